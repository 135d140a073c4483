//! Code for a program in few registers, and its interpreter.

use std::collections::BTreeMap;
use std::fmt::Debug;
use std::ops::Range;

use liestep::__private::{log_ratio, stumpff};
use liestep::numbers::{Real, real};
use liestep_derivation::whole::Sizes;
use liestep_derivation::{Array, Function, Operation, Program, Source};

use crate::error::LateError;

/// A back end that runs programs: one for all of a declaration, so that a step calls it directly.
pub trait Backend<T: Real>: Copy + Debug + 'static {
    /// The code of a program.
    type Code: Debug + Send + Sync + 'static;

    /// The programs of a declaration, each as code.
    ///
    /// # Errors
    ///
    /// A program that the back end can't run.
    fn codes(programs: &[&Program]) -> Result<Vec<Self::Code>, LateError>;

    /// Compiles code now that is otherwise compiled after some runs.
    fn prepare(_: &Self::Code) {}

    /// Makes a usual step of a state in one piece, where the back end can: twice the number of its iterations, plus one if its
    /// increment is far from the identity; or zero, without a change, if the driver has to run the programs.
    #[inline]
    #[must_use]
    fn step(_: &UsualStep<'_, Self::Code>, _: StepInputs<'_, T>, _: &mut [T]) -> u64 {
        0
    }

    /// Compiles a step now that is otherwise compiled after some of them; returns whether there is one.
    #[must_use]
    fn prepare_step(_: &UsualStep<'_, Self::Code>) -> bool {
        false
    }

    /// Runs a program, for as many outputs as it has. If constants or arrays are shorter than it reads, it gives NaN or
    /// panics.
    fn run<const N: usize>(code: &Self::Code, constants: &[T], given: Given<'_, T, N>, outputs: &mut [T]);
}

/// The programs of a usual step, as code, and the sizes of a state; see
/// [`Programs`](liestep_derivation::whole::Programs).
#[derive(Debug)]
#[allow(missing_docs)] // their names are those of the programs
pub struct UsualStep<'a, C> {
    pub sizes: &'a Sizes,
    /// Whether the determinant of a Jacobian is the product of those of its blocks, each relative to its diagonal.
    pub is_product: bool,
    pub target: &'a C,
    pub iterate: &'a C,
    pub again: &'a C,
    pub finish: &'a C,
    pub safe: Option<&'a C>,
}

impl<'a, C> UsualStep<'a, C> {
    /// This step with other code for each program.
    #[must_use]
    pub fn map<D>(&self, other: impl Fn(&'a C) -> &'a D) -> UsualStep<'a, D> {
        UsualStep {
            sizes: self.sizes,
            is_product: self.is_product,
            target: other(self.target),
            iterate: other(self.iterate),
            again: other(self.again),
            finish: other(self.finish),
            safe: self.safe.map(other),
        }
    }

    /// All programs.
    pub fn programs(&self) -> impl Iterator<Item = &'a C> {
        [self.target, self.iterate, self.again, self.finish].into_iter().chain(self.safe)
    }
}

/// The numbers that a usual step reads besides the state.
#[derive(Clone, Copy, Debug)]
pub struct StepInputs<'a, T> {
    /// The constants.
    pub constants: &'a [T],
    /// The numbers of the parameters.
    pub parameters: &'a [T],
    /// The determinant above which a Jacobian serves twice, where the inertia is constant, and the square of the largest right
    /// side.
    pub bounds: [T; 2],
}

/// Interprets programs operation by operation: safe, on every machine, and in lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Interpreter;

impl<T: Real> Backend<T> for Interpreter {
    type Code = Code;

    fn codes(programs: &[&Program]) -> Result<Vec<Code>, LateError> {
        programs.iter().map(|program| Code::of(program)).collect()
    }

    fn run<const N: usize>(code: &Code, constants: &[T], given: Given<'_, T, N>, outputs: &mut [T]) {
        code.run(constants, &given, outputs);
    }
}

/// The arrays of inputs other than constants, each once, without those that a stage doesn't have.
pub type Given<'a, T, const N: usize> = [(Array, &'a [T]); N];

/// Straight-line code. Registers hold constants, literals, inputs and results; a result's register is reused after its
/// last read.
#[derive(Clone, Debug, PartialEq)]
pub struct Code {
    /// The constants in the first registers, copied in one piece from the first to the last that is read; literals
    /// follow.
    constants: Range<usize>,
    literals: Vec<f64>,
    /// Inputs follow, array by array.
    inputs: Vec<(Array, Vec<usize>)>,
    runs: Vec<Run>,
    outputs: Vec<u16>,
    registers: usize,
}

/// Operations of one kind, one after the other.
#[derive(Clone, Debug, PartialEq)]
struct Run {
    operation: Kind,
    instructions: Vec<Instruction>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Instruction {
    operands: [u16; 2],
    result: u16,
}

/// An operation without its operands.
type Kind = Operation<()>;

/// Allocates registers for results in an order; `place` has those of inputs and literals, as many as `registers`, and
/// gets those of results. Returns the code and the number of registers, if 16 bits count them.
fn allocated(program: &Program, order: &[usize], place: &mut [u16], mut registers: usize) -> Option<(Vec<Run>, usize)> {
    let fixed = program.inputs.len() + program.literals.len();
    // The last read of each value; the register of an output is never reused.
    let mut last = vec![0; place.len()];
    for (time, &at) in order.iter().enumerate() {
        for operand in program.operations[at].operands() {
            last[operand] = time;
        }
    }
    for &output in &program.outputs {
        last[output as usize] = usize::MAX;
    }
    let mut free = Vec::new();
    let mut runs: Vec<Run> = Vec::new();
    for (time, &at) in order.iter().enumerate() {
        let (operation, read) = (kind(program.operations[at]), program.operations[at].operands());
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

/// An order of operations that puts like ones together: an interpreter then dispatches once for many.
fn by_kind(program: &Program) -> Vec<usize> {
    let fixed = program.inputs.len() + program.literals.len();
    let count = program.operations.len();
    let (mut missing, mut readers) = (vec![0_usize; count], vec![Vec::new(); count]);
    for (at, &operation) in program.operations.iter().enumerate() {
        for operand in operation.operands().into_iter().filter_map(|operand| operand.checked_sub(fixed)) {
            missing[at] += 1;
            readers[operand].push(at);
        }
    }
    let kind = |at: usize| kind(program.operations[at]);
    let mut ready: BTreeMap<Kind, Vec<usize>> = BTreeMap::new();
    (0..count).filter(|&at| missing[at] == 0).for_each(|at| ready.entry(kind(at)).or_default().push(at));
    let mut order = Vec::with_capacity(count);
    while let Some(chosen) = ready.iter().max_by_key(|(_, ready)| ready.len()).map(|(&kind, _)| kind) {
        // Like operations that become ready meanwhile follow at once.
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
    fn of(program: &Program) -> Result<Self, LateError> {
        let missing = program.operations.iter().find_map(|operation| match operation {
            Operation::Apply(function, _) if applied(*function, 0.5_f64).is_nan() => {
                Some(LateError::Function(format!("{function:?}")))
            }
            _ => None,
        });
        missing.map_or_else(|| Self::allocated(program).ok_or(LateError::TooLarge), Err)
    }

    /// The code with allocated registers; `None` if 16 bits don't count them.
    fn allocated(program: &Program) -> Option<Self> {
        let fixed = program.inputs.len() + program.literals.len();
        // Each input and literal has a register, constants first.
        let is_constant = |source: &Source| source.array == Array::Constants;
        let of_constants = || program.inputs.iter().filter(|source| is_constant(source)).map(|source| source.at);
        let constants =
            of_constants().min().unwrap_or(0)..of_constants().max().map_or(0, |last| last.saturating_add(1));
        let literals = program.inputs.len()..fixed;
        let mut others: Vec<usize> =
            (0..program.inputs.len()).filter(|&value| !is_constant(&program.inputs[value])).collect();
        others.sort_by_key(|&value| program.inputs[value].array);
        let mut inputs: Vec<(Array, Vec<usize>)> = Vec::new();
        for Source { array, at } in others.iter().map(|&value| program.inputs[value]) {
            match inputs.last_mut() {
                Some((last, places)) if *last == array => places.push(at),
                _ => inputs.push((array, vec![at])),
            }
        }
        let mut place = vec![0; fixed + program.operations.len()];
        for (place, source) in place.iter_mut().zip(&program.inputs).filter(|(_, source)| is_constant(source)) {
            *place = u16::try_from(source.at - constants.start).ok()?;
        }
        let mut registers = constants.len();
        for value in literals.chain(others) {
            place[value] = u16::try_from(registers).ok()?;
            registers += 1;
        }
        let (runs, registers) = allocated(program, &by_kind(program), &mut place, registers)?;
        Some(Self {
            constants,
            literals: program.literals.clone(),
            inputs,
            runs,
            outputs: program.outputs.iter().map(|&output| place[output as usize]).collect(),
            registers,
        })
    }

    #[inline(never)]
    fn run<T: Real>(&self, constants: &[T], given: &[(Array, &[T])], outputs: &mut [T]) {
        // Clearing unused registers costs time.
        match self.registers {
            0..=32 => self.run_in(&mut [T::zero(); 32], constants, given, outputs),
            33..=64 => self.run_in(&mut [T::zero(); 64], constants, given, outputs),
            65..=128 => self.run_in(&mut [T::zero(); 128], constants, given, outputs),
            129..=256 => self.run_in(&mut [T::zero(); 256], constants, given, outputs),
            more => self.run_in(&mut vec![T::zero(); more.next_power_of_two()], constants, given, outputs),
        }
    }

    /// Runs in a power of two of registers, so that a masked index is always in range.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run_in<T: Real>(&self, registers: &mut [T], constants: &[T], given: &[(Array, &[T])], outputs: &mut [T]) {
        let mask = registers.len().wrapping_sub(1);
        let (known, open) = registers.split_at_mut(self.constants.len().min(registers.len()));
        // No step accepts NaN for a number.
        match constants.get(self.constants.clone()) {
            Some(read) => known.copy_from_slice(&read[..known.len()]),
            None => known.fill(real(f64::NAN)),
        }
        let mut open = open.iter_mut();
        self.literals.iter().zip(&mut open).for_each(|(&literal, register)| *register = real(literal));
        for (array, places) in &self.inputs {
            let numbers = given.iter().find(|(given, _)| given == array).map_or(&[][..], |(_, numbers)| numbers);
            for (&at, register) in places.iter().zip(&mut open) {
                *register = numbers.get(at).copied().unwrap_or_else(|| real(f64::NAN));
            }
        }
        for Run { operation, instructions } in &self.runs {
            match *operation {
                Operation::Negate(()) => apply(registers, mask, instructions, |a, _| -a),
                Operation::Add(..) => apply(registers, mask, instructions, |a, b| a + b),
                Operation::Subtract(..) => apply(registers, mask, instructions, |a, b| a - b),
                Operation::Multiply(..) => apply(registers, mask, instructions, |a, b| a * b),
                Operation::Divide(..) => apply(registers, mask, instructions, |a, b| a / b),
                Operation::Apply(function, ()) => apply(registers, mask, instructions, |a, _| applied(function, a)),
            }
        }
        for (output, &register) in outputs.iter_mut().zip(&self.outputs) {
            *output = registers[usize::from(register) & mask];
        }
    }
}

/// The mask is one less than the number of registers, a power of two.
#[cfg_attr(not(debug_assertions), inline(always))]
fn apply<T: Real>(registers: &mut [T], mask: usize, instructions: &[Instruction], operation: impl Fn(T, T) -> T) {
    // The loop over plain numbers is unrolled by four.
    let (fours, others) = if T::LANES == 1 { instructions.as_chunks::<4>() } else { (&[][..], instructions) };
    for four in fours {
        for &instruction in four {
            apply_one(registers, mask, instruction, &operation);
        }
    }
    for &instruction in others {
        apply_one(registers, mask, instruction, &operation);
    }
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn apply_one<T: Real>(registers: &mut [T], mask: usize, made: Instruction, operation: &impl Fn(T, T) -> T) {
    let [a, b] = made.operands.map(|operand| registers[usize::from(operand) & mask]);
    registers[usize::from(made.result) & mask] = operation(a, b);
}

/// Applies a function as the compiled step does, to the bit. Between zero and one it is a number, or NaN if there is no
/// function of this order.
#[cold]
#[must_use]
pub fn applied<T: Real>(function: Function, a: T) -> T {
    match function {
        Function::Sqrt => a.simd_sqrt(),
        Function::Ln => a.simd_ln(),
        Function::Exp => a.simd_exp(),
        Function::Sin => a.simd_sin(),
        Function::Cos => a.simd_cos(),
        Function::Stumpff(order) => stumpff_of(order, a),
        Function::LogRatio(order) => log_ratio_of(order, a),
    }
}

macro_rules! of_order {
    ($name:ident of $function:ident: $($order:literal)+) => {
        /// The function, or NaN for other orders.
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

fn kind(operation: Operation) -> Kind {
    operation.of([(); 2])
}
