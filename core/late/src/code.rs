//! A program for few registers, and its interpreter.

use std::collections::BTreeMap;

use liestep::__private::{log_ratio, stumpff};
use liestep::numbers::{Real, real};
use liestep_derivation::{Operation, Program, Source};

/// Straight-line code. Registers hold constants, literals, inputs and what is computed: of these, one that isn't read any
/// more is used again.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Code {
    /// What is known before a step, in the first registers: places among the constants, then literals.
    constants: Vec<usize>,
    literals: Vec<f64>,
    inputs: Vec<Source>,
    runs: Vec<Run>,
    outputs: Vec<u16>,
    registers: usize,
}

/// Operations of one kind, one after the other.
#[derive(Clone, Debug, PartialEq)]
struct Run {
    operation: Arithmetic,
    instructions: Vec<Instruction>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Instruction {
    operands: [u16; 2],
    result: u16,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
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
            // It is in the image.
            Source::Constant(_) => None,
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

/// The operations in that order, each with a register for its result; `place` has those of inputs and literals, and gets
/// those of results. With the number of registers.
fn allocated(program: &Program, order: &[usize], place: &mut [u16]) -> Option<(Vec<Run>, usize)> {
    let fixed = program.inputs.len() + program.literals.len();
    // When each value is read last; an output is never done with.
    let mut last = vec![0; place.len()];
    for (time, &at) in order.iter().enumerate() {
        for operand in parts(program.operations[at]).1 {
            last[operand] = time;
        }
    }
    for &output in &program.outputs {
        last[output] = usize::MAX;
    }
    let (mut free, mut registers) = (Vec::new(), fixed);
    let mut runs: Vec<Run> = Vec::new();
    for (time, &at) in order.iter().enumerate() {
        let (operation, read) = parts(program.operations[at]);
        if !exists(operation) {
            return None;
        }
        let operands = read.map(|value| place[value]);
        for (value, operand) in read.into_iter().zip(operands) {
            if value >= fixed && last[value] == time && !free.contains(&operand) {
                free.push(operand);
            }
        }
        let result = free.pop().unwrap_or_else(|| {
            registers += 1;
            u16::try_from(registers - 1).unwrap_or(u16::MAX)
        });
        place[fixed + at] = result;
        let instruction = Instruction { operands, result };
        match runs.last_mut() {
            Some(run) if run.operation == operation => run.instructions.push(instruction),
            _ => runs.push(Run { operation, instructions: vec![instruction] }),
        }
    }
    u16::try_from(registers).is_ok().then_some((runs, registers))
}

/// Operations in an order in which like ones stand together: an interpreter then decides once for many what to do.
fn by_kind(program: &Program) -> Vec<usize> {
    let fixed = program.inputs.len() + program.literals.len();
    let count = program.operations.len();
    let (mut missing, mut readers) = (vec![0_usize; count], vec![Vec::new(); count]);
    for (at, &operation) in program.operations.iter().enumerate() {
        for operand in parts(operation).1.into_iter().filter_map(|operand| operand.checked_sub(fixed)) {
            missing[at] += 1;
            readers[operand].push(at);
        }
    }
    let kind = |at: usize| parts(program.operations[at]).0;
    let mut ready: BTreeMap<Arithmetic, Vec<usize>> = BTreeMap::new();
    (0..count).filter(|&at| missing[at] == 0).for_each(|at| ready.entry(kind(at)).or_default().push(at));
    let mut order = Vec::with_capacity(count);
    while let Some(chosen) = ready.iter().max_by_key(|(_, ready)| ready.len()).map(|(&kind, _)| kind) {
        // As long as there are any, those that become ready meanwhile too.
        while let Some(at) = ready.get_mut(&chosen).and_then(Vec::pop) {
            order.push(at);
            for &reader in &readers[at] {
                missing[reader] -= 1;
                if missing[reader] == 0 {
                    ready.entry(kind(reader)).or_default().push(reader);
                }
            }
        }
        ready.remove(&chosen);
    }
    order
}

impl Code {
    /// `None` of a program that needs more registers than there are names for, or a function of a higher order.
    pub(crate) fn of(program: &Program) -> Option<Self> {
        let fixed = program.inputs.len() + program.literals.len();
        // A register for each input and literal, what is known before a step first.
        let is_constant = |source: &Source| matches!(source, Source::Constant(_));
        let inputs = || program.inputs.iter().enumerate();
        let first = inputs().filter(|(_, source)| is_constant(source)).map(|(value, _)| value);
        let literals = program.inputs.len()..fixed;
        let others = inputs().filter(|(_, source)| !is_constant(source)).map(|(value, _)| value);
        let mut place = vec![0; fixed + program.operations.len()];
        for (register, value) in first.chain(literals).chain(others).enumerate() {
            place[value] = u16::try_from(register).ok()?;
        }
        let (runs, registers) = allocated(program, &by_kind(program), &mut place)?;
        let constants = program.inputs.iter().filter_map(|source| match source {
            Source::Constant(at) => Some(*at),
            _ => None,
        });
        Some(Self {
            constants: constants.collect(),
            literals: program.literals.clone(),
            inputs: program.inputs.iter().copied().filter(|source| !is_constant(source)).collect(),
            runs,
            outputs: program.outputs.iter().map(|&output| place[output]).collect(),
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

    /// The first registers of every run with these constants.
    pub(crate) fn image<T: Real>(&self, constants: &[T]) -> Box<[T]> {
        let of = |&at: &usize| constants.get(at).copied().unwrap_or_else(|| real(f64::NAN));
        self.constants.iter().map(of).chain(self.literals.iter().map(|&literal| real(literal))).collect()
    }

    /// Runs it, and makes something of what comes out, number by number.
    pub(crate) fn run<T: Real, R>(
        &self,
        image: &[T],
        arrays: &Arrays<T>,
        make: impl FnOnce(&dyn Fn(usize) -> T) -> R,
    ) -> R {
        // Registers beyond those that are used cost time to clear.
        match self.registers {
            0..=32 => self.run_in(&mut [T::zero(); 32], image, arrays, make),
            33..=64 => self.run_in(&mut [T::zero(); 64], image, arrays, make),
            65..=128 => self.run_in(&mut [T::zero(); 128], image, arrays, make),
            129..=256 => self.run_in(&mut [T::zero(); 256], image, arrays, make),
            more => self.run_in(&mut vec![T::zero(); more.next_power_of_two()], image, arrays, make),
        }
    }

    /// In registers whose number is a power of two, so that a masked index is always in range.
    #[inline]
    fn run_in<T: Real, R>(
        &self,
        registers: &mut [T],
        image: &[T],
        arrays: &Arrays<T>,
        make: impl FnOnce(&dyn Fn(usize) -> T) -> R,
    ) -> R {
        let mask = registers.len().wrapping_sub(1);
        let (known, open) = registers.split_at_mut(image.len().min(registers.len()));
        known.copy_from_slice(&image[..known.len()]);
        open.iter_mut().zip(&self.inputs).for_each(|(register, &source)| *register = arrays.read(source));
        for Run { operation, instructions } in &self.runs {
            match *operation {
                Arithmetic::Negate => apply(registers, mask, instructions, |a, _| -a),
                Arithmetic::Add => apply(registers, mask, instructions, |a, b| a + b),
                Arithmetic::Subtract => apply(registers, mask, instructions, |a, b| a - b),
                Arithmetic::Multiply => apply(registers, mask, instructions, |a, b| a * b),
                Arithmetic::Divide => apply(registers, mask, instructions, |a, b| a / b),
                other => apply(registers, mask, instructions, |a, _| function(other, a)),
            }
        }
        make(&|output| match self.outputs.get(output) {
            Some(&register) => registers[usize::from(register) & mask],
            None => real(f64::NAN),
        })
    }
}

/// The mask is one less than the number of registers, a power of two.
#[inline]
fn apply<T: Copy>(registers: &mut [T], mask: usize, instructions: &[Instruction], operation: impl Fn(T, T) -> T) {
    for &Instruction { operands: [a, b], result } in instructions {
        let value = operation(registers[usize::from(a) & mask], registers[usize::from(b) & mask]);
        registers[usize::from(result) & mask] = value;
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
