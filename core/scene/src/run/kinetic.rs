//! Kinetic terms of one type: which of them a body has is asked at run time, so that its sums are of few types.

use std::ops::Add;

use liestep::effects::{CayleyBody, FourthOrderBody, GeodesicBody, SixthOrderBody};
use liestep::mechanics::{DiscreteLagrangian, Effect, Inertia, Operations, Parts, Sum, Term, WithKinetic};
use liestep::numbers::Coordinates as _;
use liestep::{SO3, delegate_term};
use nalgebra::{Matrix3, Vector3};

use crate::file::body::Kinetic;

/// Something of one of the kinetic terms beside (3.13).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum OneOf<C, G, F, S> {
    Cayley(C),
    Geodesic(G),
    FourthOrder(F),
    SixthOrder(S),
}

/// A body with one of them.
pub(crate) type ChosenBody = OneOf<CayleyBody, GeodesicBody, FourthOrderBody, SixthOrderBody>;

/// What the parameters and `h` determine of such a body.
type Constants = OneOf<
    <CayleyBody as Effect>::Constants,
    <GeodesicBody as Effect>::Constants,
    <FourthOrderBody as Effect>::Constants,
    <SixthOrderBody as Effect>::Constants,
>;

/// What one solve needs of it.
type StepTerms = OneOf<
    <CayleyBody as Effect>::StepTerms,
    <GeodesicBody as Effect>::StepTerms,
    <FourthOrderBody as Effect>::StepTerms,
    <SixthOrderBody as Effect>::StepTerms,
>;

/// An expression of whichever there is.
macro_rules! whichever {
    ($value:expr, $one:ident => $result:expr) => {
        match $value {
            OneOf::Cayley($one) => $result,
            OneOf::Geodesic($one) => $result,
            OneOf::FourthOrder($one) => $result,
            OneOf::SixthOrder($one) => $result,
        }
    };
}

/// A function of the type of whichever body these constants belong to.
macro_rules! of_its_type {
    ($constants:expr, $function:ident($($argument:expr),*)) => {
        match $constants {
            OneOf::Cayley(constants) => $function::<CayleyBody>(constants, $($argument),*),
            OneOf::Geodesic(constants) => $function::<GeodesicBody>(constants, $($argument),*),
            OneOf::FourthOrder(constants) => $function::<FourthOrderBody>(constants, $($argument),*),
            OneOf::SixthOrder(constants) => $function::<SixthOrderBody>(constants, $($argument),*),
        }
    };
}

/// What all have, to be known when this is built.
macro_rules! of_all {
    ($joined:expr, $constant:ident) => {
        $joined(
            $joined(<CayleyBody as Effect>::$constant, <GeodesicBody as Effect>::$constant),
            $joined(<FourthOrderBody as Effect>::$constant, <SixthOrderBody as Effect>::$constant),
        )
    };
}

const fn greater(a: u32, b: u32) -> u32 {
    if a > b { a } else { b }
}

const fn both(a: bool, b: bool) -> bool {
    a && b
}

const fn most(a: Operations, b: Operations) -> Operations {
    Operations { step: greater(a.step, b.step), iteration: greater(a.iteration, b.iteration) }
}

impl ChosenBody {
    /// The body of this kinetic term and inertia; nothing where the term is (3.13).
    pub(crate) fn of(kinetic: Kinetic, J: Inertia) -> Option<Self> {
        Some(match kinetic {
            Kinetic::Rigid => return None,
            Kinetic::Cayley => Self::Cayley(CayleyBody { J }),
            Kinetic::Geodesic => Self::Geodesic(GeodesicBody { J }),
            Kinetic::FourthOrder => Self::FourthOrder(FourthOrderBody { J }),
            Kinetic::SixthOrder => Self::SixthOrder(SixthOrderBody { J }),
        })
    }
}

/// A body alone: nothing is advected.
trait Body: Effect<Scalar = f64, Group = SO3, Advected = ()> {}

impl<E: Effect<Scalar = f64, Group = SO3, Advected = ()>> Body for E {}

/// Called, so that it is compiled once and not into each sum.
#[inline(never)]
fn terms<E: Body>(constants: &E::Constants, a: &Vector3<f64>) -> E::StepTerms {
    E::step_terms(constants, a, &())
}

/// As [`terms`].
#[inline(never)]
fn system<E: Body>(
    constants: &E::Constants,
    terms: &E::StepTerms,
    half: &Vector3<f64>,
) -> (Vector3<f64>, Matrix3<f64>) {
    let (residual, jacobian) = E::newton_system(constants, terms, half);
    Vector3::raised(&residual, &jacobian, ChosenBody::DENOMINATORS - E::DENOMINATORS, half)
}

fn before<E: Body>(constants: &E::Constants) -> Vector3<f64> {
    E::kick_before(constants, &())
}

fn after<E: Body>(constants: &E::Constants, increment: &Matrix3<f64>) -> Vector3<f64> {
    E::kick_after(constants, increment, &())
}

fn finite<E: Body>(constants: &E::Constants) -> bool {
    E::are_finite(constants)
}

impl Term for ChosenBody {
    type Scalar = f64;
    type Group = SO3;
    type Advected = ();

    delegate_term!(whichever: validate advected);
}

impl<E: Term<Scalar = f64, Group = SO3>> Add<E> for ChosenBody {
    type Output = Sum<Self, E>;

    fn add(self, other: E) -> Sum<Self, E> {
        Sum::new(self, other)
    }
}

impl Effect for ChosenBody {
    type Retraction = <CayleyBody as Effect>::Retraction;
    type Kinetic = WithKinetic;
    type Constants = Constants;
    type StepTerms = StepTerms;

    const PARTS: Parts = of_all!(Parts::or, PARTS);
    const DENOMINATORS: u32 = of_all!(greater, DENOMINATORS);
    const INERTIA_IS_CONSTANT: bool = of_all!(both, INERTIA_IS_CONSTANT);
    const IS_QUADRATIC: bool = of_all!(both, IS_QUADRATIC);
    // It asks that there be no `DENOMINATORS`, so it can't be true where it isn't of all.
    const JACOBIAN_IS_EXPENSIVE: bool = of_all!(both, JACOBIAN_IS_EXPENSIVE);
    const OPERATIONS: Operations = of_all!(most, OPERATIONS);
    const DERIVATION: &'static str = "one of four kinetic terms, which is asked at run time: `liestep derive cayley-body`, \
                                      `geodesic-body`, `fourth-order-body` and `sixth-order-body` show them\n";

    delegate_term!(whichever: describe momentum_jacobian limit);

    fn constants(&self, h: f64) -> Constants {
        match self {
            Self::Cayley(body) => OneOf::Cayley(body.constants(h)),
            Self::Geodesic(body) => OneOf::Geodesic(body.constants(h)),
            Self::FourthOrder(body) => OneOf::FourthOrder(body.constants(h)),
            Self::SixthOrder(body) => OneOf::SixthOrder(body.constants(h)),
        }
    }

    fn are_finite(constants: &Constants) -> bool {
        of_its_type!(constants, finite())
    }

    fn kick_before(constants: &Constants, (): &()) -> Vector3<f64> {
        of_its_type!(constants, before())
    }

    #[inline(always)]
    fn step_terms(constants: &Constants, a: &Vector3<f64>, (): &()) -> StepTerms {
        match constants {
            OneOf::Cayley(constants) => OneOf::Cayley(terms::<CayleyBody>(constants, a)),
            OneOf::Geodesic(constants) => OneOf::Geodesic(terms::<GeodesicBody>(constants, a)),
            OneOf::FourthOrder(constants) => OneOf::FourthOrder(terms::<FourthOrderBody>(constants, a)),
            OneOf::SixthOrder(constants) => OneOf::SixthOrder(terms::<SixthOrderBody>(constants, a)),
        }
    }

    /// Of constants and terms of the same; there are no others.
    #[inline(always)]
    fn newton_system(constants: &Constants, terms: &StepTerms, half: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        match (constants, terms) {
            (OneOf::Cayley(constants), OneOf::Cayley(terms)) => system::<CayleyBody>(constants, terms, half),
            (OneOf::Geodesic(constants), OneOf::Geodesic(terms)) => system::<GeodesicBody>(constants, terms, half),
            (OneOf::FourthOrder(constants), OneOf::FourthOrder(terms)) => {
                system::<FourthOrderBody>(constants, terms, half)
            }
            (OneOf::SixthOrder(constants), OneOf::SixthOrder(terms)) => {
                system::<SixthOrderBody>(constants, terms, half)
            }
            _ => {
                debug_assert!(false, "the terms are those of another body than the constants");
                (Vector3::from_element(f64::NAN), Matrix3::zeros())
            }
        }
    }

    fn kick_after(constants: &Constants, increment: &Matrix3<f64>, (): &()) -> Vector3<f64> {
        of_its_type!(constants, after(increment))
    }
}

impl DiscreteLagrangian for ChosenBody {
    const SELF_ADJOINT: bool = CayleyBody::<f64>::SELF_ADJOINT
        && GeodesicBody::<f64>::SELF_ADJOINT
        && FourthOrderBody::<f64>::SELF_ADJOINT
        && SixthOrderBody::<f64>::SELF_ADJOINT;

    delegate_term!(whichever: l_d right_momentum left_momentum diamond discrete_energy);
}
