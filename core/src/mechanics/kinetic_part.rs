//! Whether a scene has a kinetic part, as types: without one a momentum determines no velocity, and nothing moves.

/// [`WithKinetic`] or [`WithoutKinetic`].
#[doc(hidden)]
pub trait KineticPart {
    /// Whether there is one.
    const IS_THERE: bool;

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
    const IS_THERE: bool = true;

    type Or<Other: KineticPart> = Self;
}

impl KineticPart for WithoutKinetic {
    const IS_THERE: bool = false;

    type Or<Other: KineticPart> = Other;
}
