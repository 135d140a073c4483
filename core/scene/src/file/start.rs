//! The start of a motion: attitude and velocity.

use std::fmt;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::Deserialize;
use serde::de::{Deserializer, Error, MapAccess, Visitor};

use crate::file::key::refuse;
use crate::file::quantity::{Angle, Number, Rate, Scalar, Triple};

/// The initial attitude, body to space, and the angular velocity, body frame, rad/s.
#[derive(Clone, Copy)]
pub(crate) struct Start {
    pub(crate) attitude: UnitQuaternion<f64>,
    pub(crate) velocity: Vector3<f64>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(field_identifier, rename_all = "snake_case")]
enum Key {
    /// Precession, nutation and spin: the attitude `R_z(φ) R_x(θ) R_z(ψ)`.
    Euler,
    /// Components `[w, x, y, z]`, or a table of them; normalised.
    Quaternion,
    /// `R_z(yaw) R_y(pitch) R_x(roll)`.
    YawPitchRoll,
    /// Roll, pitch and yaw of `R_z(yaw) R_y(pitch) R_x(roll)`.
    Rpy,
    /// Angular velocity, body frame.
    Velocity,
    /// Rates of the Euler angles.
    EulerRates,
}

/// An attitude, body to space.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "AttitudeTable")]
pub(crate) enum Attitude {
    Euler(Vector3<f64>),
    /// An attitude by a quaternion, or by yaw, pitch and roll.
    Other(UnitQuaternion<f64>),
}

impl Attitude {
    pub(crate) fn rotation(&self) -> UnitQuaternion<f64> {
        match self {
            Self::Euler(angles) => from_euler(angles),
            Self::Other(attitude) => *attitude,
        }
    }

    /// The attitude `R_z(yaw) R_y(pitch) R_x(roll)`.
    fn by_yaw_pitch_roll(angles: &Vector3<f64>) -> Self {
        // The constructor takes the angles about x, y and z.
        Self::Other(UnitQuaternion::from_euler_angles(angles.z, angles.y, angles.x))
    }
}

/// The keys of an attitude alone.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AttitudeTable {
    euler: Option<Triple<Angle>>,
    quaternion: Option<Components>,
    yaw_pitch_roll: Option<Triple<Angle>>,
    rpy: Option<Triple<Angle>>,
}

impl TryFrom<AttitudeTable> for Attitude {
    type Error = &'static str;

    fn try_from(table: AttitudeTable) -> Result<Self, Self::Error> {
        match (table.euler, table.quaternion, table.yaw_pitch_roll, table.rpy) {
            (Some(angles), None, None, None) => Ok(Self::Euler(angles.value)),
            (None, Some(components), None, None) => Ok(Self::Other(components.0)),
            (None, None, Some(angles), None) => Ok(Self::by_yaw_pitch_roll(&angles.value)),
            (None, None, None, Some(angles)) => Ok(Self::by_yaw_pitch_roll(&reversed(&angles.value))),
            _ => Err(ATTITUDE),
        }
    }
}

fn reversed(angles: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(angles.z, angles.y, angles.x)
}

#[derive(Clone, Copy)]
enum Velocity {
    Body(Vector3<f64>),
    EulerRates(Vector3<f64>),
}

const ATTITUDE: &str = "an attitude is given by one of `euler`, `quaternion`, `yaw_pitch_roll`, `rpy`";
const VELOCITY: &str = "a velocity is given by either `velocity` or `euler_rates`";
const RATES: &str = "`euler_rates` need the attitude by `euler`";

impl<'de> Deserialize<'de> for Start {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        source.deserialize_map(StartTable)
    }
}

struct StartTable;

/// Written by hand, so that conflicting keys are refused at their place.
impl<'de> Visitor<'de> for StartTable {
    type Value = Start;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table with an attitude and a velocity")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut table: M) -> Result<Start, M::Error> {
        let (mut attitude, mut velocity) = (None, None);
        while let Some(key) = table.next_key()? {
            match (key, attitude, velocity) {
                (Key::Euler | Key::Quaternion | Key::YawPitchRoll | Key::Rpy, Some(_), _) => {
                    return refuse(&mut table, ATTITUDE);
                }
                (Key::Velocity | Key::EulerRates, _, Some(_)) => return refuse(&mut table, VELOCITY),
                (Key::Quaternion | Key::YawPitchRoll | Key::Rpy, _, Some(Velocity::EulerRates(_)))
                | (Key::EulerRates, Some(Attitude::Other(_)), _) => return refuse(&mut table, RATES),
                (Key::Euler, ..) => attitude = Some(Attitude::Euler(table.next_value::<Triple<Angle>>()?.value)),
                (Key::Quaternion, ..) => attitude = Some(Attitude::Other(table.next_value::<Components>()?.0)),
                (Key::YawPitchRoll, ..) => {
                    attitude = Some(Attitude::by_yaw_pitch_roll(&table.next_value::<Triple<Angle>>()?.value));
                }
                (Key::Rpy, ..) => {
                    let angles = reversed(&table.next_value::<Triple<Angle>>()?.value);
                    attitude = Some(Attitude::by_yaw_pitch_roll(&angles));
                }
                (Key::Velocity, ..) => velocity = Some(Velocity::Body(table.next_value::<Triple<Rate>>()?.value)),
                (Key::EulerRates, ..) => {
                    velocity = Some(Velocity::EulerRates(table.next_value::<Triple<Rate>>()?.value));
                }
            }
        }
        let attitude = attitude.ok_or_else(|| M::Error::custom(ATTITUDE))?;
        let velocity = match (velocity.ok_or_else(|| M::Error::custom(VELOCITY))?, attitude) {
            (Velocity::Body(velocity), _) => velocity,
            (Velocity::EulerRates(rates), Attitude::Euler(angles)) => body_velocity(&angles, &rates),
            (Velocity::EulerRates(_), Attitude::Other(_)) => return Err(M::Error::custom(RATES)),
        };
        Ok(Start { attitude: attitude.rotation(), velocity })
    }
}

/// A quaternion of any length.
#[derive(Deserialize)]
#[serde(try_from = "QuaternionValue")]
struct Components(UnitQuaternion<f64>);

/// Components in the order w, x, y, z, or by their names.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "a quaternion is `[w, x, y, z]` or `{ w = …, x = …, y = …, z = … }`, four finite numbers"
)]
enum QuaternionValue {
    List(Vec<Scalar<Number>>),
    Table(ComponentTable),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ComponentTable {
    w: Scalar<Number>,
    x: Scalar<Number>,
    y: Scalar<Number>,
    z: Scalar<Number>,
}

/// The identity of programs that write the scalar part last; here it is half a turn.
const SCALAR_LAST: &str = "`quaternion` begins with w, so this is half a turn about z: write [1, 0, 0, 0] for no turn, \
                           or { w = 0, x = 0, y = 0, z = 1 } for that one";

impl TryFrom<QuaternionValue> for Components {
    type Error = String;

    fn try_from(value: QuaternionValue) -> Result<Self, String> {
        let [w, x, y, z] = match value {
            QuaternionValue::List(components) => match components.as_slice() {
                [w, x, y, z] if [w, x, y].iter().all(|part| part.value == 0.0) && z.value != 0.0 => {
                    return Err(SCALAR_LAST.to_owned());
                }
                &[w, x, y, z] => [w, x, y, z],
                other => {
                    return Err(format!("`quaternion` has the four components w, x, y, z, found {}", other.len()));
                }
            },
            QuaternionValue::Table(ComponentTable { w, x, y, z }) => [w, x, y, z],
        };
        // Divided by the largest component first, as squares may overflow or underflow.
        let quaternion = Quaternion::new(w.value, x.value, y.value, z.value);
        let scaled = quaternion / quaternion.coords.amax();
        let unit = UnitQuaternion::try_new(scaled, 0.5).filter(|unit| unit.coords.iter().all(|x| x.is_finite()));
        unit.map(Self).ok_or_else(|| "`quaternion` can't be zero".to_owned())
    }
}

fn from_euler(angles: &Vector3<f64>) -> UnitQuaternion<f64> {
    let about_z = |angle| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
    about_z(angles.x) * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), angles.y) * about_z(angles.z)
}

/// The angular velocity `Ω = (RᵀR')^∨` of `R = R_z(φ) R_x(θ) R_z(ψ)`.
fn body_velocity(angles: &Vector3<f64>, rates: &Vector3<f64>) -> Vector3<f64> {
    let ((sin_tilt, cos_tilt), (sin_spin, cos_spin)) = (angles.y.sin_cos(), angles.z.sin_cos());
    let along_nodes = Vector3::new(cos_spin, -sin_spin, 0.0);
    let vertical = Vector3::new(sin_tilt * sin_spin, sin_tilt * cos_spin, cos_tilt);
    vertical * rates.x + along_nodes * rates.y + Vector3::z() * rates.z
}
