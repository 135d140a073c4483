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
//! `lib → called → translated`: `translated` makes the code, and all that is unsafe is in `called`.

#![cfg(feature = "cranelift")]

mod called;
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
    runs: AtomicU32,
    /// Of numbers, and of lanes; none where it couldn't be made.
    functions: [OnceLock<Option<Function>>; 2],
}

impl Both {
    /// Where machine code is kept for these numbers.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn place<T: Real>(&self) -> Option<&OnceLock<Option<Function>>> {
        match lanes_of::<T>() {
            1 => Some(&self.functions[0]),
            LANES => Some(&self.functions[1]),
            _ => None,
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
            runs: AtomicU32::new(0),
            functions: Default::default(),
        };
        Ok(programs.iter().zip(interpreted).map(both).collect())
    }

    fn prepare(code: &Both) {
        if let Some(place) = code.place::<T>() {
            place.get_or_init(|| Function::of(&code.program, lanes_of::<T>()).ok());
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<const N: usize>(code: &Both, constants: &[T], given: Given<'_, T, N>, outputs: &mut [T]) {
        match code.place::<T>().and_then(OnceLock::get) {
            Some(Some(function)) => function.call(constants, given, outputs),
            _ => run_first::<T, N>(code, constants, std::array::from_fn(|at| given[at]), outputs),
        }
    }
}

/// A run before there is machine code, or the one that makes it.
#[cold]
#[inline(never)]
fn run_first<T: Real, const N: usize>(code: &Both, constants: &[T], given: Given<'_, T, N>, outputs: &mut [T]) {
    if code.runs.fetch_add(1, Ordering::Relaxed) >= FEW {
        <Machine as Backend<T>>::prepare(code);
    }
    Interpreter::run(&code.interpreted, constants, given, outputs);
}
