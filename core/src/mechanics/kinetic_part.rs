//! The kinds of kinetic parts, as types: without one a momentum determines no velocity, and a scene can't be stepped.

/// A kind of kinetic part: [`WithKinetic`], [`WithoutKinetic`] or [`OnlyKicks`].
pub trait KineticPart {
    /// Whether there is a kinetic part.
    const IS_THERE: bool;

    /// Whether an effect of this kind may have an unknown part: see
    /// [`Parts::unknown`](crate::mechanics::Parts::unknown).
    const MAY_BE_UNKNOWN: bool;

    /// The kinetic part of a sum: a sum has one if one of its terms has.
    type Or<Other: KineticPart>: KineticPart;
}

macro_rules! kinds {
    ($($(#[$doc:meta])* $Kind:ident: $there:literal, $unknown:literal, $Or:ty;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $Kind;

        impl KineticPart for $Kind {
            const IS_THERE: bool = $there;
            const MAY_BE_UNKNOWN: bool = $unknown;

            type Or<Other: KineticPart> = $Or;
        }
    )*};
}

kinds! {
    /// A term in `1/h`.
    WithKinetic: true, true, Self;

    /// No kinetic part, as in a potential.
    WithoutKinetic: false, true, Other;

    /// No kinetic part and no unknown part: only kicks at both ends of a step, as of a weight or a constant torque.
    OnlyKicks: false, false, Other;
}
