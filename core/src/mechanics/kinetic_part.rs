//! The kinds of kinetic parts, as types: without one a momentum determines no velocity, and a scene can't be stepped.

/// A kind of kinetic part: [`WithKinetic`] or [`WithoutKinetic`].
pub trait KineticPart {
    /// Whether there is a kinetic part.
    const IS_THERE: bool;

    /// The kinetic part of a sum: a sum has one if one of its terms has.
    type Or<Other: KineticPart>: KineticPart;
}

macro_rules! kinds {
    ($($(#[$doc:meta])* $Kind:ident: $there:literal, $Or:ty;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $Kind;

        impl KineticPart for $Kind {
            const IS_THERE: bool = $there;

            type Or<Other: KineticPart> = $Or;
        }
    )*};
}

kinds! {
    /// A term in `1/h`.
    WithKinetic: true, Self;

    /// No kinetic part, as in a potential.
    WithoutKinetic: false, Other;
}
