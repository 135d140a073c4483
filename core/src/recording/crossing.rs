//! The zeros of a function on the interval from 0 to 1, isolated and located.

use alloc::vec;
use alloc::vec::Vec;

/// Known data of the function, and the accuracy of the search.
#[derive(Clone, Copy)]
pub(super) struct Looks {
    /// The function's values at 0 and 1.
    pub(super) ends: [f64; 2],
    /// Whether the function was above zero when it last wasn't zero.
    pub(super) above: Option<bool>,
    /// A bound on the function's second derivative.
    pub(super) bound: Option<f64>,
    /// The period of a function whose values go around.
    pub(super) period: Option<f64>,
    /// The accuracy of a zero.
    pub(super) rounding: f64,
}

/// The shortest interval in which two zeros are separated, in parts of the step.
const SHORTEST: f64 = 1.0 / 16_777_216.0;
/// Limit of the evaluations.
const MOST_LOOKS: u32 = 10_000;

/// A part of the interval: its ends, and the function's values there.
#[derive(Clone, Copy)]
struct Part {
    begin: (f64, f64),
    end: (f64, f64),
}

impl Part {
    fn length(&self) -> f64 {
        self.end.0 - self.begin.0
    }

    /// Whether the part has at most one zero, by the signs at its ends: the slope of the chord is that of the function
    /// somewhere in the part, and changes by no more than the bound times the length.
    fn is_monotone(&self, bound: f64) -> bool {
        (self.end.1 - self.begin.1).abs() >= bound * self.length() * self.length()
    }

    /// Whether the part has no zero: if both ends are on one side and the chord isn't so steep, the function is no
    /// nearer to zero than the parabola with this second derivative through the ends, whose vertex has this distance
    /// from zero.
    fn is_clear(&self, bound: f64) -> bool {
        let (a, b) = (self.begin.1, self.end.1);
        let sag = bound * self.length() * self.length();
        a * b > 0.0 && 0.5 * (a.abs() + b.abs()) - sag / 8.0 - (b - a) * (b - a) / (2.0 * sag) > 0.0
    }
}

/// The zeros from left to right, and whether the function rises there. `None` if the search exceeds its limit of
/// evaluations.
pub(super) fn zeros<E>(
    looks: Looks,
    function: &mut impl FnMut(f64) -> Result<f64, E>,
) -> Result<Option<Vec<(f64, bool)>>, E> {
    let Looks { ends, mut above, bound, period, rounding } = looks;
    // Values half a period from zero are neighbours on the circle of values.
    let jumps = |from: f64, to: f64| period.is_some_and(|period| (to - from).abs() > 0.5 * period.abs());
    let (mut found, mut looked) = (Vec::new(), 0);
    let mut parts = vec![Part { begin: (0.0, ends[0]), end: (1.0, ends[1]) }];
    while let Some(part) = parts.pop() {
        let is_plain =
            bound.is_none_or(|bound| part.is_monotone(bound) || part.is_clear(bound) || part.length() <= SHORTEST);
        if !is_plain {
            looked += 1;
            if looked > MOST_LOOKS {
                return Ok(None);
            }
            let middle = 0.5 * (part.begin.0 + part.end.0);
            let middle = (middle, function(middle)?);
            parts.push(Part { begin: middle, ..part });
            parts.push(Part { end: middle, ..part });
            continue;
        }
        let Some(next) = side(part.end.1) else { continue };
        if above.is_some_and(|above| above != next) && !jumps(part.begin.1, part.end.1) {
            let (zero, [before, after]) = located(part, next, rounding, function)?;
            if !jumps(before, after) {
                found.push((zero, next));
            }
        }
        above = Some(next);
    }
    Ok(Some(found))
}

/// Limit of the iterations, in which bisections alone reach rounding.
const MOST_ITERATIONS: u32 = 120;

/// The zero in a part whose ends have different signs, or that begins with a zero, by inverse quadratic interpolation
/// if that is sure to converge and bisection otherwise; and the values at the ends of the last bracket.
///
/// # Source
///
/// T. R. Chandrupatla, A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear function without
/// using derivatives, Advances in Engineering Software 28 (1997).
fn located<E>(
    part: Part,
    rising: bool,
    rounding: f64,
    function: &mut impl FnMut(f64) -> Result<f64, E>,
) -> Result<(f64, [f64; 2]), E> {
    // `a` is the newest point, `b` on the other side of the zero, `c` the one before.
    let (mut a, mut b) = (part.end, part.begin);
    if b.1 == 0.0 || side(b.1) == Some(rising) {
        return Ok((b.0, [b.1; 2]));
    }
    let mut share = 0.5;
    for iteration in 0..MOST_ITERATIONS {
        let place = a.0 + share * (b.0 - a.0);
        let value = function(place)?;
        if value == 0.0 {
            return Ok((place, [value; 2]));
        }
        let c;
        if side(value) == side(a.1) {
            c = a;
        } else {
            (c, b) = (b, a);
        }
        a = (place, value);
        let length = (b.0 - a.0).abs();
        let nearest = rounding.max(f64::EPSILON * place);
        if length <= nearest {
            break;
        }
        let (xi, phi) = ((a.0 - b.0) / (c.0 - b.0), (a.1 - b.1) / (c.1 - b.1));
        let interpolates = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
        share = if interpolates && iteration < MOST_ITERATIONS / 2 {
            let (first, second) = (b.1 - a.1, b.1 - c.1);
            let along = (c.0 - a.0) / (b.0 - a.0);
            a.1 / first * c.1 / second + along * a.1 / (c.1 - a.1) * b.1 / (c.1 - b.1)
        } else {
            0.5
        };
        // The next point keeps a distance of the accuracy from both ends, so that in the end both sides are that near.
        let least = (nearest / length).min(0.5);
        share = if share.is_nan() { 0.5 } else { share.clamp(least, 1.0 - least) };
    }
    Ok((if a.1.abs() <= b.1.abs() { a.0 } else { b.0 }, [a.1, b.1]))
}

/// Whether a value is above zero; none for zero.
pub(super) fn side(value: f64) -> Option<bool> {
    if value == 0.0 { None } else { Some(value > 0.0) }
}

#[cfg(test)]
mod tests {
    use super::{Looks, zeros};
    use alloc::vec::Vec;
    use core::convert::Infallible;
    use std::cell::Cell;

    /// The zeros of a function with this bound, and the number of evaluations.
    fn found(bound: Option<f64>, function: impl Fn(f64) -> f64) -> (Vec<(f64, bool)>, u32) {
        found_around(None, bound, function)
    }

    /// [`found`] of a function whose values go around with this period.
    fn found_around(period: Option<f64>, bound: Option<f64>, function: impl Fn(f64) -> f64) -> (Vec<(f64, bool)>, u32) {
        let count = Cell::new(0);
        let mut look = |x: f64| -> Result<f64, Infallible> {
            count.set(count.get() + 1);
            Ok(function(x))
        };
        let ends = [function(0.0), function(1.0)];
        let looks = Looks { ends, above: super::side(ends[0]), bound, period, rounding: 0.25 * f64::EPSILON };
        let Ok(zeros) = zeros(looks, &mut look);
        (zeros.unwrap(), count.get())
    }

    #[test]
    fn a_zero_is_located_to_rounding() {
        for k in 1..1000 {
            let zero = f64::from(k) / 1000.0;
            for (function, most) in [
                (&(|x: f64| (x - zero).sin()) as &dyn Fn(f64) -> f64, 10),
                (&|x| (x * x * x - zero * zero * zero).exp_m1(), 40),
                (&|x| (x - zero).powi(3), 120),
            ] {
                let (found, looks) = found(None, function);
                assert!(matches!(found.as_slice(), [(place, true)] if (place - zero).abs() <= 4e-16), "{found:?}");
                assert!(looks <= most, "{looks} looks for {zero}");
            }
        }
    }

    /// Pairs down to a distance of 10⁻⁷ of a step, some functions with two, and functions that just miss zero.
    #[test]
    fn no_pair_is_missed_where_a_bound_is_known() {
        for k in 0..200 {
            let (place, half) = (0.03 + 0.0047 * f64::from(k), 0.05 * 0.1_f64.powf(0.03 * f64::from(k)));
            let offset = 2.0 * (3.5 * half).sin().powi(2);
            let curved = |x: f64, offset: f64| offset - 2.0 * (3.5 * (x - place)).sin().powi(2);
            let period = 2.0 * core::f64::consts::PI / 7.0;
            let expected = [-period, 0.0, period].map(|shift| [place + shift - half, place + shift + half]);
            let expected = expected.as_flattened().iter().filter(|x| (0.0..=1.0).contains(*x));
            let (zeros, looks) = found(Some(49.1), |x| curved(x, offset));
            assert_eq!(zeros.len(), expected.clone().count(), "{place} {half}: {zeros:?}");
            for ((zero, _), expected) in zeros.iter().zip(expected) {
                assert!((zero - expected).abs() < 1e-16 / half, "{place} {half}: {zero} for {expected}");
            }
            assert!(looks < 400, "{looks} looks");
            assert!(found(Some(49.1), |x| curved(x, -offset)).0.is_empty());
        }
    }

    /// An angle in turns, from −½ to ½, rises or falls by up to 0.9 turns from many places; its zeros are whole turns.
    #[test]
    fn a_jump_of_an_angle_is_no_zero() {
        for k in 0..400 {
            for turn in [0.07, 0.4, 0.6, 0.9, -0.07, -0.4, -0.6, -0.9] {
                let first = 0.0013 + 0.0025 * f64::from(k);
                let whole = |x: f64| first + turn * x;
                let angle = |x: f64| whole(x) - whole(x).round();
                let turns = if turn > 0.0 { [1.0, 2.0] } else { [0.0, 1.0] };
                let expected = turns.map(|whole| (whole - first) / turn);
                let expected: Vec<f64> = expected.into_iter().filter(|x| (0.0..1.0).contains(x)).collect();
                // Beyond half a turn only a bound finds a zero and a jump in one step.
                let bound = (turn.abs() > 0.5).then_some(16.0);
                let (zeros, looks) = found_around(Some(1.0), bound, angle);
                assert_eq!(zeros.len(), expected.len(), "{first} {turn}: {zeros:?}");
                for (&(zero, rises), expected) in zeros.iter().zip(expected) {
                    assert!((zero - expected).abs() < 1e-14 && rises == (turn > 0.0), "{first} {turn}: {zero}");
                }
                assert!(bound.is_some() || looks <= if zeros.is_empty() { 0 } else { 10 }, "{looks} looks");
            }
        }
    }

    #[test]
    fn a_step_far_from_zero_takes_no_look() {
        assert_eq!(found(Some(49.0), |x| 8.0 + (7.0 * x).cos()), (Vec::new(), 0));
        assert_eq!(found(None, |x| (7.0 * x).cos() + 2.0), (Vec::new(), 0));
    }
}
