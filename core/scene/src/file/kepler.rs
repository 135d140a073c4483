//! The orbit of a scene: the table `orbit`.

use std::ops::Deref;
use std::path::Path;

use liestep::with::Kepler;
use nalgebra::Vector3;
use serde::Deserialize;

use crate::file::mistake::Mistake;
use crate::file::quantity::{
    Angle, Direction, Duration, GravitationalParameter, Length, Number, PositiveScalar, Scalar, Speed, Triple,
};
use crate::file::tle::Lines;

/// An orbit as a file gives it.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "OrbitTable")]
pub(crate) struct Orbit(Kepler);

impl Deref for Orbit {
    type Target = Kepler;

    fn deref(&self) -> &Kepler {
        &self.0
    }
}

/// The keys of an orbit: a size, a plane and a place, or a position with a velocity, or two lines.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OrbitTable {
    period: Option<PositiveScalar<Duration>>,
    semi_major_axis: Option<PositiveScalar<Length>>,
    GM: Option<PositiveScalar<GravitationalParameter>>,
    eccentricity: Option<Scalar<Number>>,
    /// Axis of the motion, which is right-handed about it.
    normal: Option<Direction>,
    /// Direction of pericentre, projected across the normal.
    periapsis: Option<Direction>,
    inclination: Option<Scalar<Angle>>,
    ascending_node: Option<Scalar<Angle>>,
    argument_of_periapsis: Option<Scalar<Angle>>,
    phase: Option<Scalar<Angle>>,
    true_anomaly: Option<Scalar<Angle>>,
    position: Option<Triple<Length>>,
    velocity: Option<Triple<Speed>>,
    tle: Option<Lines>,
}

const SIZE: &str = "an orbit has a `period`, or a `semi_major_axis` with `GM`";
const PLANE: &str = "the plane of an orbit is given by its `normal`, beside which `periapsis` may stand, or by \
                     `inclination`, `ascending_node` and `argument_of_periapsis`";
const PLACE: &str = "the place at the start is given by the `phase`, a mean anomaly, or by the `true_anomaly`";
const STATE: &str = "an orbit by `position` and `velocity` has these two and `GM` alone, which of the Earth is \
                     \"398600.4418 km³/s²\"";
const OPEN: &str = "this `position` and `velocity` are on no closed orbit about a mass with this `GM`";
const TWO_LINES: &str = "an orbit by `tle` has no other key";

/// Parses the keys and values of a scene's table `orbit`, as a text of TOML.
///
/// # Errors
///
/// The first [`Mistake`] in it.
///
/// # Examples
///
/// ```
/// let keys = "period = \"90 min\"\nnormal = [0, 0, 1]\neccentricity = 0.2\nphase = \"180 deg\"";
/// let orbit = liestep_scene::orbit(keys)?;
/// // At the far end, 1.2 semi-major axes from the mass.
/// assert!((orbit.place(0.0).x + 1.2).abs() < 1e-15);
/// # Ok::<(), liestep_scene::Mistake>(())
/// ```
pub fn orbit(text: &str) -> Result<Kepler, Mistake> {
    let read = toml::from_str::<Orbit>(text);
    read.map(|orbit| *orbit).map_err(|error| Mistake::of_toml(Path::new("orbit"), text, &error))
}

impl TryFrom<OrbitTable> for Orbit {
    type Error = &'static str;

    fn try_from(table: OrbitTable) -> Result<Self, &'static str> {
        if let Some(lines) = &table.tle {
            let axes = Kepler::plane(lines.inclination, lines.ascending_node, lines.argument_of_perigee);
            let orbit = Kepler::new(lines.period, lines.eccentricity, lines.mean_anomaly, axes);
            let is_alone = !table.has_elements() && !table.has_state();
            return orbit.ok().filter(|_| is_alone).map(Self).ok_or(TWO_LINES);
        }
        if table.has_state() {
            return match (table.position, table.velocity, table.GM) {
                (Some(place), Some(velocity), Some(GM)) if !table.has_elements_beside_gm() => {
                    Kepler::of_state(place.value, velocity.value, GM.value).map(Self).map_err(|_| OPEN)
                }
                _ => Err(STATE),
            };
        }
        let eccentricity = table.eccentricity.map_or(0.0, |number| number.value);
        if !(0.0..1.0).contains(&eccentricity) {
            return Err("an orbit's `eccentricity` is from 0, a circle, to below 1");
        }
        let period = table.period()?;
        let axes = table.axes()?;
        let phase = match (table.phase, table.true_anomaly) {
            (phase, None) => phase.map_or(0.0, |angle| angle.value),
            (None, Some(angle)) => Kepler::mean_anomaly(angle.value, eccentricity),
            _ => return Err(PLACE),
        };
        Kepler::new(period, eccentricity, phase, axes).map(Self).map_err(|_| SIZE)
    }
}

impl OrbitTable {
    const fn has_state(&self) -> bool {
        self.position.is_some() || self.velocity.is_some()
    }

    const fn has_elements(&self) -> bool {
        self.GM.is_some() || self.has_elements_beside_gm()
    }

    const fn has_elements_beside_gm(&self) -> bool {
        self.period.is_some()
            || self.semi_major_axis.is_some()
            || self.eccentricity.is_some()
            || self.has_angles()
            || self.normal.is_some()
            || self.periapsis.is_some()
            || self.phase.is_some()
            || self.true_anomaly.is_some()
    }

    const fn has_angles(&self) -> bool {
        self.inclination.is_some() || self.ascending_node.is_some() || self.argument_of_periapsis.is_some()
    }

    /// The period, s, by Kepler's third law from the semi-major axis.
    fn period(&self) -> Result<f64, &'static str> {
        match (self.period, self.semi_major_axis, self.GM) {
            (Some(period), None, None) => Ok(period.value),
            (None, Some(axis), Some(GM)) => Kepler::period_of(axis.value, GM.value).map_err(|_| SIZE),
            _ => Err(SIZE),
        }
    }

    /// The unit vectors towards pericentre, and a quarter turn further.
    fn axes(&self) -> Result<[Vector3<f64>; 2], &'static str> {
        let Some(Direction(normal)) = self.normal else {
            let (None, Some(tilt), Some(node)) = (self.periapsis, self.inclination, self.ascending_node) else {
                return Err(PLANE);
            };
            let argument = self.argument_of_periapsis.map_or(0.0, |angle| angle.value);
            return Ok(Kepler::plane(tilt.value, node.value, argument));
        };
        if self.has_angles() {
            return Err(PLANE);
        }
        let across = |direction: Vector3<f64>| (direction - normal * normal.dot(&direction)).try_normalize(1e-6);
        let periapsis = match self.periapsis {
            Some(direction) => across(direction.0),
            None => across(Vector3::x()).or_else(|| across(Vector3::y())),
        };
        let periapsis = periapsis.ok_or("`periapsis` is a direction in the plane of the orbit, across its `normal`")?;
        Ok([periapsis, normal.cross(&periapsis)])
    }
}
