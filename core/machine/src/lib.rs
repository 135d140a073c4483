//! The programs of a Lagrangian that is read while a program runs, as machine code.
//!
//! [`Machine`] is a back end of [`Late`](liestep_late::Late): `Late<SO3, W, K, Machine>`. A program is interpreted until it
//! has run some hundred times, so that a first step waits for no compiler, and then becomes a function, by
//! [Cranelift](https://cranelift.dev), operation by operation: nothing is contracted or associated anew, and functions like
//! `sin` are those of the interpreter, called. So the steps are the same to the bit.
//!
//! There is machine code for x86-64 and aarch64, for numbers and for the eight lanes of an ensemble. In other lanes, and for
//! other scalars, programs are interpreted. On aarch64 it hasn't been run: the tests here hold it to the interpreter there,
//! too.
//!
//! # Inside
//!
//! `lib → called → translated → registers`: `translated` makes the code, `registers` says what stands in registers and what
//! in memory, and all that is unsafe is in `called`.

#![cfg(feature = "cranelift")]

mod called;
mod registers;
mod translated;

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

use liestep::numbers::Real;
use liestep_late::{Backend, Code, Given, Interpreter, LateError, Program};

use called::{Function, LANES, lanes_of};

/// Programs are machine code once they have run some hundred times, and interpreted before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Machine;

/// A program as what is interpreted, and as machine code where that has been made.
#[derive(Debug)]
pub struct Both {
    program: Program,
    interpreted: Code,
    of_numbers: Made<1>,
    of_lanes: Made<LANES>,
}

/// A function, once it has been made.
#[derive(Debug, Default)]
struct Made<const LANES: usize> {
    /// Those that were interpreted.
    runs: AtomicU32,
    /// None where it couldn't be made, either.
    function: OnceLock<Function<LANES>>,
}

impl<const LANES: usize> Made<LANES> {
    fn make(&self, program: &Program) {
        if self.function.get().is_none()
            && let Ok(function) = Function::of(program)
        {
            // Of two threads the first has made it.
            let _ = self.function.set(function);
        }
    }

    /// Another run; what couldn't be made after some isn't tried again.
    fn run(&self, program: &Program) {
        if self.runs.fetch_add(1, Ordering::Relaxed) == FEW {
            self.make(program);
        }
    }
}

/// As many runs are interpreted in less time than machine code takes to make.
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

/// A run before there is machine code, or the one that makes it.
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
