//! Bodies that move as directions: on the sphere S² = SO(3)/SO(2).

use nalgebra::{Matrix3, Quaternion, RealField, UnitQuaternion, Vector3};

use super::inertia::{InertiaError, NonstandardInertia};
use crate::error::SetupError;
use crate::groups::SO3;
use crate::numbers::{Real, is_finite, real, reported};

/// The tolerance for numbers printed to a dozen digits; in scalars with fewer digits, for rounding.
fn printed<T: RealField + Copy + Real>() -> T {
    (T::default_epsilon() * real(64.0)).max(real(2e-12))
}

impl<T: RealField + Copy> NonstandardInertia<T> {
    /// The inertia of a mass `m`, in kg, at the end `l` of a thin massless rod, about the rod's other end; `l` is in
    /// the body's frame, in m.
    ///
    /// The moment across the rod is `m |l|²`. A uniform rod of length `l` has that of a third of its mass at its end. A
    /// thin rod has no moment about its own axis, and a spin would have no momentum. Here that moment is a quarter of
    /// the other. Motions that [start without spin](Self::pointing) don't depend on it.
    ///
    /// # Errors
    ///
    /// [`InertiaError::NotPositive`] for a mass or a length that isn't positive, [`InertiaError::NotFinite`], and
    /// [`InertiaError::OutOfRange`].
    pub fn of_rod(m: T, l: &Vector3<T>) -> Result<Self, InertiaError> {
        for (what, value) in [("m", m), ("length of l", l.norm())] {
            if !is_finite(value) {
                return Err(InertiaError::NotFinite);
            }
            if value <= T::zero() {
                return Err(InertiaError::NotPositive { what, value: reported(value) });
            }
        }
        // `J_d` is m|l|²/8 in both directions across the rod, and 7m|l|²/8 along it; then J = tr(J_d) I − J_d is m|l|²
        // across and m|l|²/4 along it.
        let across = Matrix3::from_diagonal_element(l.norm_squared());
        Self::new((across + l * l.transpose() * real::<T>(6.0)) * (m * real(0.125)))
    }
}

impl<T: RealField + Copy + Real> NonstandardInertia<T> {
    /// The attitude and the body velocity, in rad/s, of a body symmetric about `axis` that points to `direction` and
    /// doesn't spin.
    ///
    /// `axis` is a unit vector of the body, and `direction` one of space, `q`, which moves by `q̇ = ω × q` with the
    /// velocity `ω ⟂ q` in space, in rad/s. Among the attitudes with that direction, the result is the shortest turn of
    /// the axis to it.
    ///
    /// A motion that starts so is a motion on the sphere S² of directions. If the scene is symmetric about the axis,
    /// too, with centres of mass, joints and springs on it, there is no torque about it: `Π·axis` stays zero, and in
    /// exact arithmetic steps don't depend on the moment about it. This holds for one body, and for each body of a
    /// product or of a system.
    ///
    /// # Errors
    ///
    /// [`SetupError::NotUnit`] if `axis` or `direction` isn't of length one, [`SetupError::NotAxisymmetric`] if the
    /// body isn't symmetric about the axis, [`SetupError::Spin`] if `ω` isn't at right angles to the direction, and
    /// [`SetupError::NonFinite`].
    ///
    /// # Examples
    ///
    /// A conical pendulum's direction rotates about the vertical at `ω² = g/(l cos θ)`.
    ///
    /// ```
    /// use liestep::effects::{Gravity, RigidBody};
    /// use liestep::{NonstandardInertia, Stepper};
    /// use nalgebra::Vector3;
    ///
    /// let (l, down) = (0.5, -Vector3::z());
    /// let J_d = NonstandardInertia::of_rod(1.0, &(down * l))?;
    /// let gravity = Gravity { m: 1.0, g: 9.81, rho: down * l, up: Vector3::z() };
    /// let stepper = Stepper::new(RigidBody { J_d } + gravity, 1e-3)?;
    ///
    /// let q = Vector3::new(0.6, 0.0, -0.8);
    /// let rate: f64 = (9.81_f64 / (l * 0.8)).sqrt();
    /// // q̇ = rate e₃ × q = ω × q with ω ⟂ q.
    /// let omega = q.cross(&(Vector3::z() * rate).cross(&q));
    /// let (attitude, velocity) = J_d.pointing(&down, &q, &omega)?;
    /// let mut state = stepper.start(attitude, velocity)?;
    /// stepper.run(&mut state, 1000)?;
    /// let expected = Vector3::new(0.6 * rate.cos(), 0.6 * rate.sin(), -0.8);
    /// assert!((state.attitude().as_matrix() * down - expected).norm() < 1e-4);
    /// assert!(state.momentum().dot(&down).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn pointing(
        &self,
        axis: &Vector3<T>,
        direction: &Vector3<T>,
        velocity: &Vector3<T>,
    ) -> Result<(SO3<T>, Vector3<T>), SetupError> {
        let (axis, direction) = (unit("axis", axis)?, unit("direction", direction)?);
        self.check_symmetry(&axis)?;
        check_finite("velocity", velocity)?;
        let spin = velocity.dot(&direction);
        if spin.abs() > velocity.norm() * printed::<T>() {
            return Err(SetupError::Spin { spin: reported(spin) });
        }
        let attitude = shortest_turn(&axis, &direction);
        let turning = attitude.inverse_transform_vector(velocity);
        Ok((SO3::from(attitude), turning - axis * axis.dot(&turning)))
    }

    /// Checks that the inertia has the form `J_d = a I + (b − a) e eᵀ`.
    fn check_symmetry(&self, axis: &Vector3<T>) -> Result<(), SetupError> {
        let inertia = self.as_matrix();
        let along = axis.dot(&(inertia * axis));
        let across = (inertia.trace() - along) * real(0.5);
        let symmetric = Matrix3::from_diagonal_element(across) + axis * axis.transpose() * (along - across);
        let difference = (inertia - symmetric).amax();
        if difference > inertia.amax() * printed::<T>() {
            return Err(SetupError::NotAxisymmetric { difference: reported(difference) });
        }
        Ok(())
    }
}

fn check_finite<T: RealField + Copy>(what: &'static str, vector: &Vector3<T>) -> Result<(), SetupError> {
    if vector.iter().all(|&entry| is_finite(entry)) { Ok(()) } else { Err(SetupError::NonFinite { what }) }
}

/// The vector normalised, if its length is one to the digits of a printed number.
fn unit<T: RealField + Copy + Real>(what: &'static str, vector: &Vector3<T>) -> Result<Vector3<T>, SetupError> {
    check_finite(what, vector)?;
    let length = vector.norm();
    if (length - T::one()).abs() > printed::<T>() {
        return Err(SetupError::NotUnit { what, length: reported(length) });
    }
    Ok(vector / length)
}

/// The shortest rotation of one unit vector to another; for opposite ones half a turn about any perpendicular axis.
fn shortest_turn<T: RealField + Copy>(from: &Vector3<T>, to: &Vector3<T>) -> UnitQuaternion<T> {
    let cosine = from.dot(to);
    if cosine >= T::zero() {
        return UnitQuaternion::from_quaternion(Quaternion::from_parts(T::one() + cosine, from.cross(to)));
    }
    // Near the opposite direction the axis is perpendicular to the small sum, whose error is only along `from`.
    let sum = from + to;
    let beside = (sum - from * from.dot(&sum)).try_normalize(T::default_epsilon());
    let beside = beside.unwrap_or_else(|| from.cross(&Vector3::ith(from.iamin(), T::one())).normalize());
    UnitQuaternion::from_quaternion(Quaternion::from_parts(sum.norm(), from.cross(&beside) * (from - to).norm()))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use crate::error::SetupError;
    use crate::groups::{LieGroup as _, SO3};
    use crate::laws::samples::Random;
    use crate::mechanics::{InertiaError, NonstandardInertia};

    #[test]
    fn a_rod_has_its_moment_across_and_is_symmetric() {
        let along = Vector3::new(0.3, -0.4, 1.2);
        let rod = NonstandardInertia::of_rod(2.0, &along).unwrap();
        let moment = 2.0 * along.norm_squared();
        let moments = rod.principal_moments();
        assert!((moments - Vector3::new(0.25 * moment, moment, moment)).amax() < 1e-14 * moment);
        let about = rod.to_inertia().as_matrix() * along;
        assert!((about - along * (0.25 * moment)).amax() < 1e-14 * moment);
        for m in [0.0, -1.0] {
            let refused = Err(InertiaError::NotPositive { what: "m", value: m });
            assert_eq!(NonstandardInertia::of_rod(m, &along), refused);
        }
        let refused = Err(InertiaError::NotPositive { what: "length of l", value: 0.0 });
        assert_eq!(NonstandardInertia::of_rod(1.0, &Vector3::zeros()), refused);
        assert!(matches!(NonstandardInertia::of_rod(f64::NAN, &along), Err(InertiaError::NotFinite)));
    }

    /// Directions in general position, the opposite one, and some near it.
    #[test]
    fn a_body_points_where_it_is_to() {
        let mut random = Random::new(4);
        let axis = Vector3::new(2.0, -1.0, 2.0) / 3.0;
        let rod = NonstandardInertia::of_rod(1.5, &axis).unwrap();
        let mut directions = [axis, -axis, -axis, -axis, axis, axis];
        for (k, direction) in directions.iter_mut().enumerate().skip(2) {
            let away: Vector3<f64> = random.sample();
            *direction = (*direction + away * [0.0, 0.0, 1e-9, 0.1, 0.7, 3.0][k]).normalize();
        }
        for direction in directions {
            let omega = direction.cross(&random.sample());
            let (attitude, velocity) = rod.pointing(&axis, &direction, &omega).unwrap();
            let r = attitude.as_matrix();
            assert!(attitude.defect() < 1e-15 * 8.0 && r.determinant() > 0.0);
            assert!((r * axis - direction).amax() < 1e-15 && (r * velocity - omega).amax() < 1e-15 * 8.0);
            assert!(velocity.dot(&axis).abs() < 1e-16 * 8.0);
            // The axis of the shortest turn is perpendicular to both directions.
            assert!((r.trace() - 1.0 - 2.0 * axis.dot(&direction)).abs() < 1e-15 * 8.0);
        }
        let (attitude, _) = rod.pointing(&axis, &axis, &Vector3::zeros()).unwrap();
        assert!((attitude.as_matrix() - SO3::<f64>::identity().as_matrix()).amax() < 1e-15);
    }

    #[test]
    fn what_is_no_direction_is_refused() {
        let (x, z) = (Vector3::x(), Vector3::z());
        let rod = NonstandardInertia::of_rod(1.0, &z).unwrap();
        let refused = |axis, direction, velocity| rod.pointing(&axis, &direction, &velocity).unwrap_err();
        let zero = Vector3::zeros();
        assert_eq!(refused(z, zero, zero), SetupError::NotUnit { what: "direction", length: 0.0 });
        assert_eq!(refused(z, x * 2.0, zero), SetupError::NotUnit { what: "direction", length: 2.0 });
        assert_eq!(refused(z * 0.5, x, zero), SetupError::NotUnit { what: "axis", length: 0.5 });
        assert_eq!(refused(z, x * f64::NAN, zero), SetupError::NonFinite { what: "direction" });
        assert_eq!(refused(z, x, z * f64::INFINITY), SetupError::NonFinite { what: "velocity" });
        assert_eq!(refused(z, x, x * 0.5 + z), SetupError::Spin { spin: 0.5 });
        assert!(matches!(refused(x, z, zero), SetupError::NotAxisymmetric { difference } if difference > 0.1));
        // The error of a dozen printed digits is accepted.
        let printed = Vector3::new(0.577_350_269_190, 0.577_350_269_190, 0.577_350_269_190);
        let across = Vector3::new(1.0, -0.5, -0.500_000_000_000_1);
        let (_, velocity) = rod.pointing(&z, &printed, &across).unwrap();
        assert!(velocity.z == 0.0);
    }

    /// In single precision rounding is accepted, and an error of a thousandth isn't.
    #[test]
    fn directions_of_single_precision() {
        let rod = NonstandardInertia::of_rod(1.0_f32, &Vector3::z()).unwrap();
        let (direction, still) = (Vector3::new(1.0_f32, 2.0, -0.3).normalize(), Vector3::zeros());
        assert!(rod.pointing(&Vector3::z(), &direction, &still).is_ok());
        let refused = rod.pointing(&Vector3::z(), &(direction * 1.001), &still);
        assert!(matches!(refused, Err(SetupError::NotUnit { what: "direction", .. })));
    }
}
