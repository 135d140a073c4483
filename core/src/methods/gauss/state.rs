//! The state of a motion in quaternion and momentum.

use nalgebra::Vector3;

use super::lift::{Lifted, length_squared, lifted, rotation, twice_momentum};
use super::stages::Stages;
use crate::groups::{Advected, LieGroup as _, SO3};
use crate::motion::State;

/// Attitude and momentum at one time as [`Gauss`](super::Gauss) integrates them.
///
/// What rounding has left behind and the stages of the last step, from which the next ones are guessed, are part of it.
/// A state belongs to the step that it was made with: with another one the guess is worse, and the first step longer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussState<const PAIRS: usize> {
    pub(super) lifted: Lifted,
    pub(super) carry: Lifted,
    pub(super) stages: Option<Stages<PAIRS>>,
    pub(super) steps: u64,
}

impl<const PAIRS: usize> GaussState<PAIRS> {
    /// The attitude, body to space: the rotation of `q/|q|`.
    #[must_use]
    pub fn attitude(&self) -> SO3 {
        let [a, b, c, d, ..] = self.lifted;
        SO3::from_matrix_unchecked(rotation(&[a, b, c, d], 2.0 / length_squared(&self.lifted)))
    }

    /// The momentum `Π`, body frame, kg m²/s.
    #[must_use]
    pub fn momentum(&self) -> Vector3<f64> {
        twice_momentum(&self.lifted) * 0.5
    }

    /// The momentum in space, `R Π`; constant where nothing is advected.
    #[must_use]
    pub fn spatial_momentum(&self) -> Vector3<f64> {
        *self.attitude().as_matrix() * self.momentum()
    }

    /// The spatial momentum's component along a direction given in space, `e₃ · R Π` for the vertical, (3.20).
    #[must_use]
    pub fn momentum_along(&self, direction: &Vector3<f64>) -> f64 {
        self.spatial_momentum().dot(direction)
    }

    /// `‖RᵀR − I‖`: the attitude is a rotation but for the rounding of its entries.
    #[must_use]
    pub fn orthogonality_defect(&self) -> f64 {
        self.attitude().defect()
    }

    /// The number of steps made.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }
}

impl<const PAIRS: usize, A: Advected<SO3>> From<State<SO3, A>> for GaussState<PAIRS> {
    /// The attitude and momentum of a state; its steps are counted on.
    fn from(state: State<SO3, A>) -> Self {
        let q = state.attitude.to_quaternion();
        let lifted = lifted(&[q.w, q.i, q.j, q.k], &state.momentum);
        Self { lifted, carry: [0.0; 8], stages: None, steps: state.steps }
    }
}
