//! The largest fraction of a step that can be solved.

roots!();

/// Exponent of the smallest fraction that is tried, `2⁻⁹⁹⁶ ≈ 10⁻³⁰⁰`.
const SMALLEST: i32 = 996;

/// The largest fraction up to one that passes, to six digits; `None` if no fraction above 10⁻³⁰⁰ passes.
///
/// The returned fraction passes. If larger fractions pass again beyond one that fails, any of these bounds may be
/// found.
#[must_use]
pub fn largest_fraction(passes: impl Fn(f64) -> bool) -> Option<f64> {
    if passes(1.0) {
        return Some(1.0);
    }
    // The power of two below the bound, by doubled exponents and by bisection: a tiny fraction keeps its digits.
    let power = |exponent: i32| 2.0_f64.powi(-exponent);
    let (mut fails, mut exponent) = (0, 1);
    while !passes(power(exponent)) {
        if exponent == SMALLEST {
            return None;
        }
        (fails, exponent) = (exponent, SMALLEST.min(2 * exponent));
    }
    while exponent - fails > 1 {
        let middle = i32::midpoint(fails, exponent);
        if passes(power(middle)) { exponent = middle } else { fails = middle }
    }
    let (mut low, mut high) = (power(exponent), power(fails));
    while high - low > 1e-6 * high {
        let middle = 0.5 * (low + high);
        if passes(middle) { low = middle } else { high = middle }
    }
    Some(low)
}

/// A step rounded towards zero, as a step slightly above the largest can't be solved.
#[must_use]
pub fn six_digits(step: f64) -> f64 {
    let unit = 10.0_f64.powf(5.0 - step.abs().log10().floor());
    // The unit isn't finite for zero and its neighbours.
    if unit.is_finite() { (step * unit).trunc() / unit } else { step }
}
