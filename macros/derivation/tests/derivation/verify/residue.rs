//! Residues modulo `2⁶¹ − 1`, and the stand-ins for functions of them.

use liestep_derivation::judged::verify::dual::Dual;
use liestep_derivation::judged::verify::number::Number;
use liestep_derivation::judged::verify::residue::Residue;
use liestep_derivation::mathematics::symbolic::{Function, Rational};

#[test]
fn it_is_a_field() {
    let mut next = Residue::stream(1);
    for _ in 0..20 {
        let (a, b, c) = (next(), next(), next());
        assert_eq!((a + b) * c - a * c, b * c);
        assert_eq!(a / b * b, a);
        assert_eq!(a.power(-3) * a * a * a, Residue::ONE);
    }
    assert!(!(Residue::ONE / Residue::ZERO).is_defined());
    assert!(!(Residue::ONE / Residue::ZERO * Residue::ZERO).is_defined());
}

#[test]
fn rational_numbers_keep_their_relations() {
    let of = |numerator, denominator| Residue::of(Rational::new(numerator, denominator));
    assert_eq!(of(1, 3) + of(-5, 7), of(-8, 21));
    assert_eq!(of(2, 9) * of(9, 2), Residue::ONE);
}

#[test]
fn functions_keep_no_other_relations() {
    let mut next = Residue::stream(2);
    for _ in 0..20 {
        let x = next();
        assert_ne!((-x).apply(Function::Sqrt), x.apply(Function::Sqrt));
        assert_ne!(x.apply(Function::Stumpff(1)), x.apply(Function::Stumpff(2)));
        // Relations that no derivation uses don't hold for the stand-ins.
        let squared = |function| x.apply(function) * x.apply(function);
        assert_ne!((x * x).apply(Function::Sqrt), x);
        assert_ne!(squared(Function::Sqrt), x);
        assert_ne!(squared(Function::Sin) + squared(Function::Cos), Residue::ONE);
        assert_ne!(squared(Function::Stumpff(0)) + x * squared(Function::Stumpff(1)), Residue::ONE);
        assert_ne!(x.apply(Function::Exp).apply(Function::Ln), x);
        assert_ne!((x + x).apply(Function::Exp), squared(Function::Exp));
        assert_ne!((x * x).apply(Function::Ln), x.apply(Function::Ln) + x.apply(Function::Ln));
    }
    assert_eq!(Residue::ZERO.apply(Function::Cos), Residue::ONE);
    assert_eq!(Residue::ONE.apply(Function::Ln), Residue::ZERO);
    assert!(!Residue::ZERO.apply(Function::Ln).is_defined());
}

/// Functions have other values at other points: otherwise a wrong multiple of `√2` would be right at all points, or
/// wrong at all.
#[test]
fn functions_differ_from_point_to_point() {
    let two = Residue::ONE + Residue::ONE;
    for function in [Function::Sqrt, Function::Sin, Function::Exp, Function::Ln, Function::Stumpff(1)] {
        let values = [5, 6, 5].map(|seed| {
            let _ = Residue::stream(seed);
            two.apply(function)
        });
        assert!(values[0] != values[1] && values[0] == values[2], "{function:?}");
    }
}

/// Asserts the symmetries of the functions, `c_k = 1/k! − q c_{k+2}`, and the relations that the used derivatives of
/// `θ/sin θ` rest on.
fn assert_relations<T: Number>(x: T) {
    let of = |value: u8| T::of(Rational::integer(value.into()));
    let none = |rest: T| assert!(rest.is_zero(), "{rest:?} at {x:?}");
    none((-x).apply(Function::Sin) + x.apply(Function::Sin));
    none((-x).apply(Function::Cos) - x.apply(Function::Cos));
    none((-x).apply(Function::Exp) * x.apply(Function::Exp) - T::ONE);
    none((T::ONE / x).apply(Function::Ln) + x.apply(Function::Ln));
    let mut factorial = T::ONE;
    for k in 0..12 {
        factorial = if k == 0 { factorial } else { factorial * of(k) };
        let [value, above] = [k, k + 2].map(|k| x.apply(Function::Stumpff(k)));
        none(value + x * above - T::ONE / factorial);
    }
    let (u, s) = (x * (T::ONE - x), T::ONE - of(2) * x);
    let g = |k| x.apply(Function::LogRatio(k));
    none(of(2) * u * g(1) + s * g(0) - T::ONE);
    for k in 0..6 {
        none(of(2) * u * g(k + 2) + of(2 * k + 3) * s * g(k + 1) - of(2) * of(k + 1) * of(k + 1) * g(k));
    }
    // The second derivative as a graph computes it.
    none(g(1) * (of(3) - of(8) * u) - of(2) * (T::ONE - s * u * g(2)));
}

/// The derivative of each relation is a relation: dual numbers and stand-ins know the same functions.
#[test]
fn functions_keep_their_relations() {
    let mut next = Residue::stream(3);
    for _ in 0..20 {
        assert_relations(next());
        assert_relations(Dual { value: next(), slope: next() });
    }
}
