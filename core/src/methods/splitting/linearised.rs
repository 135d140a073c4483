//! The derivatives of a splitting: those of its kicks are the scene's, those of its drifts the flow's.

use super::{Flow, KineticFlow, Split};
use crate::error::SetupError;
use crate::groups::SO3;
use crate::mechanics::{DiscreteLagrangian, Effect, Regular, RigidScene, Scalar, SceneVisitor, SecondDerivatives};
use crate::motion::linearised::{Change, Linearisable, Pass, Stage};
use crate::numbers::{Real, real};

/// A kinetic flow that can be differentiated: one that is declared with `gradients`.
///
/// Every such declaration is one; there is nothing to implement by hand.
///
/// Its parameters are behind those of the scene, as a term of their own: in a splitting the body moves by the flow's
/// inertia, not by the scene's. What depends on both, as an inertia that the two share, sums both derivatives.
#[diagnostic::on_unimplemented(
    message = "the derivatives of the flow `{Self}` aren't known",
    label = "not declared with `gradients`",
    note = "take a declared body for the flow, as `RigidBody`, `PrincipalBody` or `GeodesicBody` of `liestep::effects`"
)]
pub trait DifferentiableFlow<T: Real>: KineticFlow<T> {
    /// The declaration.
    type Declared: SecondDerivatives<Scalar = T, Group = SO3<T>, Advected = ()>;

    /// The declaration of a flow.
    fn declared(flow: &Self) -> &Self::Declared;
}

impl<T: Real, L> DifferentiableFlow<T> for L
where
    L: DiscreteLagrangian<Scalar = T, Group = SO3<T>, Advected = ()> + SecondDerivatives + Regular + Clone,
{
    type Declared = L;

    fn declared(flow: &Self) -> &L {
        flow
    }
}

impl<S, K> Linearisable<S> for Split<S, K>
where
    S: RigidScene + SecondDerivatives,
    K: DifferentiableFlow<Scalar<S>>,
{
    fn parameters(&self) -> usize {
        S::PARAMETERS + K::Declared::PARAMETERS
    }

    fn describe_parameters(&self, scene: &S, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        scene.describe(visitor);
        Effect::describe(K::declared(&self.kinetic), visitor);
    }

    fn check_stages(&self) -> Result<(), SetupError> {
        if self.scheme.has_gradients() { Err(SetupError::NoSecondDerivatives) } else { Ok(()) }
    }

    fn stages(&self) -> usize {
        self.scheme.shares().map(|(flow, _)| changes(flow)).sum()
    }

    #[inline(always)]
    fn visit(
        &self,
        scene: &S,
        index: usize,
        event: &Change<SO3<Scalar<S>>, S::Advected>,
        pass: &mut impl Pass<SO3<Scalar<S>>>,
    ) {
        let mut before = 0;
        for (flow, part) in self.scheme.shares() {
            let time = self.h * real(part);
            match flow {
                Flow::Kick if before == index => pass.stage(&Stage::kick(scene, time, event)),
                Flow::Drift if before == index => {
                    let drift = Stage::step(K::declared(&self.kinetic), time, event, ());
                    pass.stage(&drift.behind(S::PARAMETERS));
                }
                _ => {}
            }
            before += changes(flow);
        }
    }
}

/// How often a share changes the motion: a drift turns the body, and then turns the momentum in its axes, which is one
/// stage.
fn changes(flow: Flow) -> usize {
    match flow {
        Flow::Drift => 2,
        Flow::Kick => 1,
    }
}
