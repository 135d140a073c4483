//! An effect that a scene has or hasn't: asked in each step, so that all scenes are of few types.

use liestep::mechanics::{DiscreteLagrangian, Effect, Matrix, Operations, Parts, Term};
use liestep::numbers::Entries as _;
use liestep::{SO3, SetupError, delegate_term};
use nalgebra::{Matrix3, Vector3};

/// An effect on a body that is there or not, which is asked at run time; of nothing all shares are zero.
///
/// Scenes with it are of one type whether the effect is there or not. A sum without it costs less:
/// `cargo bench --bench scenes -- instructions` counts both.
#[derive(Clone, Copy, Debug)]
pub struct Switched<E>(pub Option<E>);

/// An expression in the effect, or zero where there is none.
macro_rules! if_there {
    ($self:ident, $effect:ident => $value:expr) => {
        $self.0.as_ref().map_or_else(Default::default, |$effect| $value)
    };
}

impl<E: Effect<Scalar = f64, Group = SO3>> Term for Switched<E> {
    type Scalar = f64;
    type Group = SO3;
    type Advected = E::Advected;

    fn validate(&self) -> Result<(), SetupError> {
        self.0.as_ref().map_or(Ok(()), E::validate)
    }

    /// Zeros, which are carried along, where there is nothing.
    fn advected(&self) -> E::Advected {
        self.0.as_ref().map_or_else(|| E::Advected::from_entries(&mut || 0.0), E::advected)
    }
}

impl<E: Effect<Scalar = f64, Group = SO3>> Effect for Switched<E> {
    type Retraction = E::Retraction;
    type Kinetic = E::Kinetic;
    type Constants = Option<E::Constants>;
    type StepTerms = Option<E::StepTerms>;

    const PARTS: Parts = E::PARTS;
    const INERTIA_IS_CONSTANT: bool = E::INERTIA_IS_CONSTANT;
    const IS_QUADRATIC: bool = E::IS_QUADRATIC;
    const DENOMINATORS: u32 = E::DENOMINATORS;
    const OPERATIONS: Operations = E::OPERATIONS;
    const DERIVATION: &'static str = E::DERIVATION;

    delegate_term!(if_there: describe momentum_jacobian limit);

    fn constants(&self, h: f64) -> Self::Constants {
        self.0.as_ref().map(|effect| effect.constants(h))
    }

    #[inline(always)]
    fn kick_before(constants: &Self::Constants, w: &E::Advected) -> Vector3<f64> {
        constants.as_ref().map_or_else(Vector3::zeros, |constants| E::kick_before(constants, w))
    }

    #[inline(always)]
    fn kick_derivative(constants: &Self::Constants, w: &E::Advected, velocity: &Vector3<f64>) -> Option<Vector3<f64>> {
        let derivative = |constants| E::kick_derivative(constants, w, velocity);
        constants.as_ref().map_or_else(|| Some(Vector3::zeros()), derivative)
    }

    #[inline(always)]
    fn step_terms(constants: &Self::Constants, a: &Vector3<f64>, w: &E::Advected) -> Self::StepTerms {
        constants.as_ref().map(|constants| E::step_terms(constants, a, w))
    }

    #[inline(always)]
    fn newton_system(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        half: &Vector3<f64>,
    ) -> (Vector3<f64>, Matrix3<f64>) {
        match (constants, terms) {
            (Some(constants), Some(terms)) => E::newton_system(constants, terms, half),
            _ => (Vector3::zeros(), Matrix3::zeros()),
        }
    }

    #[inline(always)]
    fn kick_after(constants: &Self::Constants, increment: &Matrix<E>, next: &E::Advected) -> Vector3<f64> {
        constants.as_ref().map_or_else(Vector3::zeros, |constants| E::kick_after(constants, increment, next))
    }
}

impl<E: DiscreteLagrangian<Scalar = f64, Group = SO3>> DiscreteLagrangian for Switched<E> {
    const SELF_ADJOINT: bool = E::SELF_ADJOINT;

    delegate_term!(if_there: l_d right_momentum left_momentum diamond discrete_energy);
}
