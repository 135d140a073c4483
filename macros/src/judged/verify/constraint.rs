//! The self-check of a constraint: its derivatives against dual numbers of the declared functions, and what each of these
//! adds to those before it, at a random point of a finite field, where nothing is rounded.

use std::collections::BTreeMap;

use super::dual::Dual;
use super::number::Number;
use super::residue::Residue;
use super::{DRAWS, Evaluation, Fault, Unconfirmed, Value, confirmed, evaluated, parameter, stream};
use crate::declared::{Declaration, FieldKind, Name};
use crate::judged::constraint::Held;
use crate::mathematics::derive::Seen;
use crate::mathematics::symbolic::SymbolId;

/// What two ways to the same slopes may differ by, relative to these: both are right but for roundings, and this leaves seven
/// digits for what cancels.
const ROUNDING: f64 = 1e-9;

/// Attitude and position of a body.
type Place<T> = [Value<T>; 2];

/// What a function holds, wherever the bodies are and whatever the parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Row {
    /// What those before it don't.
    New,
    /// Nothing more than those before it.
    Follows,
    /// Nothing at all, as it is the same everywhere.
    Constant,
}

/// Checks the slopes of both bodies, and finds what each function adds to those before it.
pub(crate) fn constraint(declaration: &Declaration, held: &Held) -> Result<Vec<Row>, Unconfirmed> {
    let draws = (1..=DRAWS).map(|seed| Point::new(declaration, stream(seed)));
    let finite = draws.filter(|point| {
        let value = point.value(held, &point.places.each_ref().map(lifted));
        value.iter().all(|entry| entry.value.is_finite())
    });
    confirmed(finite, |point| point.check(held))?;
    let rows = Point::new(declaration, Residue::stream(1)).rows(held);
    Ok(rows.unwrap_or_else(|| vec![Row::New; held.rows()]))
}

/// Where two bodies are, and the values of the fields.
struct Point<'a, T = f64> {
    declaration: &'a Declaration,
    places: [Place<T>; 2],
    fields: BTreeMap<Name, Value<T>>,
}

fn lifted<T: Number>(place: &Place<T>) -> Place<Dual<T>> {
    place.each_ref().map(constant)
}

fn constant<T: Number>(value: &Value<T>) -> Value<Dual<T>> {
    Value {
        rows: value.rows,
        columns: value.columns,
        entries: value.entries.iter().map(|&entry| Dual::constant(entry)).collect(),
    }
}

impl<'a, T: Number> Point<'a, T> {
    fn new(declaration: &'a Declaration, mut number: impl FnMut() -> T) -> Self {
        let mut place = || [FieldKind::Configuration(3), FieldKind::Vector(3)].map(|kind| parameter(kind, &mut number));
        let places = [place(), place()];
        let fields = declaration.fields.iter().enumerate();
        let fields = fields.map(|(index, field)| (Name::Field(index), parameter(field.kind, &mut number))).collect();
        Self { declaration, places, fields }
    }

    /// The declared functions of bodies at these places.
    fn value(&self, held: &Held, places: &[Place<Dual<T>>; 2]) -> Vec<Dual<T>> {
        let mut values: BTreeMap<Name, Value<Dual<T>>> =
            self.fields.iter().map(|(name, value)| (*name, constant(value))).collect();
        let place = |factor: usize| &places[factor / 2 % 2][factor % 2];
        for (index, w) in self.declaration.advected.iter().enumerate() {
            let field = w.field.and_then(|field| self.fields.get(&Name::Field(field))).map(constant);
            let seen = match w.seen {
                Seen::From(factor) => field.map(|field| place(factor).transpose().times(&field)),
                Seen::Configuration(of) => Some(place(of).clone()),
                Seen::Relative { of, from } if of % 2 == 1 => Some(place(of).zip(place(from), |x, y| x - y)),
                Seen::Relative { of, from } => Some(place(from).transpose().times(place(of))),
            };
            values.extend(seen.map(|seen| (Name::Advected(index), seen)));
        }
        let mut at = Evaluation::new(&values);
        held.functions.iter().flat_map(|tree| at.of(tree).entries).collect()
    }

    /// Their slopes where a body turns about an axis, `by = 0`, or is shifted along it.
    fn slopes(&self, held: &Held, body: usize, by: usize, k: usize) -> Vec<T> {
        let slope = |row: usize| if row == k { T::ONE } else { T::ZERO };
        let axis = Value::new(3, 1, |row, _| Dual { value: T::ZERO, slope: slope(row) });
        let mut places = self.places.each_ref().map(lifted);
        let moved = &mut places[body][by];
        // exp(εη̂) R is R + εη̂ R.
        *moved = if by == 0 { moved.plus(&Value::hat(&axis).times(moved)) } else { moved.plus(&axis) };
        self.value(held, &places).iter().map(|value| value.slope).collect()
    }
}

impl Point<'_, Residue> {
    /// What each function adds to those before it; nothing where the field doesn't say.
    ///
    /// At a random point slopes have the largest rank that they have anywhere, but for a chance of their degree in `2⁶¹`. A root
    /// or a sine is replaced by a function that has no relations but its symmetry, so that the rank may be larger than among
    /// real numbers and is never smaller. So no function is refused that holds something, and what follows by a relation like
    /// `sin² + cos² = 1` alone isn't found here.
    ///
    /// Nor is what follows on the constraint alone, where the point isn't: of `R_1 a − R_2 b` with vectors of one length two of
    /// the three functions say all.
    fn rows(&self, held: &Held) -> Option<Vec<Row>> {
        let ways: Vec<Vec<Residue>> = (0..12).map(|way| self.slopes(held, way / 6, way / 3 % 2, way % 3)).collect();
        // Each with the place of its first entry that isn't zero, which is one.
        let mut before: Vec<(usize, Vec<Residue>)> = Vec::new();
        let mut rows = Vec::new();
        for row in 0..held.rows() {
            let slopes: Vec<Residue> = ways.iter().map(|slopes| slopes[row]).collect();
            if !slopes.iter().all(|slope| slope.is_defined()) {
                return None;
            }
            let first = |slopes: &[Residue]| slopes.iter().position(|slope| *slope != Residue::ZERO);
            let mut rest = slopes.clone();
            for (at, unit) in &before {
                let share = rest[*at];
                rest.iter_mut().zip(unit).for_each(|(entry, &unit)| *entry = *entry - share * unit);
            }
            rows.push(match (first(&rest), first(&slopes)) {
                (Some(_), _) => Row::New,
                (None, Some(_)) => Row::Follows,
                (None, None) => Row::Constant,
            });
            before.extend(first(&rest).map(|at| (at, rest.iter().map(|&entry| entry / rest[at]).collect())));
        }
        Some(rows)
    }
}

impl Point<'_> {
    fn inputs(&self, held: &Held) -> BTreeMap<SymbolId, Value> {
        let mut inputs = BTreeMap::new();
        for (body, [attitude, position]) in held.lowered.declared.bodies.iter().zip(&self.places) {
            inputs.extend([(body.attitude, attitude.clone()), (body.position, position.clone())]);
        }
        for (name, value) in &self.fields {
            inputs.extend(held.lowered.names.get(name).map(|&symbol| (symbol, value.clone())));
        }
        inputs
    }

    fn check(&self, held: &Held) -> Result<(), Fault> {
        let inputs = self.inputs(held);
        for (body, slopes) in held.entries.iter().enumerate() {
            for (by, entries) in slopes.iter().enumerate() {
                let found = evaluated(&held.graph, entries, &inputs);
                let size = 1.0 + found.iter().map(|entry| entry.abs()).sum::<f64>();
                for k in 0..3 {
                    let expected = self.slopes(held, body, by, k);
                    for (row, expected) in expected.iter().enumerate() {
                        let off = found.get(3 * row + k).map_or(f64::NAN, |found| (found - expected).abs());
                        if off.partial_cmp(&(ROUNDING * size)) != Some(std::cmp::Ordering::Less) {
                            return Err(Fault::Disagrees("slope"));
                        }
                    }
                }
            }
        }
        Ok(())
    }
}
