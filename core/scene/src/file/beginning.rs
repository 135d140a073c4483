//! The start of a motion on any group: attitude and velocity of each factor.

use liestep::motion::{AnyState, AnyStepper, Factor, FactorKind};
use liestep::{SO3, SetupError};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use serde::de::IgnoredAny;
use serde::{Deserialize, Deserializer};
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use crate::file::group::Group;
use crate::file::kepler::Orbit;
use crate::file::mistake::{SpanMessage, advised};
use crate::file::parameter::{in_value, list, matrix};
use crate::file::quantity::{Angle, Scalar};
use crate::file::start::{Start, in_space, orbit_of};

/// The initial attitude, as the matrices of the factors row by row, and the velocity or the momentum, body frame.
#[derive(Clone, Default)]
pub(crate) struct Beginning {
    pub(crate) attitude: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
    /// Whether the momentum is in the place of the velocity.
    pub(crate) is_by_momentum: bool,
    /// Whether the start is relative to the local vertical in the file; here it is in space.
    pub(crate) is_relative: bool,
}

/// Nothing: the table is read when the group is known.
impl<'de> Deserialize<'de> for Beginning {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        IgnoredAny::deserialize(source).map(|_| Self::default())
    }
}

type Value<'a> = Spanned<DeValue<'a>>;

const ROTATIONS: [&str; 4] = ["euler", "quaternion", "yaw_pitch_roll", "rpy"];
/// The keys of the start of a rotation.
const TURNED: [&str; 9] =
    ["euler", "quaternion", "yaw_pitch_roll", "rpy", "attitude", "velocity", "euler_rates", "momentum", RELATIVE];
/// The key of the frame that a start is relative to.
const RELATIVE: &str = "relative_to";
const ONE_VELOCITY: &str = "a start has one of `velocity` and `momentum`";

impl Beginning {
    /// The start of a table `start` on a group.
    pub(crate) fn read(value: &Value<'_>, group: &Group, orbit: Option<&Orbit>) -> Result<Self, SpanMessage> {
        let Some(table) = value.get_ref().as_table() else {
            return Err((value.span(), "`start` is a table".to_owned()));
        };
        if group.increments.is_empty() {
            let place = Place { table, value, factor: &group.factors[0], group: &group.groups[0] };
            return match table.get(RELATIVE).filter(|_| group.is_rotation()) {
                Some(frame) => place.relative(frame, orbit),
                None => place.start(),
            };
        }
        if let Some((key, _)) = table.iter().find(|(key, _)| !group.increments.iter().any(|own| own == key.get_ref())) {
            return Err((key.span(), unknown(key.get_ref(), group.increments.iter().map(String::as_str))));
        }
        let mut all = Self::default();
        for ((name, factor), of) in group.increments.iter().zip(&group.factors).zip(&group.groups) {
            let Some(value) = table.get(name.as_str()) else {
                return Err((
                    value.span(),
                    format!("missing field `{name}`: each factor has a start, as `{name} = {{ velocity = … }}`"),
                ));
            };
            let Some(table) = value.get_ref().as_table() else {
                return Err((value.span(), format!("`{name}` is a table with the start of this factor")));
            };
            let own = Place { table, value, factor, group: of }.start()?;
            if !all.velocity.is_empty() && own.is_by_momentum != all.is_by_momentum {
                return Err((value.span(), "all factors start by a `velocity`, or all by a `momentum`".to_owned()));
            }
            all.attitude.extend(own.attitude);
            all.velocity.extend(own.velocity);
            all.is_by_momentum = own.is_by_momentum;
        }
        Ok(all)
    }

    /// Whether the velocity is that of the file.
    pub(crate) const fn is_in_space(&self) -> bool {
        !self.is_by_momentum && !self.is_relative
    }

    /// The state of a stepper at this start.
    pub(crate) fn state(&self, stepper: &AnyStepper) -> Result<AnyState, SetupError> {
        if self.is_by_momentum {
            stepper.start_with_momentum(&self.attitude, &self.velocity)
        } else {
            stepper.start(&self.attitude, &self.velocity)
        }
    }

    /// The attitude on SO(3).
    pub(crate) fn rotation(&self) -> SO3 {
        let is_one = self.attitude.len() == 9;
        SO3::from_matrix_unchecked(if is_one { Matrix3::from_row_slice(&self.attitude) } else { Matrix3::identity() })
    }

    /// The angular velocity on SO(3), rad/s; none if the momentum is given.
    pub(crate) fn rate(&self) -> Option<Vector3<f64>> {
        match self.velocity[..] {
            [x, y, z] if !self.is_by_momentum => Some(Vector3::new(x, y, z)),
            _ => None,
        }
    }
}

/// The message about a key that a table can't have.
fn unknown<'n>(key: &str, known: impl Iterator<Item = &'n str>) -> String {
    let known: Vec<_> = known.map(|name| format!("`{name}`")).collect();
    advised(&format!("unknown field `{key}`, expected one of {}", known.join(", ")))
}

/// The table of a factor's start.
struct Place<'t, 'a> {
    table: &'t DeTable<'a>,
    value: &'t Value<'a>,
    factor: &'t Factor,
    /// The name of its group.
    group: &'t str,
}

impl Place<'_, '_> {
    /// The start of a body relative to the local vertical of an orbit at the time zero.
    fn relative(&self, frame: &Value<'_>, orbit: Option<&Orbit>) -> Result<Beginning, SpanMessage> {
        let orbit = orbit_of(frame.get_ref().as_str(), frame.span(), orbit)?;
        if let Some(momentum) = self.table.get("momentum") {
            let message = "a start relative to the local vertical has a `velocity`";
            return Err((momentum.span(), message.to_owned()));
        }
        let mut table = self.table.clone();
        table.remove(RELATIVE);
        let own = Place { table: &table, ..*self }.start()?;
        let velocity = Vector3::from_column_slice(&own.velocity);
        let (attitude, velocity) = in_space(orbit, own.rotation().as_matrix(), &velocity);
        let velocity = velocity.as_slice().to_vec();
        Ok(Beginning { attitude: by_rows(&attitude), velocity, is_by_momentum: false, is_relative: true })
    }

    fn start(&self) -> Result<Beginning, SpanMessage> {
        let is_rotation = self.factor.kind == FactorKind::Rotation;
        if is_rotation && self.table.get("attitude").is_none() {
            return self.turned();
        }
        let known: &[&str] = match (self.factor.kind, self.group) {
            (FactorKind::Translation(_), _) => &["position", "velocity", "momentum"],
            (_, "SE2") => &["attitude", "angle", "position", "velocity", "momentum"],
            (_, "SE3") => {
                &["attitude", "euler", "quaternion", "yaw_pitch_roll", "rpy", "position", "velocity", "momentum"]
            }
            _ => &["attitude", "velocity", "momentum"],
        };
        if let Some((key, _)) = self.table.iter().find(|(key, _)| !known.contains(&key.get_ref().as_ref())) {
            return Err((key.span(), unknown(key.get_ref(), known.iter().copied())));
        }
        let attitude = self.attitude()?;
        if is_rotation && Matrix3::from_row_slice(&attitude).determinant() <= 0.0 {
            let at = self.table.get("attitude").map_or_else(|| self.value.span(), Spanned::span);
            return Err((at, "`attitude` is no rotation: its determinant isn't above zero".to_owned()));
        }
        let length = self.factor.components.len();
        let (velocity, is_by_momentum) = match (self.table.get("velocity"), self.table.get("momentum")) {
            (Some(velocity), None) => (list(velocity, "`velocity`", length)?, false),
            (None, Some(momentum)) => (list(momentum, "`momentum`", length)?, true),
            (None, None) => return Err((self.value.span(), ONE_VELOCITY.to_owned())),
            (Some(_), Some(momentum)) => return Err((momentum.span(), ONE_VELOCITY.to_owned())),
        };
        Ok(Beginning { attitude, velocity, is_by_momentum, is_relative: false })
    }

    /// The start of a body that turns.
    fn turned(&self) -> Result<Beginning, SpanMessage> {
        if let Some((key, _)) = self.table.iter().find(|(key, _)| !TURNED.contains(&key.get_ref().as_ref())) {
            return Err((key.span(), unknown(key.get_ref(), TURNED.into_iter())));
        }
        let momentum = self.table.get("momentum");
        let mut table = self.table.clone();
        if let Some(momentum) = momentum {
            if ["velocity", "euler_rates"].iter().any(|key| table.contains_key(*key)) {
                return Err((momentum.span(), ONE_VELOCITY.to_owned()));
            }
            table.remove("momentum");
        }
        let Start { attitude, velocity } = self.read(table, momentum.is_some())?;
        let velocity = match momentum {
            Some(momentum) => list(momentum, "`momentum`", 3)?,
            None => velocity.as_slice().to_vec(),
        };
        let attitude = by_rows(SO3::from(attitude).as_matrix());
        Ok(Beginning { attitude, velocity, is_by_momentum: momentum.is_some(), is_relative: false })
    }

    /// The start of a rotation in a table, to which a velocity of zero may be added.
    fn read(&self, mut table: DeTable<'_>, at_rest: bool) -> Result<Start, SpanMessage> {
        if at_rest && let Ok(zero) = DeValue::parse("[0, 0, 0]") {
            let key = Spanned::new(self.value.span(), "velocity".into());
            table.insert(key, Spanned::new(self.value.span(), zero.into_inner()));
        }
        let table = Spanned::new(self.value.span(), DeValue::Table(table));
        Start::deserialize(ValueDeserializer::from(table)).map_err(|error| in_value(self.value, &error))
    }

    /// The entries of the attitude, the identity by default.
    fn attitude(&self) -> Result<Vec<f64>, SpanMessage> {
        let rows = self.factor.kind.rows();
        let parts = ["angle", "position"].into_iter().chain(ROTATIONS);
        let mut parts = parts.filter_map(|key| self.table.get(key));
        if let Some(attitude) = self.table.get("attitude") {
            return match parts.next() {
                Some(part) => Err((part.span(), "an attitude is given by its matrix, or by its parts".to_owned())),
                None => matrix(attitude, "`attitude`", rows),
            };
        }
        let mut entries: Vec<f64> = (0..rows * rows).map(|at| f64::from(u8::from(at / rows == at % rows))).collect();
        if let Some(angle) = self.table.get("angle") {
            let read = Scalar::<Angle>::deserialize(ValueDeserializer::from(angle.clone()));
            let (sine, cosine) = read.map_err(|error| in_value(angle, &error))?.value.sin_cos();
            (entries[0], entries[1], entries[3], entries[4]) = (cosine, -sine, sine, cosine);
        }
        if ROTATIONS.iter().any(|key| self.table.contains_key(*key)) {
            let mut table = self.table.clone();
            for key in ["position", "velocity", "momentum"] {
                table.remove(key);
            }
            let attitude: UnitQuaternion<f64> = self.read(table, true)?.attitude;
            for (at, entry) in by_rows(SO3::from(attitude).as_matrix()).into_iter().enumerate() {
                entries[at / 3 * rows + at % 3] = entry;
            }
        }
        if let Some(position) = self.table.get("position") {
            for (row, coordinate) in list(position, "`position`", rows - 1)?.into_iter().enumerate() {
                entries[row * rows + rows - 1] = coordinate;
            }
        }
        Ok(entries)
    }
}

/// The entries of a matrix, row by row.
fn by_rows(matrix: &Matrix3<f64>) -> Vec<f64> {
    matrix.transpose().as_slice().to_vec()
}
