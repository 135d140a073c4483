//! The symmetries behind conserved momenta, as types: a scene without a symmetry hasn't got the function for its
//! momentum.

use nalgebra::SVector;

use crate::mechanics::lagrangian::DiscreteLagrangian;
use crate::mechanics::sum::Sum;
use crate::numbers::Real;

/// A Lagrangian without advected parameters (prescribed ones are allowed): it is invariant under all rotations of
/// space, and the spatial momentum is conserved exactly.
///
/// A sum is left-invariant if both terms are. The attribute implements the trait; for a hand-written Lagrangian without
/// advected parameters write the empty `impl`.
#[diagnostic::on_unimplemented(
    message = "the spatial momentum isn't conserved in a scene with `{Self}`",
    label = "`{Self}` singles out a direction in space, or is a force",
    note = "`State::spatial_momentum` is its value in any scene; with one advected vector, \
            `Stepper::momentum_along_advected` is conserved"
)]
pub trait LeftInvariant: DiscreteLagrangian {}

impl<A, B> LeftInvariant for Sum<A, B>
where
    A: LeftInvariant,
    B: LeftInvariant<Scalar = A::Scalar, Group = A::Group, Retraction = A::Retraction>,
{
}

/// Advected parameters that consist of exactly one vector of space: rotations about it are a symmetry of a Lagrangian on
/// SO(3), and the momentum along it is conserved exactly, (3.20).
#[diagnostic::on_unimplemented(
    message = "no momentum along a direction is conserved, as this scene doesn't advect exactly one vector",
    label = "advects none or several",
    note = "with two or more, rotations about either change the other; with none, all of the spatial momentum is \
            conserved: `Stepper::spatial_momentum`"
)]
pub trait OneVector {
    /// The scalar of the vector's components.
    type Scalar: Real;

    /// The vector in the body frame.
    fn vector(&self) -> SVector<Self::Scalar, 3>;
}

impl<T: Real> OneVector for SVector<T, 3> {
    type Scalar = T;

    fn vector(&self) -> SVector<T, 3> {
        *self
    }
}

impl<A: OneVector> OneVector for (A, ()) {
    type Scalar = A::Scalar;

    fn vector(&self) -> SVector<A::Scalar, 3> {
        self.0.vector()
    }
}

impl<B: OneVector> OneVector for ((), B) {
    type Scalar = B::Scalar;

    fn vector(&self) -> SVector<B::Scalar, 3> {
        self.1.vector()
    }
}
