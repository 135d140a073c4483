//! Long runs: defects of the group and of the Casimirs while they grow.

use liestep::{Effect, LieGroup as _, SO3, State};
use nalgebra::{Matrix3, Vector3};

use crate::measure::{float, greater};

/// A state with one advected vector.
pub(crate) type TopState = State<SO3, Vector3<f64>>;

/// `‖RᵀR − I‖`.
pub(crate) fn orthogonality(attitude: &Matrix3<f64>) -> f64 {
    (attitude.transpose() * attitude - Matrix3::identity()).norm()
}

/// The largest defects up to a number of steps.
#[derive(Clone, Copy, Default)]
pub(crate) struct Defects {
    pub(crate) orthogonality: f64,
    /// `|w| − 1`.
    pub(crate) length: f64,
    /// `p·w`, relative.
    pub(crate) vertical: f64,
    /// `p_3`, relative.
    pub(crate) axial: f64,
}

/// The defects of a run, and how they grew.
pub(crate) struct Walk {
    start: (f64, f64),
    pub(crate) worst: Defects,
    /// At ten numbers of steps a decade.
    pub(crate) history: Vec<(f64, Defects)>,
    next: f64,
}

/// Looking at every step would cost more than the step.
const SAMPLE: u64 = 100;

impl Walk {
    pub(crate) fn from(momentum: &Vector3<f64>, w: &Vector3<f64>) -> Self {
        let start = (momentum.dot(w), momentum.z);
        Self { start, worst: Defects::default(), history: Vec::new(), next: 100.0 }
    }

    pub(crate) fn from_state(state: &TopState) -> Self {
        Self::from(&state.momentum(), &state.advected())
    }

    /// Looks at the state after the step of this number now and then.
    pub(crate) fn after(&mut self, step: u64, state: impl FnOnce() -> (Matrix3<f64>, Vector3<f64>, Vector3<f64>)) {
        if step.is_multiple_of(SAMPLE) {
            self.look(step, &state());
        }
    }

    /// As [`after`](Self::after), for our states.
    pub(crate) fn after_step(&mut self, step: u64, state: &TopState) {
        self.after(step, || (state.attitude().matrix(), state.momentum(), state.advected()));
    }

    fn look(&mut self, step: u64, (attitude, momentum, w): &(Matrix3<f64>, Vector3<f64>, Vector3<f64>)) {
        let (vertical, axial) = self.start;
        let worst = &mut self.worst;
        worst.orthogonality = greater(worst.orthogonality, orthogonality(attitude));
        worst.length = greater(worst.length, (w.norm() - 1.0).abs());
        worst.vertical = greater(worst.vertical, (momentum.dot(w) / vertical - 1.0).abs());
        worst.axial = greater(worst.axial, (momentum.z / axial - 1.0).abs());
        if float(step) >= self.next {
            self.history.push((float(step), self.worst));
            self.next = float(step) * 10.0_f64.powf(0.1);
        }
    }

    /// A defect against the logarithm of the number of steps.
    pub(crate) fn points(&self, defect: impl Fn(&Defects) -> f64) -> Vec<(f64, f64)> {
        self.history.iter().map(|(steps, defects)| (steps.log10(), defect(defects))).collect()
    }

    /// The exponent of a defect's growth over the last two decades.
    pub(crate) fn exponent(&self, defect: impl Fn(&Defects) -> f64) -> f64 {
        let end = self.history.last().map_or(0.0, |(steps, _)| *steps);
        let late: Vec<_> = self.history.iter().filter(|(steps, _)| *steps >= 0.01 * end).collect();
        crate::measure::exponent(&late.iter().map(|(steps, defects)| (*steps, defect(defects))).collect::<Vec<_>>())
    }
}

/// The energy of a declared scene at a momentum and a parameter, J: that of its continuous limit without a bias.
pub(crate) fn energy<L: Effect<Scalar = f64, Group = SO3, Advected = Vector3<f64>>>(
    lagrangian: &L,
    momentum: &Vector3<f64>,
    w: &Vector3<f64>,
) -> f64 {
    let rates = lagrangian.inertia().lu().solve(momentum).unwrap_or_else(|| Vector3::repeat(f64::NAN));
    0.5 * rates.dot(momentum) + lagrangian.potential(w)
}
