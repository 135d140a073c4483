//! The self-check of a constraint: its derivatives against dual numbers of the declared functions.

use std::collections::BTreeMap;

use super::dual::Dual;
use super::{DRAWS, Evaluation, Fault, Unconfirmed, Value, confirmed, evaluated, parameter, stream};
use crate::declared::{Declaration, FieldKind, Name};
use crate::judged::constraint::Held;
use crate::mathematics::derive::Seen;
use crate::mathematics::symbolic::SymbolId;

/// Of the size of the slopes.
const ROUNDING: f64 = 1e-9;

/// Attitude and position of a body.
type Place<T> = [Value<T>; 2];

/// What is left of a direction in which there is nothing new, relative to it.
const NOTHING_NEW: f64 = 1e-9;

/// Checks the slopes of both bodies, and finds a function that follows from those before it wherever the bodies are and
/// whatever the parameters: its number.
///
/// The points aren't on the constraint, so what follows there alone isn't found.
pub(crate) fn constraint(declaration: &Declaration, held: &Held) -> Result<Option<usize>, Unconfirmed> {
    let draws = (1..=DRAWS).map(|seed| Point::new(declaration, seed));
    let finite = draws.filter(|point| {
        let value = point.value(held, &point.places.each_ref().map(lifted));
        value.iter().all(|entry| entry.value.is_finite())
    });
    let points = confirmed(finite, |point| point.check(held))?;
    let following: Option<Vec<usize>> = points.iter().map(|point| point.following(held)).collect();
    Ok(following.and_then(|rows| rows.into_iter().max()))
}

/// Where two bodies are, and the values of the fields.
struct Point<'a> {
    declaration: &'a Declaration,
    places: [Place<f64>; 2],
    fields: BTreeMap<Name, Value>,
}

fn length(entries: &[f64]) -> f64 {
    entries.iter().map(|entry| entry * entry).sum::<f64>().sqrt()
}

fn lifted(place: &Place<f64>) -> Place<Dual<f64>> {
    place.each_ref().map(constant)
}

fn constant(value: &Value) -> Value<Dual<f64>> {
    Value {
        rows: value.rows,
        columns: value.columns,
        entries: value.entries.iter().map(|&entry| Dual::constant(entry)).collect(),
    }
}

impl<'a> Point<'a> {
    fn new(declaration: &'a Declaration, seed: u64) -> Self {
        let mut number = stream(seed);
        let mut place = || [FieldKind::Configuration(3), FieldKind::Vector(3)].map(|kind| parameter(kind, &mut number));
        let places = [place(), place()];
        let fields = declaration.fields.iter().enumerate();
        let fields = fields.map(|(index, field)| (Name::Field(index), parameter(field.kind, &mut number))).collect();
        Self { declaration, places, fields }
    }

    /// The declared functions of bodies at these places.
    fn value(&self, held: &Held, places: &[Place<Dual<f64>>; 2]) -> Vec<Dual<f64>> {
        let mut values: BTreeMap<Name, Value<Dual<f64>>> =
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

    /// The first function whose slopes are combined of those before it.
    fn following(&self, held: &Held) -> Option<usize> {
        let inputs = self.inputs(held);
        let all: Vec<Vec<f64>> =
            held.entries.iter().flatten().map(|entries| evaluated(&held.graph, entries, &inputs)).collect();
        let mut before: Vec<Vec<f64>> = Vec::new();
        for row in 0..held.rows() {
            let mut rest: Vec<f64> = all.iter().flat_map(|entries| &entries[3 * row..3 * row + 3]).copied().collect();
            let whole = length(&rest);
            // The second time for what roundings of the first leave.
            for unit in before.iter().chain(&before) {
                let along: f64 = unit.iter().zip(&rest).map(|(a, b)| a * b).sum();
                rest.iter_mut().zip(unit).for_each(|(entry, unit)| *entry -= along * unit);
            }
            let left = length(&rest);
            if left <= NOTHING_NEW * whole {
                return Some(row);
            }
            before.push(rest.iter().map(|entry| entry / left).collect());
        }
        None
    }

    fn check(&self, held: &Held) -> Result<(), Fault> {
        let inputs = self.inputs(held);
        for (body, slopes) in held.entries.iter().enumerate() {
            for (by, entries) in slopes.iter().enumerate() {
                let found = evaluated(&held.graph, entries, &inputs);
                let size = 1.0 + found.iter().map(|entry| entry.abs()).sum::<f64>();
                for k in 0..3 {
                    let axis = Value::new(3, 1, |row, _| Dual { value: 0.0, slope: f64::from(u8::from(row == k)) });
                    let mut places = self.places.each_ref().map(lifted);
                    let moved = &mut places[body][by];
                    // exp(εη̂) R is R + εη̂ R.
                    *moved = if by == 0 { moved.plus(&Value::hat(&axis).times(moved)) } else { moved.plus(&axis) };
                    let expected = self.value(held, &places);
                    for (row, expected) in expected.iter().enumerate() {
                        let off = found.get(3 * row + k).map_or(f64::NAN, |found| (found - expected.slope).abs());
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
