//! The measure of an error: the parts of a motion, each judged in units of its own.

use alloc::vec::Vec;

use crate::groups::layout::Factor;

roots!();

/// Numbers that are judged together: a rotation with its angular velocity, or a place with its velocity.
#[derive(Clone, Debug)]
struct Part {
    /// The places of the entries in an attitude.
    entries: Vec<usize>,
    /// The places of the components in a velocity.
    components: Vec<usize>,
    /// Whether it is a place; otherwise a rotation, or another group's block of matrices.
    is_place: bool,
    /// The sizes of a place's motion that were seen.
    seen: Sizes,
}

/// The sizes in which a place and its velocity are counted: the farthest from the start, and the fastest.
#[derive(Clone, Copy, Debug, Default)]
struct Sizes {
    way: f64,
    speed: f64,
}

/// The measure of the errors of a system's motion, see [`Accuracy`](super::Accuracy).
#[derive(Clone, Debug)]
pub struct Measure {
    /// The parts of the factors; each number that moves is in one.
    parts: Vec<Part>,
    /// Places in translations of equal dimension, which are also judged relative to their mean, with the sizes of their motion about
    /// it.
    together: Vec<(Vec<usize>, Vec<Sizes>)>,
    /// The least length in which places count.
    length: f64,
}

/// The least length in which places count where the system has none, in their unit.
pub(super) const LEAST_LENGTH: f64 = 1e-9;
/// The share of a place in which its error is counted at least, so that roundings of places far off don't count.
const FAR_OFF: f64 = 1e-6;

/// An end of a run, as two lists: the entries of the attitude, and the components of the velocity.
type State<'a> = [&'a [f64]; 2];

impl Measure {
    /// The measure of motions on a group with these factors. `length` is that of the system in which its places count at least, in the
    /// unit of the places, 10⁻⁹ where none is known.
    #[must_use]
    pub fn new(factors: &[Factor], length: Option<f64>) -> Self {
        let (mut parts, mut together): (Vec<Part>, Vec<(usize, Vec<usize>)>) = Default::default();
        let (mut entry, mut component) = (0, 0);
        for factor in factors {
            let (rows, head) = (factor.kind.rows(), factor.head);
            let block = |columns: core::ops::Range<usize>| -> Vec<usize> {
                let row = |row: usize| columns.clone().map(move |column| entry + row * rows + column);
                (0..head).flat_map(row).collect()
            };
            let moving = |is_place: bool| -> Vec<usize> {
                let own = factor.translates.iter().enumerate().filter(|(_, place)| **place == is_place);
                own.map(|(at, _)| component + at).collect()
            };
            for (is_place, entries) in [(false, block(0..head)), (true, block(head..rows))] {
                let part = Part { entries, components: moving(is_place), is_place, seen: Sizes::default() };
                if part.components.is_empty() {
                    continue;
                }
                // Velocities of other groups are in the axes of the body, and have no mean.
                if factor.is_translation() {
                    match together.iter_mut().find(|(dimension, _)| *dimension == part.components.len()) {
                        Some((_, alike)) => alike.push(parts.len()),
                        None => together.push((part.components.len(), [parts.len()].into())),
                    }
                }
                parts.push(part);
            }
            (entry, component) = (entry + rows * rows, component + factor.components.len());
        }
        let alike = together.into_iter().map(|(_, alike)| alike).filter(|alike| alike.len() > 1);
        let together = alike.map(|alike| (alike.clone(), alloc::vec![Sizes::default(); alike.len()])).collect();
        Self { parts, together, length: length.unwrap_or(LEAST_LENGTH) }
    }

    /// Takes up a state of the motion between start and end, so that places count relative to the way to it, and their velocities
    /// relative to those there.
    pub fn see(&mut self, start: State<'_>, state: State<'_>) {
        for (alike, sizes) in &mut self.together {
            let [start, now] = [start, state].map(|state| of_mean(&self.parts, alike, state));
            sizes.iter_mut().zip(start.iter().zip(&now)).for_each(|(sizes, (start, now))| sizes.see(start, now));
        }
        for part in &mut self.parts {
            let [start, now] = [start, state].map(|state| part.of(state));
            part.seen.see(&start, &now);
        }
    }

    /// The error of an end of a run, without a unit. The numbers of both ends and of the start are the entries of the attitude, the
    /// matrices of the factors row by row, and the components of the velocity; `time` is that of the run, s, whose sign doesn't
    /// matter. It isn't finite where a number isn't.
    #[must_use]
    pub fn error(&self, end: State<'_>, exact: State<'_>, start: State<'_>, time: f64) -> f64 {
        let of_part = |part: &Part| {
            let states = [end, exact, start].map(|state| part.of(state));
            self.apart(&states, (part.is_place, time), part.seen)
        };
        let of_mean = |(alike, sizes): &(Vec<usize>, Vec<Sizes>)| {
            let [end, exact, start] = [end, exact, start].map(|state| of_mean(&self.parts, alike, state));
            let parts = end.into_iter().zip(exact).zip(start).zip(sizes);
            parts.fold(0.0, |most, (((end, exact), start), seen)| {
                worse(most, self.apart(&[end, exact, start], (true, time), *seen))
            })
        };
        let errors = self.parts.iter().map(of_part).chain(self.together.iter().map(of_mean));
        errors.fold(0.0, worse)
    }

    /// The error of a part's end beside the exact one, after the start.
    fn apart(&self, [end, exact, start]: &[[Vec<f64>; 2]; 3], (is_place, time): (bool, f64), seen: Sizes) -> f64 {
        let mut sizes = if is_place { seen } else { Sizes::default() };
        sizes.see(start, exact);
        let speed = self.rate(is_place, time).max(sizes.speed);
        let distance = size(exact[0].iter().copied());
        let unit = if is_place { self.length.max(sizes.way).max(FAR_OFF * distance) } else { distance };
        let [of_place, of_velocity] = [0, 1].map(|number| away(&end[number], &exact[number]));
        (of_place / unit).hypot(of_velocity / speed)
    }

    /// The slowest velocity in which a part's is counted.
    fn rate(&self, is_place: bool, time: f64) -> f64 {
        if is_place { self.length / time.abs() } else { time.abs().recip() }
    }

    /// The sizes in which the components of a velocity are counted at the start.
    pub(super) fn speeds(&self, start: &[f64], time: f64) -> Vec<f64> {
        let mut speeds = alloc::vec![0.0; start.len()];
        for part in &self.parts {
            let of_part = picked(start, &part.components).into_iter();
            let seen = if part.is_place { part.seen.speed } else { 0.0 };
            let speed = self.rate(part.is_place, time).max(size(of_part)).max(seen);
            for component in &part.components {
                speeds[*component] = speed;
            }
        }
        speeds
    }

    /// The attitude displaced to that `beside`, where places below one are displaced in proportion.
    pub(super) fn displaced(&self, attitude: &[f64], beside: &[f64]) -> Vec<f64> {
        let mut displaced = beside.to_vec();
        for part in self.parts.iter().filter(|part| part.is_place) {
            let own = size(picked(attitude, &part.entries).into_iter()).max(part.seen.way).max(self.length).min(1.0);
            for entry in &part.entries {
                displaced[*entry] = attitude[*entry] + (beside[*entry] - attitude[*entry]) * own;
            }
        }
        displaced
    }
}

impl Sizes {
    fn see(&mut self, start: &[Vec<f64>; 2], now: &[Vec<f64>; 2]) {
        self.way = self.way.max(away(&now[0], &start[0]));
        self.speed = self.speed.max(size(start[1].iter().copied())).max(size(now[1].iter().copied()));
    }
}

impl Part {
    /// The numbers of a part.
    fn of(&self, [attitude, velocity]: State<'_>) -> [Vec<f64>; 2] {
        [picked(attitude, &self.entries), picked(velocity, &self.components)]
    }
}

fn picked(numbers: &[f64], places: &[usize]) -> Vec<f64> {
    places.iter().map(|place| numbers.get(*place).copied().unwrap_or(f64::NAN)).collect()
}

/// Places and velocities of these parts relative to their means.
fn of_mean(parts: &[Part], alike: &[usize], state: State<'_>) -> Vec<[Vec<f64>; 2]> {
    let mut parts: Vec<_> = alike.iter().map(|part| parts[*part].of(state)).collect();
    #[allow(clippy::cast_precision_loss)] // a number of bodies
    let count = parts.len() as f64;
    for kind in 0..2 {
        for number in 0..parts.first().map_or(0, |part| part[kind].len()) {
            let mean = parts.iter().map(|part| part[kind][number]).sum::<f64>() / count;
            for part in &mut parts {
                part[kind][number] -= mean;
            }
        }
    }
    parts
}

/// The larger one of two errors; one that is no number is the largest.
fn worse(one: f64, other: f64) -> f64 {
    if one >= other || one.is_nan() { one } else { other }
}

fn away(one: &[f64], other: &[f64]) -> f64 {
    size(one.iter().zip(other).map(|(a, b)| a - b))
}

fn size(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |squares, number| squares + number * number).sqrt()
}
