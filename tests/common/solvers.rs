//! Lagrangians whose momentum equation is solved by another algorithm, with or without the Jacobian, or wrongly.

use core::cell::Cell;
use core::fmt::Debug;

use liestep::groups::Retraction as _;
use liestep::mechanics::{
    DiscreteLagrangian, Effect, Group, Limit, Matrix, Parts, Residual, Scalar, SceneVisitor, SecondDerivatives, Square,
    StepDerivatives, StepPoint, Term, Vector, WithExpensiveKinetic, WithKinetic,
};
use liestep::numbers::Real;
use liestep::prelude::*;
use nalgebra::{Matrix3, Vector3};

/// Functions that call the wrapped Lagrangian.
macro_rules! of_inner {
    ($(fn $name:ident($($argument:ident: $type:ty),*) $(-> $result:ty)?;)*) => {
        $(fn $name(&self, $($argument: $type),*) $(-> $result)? { self.0.$name($($argument),*) })*
    };
}

/// The wrapped Lagrangian's parameters.
macro_rules! term_as {
    ($inner:ty) => {
        type Scalar = Scalar<$inner>;
        type Group = Group<$inner>;
        type Advected = <$inner as Term>::Advected;

        of_inner! {
            fn validate() -> Result<(), liestep::SetupError>;
            fn advected() -> Self::Advected;
        }
    };
}

/// The derived terms outside of the stages.
macro_rules! declared_as {
    ($inner:ty) => {
        const SELF_ADJOINT: bool = <$inner>::SELF_ADJOINT;

        of_inner! {
            fn l_d(f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Self::Scalar;
            fn right_momentum(f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self>;
            fn left_momentum(f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self>;
            fn diamond(f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self>;
            fn discrete_energy(f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Self::Scalar;
        }
    };
}

/// The stages that don't depend on the solver.
macro_rules! staged_as {
    ($inner:ty) => {
        type Retraction = <$inner as Effect>::Retraction;

        const PARTS: Parts = <$inner>::PARTS;
        const INERTIA_IS_CONSTANT: bool = <$inner>::INERTIA_IS_CONSTANT;
        const IS_QUADRATIC: bool = <$inner>::IS_QUADRATIC;
        const DERIVATION: &'static str = <$inner>::DERIVATION;

        of_inner! {
            fn describe(visitor: &mut dyn SceneVisitor<Self::Scalar>);
            fn momentum_jacobian(f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Square<Self>;
        }

        fn limit(&self, velocity: Option<&Vector<Self>>, w: &Self::Advected) -> Limit<Self> {
            let Limit { l, momentum, hessian } = self.0.limit(velocity, w);
            Limit { l, momentum, hessian }
        }
    };
}

/// The wrapped Lagrangian's stages and constants, so that only the Newton system differs.
macro_rules! solved_as {
    ($L:ident) => {
        type Constants = $L::Constants;
        type StepTerms = $L::StepTerms;

        const DENOMINATORS: u32 = $L::DENOMINATORS;

        type Kinetic = WithKinetic;

        staged_as!($L);

        fn constants(&self, h: Self::Scalar) -> Self::Constants {
            self.0.constants(h)
        }

        fn kick_before(constants: &Self::Constants, w: &Self::Advected) -> Vector<Self> {
            $L::kick_before(constants, w)
        }

        fn step_terms(constants: &Self::Constants, a: &Vector<Self>, w: &Self::Advected) -> Self::StepTerms {
            $L::step_terms(constants, a, w)
        }

        fn kick_after(constants: &Self::Constants, increment: &Matrix<Self>, next: &Self::Advected) -> Vector<Self> {
            $L::kick_after(constants, increment, next)
        }
    };
}

/// A Lagrangian solved by Newton's iteration, whatever the Jacobian costs.
#[derive(Clone, Debug)]
pub struct WithJacobian<L>(pub L);

impl<L: DiscreteLagrangian> DiscreteLagrangian for WithJacobian<L> {
    declared_as!(L);
}

impl<L: Term> Term for WithJacobian<L> {
    term_as!(L);
}

impl<L: Effect> Effect for WithJacobian<L> {
    solved_as!(L);

    fn newton_system(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> (Vector<Self>, Square<Self>) {
        SYSTEMS.set(SYSTEMS.get() + 1);
        L::newton_system(constants, terms, half)
    }

    fn newton_residual(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> Residual<Vector<Self>> {
        Residual { moving_kick: None, ..L::newton_residual(constants, terms, half) }
    }
}

std::thread_local! {
    static SYSTEMS: Cell<u32> = const { Cell::new(0) };
}

/// The number of Jacobians of a [`WithJacobian`] or a [`WithoutJacobian`] that `run` evaluates.
pub fn jacobians<T>(run: impl FnOnce() -> T) -> (T, u32) {
    let before = SYSTEMS.get();
    let outcome = run();
    (outcome, SYSTEMS.get() - before)
}

/// Whether `run` evaluates a Jacobian of a [`WithoutJacobian`].
pub fn needs_jacobian<T>(run: impl FnOnce() -> T) -> (T, bool) {
    let (outcome, jacobians) = jacobians(run);
    (outcome, jacobians > 0)
}

/// A Lagrangian solved as if its Jacobian were expensive. The second field is the inertia that its limit claims.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithoutJacobian<L, T: Real>(pub L, pub Matrix3<T>);

impl<T: Real, L: DiscreteLagrangian<Scalar = T, Group = SO3<T>> + Copy> WithoutJacobian<L, T> {
    pub fn new(lagrangian: L) -> Self {
        Self(lagrangian, lagrangian.inertia(&lagrangian.advected()))
    }
}

impl<T, L> DiscreteLagrangian for WithoutJacobian<L, T>
where
    T: Real,
    L: DiscreteLagrangian<Scalar = T, Group = SO3<T>> + Copy + Debug + PartialEq,
{
    declared_as!(L);
}

impl<T, L> Term for WithoutJacobian<L, T>
where
    T: Real,
    L: Term<Scalar = T, Group = SO3<T>>,
{
    term_as!(L);
}

impl<T, L> Effect for WithoutJacobian<L, T>
where
    T: Real,
    L: DiscreteLagrangian<Scalar = T, Group = SO3<T>> + Copy + Debug + PartialEq,
{
    type Constants = (L::Constants, L, T);
    type StepTerms = (Vector3<T>, L::Advected);
    type Kinetic = WithExpensiveKinetic;

    staged_as!(L);

    fn inertia(&self, _: &Self::Advected) -> Matrix3<T> {
        self.1
    }

    fn constants(&self, h: T) -> Self::Constants {
        (self.0.constants(h), self.0, h)
    }

    fn kick_before((constants, ..): &Self::Constants, w: &Self::Advected) -> Vector3<T> {
        L::kick_before(constants, w)
    }

    fn step_terms(_: &Self::Constants, a: &Vector3<T>, w: &Self::Advected) -> Self::StepTerms {
        (*a, *w)
    }

    fn newton_system(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector3<T>,
    ) -> (Vector3<T>, Matrix3<T>) {
        SYSTEMS.set(SYSTEMS.get() + 1);
        let f = L::Retraction::retract(&(half + half)).matrix();
        let jacobian = constants.1.momentum_jacobian(&f, &terms.1, constants.2) * L::Retraction::tangent_of_half(half);
        let residual = Self::newton_residual(constants, terms, half).momentum_defect;
        (residual, jacobian * (constants.2 * nalgebra::convert::<f64, T>(0.5)))
    }

    fn newton_residual(
        (constants, lagrangian, h): &Self::Constants,
        (a, w): &Self::StepTerms,
        half: &Vector3<T>,
    ) -> Residual<Vector3<T>> {
        let f = L::Retraction::retract(&(half + half)).matrix();
        let kick_before = L::kick_before(constants, w);
        let residual = lagrangian.legendre_minus(&f, w, *h) + kick_before - *a;
        let moved = lagrangian.diamond(&f, w, *h) - kick_before;
        let momentum_defect = residual * (*h * nalgebra::convert::<f64, T>(0.5));
        Residual { momentum_defect, moving_kick: Some(moved) }
    }

    fn kick_after((constants, ..): &Self::Constants, increment: &Matrix3<T>, next: &Self::Advected) -> Vector3<T> {
        L::kick_after(constants, increment, next)
    }
}

/// A Lagrangian whose momentum equation is solved for another body: its roots have errors of some thousandths.
#[derive(Clone, Debug)]
pub struct Badly<L>(pub L);

impl<L: DiscreteLagrangian> DiscreteLagrangian for Badly<L> {
    declared_as!(L);
}

impl<L: Term> Term for Badly<L> {
    term_as!(L);
}

impl<L: Effect> Effect for Badly<L> {
    solved_as!(L);

    fn newton_system(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> (Vector<Self>, Square<Self>) {
        let (residual, jacobian) = L::newton_system(constants, terms, half);
        (residual + *half * nalgebra::convert::<f64, Self::Scalar>(1e-3), jacobian)
    }

    fn newton_residual(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> Residual<Vector<Self>> {
        Residual { momentum_defect: Self::newton_system(constants, terms, half).0, moving_kick: None }
    }
}

/// A Lagrangian with the derivatives of steps except those of the kick, solved by Newton's iteration.
#[derive(Clone, Debug)]
pub struct WithoutKickGradient<L>(pub L);

impl<L: DiscreteLagrangian> DiscreteLagrangian for WithoutKickGradient<L> {
    declared_as!(L);
}

impl<L: Term> Term for WithoutKickGradient<L> {
    term_as!(L);
}

impl<L: Effect> Effect for WithoutKickGradient<L> {
    solved_as!(L);

    fn kick_derivative(
        constants: &Self::Constants,
        w: &Self::Advected,
        velocity: &Vector<Self>,
    ) -> Option<Vector<Self>> {
        L::kick_derivative(constants, w, velocity)
    }

    fn newton_system(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> (Vector<Self>, Square<Self>) {
        L::newton_system(constants, terms, half)
    }
}

impl<L: SecondDerivatives> SecondDerivatives for WithoutKickGradient<L> {
    const PARAMETERS: usize = L::PARAMETERS;

    of_inner! {
        fn step_derivatives(at: StepPoint<'_, Self::Group, Self::Advected>) -> StepDerivatives<Square<Self>>;
        fn by_parameters(
            at: StepPoint<'_, Self::Group, Self::Advected>, visit: &mut impl FnMut(usize, Vector<Self>, Vector<Self>)
        );
        fn by_advected(
            at: StepPoint<'_, Self::Group, Self::Advected>, visit: &mut impl FnMut(usize, Vector<Self>, Vector<Self>)
        );
        fn adjoint_system(
            at: StepPoint<'_, Self::Group, Self::Advected>, at_end: &Vector<Self>
        ) -> (Square<Self>, Vector<Self>);
        fn adjoint_gradient(
            at: StepPoint<'_, Self::Group, Self::Advected>, ends: [&Vector<Self>; 2],
            visit: &mut impl FnMut(usize, Self::Scalar)
        ) -> (Vector<Self>, Self::Advected);
    }

    fn carried_parameters(visit: &mut impl FnMut(usize, usize)) {
        L::carried_parameters(visit);
    }
}
