//! Long runs: the growth of the defects of the group and of the Casimirs.

use declarations::{HeavyTop, Motion};
use liestep::groups::LieGroup as _;
use liestep::motion::Plan;
use liestep::{SO3, StateOf, Stepper};
use nalgebra::{Matrix3, SVector, Vector3};
use workbench::measure::{Tenths, greater};

use crate::rivals::started;
use crate::row::Failure;

/// A motion with one advected vector.
pub(crate) type TopMotion = liestep::motion::Motion<SO3, Vector3<f64>>;

/// The distance from the rotations, `‖RᵀR − I‖`.
pub(crate) fn orthogonality(attitude: &Matrix3<f64>) -> f64 {
    (attitude.transpose() * attitude - Matrix3::identity()).norm()
}

/// The largest defects up to a number of steps.
#[derive(Clone, Copy, Default)]
pub(crate) struct Defects {
    pub(crate) orthogonality: f64,
    /// The defect of `|w|`, `|w| − 1`.
    pub(crate) length: f64,
    /// The relative change of `p·w`.
    pub(crate) vertical: f64,
    /// The relative change of `p_3`.
    pub(crate) axial: f64,
}

/// A test for whether a growth is a walk or a drift: its largest size relative to that of a walk with the same steps.
///
/// Sampled `n` times, a walk reaches some four standard deviations at most, and a constant growth `√n`. The quantities
/// are the six entries of `RRᵀ − I` (those of `RᵀR − I` turn with the body), `|w|²` and `p·w`.
struct Growth {
    last: SVector<f64, 8>,
    squares: SVector<f64, 8>,
    farthest: SVector<f64, 8>,
}

impl Growth {
    fn new() -> Self {
        Self { last: SVector::zeros(), squares: SVector::zeros(), farthest: SVector::zeros() }
    }

    fn add(&mut self, now: SVector<f64, 8>) {
        self.squares += (now - self.last).map(|change| change * change);
        self.farthest = self.farthest.sup(&now.abs());
        self.last = now;
    }

    /// The largest growth among the quantities `from` to `to`, in standard deviations; zero if nothing changed.
    fn deviations(&self, from: usize, to: usize) -> f64 {
        let ratio = |k: usize| if self.squares[k] > 0.0 { self.farthest[k] / self.squares[k].sqrt() } else { 0.0 };
        (from..to).map(ratio).fold(0.0, greater)
    }
}

/// The number of samples of a run: a drift then reaches thirty standard deviations.
const LOOKS: u64 = 1000;

/// The defects of a run, and their growth.
pub(crate) struct Walk {
    start: (f64, f64),
    followed: Growth,
    /// The steps between two samples.
    stride: u64,
    pub(crate) worst: Defects,
}

/// The step between evaluations of the defects: evaluating them at every step would cost more than the step.
const SAMPLE: u64 = 100;

impl Walk {
    /// The defects of a run of this number of steps.
    pub(crate) fn from(momentum: &Vector3<f64>, w: &Vector3<f64>, steps: u64) -> Self {
        let start = (momentum.dot(w), momentum.z);
        let stride = (steps / LOOKS).next_multiple_of(SAMPLE);
        Self { start, followed: Growth::new(), stride, worst: Defects::default() }
    }

    /// Evaluates the defects after the step of this number, if it is one of the sampled steps.
    pub(crate) fn after(&mut self, step: u64, state: impl FnOnce() -> (Matrix3<f64>, Vector3<f64>, Vector3<f64>)) {
        if step.is_multiple_of(SAMPLE) {
            self.look(step, &state());
        }
    }

    fn look(&mut self, step: u64, (attitude, momentum, w): &(Matrix3<f64>, Vector3<f64>, Vector3<f64>)) {
        let (vertical, axial) = self.start;
        let worst = &mut self.worst;
        worst.orthogonality = greater(worst.orthogonality, orthogonality(attitude));
        worst.length = greater(worst.length, (w.norm() - 1.0).abs());
        worst.vertical = greater(worst.vertical, (momentum.dot(w) / vertical - 1.0).abs());
        worst.axial = greater(worst.axial, (momentum.z / axial - 1.0).abs());
        if step.is_multiple_of(self.stride) {
            let gram = attitude * attitude.transpose();
            self.followed.add(SVector::from([
                gram.m11 - 1.0,
                gram.m22 - 1.0,
                gram.m33 - 1.0,
                gram.m12,
                gram.m23,
                gram.m31,
                w.norm_squared() - 1.0,
                momentum.dot(w) / vertical - 1.0,
            ]));
        }
    }

    /// The growth of the attitude's distance from the rotations, in standard deviations of a walk.
    pub(crate) fn attitude_deviations(&self) -> f64 {
        self.followed.deviations(0, 6)
    }

    /// The growth of the errors of `|w|²` and `p·w`, in standard deviations of a walk.
    pub(crate) fn casimir_deviations(&self) -> f64 {
        self.followed.deviations(6, 8)
    }
}

/// The largest growth of a walk.
pub(crate) const FARTHEST: f64 = 4.0;

/// The result of a long run of our method.
pub(crate) struct Run {
    pub(crate) walk: Walk,
    /// The energy at the start, J.
    pub(crate) energy: f64,
    /// The means of the energy's change.
    pub(crate) energies: Tenths,
    /// The number of steps that changed `p_3`.
    pub(crate) axial: u64,
}

/// The period of corrections of the attitude, in steps, in runs with polar steps.
const PERIOD: u64 = 1000;

/// The attitude after a step towards its polar factor.
fn orthogonal(state: &TopMotion) -> SO3 {
    let r = state.attitude().matrix();
    SO3::from_matrix_unchecked(r * (Matrix3::identity() * 3.0 - r.transpose() * r) * 0.5)
}

impl Run {
    /// A run of this number of steps.
    pub(crate) fn of<P: Plan<HeavyTop>>(
        stepper: &Stepper<HeavyTop, P>,
        start: &StateOf<HeavyTop, P>,
        steps: u64,
        is_corrected: bool,
    ) -> Result<Self, Failure> {
        let (mut state, energy, axial) = (*start, stepper.energy(start), start.momentum().z);
        let walk = Walk::from(&start.momentum(), &start.advected(), steps);
        let mut run = Self { walk, energy, energies: Tenths::new(steps), axial: 0 };
        for step in 1..=steps {
            stepper.step(&mut state)?;
            if is_corrected && step.is_multiple_of(PERIOD) {
                state = stepper.start_with_momentum(orthogonal(&state), state.momentum())?;
            }
            run.axial += u64::from(state.momentum().z.to_bits() != axial.to_bits());
            run.energies.after(step, || stepper.energy(&state) - energy);
            run.walk.after(step, || (state.attitude().matrix(), state.momentum(), state.advected()));
        }
        Ok(run)
    }

    /// A run of (3.13) along a motion.
    pub(crate) fn along(motion: &Motion, h: f64, steps: u64, is_compensated: bool) -> Result<Self, Failure> {
        let (stepper, start) = started(motion, h)?;
        if is_compensated {
            let compensated = stepper.compensated();
            Self::of(&compensated, &compensated.adopt(&start), steps, false)
        } else {
            Self::of(&stepper, &start, steps, false)
        }
    }
}
