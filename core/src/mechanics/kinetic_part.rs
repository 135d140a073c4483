//! The kinds of kinetic parts, as types: without one a momentum determines no velocity, and a scene can't be stepped.

use crate::numbers::{Coordinates, Either, History, Parabola, Polynomial, Real};

/// A kind of kinetic part: [`WithKinetic`], [`WithPace`], [`WithExpensiveKinetic`], [`WithEitherKinetic`],
/// [`WithoutKinetic`] or [`OnlyKicks`].
pub trait KineticPart {
    /// Whether there is a kinetic part.
    const IS_THERE: bool;

    /// The value of [`Effect::JACOBIAN_IS_EXPENSIVE`](crate::mechanics::Effect::JACOBIAN_IS_EXPENSIVE).
    const JACOBIAN_IS_EXPENSIVE: bool;

    /// Whether values of one type may differ in whether their Jacobian is expensive.
    const IS_EITHER: bool = false;

    /// Whether an effect of this kind may have an unknown part: see
    /// [`Parts::unknown`](crate::mechanics::Parts::unknown).
    const MAY_BE_UNKNOWN: bool = true;

    /// The history of increments in a state, from which the next one is guessed. It is copied with each state, so it is
    /// only as long as is worthwhile for the solve.
    type History<T: Real, V: Coordinates<T>>: History<T, V>;

    /// The kinetic part of a sum: a sum has one if one of its terms has.
    type Or<Other: KineticPart>: KineticPart;

    /// The kind for solves that always use the Jacobian, whatever it costs.
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
    /// A term in `1/h`.
    WithKinetic: true, false, Parabola, Self, Self;

    /// A term in `1/h`, in a rescaled time in which motions are smooth: extrapolation of the history predicts an
    /// increment so well that one iteration converges to rounding.
    WithPace: true, false, Polynomial, Self, WithKinetic;

    /// A term in `1/h`, whose Jacobian costs more than several residuals.
    WithExpensiveKinetic: true, true, Polynomial, Self, WithKinetic;

    /// A term in `1/h`, and only the value of the effect determines whether its Jacobian is expensive: see
    /// [`jacobian_is_expensive`](crate::mechanics::Effect::jacobian_is_expensive).
    WithEitherKinetic: true, true, Either, Self, WithKinetic, IS_EITHER = true;

    /// No kinetic part, as in a potential.
    WithoutKinetic: false, false, Parabola, Other, Self;

    /// No kinetic part and no unknown part: only kicks at both ends of a step, as of a weight or a constant torque.
    OnlyKicks: false, false, Parabola, Other, Self, MAY_BE_UNKNOWN = false;
}
