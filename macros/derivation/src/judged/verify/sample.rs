//! Numbers for all names of a declaration, at an element of its group.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::dual::Dual;
use super::evaluation::Evaluation;
use super::number::Number;
use super::series::Series;
use super::value::Value;
use super::{
    DRAWS, Values, algebra, cayley, displacements, exponential, increments, over, parameters, shares, stream,
    translation, velocities,
};
use crate::declared::lower::Reading;
use crate::declared::{Declaration, FieldKind, Name, Role, Tree};
use crate::mathematics::derive::{Derivation, View};
use crate::mathematics::group::Group;
use crate::mathematics::symbolic::{Rational, SymbolId};

/// An element of the group; for a product, an element of each factor.
#[derive(Clone, Debug)]
pub struct Element<T = f64> {
    pub matrices: Vec<Value<T>>,
    pub inverses: Vec<Value<T>>,
    /// The coordinates `y` with `F = cay(2y)`, or `d = 2y` for a translation, on products of SO(3) and translations
    /// alone.
    pub coordinates: Vec<T>,
}

impl<T: Number> Element<T> {
    pub fn identity(group: &Group) -> Self {
        let matrices: Vec<Value<T>> = group.factors().iter().map(|own| Value::identity(own.size)).collect();
        Self { inverses: matrices.clone(), matrices, coordinates: vec![T::ZERO; group.dimension()] }
    }

    /// Multiplies by an element of a factor, passed with its inverse.
    fn times(&mut self, factor: usize, [forwards, backwards]: [Value<T>; 2]) {
        self.matrices[factor] = self.matrices[factor].times(&forwards);
        self.inverses[factor] = backwards.times(&self.inverses[factor]);
    }

    /// A product of Cayley transforms `cay(x) = (I − x)⁻¹(I + x)`: on SO(3) that of one random element, else those of
    /// multiples of all generators; `None` if these aren't in the group.
    ///
    /// If `E³ = c E`, `cay(tE)` is an element of the one-parameter group of `E`, rational in `t`; this holds for all
    /// generators of the built-in groups. The products over all generators fill a neighbourhood of the identity.
    pub fn by_cayley(group: &Group, number: &mut impl FnMut() -> T) -> Option<Self> {
        let mut element = Self::identity(group);
        element.coordinates.fill_with(number);
        let coordinates = element.coordinates.clone();
        for (factor, (own, share)) in shares(group, &coordinates).enumerate() {
            let all = || vec![Value::combination(own.size, &own.generators, share)];
            for x in if own.is_so3 { all() } else { multiples(own, share).collect() } {
                element.times(factor, cayley(&x, cube(&x)?));
            }
        }
        Some(element)
    }

    /// A product of exponentials of multiples of all generators, which are small or powers of `h`.
    pub fn by_exponentials(group: &Group, mut number: impl FnMut() -> T) -> Self {
        let mut element = Self::identity(group);
        let components: Vec<T> = group.generators.iter().map(|_| number()).collect();
        for (factor, (own, share)) in shares(group, &components).enumerate() {
            for x in multiples(own, share) {
                element.times(factor, [exponential(&x), exponential(&x.map(|entry| -entry))]);
            }
        }
        element
    }

    /// The element as constants among dual numbers.
    fn lifted(&self) -> Element<Dual<T>> {
        let [matrices, inverses] = [&self.matrices, &self.inverses]
            .map(|matrices| matrices.iter().map(|matrix| matrix.over(Dual::constant)).collect());
        Element { matrices, inverses, coordinates: self.coordinates.iter().map(|&y| Dual::constant(y)).collect() }
    }

    /// `exp(ε v̂) F`, with the coordinates of `F`.
    pub fn turned(&self, [forwards, backwards]: &[Vec<Value<Dual<T>>>; 2]) -> Element<Dual<T>> {
        let still = self.lifted();
        let [matrices, inverses] = [products(forwards, &still.matrices), products(&still.inverses, backwards)];
        Element { matrices, inverses, ..still }
    }
}

/// The multiples of the generators.
fn multiples<T: Number>(group: &Group, shares: &[T]) -> impl Iterator<Item = Value<T>> {
    let each = group.generators.iter().zip(shares);
    each.map(|(entries, &t)| Value::square(group.size, entries).map(|entry: T| t * entry))
}

/// The products of the elements of each factor.
pub fn products<T: Number>(a: &[Value<T>], b: &[Value<T>]) -> Vec<Value<T>> {
    a.iter().zip(b).map(|(a, b)| a.times(b)).collect()
}

/// `exp(±ε x) = I ± ε x`.
pub fn exponentials<T: Number>(elements: &[Value<T>]) -> [Vec<Value<Dual<T>>>; 2] {
    [T::ONE, -T::ONE].map(|sign| {
        let one = |x: &Value<T>| Value::identity(x.rows).plus(&x.over(|x| Dual { value: T::ZERO, slope: sign * x }));
        elements.iter().map(one).collect()
    })
}

/// `exp(h ξ̂)`.
pub fn along_motion(group: &Group, velocity: &[Series]) -> Vec<Value<Series>> {
    algebra(group, velocity).iter().map(|x| exponential(&x.map(|entry| entry * Series::STEP))).collect()
}

/// The `c` with `x³ = c x`, if there is one.
fn cube<T: Number>(x: &Value<T>) -> Option<T> {
    let cube = x.times(x).times(x);
    let (&first, &scale) = cube.entries.iter().zip(&x.entries).find(|(_, entry)| !entry.is_zero())?;
    let c = first / scale;
    cube.entries.iter().zip(&x.entries).all(|(&a, &b)| (a - c * b).is_zero()).then_some(c)
}

/// A declaration and its derivation.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    pub declaration: &'a Declaration,
    pub tree: &'a Rc<Tree>,
    pub lowered: &'a Reading,
    pub derived: &'a Derivation,
}

/// Numbers for all names.
#[derive(Clone)]
pub struct Sample<'a, T = f64> {
    pub of: Subject<'a>,
    pub element: Element<T>,
    pub values: Values<T>,
}

/// Real numbers for all names. Later draws have parameters of larger range, and smaller increments.
pub fn draws(declaration: &Declaration) -> impl Iterator<Item = (Element, Values<f64>)> {
    (1..=DRAWS).map(|seed| {
        let mut number = stream(seed);
        // The first fifth of the draws has parameters near one; later ones vary the scale of each, and the sign of
        // scalars.
        let reach = f64::from(u32::try_from(seed / (DRAWS / 5)).unwrap_or(0));
        // Increments shrink, as a relativistic root has values below the speed of light alone.
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

/// Values at an element, from numbers between zero and one.
fn numbers<T: Number>(declaration: &Declaration, element: &Element<T>, number: &mut impl FnMut() -> T) -> Values<T> {
    let mut values = increments(&declaration.group, &element.matrices);
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
    pub fn draws(of: Subject<'a>) -> impl Iterator<Item = Self> {
        let samples = draws(of.declaration).map(move |(element, values)| Self { of, element, values });
        samples.filter(|sample| sample.declared().is_defined())
    }
}

impl<'a, T: Number> Sample<'a, T> {
    /// The sample at a group element, from numbers between zero and one.
    pub fn at(of: Subject<'a>, element: Element<T>, number: &mut impl FnMut() -> T) -> Self {
        Self { of, values: numbers(of.declaration, &element, number), element }
    }

    pub fn lifted(&self) -> Sample<'a, Dual<T>> {
        Sample { of: self.of, element: self.element.lifted(), values: over(&self.values, Dual::constant) }
    }

    /// `l_d` at this point.
    pub fn declared(&self) -> T {
        Evaluation::new(&self.values).of(self.of.tree).first()
    }

    /// `−l_d` of the reversed step: at `F⁻¹`, `F⁻¹·w` and `−h`, and of virtual work with the displacements exchanged.
    pub fn reversed(&self) -> T {
        let Element { matrices, inverses, .. } = &self.element;
        let mut values = self.moved([inverses, matrices]);
        values.extend(increments(&self.of.declaration.group, inverses));
        values.entry(Name::Step).and_modify(|h| *h = h.map(|h| -h));
        for factor in 0..matrices.len() {
            let [before, after] = [Name::DisplacementBefore(factor), Name::DisplacementAfter(factor)];
            if let (Some(first), Some(last)) = (values.get(&before).cloned(), values.get(&after).cloned()) {
                values.extend([(before, last), (after, first)]);
            }
        }
        -Evaluation::new(&values).of(self.of.tree).first()
    }

    /// The values of all symbols: of the names, and of the variables that the derivation adds.
    pub fn inputs(&self) -> BTreeMap<SymbolId, Value<T>> {
        self.inputs_at(&self.element, &self.values)
    }

    /// The values of all symbols at another increment, and at other values of names.
    pub fn inputs_at(&self, element: &Element<T>, values: &Values<T>) -> BTreeMap<SymbolId, Value<T>> {
        let (group, directions) = (&self.of.derived.group, &self.of.derived.directions);
        let names = self.of.lowered.names.iter();
        let named = names.filter_map(|(name, symbol)| Some((*symbol, values.get(name)?.clone())));
        let mut inputs: BTreeMap<SymbolId, Value<T>> = named.collect();
        for (factor, one) in directions.factors.iter().enumerate() {
            let (f, inverse) = (&element.matrices[factor], &element.inverses[factor]);
            if group.factor(factor).is_added {
                let d = translation(f);
                inputs.extend([(one.small, d.clone()), (one.increment, d)]);
                continue;
            }
            let small = |f: &Value<T>| f.zip(&Value::identity(f.rows), |x, y| x - y);
            inputs.extend([(one.small, small(f)), (one.small_inverse, small(inverse))]);
            inputs.extend([(one.increment, f.clone()), (one.inverse, inverse.clone())]);
        }
        inputs.insert(directions.coordinates, Value::column(&element.coordinates));
        inputs
    }

    /// The values with all advected parameters moved by a group element, passed with its inverse.
    pub fn moved(&self, element: [&[Value<T>]; 2]) -> Values<T> {
        moved(self.of.declaration, &self.values, element)
    }
}

/// The values with all advected parameters moved by a group element, passed with its inverse.
pub fn moved<T: Number>(declaration: &Declaration, values: &Values<T>, [g, inverse]: [&[Value<T>]; 2]) -> Values<T> {
    let (mut values, group) = (values.clone(), &declaration.group);
    let added = |moving: &[Value<T>], factor: usize| translation(&moving[factor]);
    for (index, advected) in declaration.advected.iter().enumerate() {
        let Some(w) = values.get_mut(&Name::Advected(index)) else { continue };
        *w = match advected.seen {
            View::Relative { of, from } if group.factor(of).is_added => {
                added(g, from).plus(w).plus(&added(inverse, of))
            }
            View::Configuration(of) if group.factor(of).is_added => w.plus(&added(inverse, of)),
            View::Relative { of, from } => g[from].times(w).times(&inverse[of]),
            View::Configuration(of) => w.times(&inverse[of]),
            View::From(factor) => {
                let variance = declaration.advected_kind(index).variance();
                variance.moved(w, [&g[factor], &inverse[factor]], Value::transpose, Value::times)
            }
        };
    }
    values
}
