//! Pieces of straight-line code: values of one or several programs, and the order in which they are computed and stored.

use std::collections::BTreeMap;

use cranelift_codegen::ir::{InstBuilder as _, Value};
use cranelift_frontend::FunctionBuilder;
use liestep_late::{Operation, Program, Source};

use crate::operation::{Callee, both, result};
use crate::registers::{Place, Registers};

/// The origin of a value.
#[derive(Clone, Copy)]
enum Origin {
    Given(Place),
    Result(Operation<usize>),
}

/// A part of the generated code.
enum Part {
    Result(usize),
    /// The store of a value, or of two next to each other.
    Store(usize, Option<usize>, Place),
    /// A value for what decides.
    Take(usize),
    /// The end of what is written in one go.
    Stop,
}

/// Values, and the parts that compute them.
#[derive(Default)]
pub(crate) struct Piece {
    values: Vec<Origin>,
    given: BTreeMap<Place, usize>,
    is_made: Vec<bool>,
    /// The numbers of results that still have to read each value.
    readers: Vec<usize>,
    parts: Vec<Part>,
    /// Stores that wait until nobody reads their places.
    waiting: Vec<(usize, Place)>,
}

impl Piece {
    fn push(&mut self, origin: Origin) -> usize {
        self.is_made.push(matches!(origin, Origin::Given(_)));
        self.values.push(origin);
        self.readers.push(0);
        self.values.len() - 1
    }

    /// The value at a place.
    pub(crate) fn given(&mut self, place: Place) -> usize {
        if let Some(&value) = self.given.get(&place) {
            return value;
        }
        let value = self.push(Origin::Given(place));
        self.given.insert(place, value);
        value
    }

    /// The outputs of a program with these inputs and literals.
    pub(crate) fn append(
        &mut self,
        program: &Program,
        mut input: impl FnMut(&mut Self, Source) -> Result<usize, String>,
        mut literal: impl FnMut(usize, f64) -> Result<Place, String>,
    ) -> Result<Vec<usize>, String> {
        let mut values = Vec::new();
        for &source in &program.inputs {
            values.push(input(self, source)?);
        }
        for (at, &number) in program.literals.iter().enumerate() {
            let place = literal(at, number)?;
            values.push(self.given(place));
        }
        for operation in &program.operations {
            let operation = operation.of(operation.operands().map(|at| values[at]));
            self.count(operation, |readers| *readers += 1);
            values.push(self.push(Origin::Result(operation)));
        }
        Ok(program.outputs.iter().map(|&at| values[at as usize]).collect())
    }

    /// Changes the numbers of readers of what an operation reads.
    fn count(&mut self, operation: Operation<usize>, change: impl Fn(&mut usize)) {
        let [first, second] = operation.read();
        change(&mut self.readers[first]);
        if second != first {
            change(&mut self.readers[second]);
        }
    }

    fn operands(&self, value: usize) -> Option<[usize; 2]> {
        match self.values[value] {
            Origin::Given(_) => None,
            Origin::Result(operation) => Some(operation.read()),
        }
    }

    /// Computes these values and what they need.
    pub(crate) fn need(&mut self, wanted: &[usize]) {
        let last = wanted.iter().copied().max().unwrap_or(0);
        let mut is_needed = vec![false; last + 1];
        for &value in wanted {
            is_needed[value] = true;
        }
        for value in (0..=last).rev().filter(|&value| !self.is_made[value]) {
            if let Some(operands) = self.operands(value).filter(|_| is_needed[value]) {
                for operand in operands {
                    is_needed[operand] = true;
                }
            }
        }
        self.make((0..=last).filter(|&value| is_needed[value]).collect());
    }

    /// Computes all values up to this one.
    pub(crate) fn need_up_to(&mut self, value: usize) {
        self.make((0..=value).collect());
    }

    fn make(&mut self, values: Vec<usize>) {
        for value in values {
            if std::mem::replace(&mut self.is_made[value], true) {
                continue;
            }
            if let Origin::Result(operation) = self.values[value] {
                self.count(operation, |readers| *readers -= 1);
                self.parts.push(Part::Result(value));
            }
        }
        self.store_what_waits();
    }

    /// Stores a value, or two next to each other, which have to be computed.
    pub(crate) fn store(&mut self, value: usize, next: Option<usize>, place: Place) {
        self.parts.push(Part::Store(value, next, place));
    }

    /// Stores a value as soon as no other one has to be read from this place.
    pub(crate) fn replace(&mut self, value: usize, place: Place) {
        let is_there = self.given.get(&place) == Some(&value);
        if !is_there {
            self.waiting.push((value, place));
        }
    }

    fn store_what_waits(&mut self) {
        loop {
            let is_read = |at: &usize, place: &Place| {
                let Some(given) = self.given.get(place) else { return false };
                let by_store = |(other, &(value, _)): (usize, &(usize, Place))| other != *at && value == *given;
                self.readers[*given] > 0 || self.waiting.iter().enumerate().any(by_store)
            };
            let mut waiting = self.waiting.iter().enumerate();
            let next = waiting.position(|(at, (value, place))| self.is_made[*value] && !is_read(&at, place));
            let Some(next) = next else { return };
            let (value, place) = self.waiting.remove(next);
            self.parts.push(Part::Store(value, None, place));
        }
    }

    /// Hands computed values to what decides after this part.
    pub(crate) fn take(&mut self, values: &[usize]) {
        self.parts.extend(values.iter().map(|&value| Part::Take(value)));
    }

    /// Ends what is written in one go.
    pub(crate) fn stop(&mut self) {
        self.parts.push(Part::Stop);
    }

    /// Begins to write, with the registers of a function.
    pub(crate) fn begin(
        self,
        new: impl FnOnce(Vec<Option<Place>>, Vec<Vec<usize>>) -> Registers,
    ) -> Result<PieceWriter, String> {
        if !self.waiting.is_empty() {
            return Err("places of a state wait for each other".to_owned());
        }
        let mut reads = vec![Vec::new(); self.values.len()];
        for (time, part) in self.parts.iter().enumerate().rev() {
            let read = match *part {
                Part::Result(value) => self.operands(value),
                Part::Store(value, next, _) => Some([value, next.unwrap_or(value)]),
                Part::Take(value) => Some([value; 2]),
                Part::Stop => None,
            };
            if let Some([first, second]) = read {
                reads[first].push(time);
                if second != first {
                    reads[second].push(time);
                }
            }
        }
        let places = self.values.iter().map(|origin| match origin {
            Origin::Given(place) => Some(*place),
            Origin::Result(_) => None,
        });
        let registers = new(places.collect(), reads);
        Ok(PieceWriter { values: self.values, parts: self.parts.into_iter(), registers })
    }
}

/// A piece that is being written.
pub(crate) struct PieceWriter {
    values: Vec<Origin>,
    parts: std::vec::IntoIter<Part>,
    registers: Registers,
}

impl PieceWriter {
    /// Writes up to the next end; returns the values that were taken.
    pub(crate) fn write(&mut self, builder: &mut FunctionBuilder, callee: &Callee) -> Result<Vec<Value>, String> {
        let mut taken = Vec::new();
        for part in self.parts.by_ref() {
            match part {
                Part::Stop => break,
                Part::Take(value) => taken.push(self.registers.read(builder, [value; 2], false)?[0]),
                Part::Store(value, next, (array, offset)) => {
                    let [first, second] = self.registers.read(builder, [value, next.unwrap_or(value)], false)?;
                    let stored = if next.is_some() { both(builder, first, second) } else { first };
                    builder.ins().store(self.registers.flags, stored, array, offset);
                }
                Part::Result(value) => {
                    let Origin::Result(operation) = self.values[value] else { continue };
                    let commutes = matches!(operation, Operation::Add(..) | Operation::Multiply(..));
                    let operands = self.registers.read(builder, operation.read(), commutes)?;
                    let made = result(builder, &mut self.registers, operation, operands, callee)?;
                    self.registers.compute(builder, value, made);
                }
            }
        }
        Ok(taken)
    }
}
