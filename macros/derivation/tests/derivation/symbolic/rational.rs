//! Fractions of whole numbers.

use liestep_derivation::mathematics::symbolic::Rational;

#[test]
fn decimals_are_exact() {
    assert_eq!(Rational::from_decimal("9.81"), Rational::new(981, 100));
    assert_eq!(Rational::from_decimal("2.50e-3"), Rational::new(1, 400));
    assert_eq!(Rational::from_decimal("3e2"), Rational::integer(300));
    assert!(Rational::from_decimal("1e300").is_overflow());
}

#[test]
fn overflow_sticks() {
    let large = Rational::integer(i128::MAX);
    assert!((large * large + Rational::ONE).is_overflow());
    assert!((Rational::OVERFLOW * Rational::ZERO).is_overflow());
    assert!(Rational::new(i128::MIN, 1).is_overflow() && Rational::new(1, i128::MIN).is_overflow());
}

#[test]
fn powers() {
    assert_eq!(Rational::new(-2, 3).power(3), Rational::new(-8, 27));
    assert_eq!(Rational::new(-2, 3).power(-4), Rational::new(81, 16));
    assert_eq!(Rational::new(7, 2).power(0), Rational::ONE);
    assert_eq!((-Rational::ONE).power(i32::MAX), -Rational::ONE);
    assert!(Rational::integer(3).power(i32::MIN).is_overflow());
}
