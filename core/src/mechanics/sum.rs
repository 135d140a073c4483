//! Scenes: sums of effects.

use core::ops::Add;

use crate::error::SetupError;
use crate::groups::LieGroup;
use crate::mechanics::description::SceneVisitor;
use crate::mechanics::effect::{Effect, Limit, Links, Matrix, NewtonUpdate, Square, Vector, update_of};
use crate::mechanics::facts::Facts;
use crate::mechanics::kinetic_part::KineticPart;
use crate::mechanics::lagrangian::DiscreteLagrangian;
use crate::mechanics::term::Term;
use crate::numbers::Coordinates as _;

/// The sum of two terms of one group, effects or continuous Lagrangians; what `+` makes of them.
///
/// Lagrangians add, and with them momentum maps, diamonds, momentum equations, Jacobians and energies. A part that a
/// term doesn't have costs nothing: no memory, no branch, no addition of zero. With one term that has an
/// [unknown part](crate::mechanics::Parts::unknown), like a body, the Newton system is that term's own, and all others are kicks.
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
#[derive(Clone, Copy, Debug, PartialEq, Lanes, InLanes)]
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

/// The group `G` itself: `A` and `B` can be added if they have the same one. A sum requires it for the message below.
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

/// Methods that add the values of both terms, each at its own advected parameters.
macro_rules! added {
    ($(fn $name:ident($at:ident: $type:ty, w $(, $h:ident: $scalar:ty)?) -> $result:ty;)+) => {$(
        fn $name(&self, $at: $type, w: &Self::Advected $(, $h: $scalar)?) -> $result {
            self.first.$name($at, &w.0 $(, $h)?) + self.second.$name($at, &w.1 $(, $h)?)
        }
    )+};
}
pub(super) use added;

/// A part of a sum: the sum of the parts of both terms, or the part of the one term that has it.
macro_rules! of_those_with {
    ($part:ident: $both:expr, $first:expr, $second:expr $(,)?) => {
        if const { A::FACTS.parts.$part && B::FACTS.parts.$part } {
            $both
        } else if const { A::FACTS.parts.$part } {
            $first
        } else {
            $second
        }
    };
}

#[hot]
impl<A, B> Effect for Sum<A, B>
where
    A: Effect,
    B: Effect<Scalar = A::Scalar, Group = A::Group, Retraction = A::Retraction>,
{
    type Retraction = A::Retraction;
    type Kinetic = <A::Kinetic as KineticPart>::Or<B::Kinetic>;
    type Constants = (A::Constants, B::Constants);
    type StepTerms = (A::StepTerms, B::StepTerms);

    const FACTS: Facts = A::FACTS.or(B::FACTS);
    const DERIVATION: &'static str = "the sum of two effects: their momentum maps, diamonds, unknown parts, kicks, \
                                      Jacobians and energies, each added; see DERIVATION of either\n";

    fn describe(&self, visitor: &mut dyn SceneVisitor<Self::Scalar>) {
        self.first.describe(visitor);
        self.second.describe(visitor);
    }

    added! {
        fn momentum_jacobian(f: &Matrix<Self>, w, h: Self::Scalar) -> Square<Self>;
    }

    fn limit(&self, velocity: Option<&Vector<Self>>, w: &Self::Advected) -> Limit<Self> {
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

    fn kick_before(constants: &Self::Constants, w: &Self::Advected) -> Vector<Self> {
        of_those_with!(
            kick_before: A::kick_before(&constants.0, &w.0) + B::kick_before(&constants.1, &w.1),
            A::kick_before(&constants.0, &w.0),
            B::kick_before(&constants.1, &w.1),
        )
    }

    fn kick_derivative(
        constants: &Self::Constants,
        w: &Self::Advected,
        velocity: &Vector<Self>,
    ) -> Option<Vector<Self>> {
        let first = || A::kick_derivative(&constants.0, &w.0, velocity);
        let second = || B::kick_derivative(&constants.1, &w.1, velocity);
        of_those_with!(kick_before: Some(first()? + second()?), first(), second())
    }

    /// The first term takes its part of the right side `a`, the second the remainder.
    fn step_terms(constants: &Self::Constants, a: &Vector<Self>, w: &Self::Advected) -> Self::StepTerms {
        let remainder = A::remainder(&constants.0, a);
        (A::step_terms(&constants.0, a, &w.0), B::step_terms(&constants.1, &remainder, &w.1))
    }

    fn remainder(constants: &Self::Constants, a: &Vector<Self>) -> Vector<Self> {
        B::remainder(&constants.1, &A::remainder(&constants.0, a))
    }

    fn newton_system(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> (Vector<Self>, Square<Self>) {
        of_those_with!(
            unknown: {
                let raised = Vector::<Self>::raised;
                let first = A::newton_system(&constants.0, &terms.0, half);
                let second = B::newton_system(&constants.1, &terms.1, half);
                let both = Self::FACTS.denominators;
                let first = raised(&first.0, &first.1, both - A::FACTS.denominators, half);
                let second = raised(&second.0, &second.1, both - B::FACTS.denominators, half);
                (first.0 + second.0, first.1 + second.1)
            },
            A::newton_system(&constants.0, &terms.0, half),
            B::newton_system(&constants.1, &terms.1, half),
        )
    }

    fn newton_update(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> NewtonUpdate<Vector<Self>, Square<Self>, Self::Scalar> {
        of_those_with!(
            unknown: update_of::<Self>(constants, terms, half),
            A::newton_update(&constants.0, &terms.0, half),
            B::newton_update(&constants.1, &terms.1, half),
        )
    }

    fn newton_linked(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
        links: &mut Links<Self>,
    ) -> (Vector<Self>, Square<Self>) {
        of_those_with!(
            unknown: {
                let both = Self::FACTS.denominators;
                let first = linked::<A>(&constants.0, &terms.0, (half, both), links);
                let second = linked::<B>(&constants.1, &terms.1, (half, both), links);
                (first.0 + second.0, first.1 + second.1)
            },
            A::newton_linked(&constants.0, &terms.0, half, links),
            B::newton_linked(&constants.1, &terms.1, half, links),
        )
    }

    fn newton_residual(constants: &Self::Constants, terms: &Self::StepTerms, half: &Vector<Self>) -> Vector<Self> {
        of_those_with!(
            unknown: Self::newton_system(constants, terms, half).0,
            A::newton_residual(&constants.0, &terms.0, half),
            B::newton_residual(&constants.1, &terms.1, half),
        )
    }

    fn constrained(
        &self,
        at: Option<(&Matrix<Self>, Self::Scalar)>,
        w: &Self::Advected,
        each: &mut dyn FnMut(Self::Scalar, Vector<Self>),
    ) {
        self.first.constrained(at, &w.0, each);
        self.second.constrained(at, &w.1, each);
    }

    fn kick_after(constants: &Self::Constants, increment: &Matrix<Self>, next: &Self::Advected) -> Vector<Self> {
        of_those_with!(
            kick_after: A::kick_after(&constants.0, increment, &next.0) + B::kick_after(&constants.1, increment, &next.1),
            A::kick_after(&constants.0, increment, &next.0),
            B::kick_after(&constants.1, increment, &next.1),
        )
    }
}

/// [`Effect::newton_linked`] of a term of a sum with this power of the Cayley denominator in its factor.
#[hot]
fn linked<E: Effect>(
    constants: &E::Constants,
    terms: &E::StepTerms,
    (half, denominators): (&Vector<E>, u32),
    links: &mut Links<E>,
) -> (Vector<E>, Square<E>) {
    let power = denominators - E::FACTS.denominators;
    if power == 0 {
        return E::newton_linked(constants, terms, half, links);
    }
    let mut own = Vector::<E>::no_links();
    let (residual, jacobian) = E::newton_linked(constants, terms, half, &mut own);
    Vector::<E>::add_links(links, &own, power, half);
    Vector::<E>::raised(&residual, &jacobian, power, half)
}

impl<A, B> DiscreteLagrangian for Sum<A, B>
where
    A: DiscreteLagrangian,
    B: DiscreteLagrangian<Scalar = A::Scalar, Group = A::Group, Retraction = A::Retraction>,
{
    added! {
        fn l_d(f: &Matrix<Self>, w, h: Self::Scalar) -> Self::Scalar;
        fn right_momentum(f: &Matrix<Self>, w, h: Self::Scalar) -> Vector<Self>;
        fn left_momentum(f: &Matrix<Self>, w, h: Self::Scalar) -> Vector<Self>;
        fn diamond(f: &Matrix<Self>, w, h: Self::Scalar) -> Vector<Self>;
        fn legendre_minus(f: &Matrix<Self>, w, h: Self::Scalar) -> Vector<Self>;
        fn discrete_energy(f: &Matrix<Self>, w, h: Self::Scalar) -> Self::Scalar;
    }
}
