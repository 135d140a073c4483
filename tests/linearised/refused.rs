//! What can't be differentiated: force gradients of a term whose derivatives were written without those of its kick.

use liestep::groups::CayleyRetraction;
use liestep::mechanics::{
    DiscreteLagrangian, Effect, Inertia, Limit, SceneVisitor, SecondDerivatives, StepDerivatives, Term, WithKinetic,
};
use liestep::methods::{ExactBody, ProcessedScheme, SplittingScheme};
use liestep::{SO3, SetupError, Stepper};
use nalgebra::{Matrix3, Vector3};

use super::scenes::{Top, top};

/// A heavy top with all that the library's has, but for `kick_gradient`.
#[derive(Clone)]
struct ByHand(Top<f64>);

type W = <Top<f64> as Term>::Advected;
type V = Vector3<f64>;
type M = Matrix3<f64>;

macro_rules! as_the_librarys {
    ($(fn $name:ident($($argument:ident: $type:ty),*) $(-> $result:ty)?;)*) => {
        $(fn $name(&self, $($argument: $type),*) $(-> $result)? { self.0.$name($($argument),*) })*
    };
    (static: $(fn $name:ident($($argument:ident: $type:ty),*) -> $result:ty;)*) => {
        $(fn $name($($argument: $type),*) -> $result { Top::<f64>::$name($($argument),*) })*
    };
}

impl Term for ByHand {
    type Scalar = f64;
    type Group = SO3;
    type Advected = W;

    as_the_librarys! {
        fn validate() -> Result<(), SetupError>;
        fn advected() -> W;
    }
}

impl DiscreteLagrangian for ByHand {
    const SELF_ADJOINT: bool = true;

    as_the_librarys! {
        fn l_d(f: &M, w: &W, h: f64) -> f64;
        fn right_momentum(f: &M, w: &W, h: f64) -> V;
        fn left_momentum(f: &M, w: &W, h: f64) -> V;
        fn diamond(f: &M, w: &W, h: f64) -> V;
        fn discrete_energy(f: &M, w: &W, h: f64) -> f64;
    }
}

impl Effect for ByHand {
    type Retraction = CayleyRetraction;
    type Kinetic = WithKinetic;
    type Constants = <Top<f64> as Effect>::Constants;
    type StepTerms = <Top<f64> as Effect>::StepTerms;

    const DENOMINATORS: u32 = <Top<f64> as Effect>::DENOMINATORS;
    const INERTIA_IS_CONSTANT: bool = true;
    const IS_QUADRATIC: bool = true;
    const DERIVATION: &'static str = "a heavy top, by hand";

    fn limit(&self, velocity: Option<&V>, w: &W) -> Limit<Self> {
        let Limit { l, momentum, hessian } = self.0.limit(velocity, w);
        Limit { l, momentum, hessian }
    }

    as_the_librarys! {
        fn describe(visitor: &mut dyn SceneVisitor<f64>);
        fn momentum_jacobian(f: &M, w: &W, h: f64) -> M;
        fn constants(h: f64) -> Self::Constants;
    }

    as_the_librarys! { static:
        fn kick_before(constants: &Self::Constants, w: &W) -> V;
        fn kick_derivative(constants: &Self::Constants, w: &W, velocity: &V) -> Option<V>;
        fn step_terms(constants: &Self::Constants, a: &V, w: &W) -> Self::StepTerms;
        fn newton_system(constants: &Self::Constants, terms: &Self::StepTerms, half: &V) -> (V, M);
        fn kick_after(constants: &Self::Constants, increment: &M, next: &W) -> V;
    }
}

impl SecondDerivatives for ByHand {
    const PARAMETERS: usize = <Top<f64> as SecondDerivatives>::PARAMETERS;

    as_the_librarys! {
        fn step_derivatives(increment: &M, w: &W, h: f64) -> StepDerivatives<M>;
        fn by_parameters(increment: &M, w: &W, h: f64, visit: &mut impl FnMut(usize, V, V));
        fn by_advected(increment: &M, w: &W, h: f64, visit: &mut impl FnMut(usize, V, V));
        fn adjoint_system(increment: &M, w: &W, h: f64, at_end: &V) -> (M, V);
        fn adjoint_gradient(
            increment: &M, w: &W, h: f64, ends: [&V; 2], visit: &mut impl FnMut(usize, f64)
        ) -> (V, W);
    }
    as_the_librarys! { static:
        fn carried_parameters(visit: &mut impl FnMut(usize, usize)) -> ();
    }
}

/// By name, and without force gradients it is differentiated all the same.
#[test]
fn force_gradients_without_the_gradient_of_a_kick() {
    let flow = ExactBody::new(&Inertia::from_principal_moments(Vector3::new(2.5, 3.0, 3.5)).expect("a body"));
    let scene = ByHand(top::<f64>(None));
    let refused = |scheme| {
        let stepper = Stepper::split(scene.clone(), 0.1, flow, scheme).expect("a stepper");
        stepper.linearised().err()
    };
    assert_eq!(refused(SplittingScheme::FORCE_GRADIENT_4), Some(SetupError::NoSecondDerivatives));
    assert_eq!(refused(SplittingScheme::NYSTROM_6), None);
    let processed = Stepper::processed(scene.clone(), 0.1, flow, ProcessedScheme::SIX_A).expect("a stepper");
    assert_eq!(processed.linearised().err(), Some(SetupError::NoSecondDerivatives));
}
