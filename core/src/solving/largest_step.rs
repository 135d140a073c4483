//! The largest fraction of a step that will do.

roots!();

/// The largest fraction of one that passes, to six digits: one itself if that does, `None` if nothing above 10⁻³⁰⁰
/// does.
///
/// What is returned passes. Where larger fractions pass again beyond one that fails, any of these bounds may be found.
pub(crate) fn largest_fraction(passes: impl Fn(f64) -> bool) -> Option<f64> {
    if passes(1.0) {
        return Some(1.0);
    }
    // Halving down to a fraction that passes first keeps the digits where only a tiny one does.
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

/// Rounded towards zero, as a step a little larger than the largest wouldn't do.
pub(crate) fn six_digits(step: f64) -> f64 {
    let unit = 10.0_f64.powf(5.0 - step.abs().log10().floor());
    // Not for zero and what is next to it.
    if unit.is_finite() { (step * unit).trunc() / unit } else { step }
}
