//! Flows of the kinetic energy `½ p·J⁻¹p` on SO(3): the free body.

use nalgebra::{Matrix3, SimdBool as _, Vector3};

use crate::error::{SetupError, StepError};
use crate::groups::SO3;
use crate::groups::rotation_coefficients;
use crate::mechanics::{DiscreteLagrangian, Effect, Inertia, Operations, Regular, SceneVisitor, inertia};
use crate::motion::DiscreteLiePoisson;
use crate::numbers::{Coordinates as _, Real, real, reported};

/// The free body's flow, or a structure-preserving approximation of it.
///
/// The body's properties are associated functions and not methods, because a declared Lagrangian is a flow, too, and
/// has a method [`describe`](Effect::describe) already.
pub trait KineticFlow<T: Real>: Clone {
    /// The flow over one share of the step, with its constants folded.
    type Drift: Clone;

    /// The operations of the flow over one share.
    const OPERATIONS: Operations = Operations::UNCOUNTED;

    /// Whether the flow is exact to rounding for all times.
    const EXACT: bool = false;

    /// The part of the operations that is the [`spin`](Self::spin)'s. If it is zero, the spin stays in the drifts.
    const OPERATIONS_OF_SPIN: u32 = 0;

    /// Visits the name and every constant: two flows with the same description move a body in the same way.
    fn describe(flow: &Self, visitor: &mut dyn SceneVisitor<T>);

    /// The inertia `J` of the body, kg m².
    fn inertia(flow: &Self) -> Matrix3<T>;

    /// Whether the inertia is diagonal.
    #[must_use]
    fn has_principal_axes(_flow: &Self) -> bool {
        false
    }

    /// The momentum bias `s` in `p = JΩ + s`, kg m²/s: that of rotors in the body; zero for most bodies.
    fn momentum_bias(_flow: &Self) -> Vector3<T> {
        Vector3::repeat(T::zero())
    }

    /// The flow over the time `h`, s.
    ///
    /// # Errors
    ///
    /// [`SetupError`] for an invalid body or time.
    fn drift(&self, h: T) -> Result<Self::Drift, SetupError>;

    /// The `s` of the rotation `exp(−s p_3 E_3)` about the third body axis at the end of the drift, 1/(kg m²/s), if the
    /// drift ends with such a rotation and the rest of the drift commutes with rotations about that axis.
    ///
    /// If the potential is symmetric about the axis, too, the spins of all drifts of a step are applied at once. A flow
    /// with spin defines its [operations](Self::OPERATIONS_OF_SPIN), and the [rest](Self::advance_without_spin) of the
    /// drift.
    #[must_use]
    fn spin(_drift: &Self::Drift) -> Option<T> {
        None
    }

    /// Computes the body's motion over the drift.
    ///
    /// # Errors
    ///
    /// [`StepError`] if an equation has no solution.
    fn advance(drift: &Self::Drift, momentum: &Vector3<T>) -> Result<Turn<T>, StepError>;

    /// The flow without its [`spin`](Self::spin): followed by `exp(−s p_3 E_3)` it is the whole flow. A flow with
    /// [operations of a spin](Self::OPERATIONS_OF_SPIN) doesn't compile without its own definition.
    ///
    /// # Errors
    ///
    /// The errors of [`advance`](Self::advance).
    #[hot]
    fn advance_without_spin(drift: &Self::Drift, momentum: &Vector3<T>) -> Result<Turn<T>, StepError> {
        const { assert!(Self::OPERATIONS_OF_SPIN == 0, "a flow with a spin needs an `advance_without_spin`") };
        Self::advance(drift, momentum)
    }
}

/// The motion of a body over a drift.
#[derive(Clone, Copy, Debug)]
pub struct Turn<T> {
    /// The increment of the attitude, `F − I`.
    pub increment: Matrix3<T>,
    /// The change of the momentum, `Fᵀ p − p`.
    pub change: Vector3<T>,
    /// Newton iterations; zero for a closed form.
    pub iterations: u32,
}

/// The free motion of a symmetric body, `J = diag(J_1, J_1, J_3)`, in closed form.
///
/// ```text
/// F = exp(h p/J_1) exp(−h (1/J_1 − 1/J_3) p_3 E_3)        p⁺ = Fᵀ p
/// ```
///
/// The flow is exact, no equation is solved, and `p_3` stays constant to the bit.
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
    /// [`SetupError::Parameter`] if the inertia isn't symmetric about the third body axis.
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

    /// The moments `J_1` and `J_3`.
    pub(super) fn moments(flow: &Self) -> (T, T) {
        (flow.transverse, flow.axial)
    }
}

/// The factors `h/J_1` and `h (1/J_1 − 1/J_3)`.
#[derive(Clone, Copy, Debug, Lanes)]
pub struct SymmetricDrift<T> {
    about_momentum: T,
    about_axis: T,
}

impl<T: Real> KineticFlow<T> for SymmetricBody<T> {
    type Drift = SymmetricDrift<T>;

    const EXACT: bool = true;

    // A rotation is 62, 30 of them for its two coefficients; no equation is solved.
    const OPERATIONS: Operations = Operations { step: 131, iteration: 0 };
    // The second rotation's sine and cosine, its product with the first, and the change of the momentum.
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
        // NaN if the angle has no significant digit.
        Ok(Turn { increment, change: Vector3::repeat(a33 * T::zero()), iterations: 0 })
    }

    #[hot]
    fn advance(drift: &Self::Drift, p: &Vector3<T>) -> Result<Turn<T>, StepError> {
        let angle = drift.about_axis * p.z;
        let (sinc, versine) = rotation_coefficients(angle * angle);
        // sin θ and cos θ − 1, without cancellation.
        let (s, v) = (angle * sinc, -(angle * angle * versine));
        let [a1, a2, a3] = rotation(p, drift.about_momentum);
        // The last component is zero, or NaN if the angle has no significant digit.
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

/// The increment `exp(t p̂) − I` by Rodrigues' formula, column by column.
#[hot]
fn rotation<T: Real>(p: &Vector3<T>, t: T) -> [(T, T, T); 3] {
    let (x, y, z) = (p.x * t, p.y * t, p.z * t);
    let (xx, yy) = (x * x, y * y);
    // If `p_3` is constant, so is the rounding error of its square, and the turns' lengths would drift in proportion to
    // the number of steps; z² − x² has a new rounding error at each step.
    let difference = (z - x) * (z + x);
    let (both, zz) = (difference + (xx + xx), difference + xx);
    let (first, second) = rotation_coefficients(both + yy);
    let (ax, ay, az) = (first * x, first * y, first * z);
    let (xy, xz, yz) = (second * x * y, second * x * z, second * y * z);
    let (d1, d2, d3) = (second * (yy + zz), second * both, second * (xx + yy));
    [(-d1, xy + az, xz - ay), (xy - az, -d2, yz + ax), (xz + ay, yz - ax, -d3)]
}

/// The flow of a declared Lagrangian without potential: any Lagrangian of this structure, to its order.
impl<T: Real, L> KineticFlow<T> for L
where
    L: DiscreteLagrangian<Scalar = T, Group = SO3<T>, Advected = ()> + Regular + Clone,
{
    type Drift = DeclaredDrift<L>;

    // The initial guess has 49 more operations, and the difference of the momenta 3.
    const OPERATIONS: Operations =
        Operations { step: L::FACTS.operations.step.saturating_add(52), iteration: L::FACTS.operations.iteration };

    fn describe(flow: &Self, visitor: &mut dyn SceneVisitor<T>) {
        visitor.term("declared flow");
        Effect::describe(flow, visitor);
    }

    fn inertia(flow: &Self) -> Matrix3<T> {
        inertia(flow, &())
    }

    fn momentum_bias(flow: &Self) -> Vector3<T> {
        flow.limit(None, &()).momentum
    }

    fn drift(&self, h: T) -> Result<Self::Drift, SetupError> {
        let inverse = inverse_inertia(self);
        Ok(DeclaredDrift { flow: DiscreteLiePoisson::new(self.clone(), h)?, inverse })
    }

    #[hot]
    fn advance(drift: &Self::Drift, momentum: &Vector3<T>) -> Result<Turn<T>, StepError> {
        // Half an explicit step ahead is the velocity at the middle, which is the mean velocity to second order.
        let h = drift.flow.step_size();
        let velocity = drift.inverse * momentum;
        let half_guess = (velocity + drift.inverse * momentum.cross(&velocity) * (h * real(0.5))) * (h * real(0.5));
        let step = drift.flow.increment_from(momentum, &(), &half_guess)?;
        Ok(Turn { increment: step.increment, change: step.momentum - momentum, iterations: step.iterations })
    }
}

/// The inverse `J⁻¹` of a constant inertia, symmetric up to the rounding of its columns.
pub(crate) fn inverse_inertia<T: Real, L: DiscreteLagrangian<Scalar = T, Group = SO3<T>>>(
    lagrangian: &L,
) -> Matrix3<T> {
    let inertia = inertia(lagrangian, &lagrangian.advected());
    let column = |k: usize| Vector3::solve(&inertia, &Matrix3::identity().column(k).into_owned()).0;
    Matrix3::from_columns(&[column(0), column(1), column(2)])
}

/// A declared flow, and the inverse inertia for its initial guesses.
#[derive(Clone, Debug, Lanes)]
pub struct DeclaredDrift<L: DiscreteLagrangian<Group = SO3<T>, Scalar = T>, T: Real = crate::mechanics::Scalar<L>> {
    flow: DiscreteLiePoisson<L>,
    inverse: Matrix3<T>,
}
