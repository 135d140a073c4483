//! Steps along a Kepler orbit.

use alloc::vec::Vec;
use core::f64::consts::TAU;

roots!();

/// Number of rectangles for an integral over a round, whose error falls exponentially with it.
const RECTANGLES: u32 = 65_536;
/// Number of parts of a step of the clock, for the classical Runge–Kutta method.
const PARTS: u32 = 8;

/// The lengths of a round from this mean anomaly, rad, `dt ∝ r^{3/2}`; from pericentre symmetric about both apsides.
pub(super) fn orbit(start: f64, eccentricity: f64, period: f64, steps: u32) -> Vec<f64> {
    // For the eccentric anomaly `E`, `r = 1 − e cos E` and `dt = r dE`: steps are equal in `s`, `ds = r^{-1/2} dE`.
    let rate = |anomaly: f64| (1.0 - eccentricity * anomaly.cos()).sqrt();
    let width = TAU / f64::from(RECTANGLES);
    let all: f64 = (0..RECTANGLES).map(|k| width / rate(width * f64::from(k))).sum();
    let part = all / (f64::from(steps) * f64::from(PARTS));
    // Bisection for the eccentric anomaly of the start. Its rounding moves the start and no length of a step.
    let halved = |(low, high): (f64, f64), _| {
        let middle = 0.5 * (low + high);
        if middle - eccentricity * middle.sin() > start { (low, middle) } else { (middle, high) }
    };
    let is_from_pericentre = start == 0.0;
    let first = if is_from_pericentre { 0.0 } else { (0..60).fold((start - 1.0, start + 1.0), halved).0 };
    let (mut anomaly, mut times) = (first, [0.0].to_vec());
    for _ in 0..if is_from_pericentre { steps / 2 } else { steps - 1 } {
        for _ in 0..PARTS {
            let first = rate(anomaly);
            let second = rate(anomaly + 0.5 * part * first);
            let third = rate(anomaly + 0.5 * part * second);
            let fourth = rate(anomaly + part * third);
            anomaly += part / 6.0 * (first + 2.0 * (second + third) + fourth);
        }
        times.push(period / TAU * (anomaly - first - eccentricity * (anomaly.sin() - first.sin())));
    }
    if !is_from_pericentre {
        times.push(period);
        return times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    }
    let is_even = steps.is_multiple_of(2);
    if let Some(apocentre) = times.last_mut().filter(|_| is_even) {
        *apocentre = 0.5 * period;
    }
    let mut lengths: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let back: Vec<f64> = lengths.iter().rev().copied().collect();
    if let Some(&last) = times.last().filter(|_| !is_even) {
        lengths.push(period - 2.0 * last);
    }
    lengths.extend(back);
    lengths
}
