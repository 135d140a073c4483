//! The rules of variations, and substitution against other values. Whole variations are what dual numbers give: the check of
//! each declaration compares them.

use std::collections::BTreeMap;

use super::numeric::{Matrix, value, value_and_scale};
use super::random::{Random, World, both};
use crate::mathematics::symbolic::{Expression, Rational, Variations, substitute, variation};

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
    assert!(vary(&b).is_zero() && vary(&w.expression(w.second)).is_zero());
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
