//! Machine code for the programs of a Lagrangian that is read while a program runs.
//!
//! [`Machine`] is a back end of [`Late`](liestep_late::Late): `Late<SO3, W, K, Machine>`. A program is interpreted
//! until it has run some hundred times, so that a first step waits for no compiler, and then becomes a function, by
//! [Cranelift](https://cranelift.dev), operation by operation: nothing is contracted or reassociated, and functions
//! like `sin` are calls of the interpreter's. So the steps are the same to the bit.
//!
//! There is machine code for x86-64 and aarch64, for numbers and for the eight lanes of an ensemble. In other lanes,
//! and for other scalars, programs are interpreted. The code for aarch64 hasn't been run; there, too, the tests here
//! compare it with the interpreter.
//!
//! # Inside
//!
//! `lib → called → translated → registers`: `translated` generates the code, `registers` assigns values to registers
//! and memory, and everything unsafe is in `called`.

#![cfg(feature = "cranelift")]

mod called;
mod registers;
mod translated;

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

use liestep::numbers::Real;
use liestep_late::{Backend, Code, Given, Interpreter, LateError, Program};

use called::{Function, LANES, lanes_of};

/// A back end that interprets programs until they have run some hundred times, and then compiles them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Machine;

/// A program as interpreted code, and as machine code once it is compiled.
#[derive(Debug)]
pub struct Both {
    program: Program,
    interpreted: Code,
    of_numbers: Made<1>,
    of_lanes: Made<LANES>,
}

/// A function, once it is compiled.
#[derive(Debug, Default)]
struct Made<const LANES: usize> {
    /// The number of interpreted runs.
    runs: AtomicU32,
    /// The function; also missing if the compilation failed.
    function: OnceLock<Function<LANES>>,
}

impl<const LANES: usize> Made<LANES> {
    fn make(&self, program: &Program) {
        if self.function.get().is_none()
            && let Ok(function) = Function::of(program)
        {
            // Another thread may have compiled it first.
            let _ = self.function.set(function);
        }
    }

    /// Counts a run, and compiles after some; a compilation that failed isn't repeated.
    fn run(&self, program: &Program) {
        if self.runs.fetch_add(1, Ordering::Relaxed) == FEW {
            self.make(program);
        }
    }
}

/// The number of runs that are interpreted in less time than a compilation takes.
const FEW: u32 = 256;

impl<T: Real> Backend<T> for Machine {
    type Code = Both;

    fn codes(programs: &[&Program]) -> Result<Vec<Both>, LateError> {
        translated::isa().map_err(LateError::Machine)?;
        let interpreted = <Interpreter as Backend<f64>>::codes(programs)?;
        let both = |(&program, interpreted): (&&Program, Code)| Both {
            program: program.clone(),
            interpreted,
            of_numbers: Made::default(),
            of_lanes: Made::default(),
        };
        Ok(programs.iter().zip(interpreted).map(both).collect())
    }

    fn prepare(code: &Both) {
        match lanes_of::<T>() {
            1 => code.of_numbers.make(&code.program),
            LANES => code.of_lanes.make(&code.program),
            _ => {}
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<const N: usize>(code: &Both, constants: &[T], given: Given<'_, T, N>, outputs: &mut [T]) {
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
fn run_first<T: Real, const N: usize>(code: &Both, constants: &[T], given: Given<'_, T, N>, outputs: &mut [T]) {
    match lanes_of::<T>() {
        1 => code.of_numbers.run(&code.program),
        LANES => code.of_lanes.run(&code.program),
        _ => {}
    }
    Interpreter::run(&code.interpreted, constants, given, outputs);
}
