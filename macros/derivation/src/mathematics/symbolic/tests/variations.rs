//! Variations against central differences, and substitution against other values.

use std::collections::BTreeMap;

use super::numeric::{Matrix, Values, value, value_and_scale};
use super::random::{Random, World, both, exponential};
use crate::mathematics::symbolic::{Expression, Rational, SymbolId, Variations, substitute, variation};

/// Where central differences of a smooth function of size one are best.
const SPACING: f64 = 1e-5;

/// Along `F ↦ exp(t Ê) F`, `w ↦ exp(t Ê) w`, and along straight lines for all other symbols.
struct Path {
    variations: Variations,
    generator: Matrix,
    rates: BTreeMap<SymbolId, Matrix>,
    turned: [SymbolId; 2],
}

impl Path {
    fn new(random: &mut Random, world: &World, direction: SymbolId) -> Self {
        let symbols = &world.symbols;
        let e = world.expression(direction);
        let [f, w] = [world.f, world.w].map(|id| (id, e.times(&world.expression(id), symbols)));
        let mut variations = Variations::from([f, w]);
        let mut rates = BTreeMap::new();
        // Symbols with another one of the same structure for their rate.
        for (id, rate, factor) in [(world.h, world.k, 2), (world.u, world.v, -1), (world.a, world.b, 3)] {
            variations.insert(id, world.expression(rate).scaled(Rational::integer(factor)));
        }
        if random.below(2) == 0 {
            variations.remove(&world.u);
        }
        for (id, factor) in [(world.h, 2.0), (world.u, -1.0), (world.a, 3.0)] {
            if variations.contains_key(&id) {
                let rate = if id == world.h {
                    world.k
                } else if id == world.u {
                    world.v
                } else {
                    world.b
                };
                rates.insert(id, world.values[&rate].scaled(factor));
            }
        }
        Self { variations, generator: world.values[&direction].clone(), rates, turned: [world.f, world.w] }
    }

    fn at(&self, values: &Values, t: f64) -> Values {
        let mut moved = values.clone();
        let turn = exponential(&self.generator.vee().scaled(t));
        for id in self.turned {
            moved.insert(id, turn.times(&values[&id]));
        }
        for (id, rate) in &self.rates {
            moved.insert(*id, values[id].plus(&rate.scaled(t)));
        }
        moved
    }

    fn slope(&self, expression: &Expression, world: &World) -> Matrix {
        let at = |t: f64| value(expression, &world.symbols, &self.at(&world.values, t));
        at(SPACING).minus(&at(-SPACING)).scaled(0.5 / SPACING)
    }
}

#[test]
fn first_and_second_variations_of_random_expressions() {
    let mut nonzero = 0;
    for seed in 0..1_500 {
        let mut random = Random::new(seed);
        let world = World::new(&mut random);
        let shape = [(1, 1), (3, 1), (3, 3)][random.below(3)];
        let depth = 1 + random.below(3);
        let expression = both(&mut random, &world, shape, depth).expression;
        let path = Path::new(&mut random, &world, world.e);
        let first = variation(&expression, &path.variations, &world.symbols);
        let second_path = Path::new(&mut random, &world, world.second);
        let second = variation(&first, &second_path.variations, &world.symbols);
        for (what, varied, path, of) in
            [("first", &first, &path, &expression), ("second", &second, &second_path, &first)]
        {
            let (found, scale) = value_and_scale(varied, &world.symbols, &world.values);
            let (_, size) = value_and_scale(of, &world.symbols, &world.values);
            let expected = path.slope(of, &world);
            let error = found.minus(&expected).size();
            assert!(
                error <= 1e-5 * (1.0 + scale + size),
                "seed {seed}, {what}: {found:?} instead of {expected:?}\n{}",
                crate::mathematics::symbolic::text(of, &world.symbols)
            );
            nonzero += usize::from(found.size() > 1e-2);
        }
    }
    assert!(nonzero > 1_000, "most random expressions should vary, but only {nonzero} did");
}

/// The rules one by one, in closed form.
#[test]
fn rules() {
    let w = World::new(&mut Random::new(2));
    let symbols = &w.symbols;
    let [a, b, u, v, h, k] = [w.a, w.b, w.u, w.v, w.h, w.k].map(|id| w.expression(id));
    let along = Variations::from([(w.a, b.clone()), (w.u, v.clone()), (w.h, k.clone())]);
    let vary = |x: &Expression| variation(x, &along, symbols);
    let times = |x: &Expression, y: &Expression| x.times(y, symbols);
    assert_eq!(vary(&times(&a, &a)), times(&b, &a).plus(times(&a, &b)));
    assert_eq!(vary(&times(&a, &a).trace(symbols)), times(&a, &b).trace(symbols).scaled(Rational::integer(2)));
    assert_eq!(
        vary(&h.clone().power(-3, symbols)),
        times(&h.clone().power(-4, symbols), &k).scaled(Rational::integer(-3))
    );
    assert_eq!(vary(&u.hat(symbols)), v.hat(symbols));
    assert_eq!(vary(&u.diagonal(symbols)), v.diagonal(symbols));
    assert_eq!(vary(&a.vee(symbols)), b.vee(symbols));
    assert_eq!(vary(&a.transpose(symbols)), b.transpose(symbols));
    assert!(vary(&b).is_zero());
}

/// A group element in an image has to be one: `cay(ξ)` with `ξ = u` and `D = h` its denominator.
#[test]
fn substitution_is_evaluation_elsewhere() {
    for seed in 0..1_500 {
        let mut random = Random::new(seed);
        let mut world = World::new(&mut random);
        let u = world.values[&world.u].clone();
        let denominator = 4.0 + u.transpose().times(&u).at(0, 0);
        world.values.insert(world.k, Matrix::scalar(denominator));
        let symbols = &world.symbols;
        let times = |x: &Expression, y: &Expression| x.times(y, symbols);
        let shape = [(1, 1), (3, 1), (3, 3)][random.below(3)];
        let depth = 1 + random.below(3);
        let expression = both(&mut random, &world, shape, depth).expression;
        let [f, e, xi, d, v, a] = [world.f, world.e, world.u, world.k, world.v, world.a].map(|id| world.expression(id));
        let scalar_part = times(&Expression::rational(Rational::integer(8)).minus(d.clone()), &Expression::identity(3));
        let outer = times(&xi, &xi.transpose(symbols)).scaled(Rational::integer(2));
        let numerator = scalar_part.plus(outer).plus(xi.hat(symbols).scaled(Rational::integer(4)));
        let cayley = times(&d.clone().power(-1, symbols), &numerator);
        let f_t = f.transpose(symbols);
        let maps = [
            BTreeMap::from([(world.f, cayley)]),
            BTreeMap::from([(world.f, Expression::identity(3))]),
            BTreeMap::from([(world.e, times(&times(&f, &e), &f_t)), (world.w, times(&f, &v))]),
            BTreeMap::from([
                (world.h, d.clone().power(2, symbols).plus(Expression::rational(Rational::ONE))),
                (world.u, times(&a, &v).plus(xi.clone())),
                (world.b, times(&a, &f).minus(a.clone())),
                (world.v, xi.clone()),
            ]),
        ];
        for (index, map) in maps.iter().enumerate() {
            let (found, scale) = value_and_scale(&substitute(&expression, map, symbols), symbols, &world.values);
            let mut values = world.values.clone();
            values.extend(map.iter().map(|(id, image)| (*id, value(image, symbols, &world.values))));
            let (expected, size) = value_and_scale(&expression, symbols, &values);
            let error = found.minus(&expected).size();
            assert!(
                error <= 1e-8 * (1.0 + scale + size),
                "seed {seed}, map {index}: {found:?} instead of {expected:?}\n{}",
                crate::mathematics::symbolic::text(&expression, symbols)
            );
        }
    }
}
