//! Where a motion starts: attitude and velocity.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::Deserialize;

use super::quantity::{Angle, Number, Rate, Scalar, Triple};

/// The attitude, body to space, and the body velocity in rad/s.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "StartTable")]
pub(super) struct Start {
    pub(super) attitude: UnitQuaternion<f64>,
    pub(super) velocity: Vector3<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StartTable {
    /// Precession, nutation and spin: the attitude `R_z(φ) R_x(θ) R_z(ψ)`.
    euler: Option<Triple<Angle>>,
    /// `[w, x, y, z]`, brought to length one.
    quaternion: Option<Vec<Scalar<Number>>>,
    /// Body frame.
    velocity: Option<Triple<Rate>>,
    /// Rates of the Euler angles.
    euler_rates: Option<Triple<Rate>>,
}

impl TryFrom<StartTable> for Start {
    type Error = String;

    fn try_from(table: StartTable) -> Result<Self, String> {
        let attitude = match (&table.euler, &table.quaternion) {
            (Some(angles), None) => from_euler(&angles.value),
            (None, Some(components)) => from_components(components)?,
            _ => return Err("an attitude is given by either `euler` or `quaternion`".to_owned()),
        };
        let velocity = match (table.velocity, table.euler_rates, table.euler) {
            (Some(velocity), None, _) => velocity.value,
            (None, Some(rates), Some(angles)) => body_velocity(&angles.value, &rates.value),
            (None, Some(_), None) => return Err("`euler_rates` need the attitude by `euler`".to_owned()),
            _ => return Err("a velocity is given by either `velocity` or `euler_rates`".to_owned()),
        };
        Ok(Self { attitude, velocity })
    }
}

fn from_euler(angles: &Vector3<f64>) -> UnitQuaternion<f64> {
    let about_z = |angle| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
    about_z(angles.x) * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), angles.y) * about_z(angles.z)
}

fn from_components(components: &[Scalar<Number>]) -> Result<UnitQuaternion<f64>, String> {
    let [w, x, y, z] = components else {
        return Err(format!("`quaternion` has the four components w, x, y, z, found {}", components.len()));
    };
    let quaternion = Quaternion::new(w.value, x.value, y.value, z.value);
    UnitQuaternion::try_new(quaternion, f64::MIN_POSITIVE).ok_or_else(|| "`quaternion` can't be zero".to_owned())
}

/// `Ω = (RᵀR')^∨` of `R = R_z(φ) R_x(θ) R_z(ψ)`.
fn body_velocity(angles: &Vector3<f64>, rates: &Vector3<f64>) -> Vector3<f64> {
    let ((sin_tilt, cos_tilt), (sin_spin, cos_spin)) = (angles.y.sin_cos(), angles.z.sin_cos());
    let along_nodes = Vector3::new(cos_spin, -sin_spin, 0.0);
    let vertical = Vector3::new(sin_tilt * sin_spin, sin_tilt * cos_spin, cos_tilt);
    vertical * rates.x + along_nodes * rates.y + Vector3::z() * rates.z
}
