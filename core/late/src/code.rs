//! A program for few registers, and its interpreter.

use std::collections::BTreeMap;
use std::fmt::Debug;
use std::ops::Range;

use liestep::__private::{log_ratio, stumpff};
use liestep::numbers::{Real, real};
use liestep_derivation::{Array, Function, Operation, Program, Source};

use crate::error::LateError;

/// What runs programs: the same for all of a declaration, so that a step calls it directly.
pub trait Backend<T: Real>: Copy + Debug + 'static {
    /// What it makes of a program.
    type Code: Debug + Send + Sync + 'static;

    /// The programs of a declaration, each made ready.
    ///
    /// # Errors
    ///
    /// Where it can't run one.
    fn codes(programs: &[&Program]) -> Result<Vec<Self::Code>, LateError>;

    /// Makes now what else is made after some runs.
    fn prepare(_: &Self::Code) {}

    /// Runs a program, for as many outputs as it has. Constants and arrays have all that it reads, or it gives NaN or panics.
    fn run<const N: usize>(code: &Self::Code, constants: &[T], given: Given<'_, T, N>, outputs: &mut [T]);
}

/// Programs are read operation by operation: safe, on every machine, and in lanes.
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

/// The arrays that inputs other than constants are read from, each once; what a stage doesn't have isn't among them.
pub type Given<'a, T, const N: usize> = [(Array, &'a [T]); N];

/// Straight-line code. Registers hold constants, literals, inputs and what is computed: of these, one that isn't read any
/// more is used again.
#[derive(Clone, Debug, PartialEq)]
pub struct Code {
    /// What is known before a step, in the first registers: constants from the first to the last that is read, copied as they
    /// stand, then literals.
    constants: Range<usize>,
    literals: Vec<f64>,
    /// Then places in arrays, array by array.
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

/// The operations in that order, each with a register for its result; `place` has those of inputs and literals, as many as
/// `registers`, and gets those of results. With the number of registers.
fn allocated(program: &Program, order: &[usize], place: &mut [u16], mut registers: usize) -> Option<(Vec<Run>, usize)> {
    let fixed = program.inputs.len() + program.literals.len();
    // When each value is read last; an output is never done with.
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

/// Operations in an order in which like ones stand together: an interpreter then decides once for many what to do.
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
    fn of(program: &Program) -> Result<Self, LateError> {
        let missing = program.operations.iter().find_map(|operation| match operation {
            Operation::Apply(function, _) if applied(*function, 0.5_f64).is_nan() => {
                Some(LateError::Function(format!("{function:?}")))
            }
            _ => None,
        });
        missing.map_or_else(|| Self::allocated(program).ok_or(LateError::TooLarge), Err)
    }

    /// `None` of a program that needs more registers than there are names for.
    fn allocated(program: &Program) -> Option<Self> {
        let fixed = program.inputs.len() + program.literals.len();
        // A register for each input and literal, what is known before a step first.
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
        // Registers beyond those that are used cost time to clear.
        match self.registers {
            0..=32 => self.run_in(&mut [T::zero(); 32], constants, given, outputs),
            33..=64 => self.run_in(&mut [T::zero(); 64], constants, given, outputs),
            65..=128 => self.run_in(&mut [T::zero(); 128], constants, given, outputs),
            129..=256 => self.run_in(&mut [T::zero(); 256], constants, given, outputs),
            more => self.run_in(&mut vec![T::zero(); more.next_power_of_two()], constants, given, outputs),
        }
    }

    /// In registers whose number is a power of two, so that a masked index is always in range.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run_in<T: Real>(&self, registers: &mut [T], constants: &[T], given: &[(Array, &[T])], outputs: &mut [T]) {
        let mask = registers.len().wrapping_sub(1);
        let (known, open) = registers.split_at_mut(self.constants.len().min(registers.len()));
        // No step takes NaN for a number.
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
    // Four in a turn, which the compiler writes one after the other, where they are short.
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

/// A function of a number: that of the compiled step, so that the bits are the same. Between zero and one it is a number, but
/// NaN where there is no function of this order.
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

fn kind(operation: Operation) -> Kind {
    operation.of([(); 2])
}
