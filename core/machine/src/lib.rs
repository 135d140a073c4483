//! The programs of a Lagrangian that is read while a program runs, as machine code.
//!
//! [`Machine`] is a back end of [`Late`](liestep_late::Late): `Late<SO3, W, K, Machine>`. Each program becomes a function, by
//! [Cranelift](https://cranelift.dev), operation by operation and in the order of the program: nothing is contracted or
//! reordered, and functions like `sin` are those of the interpreter, called. So the steps are the same to the bit.
//!
//! There is machine code for x86-64 and aarch64, for numbers and for the eight lanes of an ensemble. In other lanes, and for
//! other scalars, programs are interpreted.
//!
//! # Inside
//!
//! `lib → called → translated`: `translated` makes the code, and all that is unsafe is in `called`.

#![cfg(feature = "cranelift")]

mod called;
mod translated;

use std::sync::OnceLock;

use liestep::numbers::Real;
use liestep_late::{Backend, Code, Given, Interpreted, LateError, Program};

use called::{Function, LANES, lanes_of};

/// Programs are machine code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Machine;

/// A program as machine code, and as what is interpreted.
#[derive(Debug)]
pub struct Both {
    program: Program,
    function: Function,
    /// Made where somebody asks for it.
    in_lanes: OnceLock<Option<Function>>,
    interpreted: Code,
}

impl<T: Real> Backend<T> for Machine {
    type Code = Both;
    type Image = Box<[T]>;

    fn codes(programs: &[&Program]) -> Result<Vec<Both>, LateError> {
        let functions = called::functions(programs, 1).map_err(LateError::Machine)?;
        let interpreted = <Interpreted as Backend<f64>>::codes(programs)?;
        let all = programs.iter().zip(functions).zip(interpreted);
        Ok(all
            .map(|((&program, function), interpreted)| Both {
                program: program.clone(),
                function,
                in_lanes: OnceLock::new(),
                interpreted,
            })
            .collect())
    }

    fn image(code: &Both, constants: &[T]) -> Box<[T]> {
        let made = || called::functions(&[&code.program], LANES).ok()?.pop();
        match lanes_of::<T>() {
            1 => Box::default(),
            LANES if code.in_lanes.get_or_init(made).is_some() => Box::default(),
            _ => <Interpreted as Backend<T>>::image(&code.interpreted, constants),
        }
    }

    #[inline]
    fn run<const N: usize>(code: &Both, image: &Box<[T]>, given: Given<'_, T, N>, outputs: &mut [T]) {
        let in_lanes = || code.in_lanes.get().and_then(Option::as_ref);
        match lanes_of::<T>() {
            1 => code.function.call(given, outputs),
            LANES if in_lanes().is_some() => in_lanes().into_iter().for_each(|made| made.call(given, outputs)),
            _ => <Interpreted as Backend<T>>::run(&code.interpreted, image, given, outputs),
        }
    }
}
