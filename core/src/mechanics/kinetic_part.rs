//! Whether a scene has a kinetic part, as types: without one a momentum determines no velocity, and nothing moves.

use crate::mechanics::effect::Effect;

/// [`WithKinetic`] or [`WithoutKinetic`].
pub trait KineticPart {
    /// Of a sum: with, if one of the two is.
    type Or<Other: KineticPart>: KineticPart;
}

/// There is a term in `1/h`.
#[derive(Clone, Copy, Debug)]
pub struct WithKinetic;

/// There is none, as in a potential.
#[derive(Clone, Copy, Debug)]
pub struct WithoutKinetic;

impl KineticPart for WithKinetic {
    type Or<Other: KineticPart> = Self;
}

impl KineticPart for WithoutKinetic {
    type Or<Other: KineticPart> = Other;
}

/// An effect with a kinetic part, so that it can be stepped; every such [`Effect`] is.
///
/// This is the first half of what the literature calls a regular Lagrangian. The other half, that the inertia isn't
/// singular, depends on the parameters and is checked by [`Stepper::new`](crate::motion::Stepper::new).
pub trait Regular: Effect {}

impl<E: Effect> Regular for E where E::Kinetic: Moves<E> {}

/// The kinetic part of the effect `E`; names it in the message where there is none.
#[diagnostic::on_unimplemented(
    message = "`{E}` has no kinetic part, so it can't move by itself",
    label = "has no kinetic part",
    note = "add it to a body, as in `RigidBody {{ J_d }} + Gravity {{ m, g, rho, up }}`",
    note = "a kinetic part is a term quadratic in `F - I` and divided by `h`: it makes a momentum determine a velocity"
)]
pub trait Moves<E: ?Sized> {}

impl<E: ?Sized> Moves<E> for WithKinetic {}
