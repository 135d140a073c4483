//! Power series in `h`.

use liestep_derivation::judged::verify::number::{Number as _, derivative};
use liestep_derivation::judged::verify::residue::Residue;
use liestep_derivation::judged::verify::series::{LENGTH_I32, Series};
use liestep_derivation::mathematics::symbolic::{Function, Rational};

#[test]
fn what_has_no_value() {
    let (h, zero) = (Series::STEP, Series::ONE - Series::ONE);
    assert!(zero.is_zero() && (zero * h).is_zero() && zero.order().is_none());
    for undefined in [Series::ONE / zero, zero.power(-1), h.apply(Function::Sqrt), h.apply(Function::Ln)] {
        assert!(!undefined.is_defined() && !(undefined * zero + h).is_defined(), "{undefined:?}");
    }
    assert!(!(Series::ONE / h).apply(Function::Exp).is_defined());
}

/// Asserts that two series are equal as far as both are known, and that this is up to a power at least.
fn assert_equal(found: Series, expected: Series, known: i32) {
    let rest = found - expected;
    assert!(rest.is_defined() && rest.is_zero() && rest.is_known_below(known), "{found:?} and {expected:?}");
}

/// The series `a + b h + c h²` with numbers of the field.
fn quadratic(next: &mut impl FnMut() -> Residue) -> Series {
    let h = Series::STEP;
    let [a, b, c] = [next(), next(), next()].map(Series::constant);
    a + h * (b + h * c)
}

/// The derivative of a root is `y' = y/(2x)` for its stand-in, so that `y²/x` stays what it is at the first
/// coefficient.
#[test]
fn roots_in_the_field() {
    let (mut next, h) = (Residue::stream(3), Series::STEP);
    for half in [0, 1, 2] {
        let x = quadratic(&mut next);
        let root = (x * h.power(2 * half)).apply(Function::Sqrt);
        let [first, of_first] = [x.at(0), x.at(0).apply(Function::Sqrt)].map(Series::constant);
        assert_eq!(root.order(), Some(half));
        assert_eq!(root.at(half), of_first.at(0));
        assert_equal(root * root * first, x * h.power(2 * half) * of_first * of_first, LENGTH_I32);
    }
    for undefined in [h, h.power(3), Series::UNDEFINED] {
        assert!(!undefined.apply(Function::Sqrt).is_defined(), "{undefined:?}");
    }
}

/// Series of functions obey the chain rule, `f(x(h))' = f'(x) x'` with the derivatives of dual numbers, and
/// `1/(1 − h) = Σ hⁿ`.
#[test]
fn functions_in_the_field() {
    let (mut next, h, one) = (Residue::stream(4), Series::STEP, Series::ONE);
    let slope = |y: Series| {
        let terms = (1..LENGTH_I32).map(|n| {
            let factor = Residue::of(Rational::integer(n.into()));
            Series::constant(y.at(n) * factor) * h.power(n - 1)
        });
        terms.fold(Series::ZERO, |sum, term| sum + term)
    };
    // The slope is known below the last power of a series with seven coefficients.
    let assert_slope = |y, expected: Series| {
        for power in 0..LENGTH_I32 - 1 {
            assert_eq!(slope(y).at(power), expected.at(power), "{y:?}");
        }
    };
    let families = [0, 1, 2].into_iter().flat_map(|k| [Function::Stumpff(k), Function::LogRatio(k)]);
    let functions: Vec<Function> =
        [Function::Ln, Function::Exp, Function::Sin, Function::Cos].into_iter().chain(families).collect();
    for _ in 0..3 {
        let x = quadratic(&mut next);
        for &function in &functions {
            let of_x = x.apply(function);
            assert_slope(of_x, derivative(function, x, || of_x) * slope(x));
        }
        assert_eq!(x.apply(Function::Ln).at(0), x.at(0).apply(Function::Ln));
        assert_equal(x * x.power(-1), one, LENGTH_I32);
    }
    let geometric = one / (one - h);
    assert!((0..LENGTH_I32).all(|n| geometric.at(n) == Residue::ONE));
}

/// The Stumpff functions are `Σ (−x)ⁱ/(2i + k)!` about zero.
#[test]
fn stumpff_in_the_field() {
    let small = |n: usize| Residue::of(Rational::integer(n.try_into().expect("small")));
    for k in 0..4_u8 {
        let series = Series::STEP.apply(Function::Stumpff(k));
        let mut expected = (1..=k).fold(Residue::ONE, |product, n| product / small(n.into()));
        for power in 0..LENGTH_I32 {
            assert_eq!(series.at(power), expected, "{k}");
            let next = usize::try_from(2 * power).expect("positive") + usize::from(k);
            expected = -expected / (small(next + 1) * small(next + 2));
        }
    }
}
