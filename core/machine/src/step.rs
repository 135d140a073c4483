//! A usual step as one function: target, iterations and the state after them, with the decisions of the driver.
//!
//! ```text
//! first ── head: iterate ──────┬── settled: finish ── store
//!           ↑    │ near enough │
//!           └────┴── again ────┘
//! ```
//!
//! What isn't usual returns zero before anything is stored. Numbers between the parts are in the frame: right side, iterate and
//! the bound of the determinant.

use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{Block, BlockArg, InstBuilder as _, Type, Value, types};
use cranelift_frontend::FunctionBuilder;
use liestep::__private::{MAX_ITERATIONS, NEAR_ENOUGH, SETTLED, SUFFICIENT, safe};
use liestep_late::{Array, Program, Sizes, Source, UsualStep};

use crate::function::{Literals, code as code_of, flags, offset};
use crate::operation::Callee;
use crate::piece::{Piece, PieceWriter};
use crate::registers::{Frame, Place, Registers};

/// The numbers that decisions compare with.
struct Bounds {
    settled: f64,
    near_enough: f64,
    sufficient: f64,
    safe: f64,
}

impl Bounds {
    fn new() -> Self {
        let square = |part: f64| (f64::EPSILON * part) * (f64::EPSILON * part);
        Self {
            settled: f64::EPSILON * SETTLED,
            near_enough: square(NEAR_ENOUGH),
            sufficient: square(SUFFICIENT),
            safe: safe(1.0),
        }
    }

    fn list(&self) -> [f64; 7] {
        [self.settled, self.near_enough, self.sufficient, self.safe, 1.0, 4.0, 9.0]
    }
}

/// The machine code of a usual step: a function of the state, the constants, the parameters, and the two bounds of
/// [`StepInputs`](liestep_late::StepInputs). It returns twice the number of iterations, plus one if the increment is far from
/// the identity; or zero.
pub(crate) fn code(usual: &UsualStep<'_, Program>) -> Result<(Vec<u8>, Literals), String> {
    let bounds = Bounds::new();
    let mut numbers: Vec<f64> = bounds.list().to_vec();
    numbers.extend(usual.programs().flat_map(|program| &program.literals));
    numbers.sort_by(f64::total_cmp);
    numbers.dedup_by_key(|number| number.to_bits());
    let literals = Literals::of(&numbers);
    let code = code_of(4, Some(types::I64), |builder, pointer, callee| {
        let block = builder.current_block().ok_or("no block")?;
        let [state, constants, parameters, given] = [0, 1, 2, 3].map(|at| builder.block_params(block)[at]);
        let frame = Frame::new(builder, pointer, 8 * u32::try_from(2 * usual.sizes.n + 1).unwrap_or(u32::MAX / 8));
        let literals = literals.start(builder, pointer);
        let [none, head, settled] = [(); 3].map(|()| builder.create_block());
        let mut step = Step {
            builder,
            usual,
            callee,
            pointer,
            state,
            tables: [constants, parameters, given, literals],
            numbers: &numbers,
            frame,
            none,
        };
        step.first(head)?;
        step.iterate(&bounds, head, settled)?;
        step.finish(settled)?;
        step.builder.switch_to_block(none);
        let nothing = step.builder.ins().iconst(types::I64, 0);
        step.builder.ins().return_(&[nothing]);
        frame.check(builder)
    })?;
    Ok((code, literals))
}

struct Step<'a, 'b> {
    builder: &'a mut FunctionBuilder<'b>,
    usual: &'a UsualStep<'a, Program>,
    callee: &'a Callee,
    pointer: Type,
    state: Value,
    /// The addresses of constants, parameters, bounds and literals.
    tables: [Value; 4],
    /// The literals in order.
    numbers: &'a [f64],
    frame: Frame,
    /// The block of what isn't usual.
    none: Block,
}

impl Step<'_, '_> {
    fn sizes(&self) -> &Sizes {
        self.usual.sizes
    }

    fn literal(&self, number: f64) -> Result<Place, String> {
        let place = self.numbers.binary_search_by(|one| one.total_cmp(&number));
        Ok((self.tables[3], offset(place.map_err(|_| "a literal is missing")?, 1)?))
    }

    fn load(&mut self, (array, offset): Place) -> Value {
        self.builder.ins().load(types::F64, flags(), array, offset)
    }

    fn known(&mut self, number: f64) -> Result<Value, String> {
        let place = self.literal(number)?;
        Ok(self.load(place))
    }

    /// The places of the frame: right side, iterate, and the bound of the determinant.
    fn target(&self, at: usize) -> Result<Place, String> {
        Ok((self.frame.start, offset(at, 1)?))
    }

    fn half(&self, at: usize) -> Result<Place, String> {
        self.target(self.sizes().n + at)
    }

    fn safe(&self) -> Result<Place, String> {
        if self.usual.safe.is_some() { self.target(2 * self.sizes().n) } else { Ok((self.tables[2], 0)) }
    }

    /// The place of an input: in the state, in the frame or in a table.
    fn place(&self, Source { array, at }: Source) -> Result<Place, String> {
        let sizes = self.sizes();
        let in_state = |first: usize, count: usize| {
            let place = (at < count).then_some(first + at).ok_or("a program reads beyond a state")?;
            Ok((self.state, offset(place, 1)?))
        };
        match array {
            Array::Constants => Ok((self.tables[0], offset(at, 1)?)),
            Array::Parameters => Ok((self.tables[1], offset(at, 1)?)),
            Array::Attitude => in_state(0, sizes.entries),
            Array::Momentum => in_state(sizes.momentum(), sizes.n),
            Array::Advected => in_state(sizes.advected(), sizes.carried),
            Array::History => in_state(sizes.history(), 2 * sizes.n),
            Array::Target if at < sizes.n => self.target(at),
            Array::Half if at < sizes.n => self.half(at),
            _ => Err(format!("{array:?} isn't there in a usual step")),
        }
    }

    fn append(&self, piece: &mut Piece, program: &Program) -> Result<Vec<usize>, String> {
        let input = |piece: &mut Piece, source| Ok(piece.given(self.place(source)?));
        piece.append(program, input, |_, number| self.literal(number))
    }

    fn begin(&self, piece: Piece) -> Result<PieceWriter, String> {
        let own = 8 * u32::try_from(2 * self.sizes().n + 1).map_err(|_| "a frame is too large")?;
        piece.begin(|places, reads| Registers::new(types::F64, flags(), (self.frame, own), places, reads))
    }

    fn write(&mut self, writing: &mut PieceWriter) -> Result<Vec<Value>, String> {
        writing.write(self.builder, self.callee)
    }

    /// The determinant of a matrix by those of its blocks, as the driver has it.
    fn determinant(&mut self, pairs: &[Value]) -> Value {
        if !self.usual.is_product {
            return pairs[0];
        }
        let zero = self.builder.ins().f64const(0.0);
        let one = self.builder.ins().f64const(1.0);
        let (mut value, mut is_negative) = (one, None);
        for pair in pairs.chunks_exact(2) {
            let size = self.builder.ins().fabs(pair[1]);
            let part = self.builder.ins().fdiv(pair[0], size);
            value = self.builder.ins().fmul(value, part);
            let is = self.builder.ins().fcmp(FloatCC::LessThan, pair[0], zero);
            is_negative = Some(is_negative.map_or(is, |before| self.builder.ins().bor(before, is)));
        }
        let Some(is_negative) = is_negative else { return value };
        let size = self.builder.ins().fabs(value);
        let negative = self.builder.ins().fneg(size);
        self.builder.ins().select(is_negative, negative, value)
    }

    /// The determinants of a matrix among its outputs: all pairs, or a single block's own.
    fn determinants<'v>(&self, outputs: &'v [usize]) -> &'v [usize] {
        &outputs[..if self.usual.is_product { 2 * self.sizes().dets } else { 1 }]
    }

    fn times(&mut self, value: Value, number: f64) -> Result<Value, String> {
        let number = self.known(number)?;
        Ok(self.builder.ins().fmul(value, number))
    }

    fn compare(&mut self, is: FloatCC, a: Value, b: Value) -> Value {
        self.builder.ins().fcmp(is, a, b)
    }

    /// The right side and the bound of the determinant, then the first iterate.
    fn first(&mut self, head: Block) -> Result<(), String> {
        let (usual, n) = (self.usual, self.sizes().n);
        let mut piece = Piece::default();
        let target = self.append(&mut piece, usual.target)?;
        piece.need(&target);
        for (at, &value) in target[..n].iter().enumerate() {
            piece.store(value, None, self.target(at)?);
        }
        piece.take(&target[n..=n]);
        if let Some(safe) = usual.safe {
            let outputs = self.append(&mut piece, safe)?;
            piece.need(&outputs);
            piece.take(self.determinants(&outputs));
        }
        piece.stop();
        let mut writing = self.begin(piece)?;
        let taken = self.write(&mut writing)?;
        if usual.safe.is_some() {
            let determinant = self.determinant(&taken[1..]);
            let bound = self.times(determinant, safe(1.0))?;
            let (frame, offset) = self.safe()?;
            self.builder.ins().store(flags(), bound, frame, offset);
        }
        let largest = self.load((self.tables[2], 8));
        let is_usual = self.compare(FloatCC::LessThan, taken[0], largest);
        let guess = i64::from(offset(self.sizes().guess(), 1)?);
        let guess = self.builder.ins().iadd_imm_s(self.state, guess);
        let none = self.builder.ins().iconst(types::I64, 0);
        self.builder.ins().brif(is_usual, head, &[guess.into(), none.into()], self.none, &[]);
        self.builder.append_block_param(head, self.pointer);
        self.builder.append_block_param(head, types::I64);
        Ok(())
    }

    /// Iterations from the iterate at an address, until one settles.
    fn iterate(&mut self, bounds: &Bounds, head: Block, settled: Block) -> Result<(), String> {
        let (usual, n) = (self.usual, self.sizes().n);
        let [near, again, retry] = [(); 3].map(|()| self.builder.create_block());
        for ty in [types::F64, types::I64] {
            self.builder.append_block_param(settled, ty);
        }
        self.builder.switch_to_block(head);
        let [half, count] = [0, 1].map(|at| self.builder.block_params(head)[at]);
        let mut piece = Piece::default();
        let input = |piece: &mut Piece, source: Source| match source.array {
            Array::Half => Ok(piece.given((half, offset(source.at, 1)?))),
            _ => Ok(piece.given(self.place(source)?)),
        };
        let next = piece.append(usual.iterate, input, |_, number| self.literal(number))?;
        let input = |piece: &mut Piece, source: Source| match source.array {
            Array::Half => next.get(source.at).copied().ok_or("an iterate is missing".to_owned()),
            Array::Factors => next.get(n + 2 + source.at).copied().ok_or("a factor is missing".to_owned()),
            _ => Ok(piece.given(self.place(source)?)),
        };
        piece.need(&next);
        let second = piece.append(usual.again, input, |_, number| self.literal(number))?;
        for (at, &value) in next[..n].iter().enumerate() {
            piece.store(value, None, self.half(at)?);
        }
        piece.take(&next[n..n + 2]);
        piece.take(self.determinants(&next[n + 2..]));
        piece.stop();
        piece.need(&second);
        for (at, &value) in second[..n].iter().enumerate() {
            piece.store(value, None, self.half(at)?);
        }
        piece.take(&second[n..n + 2]);
        piece.stop();
        let mut writing = self.begin(piece)?;

        let taken = self.write(&mut writing)?;
        let (first, size) = (taken[0], taken[1]);
        let determinant = self.determinant(&taken[2..]);
        let count = self.builder.ins().iadd_imm_s(count, 1);
        let bound = self.times(size, bounds.settled)?;
        let is_settled = self.compare(FloatCC::LessThanOrEqual, first, bound);
        let end = |count: Value| -> [BlockArg; 2] { [determinant.into(), count.into()] };
        self.builder.ins().brif(is_settled, settled, &end(count), near, &[]);

        self.builder.switch_to_block(near);
        let square = self.builder.ins().fmul(first, first);
        let cube = self.builder.ins().fmul(square, first);
        let bound = self.times(size, bounds.near_enough)?;
        let is_near = self.compare(FloatCC::LessThanOrEqual, cube, bound);
        let bound = self.safe()?;
        let bound = self.load(bound);
        let is_safe = self.compare(FloatCC::GreaterThan, determinant, bound);
        let both = self.builder.ins().band(is_near, is_safe);
        self.builder.ins().brif(both, again, &[], retry, &[]);

        self.builder.switch_to_block(again);
        let taken = self.write(&mut writing)?;
        let (change, size) = (taken[0], taken[1]);
        let ratio = self.builder.ins().fdiv(change, first);
        // A ratio that isn't a number has a change that isn't one.
        let is_larger = self.compare(FloatCC::GreaterThan, first, ratio);
        let larger = self.builder.ins().select(is_larger, first, ratio);
        let rest = self.builder.ins().fmul(change, larger);
        let bound = self.times(size, bounds.sufficient)?;
        let has_sufficed = self.compare(FloatCC::LessThanOrEqual, rest, bound);
        let both = self.builder.ins().iadd_imm_s(count, 1);
        self.builder.ins().brif(has_sufficed, settled, &end(both), retry, &[]);

        self.builder.switch_to_block(retry);
        let goes_on = self.builder.ins().icmp_imm_s(IntCC::SignedLessThan, count, i64::from(MAX_ITERATIONS));
        let place = i64::from(self.half(0)?.1);
        let half = self.builder.ins().iadd_imm_s(self.frame.start, place);
        self.builder.ins().brif(goes_on, head, &[half.into(), count.into()], self.none, &[]);
        Ok(())
    }

    /// The state after a solution, if that is usual.
    fn finish(&mut self, settled: Block) -> Result<(), String> {
        let (usual, sizes) = (self.usual, self.sizes().clone());
        let [finish, store] = [(); 2].map(|()| self.builder.create_block());
        self.builder.switch_to_block(settled);
        let [determinant, count] = [0, 1].map(|at| self.builder.block_params(settled)[at]);
        let zero = self.builder.ins().f64const(0.0);
        let is_positive = self.compare(FloatCC::GreaterThan, determinant, zero);
        self.builder.ins().brif(is_positive, finish, &[], self.none, &[]);

        self.builder.switch_to_block(finish);
        let mut piece = Piece::default();
        let outputs = self.append(&mut piece, usual.finish)?;
        let (next, others) = outputs.split_at(sizes.state() - 1);
        piece.need(others);
        piece.take(others);
        piece.stop();
        // Momenta and advected parameters are computed; then the attitude, and the memory.
        let moving = (sizes.momentum()..sizes.history()).chain(0..sizes.momentum());
        for at in moving.chain(sizes.history()..sizes.state() - 1) {
            piece.replace(next[at], (self.state, offset(at, 1)?));
            piece.need(&[next[at]]);
        }
        piece.stop();
        let mut writing = self.begin(piece)?;
        let taken = self.write(&mut writing)?;
        let rest = self.builder.ins().fsub(taken[0], taken[0]);
        let mut is_fine = self.compare(FloatCC::Equal, rest, zero);
        let mut is_far = self.builder.ins().iconst(types::I8, 0);
        for &near in &taken[1..] {
            let one = self.known(1.0)?;
            let wide = self.times(near, 9.0)?;
            let is = self.compare(FloatCC::UnorderedOrGreaterThanOrEqual, wide, one);
            is_far = self.builder.ins().bor(is_far, is);
            let wide = self.times(near, 4.0)?;
            let is = self.compare(FloatCC::LessThan, wide, one);
            is_fine = self.builder.ins().band(is_fine, is);
        }
        self.builder.ins().brif(is_fine, store, &[], self.none, &[]);

        self.builder.switch_to_block(store);
        self.write(&mut writing)?;
        let twice = self.builder.ins().iadd(count, count);
        let is_far = self.builder.ins().uextend(types::I64, is_far);
        let both = self.builder.ins().iadd(twice, is_far);
        self.builder.ins().return_(&[both]);
        Ok(())
    }
}
