//! The facts about an effect that a step is built by.

use crate::mechanics::operations::Operations;
use crate::numbers::Blocks;

/// The parts of a step to which an effect contributes; the other contributions are zero for all parameters.
///
/// They are known at compile time, so a sum adds no zeros and has no branches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    /// The unknown part `U(F, w)` of the equation for `F`. A potential of the positions at both ends of a step has
    /// none: moving `F` and `w` together from the left leaves `F⁻¹·w` unchanged.
    pub unknown: bool,
    /// The kick `kick_before(w)`.
    pub kick_before: bool,
    /// The kick `kick_after(F, w⁺)`.
    pub kick_after: bool,
}

impl Parts {
    /// All parts.
    pub const ALL: Self = Self { unknown: true, kick_before: true, kick_after: true };

    /// The parts that at least one of two effects has.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        Self {
            unknown: self.unknown || other.unknown,
            kick_before: self.kick_before || other.kick_before,
            kick_after: self.kick_after || other.kick_after,
        }
    }
}

/// The facts about an effect that hold for all values of its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools)] // each is a fact by itself
pub struct Facts {
    /// The parts that aren't zero.
    pub parts: Parts,

    /// The power of the Cayley denominator in the factor of [`newton_system`](crate::mechanics::Effect::newton_system).
    pub denominators: u32,

    /// Whether [`inertia`](crate::mechanics::inertia()) is the same for all `w`. If so, it is checked once, when a
    /// stepper is constructed, and methods that contain the motion of one free body are available.
    pub has_constant_inertia: bool,

    /// Whether the continuous limit is quadratic in the velocity. If it isn't,
    /// [`inertia`](crate::mechanics::inertia()) is that at rest, and [`limit`](crate::mechanics::Effect::limit) has
    /// the values elsewhere.
    pub is_quadratic: bool,

    /// Whether `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)` for all values of the parameters, and for a force
    /// `δW(F, w, h, η, η⁺) = −δW(F⁻¹, F⁻¹·w, −h, η⁺, η)`.
    ///
    /// If so, a step of `−h` is the exact inverse of a step of `h`, the order is even (2 at least), and symmetric
    /// compositions raise it; otherwise the order is 1 in general. The macro determines it, by normal forms or by
    /// values at random points of a finite field. [`DERIVATION`](crate::mechanics::Effect::DERIVATION) states how, and whether it
    /// would hold if vectors were declared as points. In an implementation by hand it is the author's claim.
    pub is_self_adjoint: bool,

    /// The blocks of unknowns between which the Jacobian of [`newton_system`](crate::mechanics::Effect::newton_system) is
    /// zero. If bodies are coupled only by potentials of the ends of a step, each body is solved separately. Blocks end
    /// where factors of the group end; a single block is always valid.
    pub apart: Blocks,

    /// Whether the Jacobian of [`newton_system`](crate::mechanics::Effect::newton_system) couples neighbours in a row of
    /// bodies; the whole Jacobian is then that of [`newton_linked`](crate::mechanics::Effect::newton_linked).
    pub links_neighbours: bool,

    /// The number of constraints on velocities; see [`Nonholonomic`](crate::mechanics::Nonholonomic).
    pub constraints: usize,

    /// The number of operations of the effect in a step, as the macro counts them.
    pub operations: Operations,
}

impl Facts {
    /// The facts about an effect of which nothing is known but that its Newton system isn't multiplied by denominators.
    pub const ANY: Self = Self {
        parts: Parts::ALL,
        denominators: 0,
        has_constant_inertia: false,
        is_quadratic: false,
        is_self_adjoint: false,
        apart: Blocks::WHOLE,
        links_neighbours: false,
        constraints: 0,
        operations: Operations::UNCOUNTED,
    };

    /// The facts about a constraint on velocities, which is no part of the momentum equation.
    pub const OF_A_CONSTRAINT: Self = Self {
        parts: Parts { unknown: false, kick_before: false, kick_after: false },
        has_constant_inertia: true,
        is_quadratic: true,
        constraints: 1,
        ..Self::ANY
    };

    /// The facts about the sum of two effects. Its Newton system is that of the terms with an unknown part.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        let most = if self.denominators < other.denominators { other.denominators } else { self.denominators };
        let (one, two) = (self.operations, other.operations);
        let (denominators, apart, iteration) = match (self.parts.unknown, other.parts.unknown) {
            (true, true) => (most, self.apart.or(other.apart), one.iteration.saturating_add(two.iteration)),
            (true, false) => (self.denominators, self.apart, one.iteration),
            (false, _) => (other.denominators, other.apart, two.iteration),
        };
        Self {
            parts: self.parts.or(other.parts),
            denominators,
            has_constant_inertia: self.has_constant_inertia && other.has_constant_inertia,
            is_quadratic: self.is_quadratic && other.is_quadratic,
            is_self_adjoint: self.is_self_adjoint && other.is_self_adjoint,
            apart,
            links_neighbours: self.links_neighbours || other.links_neighbours,
            constraints: self.constraints + other.constraints,
            operations: Operations { step: one.step.saturating_add(two.step), iteration },
        }
    }
}
