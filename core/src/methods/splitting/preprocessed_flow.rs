//! The preprocessed free body between kicks.

use nalgebra::{Matrix3, Vector3};

use super::kinetic_flow::{KineticFlow, Turn};
use crate::effects::PrincipalBody;
use crate::error::{SetupError, StepError};
use crate::groups::{LieGroup as _, SO3};
use crate::mechanics::{DiagonalNonstandardInertia, Operations, SceneVisitor};
use crate::methods::preprocessed::{ModifiedBody, Preprocessed, PreprocessedOrder};
use crate::motion::DiscreteLiePoisson;
use crate::numbers::{Real, real};

/// The free motion of an asymmetric body by [`Preprocessed`]'s map.
///
/// It solves one equation, where [`ExactBody`](crate::methods::ExactBody) solves none, and it isn't symplectic: between
/// kicks the Poisson structure is kept as well as the flow is approximated. Where a share of the step turns the body by less than a tenth of a radian,
/// order 10 does both to rounding; at coarse steps energy drifts. [`SplitBody`](crate::methods::SplitBody) and declared kinetic
/// flows, such as that of a Lagrangian of order 6, are Poisson at any step.
#[derive(Clone, Copy, Debug, Lanes, InLanes)]
pub struct PreprocessedFlow<T = f64> {
    pub(super) inertia: DiagonalNonstandardInertia<T>,
    #[shared]
    pub(super) order: PreprocessedOrder,
}

impl<T: Real> PreprocessedFlow<T> {
    /// The body with this inertia about the pivot, to this order.
    #[must_use]
    pub fn new(inertia: DiagonalNonstandardInertia<T>, order: PreprocessedOrder) -> Self {
        Self { inertia, order }
    }
}

/// A preprocessed flow over one share of the step.
#[derive(Clone, Copy, Debug, Lanes)]
pub struct PreprocessedDrift<T> {
    pub(super) modified: ModifiedBody<T>,
    pub(super) h: T,
}

impl<T: Real> KineticFlow<T> for PreprocessedFlow<T> {
    type Drift = PreprocessedDrift<T>;

    const OPERATIONS: Operations = Preprocessed::<T>::OPERATIONS;

    fn describe(flow: &Self, visitor: &mut dyn SceneVisitor<T>) {
        visitor.term(flow.order.name());
        flow.inertia.diagonal().iter().for_each(|&entry| visitor.parameter("J_d", entry));
    }

    fn inertia(flow: &Self) -> Matrix3<T> {
        let d = flow.inertia.diagonal();
        Matrix3::from_diagonal(&Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y))
    }

    fn drift(&self, h: T) -> Result<Self::Drift, SetupError> {
        // For its checks of the step.
        DiscreteLiePoisson::new(PrincipalBody { J_d: self.inertia }, h)?;
        Ok(PreprocessedDrift { modified: ModifiedBody::new(&self.inertia, self.order.degree()), h })
    }

    #[hot]
    fn advance(drift: &Self::Drift, momentum: &Vector3<T>) -> Result<Turn<T>, StepError> {
        let PreprocessedDrift { modified, h } = drift;
        if *h == T::zero() {
            return Ok(Turn { increment: Matrix3::zeros(), change: Vector3::zeros(), iterations: 0 });
        }
        // As for a declared flow, by the velocity in the middle.
        let velocity = momentum.component_mul(&modified.inverse_moments);
        let bend = momentum.cross(&velocity).component_mul(&modified.inverse_moments);
        let half_guess = (velocity + bend * (*h * real(0.5))) * (*h * real(0.5));
        let root = modified.solve(*h, momentum, &half_guess)?;
        let change = SO3::adjoint_transpose_increment(&root.increment, momentum);
        Ok(Turn { increment: root.increment, change, iterations: root.iterations })
    }
}
