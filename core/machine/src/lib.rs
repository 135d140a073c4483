//! The programs of a Lagrangian that is read while a program runs, as machine code.
//!
//! [`Machine`] is a back end of [`Late`](liestep_late::Late): `Late<SO3, W, K, Machine>`. Each program becomes a function, by
//! [Cranelift](https://cranelift.dev), operation by operation and in the order of the program: nothing is contracted or
//! reordered, and functions like `sin` are those of the interpreter, called. So the steps are the same to the bit.
//!
//! There is machine code for x86-64 and aarch64. In lanes, and for scalars other than `f64`, programs are interpreted.
//!
//! # Inside
//!
//! `lib → called → translated`: `translated` makes the code, and all that is unsafe is in `called`.

#![cfg(feature = "cranelift")]

mod called;
mod translated;

use std::any::TypeId;

use liestep::numbers::Real;
use liestep_late::{Arrays, Backend, Code, Interpreted, LateError, Program};

use called::Function;

/// Programs are machine code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Machine;

/// A program as machine code, and as what is interpreted in lanes.
#[derive(Debug)]
pub struct Both {
    function: Function,
    interpreted: Code,
}

fn is_single<T: 'static>() -> bool {
    TypeId::of::<T>() == TypeId::of::<f64>()
}

impl<T: Real> Backend<T> for Machine {
    type Code = Both;
    type Image = Box<[T]>;

    fn codes(programs: &[&Program]) -> Result<Vec<Both>, LateError> {
        let functions = called::functions(programs).map_err(LateError::Machine)?;
        let interpreted = <Interpreted as Backend<f64>>::codes(programs)?;
        Ok(functions
            .into_iter()
            .zip(interpreted)
            .map(|(function, interpreted)| Both { function, interpreted })
            .collect())
    }

    fn image(code: &Both, constants: &[T]) -> Box<[T]> {
        if is_single::<T>() { Box::default() } else { <Interpreted as Backend<T>>::image(&code.interpreted, constants) }
    }

    #[inline]
    fn run(code: &Both, image: &Box<[T]>, arrays: &Arrays<T>, outputs: &mut [T]) {
        if is_single::<T>() {
            code.function.call(arrays, outputs);
        } else {
            <Interpreted as Backend<T>>::run(&code.interpreted, image, arrays, outputs);
        }
    }
}
