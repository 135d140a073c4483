//! The derivatives of a splitting: those of kicks come from the scene, those of drifts from the flow.
//!
//! The kick of a force gradient contains the scene's `J⁻¹`, so it has derivatives with respect to the scene's inertia,
//! too.

use alloc::vec::Vec;
use core::fmt::Debug;

use nalgebra::{Matrix3, Vector3};

use super::kinetic_flow::SymmetricBody;
use super::{Flow, KineticFlow, Length, Splitting};
use crate::error::{SetupError, StepError};
use crate::gradients::{
    Change, ChangeOf, Cotangent, FlowDerivatives, ForceGradient, Linearisable, Pass, Stage, add_shares,
};
use crate::groups::SO3;
use crate::groups::rotation_functions::stumpff;
use crate::mechanics::{
    DiscreteLagrangian, Effect, Group, Regular, RigidScene, Scalar, SceneVisitor, SecondDerivatives,
};
use crate::motion::{Plan, StepReport, Summation};
use crate::numbers::{Real, real};

/// A kinetic flow with derivatives: [`SymmetricBody`], [`ExactBody`](super::ExactBody), and every flow that is declared
/// with `gradients`.
///
/// A flow that is implemented by hand outside of the library can't have derivatives, as only the library constructs the
/// arguments of a [`Pass`].
///
/// The flow's parameters come after those of the scene, as a term of their own: in a splitting the body moves by the
/// flow's inertia, not by the scene's. If the two share an inertia, its derivative is the sum of both.
#[diagnostic::on_unimplemented(
    message = "the derivatives of the flow `{Self}` aren't known",
    label = "neither declared with `gradients` nor exact",
    note = "take `SymmetricBody`, `ExactBody`, or a declared body, as `RigidBody` or `PrincipalBody` of `liestep::effects`"
)]
#[doc(hidden)]
pub trait DifferentiableFlow<T: Real>: KineticFlow<T> {
    /// The number of scalar parameters.
    const PARAMETERS: usize;

    /// Visits the parameters.
    fn describe_parameters(flow: &Self, visitor: &mut dyn SceneVisitor<T>);

    /// The part of the derivatives that all motions of one duration share.
    type Slopes: Clone + Debug;

    /// The shared part of the derivatives for this duration, s.
    fn slopes(flow: &Self, time: T) -> Self::Slopes;

    /// Passes the derivatives of a drift to `pass`.
    fn visit<A>(flow: &Self, drift: &DriftEvent<'_, T, Self::Slopes, A>, pass: &mut impl Pass<SO3<T>>);
}

/// A drift of this duration, s. Its parameters are numbered from `first` on, among those of the splitting.
#[doc(hidden)]
pub struct DriftEvent<'a, T: Real, D, A> {
    pub(super) time: T,
    pub(super) slopes: &'a D,
    pub(super) event: &'a Change<SO3<T>, A>,
    pub(super) first: usize,
}

impl<T: Real, L> DifferentiableFlow<T> for L
where
    L: DiscreteLagrangian<Scalar = T, Group = SO3<T>, Advected = ()> + SecondDerivatives + Regular + Clone,
{
    const PARAMETERS: usize = <L as SecondDerivatives>::PARAMETERS;

    type Slopes = ();

    fn slopes(_: &Self, _: T) {}

    fn describe_parameters(flow: &Self, visitor: &mut dyn SceneVisitor<T>) {
        Effect::describe(flow, visitor);
    }

    #[hot]
    fn visit<A>(flow: &Self, drift: &DriftEvent<'_, T, (), A>, pass: &mut impl Pass<SO3<T>>) {
        pass.stage(&Stage::step(flow, drift.time, drift.event, ()).behind(drift.first));
    }
}

/// For `F = exp(t p̂) exp(−s p_3 E_3)` with `t = h/J_1` and `s = h (1/J_1 − 1/J_3)`, the variation is
///
/// ```text
/// ε = dexp(t p̂) δ(t p) − δ(s p_3) F e_3        dexp(x̂) = I + c₂(|x|²) x̂ + c₃(|x|²) x̂²
/// ```
impl<T: Real> DifferentiableFlow<T> for SymmetricBody<T> {
    const PARAMETERS: usize = 2;

    type Slopes = ();

    fn slopes(_: &Self, _: T) {}

    fn describe_parameters(flow: &Self, visitor: &mut dyn SceneVisitor<T>) {
        Self::describe(flow, visitor);
    }

    #[hot]
    fn visit<A>(flow: &Self, drift: &DriftEvent<'_, T, (), A>, pass: &mut impl Pass<SO3<T>>) {
        let (&DriftEvent { time, event, first, .. }, (transverse, axial)) = (drift, Self::moments(flow));
        let (momentum, increment) = (event.before.momentum, event.increment);
        let t = time / transverse;
        let s = t * ((axial - transverse) / axial);
        // The axis of the second factor in space.
        let axis: Vector3<T> = increment.column(2) + Vector3::z();
        let x = momentum * t;
        let q = x.norm_squared();
        if let Some((end, gradient)) = pass.on_the_way_back() {
            let (before, by_turn) = before_turn(&increment, &momentum, end);
            let (across, along) = (x.cross(&by_turn), axis.dot(&by_turn));
            let of_direction = by_turn - across * stumpff::<T, 2>(q) + x.cross(&across) * stumpff::<T, 3>(q);
            let by_momentum = of_direction * t - Vector3::z() * (along * s);
            *end = Cotangent { momentum: before.momentum + by_momentum, ..before };
            let spin = along * momentum.z;
            let by_transverse = (spin - momentum.dot(&by_turn)) * (t / transverse);
            return add_shares(gradient, first, &[by_transverse, -(spin * (time / (axial * axial)))]);
        }
        let hat = x.cross_matrix();
        let of_direction = (Matrix3::identity() + hat * stumpff::<T, 2>(q) + hat * hat * stumpff::<T, 3>(q)) * t;
        let turn_by_momentum = of_direction - Matrix3::from_columns(&[Vector3::zeros(), Vector3::zeros(), axis * s]);
        // Along p itself dexp is the identity.
        let spin = axis * momentum.z;
        let by_transverse = (spin - momentum) * (t / transverse);
        let by_axial = spin * -(time / (axial * axial));
        let by_parameters = [(first, by_transverse), (first + 1, by_axial)];
        pass.flown(&flown(turn_by_momentum, &increment, &momentum, &by_parameters));
    }
}

/// The cotangent before a turn, `F z` and `F p`, without the turn's own dependence on the momentum, and the derivative
/// with respect to the turn, `F z − μ × F p`. The turn is `F = I + D`, and `μ` the body's momentum before it.
#[hot]
pub(super) fn before_turn<T: Real>(
    increment: &Matrix3<T>,
    momentum: &Vector3<T>,
    end: &Cotangent<Vector3<T>>,
) -> (Cotangent<Vector3<T>>, Vector3<T>) {
    let [attitude, carried] = [end.attitude, end.momentum].map(|part| part + increment * part);
    (Cotangent { attitude, momentum: carried }, attitude - momentum.cross(&carried))
}

/// The derivatives of a turn by `F` with this increment, of a body with this momentum before it.
#[hot]
pub(super) fn flown<'a, T: Real>(
    turn_by_momentum: Matrix3<T>,
    increment: &Matrix3<T>,
    momentum: &Vector3<T>,
    by_parameters: &'a [(usize, Vector3<T>)],
) -> FlowDerivatives<'a, SO3<T>> {
    let turned_back = (increment + Matrix3::identity()).transpose();
    let end_by_turn = turned_back * momentum.cross_matrix();
    FlowDerivatives { turn_by_momentum, turned_back, end_by_turn, by_parameters }
}

impl<S, K> Linearisable<S> for Splitting<S, K>
where
    S: RigidScene + SecondDerivatives,
    K: DifferentiableFlow<Scalar<S>>,
{
    type Table = Table<Scalar<S>, K::Slopes>;

    fn table(&self) -> Self::Table {
        let shares = self.scheme.shares().zip(self.scheme.gradients());
        self.table_of(shares.map(|share| Length::of(self.h, 1.0, share)))
    }

    fn parameters(&self) -> usize {
        S::PARAMETERS + K::PARAMETERS
    }

    fn describe_parameters(&self, scene: &S, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        scene.describe(visitor);
        K::describe_parameters(&self.kinetic, visitor);
    }

    fn check_stages(&self, scene: &S) -> Result<(), SetupError> {
        if self.scheme.has_gradients() { Self::check_gradients(scene) } else { Ok(()) }
    }

    fn stages(&self) -> usize {
        self.scheme.shares().count()
    }

    /// Applying all spins once after the drifts is equivalent only for symmetric potentials. The derivative with
    /// respect to the potential also has asymmetric directions, so the recorded drifts include their own spins.
    #[hot]
    fn record<M: Summation<SO3<Scalar<S>>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut (),
        _ends: [bool; 2],
    ) -> Result<StepReport, StepError> {
        if self.spin.is_none() {
            return self.step(scene, motion, kept);
        }
        let mut whole = *motion;
        for shares in [&self.first, &self.last] {
            self.make_all::<true, M>(shares, &mut whole, &mut 0)?;
        }
        let mut plain = *motion.now();
        let report = self.step(scene, &mut plain, kept)?;
        motion.replace(plain);
        Ok(report)
    }

    #[hot]
    fn visit(&self, stages: (&S, &Self::Table), event: (usize, &ChangeOf<S>), pass: &mut impl Pass<Group<S>>) {
        let ((scene, table), (index, event)) = (stages, event);
        let Some((length, slopes)) = table.0.get(index) else { return };
        if let Some(slopes) = slopes {
            let drift = DriftEvent { time: length.time, slopes, event, first: S::PARAMETERS };
            return K::visit(&self.kinetic, &drift, pass);
        }
        let (torque, inverse_inertia) = (&self.torque, &self.inverse_inertia);
        let gradient = length.gradient.map(|share| ForceGradient { share, torque, inverse_inertia });
        pass.stage(&Stage::kick(scene, length.time, gradient, event));
    }
}

impl<S, K> Splitting<S, K>
where
    S: RigidScene + SecondDerivatives,
    K: DifferentiableFlow<Scalar<S>>,
{
    /// Checks that the derivatives of force gradients are known.
    pub(super) fn check_gradients(scene: &S) -> Result<(), SetupError> {
        let (w, zero) = (scene.advected(), Vector3::repeat(real(0.0)));
        let known = scene.kick_gradient(&w, &zero, [&zero; 2], &mut |_, _| {});
        known.map(|_| ()).ok_or(SetupError::NoSecondDerivatives)
    }

    /// The table for shares of these lengths.
    pub(super) fn table_of(&self, lengths: impl Iterator<Item = Length<Scalar<S>>>) -> Table<Scalar<S>, K::Slopes> {
        let slopes = |time| K::slopes(&self.kinetic, time);
        Table(lengths.map(|length| (length, (length.flow == Flow::Drift).then(|| slopes(length.time)))).collect())
    }
}

/// The lengths of all shares of a step, and for drifts the shared part of the derivatives.
#[derive(Clone, Debug)]
pub struct Table<T, D>(Vec<(Length<T>, Option<D>)>);
