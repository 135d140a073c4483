//! Lagrangians whose Jacobians are counted, or whose momentum equation is solved wrongly.

use core::cell::Cell;

use liestep::mechanics::{
    DiscreteLagrangian, Effect, Facts, Group, Limit, Matrix, Scalar, SceneVisitor, SecondDerivatives, Square,
    StepDerivatives, StepPoint, Term, Vector, WithKinetic,
};

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
        of_inner! {
            fn l_d(f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Self::Scalar;
            fn right_momentum(f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self>;
            fn left_momentum(f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self>;
            fn diamond(f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self>;
            fn discrete_energy(f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Self::Scalar;
        }
    };
}

/// The wrapped Lagrangian's stages and constants, so that only the Newton system differs.
macro_rules! solved_as {
    ($L:ident) => {
        type Constants = $L::Constants;
        type StepTerms = $L::StepTerms;

        type Kinetic = WithKinetic;

        type Retraction = $L::Retraction;

        const FACTS: Facts = $L::FACTS;
        const DERIVATION: &'static str = $L::DERIVATION;

        of_inner! {
            fn describe(visitor: &mut dyn SceneVisitor<Self::Scalar>);
            fn momentum_jacobian(f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Square<Self>;
        }

        fn limit(&self, velocity: Option<&Vector<Self>>, w: &Self::Advected) -> Limit<Self> {
            let Limit { l, momentum, hessian } = self.0.limit(velocity, w);
            Limit { l, momentum, hessian }
        }

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

/// A Lagrangian whose Jacobians are counted.
#[derive(Clone, Debug)]
pub struct JacobianCounter<L>(pub L);

impl<L: DiscreteLagrangian> DiscreteLagrangian for JacobianCounter<L> {
    declared_as!(L);
}

impl<L: Term> Term for JacobianCounter<L> {
    term_as!(L);
}

impl<L: Effect> Effect for JacobianCounter<L> {
    solved_as!(L);

    fn newton_system(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> (Vector<Self>, Square<Self>) {
        SYSTEMS.set(SYSTEMS.get() + 1);
        L::newton_system(constants, terms, half)
    }

    fn newton_residual(constants: &Self::Constants, terms: &Self::StepTerms, half: &Vector<Self>) -> Vector<Self> {
        L::newton_residual(constants, terms, half)
    }
}

std::thread_local! {
    static SYSTEMS: Cell<u32> = const { Cell::new(0) };
}

/// The number of Jacobians of a [`JacobianCounter`] that `run` evaluates.
pub fn jacobians<T>(run: impl FnOnce() -> T) -> (T, u32) {
    let before = SYSTEMS.get();
    let outcome = run();
    (outcome, SYSTEMS.get() - before)
}

/// A Lagrangian whose momentum equation is solved for another body: its roots have errors of some thousandths.
#[derive(Clone, Debug)]
pub struct InaccurateSolver<L>(pub L);

impl<L: DiscreteLagrangian> DiscreteLagrangian for InaccurateSolver<L> {
    declared_as!(L);
}

impl<L: Term> Term for InaccurateSolver<L> {
    term_as!(L);
}

impl<L: Effect> Effect for InaccurateSolver<L> {
    solved_as!(L);

    fn newton_system(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector<Self>,
    ) -> (Vector<Self>, Square<Self>) {
        let (residual, jacobian) = L::newton_system(constants, terms, half);
        (residual + *half * nalgebra::convert::<f64, Self::Scalar>(1e-3), jacobian)
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
