//! The trait of a term of a scene: its share of each stage of a step.

use core::fmt::Debug;

use crate::groups::{LieGroup, Retraction};
use crate::mechanics::description::SceneVisitor;
use crate::mechanics::facts::Facts;
use crate::mechanics::kinetic_part::{KineticPart, WithKinetic};
use crate::mechanics::term::Term;
use crate::numbers::{Coordinates, Pattern, Real, real};

/// The scalar of an effect.
pub type Scalar<E> = <E as Term>::Scalar;
/// The group of an effect.
pub type Group<E> = <E as Term>::Group;
/// The matrices of an effect's group.
pub type Matrix<E> = <Group<E> as LieGroup>::Matrix;
/// Components of covectors and algebra elements.
pub type Vector<E> = <Group<E> as LieGroup>::Vector;
/// Linear maps of components.
pub type Square<E> = <Vector<E> as Coordinates<Scalar<E>>>::Square;

/// The blocks of an effect's Newton matrix that couple neighbours in a row of bodies.
pub(crate) type Links<E> = <Vector<E> as Coordinates<Scalar<E>>>::Links;

/// The result of one Newton iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct NewtonUpdate<V, S, T> {
    /// The update, to be subtracted from half the coordinates.
    pub update: V,
    /// The factors of the Jacobian, for simplified iterations; `None` if neighbours are coupled.
    pub factors: Option<S>,
    /// The determinant of the Jacobian, for several bodies relative to the diagonal.
    pub det: T,
}

impl<T: Real, V: Coordinates<T>> NewtonUpdate<V, V::Square, T> {
    /// The update for a residual and its Jacobian.
    #[hot]
    #[must_use]
    pub fn of(residual: &V, jacobian: &V::Square, pattern: Pattern) -> Self {
        let (factors, det) = V::factorise_with(jacobian, pattern);
        Self { update: V::solve_again_with(&factors, det, pattern, residual), factors: Some(factors), det }
    }
}

/// One Newton iteration by residual and Jacobian; if neighbours are coupled, by their blocks, too.
///
/// The functions are named here and not passed as closures, which wouldn't be inlined nor compiled for the machine's
/// vector instructions.
#[hot]
pub(crate) fn update_of<E: Effect + ?Sized>(
    constants: &E::Constants,
    terms: &E::StepTerms,
    half: &Vector<E>,
) -> NewtonUpdate<Vector<E>, Square<E>, Scalar<E>> {
    if const { !E::FACTS.links_neighbours } {
        let (residual, jacobian) = E::newton_system(constants, terms, half);
        return NewtonUpdate::of(&residual, &jacobian, pattern::<E>());
    }
    let mut links = Vector::<E>::no_links();
    let (mut update, mut jacobian) = E::newton_linked(constants, terms, half, &mut links);
    let det = Vector::<E>::solve_linked(&mut jacobian, &links, pattern::<E>(), &mut update);
    NewtonUpdate { update, factors: None, det }
}

/// The known structure of an effect's Newton matrix.
#[hot]
pub(crate) const fn pattern<E: Effect + ?Sized>() -> Pattern {
    Pattern { factors: <Group<E> as LieGroup>::FACTORS, apart: E::FACTS.apart }
}

/// The continuous Lagrangian `l(ξ, w)` that an effect discretises, with its derivatives at a velocity.
#[derive(Clone, Copy, Debug)]
pub struct Limit<E: Effect + ?Sized> {
    /// The Lagrangian `l`, in J.
    pub l: Scalar<E>,
    /// The momentum `∂l/∂ξ`.
    pub momentum: Vector<E>,
    /// The second derivative `∂²l/∂ξ²`.
    pub hessian: Square<E>,
}

impl<E: Effect + ?Sized> Limit<E> {
    /// The limit `l = ½ ξ·Jξ + s·ξ − V` for these `J`, `s` and `V`, at the velocity `ξ` or at rest.
    #[hot]
    #[must_use]
    pub fn quadratic(velocity: Option<&Vector<E>>, inertia: Square<E>, bias: Vector<E>, potential: E::Scalar) -> Self {
        let Some(velocity) = velocity else { return Self { l: -potential, momentum: bias, hessian: inertia } };
        let image = inertia * *velocity;
        let l = velocity.dot(&image) * real(0.5) + bias.dot(velocity) - potential;
        Self { l, momentum: image + bias, hessian: inertia }
    }
}

/// One term of a scene, with everything that a stepper needs: a
/// [`DiscreteLagrangian`](crate::mechanics::DiscreteLagrangian), a force, or a sum.
///
/// The equations are those of `DiscreteLagrangian` in stages. Quantities that depend on the parameters and `h` are
/// computed once ([`constants`](Self::constants)), those that depend on the state once a step, and those that depend on
/// the unknown once a Newton iteration. A step is
///
/// ```text
/// a  = μ + kick_before(w)                      the part of (2.7) without F moves to the other side
/// solve   U(F, w) = a     for F = τ(2y)        newton_system, up to a factor
/// w⁺ = F⁻¹ · w                                 (2.9)
/// μ⁺ = Ad*_F a + kick_after(F, w⁺)             (2.9), in the transport form μ⁺ = Ad*_F (μ + δl_d/δw ⋄ w)
/// g⁺ = g F                                     (2.10)
/// ```
///
/// All parts are additive, so effects on one group add: see [`Sum`](crate::mechanics::Sum). An effect that isn't the
/// gradient of a Lagrangian fits as well: a discrete force `(f⁻, f⁺)` of the Lagrange–d'Alembert principle has the
/// unknown part `−f⁻(F, w)` and the kick after the step `Ad*_F f⁻ + f⁺`. Reactions of constraints on velocities are added to
/// `a`, as large as the constraints ask for.
///
/// # Source
///
/// \[RDAE\], section 2.2; see [`conventions`](crate::conventions).
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no steps, as it isn't an effect",
    label = "not an effect",
    note = "a continuous Lagrangian `l = …` is one with `discretise = trapezoid(Cayley)` or another, which makes its steps",
    note = "effects are structs with `#[lagrangian(…)]`, those in `liestep::effects`, and their sums",
    note = "joints are added to a system of bodies: `liestep::methods::Multibody`"
)]
#[hot]
pub trait Effect: Term {
    /// The coordinates of the Newton unknown.
    type Retraction: Retraction<Self::Group>;
    /// The kind of kinetic part: [`WithKinetic`] or [`WithoutKinetic`](crate::mechanics::WithoutKinetic).
    type Kinetic: KineticPart;
    /// The quantities that depend on the parameters and `h`.
    type Constants: Clone + Debug + PartialEq;
    /// The quantities that depend on `a` and `w`.
    type StepTerms: Copy;

    /// The facts that hold for all values of the parameters.
    const FACTS: Facts;

    /// The declaration and everything derived from it, as text.
    const DERIVATION: &'static str;

    /// The text of the declaration, which `liestep-late` derives at run time; empty for sums and hand-written effects.
    const DECLARATION: &'static str = "";

    /// The facts about this value: those of the type, unless the effect is a text. No sum asks for them.
    #[doc(hidden)]
    fn facts(&self) -> Facts {
        Self::FACTS
    }

    /// Visits the derivations and, field by field in the order of the declaration, every scalar of the parameters.
    ///
    /// Two scenes with the same description make the same steps.
    fn describe(&self, visitor: &mut dyn SceneVisitor<Self::Scalar>);

    /// The exact right-trivialised Newton Jacobian: entry `(k, j)` is the derivative of component `k` of the momentum
    /// equation (2.7), [`legendre_minus`](crate::mechanics::DiscreteLagrangian::legendre_minus), along `F ↦ exp(t E_j) F`.
    ///
    /// For several bodies it has the block of each. If the equation [couples neighbours](Facts::links_neighbours), the
    /// blocks between two bodies are missing.
    fn momentum_jacobian(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Square<Self>;

    /// The continuous limit `l(ξ, w)`, `l_d(exp hξ, w) = h l(ξ, w) + O(h²)`, at a velocity; `None` is rest, which saves
    /// products with zeros. If the limit is `½ ξ·Jξ + s·ξ − V`, this is [`Limit::quadratic`].
    fn limit(&self, velocity: Option<&Vector<Self>>, w: &Self::Advected) -> Limit<Self>;

    /// The advected and prescribed parameters with another energy `E_0`, J, and the previous `E_0`; `None` if no `pace`
    /// was declared.
    ///
    /// The potential of the [limit](Self::limit) is then `s (V − E_0)` with the pace `s` of [`paced`](crate::Stepper::paced).
    #[must_use]
    fn with_energy(&self, _: &Self::Advected, _energy: Self::Scalar) -> Option<(Self::Advected, Self::Scalar)> {
        None
    }

    /// Folds the parameters and the step into the constants of the stages below.
    fn constants(&self, h: Self::Scalar) -> Self::Constants;

    /// Whether all constants are finite, as a stepper requires. Derived effects check each constant; a hand-written one
    /// may omit this.
    #[must_use]
    fn are_finite(_: &Self::Constants) -> bool {
        true
    }

    /// The part of the diamond that doesn't depend on `F`.
    fn kick_before(constants: &Self::Constants, w: &Self::Advected) -> Vector<Self>;

    /// The derivative of [`kick_before`](Self::kick_before) as the body turns with this velocity: `d/dt` of it at
    /// `exp(−t v̂)·w`. `None` where it isn't known; without a kick it is zero.
    ///
    /// The kicks of a [`SplittingScheme`](crate::methods::SplittingScheme) with force gradients are made with it.
    #[must_use]
    fn kick_derivative(_: &Self::Constants, _: &Self::Advected, _: &Vector<Self>) -> Option<Vector<Self>> {
        (!Self::FACTS.parts.kick_before).then(Vector::<Self>::zero)
    }

    /// What one solve needs of `a = μ + kick_before(w)` and `w`.
    fn step_terms(constants: &Self::Constants, a: &Vector<Self>, w: &Self::Advected) -> Self::StepTerms;

    /// The remainder of the right side `a` that the [step terms](Self::step_terms) of this effect leave to the other terms of
    /// a sum. Each component of the momentum equation (2.7) has `a` once: an effect with an
    /// [unknown part](crate::mechanics::Parts::unknown) takes all of it, one at [places](crate::mechanics::Each) of a system that of the bodies
    /// there, and one without leaves it.
    #[must_use]
    fn remainder(_: &Self::Constants, a: &Vector<Self>) -> Vector<Self> {
        if Self::FACTS.parts.unknown { Vector::<Self>::zero() } else { *a }
    }

    /// `(h/2) (1 + |y|²)ⁿ (U(τ(2y), w) − a)` with `n` = [`denominators`](Facts::denominators), and its derivative with
    /// respect to `y`, half the coordinates of `F`.
    ///
    /// In this form the derivative at rest is the inertia, whatever the step and its sign, and for (3.13) the moments
    /// of inertia are the only constants in it.
    fn newton_system(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> (Vector<Self>, Square<Self>);

    /// One Newton iteration: the update to be subtracted, and the factors of [`Coordinates::factorise_with`]. A system
    /// of many bodies computes it body by body.
    #[must_use]
    fn newton_update(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> NewtonUpdate<Vector<Self>, Square<Self>, Self::Scalar> {
        update_of::<Self>(constants, terms, half)
    }

    /// [`newton_system`](Self::newton_system), with the blocks that couple neighbours in a row of bodies added to the
    /// last argument.
    fn newton_linked(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
        _: &mut Links<Self>,
    ) -> (Vector<Self>, Square<Self>) {
        Self::newton_system(constants, terms, half)
    }

    /// The residual of [`newton_system`](Self::newton_system) without its Jacobian.
    #[must_use]
    fn newton_residual(constants: &Self::Constants, terms: &Self::StepTerms, half: &Vector<Self>) -> Vector<Self> {
        Self::newton_system(constants, terms, half).0
    }

    /// Visits the [constraints on velocities](crate::mechanics::Nonholonomic): at an increment of a step each with its value and
    /// its slope, at rest with zero and the covector of its reaction.
    fn constrained(
        &self,
        _at: Option<(&Matrix<Self>, Self::Scalar)>,
        _: &Self::Advected,
        _each: &mut dyn FnMut(Self::Scalar, Vector<Self>),
    ) {
    }

    /// `Ad*_F` of the part of the diamond that depends on `F`, as a function of the new `w⁺`; `increment` is `F − I`.
    fn kick_after(constants: &Self::Constants, increment: &Matrix<Self>, next: &Self::Advected) -> Vector<Self>;
}

/// An effect with a kinetic part, so that it can be stepped; every such [`Effect`] is.
///
/// This is the first condition for a regular Lagrangian in the literature's sense. The second, an inertia that isn't
/// singular, depends on the parameters. [`Stepper::new`](crate::motion::Stepper::new) checks it; if the inertia depends
/// on `w`, [`Stepper::start`](crate::motion::Stepper::start) does.
pub trait Regular: Effect {}

impl<E: Effect> Regular for E where E::Kinetic: Moves<E> {}

/// The kinetic part of the effect `E`, as a trait whose error message names `E` if there is none.
#[diagnostic::on_unimplemented(
    message = "`{E}` has no kinetic part, so it can't move by itself",
    label = "has no kinetic part",
    note = "add it to a body, as in `RigidBody {{ J_d }} + Gravity {{ m, g, rho, up }}`",
    note = "a kinetic part is a term quadratic in `F - I` and divided by `h`: it makes a momentum determine a velocity"
)]
#[doc(hidden)]
pub trait Moves<E: ?Sized> {}

impl<E: ?Sized> Moves<E> for WithKinetic {}
