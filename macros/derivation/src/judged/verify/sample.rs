//! Numbers for all names of a declaration, at an element of its group.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::dual::Dual;
use super::evaluation::Evaluation;
use super::number::Number;
use super::value::Value;
use super::{
    DRAWS, Values, block, by_blocks, cayley, displacements, exponential, increments, parameters, stream, translation,
    velocities,
};
use crate::declared::lower::Lowered;
use crate::declared::{Declaration, FieldKind, Name, Role, Tree};
use crate::mathematics::derive::{Derived, Seen};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Rational, SymbolId, Variance};

/// An element of the group.
#[derive(Clone, Debug)]
pub(super) struct Element<T = f64> {
    /// Of a product all increments, in blocks.
    pub(super) matrix: Value<T>,
    pub(super) inverse: Value<T>,
    /// `y` with `F = cay(2y)`, or `d = 2y` of what is translated, for groups of nothing else.
    pub(super) coordinates: Vec<T>,
}

impl<T: Number> Element<T> {
    pub(super) fn identity(group: &Group) -> Self {
        let identity = Value::identity(group.size);
        Self { matrix: identity.clone(), inverse: identity, coordinates: vec![T::ZERO; group.dimension()] }
    }

    /// A product of Cayley transforms `cay(x) = (I − x)⁻¹(I + x)`: of a rotation of space the one of a random element, else
    /// those of multiples of all generators; nothing where these aren't of the group.
    ///
    /// Where `E³ = c E`, `cay(tE)` is an element of the one-parameter group of `E`, rational in `t`: for all of the built-in
    /// groups' generators. The products for all generators have elements near the identity for all that the group has there.
    pub(super) fn by_cayley(group: &Group, number: &mut impl FnMut() -> T) -> Option<Self> {
        let (mut matrices, mut inverses, mut coordinates) = (Vec::new(), Vec::new(), Vec::new());
        for own in group.factors() {
            let identity = Value::identity(own.size);
            let components: Vec<T> = own.generators.iter().map(|_| number()).collect();
            let one_by_one = || {
                let each = own.generators.iter().zip(&components);
                each.map(|(entries, &t)| Value::square(own.size, entries).map(|entry: T| t * entry))
            };
            let elements: Vec<Value<T>> = if own.is_so3 {
                vec![Value::combination(own.size, &own.generators, &components)]
            } else {
                one_by_one().collect()
            };
            let (mut matrix, mut inverse) = (identity.clone(), identity);
            for x in elements {
                let [forwards, backwards] = cayley(&x, cube(&x)?);
                matrix = matrix.times(&forwards);
                inverse = backwards.times(&inverse);
            }
            matrices.push(matrix);
            inverses.push(inverse);
            coordinates.extend(components);
        }
        let [matrix, inverse] = [matrices, inverses].map(|blocks| by_blocks(group, |factor| blocks[factor].clone()));
        Some(Self { matrix, inverse, coordinates })
    }

    /// A product of exponentials of multiples of all generators, which are small or powers of `h`.
    pub(super) fn by_exponentials(group: &Group, mut number: impl FnMut() -> T) -> Self {
        let mut element = Self::identity(group);
        for entries in &group.generators {
            let t = number();
            let x = Value::square(group.size, entries).map(|entry: T| t * entry);
            element.matrix = element.matrix.times(&exponential(group, &x));
            element.inverse = exponential(group, &x.map(|entry| -entry)).times(&element.inverse);
        }
        element
    }

    /// As constants among dual numbers.
    fn lifted(&self) -> Element<Dual<T>> {
        Element {
            matrix: self.matrix.over(Dual::constant),
            inverse: self.inverse.over(Dual::constant),
            coordinates: self.coordinates.iter().map(|&y| Dual::constant(y)).collect(),
        }
    }

    /// `exp(ε v̂) F`; its coordinates aren't turned.
    pub(super) fn turned(&self, [forwards, backwards]: &[Value<Dual<T>>; 2]) -> Element<Dual<T>> {
        let still = self.lifted();
        Element { matrix: forwards.times(&still.matrix), inverse: still.inverse.times(backwards), ..still }
    }
}

/// `exp(±ε x) = I ± ε x`.
pub(super) fn exponentials<T: Number>(x: &Value<T>) -> [Value<Dual<T>>; 2] {
    let identity = Value::identity(x.rows);
    let along = |x: Value<T>| Value {
        rows: x.rows,
        columns: x.columns,
        entries: identity.entries.iter().zip(&x.entries).map(|(&value, &slope)| Dual { value, slope }).collect(),
    };
    [along(x.clone()), along(x.map(|entry| -entry))]
}

/// The `c` with `x³ = c x`; nothing where there is none.
fn cube<T: Number>(x: &Value<T>) -> Option<T> {
    let cube = x.times(x).times(x);
    let (&first, &scale) = cube.entries.iter().zip(&x.entries).find(|(_, entry)| !entry.is_zero())?;
    let c = first / scale;
    cube.entries.iter().zip(&x.entries).all(|(&a, &b)| (a - c * b).is_zero()).then_some(c)
}

/// Numbers for all names.
#[derive(Clone)]
pub(super) struct Sample<'a, T = f64> {
    pub(super) derived: &'a Derived,
    pub(super) element: Element<T>,
    pub(super) values: Values<T>,
    symbols: BTreeMap<SymbolId, Name>,
    pub(super) advected: Vec<(Name, Variance, Seen)>,
}

/// Real numbers for all names. The later ones are farther away, and may be anywhere, with smaller increments.
pub(super) fn draws(declaration: &Declaration) -> impl Iterator<Item = (Element, Values<f64>)> {
    (1..=DRAWS).map(|seed| {
        let mut number = stream(seed);
        // From one draw in five on, another scale for each parameter, and another sign for scalars.
        let reach = f64::from(u32::try_from(seed / (DRAWS / 5)).unwrap_or(0));
        // A relativistic root has values below the speed of light alone.
        let size = (-2.0 * reach).exp2();
        let element = Element::by_exponentials(&declaration.group, || size * (0.6 * number() - 0.3));
        let mut values = numbers(declaration, &element, &mut number);
        for (name, value) in values.iter_mut().filter(|_| reach > 0.0) {
            let (scale, sign) = ((8.0 * number() - 2.0).exp2().powf(reach / 4.0), number() < 0.5);
            let kind = match name {
                Name::Field(index) => declaration.fields.get(*index).map(|field| field.kind),
                Name::Advected(index) => Some(declaration.advected_kind(*index)),
                _ => None,
            };
            *value = match kind {
                None | Some(FieldKind::Point(_) | FieldKind::Configuration(_)) => continue,
                Some(FieldKind::Scalar) if sign => value.map(|x| -scale * x),
                Some(_) => value.map(|x| scale * x),
            };
        }
        (element, values)
    })
}

/// At an element, of numbers that are taken to lie between zero and one.
fn numbers<T: Number>(declaration: &Declaration, element: &Element<T>, number: &mut impl FnMut() -> T) -> Values<T> {
    let mut values = BTreeMap::from_iter(increments(&declaration.group, &element.matrix));
    let tenth = T::of(Rational::new(1, 10));
    values.insert(Name::Step, Value::scalar(tenth + tenth * number()));
    if declaration.role == Role::Force {
        values.extend(displacements(&declaration.group, number));
    }
    if declaration.continuous.is_some() {
        let components: Vec<T> = declaration.group.generators.iter().map(|_| number()).collect();
        values.extend(velocities(&declaration.group, &components));
    }
    values.extend(parameters(declaration, number));
    values
}

impl<'a> Sample<'a> {
    /// The points at which the declaration has a value.
    pub(super) fn draws(
        declaration: &'a Declaration,
        lowered: &'a Lowered,
        derived: &'a Derived,
        tree: &'a Rc<Tree>,
    ) -> impl Iterator<Item = Self> {
        let samples =
            draws(declaration).map(|(element, values)| Self::new(declaration, lowered, derived, element, values));
        samples.filter(|sample| sample.declared(tree).is_defined())
    }
}

impl<'a, T: Number> Sample<'a, T> {
    /// At a group element, with numbers that are taken to lie between zero and one.
    pub(super) fn with_numbers(
        declaration: &Declaration,
        lowered: &Lowered,
        derived: &'a Derived,
        element: Element<T>,
        mut number: impl FnMut() -> T,
    ) -> Self {
        let values = numbers(declaration, &element, &mut number);
        Self::new(declaration, lowered, derived, element, values)
    }

    fn new(
        declaration: &Declaration,
        lowered: &Lowered,
        derived: &'a Derived,
        element: Element<T>,
        values: Values<T>,
    ) -> Self {
        let advected = advected(declaration);
        let symbols = lowered.names.iter().map(|(name, id)| (*id, *name)).collect();
        Self { derived, element, values, symbols, advected }
    }

    pub(super) fn lifted(&self) -> Sample<'a, Dual<T>> {
        Sample {
            derived: self.derived,
            element: self.element.lifted(),
            values: self.values.iter().map(|(name, value)| (*name, value.over(Dual::constant))).collect(),
            symbols: self.symbols.clone(),
            advected: self.advected.clone(),
        }
    }

    /// `l_d` at this point.
    pub(super) fn declared(&self, tree: &Rc<Tree>) -> T {
        Evaluation::new(&self.values).of(tree).first()
    }

    /// `−l_d` turned back: at `F⁻¹`, `F⁻¹·w` and `−h`.
    pub(super) fn reversed(&self, tree: &Rc<Tree>) -> T {
        let Element { matrix, inverse, .. } = &self.element;
        let mut values = self.moved([inverse, matrix]);
        values.extend(increments(&self.derived.group, inverse));
        if let Some(h) = self.values.get(&Name::Step) {
            values.insert(Name::Step, h.map(|h| -h));
        }
        -Evaluation::new(&values).of(tree).first()
    }

    /// The values of all symbols: of the names, and of what the derivation adds.
    pub(super) fn inputs(&self) -> BTreeMap<SymbolId, Value<T>> {
        self.inputs_at(&self.element, &self.values)
    }

    /// The same at another increment, and at other values.
    pub(super) fn inputs_at(&self, element: &Element<T>, values: &Values<T>) -> BTreeMap<SymbolId, Value<T>> {
        let (group, directions) = (&self.derived.group, &self.derived.directions);
        let named = self.symbols.iter().filter_map(|(symbol, name)| Some((*symbol, values.get(name)?.clone())));
        let mut inputs: BTreeMap<SymbolId, Value<T>> = named.collect();
        for (factor, one) in directions.factors.iter().enumerate() {
            let [f, inverse] = [&element.matrix, &element.inverse].map(|matrix| block(group, matrix, factor));
            if group.factor(factor).is_added {
                let d = translation(&f);
                inputs.extend([(one.small, d.clone()), (one.increment, d)]);
                continue;
            }
            let small = |f: &Value<T>| f.zip(&Value::identity(f.rows), |x, y| x - y);
            inputs.extend([(one.small, small(&f)), (one.small_inverse, small(&inverse))]);
            inputs.extend([(one.increment, f), (one.inverse, inverse)]);
        }
        inputs.insert(directions.coordinates, Value::column(&element.coordinates));
        inputs
    }

    /// The values with all that is advected moved by a group element, given with its inverse.
    pub(super) fn moved(&self, element: [&Value<T>; 2]) -> Values<T> {
        moved(&self.derived.group, &self.advected, &self.values, element)
    }
}

/// How each advected parameter is moved.
pub(super) fn advected(declaration: &Declaration) -> Vec<(Name, Variance, Seen)> {
    let each = declaration.advected.iter().enumerate();
    each.map(|(index, w)| (Name::Advected(index), declaration.advected_kind(index).variance(), w.seen)).collect()
}

/// The values with all that is advected moved by a group element, given with its inverse.
pub(super) fn moved<T: Number>(
    group: &Group,
    advected: &[(Name, Variance, Seen)],
    values: &Values<T>,
    [g, inverse]: [&Value<T>; 2],
) -> Values<T> {
    let mut values = values.clone();
    let added = |moving: &Value<T>, factor| translation(&block(group, moving, factor));
    for &(name, variance, seen) in advected {
        let Some(w) = values.get(&name) else { continue };
        let moved = match seen {
            Seen::Relative { of, from } if group.factor(of).is_added => {
                added(g, from).plus(w).plus(&added(inverse, of))
            }
            Seen::Configuration(of) if group.factor(of).is_added => w.plus(&added(inverse, of)),
            Seen::Relative { of, from } => block(group, g, from).times(w).times(&block(group, inverse, of)),
            Seen::Configuration(of) => w.times(&block(group, inverse, of)),
            Seen::From(factor) => {
                let (g, inverse) = (&block(group, g, factor), &block(group, inverse, factor));
                match variance {
                    Variance::Vector => g.times(w),
                    Variance::Covector => inverse.transpose().times(w),
                    Variance::Contravariant => g.times(w).times(&g.transpose()),
                    Variance::Covariant => inverse.transpose().times(w).times(inverse),
                    Variance::Mixed => g.times(w).times(inverse),
                    Variance::Fixed => w.clone(),
                }
            }
        };
        values.insert(name, moved);
    }
    values
}
