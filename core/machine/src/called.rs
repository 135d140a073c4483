//! Calls of machine code.
#![allow(unsafe_code)]

use std::any::TypeId;
use std::fmt;
use std::mem::MaybeUninit;

use liestep_late::{Array, Given, Program, StepInputs, UsualStep};
use simba::simd::AutoF64x8;

use crate::function::Literals;
use crate::memory::Pages;
use crate::{step, translated};

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
    /// The executable memory and the literals, which live as long as the function.
    _memory: (Pages, Literals),
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
        let (code, literals) = translated::program(program, LANES)?;
        let pages = Pages::of(&code)?;
        // SAFETY: the pages begin with code that `translated` has generated for the signature of `Entry` and the calling
        // convention of C; they are executable, and stay so as long as this function has them.
        let entry = unsafe { std::mem::transmute::<*const u8, Entry>(pages.start()) };
        let least = translated::least(program);
        let read = translated::given(&least).fold(0, |read, array| read | 1 << array as u16);
        Ok(Self { entry, least, read, outputs: program.outputs.len(), _memory: (pages, literals) })
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
            // the code and its literals are owned by `self`. Its frame, of 64 KiB at most, is on the stack of this thread:
            // code whose frame is larger than a page touches all its pages from the top down before it uses them, so that
            // a stack that is too short ends at its guard page, as that of any function of Rust does.
            unsafe { (self.entry)(constants, inputs.as_ptr().cast(), outputs) };
        }
    }
}

/// A function of a state, the constants, the parameters and the bounds of a step.
type StepEntry = unsafe extern "C" fn(*mut f64, *const f64, *const f64, *const f64) -> u64;

/// A usual step as a machine function.
pub(crate) struct StepFunction {
    entry: StepEntry,
    state: usize,
    constants: usize,
    parameters: usize,
    _memory: (Pages, Literals),
}

impl fmt::Debug for StepFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("StepFunction").field("state", &self.state).finish_non_exhaustive()
    }
}

impl StepFunction {
    pub(crate) fn of(usual: &UsualStep<'_, Program>) -> Result<Self, String> {
        let (code, literals) = step::code(usual)?;
        let pages = Pages::of(&code)?;
        // SAFETY: the pages begin with code that `step` has generated for the signature of `StepEntry` and the calling
        // convention of C; they are executable, and stay so as long as this function has them.
        let entry = unsafe { std::mem::transmute::<*const u8, StepEntry>(pages.start()) };
        let least = |array: Array| {
            let all = usual.programs().map(|program| translated::least(program)[array as usize]);
            all.max().unwrap_or(0)
        };
        let (constants, parameters) = (least(Array::Constants), least(Array::Parameters));
        Ok(Self { entry, state: usual.sizes.state(), constants, parameters, _memory: (pages, literals) })
    }

    /// Makes a step; zero if that isn't usual, or if a slice is shorter than the function reads. Then the state is as it was.
    #[inline]
    pub(crate) fn call<T: 'static>(&self, inputs: StepInputs<'_, T>, state: &mut [T]) -> u64 {
        let StepInputs { constants, parameters, bounds } = inputs;
        let is_there = state.len() >= self.state
            && constants.len() >= self.constants
            && parameters.len() >= self.parameters
            && lanes_of::<T>() == 1;
        if !is_there {
            return 0;
        }
        // SAFETY: `T` is `f64`. The code reads and writes as many numbers of the state as `sizes` counts, reads as many of
        // the constants and of the parameters as its programs do, and both bounds: all are there, and the state is borrowed
        // here alone. The memory of the code and its literals are owned by `self`. Its frame is bounded and touched as that of
        // `Function`.
        unsafe {
            (self.entry)(
                state.as_mut_ptr().cast(),
                constants.as_ptr().cast(),
                parameters.as_ptr().cast(),
                bounds.as_ptr().cast(),
            )
        }
    }
}
