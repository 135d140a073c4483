//! The start of a motion: attitude and velocity.

use std::fmt;
use std::ops::Range;

use liestep::SO3;
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};
use serde::Deserialize;
use serde::de::{Deserializer, Error, MapAccess, Visitor};
use toml::Spanned;

use crate::file::euler::{Angles, Sequence};
use crate::file::kepler::Orbit;
use crate::file::key::refuse;
use crate::file::mistake::SpanMessage;
use crate::file::quantity::{Angle, Number, Rate, Scalar, Triple};

/// The initial attitude, body to space, and the angular velocity, body frame, rad/s.
#[derive(Clone, Copy)]
pub(crate) struct Start {
    pub(crate) attitude: UnitQuaternion<f64>,
    pub(crate) velocity: Vector3<f64>,
}

/// A start whose axes may be those of the local vertical.
pub(crate) struct FramedStart {
    own: Start,
    frame: Option<Spanned<String>>,
}

impl FramedStart {
    /// The start in space at the time zero, with the orbit of the file, if it has one.
    pub(crate) fn in_space(self, orbit: Option<&Orbit>) -> Result<Start, SpanMessage> {
        let Self { own, frame: Some(frame) } = self else { return Ok(self.own) };
        let orbit = orbit_of(Some(frame.get_ref()), frame.span(), orbit)?;
        let (attitude, velocity) = in_space(orbit, SO3::from(own.attitude).as_matrix(), &own.velocity);
        let attitude = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(attitude));
        Ok(Start { attitude, velocity })
    }
}

/// The orbit of the frame that a start is relative to.
pub(crate) fn orbit_of<'o>(
    frame: Option<&str>,
    span: Range<usize>,
    orbit: Option<&'o Orbit>,
) -> Result<&'o Orbit, SpanMessage> {
    if frame != Some("local vertical") {
        return Err((span, "a start is relative to space, or to the \"local vertical\"".to_owned()));
    }
    orbit
        .ok_or_else(|| (span, "the local vertical is that of an orbit, and the file has no table `[orbit]`".to_owned()))
}

/// Attitude and angular velocity, body frame, in space, of those relative to the local vertical at the time zero.
pub(crate) fn in_space(
    orbit: &Orbit,
    attitude: &Matrix3<f64>,
    velocity: &Vector3<f64>,
) -> (Matrix3<f64>, Vector3<f64>) {
    let attitude = orbit.local_vertical(0.0) * attitude;
    (attitude, velocity + attitude.tr_mul(&orbit.turning(0.0)))
}

#[derive(Clone, Copy, Deserialize)]
#[serde(field_identifier, rename_all = "snake_case")]
enum Key {
    /// Precession, nutation and spin: the attitude `R_z(φ) R_x(θ) R_z(ψ)`; or the angles of a sequence.
    Euler,
    /// Components `[w, x, y, z]`, or a table of them or of their list by its order; normalised.
    Quaternion,
    /// `R_z(yaw) R_y(pitch) R_x(roll)`.
    YawPitchRoll,
    /// Roll, pitch and yaw of `R_z(yaw) R_y(pitch) R_x(roll)`.
    Rpy,
    /// Angular velocity, body frame.
    Velocity,
    /// Rates of the Euler angles.
    EulerRates,
    /// The frame that attitude and velocity are relative to, instead of space.
    RelativeTo,
}

/// An attitude, body to space.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "AttitudeTable")]
pub(crate) enum Attitude {
    Euler(Angles),
    /// An attitude by a quaternion, or by yaw, pitch and roll.
    Other(UnitQuaternion<f64>),
}

impl Attitude {
    pub(crate) fn rotation(&self) -> UnitQuaternion<f64> {
        match self {
            Self::Euler(angles) => angles.attitude(),
            Self::Other(attitude) => *attitude,
        }
    }

    /// The attitude `R_z(yaw) R_y(pitch) R_x(roll)`.
    fn by_yaw_pitch_roll(angles: &Vector3<f64>) -> Self {
        Self::Other(Angles { sequence: Sequence::ZYX, angles: *angles }.attitude())
    }
}

/// The keys of an attitude alone.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AttitudeTable {
    euler: Option<Angles>,
    quaternion: Option<Components>,
    yaw_pitch_roll: Option<Triple<Angle>>,
    rpy: Option<Triple<Angle>>,
}

impl TryFrom<AttitudeTable> for Attitude {
    type Error = &'static str;

    fn try_from(table: AttitudeTable) -> Result<Self, Self::Error> {
        match (table.euler, table.quaternion, table.yaw_pitch_roll, table.rpy) {
            (Some(angles), None, None, None) => Ok(Self::Euler(angles)),
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
        match FramedStart::deserialize(source)? {
            FramedStart { own, frame: None } => Ok(own),
            FramedStart { .. } => Err(Error::custom("a factor starts relative to space: leave `relative_to` out")),
        }
    }
}

impl<'de> Deserialize<'de> for FramedStart {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        source.deserialize_map(StartTable)
    }
}

struct StartTable;

/// Written by hand, so that conflicting keys are refused at their place.
impl<'de> Visitor<'de> for StartTable {
    type Value = FramedStart;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table with an attitude and a velocity")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut table: M) -> Result<FramedStart, M::Error> {
        let (mut attitude, mut velocity, mut frame) = (None, None, None);
        while let Some(key) = table.next_key()? {
            match (key, attitude, velocity) {
                (Key::Euler | Key::Quaternion | Key::YawPitchRoll | Key::Rpy, Some(_), _) => {
                    return refuse(&mut table, ATTITUDE);
                }
                (Key::Velocity | Key::EulerRates, _, Some(_)) => return refuse(&mut table, VELOCITY),
                (Key::Quaternion | Key::YawPitchRoll | Key::Rpy, _, Some(Velocity::EulerRates(_)))
                | (Key::EulerRates, Some(Attitude::Other(_)), _) => return refuse(&mut table, RATES),
                (Key::Euler, ..) => attitude = Some(Attitude::Euler(table.next_value()?)),
                (Key::Quaternion, ..) => attitude = Some(Attitude::Other(table.next_value::<Components>()?.0)),
                (Key::YawPitchRoll, ..) => {
                    attitude = Some(Attitude::by_yaw_pitch_roll(&table.next_value::<Triple<Angle>>()?.value));
                }
                (Key::Rpy, ..) => {
                    let angles = reversed(&table.next_value::<Triple<Angle>>()?.value);
                    attitude = Some(Attitude::by_yaw_pitch_roll(&angles));
                }
                (Key::RelativeTo, ..) => frame = Some(table.next_value()?),
                (Key::Velocity, ..) => velocity = Some(Velocity::Body(table.next_value::<Triple<Rate>>()?.value)),
                (Key::EulerRates, ..) => {
                    velocity = Some(Velocity::EulerRates(table.next_value::<Triple<Rate>>()?.value));
                }
            }
        }
        let velocity = match (velocity.ok_or_else(|| M::Error::custom(VELOCITY))?, attitude) {
            (Velocity::Body(velocity), _) => velocity,
            (Velocity::EulerRates(rates), Some(Attitude::Euler(angles))) => angles.velocity(&rates),
            (Velocity::EulerRates(_), _) => return Err(M::Error::custom(RATES)),
        };
        // The axes of the body are those of space, or of the frame that the start is relative to.
        let attitude = attitude.map_or_else(UnitQuaternion::identity, |attitude| attitude.rotation());
        Ok(FramedStart { own: Start { attitude, velocity }, frame })
    }
}

/// A quaternion of any length.
#[derive(Deserialize)]
#[serde(try_from = "QuaternionValue")]
struct Components(UnitQuaternion<f64>);

/// Components in the order w, x, y, z, by their names, or in an order that is named.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "a quaternion is `[w, x, y, z]`, `{ w = …, x = …, y = …, z = … }` or `{ xyzw = […] }`, four finite numbers"
)]
enum QuaternionValue {
    List(Vec<Scalar<Number>>),
    Table(ComponentTable),
    Ordered(OrderedTable),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ComponentTable {
    w: Scalar<Number>,
    x: Scalar<Number>,
    y: Scalar<Number>,
    z: Scalar<Number>,
}

/// A list whose order is its key.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum OrderedTable {
    Wxyz([Scalar<Number>; 4]),
    Xyzw([Scalar<Number>; 4]),
}

/// The identity of programs that write the scalar part last; here it is half a turn.
const SCALAR_LAST: &str = "`quaternion` begins with w, so this is half a turn about z: write [1, 0, 0, 0] or \
                           { xyzw = [0, 0, 0, 1] } for no turn, and { w = 0, x = 0, y = 0, z = 1 } for that one";

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
            QuaternionValue::Table(ComponentTable { w, x, y, z })
            | QuaternionValue::Ordered(OrderedTable::Wxyz([w, x, y, z]) | OrderedTable::Xyzw([x, y, z, w])) => {
                [w, x, y, z]
            }
        };
        // Divided by the largest component first, as squares may overflow or underflow.
        let quaternion = Quaternion::new(w.value, x.value, y.value, z.value);
        let scaled = quaternion / quaternion.coords.amax();
        let unit = UnitQuaternion::try_new(scaled, 0.5).filter(|unit| unit.coords.iter().all(|x| x.is_finite()));
        unit.map(Self).ok_or_else(|| "`quaternion` can't be zero".to_owned())
    }
}
