//! Executable memory: one arena for the machine code of a process.
#![allow(unsafe_code)]

use std::collections::BTreeMap;
use std::ptr;
use std::sync::{Mutex, MutexGuard, PoisonError};

use region::Protection;

/// The most memory of machine code, bytes: address space that takes memory as it is filled, but on Windows, which sets it
/// aside at once.
pub const MOST_MEMORY: usize = if cfg!(windows) { 64 << 20 } else { 256 << 20 };

/// The memory of machine code, bytes. Code that is dropped gives its pages back to this process; code that finds none,
/// beyond [`MOST_MEMORY`], stays interpreted.
#[must_use]
pub fn used_memory() -> usize {
    arena().as_ref().map_or(0, |arena| arena.used)
}

/// Pages of one piece of code.
#[derive(Debug)]
pub(crate) struct Pages {
    offset: usize,
    size: usize,
}

struct Arena {
    /// The first address, whose pages are never given back to the system.
    base: usize,
    /// The beginning of what was never used.
    unused: usize,
    used: usize,
    /// Beginnings and sizes of pages that were given back.
    free: BTreeMap<usize, usize>,
}

static ARENA: Mutex<Option<Arena>> = Mutex::new(None);

fn arena() -> MutexGuard<'static, Option<Arena>> {
    ARENA.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Arena {
    fn new() -> Result<Self, String> {
        let mut memory = region::alloc(MOST_MEMORY, Protection::NONE).map_err(|error| error.to_string())?;
        let base = memory.as_mut_ptr::<u8>().expose_provenance();
        // Code lives as long as the process.
        std::mem::forget(memory);
        Ok(Self { base, unused: 0, used: 0, free: BTreeMap::new() })
    }

    /// Sets pages aside: the first that were given back, or new ones.
    fn take(&mut self, size: usize) -> Result<Pages, String> {
        let given_back = self.free.iter().find(|(_, free)| **free >= size).map(|(&offset, &free)| (offset, free));
        let offset = if let Some((offset, free)) = given_back {
            self.free.remove(&offset);
            if free > size {
                self.free.insert(offset + size, free - size);
            }
            offset
        } else if size <= MOST_MEMORY - self.unused {
            self.unused += size;
            self.unused - size
        } else {
            return Err(format!("machine code takes more than {MOST_MEMORY} bytes"));
        };
        self.used += size;
        Ok(Pages { offset, size })
    }

    fn give_back(&mut self, Pages { offset, size }: &Pages) {
        self.used -= size;
        let (mut begin, mut end) = (*offset, offset + size);
        let before = self.free.range(..begin).next_back().map(|(&before, &length)| (before, before + length));
        if let Some((before, _)) = before.filter(|(_, end)| *end == begin) {
            self.free.remove(&before);
            begin = before;
        }
        if let Some(length) = self.free.remove(&end) {
            end += length;
        }
        self.free.insert(begin, end - begin);
    }

    fn pointer(&self, pages: &Pages) -> *mut u8 {
        ptr::with_exposed_provenance_mut(self.base + pages.offset)
    }

    /// Copies code into pages, which are writable meanwhile, and makes them executable.
    fn fill(&self, pages: &Pages, code: &[u8]) -> Result<(), String> {
        let start = self.pointer(pages);
        let protect = |protection| {
            // SAFETY: the pages belong to the arena and to this piece of code alone, which nobody can call yet: no code that
            // runs loses the right to do so, and no borrowed memory changes its protection.
            unsafe { region::protect(start, pages.size, protection) }.map_err(|error| error.to_string())
        };
        protect(Protection::READ_WRITE)?;
        // SAFETY: the pages are writable, have at least as many bytes, and are nobody else's.
        unsafe { ptr::copy_nonoverlapping(code.as_ptr(), start, code.len()) };
        #[cfg(target_arch = "aarch64")]
        {
            use wasmtime_internal_jit_icache_coherence::{clear_cache, pipeline_flush_mt};
            // SAFETY: these bytes have just been written.
            unsafe { clear_cache(start.cast(), code.len()) }.map_err(|error| error.to_string())?;
            protect(Protection::READ_EXECUTE)?;
            return pipeline_flush_mt().map_err(|error| error.to_string());
        }
        #[cfg(not(target_arch = "aarch64"))]
        protect(Protection::READ_EXECUTE)
    }
}

impl Pages {
    /// Executable pages with this code.
    pub(crate) fn of(code: &[u8]) -> Result<Self, String> {
        let mut arena = arena();
        let arena = match &mut *arena {
            Some(arena) => arena,
            none => none.insert(Arena::new()?),
        };
        let pages = arena.take(code.len().max(1).next_multiple_of(region::page::size()))?;
        if let Err(error) = arena.fill(&pages, code) {
            arena.give_back(&pages);
            std::mem::forget(pages);
            return Err(error);
        }
        Ok(pages)
    }

    /// The address of the code, which is there as long as these pages are.
    pub(crate) fn start(&self) -> *const u8 {
        arena().as_ref().map_or(ptr::null(), |arena| arena.pointer(self).cast_const())
    }
}

impl Drop for Pages {
    fn drop(&mut self) {
        if let Some(arena) = &mut *arena() {
            arena.give_back(self);
        }
    }
}
