//! The largest fraction of a step that can be solved.

roots!();

/// The largest fraction up to one that passes, to six digits; `None` if no fraction above 10⁻³⁰⁰ passes.
///
/// The returned fraction passes. If larger fractions pass again beyond one that fails, any of these bounds may be
/// found.
pub fn largest_fraction(passes: impl Fn(f64) -> bool) -> Option<f64> {
    if passes(1.0) {
        return Some(1.0);
    }
    // Halving until a fraction passes retains the digits of a tiny one.
    let mut low = 1.0;
    while !passes(low) {
        low *= 0.5;
        if low < 1e-300 {
            return None;
        }
    }
    let mut high = 2.0 * low;
    while high - low > 1e-6 * high {
        let middle = 0.5 * (low + high);
        if passes(middle) { low = middle } else { high = middle }
    }
    Some(low)
}

/// A step rounded towards zero, as a step slightly above the largest can't be solved.
pub fn six_digits(step: f64) -> f64 {
    let unit = 10.0_f64.powf(5.0 - step.abs().log10().floor());
    // The unit isn't finite for zero and its neighbours.
    if unit.is_finite() { (step * unit).trunc() / unit } else { step }
}
