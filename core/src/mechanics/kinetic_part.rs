//! Whether a scene has a kinetic part, as types: without one a momentum determines no velocity, and nothing moves.

use crate::numbers::{Coordinates, Either, History, Parabola, Polynomial, Real};

/// [`WithKinetic`], [`WithPace`], [`WithExpensiveKinetic`], [`WithEitherKinetic`], [`WithoutKinetic`] or [`OnlyKicks`].
#[doc(hidden)]
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

/// There is a term in `1/h`.
#[derive(Clone, Copy, Debug)]
pub struct WithKinetic;

/// There is a term in `1/h`, whose Jacobian costs more than several residuals.
#[derive(Clone, Copy, Debug)]
pub struct WithExpensiveKinetic;

/// There is a term in `1/h`, and the effect says as a value whether its Jacobian is expensive: see
/// [`jacobian_is_expensive`](crate::mechanics::Effect::jacobian_is_expensive).
#[derive(Clone, Copy, Debug)]
pub struct WithEitherKinetic;

/// There is none, as in a potential.
#[derive(Clone, Copy, Debug)]
pub struct WithoutKinetic;

/// There is none, and nothing to solve for: kicks at both ends of a step alone, as of a weight or a constant torque.
#[derive(Clone, Copy, Debug)]
pub struct OnlyKicks;

impl KineticPart for WithKinetic {
    const IS_THERE: bool = true;
    const JACOBIAN_IS_EXPENSIVE: bool = false;

    type History<T: Real, V: Coordinates<T>> = Parabola<V>;
    type Or<Other: KineticPart> = Self;
    type ByNewton = Self;
}

/// In a time in which motion is smooth: its history guesses an increment that one iteration brings to rounding.
#[derive(Clone, Copy, Debug)]
#[doc(hidden)]
pub struct WithPace;

impl KineticPart for WithPace {
    const IS_THERE: bool = true;
    const JACOBIAN_IS_EXPENSIVE: bool = false;

    type History<T: Real, V: Coordinates<T>> = Polynomial<V>;
    type Or<Other: KineticPart> = Self;
    type ByNewton = WithKinetic;
}

impl KineticPart for WithExpensiveKinetic {
    const IS_THERE: bool = true;
    const JACOBIAN_IS_EXPENSIVE: bool = true;

    type History<T: Real, V: Coordinates<T>> = Polynomial<V>;
    type Or<Other: KineticPart> = Self;
    type ByNewton = WithKinetic;
}

impl KineticPart for WithEitherKinetic {
    const IS_THERE: bool = true;
    const JACOBIAN_IS_EXPENSIVE: bool = true;
    const IS_EITHER: bool = true;

    type History<T: Real, V: Coordinates<T>> = Either<V>;
    type Or<Other: KineticPart> = Self;
    type ByNewton = WithKinetic;
}

impl KineticPart for WithoutKinetic {
    const IS_THERE: bool = false;
    const JACOBIAN_IS_EXPENSIVE: bool = false;

    type History<T: Real, V: Coordinates<T>> = Parabola<V>;
    type Or<Other: KineticPart> = Other;
    type ByNewton = Self;
}

impl KineticPart for OnlyKicks {
    const IS_THERE: bool = false;
    const JACOBIAN_IS_EXPENSIVE: bool = false;
    const MAY_BE_UNKNOWN: bool = false;

    type History<T: Real, V: Coordinates<T>> = Parabola<V>;
    type Or<Other: KineticPart> = Other;
    type ByNewton = Self;
}
