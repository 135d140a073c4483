//! Machine code, called: the only place where anything is unsafe.
#![allow(unsafe_code)]

use std::any::TypeId;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use cranelift_jit::JITModule;
use cranelift_module::FuncId;
use liestep_late::{Array, Arrays, Program};

use crate::translated;

/// The arrays of the inputs, and the place of the outputs.
type Entry = unsafe extern "C" fn(*const *const f64, *mut f64);

/// A program as a function.
pub(crate) struct Function {
    entry: Entry,
    /// How many numbers it reads at least of each array that it reads.
    least: Vec<(Array, usize)>,
    outputs: usize,
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

/// Each program as a function, in one piece of memory.
pub(crate) fn functions(programs: &[&Program]) -> Result<Vec<Function>, String> {
    let (module, ids) = translated::module(programs)?;
    let entry = |id: FuncId| {
        let code = module.get_finalized_function(id);
        // SAFETY: the module has been finalised, so that this is the address of a function; `translated` has declared all
        // with the signature of `Entry` and the calling convention of C.
        unsafe { std::mem::transmute::<*const u8, Entry>(code) }
    };
    let entries: Vec<Entry> = ids.into_iter().map(entry).collect();
    let memory = Arc::new(Memory(Mutex::new(Some(module))));
    let function = |(entry, program): (Entry, &&Program)| Function {
        entry,
        least: translated::least(program),
        outputs: program.outputs.len(),
        memory: Arc::clone(&memory),
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
    pub(crate) fn call<T: 'static>(&self, arrays: &Arrays<T>, outputs: &mut [T]) {
        assert!(TypeId::of::<T>() == TypeId::of::<f64>(), "machine code is for `f64`");
        // A handful of comparisons, in release builds too: a call of this function is safe.
        assert!(self.least.iter().all(|&(array, least)| arrays.get(array).len() >= least), "an input is missing");
        assert!(outputs.len() >= self.outputs, "there is no place for the outputs");
        let inputs = arrays.all().map(|array| array.as_ptr().cast::<f64>());
        // SAFETY: the code reads pointers of `inputs` at places of arrays, of which it has as many; of an array the numbers
        // that `least` counts, which are there; and writes as many outputs as there is place for, that nobody else can see
        // while they are borrowed here. `T` is `f64`, as asserted, so the pointers have the right type and alignment. The
        // memory of the code is held by `self`.
        unsafe { (self.entry)(inputs.as_ptr(), outputs.as_mut_ptr().cast::<f64>()) };
    }
}
