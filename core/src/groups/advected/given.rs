//! Prescribed values of a step, on which the group acts trivially.

use nalgebra::{SMatrix, Vector1};

use super::Advected;
use crate::groups::LieGroup;
use crate::numbers::{Real, entries_of_value};

/// A value that may be [prescribed](crate::Stepper::step_with) in each step: the type for the field `torque` in
/// `given(u = torque)`, which may be a scalar as a 1 × 1 matrix, a vector or a matrix.
///
/// A prescribed value is a parameter in the trivial representation: `f⁻¹ · x = x`, and its diamond is zero. A value in
/// the body frame, as most torques are, has components in the body's axes; units are those of the field.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct Given<T, const R: usize = 1, const C: usize = 1>(pub SMatrix<T, R, C>);

impl<T: Real> Given<T> {
    /// A prescribed scalar.
    #[hot]
    pub const fn scalar(value: T) -> Self {
        Self(Vector1::new(value))
    }
}

entries_of_value!([const R: usize, const C: usize] Given<S, R, C>);

#[hot]
impl<T: Real, G: LieGroup<Scalar = T>, const R: usize, const C: usize> Advected<G> for Given<T, R, C> {
    fn seen_from(&self, _: &G) -> Self {
        *self
    }

    fn pulled_back(&self, _: &G) -> Self {
        *self
    }

    fn change(&self, _: &G::Matrix) -> Self {
        Self(SMatrix::zeros())
    }

    fn rate(&self, _: &G::Matrix) -> Self {
        Self(SMatrix::zeros())
    }

    fn seen_through(&self, _: &G::Matrix, _: &G::Matrix) -> Self {
        *self
    }

    fn advect(&self, _: &G::Matrix) -> Self {
        *self
    }
}
