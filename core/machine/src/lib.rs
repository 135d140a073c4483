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

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, OnceLock};

use liestep::numbers::Real;
use liestep_late::{Backend, Code, Given, Interpreter, LateError, Program};

use called::{Bound, Function, LANES, lanes_of};

/// Programs are machine code once they have run some hundred times, and interpreted before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Machine;

/// A program as what is interpreted, and as machine code where that has been made.
#[derive(Debug)]
pub struct Both {
    program: Program,
    interpreted: Code,
    runs: AtomicU32,
    /// Of numbers, and of lanes.
    functions: [OnceLock<Option<Arc<Function>>>; 2],
}

impl Both {
    /// Where machine code is kept for these numbers.
    fn place<T: Real>(&self) -> Option<&OnceLock<Option<Arc<Function>>>> {
        [1, LANES].iter().zip(&self.functions).find(|(lanes, _)| **lanes == lanes_of::<T>()).map(|(_, place)| place)
    }

    /// The machine code with these constants, if it has been made.
    fn bound<T: Real>(&self, constants: &[T]) -> Option<Bound<T>> {
        Bound::of(self.place::<T>()?.get()?.as_ref()?, constants)
    }
}

/// The constants of a program: beside its machine code, or until there is one for the interpreter, too.
#[derive(Debug)]
pub struct Image<T> {
    bound: OnceLock<Bound<T>>,
    constants: Box<[T]>,
    interpreted: Box<[T]>,
}

/// As many runs are interpreted in less time than machine code takes to make.
const FEW: u32 = 256;

impl<T: Real> Backend<T> for Machine {
    type Code = Both;
    type Image = Image<T>;

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
            place.get_or_init(|| Function::of(&code.program, lanes_of::<T>()).ok().map(Arc::new));
        }
    }

    fn image(code: &Both, constants: &[T]) -> Image<T> {
        match code.bound(constants) {
            Some(bound) => Image { bound: bound.into(), constants: Box::default(), interpreted: Box::default() },
            None => Image {
                bound: OnceLock::new(),
                constants: constants.into(),
                interpreted: Interpreter::image(&code.interpreted, constants),
            },
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<const N: usize>(code: &Both, image: &Image<T>, given: Given<'_, T, N>, outputs: &mut [T]) {
        match image.bound.get() {
            Some(bound) => bound.call(given, outputs),
            None => run_first::<T, N>(code, image, std::array::from_fn(|at| given[at]), outputs),
        }
    }
}

/// A run before there is machine code, or the one that makes it.
#[cold]
#[inline(never)]
fn run_first<T: Real, const N: usize>(code: &Both, image: &Image<T>, given: Given<'_, T, N>, outputs: &mut [T]) {
    if code.runs.fetch_add(1, Ordering::Relaxed) >= FEW {
        <Machine as Backend<T>>::prepare(code);
        if let Some(bound) = code.bound(&image.constants) {
            return image.bound.get_or_init(|| bound).call(given, outputs);
        }
    }
    Interpreter::run(&code.interpreted, &image.interpreted, given, outputs);
}
