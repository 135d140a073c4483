//! Calls of machine code: the only place where anything is unsafe.
#![allow(unsafe_code)]

use std::any::TypeId;
use std::fmt;
use std::mem::MaybeUninit;
use std::sync::{Mutex, PoisonError};

use cranelift_jit::JITModule;
use liestep_late::{Array, Given, Program};
use simba::simd::AutoF64x8;

use crate::translated;

/// The number of lanes of an ensemble.
pub(crate) const LANES: usize = 8;

/// A function of the constants, of the arrays of the other inputs, and of the array of outputs.
type Entry = unsafe extern "C" fn(*const f64, *const *const f64, *mut f64);

/// A program as a machine function: of numbers, or of as many lanes.
pub(crate) struct Function<const LANES: usize> {
    entry: Entry,
    /// The least length of each array.
    least: [usize; Array::COUNT],
    /// A bit for each array that a call has to pass.
    read: u16,
    outputs: usize,
    /// The executable memory, which lives as long as the function.
    memory: Mutex<Option<JITModule>>,
}

impl<const LANES: usize> Drop for Function<LANES> {
    fn drop(&mut self) {
        if let Some(module) = self.memory.get_mut().unwrap_or_else(PoisonError::into_inner).take() {
            // SAFETY: this is the only function of the module, and `entry` isn't handed out: none is left that could be
            // called, and none is running, as a call borrows it.
            unsafe { module.free_memory() };
        }
    }
}

impl<const LANES: usize> fmt::Debug for Function<LANES> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Function").field("least", &self.least).field("outputs", &self.outputs).finish_non_exhaustive()
    }
}

/// The number of lanes of a value of this type; zero for types without machine code.
pub(crate) fn lanes_of<T: 'static>() -> usize {
    match TypeId::of::<T>() {
        one if one == TypeId::of::<f64>() => 1,
        eight if eight == TypeId::of::<AutoF64x8>() && size_of::<T>() == 8 * size_of::<f64>() => LANES,
        _ => 0,
    }
}

impl<const LANES: usize> Function<LANES> {
    pub(crate) fn of(program: &Program) -> Result<Self, String> {
        let (module, id) = translated::module(program, LANES)?;
        let code = module.get_finalized_function(id);
        // SAFETY: the module has been finalised, so that this is the address of a function; `translated` has declared it
        // with the signature of `Entry` and the calling convention of C.
        let entry = unsafe { std::mem::transmute::<*const u8, Entry>(code) };
        let least = translated::least(program);
        let read = translated::given(&least).fold(0, |read, array| read | 1 << array as u16);
        let memory = Mutex::new(Some(module));
        Ok(Self { entry, least, read, outputs: program.outputs.len(), memory })
    }

    /// Calls the function with constants and the other inputs.
    ///
    /// # Panics
    ///
    /// If it isn't a function of `T`, an array is missing or too short, or the outputs are: then nothing is called.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn call<T: 'static, const N: usize>(&self, constants: &[T], given: Given<'_, T, N>, outputs: &mut [T]) {
        // A handful of comparisons, also in release builds, makes a call safe. Pointers that aren't read stay
        // uninitialised.
        let mut inputs = [const { MaybeUninit::<*const f64>::uninit() }; Array::COUNT];
        let (mut missing, mut is_there) = (self.read, outputs.len() >= self.outputs);
        is_there = is_there && lanes_of::<T>() == LANES && constants.len() >= self.least[Array::Constants as usize];
        for (array, numbers) in &given {
            missing &= !(1 << *array as u16);
            is_there = is_there && numbers.len() >= self.least[*array as usize];
        }
        assert!(missing == 0 && is_there, "an input is missing, or a place for the outputs, or it is of other numbers");
        // Two lanes at a time.
        for first in (0..lanes_of::<T>()).step_by(2) {
            for (array, numbers) in &given {
                inputs[*array as usize] = MaybeUninit::new(numbers.as_ptr().cast::<f64>().wrapping_add(first));
            }
            let constants = constants.as_ptr().cast::<f64>().wrapping_add(first);
            let outputs = outputs.as_mut_ptr().cast::<f64>().wrapping_add(first);
            // SAFETY: the code reads pointers of `inputs` at places of arrays that are in `read`, all of which are
            // passed and set; it reads as many numbers of an array as `least` counts, which are there, as those of the
            // constants are; and it writes as many outputs as there is place for, which nobody else can access while
            // they are borrowed here. `T` is `f64`, or an array of as many as the code was compiled for, of which it
            // reads and writes two from `first` on: so the pointers have the right type and alignment. The memory of
            // the code is owned by `self`.
            unsafe { (self.entry)(constants, inputs.as_ptr().cast(), outputs) };
        }
    }
}
