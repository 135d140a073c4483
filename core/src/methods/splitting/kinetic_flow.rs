//! Flows of the kinetic energy `½ p·J⁻¹p` on SO(3): the free body.

use nalgebra::{Matrix3, SimdBool as _, Vector3};

use crate::error::{SetupError, StepError};
use crate::groups::SO3;
use crate::groups::rotation_coefficients;
use crate::mechanics::{DiscreteLagrangian, Effect, Inertia, Operations, Regular, SceneVisitor};
use crate::motion::DiscreteLiePoisson;
use crate::numbers::{Coordinates as _, Real, real, reported};

/// A flow, or a structure-preserving approximation of it, of the free body's motion.
///
/// What it says of the body are associated functions. A declared Lagrangian is a flow, too, and has a method
/// [`inertia`](Effect::inertia) already.
pub trait KineticFlow<T: Real>: Clone {
    /// The flow over one share of the step, its constants folded.
    type Drift: Clone;

    /// How much arithmetic the flow over one share is.
    const OPERATIONS: Operations = Operations::UNCOUNTED;

    /// Whether it is the motion itself, but for rounding, whatever the time.
    const EXACT: bool = false;

    /// How much of that its [`spin`](Self::spin) is. Where it is zero, the spin stays in the drifts.
    const OPERATIONS_OF_SPIN: u32 = 0;

    /// Shows its name and every constant: two flows that show the same move a body in the same way.
    fn describe(flow: &Self, visitor: &mut dyn SceneVisitor<T>);

    /// The inertia `J` of the body, kg m².
    fn inertia(flow: &Self) -> Matrix3<T>;

    /// Whether the inertia is diagonal.
    #[must_use]
    fn has_principal_axes(_flow: &Self) -> bool {
        false
    }

    /// The momentum `s` at rest, `p = JΩ + s`, kg m²/s: that of rotors in the body, which most bodies haven't got.
    fn momentum_bias(_flow: &Self) -> Vector3<T> {
        Vector3::repeat(T::zero())
    }

    /// The flow over the time `h`, s.
    ///
    /// # Errors
    ///
    /// [`SetupError`] for a body or a time that can't be used.
    fn drift(&self, h: T) -> Result<Self::Drift, SetupError>;

    /// The `s` of the rotation `exp(−s p_3 E_3)` about the third body axis that the drift ends with, 1/(kg m²/s), where it
    /// is one that commutes with all else about that axis.
    ///
    /// Under a potential that is symmetric about the axis, too, those of all drifts are made at once. A flow that has it
    /// says its [operations](Self::OPERATIONS_OF_SPIN), and what is [left](Self::advance_without_spin) of the drift.
    #[must_use]
    fn spin(_drift: &Self::Drift) -> Option<T> {
        None
    }

    /// Moves the body.
    ///
    /// # Errors
    ///
    /// [`StepError`] where an equation has no solution.
    fn advance(drift: &Self::Drift, momentum: &Vector3<T>) -> Result<Turn<T>, StepError>;

    /// The flow without its [`spin`](Self::spin), so that `exp(−s p_3 E_3)` after it makes the whole. A flow with
    /// [operations of a spin](Self::OPERATIONS_OF_SPIN) has to write it, or else doesn't compile.
    ///
    /// # Errors
    ///
    /// As [`advance`](Self::advance).
    #[hot]
    fn advance_without_spin(drift: &Self::Drift, momentum: &Vector3<T>) -> Result<Turn<T>, StepError> {
        const { assert!(Self::OPERATIONS_OF_SPIN == 0, "a flow with a spin needs an `advance_without_spin`") };
        Self::advance(drift, momentum)
    }
}

/// What a body did.
#[derive(Clone, Copy, Debug)]
pub struct Turn<T> {
    /// `F − I`.
    pub increment: Matrix3<T>,
    /// `Fᵀ p − p`.
    pub change: Vector3<T>,
    /// Newton iterations; none for a closed form.
    pub iterations: u32,
}

/// The free motion of a symmetric body, `J = diag(J_1, J_1, J_3)`, in closed form.
///
/// ```text
/// F = exp(h p/J_1) exp(−h (1/J_1 − 1/J_3) p_3 E_3)        p⁺ = Fᵀ p
/// ```
///
/// It is exact, there is nothing to solve, and `p_3` isn't even computed anew.
#[derive(Clone, Copy, Debug, PartialEq, Lanes, InLanes)]
pub struct SymmetricBody<T = f64> {
    transverse: T,
    axial: T,
}

impl<T: Real> SymmetricBody<T> {
    /// The body with this inertia about the pivot.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] where that isn't symmetric about the third body axis.
    pub fn new(inertia: &Inertia<T>) -> Result<Self, SetupError> {
        let j = inertia.as_matrix();
        let expected = Matrix3::from_diagonal(&Vector3::new(j.m11, j.m11, j.m33));
        let allowed = j.m11 * T::simd_default_epsilon() * real(4.0);
        if !(j - expected).iter().all(|entry| entry.simd_abs().simd_le(allowed).all()) {
            return Err(SetupError::Parameter {
                field: "inertia",
                cause: "is not symmetric about the third body axis",
            });
        }
        Ok(Self { transverse: j.m11, axial: j.m33 })
    }

    /// `J_1` and `J_3`.
    pub(super) fn moments(flow: &Self) -> (T, T) {
        (flow.transverse, flow.axial)
    }
}

/// `h/J_1` and `h (1/J_1 − 1/J_3)`.
#[derive(Clone, Copy, Debug, Lanes)]
pub struct SymmetricDrift<T> {
    about_momentum: T,
    about_axis: T,
}

impl<T: Real> KineticFlow<T> for SymmetricBody<T> {
    type Drift = SymmetricDrift<T>;

    const EXACT: bool = true;

    // A rotation is 62, 30 of them for its two coefficients; nothing is solved.
    const OPERATIONS: Operations = Operations { step: 131, iteration: 0 };
    // The other rotation's sine and cosine, its product with the first and what it does to the momentum.
    const OPERATIONS_OF_SPIN: u32 = 69;

    fn describe(flow: &Self, visitor: &mut dyn SceneVisitor<T>) {
        visitor.term("exact flow of a symmetric body");
        visitor.parameter("transverse", flow.transverse);
        visitor.parameter("axial", flow.axial);
    }

    fn inertia(flow: &Self) -> Matrix3<T> {
        Matrix3::from_diagonal(&Vector3::new(flow.transverse, flow.transverse, flow.axial))
    }

    fn drift(&self, h: T) -> Result<Self::Drift, SetupError> {
        let (about_momentum, difference) = (h / self.transverse, (self.axial - self.transverse) / self.axial);
        let about_axis = about_momentum * difference;
        if !crate::numbers::is_finite(about_momentum + about_axis) {
            return Err(SetupError::InvalidStep { step: reported(h) });
        }
        Ok(SymmetricDrift { about_momentum, about_axis })
    }

    fn spin(drift: &Self::Drift) -> Option<T> {
        Some(drift.about_axis)
    }

    #[hot]
    fn advance_without_spin(drift: &Self::Drift, p: &Vector3<T>) -> Result<Turn<T>, StepError> {
        let [(a11, a21, a31), (a12, a22, a32), (a13, a23, a33)] = rotation(p, drift.about_momentum);
        let increment = Matrix3::new(a11, a12, a13, a21, a22, a23, a31, a32, a33);
        // Not a number where the angle has no digit left.
        Ok(Turn { increment, change: Vector3::repeat(a33 * T::zero()), iterations: 0 })
    }

    #[hot]
    fn advance(drift: &Self::Drift, p: &Vector3<T>) -> Result<Turn<T>, StepError> {
        let angle = drift.about_axis * p.z;
        let (sinc, versine) = rotation_coefficients(angle * angle);
        // sin θ and cos θ − 1, without cancellation.
        let (s, v) = (angle * sinc, -(angle * angle * versine));
        let [a1, a2, a3] = rotation(p, drift.about_momentum);
        // The last is zero, or not a number where the angle has no digit left.
        let change = Vector3::new(v * p.x - s * p.y, v * p.y + s * p.x, a3.2 * T::zero());
        // D = A + B + A B, where B turns by −θ about the third axis: B_11 = B_22 = v, B_12 = −B_21 = s.
        let turned_1 = (a1.0 * v - a2.0 * s, a1.1 * v - a2.1 * s, a1.2 * v - a2.2 * s);
        let turned_2 = (a1.0 * s + a2.0 * v, a1.1 * s + a2.1 * v, a1.2 * s + a2.2 * v);
        #[rustfmt::skip]
        let increment = Matrix3::new(
            a1.0 + (v + turned_1.0), a2.0 + (s + turned_2.0), a3.0,
            a1.1 + (turned_1.1 - s), a2.1 + (v + turned_2.1), a3.1,
            a1.2 + turned_1.2,       a2.2 + turned_2.2,       a3.2,
        );
        Ok(Turn { increment, change, iterations: 0 })
    }
}

/// `exp(t p̂) − I` by Rodrigues' formula, column by column.
#[hot]
fn rotation<T: Real>(p: &Vector3<T>, t: T) -> [(T, T, T); 3] {
    let (x, y, z) = (p.x * t, p.y * t, p.z * t);
    let (xx, yy) = (x * x, y * y);
    // Where `p_3` is constant the rounding of its square is the same at each step, and would make turns that lengthen
    // or shorten in proportion to the number of steps; z² − x² is rounded anew each time.
    let difference = (z - x) * (z + x);
    let (both, zz) = (difference + (xx + xx), difference + xx);
    let (first, second) = rotation_coefficients(both + yy);
    let (ax, ay, az) = (first * x, first * y, first * z);
    let (xy, xz, yz) = (second * x * y, second * x * z, second * y * z);
    let (d1, d2, d3) = (second * (yy + zz), second * both, second * (xx + yy));
    [(-d1, xy + az, xz - ay), (xy - az, -d2, yz + ax), (xz + ay, yz - ax, -d3)]
}

/// The flow of a declared Lagrangian without potential: any of its structure, to its order.
impl<T: Real, L> KineticFlow<T> for L
where
    L: DiscreteLagrangian<Scalar = T, Group = SO3<T>, Advected = ()> + Regular + Clone,
{
    type Drift = DeclaredDrift<L>;

    // The guess takes 49 more, and the difference of the momenta 3.
    const OPERATIONS: Operations =
        Operations { step: L::OPERATIONS.step.saturating_add(52), iteration: L::OPERATIONS.iteration };

    fn describe(flow: &Self, visitor: &mut dyn SceneVisitor<T>) {
        visitor.term("declared flow");
        Effect::describe(flow, visitor);
    }

    fn inertia(flow: &Self) -> Matrix3<T> {
        Effect::inertia(flow, &())
    }

    fn momentum_bias(flow: &Self) -> Vector3<T> {
        Effect::momentum_bias(flow, &())
    }

    fn drift(&self, h: T) -> Result<Self::Drift, SetupError> {
        let inverse = inverse_inertia(self);
        Ok(DeclaredDrift { flow: DiscreteLiePoisson::new(self.clone(), h)?, inverse })
    }

    #[hot]
    fn advance(drift: &Self::Drift, momentum: &Vector3<T>) -> Result<Turn<T>, StepError> {
        // Half an explicit step ahead is the velocity in the middle, to second order that of the whole.
        let h = drift.flow.step_size();
        let velocity = drift.inverse * momentum;
        let half_guess = (velocity + drift.inverse * momentum.cross(&velocity) * (h * real(0.5))) * (h * real(0.5));
        let step = drift.flow.increment_from(momentum, &(), &half_guess)?;
        Ok(Turn { increment: step.increment, change: step.momentum - momentum, iterations: step.iterations })
    }
}

/// `J⁻¹` of a constant inertia, symmetric but for the rounding of its columns.
pub(crate) fn inverse_inertia<T: Real, L: DiscreteLagrangian<Scalar = T, Group = SO3<T>>>(
    lagrangian: &L,
) -> Matrix3<T> {
    let inertia = lagrangian.inertia(&lagrangian.advected());
    let column = |k: usize| Vector3::solve(&inertia, &Matrix3::identity().column(k).into_owned()).0;
    Matrix3::from_columns(&[column(0), column(1), column(2)])
}

/// A declared flow, and the inverse inertia that its guesses are made with.
#[derive(Clone, Debug, Lanes)]
pub struct DeclaredDrift<L: DiscreteLagrangian<Group = SO3<T>, Scalar = T>, T: Real = crate::mechanics::Scalar<L>> {
    flow: DiscreteLiePoisson<L>,
    inverse: Matrix3<T>,
}
