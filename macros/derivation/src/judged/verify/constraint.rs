//! The self-check of a constraint at random points of a finite field, where nothing is rounded: its derivatives against
//! dual numbers of the declared functions, and the rank of its functions, one after the other.

use std::collections::BTreeMap;
use std::ops::Add as _;
use std::rc::Rc;

use super::degree::{Content, Degree};
use super::dual::Dual;
use super::exact::{certified, same};
use super::identities::Same;
use super::linear::Subspace;
use super::number::Number;
use super::residue::Residue;
use super::{DRAWS, Evaluation, Objection, Sureness, Value, Values, dot, evaluated, over, parameter, stream};
use crate::declared::lower::ConstraintReading;
use crate::declared::{Declaration, FieldKind, Name, Tree};
use crate::mathematics::derive::View;
use crate::mathematics::symbolic::{Expression, SymbolId};
use crate::program::{Graph, NodeId};

/// A constraint as it is emitted.
pub struct ConstraintSlopes {
    /// The scalars and vectors, stacked into one column.
    pub functions: Vec<Rc<Tree>>,
    pub lowered: ConstraintReading,
    /// The derivatives of each body by its rotation and by its translation, linear in the directions.
    pub slopes: [[Vec<Expression>; 2]; 2],
    pub graph: Graph,
    /// The derivatives as matrices with a row for each function, by rows.
    pub entries: [[Vec<NodeId>; 2]; 2],
    pub sureness: Sureness,
}

impl ConstraintSlopes {
    /// The number of functions.
    pub fn rows(&self) -> usize {
        self.functions.iter().map(|tree| tree.shape.rows()).sum()
    }
}

/// Attitude and position of a body.
type Place<T> = [Value<T>; 2];

/// The dependence of a function on those before it, at all positions of the bodies and for all parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Row {
    /// The function is independent of those before it.
    New,
    /// The function depends on those before it.
    Follows,
    /// The function is constant.
    Constant,
}

/// Checks the slopes of both bodies; returns a bound on the probability of a wrong result, and each function's
/// dependence on those before it.
pub fn constraint(declaration: &Declaration, held: &ConstraintSlopes) -> Result<(Sureness, Vec<Row>), Objection> {
    let has_value = |seed| {
        let point = Point::new(declaration, stream(seed));
        let value = point.value(held, &point.places.each_ref().map(lifted));
        value.iter().all(|entry| entry.value.is_defined())
    };
    if !(1..=DRAWS).any(has_value) {
        return Err(Objection::NoValue);
    }
    let content = held.functions.iter().map(Content::of_tree).fold(Content::of_graph(&held.graph), Content::add);
    let degrees = |same: &mut Same<Degree>| {
        let mut number = Degree::stream();
        let mut point = Point::new(declaration, &mut number);
        // The attitudes of both bodies are Cayley transforms.
        for [attitude, _] in &mut point.places {
            attitude.entries.iter_mut().for_each(|entry| *entry = number().of_element(4));
        }
        point.holds(held, number, same)
    };
    let sureness = certified(content, degrees, |seed| {
        let mut number = Residue::stream(seed);
        Point::new(declaration, &mut number).holds(held, number, &mut same)
    })?;
    let rows = if content.has_multiple { None } else { Point::new(declaration, Residue::stream(1)).rows(held) };
    Ok((sureness, rows.unwrap_or_else(|| vec![Row::New; held.rows()])))
}

/// The positions of two bodies, and the values of the fields.
struct Point<'a, T> {
    declaration: &'a Declaration,
    places: [Place<T>; 2],
    fields: Values<T>,
}

fn lifted<T: Number>(place: &Place<T>) -> Place<Dual<T>> {
    place.each_ref().map(constant)
}

fn constant<T: Number>(value: &Value<T>) -> Value<Dual<T>> {
    value.over(Dual::constant)
}

impl<'a, T: Number> Point<'a, T> {
    fn new(declaration: &'a Declaration, mut number: impl FnMut() -> T) -> Self {
        let mut place = || [FieldKind::Configuration(3), FieldKind::Vector(3)].map(|kind| parameter(kind, &mut number));
        let places = [place(), place()];
        let fields = declaration.fields.iter().enumerate();
        let fields = fields.map(|(index, field)| (Name::Field(index), parameter(field.kind, &mut number))).collect();
        Self { declaration, places, fields }
    }

    /// The declared functions at these positions of the bodies.
    fn value(&self, held: &ConstraintSlopes, places: &[Place<Dual<T>>; 2]) -> Vec<Dual<T>> {
        let mut values = over(&self.fields, Dual::constant);
        let place = |factor: usize| &places[factor / 2 % 2][factor % 2];
        for (index, w) in self.declaration.advected.iter().enumerate() {
            let field = w.field.and_then(|field| self.fields.get(&Name::Field(field))).map(constant);
            let seen = match w.seen {
                View::From(factor) => field.map(|field| place(factor).transpose().times(&field)),
                View::Configuration(of) => Some(place(of).clone()),
                View::Relative { of, from } if of % 2 == 1 => Some(place(of).zip(place(from), |x, y| x - y)),
                View::Relative { of, from } => Some(place(from).transpose().times(place(of))),
            };
            values.extend(seen.map(|seen| (Name::Advected(index), seen)));
        }
        let mut at = Evaluation::new(&values);
        held.functions.iter().flat_map(|tree| at.of(tree).entries).collect()
    }

    /// The slopes of the functions when a body rotates about an axis, `by = 0`, or moves along it.
    fn slopes(&self, held: &ConstraintSlopes, body: usize, by: usize, axis: &[T]) -> Vec<T> {
        let axis = Value::column(axis).over(|slope| Dual { value: T::ZERO, slope });
        let mut places = self.places.each_ref().map(lifted);
        let moved = &mut places[body][by];
        // exp(εη̂) R is R + εη̂ R.
        *moved = if by == 0 { moved.plus(&Value::hat(&axis).times(moved)) } else { moved.plus(&axis) };
        self.value(held, &places).iter().map(|value| value.slope).collect()
    }

    fn inputs(&self, held: &ConstraintSlopes) -> BTreeMap<SymbolId, Value<T>> {
        let mut inputs = BTreeMap::new();
        for (body, [attitude, position]) in held.lowered.declared.bodies.iter().zip(&self.places) {
            inputs.extend([(body.attitude, attitude.clone()), (body.position, position.clone())]);
        }
        for (name, value) in &self.fields {
            inputs.extend(held.lowered.names.get(name).map(|&symbol| (symbol, value.clone())));
        }
        inputs
    }

    /// Compares the slopes along a direction of these numbers.
    fn holds(
        &self,
        held: &ConstraintSlopes,
        mut number: impl FnMut() -> T,
        same: &mut Same<T>,
    ) -> Result<(), Objection> {
        let (inputs, axis) = (self.inputs(held), [(); 3].map(|()| number()));
        for (body, slopes) in held.entries.iter().enumerate() {
            for (by, entries) in slopes.iter().enumerate() {
                let found = evaluated(&held.graph, entries, &inputs);
                for (row, expected) in found.chunks(3).zip(self.slopes(held, body, by, &axis)) {
                    same("slope", dot(row, &axis), expected)?;
                }
            }
        }
        Ok(())
    }
}

impl Point<'_, Residue> {
    /// The dependence of each function on those before it; `None` where a slope has no value in the field.
    ///
    /// At a random point slopes have their largest rank, but for a probability of their degree over `2⁶¹`. A root or a
    /// sine is replaced by a function that has no relations but its symmetry, so the rank may be larger than among real
    /// numbers and is never smaller. So no independent function is refused, and a dependence that needs a relation like
    /// `sin² + cos² = 1` isn't found here.
    ///
    /// A dependence on the constraint alone isn't found either, as the point doesn't satisfy it: of `R_1 a − R_2 b`
    /// with vectors of equal length two of the three functions are enough.
    fn rows(&self, held: &ConstraintSlopes) -> Option<Vec<Row>> {
        let ways: Vec<Vec<Residue>> = (0..12)
            .map(|way| {
                let axis = [0, 1, 2].map(|k| if k == way % 3 { Residue::ONE } else { Residue::ZERO });
                self.slopes(held, way / 6, way / 3 % 2, &axis)
            })
            .collect();
        let mut before = Subspace::default();
        let mut rows = Vec::new();
        for row in 0..held.rows() {
            let slopes: Vec<Residue> = ways.iter().map(|slopes| slopes[row]).collect();
            if !slopes.iter().all(|slope| slope.is_defined()) {
                return None;
            }
            let is_constant = slopes.iter().all(|slope| *slope == Residue::ZERO);
            rows.push(match before.extend(slopes) {
                true => Row::New,
                false if is_constant => Row::Constant,
                false => Row::Follows,
            });
        }
        Some(rows)
    }
}
