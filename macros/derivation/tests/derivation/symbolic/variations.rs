//! The rules of variations. Whole variations are what dual numbers give: the check of each declaration compares them.

use crate::common::random::{Random, World};
use liestep_derivation::mathematics::symbolic::{Expression, Rational, Variations, variation};

/// The rules of variation one by one, in closed form.
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
