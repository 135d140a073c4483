//! The outcome of an ensemble's members, in words.

use liestep_ensemble::{Outcome, Passages};

/// The numbers of members by their outcome.
pub(crate) fn counts(outcome: &Outcome) -> String {
    let Outcome { finished, left, stopped, impossible, .. } = outcome;
    let ended = if *left > 0 { format!("{left} ended by an event, ") } else { String::new() };
    format!("{finished} finished, {ended}{stopped} broke down, {impossible} can't exist")
}

/// The probability of an event, in a line.
#[allow(clippy::cast_precision_loss)] // counts
pub(crate) fn of_event(name: &str, outcome: &Outcome, Passages { times, first }: &Passages) -> String {
    let (all, members) = (outcome.finished + outcome.left, first.count);
    if all == 0 {
        return String::new();
    }
    let share = members as f64 / all as f64;
    let [from, to] = wilson(members as f64, all as f64);
    let often = if *times > members { format!("{times} times ") } else { String::new() };
    let first = if members > 0 {
        let digits = |time: f64| format!("{time:.6e}").parse().unwrap_or(time);
        let [mean, least, largest] = [first.mean, first.least, first.largest].map(digits);
        format!("; first at {mean} s in the mean, from {least} to {largest} s")
    } else {
        String::new()
    };
    format!(
        "  {name}: {often}in {members} of {all} members; probability {share:.4}, with 95 % from {from:.4} to {to:.4}{first}\n"
    )
}

/// The 95 % confidence interval of a probability, for an event that occurred in some of all trials.
///
/// E. B. Wilson, Probable inference, the law of succession, and statistical inference, Journal of the American Statistical
/// Association 22 (1927).
fn wilson(some: f64, all: f64) -> [f64; 2] {
    /// The 97.5 % quantile of the normal distribution.
    const Z: f64 = 1.959_963_984_540_054;
    let (share, z) = (some / all, Z * Z / all);
    let middle = share + 0.5 * z;
    let half = (z * (share * (1.0 - share) + 0.25 * z)).sqrt();
    // At both ends of the range the interval is exact but for rounding.
    [(middle - half) / (1.0 + z), (middle + half) / (1.0 + z)].map(|end| end.clamp(0.0, 1.0))
}
