//! Machine code, called: the only place where anything is unsafe.
#![allow(unsafe_code)]

use std::any::TypeId;
use std::fmt;
use std::mem::MaybeUninit;
use std::sync::{Arc, Mutex, PoisonError};

use cranelift_jit::JITModule;
use cranelift_module::FuncId;
use liestep_late::{Array, Given, Program};
use simba::simd::AutoF64x8;

use crate::translated;

/// The lanes of an ensemble.
pub(crate) const LANES: usize = 8;

/// The arrays of the inputs, and the place of the outputs.
type Entry = unsafe extern "C" fn(*const *const f64, *mut f64);

/// A program as a function.
pub(crate) struct Function {
    entry: Entry,
    /// How many numbers it reads at least of each array.
    least: [usize; Array::COUNT],
    /// A bit for each array that it reads.
    read: u16,
    outputs: usize,
    /// How many numbers stand at each place: one, or as many as there are lanes.
    lanes: usize,
    /// The code is there as long as one of its functions.
    memory: Arc<Memory>,
}

/// Executable memory.
struct Memory(Mutex<Option<JITModule>>);

impl Drop for Memory {
    fn drop(&mut self) {
        if let Some(module) = self.0.lock().unwrap_or_else(PoisonError::into_inner).take() {
            // SAFETY: every function of the module holds this memory, and `entry` isn't handed out: none is left that
            // could be called, and none is running, as a call borrows its function.
            unsafe { module.free_memory() };
        }
    }
}

impl fmt::Debug for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { least, outputs, memory, .. } = self;
        let functions = Arc::strong_count(memory);
        f.debug_struct("Function").field("least", least).field("outputs", outputs).field("of", &functions).finish()
    }
}

/// How many numbers a value of this type is: those of other types are none that machine code knows.
pub(crate) fn lanes_of<T: 'static>() -> usize {
    match TypeId::of::<T>() {
        one if one == TypeId::of::<f64>() => 1,
        eight if eight == TypeId::of::<AutoF64x8>() && size_of::<T>() == 8 * size_of::<f64>() => LANES,
        _ => 0,
    }
}

/// Each program as a function, of numbers or of lanes, in one piece of memory.
pub(crate) fn functions(programs: &[&Program], lanes: usize) -> Result<Vec<Function>, String> {
    let (module, ids) = translated::module(programs, lanes)?;
    let entry = |id: FuncId| {
        let code = module.get_finalized_function(id);
        // SAFETY: the module has been finalised, so that this is the address of a function; `translated` has declared all
        // with the signature of `Entry` and the calling convention of C.
        unsafe { std::mem::transmute::<*const u8, Entry>(code) }
    };
    let entries: Vec<Entry> = ids.into_iter().map(entry).collect();
    let memory = Arc::new(Memory(Mutex::new(Some(module))));
    let function = |(entry, program): (Entry, &&Program)| {
        let (mut least, mut read) = ([0; Array::COUNT], 0);
        for (array, count) in translated::least(program) {
            least[array as usize] = count;
            read |= 1 << array as u16;
        }
        Function { entry, least, read, outputs: program.outputs.len(), lanes, memory: Arc::clone(&memory) }
    };
    Ok(entries.into_iter().zip(programs).map(function).collect())
}

impl Function {
    /// Calls it.
    ///
    /// # Panics
    ///
    /// Where an array is shorter than what is read of it, or outputs than what is written: then nothing is called.
    #[inline]
    pub(crate) fn call<T: 'static, const N: usize>(&self, given: Given<'_, T, N>, outputs: &mut [T]) {
        assert!(self.lanes == lanes_of::<T>(), "machine code is for `f64`, or for eight of them");
        // A handful of comparisons, in release builds too: a call of this function is safe. What isn't read isn't set.
        let mut inputs = [const { MaybeUninit::<*const f64>::uninit() }; Array::COUNT];
        let (mut missing, mut is_there) = (self.read, outputs.len() >= self.outputs);
        for (array, numbers) in given {
            missing &= !(1 << array as u16);
            is_there &= numbers.len() >= self.least[array as usize];
        }
        assert!(missing == 0 && is_there, "an input is missing, or a place for the outputs");
        // Two lanes at a time.
        for first in (0..lanes_of::<T>()).step_by(2) {
            for (array, numbers) in given {
                inputs[array as usize] = MaybeUninit::new(numbers.as_ptr().cast::<f64>().wrapping_add(first));
            }
            let outputs = outputs.as_mut_ptr().cast::<f64>().wrapping_add(first);
            // SAFETY: the code reads pointers of `inputs` at places of arrays that are in `read`, all of which are given and
            // set; of an array the numbers that `least` counts, which are there; and writes as many outputs as there is
            // place for, that nobody else can see while they are borrowed here. `T` is `f64`, or an array of as many as the
            // code was made for, as asserted, of which it reads and writes two from `first` on: so the pointers have the
            // right type and alignment. The memory of the code is held by `self`.
            unsafe { (self.entry)(inputs.as_ptr().cast(), outputs) };
        }
    }
}
