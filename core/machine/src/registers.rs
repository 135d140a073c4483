//! The assignment of a program's values to registers and memory.

use std::cmp::Reverse;

use cranelift_codegen::ir::{InstBuilder as _, MemFlagsData, StackSlot, StackSlotData, StackSlotKind, Type, Value};
use cranelift_frontend::FunctionBuilder;

/// The most values in registers at once. One more is loaded, and one computed.
const MOST: usize = if cfg!(target_arch = "aarch64") { 28 } else { 14 };

/// The place of a value in memory: a pointer and an offset.
pub(crate) type Place = (Value, i32);

/// The values of a program, while its code is generated.
///
/// If there are too many for the registers, the value whose next use is the latest leaves its own. Such a value is
/// stored once, and operations read it from memory, as they read inputs. Cranelift would load it into a register for
/// each operation.
pub(crate) struct Registers {
    pub(crate) number: Type,
    pub(crate) flags: MemFlagsData,
    held: Vec<(usize, Value)>,
    /// The place of each value in memory, if it has one.
    places: Vec<Option<Place>>,
    /// The times of each value's reads, the next last.
    reads: Vec<Vec<usize>>,
    frame: Frame,
    /// The bytes of the frame that belong to others, and those that are set aside.
    own: i32,
    set_aside: u32,
    /// Places in the frame whose values aren't read again.
    free: Vec<i32>,
}

/// The frame of a function, which grows with the stored values.
#[derive(Clone, Copy)]
pub(crate) struct Frame {
    slot: StackSlot,
    pub(crate) start: Value,
}

/// The largest frame, bytes: a small part of the stack of any thread.
const LARGEST_FRAME: u32 = 64 << 10;

impl Frame {
    /// A frame that begins with so many bytes.
    pub(crate) fn new(builder: &mut FunctionBuilder, pointer: Type, size: u32) -> Self {
        let slot = builder.create_sized_stack_slot(StackSlotData::new(StackSlotKind::ExplicitSlot, size, 4));
        let start = builder.ins().stack_addr(pointer, slot, 0);
        Self { slot, start }
    }

    /// Checks that a stack has room for it.
    pub(crate) fn check(self, builder: &FunctionBuilder) -> Result<(), String> {
        let size = builder.func.sized_stack_slots[self.slot].size;
        let most = LARGEST_FRAME;
        if size <= most { Ok(()) } else { Err(format!("a frame of {size} bytes is larger than {most}")) }
    }
}

impl Registers {
    /// Values, some with places; `reads` has the times at which each is read, the next one last. The first bytes of the
    /// frame belong to others.
    pub(crate) fn new(
        number: Type,
        flags: MemFlagsData,
        (frame, set_aside): (Frame, u32),
        places: Vec<Option<Place>>,
        reads: Vec<Vec<usize>>,
    ) -> Self {
        let own = set_aside.cast_signed();
        Self { number, flags, held: Vec::new(), places, reads, frame, own, set_aside, free: Vec::new() }
    }

    /// Two values for an operation that reads them now: the first in a register, the second in a register or from
    /// memory.
    pub(crate) fn read(
        &mut self,
        builder: &mut FunctionBuilder,
        [mut first, mut second]: [usize; 2],
        commutes: bool,
    ) -> Result<[Value; 2], String> {
        self.reads[first].pop();
        if second != first {
            self.reads[second].pop();
        }
        // If both are in memory, the one that is read again sooner gets a register.
        let soon = |at: usize| (self.held(at).is_some(), self.reads[at].last().map(|&at| Reverse(at)));
        if commutes && soon(second) > soon(first) {
            (first, second) = (second, first);
        }
        let a = if let Some(value) = self.held(first) {
            value
        } else {
            let value = self.load(builder, first)?;
            self.hold(builder, first, value);
            value
        };
        let b = if second == first { a } else { self.held(second).map_or_else(|| self.load(builder, second), Ok)? };
        for at in [first, second] {
            if self.reads[at].is_empty() {
                self.held.retain(|&(one, _)| one != at);
                let place = self.places[at].take_if(|place| place.0 == self.frame.start && place.1 >= self.own);
                self.free.extend(place.map(|place| place.1));
            }
        }
        Ok([a, b])
    }

    fn held(&self, at: usize) -> Option<Value> {
        self.held.iter().find(|&&(one, _)| one == at).map(|&(_, value)| value)
    }

    fn load(&self, builder: &mut FunctionBuilder, at: usize) -> Result<Value, String> {
        let (array, offset) = self.places[at].ok_or("a program reads what it hasn't computed")?;
        Ok(builder.ins().load(self.number, self.flags, array, offset))
    }

    /// Adds a result.
    pub(crate) fn compute(&mut self, builder: &mut FunctionBuilder, at: usize, value: Value) {
        // Cranelift lets an operation read from memory only if its result is read once: here by the block, whose
        // parameter is read often.
        let is_read_often = self.reads[at].len() > 1;
        let value = if is_read_often {
            let next = builder.create_block();
            builder.ins().jump(next, &[value.into()]);
            builder.switch_to_block(next);
            builder.seal_block(next);
            builder.append_block_param(next, self.number)
        } else {
            value
        };
        self.hold(builder, at, value);
    }

    fn hold(&mut self, builder: &mut FunctionBuilder, at: usize, value: Value) {
        if !self.reads[at].is_empty() {
            self.held.push((at, value));
            self.leave(builder, MOST);
        }
    }

    /// Leaves this number of values in registers, those that are read next.
    pub(crate) fn leave(&mut self, builder: &mut FunctionBuilder, most: usize) {
        while self.held.len() > most {
            let next = |&(_, &(at, _)): &(usize, &(usize, Value))| self.reads[at].last().copied();
            let Some((last, _)) = self.held.iter().enumerate().max_by_key(next) else { return };
            let (at, value) = self.held.swap_remove(last);
            if self.places[at].is_none() {
                let offset = self.free.pop().unwrap_or_else(|| {
                    let (slot, place) = (&mut builder.func.sized_stack_slots[self.frame.slot], self.set_aside);
                    self.set_aside += self.number.bytes();
                    slot.size = slot.size.max(self.set_aside);
                    place.cast_signed()
                });
                builder.ins().store(self.flags, value, self.frame.start, offset);
                self.places[at] = Some((self.frame.start, offset));
            }
        }
    }
}
