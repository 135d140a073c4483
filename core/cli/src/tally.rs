//! The outcome of an ensemble's members, in words.

use std::fmt::Write as _;

use liestep_ensemble::{Histogram, Outcome, Passages};
use liestep_scene::EndHistogram;

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

/// Most signs of a bar.
const LONGEST_BAR: u64 = 40;

/// A histogram with a line for each part of its range, in the unit of the file, and lines for values outside, if there are any.
#[allow(clippy::cast_precision_loss)] // the number of parts
pub(crate) fn bars(of: &EndHistogram, counted: &Histogram) -> String {
    let [from, to] = of.written;
    let end = |at: usize| {
        let share = at as f64 / of.parts as f64;
        let number = from * (1.0 - share) + to * share;
        // Rounding of the share isn't to be seen.
        let number: f64 = format!("{number:.6e}").parse().unwrap_or(number);
        format!("{number} {}", of.unit).trim_end().to_owned()
    };
    let between = |at: usize| format!("{} to {}", end(at), end(at + 1));
    let outside = [(format!("below {}", end(0)), counted.below), (format!("from {} on", end(of.parts)), counted.above)];
    let unknown = (String::from("not a number"), counted.not_a_number);
    let within = counted.counts.iter().enumerate().map(|(at, count)| (between(at), *count));
    let lines: Vec<(String, u64)> =
        within.chain(outside.into_iter().chain([unknown]).filter(|(_, count)| *count > 0)).collect();
    let (most, width) =
        lines.iter().fold((1, 0), |(most, width), (name, count)| (most.max(*count), width.max(name.chars().count())));
    let mut text = format!("  {} at the end, members\n", of.column);
    for (name, count) in lines {
        let length =
            usize::try_from(u128::from(count) * u128::from(LONGEST_BAR) / u128::from(most)).unwrap_or_default();
        let _ = writeln!(text, "{}", format!("    {name:<width$}{count:>10}  {}", "#".repeat(length)).trim_end());
    }
    text
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
