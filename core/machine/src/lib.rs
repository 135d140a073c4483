#![doc = include_str!("../README.md")]
//!
//! # Inside
//!
//! `lib → called → {memory, {step, translated} → {piece, function} → operation → registers}`: `translated` generates the code
//! of a program, `step` that of a whole step, `piece` orders operations, `registers` assigns values to registers and memory.
//! Everything unsafe is in `called` and `memory`.

#![cfg(feature = "cranelift")]

mod called;
mod function;
mod memory;
mod operation;
mod piece;
mod registers;
mod step;
mod translated;

pub use memory::{MOST_MEMORY, used_memory};

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

use liestep::numbers::Real;
use liestep_late::{Backend, Code, Given, Interpreter, LateError, Program, StepInputs, UsualStep};

use called::{Function, LANES, StepFunction, lanes_of};

/// A back end that interprets programs until they have run some hundred times, and then compiles them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Machine;

/// A program as interpreted code, and as machine code once it is compiled.
#[derive(Debug)]
pub struct Codes {
    program: Program,
    interpreted: Code,
    of_numbers: Compilation<Function<1>>,
    of_lanes: Compilation<Function<LANES>>,
    /// The step that ends with this program.
    of_step: Compilation<StepFunction>,
}

/// A function, once it is compiled.
#[derive(Debug)]
struct Compilation<F> {
    /// The number of interpreted runs.
    runs: AtomicU32,
    /// The function; also missing if the compilation failed.
    function: OnceLock<F>,
}

impl<F> Default for Compilation<F> {
    fn default() -> Self {
        Self { runs: AtomicU32::new(0), function: OnceLock::new() }
    }
}

impl<F> Compilation<F> {
    fn make(&self, compile: impl FnOnce() -> Result<F, String>) {
        if self.function.get().is_none()
            && let Ok(function) = compile()
        {
            // Another thread may have compiled it first.
            let _ = self.function.set(function);
        }
    }

    /// Counts a run, and compiles after some; a compilation that failed isn't repeated.
    fn run(&self, few: u32, compile: impl FnOnce() -> Result<F, String>) {
        if self.runs.fetch_add(1, Ordering::Relaxed) == few {
            self.make(compile);
        }
    }
}

/// The numbers of runs that are interpreted in less time than a compilation takes, of a program and of a step, whose programs
/// run some times each.
const FEW: u32 = 256;
const FEW_STEPS: u32 = 64;

impl<T: Real> Backend<T> for Machine {
    type Code = Codes;

    fn codes(programs: &[&Program]) -> Result<Vec<Codes>, LateError> {
        function::isa().map_err(LateError::Machine)?;
        let interpreted = <Interpreter as Backend<f64>>::codes(programs)?;
        let both = |(&program, interpreted): (&&Program, Code)| Codes {
            program: program.clone(),
            interpreted,
            of_numbers: Compilation::default(),
            of_lanes: Compilation::default(),
            of_step: Compilation::default(),
        };
        Ok(programs.iter().zip(interpreted).map(both).collect())
    }

    fn prepare(code: &Codes) {
        match lanes_of::<T>() {
            1 => code.of_numbers.make(|| Function::of(&code.program)),
            LANES => code.of_lanes.make(|| Function::of(&code.program)),
            _ => {}
        }
    }

    #[inline]
    fn step(usual: &UsualStep<'_, Codes>, inputs: StepInputs<'_, T>, state: &mut [T]) -> u64 {
        let compilation = &usual.finish.of_step;
        if let Some(function) = compilation.function.get() {
            return function.call(inputs, state);
        }
        compilation.run(FEW_STEPS, || StepFunction::of(&usual.map(|both| &both.program)));
        0
    }

    fn prepare_step(usual: &UsualStep<'_, Codes>) -> bool {
        usual.finish.of_step.make(|| StepFunction::of(&usual.map(|both| &both.program)));
        usual.finish.of_step.function.get().is_some()
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<const N: usize>(code: &Codes, constants: &[T], given: Given<'_, T, N>, outputs: &mut [T]) {
        let lanes = lanes_of::<T>();
        if let Some(function) = code.of_numbers.function.get().filter(|_| lanes == 1) {
            function.call(constants, given, outputs);
        } else if let Some(function) = code.of_lanes.function.get().filter(|_| lanes == LANES) {
            function.call(constants, given, outputs);
        } else {
            run_first::<T, N>(code, constants, std::array::from_fn(|at| given[at]), outputs);
        }
    }
}

/// Interprets a run, and compiles the program when that is due.
#[cold]
#[inline(never)]
fn run_first<T: Real, const N: usize>(code: &Codes, constants: &[T], given: Given<'_, T, N>, outputs: &mut [T]) {
    match lanes_of::<T>() {
        1 => code.of_numbers.run(FEW, || Function::of(&code.program)),
        LANES => code.of_lanes.run(FEW, || Function::of(&code.program)),
        _ => {}
    }
    Interpreter::run(&code.interpreted, constants, given, outputs);
}
