//! Scenes: sums of effects.

use alloc::format;
use alloc::string::String;
use core::ops::Add;

use crate::error::SetupError;
use crate::groups::LieGroup;
use crate::mechanics::description::SceneVisitor;
use crate::mechanics::effect::{
    Effect, Limit, Links, Matrix, NewtonUpdate, Parts, Residual, Square, Vector, update_by,
};
use crate::mechanics::kinetic_part::KineticPart;
use crate::mechanics::lagrangian::DiscreteLagrangian;
use crate::mechanics::operations::Operations;
use crate::mechanics::term::Term;
use crate::numbers::{Blocks, Coordinates as _, InLanes, Lanes};

/// The sum of two terms of one group, effects or continuous Lagrangians; what `+` makes of them.
///
/// Lagrangians add, and with them momentum maps, diamonds, momentum equations, Jacobians and energies. A part that a
/// term doesn't have costs nothing: no memory, no branch, no addition of zero. With one term that has an
/// [unknown part](Parts::unknown), like a body, the Newton system is that term's own, and all others are kicks.
///
/// # Examples
///
/// ```
/// use liestep::effects::{Gravity, RigidBody};
/// use liestep::{NonstandardInertia, SO3, Stepper};
/// use liestep::groups::LieGroup as _;
/// use nalgebra::Vector3;
///
/// let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
/// let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
/// let stepper = Stepper::new(RigidBody { J_d } + gravity, 0.01)?;
/// let state = stepper.start(SO3::identity(), Vector3::new(0.1, 0.0, 12.0))?;
/// for state in stepper.steps(state).take(100) {
///     let vertical: f64 = stepper.momentum_along_advected(&*state?);
///     assert!((vertical - 48.0).abs() < 1e-12);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sum<A, B> {
    /// The left term.
    pub first: A,
    /// The right term.
    pub second: B,
}

impl<A, B> Sum<A, B> {
    /// `first + second`.
    pub const fn new(first: A, second: B) -> Self {
        Self { first, second }
    }
}

impl<A: Lanes, B: Lanes> Lanes for Sum<A, B> {
    type Lane = Sum<A::Lane, B::Lane>;

    fn splat(lane: &Self::Lane) -> Self {
        Self { first: A::splat(&lane.first), second: B::splat(&lane.second) }
    }

    fn lane(&self, k: usize) -> Self::Lane {
        Sum { first: self.first.lane(k), second: self.second.lane(k) }
    }

    fn set_lane(&mut self, k: usize, lane: &Self::Lane) -> bool {
        self.first.set_lane(k, &lane.first) && self.second.set_lane(k, &lane.second)
    }
}

impl<W, A: InLanes<W>, B: InLanes<W>> InLanes<W> for Sum<A, B> {
    type Together = Sum<A::Together, B::Together>;
}

/// The group `G` itself: what the effects `A` and `B` have to share to add. It is there for its message.
#[diagnostic::on_unimplemented(
    message = "`{B}` can't be added to `{A}`: the one moves on `{Self}`, the other on `{G}`",
    label = "effects of different groups, or of different scalars",
    note = "all effects of a scene share one group and one scalar"
)]
#[doc(hidden)]
pub trait SharedBy<G, A, B> {}

impl<G: LieGroup, A, B> SharedBy<G, A, B> for G {}

impl<A, B, C> Add<C> for Sum<A, B>
where
    A: Term,
    C: Term,
    C::Group: SharedBy<A::Group, Self, C>,
{
    type Output = Sum<Self, C>;

    fn add(self, other: C) -> Sum<Self, C> {
        Sum::new(self, other)
    }
}

impl<A, B> Term for Sum<A, B>
where
    A: Term,
    B: Term<Scalar = A::Scalar, Group = A::Group>,
{
    type Scalar = A::Scalar;
    type Group = A::Group;
    type Advected = (A::Advected, B::Advected);

    fn validate(&self) -> Result<(), SetupError> {
        self.first.validate()?;
        self.second.validate()
    }

    fn advected(&self) -> Self::Advected {
        (self.first.advected(), self.second.advected())
    }
}

impl<A, B> Effect for Sum<A, B>
where
    A: Effect,
    B: Effect<Scalar = A::Scalar, Group = A::Group, Retraction = A::Retraction>,
{
    type Retraction = A::Retraction;
    type Kinetic = <A::Kinetic as KineticPart>::Or<B::Kinetic>;
    type Constants = (A::Constants, B::Constants);
    type StepTerms = (A::StepTerms, B::StepTerms);

    const PARTS: Parts = A::PARTS.or(B::PARTS);
    const DENOMINATORS: u32 = match (A::PARTS.unknown, B::PARTS.unknown) {
        (true, true) if A::DENOMINATORS < B::DENOMINATORS => B::DENOMINATORS,
        (true, _) => A::DENOMINATORS,
        (false, _) => B::DENOMINATORS,
    };
    const APART: Blocks = match (A::PARTS.unknown, B::PARTS.unknown) {
        (true, true) => A::APART.or(B::APART),
        (true, false) => A::APART,
        (false, _) => B::APART,
    };
    const LINKS_NEIGHBOURS: bool = {
        let links = A::LINKS_NEIGHBOURS || B::LINKS_NEIGHBOURS;
        assert!(
            !links || Self::DENOMINATORS == 0,
            "a term with cleared denominators has another residual than what joins neighbours is added to"
        );
        links
    };
    // The one unknown part's own kernel is run; two are added with their Jacobians.
    const JACOBIAN_IS_EXPENSIVE: bool = match (A::PARTS.unknown, B::PARTS.unknown) {
        (true, true) => false,
        (true, false) => A::JACOBIAN_IS_EXPENSIVE,
        (false, _) => B::JACOBIAN_IS_EXPENSIVE,
    };
    const INERTIA_IS_CONSTANT: bool = A::INERTIA_IS_CONSTANT && B::INERTIA_IS_CONSTANT;
    const IS_QUADRATIC: bool = A::IS_QUADRATIC && B::IS_QUADRATIC;
    const OPERATIONS: Operations = Operations {
        step: A::OPERATIONS.step.saturating_add(B::OPERATIONS.step),
        iteration: match (A::PARTS.unknown, B::PARTS.unknown) {
            (true, true) => A::OPERATIONS.iteration.saturating_add(B::OPERATIONS.iteration),
            (true, false) => A::OPERATIONS.iteration,
            (false, _) => B::OPERATIONS.iteration,
        },
    };
    const DERIVATION: &'static str = "the sum of two effects: their momentum maps, diamonds, unknown parts, kicks, \
                                      Jacobians and energies, each added; see DERIVATION of either\n";

    fn derivation() -> String {
        // A blank line between terms; those of an inner sum have theirs.
        format!("{}\n{}", A::derivation(), B::derivation())
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<Self::Scalar>) {
        self.first.describe(visitor);
        self.second.describe(visitor);
    }

    fn momentum_jacobian(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Square<Self> {
        self.first.momentum_jacobian(f, &w.0, h) + self.second.momentum_jacobian(f, &w.1, h)
    }

    fn inertia(&self, w: &Self::Advected) -> Square<Self> {
        self.first.inertia(&w.0) + self.second.inertia(&w.1)
    }

    fn momentum_bias(&self, w: &Self::Advected) -> Vector<Self> {
        self.first.momentum_bias(&w.0) + self.second.momentum_bias(&w.1)
    }

    fn potential(&self, w: &Self::Advected) -> Self::Scalar {
        self.first.potential(&w.0) + self.second.potential(&w.1)
    }

    fn limit(&self, velocity: &Vector<Self>, w: &Self::Advected) -> Limit<Self> {
        let (first, second) = (self.first.limit(velocity, &w.0), self.second.limit(velocity, &w.1));
        Limit {
            l: first.l + second.l,
            momentum: first.momentum + second.momentum,
            hessian: first.hessian + second.hessian,
        }
    }

    fn constants(&self, h: Self::Scalar) -> Self::Constants {
        (self.first.constants(h), self.second.constants(h))
    }

    fn are_finite(constants: &Self::Constants) -> bool {
        A::are_finite(&constants.0) && B::are_finite(&constants.1)
    }

    #[hot]
    fn kick_before(constants: &Self::Constants, w: &Self::Advected) -> Vector<Self> {
        match (A::PARTS.kick_before, B::PARTS.kick_before) {
            (true, true) => A::kick_before(&constants.0, &w.0) + B::kick_before(&constants.1, &w.1),
            (true, false) => A::kick_before(&constants.0, &w.0),
            (false, _) => B::kick_before(&constants.1, &w.1),
        }
    }

    #[hot]
    fn kick_derivative(
        constants: &Self::Constants,
        w: &Self::Advected,
        velocity: &Vector<Self>,
    ) -> Option<Vector<Self>> {
        let first = || A::kick_derivative(&constants.0, &w.0, velocity);
        let second = || B::kick_derivative(&constants.1, &w.1, velocity);
        match (A::PARTS.kick_before, B::PARTS.kick_before) {
            (true, true) => Some(first()? + second()?),
            (true, false) => first(),
            (false, _) => second(),
        }
    }

    /// The right side `a` belongs to one unknown part, zero to the other.
    #[hot]
    fn step_terms(constants: &Self::Constants, a: &Vector<Self>, w: &Self::Advected) -> Self::StepTerms {
        let zero = Vector::<Self>::zero();
        // What only joins bodies would take it twice.
        let only_joins = A::LINKS_NEIGHBOURS && !A::Kinetic::IS_THERE && B::PARTS.unknown;
        let (first, second) = if A::PARTS.unknown && !only_joins { (a, &zero) } else { (&zero, a) };
        (A::step_terms(&constants.0, first, &w.0), B::step_terms(&constants.1, second, &w.1))
    }

    #[hot]
    fn newton_system(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> (Vector<Self>, Square<Self>) {
        match (A::PARTS.unknown, B::PARTS.unknown) {
            (true, true) => {
                let raised = Vector::<Self>::raised;
                let first = A::newton_system(&constants.0, &terms.0, half);
                let second = B::newton_system(&constants.1, &terms.1, half);
                let first = raised(&first.0, &first.1, Self::DENOMINATORS - A::DENOMINATORS, half);
                let second = raised(&second.0, &second.1, Self::DENOMINATORS - B::DENOMINATORS, half);
                (first.0 + second.0, first.1 + second.1)
            }
            (true, false) => A::newton_system(&constants.0, &terms.0, half),
            (false, _) => B::newton_system(&constants.1, &terms.1, half),
        }
    }

    #[hot]
    fn newton_update(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> NewtonUpdate<Vector<Self>, Square<Self>, Self::Scalar> {
        match (A::PARTS.unknown, B::PARTS.unknown) {
            (true, true) => update_by::<Self>(
                #[allow(clippy::redundant_closure)] // the function itself wouldn't be inlined
                #[cfg_attr(not(debug_assertions), inline(always))]
                |constants, terms, half| Self::newton_system(constants, terms, half),
                constants,
                terms,
                half,
            ),
            (true, false) => A::newton_update(&constants.0, &terms.0, half),
            (false, _) => B::newton_update(&constants.1, &terms.1, half),
        }
    }

    #[hot]
    fn newton_linked(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
        links: &mut Links<Self>,
    ) -> (Vector<Self>, Square<Self>) {
        match (A::PARTS.unknown, B::PARTS.unknown) {
            (true, true) => {
                let first = A::newton_linked(&constants.0, &terms.0, half, links);
                let second = B::newton_linked(&constants.1, &terms.1, half, links);
                (first.0 + second.0, first.1 + second.1)
            }
            (true, false) => A::newton_linked(&constants.0, &terms.0, half, links),
            (false, _) => B::newton_linked(&constants.1, &terms.1, half, links),
        }
    }

    #[hot]
    fn newton_residual(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> Residual<Vector<Self>> {
        match (A::PARTS.unknown, B::PARTS.unknown) {
            (true, true) => {
                Residual { momentum_defect: Self::newton_system(constants, terms, half).0, moving_kick: None }
            }
            (true, false) => A::newton_residual(&constants.0, &terms.0, half),
            (false, _) => B::newton_residual(&constants.1, &terms.1, half),
        }
    }

    #[hot]
    fn kick_beside(
        constants: &Self::Constants,
        increment: &Matrix<Self>,
        next: &Self::Advected,
    ) -> Option<Vector<Self>> {
        let (beside, other) = if A::PARTS.unknown {
            let other = || B::kick_after(&constants.1, increment, &next.1);
            (A::kick_beside(&constants.0, increment, &next.0), B::PARTS.kick_after.then(other))
        } else {
            let other = || A::kick_after(&constants.0, increment, &next.0);
            (B::kick_beside(&constants.1, increment, &next.1), A::PARTS.kick_after.then(other))
        };
        match (beside, other) {
            (Some(beside), Some(other)) => Some(beside + other),
            (beside, other) => beside.or(other),
        }
    }

    #[hot]
    fn kick_after(constants: &Self::Constants, increment: &Matrix<Self>, next: &Self::Advected) -> Vector<Self> {
        match (A::PARTS.kick_after, B::PARTS.kick_after) {
            (true, true) => {
                A::kick_after(&constants.0, increment, &next.0) + B::kick_after(&constants.1, increment, &next.1)
            }
            (true, false) => A::kick_after(&constants.0, increment, &next.0),
            (false, _) => B::kick_after(&constants.1, increment, &next.1),
        }
    }
}

impl<A, B> DiscreteLagrangian for Sum<A, B>
where
    A: DiscreteLagrangian,
    B: DiscreteLagrangian<Scalar = A::Scalar, Group = A::Group, Retraction = A::Retraction>,
{
    const SELF_ADJOINT: bool = A::SELF_ADJOINT && B::SELF_ADJOINT;

    fn l_d(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Self::Scalar {
        self.first.l_d(f, &w.0, h) + self.second.l_d(f, &w.1, h)
    }

    fn right_momentum(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self> {
        self.first.right_momentum(f, &w.0, h) + self.second.right_momentum(f, &w.1, h)
    }

    fn left_momentum(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self> {
        self.first.left_momentum(f, &w.0, h) + self.second.left_momentum(f, &w.1, h)
    }

    fn diamond(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self> {
        self.first.diamond(f, &w.0, h) + self.second.diamond(f, &w.1, h)
    }

    fn legendre_minus(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self> {
        self.first.legendre_minus(f, &w.0, h) + self.second.legendre_minus(f, &w.1, h)
    }

    fn discrete_energy(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Self::Scalar {
        self.first.discrete_energy(f, &w.0, h) + self.second.discrete_energy(f, &w.1, h)
    }
}
