//! Whether a scene has a kinetic part, as types: without one a momentum determines no velocity, and nothing moves.

use crate::numbers::{Coordinates, Either, History, Parabola, Polynomial, Real};

/// [`WithKinetic`], [`WithPace`], [`WithExpensiveKinetic`], [`WithEitherKinetic`], [`WithoutKinetic`] or [`OnlyKicks`].
pub trait KineticPart {
    /// Whether there is one.
    const IS_THERE: bool;

    /// See [`Effect::JACOBIAN_IS_EXPENSIVE`](crate::mechanics::Effect::JACOBIAN_IS_EXPENSIVE).
    const JACOBIAN_IS_EXPENSIVE: bool;

    /// Whether an effect of this kind may be expensive or not.
    const IS_EITHER: bool = false;

    /// Whether an effect of this kind may be solved for: see [`Parts::unknown`](crate::mechanics::Parts::unknown).
    const MAY_BE_UNKNOWN: bool = true;

    /// What a state keeps of the last increments to guess the next one. It is copied with each state, so it is no longer
    /// than the solve pays for.
    type History<T: Real, V: Coordinates<T>>: History<T, V>;

    /// The kinetic part of a sum: there is one if one of the two terms has it.
    type Or<Other: KineticPart>: KineticPart;

    /// The part where the solve takes the Jacobian, whatever that costs.
    type ByNewton: KineticPart;
}

macro_rules! kinds {
    ($($(#[$doc:meta])* $Kind:ident: $there:literal, $expensive:literal, $History:ident, $Or:ty, $ByNewton:ty
        $(, $name:ident = $value:literal)?;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $Kind;

        impl KineticPart for $Kind {
            const IS_THERE: bool = $there;
            const JACOBIAN_IS_EXPENSIVE: bool = $expensive;
            $(const $name: bool = $value;)?

            type History<T: Real, V: Coordinates<T>> = $History<V>;
            type Or<Other: KineticPart> = $Or;
            type ByNewton = $ByNewton;
        }
    )*};
}

kinds! {
    /// There is a term in `1/h`.
    WithKinetic: true, false, Parabola, Self, Self;

    /// In a time in which motion is smooth: its history guesses an increment that one iteration brings to rounding.
    WithPace: true, false, Polynomial, Self, WithKinetic;

    /// There is a term in `1/h`, whose Jacobian costs more than several residuals.
    WithExpensiveKinetic: true, true, Polynomial, Self, WithKinetic;

    /// There is a term in `1/h`, and the effect says as a value whether its Jacobian is expensive: see
    /// [`jacobian_is_expensive`](crate::mechanics::Effect::jacobian_is_expensive).
    WithEitherKinetic: true, true, Either, Self, WithKinetic, IS_EITHER = true;

    /// There is none, as in a potential.
    WithoutKinetic: false, false, Parabola, Other, Self;

    /// There is none, and nothing to solve for: kicks at both ends of a step alone, as of a weight or a constant torque.
    OnlyKicks: false, false, Parabola, Other, Self, MAY_BE_UNKNOWN = false;
}
