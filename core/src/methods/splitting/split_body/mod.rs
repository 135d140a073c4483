//! The free motion of an asymmetric body as rotations about body axes: nothing to solve, and Poisson at any step.

mod rotor;

use nalgebra::{Matrix3, SimdBool as _, Vector3};

use self::rotor::Rotor;
use super::axes::Axes;
use super::kinetic_flow::{KineticFlow, Turn};
use super::quaternion::{Quaternion, scaled_increment};
use crate::error::{SetupError, StepError};
use crate::groups::rotation_coefficients;
use crate::groups::{LieGroup as _, SO3};
use crate::mechanics::{Inertia, Operations, SceneVisitor};
use crate::numbers::{Mask, Real, is_finite, real, reported};

/// The free motion of a body with three different moments, split into rotations about body axes; of order 4.
///
/// With `J_c` the middle moment,
///
/// ```text
/// ½ p·J⁻¹p = |p|²/(2 J_c) + (1/J_a − 1/J_c) p_a²/2 + (1/J_b − 1/J_c) p_b²/2
/// ```
///
/// The flow of the first term is `F = exp(h p/J_c)`, `p⁺ = p`; it commutes with the others and is made once. The flow
/// of each of the others is a rotation of the body about one of its axes, `F = exp(h (1/J_a − 1/J_c) p_a E_a)`,
/// `p⁺ = Fᵀp`, which doesn't change `p_a`. They are composed symmetrically, so that a drift is a Poisson map for any
/// step and keeps `R p`, that of `−h` undoes that of `h`, and there is no step it has no solution for. The energy isn't
/// exact, but has no drift.
///
/// # Rotations
///
/// There may be this many:
///
/// - `SplitBody::<7>`, of Forest and Ruth, is the cheapest to accuracies of four digits or so;
/// - `SplitBody::<9>` also is of order 6 in the smaller of the two coefficients, and pays for more digits than that and
///   for bodies that are nearly symmetric.
///
/// [`ExactBody`](crate::methods::ExactBody) takes less time than either, and has no error but rounding.
///
/// Of a symmetric body one term is zero, and the flow is that of [`SymmetricBody`](crate::methods::SymmetricBody), at a higher
/// price.
///
/// # Frame and units
///
/// Body axes, which must be the principal ones; the inertia in kg m², momenta in kg m²/s.
///
/// # Examples
///
/// ```
/// use liestep::mechanics::Inertia;
/// use liestep::methods::{KineticFlow as _, SplitBody};
/// use nalgebra::Vector3;
///
/// let inertia = Inertia::from_principal_moments(Vector3::new(1.6, 2.6, 3.0))?;
/// let body = SplitBody::<7>::new(&inertia)?;
/// let momentum = Vector3::new(1.0, -2.0, 3.0);
/// let turn = SplitBody::<7>::advance(&body.drift(0.1)?, &momentum)?;
/// // What the space sees of the momentum, F (p + Δp), hasn't changed.
/// let after = momentum + turn.change;
/// assert!((after + turn.increment * after - momentum).norm() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Source
///
/// \[TW94\], \[ML93\], \[Fa03\] for splittings of the free body; \[FR90\] for the seven rotations, \[ML95\] for the
/// order of the nine. See [`conventions`](crate::conventions).
#[derive(Clone, Copy, Debug, PartialEq, Lanes, InLanes)]
pub struct SplitBody<const ROTATIONS: usize, T = f64> {
    moments: Vector3<T>,
    #[shared]
    axes: Axes,
}

impl<const ROTATIONS: usize, T: Real> SplitBody<ROTATIONS, T> {
    /// The body with this inertia about the pivot. Any other number of rotations than 7 and 9 doesn't compile.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] where the body axes aren't the principal ones, and where lanes disagree about which
    /// axis has the middle moment and which of the others the moment that is farther from it.
    pub fn new(inertia: &Inertia<T>) -> Result<Self, SetupError> {
        const { assert!(ROTATIONS == 7 || ROTATIONS == 9, "a body is split into 7 or 9 rotations") };
        let refused = |cause| SetupError::Parameter { field: "inertia", cause };
        let j = inertia.as_matrix();
        let moments = j.diagonal();
        let allowed = j.trace() * T::simd_default_epsilon() * real(4.0);
        if !(j - Matrix3::from_diagonal(&moments)).iter().all(|entry| entry.simd_abs().simd_le(allowed).all()) {
            return Err(refused("is not along the principal axes"));
        }
        // Nine rotations begin with the term of the smaller coefficient, seven with the other.
        let fits = |axes: &Axes| {
            let [first, second] = coefficients(&moments, *axes);
            let (larger, smaller) = if ROTATIONS == 9 { (second, first) } else { (first, second) };
            let between = (first * second).simd_le(T::zero()).all();
            between && larger.simd_abs().simd_ge(smaller.simd_abs()).all()
        };
        let axes =
            Axes::ALL.into_iter().find(fits).ok_or(refused("has its moments in another order in other lanes"))?;
        Ok(Self { moments, axes })
    }
}

/// `J_c/J_a − 1` and `J_c/J_b − 1`, without cancellation.
fn coefficients<T: Real>(moments: &Vector3<T>, axes: Axes) -> [T; 2] {
    let [a, b, c] = axes.moments(moments);
    [(c - a) / a, (c - b) / b]
}

/// The flow over one share of the step.
#[derive(Clone, Copy, Debug, Lanes)]
pub struct SplitDrift<T> {
    #[shared]
    axes: Axes,
    /// `h/J_c`, which makes the momentum an angle.
    scale: T,
    /// Up to this square of that angle the rotors' polynomials do.
    reach: T,
    /// From the first to the middle one; of seven rotations that is the fourth.
    rotors: [Rotor<T>; 5],
}

impl<const ROTATIONS: usize, T: Real> KineticFlow<T> for SplitBody<ROTATIONS, T> {
    type Drift = SplitDrift<T>;

    // A rotation is 52, 23 of them for its sine and cosine; that about the momentum, the matrix of all and what it does
    // to the momentum are 91, and what the last rotation does to it, 16, isn't asked for.
    #[allow(clippy::cast_possible_truncation)] // seven or nine
    const OPERATIONS: Operations = Operations { step: 75 + 52 * ROTATIONS as u32, iteration: 0 };

    fn describe(flow: &Self, visitor: &mut dyn SceneVisitor<T>) {
        visitor.term(if ROTATIONS == 9 { "nine rotations" } else { "seven rotations" });
        flow.moments.iter().for_each(|&moment| visitor.parameter("moment", moment));
    }

    fn inertia(flow: &Self) -> Matrix3<T> {
        Matrix3::from_diagonal(&flow.moments)
    }

    fn drift(&self, h: T) -> Result<Self::Drift, SetupError> {
        let [_, _, middle] = self.axes.moments(&self.moments);
        let scale = h / middle;
        if !is_finite(scale) {
            return Err(SetupError::InvalidStep { step: reported(h) });
        }
        let half = coefficients(&self.moments, self.axes).map(|coefficient| coefficient * real(0.5));
        let shares = if ROTATIONS == 9 { rotor::NINE } else { rotor::SEVEN };
        let rotors: [Rotor<T>; 5] = core::array::from_fn(|k| Rotor::new(half[k % 2] * real(shares[k])));
        let reach = rotors.iter().map(Rotor::reach).fold(real(f64::INFINITY), nalgebra::SimdPartialOrd::simd_min);
        Ok(SplitDrift { axes: self.axes, scale, reach, rotors })
    }

    #[hot]
    fn advance(drift: &Self::Drift, momentum: &Vector3<T>) -> Result<Turn<T>, StepError> {
        let angles = drift.axes.of(&(momentum * drift.scale));
        let squared = (angles[0] * angles[0] + angles[1] * angles[1]) + angles[2] * angles[2];
        let near = squared.simd_le(drift.reach);
        let quaternion = if near.all() {
            rotated::<ROTATIONS, T>(drift, angles, squared, Rotor::near)
        } else {
            far::<ROTATIONS, T>(drift, angles, squared, near)
        };
        let increment = increment(drift.axes.back(quaternion));
        let change = SO3::adjoint_transpose_increment(&increment, momentum);
        Ok(Turn { increment, change, iterations: 0 })
    }
}

/// Where a rotation is too large for the polynomials in one lane at least; lanes in which none is take them all the
/// same.
#[cold]
#[inline(never)]
fn far<const ROTATIONS: usize, T: Real>(
    drift: &SplitDrift<T>,
    angles: [T; 3],
    squared: T,
    near: Mask<T>,
) -> Quaternion<T> {
    let far = rotated::<ROTATIONS, T>(drift, angles, squared, Rotor::anywhere);
    if !near.any() {
        return far;
    }
    let mut quaternion = rotated::<ROTATIONS, T>(drift, angles, squared, Rotor::near);
    for (near_one, far_one) in quaternion.iter_mut().zip(far) {
        *near_one = near_one.select(near, far_one);
    }
    quaternion
}

/// The product of all rotations, that about the momentum first, for the momentum `(a, b, c)` in units of `J_c/h`.
///
/// What takes the time is that each angle waits for the rotation before; the quaternion is multiplied meanwhile. That
/// is half of the arithmetic of products of matrices, and what roundings do to its length is divided out in the end.
#[hot]
fn rotated<const ROTATIONS: usize, T: Real>(
    drift: &SplitDrift<T>,
    [mut a, mut b, mut c]: [T; 3],
    squared: T,
    half: impl Fn(&Rotor<T>, T) -> (T, T),
) -> Quaternion<T> {
    let quarter = squared * real(0.25);
    let (sinc, versine) = rotation_coefficients(quarter);
    let sinc = sinc * real(0.5);
    let mut q = [T::one() - quarter * versine, sinc * a, sinc * b, sinc * c];
    let mut about = |axis: usize, rotor: &Rotor<T>| {
        if axis == 0 {
            let [w, x, y, z] = q;
            (b, c, [q[0], q[1], q[2], q[3]]) = turned([a, b, c], half(rotor, a * a), [w, x, y, z]);
        } else {
            let [w, x, y, z] = q;
            (c, a, [q[0], q[2], q[3], q[1]]) = turned([b, c, a], half(rotor, b * b), [w, y, z, x]);
        }
    };
    let [r0, r1, r2, r3, r4] = &drift.rotors;
    about(0, r0);
    about(1, r1);
    about(0, r2);
    about(1, r3);
    if ROTATIONS == 9 {
        about(0, r4);
        about(1, r3);
    }
    about(0, r2);
    about(1, r1);
    about(0, r0);
    q
}

/// What a rotation about the first of three axes makes of the other two components of the momentum and of the
/// quaternion, given the sine of half its angle over the first component, and the cosine.
#[hot]
fn turned<T: Real>([a, b, c]: [T; 3], (s, cosine): (T, T), [w, x, y, z]: Quaternion<T>) -> (T, T, Quaternion<T>) {
    let sine = s * a;
    let quaternion = [w * cosine - x * sine, x * cosine + w * sine, y * cosine + z * sine, z * cosine - y * sine];
    // Fᵀp − p with sin θ = 2 s a cos(θ/2) and 1 − cos θ = 2 s² a²; products without s and the cosine don't wait for
    // them.
    let twice = a + a;
    let square = twice * a;
    let of_b = s * (cosine * (twice * c) - s * (square * b));
    let of_c = s * (cosine * (twice * b) + s * (square * c));
    (b + of_b, c - of_c, quaternion)
}

/// `F − I` of a quaternion whose length is one to some roundings.
#[hot]
fn increment<T: Real>([w, x, y, z]: Quaternion<T>) -> Matrix3<T> {
    let (xx, yy, zz) = (x * x, y * y, z * z);
    // 1/(1 + ε), which the products beside it don't wait for.
    let factor = T::one() - (((w * w - T::one()) + xx) + (yy + zz));
    scaled_increment([w, x, y, z]) * factor
}

#[cfg(test)]
mod tests {
    use super::increment;

    /// A length that is off by roundings changes the rotation by its square.
    #[test]
    fn lengths_are_divided_out() {
        let exact = increment([0.6, 0.0, 0.48, 0.64]);
        let longer = increment([0.6, 0.0, 0.48, 0.64].map(|part: f64| part * (1.0 + 1e-9)));
        assert!((longer - exact).norm() < 1e-15);
        assert!((exact.transpose() * exact + exact + exact.transpose()).norm() < 1e-15);
    }
}
