//! The derivatives of a body's exact motion with respect to its momentum and its inertia. The forward mode and long
//! drifts use dual numbers in the closed form, the reverse mode [its adjoint](super::reverse).
//!
//! The derivatives of elliptic functions with respect to their invariants are quotients whose numerator and denominator
//! vanish for symmetric bodies and at the separatrix. The closed form and its derivative have no such singularity.
//!
//! On the separatrix, where `K_a = K_b = K`, [`doubling`](super::doubling) clamps the functions `c = d` to the square
//! of a rounding error `ε`, and after that their slopes are zero: from `2√K = ln(2/ε²)` on, which is 73 for doubles.
//! There the motion has amplified a deviation by `ε⁻²`, and its derivative doesn't predict the next double.

use nalgebra::{Matrix3, Vector3};

use super::super::linearised::{DifferentiableFlow, DriftEvent, before_turn, flown};
use super::super::quaternion::product;
use super::{ExactBody, Form};
use crate::gradients::{Cotangent, Pass, add_shares};
use crate::groups::SO3;
use crate::mechanics::SceneVisitor;
use crate::numbers::{Dual, Real, real};

/// The closed form of a motion of one duration; with derivatives, at fixed moments and along each of them.
#[derive(Clone, Debug)]
pub struct Forms<T>(Form<T>, [Form<Dual<T>>; 2]);

/// The parameters are documented at [`ExactBody`], under "Derivatives".
impl<T: Real> DifferentiableFlow<T> for ExactBody<T> {
    const PARAMETERS: usize = 6;

    type Slopes = Forms<T>;

    fn slopes(flow: &Self, time: T) -> Self::Slopes {
        let moments = flow.moments.0;
        let both = [moments.map(Dual::constant), core::array::from_fn(|k| Dual::along(moments[k], k))];
        Forms(Form::of(moments, time), both.map(|moments| Form::of(moments, Dual::constant(time))))
    }

    fn describe_parameters(flow: &Self, visitor: &mut dyn SceneVisitor<T>) {
        let mut moments = flow.moments.0;
        flow.frame.places().into_iter().zip(flow.moments.0).for_each(|(place, moment)| moments[place] = moment);
        for moment in moments {
            visitor.parameter("moment", moment);
        }
        for _ in 0..3 {
            visitor.parameter("turn", T::zero());
        }
    }

    #[hot]
    fn visit<A>(flow: &Self, drift: &DriftEvent<'_, T, Forms<T>, A>, pass: &mut impl Pass<SO3<T>>) {
        let (&DriftEvent { event, first, .. }, Forms(form, [fixed, varied])) = (drift, drift.slopes);
        let (momentum, increment) = (event.before.momentum, event.increment);
        if let Some((end, gradient)) = pass.on_the_way_back()
            && let Some((before, shares)) = flow.pulled(form, (&momentum, &increment), end)
        {
            *end = before;
            return add_shares(gradient, first, &shares);
        }
        let along = flow.frame.within(&momentum);
        let turns = flow.turns(fixed, |k| fixed.scale * Dual::along(along[k], k));
        let inward = |k: usize| flow.frame.within(&Matrix3::identity().column(k).into_owned());
        let turn_by_momentum =
            Matrix3::from_columns(&turns) * Matrix3::from_columns(&[0, 1, 2].map(|k| Vector3::from(inward(k))));
        if !pass.asks_for_parameters() {
            return pass.flown(&flown(turn_by_momentum, &increment, &momentum, &[]));
        }
        let by_moments = flow.turns(varied, |k| varied.scale * Dual::constant(along[k]));
        // F(R J Rᵀ, p) = R F(J, Rᵀ p) Rᵀ.
        let by_axes = turn_by_momentum * momentum.cross_matrix() - increment;
        let places = flow.frame.places();
        let moment = |k: usize| (first + places[k], by_moments[k]);
        let axis = |k: usize| (first + 3 + k, by_axes.column(k).into_owned());
        let by_parameters = [moment(0), moment(1), moment(2), axis(0), axis(1), axis(2)];
        pass.flown(&flown(turn_by_momentum, &increment, &momentum, &by_parameters));
    }
}

#[hot]
impl<T: Real> ExactBody<T> {
    /// The cotangent before a drift from that after it, and the derivatives with respect to the parameters; `None` if
    /// the drift is too long for the polynomials.
    fn pulled(
        &self,
        form: &Form<T>,
        (momentum, increment): (&Vector3<T>, &Matrix3<T>),
        end: &Cotangent<Vector3<T>>,
    ) -> Option<(Cotangent<Vector3<T>>, [T; 6])> {
        let along = self.frame.within(momentum);
        let (before, by_turn) = before_turn(increment, momentum, end);
        let (by_u, [by_a, by_b]) = form.reversed(along.map(|part| part * form.scale), self.frame.within(&by_turn))?;
        let [_, x, y, z] = self.frame.back([T::zero(), by_u[0], by_u[1], by_u[2]]);
        let by_momentum = Vector3::new(x, y, z) * form.scale;
        let axes = by_momentum.cross(momentum) - increment.tr_mul(&by_turn);
        let over = self.moments.0.map(|moment| T::one() / moment);
        let [by_a, by_b, by_scale] = [by_a * over[0], by_b * over[1], momentum.dot(&by_momentum) * over[2]];
        let of_moments = [-(by_a + by_a * form.a), -(by_b + by_b * form.b), (by_a + by_b) - by_scale];
        let mut shares = [axes.x; 6];
        self.frame.places().into_iter().zip(of_moments).for_each(|(place, share)| shares[place] = share);
        shares[3..].copy_from_slice(axes.as_slice());
        Some((Cotangent { momentum: before.momentum + by_momentum, ..before }, shares))
    }

    /// The turns `ε`, `δF = ε̂ F`, along three directions, in the body's axes.
    fn turns(&self, form: &Form<Dual<T>>, u: impl Fn(usize) -> Dual<T>) -> [Vector3<T>; 3] {
        let turned = form.turned([u(0), u(1), u(2)]);
        let [w, x, y, z] = turned.map(|part| part.value);
        let scale = real::<T>(2.0) / ((w * w + x * x) + (y * y + z * z));
        core::array::from_fn(|k| {
            // ½ ε̂ is the change of the quaternion divided by the quaternion.
            let [_, a, b, c] = product(turned.map(|part| part.slopes[k]), [w, -x, -y, -z]);
            let [_, x, y, z] = self.frame.back([T::zero(), a, b, c]);
            Vector3::new(x, y, z) * scale
        })
    }
}
