//! The numbers of a state: attitudes, momenta, the memory for the next guess and of momenta before and after their projection, and the
//! number of steps.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use nalgebra::{Matrix3, Matrix4, Vector6};

use super::Body;
use crate::groups::{R3, SO3};
use crate::motion::{Factor, FactorKind, Layout};
use crate::numbers::{OnRegisters, Register, on_registers};

/// The entries of an attitude: a rotation and a translation.
const ATTITUDE: usize = 9 + 16;

/// The number of backward differences of increments, from which the next one is guessed. Eight increments at equal
/// times predict the next to some `(h ω)⁸` for their fastest frequency `ω`; each further one would double the rounding
/// in the guess.
const DIFFERENCES: usize = 7;

/// The layout of the states of a number of bodies, with a memory for each stage of a step.
pub(super) fn layout(bodies: usize, stages: usize) -> Layout {
    let of_body = |body: usize| {
        let kinds = [FactorKind::Rotation, FactorKind::Translation(4)];
        (1..).zip(kinds).map(move |(place, kind)| Factor::of(kind, 3).at(2 * body + place))
    };
    let memory = stages * memory(bodies);
    Layout { factors: (0..bodies).flat_map(of_body).collect(), advected: Vec::new(), memory }
}

/// The length of the memory of a stage.
fn memory(bodies: usize) -> usize {
    6 * bodies * (4 + DIFFERENCES) + 1
}

/// The places of a state's numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Offsets {
    bodies: usize,
    stages: usize,
}

impl Offsets {
    pub(super) fn of(bodies: usize, stages: usize) -> Self {
        Self { bodies, stages }
    }

    /// The number of entries.
    pub(super) fn length(self) -> usize {
        self.memory_of(self.stages).start + 1
    }

    /// The number of entries of all attitudes.
    pub(super) fn attitudes(self) -> usize {
        ATTITUDE * self.bodies
    }

    /// The memory of a stage.
    pub(super) fn memory_of(self, stage: usize) -> Range<usize> {
        let start = (ATTITUDE + 6) * self.bodies + stage * memory(self.bodies);
        start..start + memory(self.bodies)
    }

    /// A state of zeros.
    pub(super) fn zeros(self) -> Vec<f64> {
        vec![0.0; self.length()]
    }

    pub(super) fn momentum(self, state: &[f64], body: usize) -> Vector6<f64> {
        Vector6::from_column_slice(&state[self.attitudes() + 6 * body..][..6])
    }

    /// Writes bodies and their momenta, from which the next step starts, too.
    pub(super) fn write(self, state: &mut [f64], bodies: &[Body], momenta: &[Vector6<f64>]) {
        for (entries, body) in state.chunks_mut(ATTITUDE).zip(bodies) {
            write_body(entries, body);
        }
        self.write_momenta(state, momenta);
    }

    /// Writes momenta, from which the next step starts, too.
    pub(super) fn write_momenta(self, state: &mut [f64], momenta: &[Vector6<f64>]) {
        for (entries, momentum) in state[self.attitudes()..].chunks_mut(6).zip(momenta) {
            entries.copy_from_slice(momentum.as_slice());
        }
        self.start_from_momenta(state, 0);
    }

    /// The places of the momenta from which the next step of a stage starts.
    fn unprojected(self, stage: usize) -> Range<usize> {
        let start = self.memory_of(stage).start + 6 * self.bodies * (2 + DIFFERENCES);
        start..start + 6 * self.bodies
    }

    /// Writes the momenta from which the next step starts, whose projection are those of the state.
    pub(super) fn write_unprojected(self, state: &mut [f64], momenta: &[Vector6<f64>]) {
        self.start_from_momenta(state, 0);
        for (entries, momentum) in state[self.unprojected(0)].chunks_mut(6).zip(momenta) {
            entries.copy_from_slice(momentum.as_slice());
        }
    }

    /// Lets the next step of a stage start from the state's momenta.
    pub(super) fn start_from_momenta(self, state: &mut [f64], stage: usize) {
        let to = self.unprojected(stage);
        state.copy_within(self.momenta(), to.start);
        state.copy_within(self.momenta(), to.end);
    }

    /// The places of the momenta.
    fn momenta(self) -> Range<usize> {
        self.attitudes()..self.attitudes() + 6 * self.bodies
    }

    /// The momenta from which a step starts: those before their projection, unless those of the state have been changed since then.
    pub(super) fn starting(self, state: &[f64]) -> &[f64] {
        let (unprojected, momenta) = (self.unprojected(0), &state[self.momenta()]);
        // Behind the momenta before the projection are those after it, as the step wrote them.
        let written = state[unprojected.end..].iter().take(momenta.len()).map(|part| part.to_bits());
        if momenta.iter().map(|part| part.to_bits()).eq(written) { &state[unprojected] } else { momenta }
    }

    /// The guess of a body's half increment in the first stage.
    pub(super) fn guess(self, state: &[f64], body: usize) -> Vector6<f64> {
        Vector6::from_column_slice(&state[self.memory_of(0).start + 6 * (self.bodies + body)..][..6])
    }

    /// The memory of a stage before the first step, from an estimate of the half increments.
    pub(super) fn begin(self, state: &mut [f64], stage: usize, halves: &[Vector6<f64>]) {
        let memory = &mut state[self.memory_of(stage)];
        memory.fill(0.0);
        for both in memory.chunks_mut(6 * self.bodies).take(2) {
            for (entries, half) in both.chunks_mut(6).zip(halves) {
                entries.copy_from_slice(half.as_slice());
            }
        }
        self.start_from_momenta(state, stage);
    }

    /// Extrapolates the guess of the first stage, by the polynomial through the last increments: the value `y + ∇ y + ∇² y + …`. If an
    /// increment is `far` from the identity, it is the guess itself. The estimate before the first step isn't used.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)] // a few
    pub(super) fn follow(self, state: &mut [f64], halves: &[Vector6<f64>], is_far: bool) {
        let (is_guessed, all) = (!is_far && self.steps(state) != 0.0, 6 * self.bodies);
        let memory = &mut state[self.memory_of(0)];
        let known = memory.last().map_or(0, |known| (*known as usize).min(DIFFERENCES + 1));
        on_registers(Extrapolation { memory, all, halves, differences: known.min(DIFFERENCES), is_guessed });
        if let Some(last) = memory.last_mut() {
            *last = (known + 1).min(DIFFERENCES + 1) as f64;
        }
    }

    /// The number of steps, a whole one.
    pub(super) fn steps(self, state: &[f64]) -> f64 {
        state[self.length() - 1]
    }

    pub(super) fn set_steps(self, state: &mut [f64], steps: f64) {
        state[self.length() - 1] = steps;
    }
}

/// The differences of increments, and the guess of the next; see [`Offsets::follow`].
struct Extrapolation<'a> {
    memory: &'a mut [f64],
    /// The number of components of all bodies.
    all: usize,
    halves: &'a [Vector6<f64>],
    differences: usize,
    is_guessed: bool,
}

impl OnRegisters for Extrapolation<'_> {
    type Output = ();

    #[hot]
    fn run<R: Register>(self, zero: R) {
        let Self { memory, all, halves, differences, is_guessed } = self;
        let (lasts, rest) = memory.split_at_mut(all);
        let (guesses, numbers) = rest.split_at_mut(all);
        let increments = lasts.as_chunks_mut::<6>().0.iter_mut().zip(guesses.as_chunks_mut::<6>().0);
        for (body, ((last, guess), half)) in increments.zip(halves).enumerate() {
            let new = six(zero, &half.data.0[0]);
            let old = six(zero, last);
            let (mut sum, mut difference) = (new, [new[0] - old[0], new[1] - old[1]]);
            let mut place = 6 * body;
            for _ in 0..differences {
                let Some(number) = numbers.get_mut(place..).and_then(<[f64]>::first_chunk_mut::<6>) else { break };
                let before = six(zero, number);
                *number = entries(difference);
                if is_guessed {
                    sum = [sum[0] + difference[0], sum[1] + difference[1]];
                }
                difference = [difference[0] - before[0], difference[1] - before[1]];
                place += all;
            }
            (*last, *guess) = (half.data.0[0], entries(sum));
        }
    }
}

/// Six numbers in two registers, of which the second begins with the last of the first.
#[hot]
fn six<R: Register>(zero: R, [a, b, c, d, e, f]: &[f64; 6]) -> [R; 2] {
    [zero.of([*a, *b, *c, *d]), zero.of([*d, *e, *f, *c])]
}

#[hot]
fn entries<R: Register>([first, second]: [R; 2]) -> [f64; 6] {
    let ([a, b, c, _], [d, e, f, _]) = (first.entries(), second.entries());
    [a, b, c, d, e, f]
}

/// The configuration of a body of a state.
pub(super) fn body_at(state: &[f64], body: usize) -> Body {
    body_of(&state[ATTITUDE * body..])
}

/// A body by the entries of its matrices, row by row.
pub(super) fn body_of(entries: &[f64]) -> Body {
    let attitude = SO3::from_matrix_unchecked(Matrix3::from_row_slice(&entries[..9]));
    (attitude, R3::from_matrix_unchecked(Matrix4::from_row_slice(&entries[9..ATTITUDE])))
}

/// Writes the entries of a body's matrices, row by row.
pub(super) fn write_body(entries: &mut [f64], body: &Body) {
    entries[..9].copy_from_slice(body.0.as_matrix().transpose().as_slice());
    entries[9..ATTITUDE].copy_from_slice(body.1.as_matrix().transpose().as_slice());
}
