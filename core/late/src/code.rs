//! A program for few registers, and its interpreter.

use liestep::__private::{log_ratio, stumpff};
use liestep::numbers::{Real, real};
use liestep_derivation::{Operation, Program, Source};

/// Straight-line code. Registers hold the inputs, then the literals, then what is computed: of these, one that isn't read
/// any more is used again.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Code {
    inputs: Vec<Source>,
    literals: Vec<f64>,
    instructions: Vec<Instruction>,
    outputs: Vec<u16>,
    registers: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Instruction {
    operation: Arithmetic,
    operands: [u16; 2],
    result: u16,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Arithmetic {
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Sqrt,
    Ln,
    Exp,
    Sin,
    Cos,
    Stumpff(u8),
    LogRatio(u8),
}

/// The arrays that inputs are read from; what a stage doesn't have is empty, and no program of it reads it.
#[derive(Clone, Copy)]
pub(crate) struct Arrays<'a, T> {
    pub(crate) step: Option<T>,
    pub(crate) parameters: &'a [T],
    pub(crate) constants: &'a [T],
    pub(crate) terms: &'a [T],
    pub(crate) advected: &'a [T],
    pub(crate) next: &'a [T],
    pub(crate) element: &'a [T],
    pub(crate) increment: &'a [T],
    pub(crate) inverse: &'a [T],
    pub(crate) inverse_increment: &'a [T],
    pub(crate) half: &'a [T],
    pub(crate) velocity: &'a [T],
    pub(crate) target: &'a [T],
}

impl<T> Default for Arrays<'_, T> {
    fn default() -> Self {
        Self {
            step: None,
            parameters: &[],
            constants: &[],
            terms: &[],
            advected: &[],
            next: &[],
            element: &[],
            increment: &[],
            inverse: &[],
            inverse_increment: &[],
            half: &[],
            velocity: &[],
            target: &[],
        }
    }
}

impl<T: Real> Arrays<'_, T> {
    /// NaN where there is none, which no step takes for a number.
    #[inline]
    fn read(&self, source: Source) -> T {
        let found = match source {
            Source::Step => self.step.as_ref(),
            Source::Parameter(at) => self.parameters.get(at),
            Source::Constant(at) => self.constants.get(at),
            Source::Term(at) => self.terms.get(at),
            Source::Advected(at) => self.advected.get(at),
            Source::Next(at) => self.next.get(at),
            Source::Element(at) => self.element.get(at),
            Source::Increment(at) => self.increment.get(at),
            Source::Inverse(at) => self.inverse.get(at),
            Source::InverseIncrement(at) => self.inverse_increment.get(at),
            Source::Half(at) => self.half.get(at),
            Source::Velocity(at) => self.velocity.get(at),
            Source::Target(at) => self.target.get(at),
        };
        found.copied().unwrap_or_else(|| real(f64::NAN))
    }
}

impl Code {
    /// `None` of a program that needs more registers than there are names for, or a function of a higher order.
    pub(crate) fn of(program: &Program) -> Option<Self> {
        let fixed = program.inputs.len() + program.literals.len();
        let values = fixed + program.operations.len();
        // When each value is read last; an output is never done with.
        let mut last = vec![0; values];
        for (at, &operation) in program.operations.iter().enumerate() {
            let (_, operands) = parts(operation);
            for operand in operands {
                last[operand] = at;
            }
        }
        for &output in &program.outputs {
            last[output] = usize::MAX;
        }
        let mut place: Vec<u16> = (0..fixed).map(u16::try_from).collect::<Result<_, _>>().ok()?;
        let (mut free, mut registers) = (Vec::new(), fixed);
        let mut instructions = Vec::with_capacity(program.operations.len());
        for (at, &operation) in program.operations.iter().enumerate() {
            let (arithmetic, read) = parts(operation);
            if !exists(arithmetic) {
                return None;
            }
            let operands = read.map(|value| place[value]);
            for (value, operand) in read.into_iter().zip(operands) {
                if value >= fixed && last[value] == at && !free.contains(&operand) {
                    free.push(operand);
                }
            }
            let result = free.pop().map_or_else(
                || {
                    registers += 1;
                    u16::try_from(registers - 1)
                },
                Ok,
            );
            let result = result.ok()?;
            place.push(result);
            instructions.push(Instruction { operation: arithmetic, operands, result });
        }
        let outputs = program.outputs.iter().map(|&output| place[output]).collect();
        Some(Self {
            inputs: program.inputs.clone(),
            literals: program.literals.clone(),
            instructions,
            outputs,
            registers,
        })
    }

    pub(crate) fn outputs(&self) -> usize {
        self.outputs.len()
    }

    /// Whether one of the inputs is of this kind.
    pub(crate) fn reads(&self, kind: fn(usize) -> Source) -> bool {
        let same = |source: &Source| std::mem::discriminant(source) == std::mem::discriminant(&kind(0));
        self.inputs.iter().any(same)
    }

    /// Runs it, and writes what comes out.
    pub(crate) fn run<T: Real>(&self, arrays: &Arrays<T>, results: &mut [T]) {
        // Registers beyond those that are used cost time to clear.
        match self.registers {
            0..=32 => self.run_in(&mut [T::zero(); 32], arrays, results),
            33..=64 => self.run_in(&mut [T::zero(); 64], arrays, results),
            65..=256 => self.run_in(&mut [T::zero(); 256], arrays, results),
            more => self.run_in(&mut vec![T::zero(); more.next_power_of_two()], arrays, results),
        }
    }

    /// In registers whose number is a power of two, so that a masked index is always in range.
    #[inline]
    fn run_in<T: Real>(&self, registers: &mut [T], arrays: &Arrays<T>, results: &mut [T]) {
        let Some(mask) = registers.len().checked_sub(1) else { return };
        let literals = self.literals.iter().map(|&literal| real(literal));
        let leaves = self.inputs.iter().map(|&source| arrays.read(source)).chain(literals);
        registers.iter_mut().zip(leaves).for_each(|(register, leaf)| *register = leaf);
        for &Instruction { operation, operands: [a, b], result } in &self.instructions {
            let (a, b) = (registers[usize::from(a) & mask], registers[usize::from(b) & mask]);
            registers[usize::from(result) & mask] = match operation {
                Arithmetic::Negate => -a,
                Arithmetic::Add => a + b,
                Arithmetic::Subtract => a - b,
                Arithmetic::Multiply => a * b,
                Arithmetic::Divide => a / b,
                other => function(other, a),
            };
        }
        for (result, &output) in results.iter_mut().zip(&self.outputs) {
            *result = registers[usize::from(output) & mask];
        }
    }
}

/// Those of the compiled step, so that the bits are the same.
#[cold]
fn function<T: Real>(operation: Arithmetic, a: T) -> T {
    match operation {
        Arithmetic::Sqrt => a.simd_sqrt(),
        Arithmetic::Ln => a.simd_ln(),
        Arithmetic::Exp => a.simd_exp(),
        Arithmetic::Sin => a.simd_sin(),
        Arithmetic::Cos => a.simd_cos(),
        Arithmetic::Stumpff(order) => stumpff_of(order, a),
        Arithmetic::LogRatio(order) => log_ratio_of(order, a),
        _ => real(f64::NAN),
    }
}

macro_rules! of_order {
    ($name:ident of $function:ident: $($order:literal)+) => {
        /// The orders that there are.
        fn $name<T: Real>(order: u8, a: T) -> T {
            match order {
                $($order => $function::<T, $order>(a),)+
                _ => real(f64::NAN),
            }
        }
    };
}

of_order!(stumpff_of of stumpff: 1 2 3 4 5 6 7 8 9 10);
of_order!(log_ratio_of of log_ratio: 0 1 2 3 4 5 6);

/// Whether there is such a function.
const fn exists(operation: Arithmetic) -> bool {
    match operation {
        Arithmetic::Stumpff(order) => 0 < order && order <= 10,
        Arithmetic::LogRatio(order) => order <= 6,
        _ => true,
    }
}

/// What it does, and the values that it reads.
fn parts(operation: Operation) -> (Arithmetic, [usize; 2]) {
    match operation {
        Operation::Negate(a) => (Arithmetic::Negate, [a, a]),
        Operation::Add(a, b) => (Arithmetic::Add, [a, b]),
        Operation::Subtract(a, b) => (Arithmetic::Subtract, [a, b]),
        Operation::Multiply(a, b) => (Arithmetic::Multiply, [a, b]),
        Operation::Divide(a, b) => (Arithmetic::Divide, [a, b]),
        Operation::Sqrt(a) => (Arithmetic::Sqrt, [a, a]),
        Operation::Ln(a) => (Arithmetic::Ln, [a, a]),
        Operation::Exp(a) => (Arithmetic::Exp, [a, a]),
        Operation::Sin(a) => (Arithmetic::Sin, [a, a]),
        Operation::Cos(a) => (Arithmetic::Cos, [a, a]),
        Operation::Stumpff(k, a) => (Arithmetic::Stumpff(k), [a, a]),
        Operation::LogRatio(k, a) => (Arithmetic::LogRatio(k), [a, a]),
    }
}
