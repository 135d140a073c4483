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
}

/// The measure of the errors of a system's motion, see [`Accuracy`](super::Accuracy).
#[derive(Clone, Debug)]
pub struct Measure {
    /// The parts of the factors; each number that moves is in one.
    parts: Vec<Part>,
    /// Places in translations of equal dimension, which are also judged relative to their mean.
    together: Vec<Vec<usize>>,
    /// The length of the system in which its places count.
    length: f64,
}

/// An end of a run, as two lists: the entries of the attitude, and the components of the velocity.
type State<'a> = [&'a [f64]; 2];

impl Measure {
    /// The measure of motions on a group with these factors. `length` is that of the system in which its places count, in the unit of
    /// the places, as 1 m where none is known.
    #[must_use]
    pub fn new(factors: &[Factor], length: f64) -> Self {
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
                let part = Part { entries, components: moving(is_place), is_place };
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
        let together = together.into_iter().map(|(_, alike)| alike).filter(|alike| alike.len() > 1).collect();
        Self { parts, together, length }
    }

    /// The error of an end of a run, without a unit. Its numbers and those of the `exact` end are the entries of the attitude, the
    /// matrices of the factors row by row, and the components of the velocity; `start` has those of the velocity at the start, and
    /// `time` is that of the run, s, whose sign doesn't matter. It isn't finite where a number isn't.
    #[must_use]
    pub fn error(&self, end: State<'_>, exact: State<'_>, start: &[f64], time: f64) -> f64 {
        let of_part = |part: &Part| {
            let [end, exact] = [end, exact].map(|state| part.of(state));
            self.apart([&end, &exact], &picked(start, &part.components), (part.is_place, time))
        };
        let of_mean = |alike: &Vec<usize>| {
            let parts: Vec<_> = alike.iter().map(|part| &self.parts[*part]).collect();
            let [end, exact] = [end, exact].map(|state| from_mean(parts.iter().map(|part| part.of(state)).collect()));
            let start = from_mean(parts.iter().map(|part| [Vec::new(), picked(start, &part.components)]).collect());
            let errors = end.iter().zip(&exact).zip(&start);
            errors
                .fold(0.0, |most, ((end, exact), start)| worse(most, self.apart([end, exact], &start[1], (true, time))))
        };
        let errors = self.parts.iter().map(of_part).chain(self.together.iter().map(of_mean));
        errors.fold(0.0, worse)
    }

    /// The error of a part.
    fn apart(&self, [end, exact]: [&[Vec<f64>; 2]; 2], start: &[f64], (is_place, time): (bool, f64)) -> f64 {
        let apart = |number: usize| size(end[number].iter().zip(&exact[number]).map(|(a, b)| a - b));
        let speed = self.rate(is_place, time).max(size(start.iter().copied())).max(size(exact[1].iter().copied()));
        let distance = size(exact[0].iter().copied());
        let unit = if is_place { self.length.max(distance.min(speed * time.abs())) } else { distance };
        (apart(0) / unit).hypot(apart(1) / speed)
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
            let speed = self.rate(part.is_place, time).max(size(of_part));
            for component in &part.components {
                speeds[*component] = speed;
            }
        }
        speeds
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

/// Places and velocities relative to their means.
fn from_mean(mut parts: Vec<[Vec<f64>; 2]>) -> Vec<[Vec<f64>; 2]> {
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

fn size(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |squares, number| squares + number * number).sqrt()
}
