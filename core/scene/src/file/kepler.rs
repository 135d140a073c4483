//! The orbit of a scene, by Kepler's laws: the table `orbit`.

use std::f64::consts::{PI, TAU};
use std::num::NonZeroU32;
use std::path::Path;

use liestep::SetupError;
use liestep::with::Clock;
use nalgebra::{Matrix3, Vector3};
use serde::Deserialize;

use crate::file::mistake::Mistake;
use crate::file::quantity::{
    Angle, Direction, Duration, GravitationalParameter, Length, Number, PositiveScalar, Scalar, Speed, Triple,
};
use crate::file::tle::Lines;

/// A closed orbit about a distant mass, by Kepler's laws; its keys are those of a [scene's table](crate::SceneFile) `orbit`.
///
/// # Examples
///
/// ```
/// use liestep_scene::Orbit;
///
/// let orbit = Orbit::parse("period = \"90 min\"\nnormal = [0, 0, 1]\neccentricity = 0.2\nphase = \"180 deg\"")?;
/// // At the far end, 1.2 semi-major axes from the mass.
/// assert!((orbit.place(0.0).x + 1.2).abs() < 1e-15);
/// # Ok::<(), liestep_scene::Mistake>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "OrbitTable")]
pub struct Orbit {
    /// s.
    period: f64,
    eccentricity: f64,
    /// Mean anomaly at the start, rad.
    phase: f64,
    /// Unit vectors in space: towards pericentre, and a quarter turn further along the orbit.
    axes: [Vector3<f64>; 2],
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
const TWO_LINES: &str = "an orbit by `tle` has no other key";

impl TryFrom<OrbitTable> for Orbit {
    type Error = &'static str;

    fn try_from(table: OrbitTable) -> Result<Self, &'static str> {
        if let Some(lines) = &table.tle {
            return if table.has_elements() || table.has_state() { Err(TWO_LINES) } else { Ok(Self::of_lines(lines)) };
        }
        if table.has_state() {
            return match (table.position, table.velocity, table.GM) {
                (Some(place), Some(velocity), Some(GM)) if !table.has_elements_beside_gm() => {
                    Self::of_state(place.value, velocity.value, GM.value)
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
            (None, Some(angle)) => mean_anomaly(angle.value, eccentricity),
            _ => return Err(PLACE),
        };
        Ok(Self { period, eccentricity, phase, axes })
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
            (None, Some(axis), Some(GM)) => of_axis(axis.value, GM.value).ok_or(SIZE),
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
            return Ok(turned_plane(tilt.value, node.value, argument));
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

/// The period of a semi-major axis, s, by Kepler's third law.
fn of_axis(axis: f64, GM: f64) -> Option<f64> {
    Some(TAU * axis * (axis / GM).sqrt()).filter(|period| period.is_finite() && *period > 0.0)
}

/// The axes of an orbit, `R_z(Ω) R_x(i) R_z(ω)` on the first two of space.
fn turned_plane(tilt: f64, node: f64, argument: f64) -> [Vector3<f64>; 2] {
    let ((sin_node, cos_node), (sin_tilt, cos_tilt)) = (node.sin_cos(), tilt.sin_cos());
    let rising = Vector3::new(cos_node, sin_node, 0.0);
    let ahead = Vector3::new(-cos_tilt * sin_node, cos_tilt * cos_node, sin_tilt);
    let (sin, cos) = argument.sin_cos();
    [rising * cos + ahead * sin, ahead * cos - rising * sin]
}

/// The mean anomaly of a true one, rad.
fn mean_anomaly(true_anomaly: f64, e: f64) -> f64 {
    let (sin, cos) = true_anomaly.sin_cos();
    let eccentric = (((1.0 - e) * (1.0 + e)).sqrt() * sin).atan2(e + cos);
    eccentric - e * eccentric.sin()
}

/// Smallest eccentricity that has a pericentre; below, the orbit begins at it.
const ROUND: f64 = 1e-12;

impl Orbit {
    /// Parses the keys and values of an orbit, as a text of TOML.
    ///
    /// # Errors
    ///
    /// The first [`Mistake`] in it.
    pub fn parse(text: &str) -> Result<Self, Mistake> {
        toml::from_str(text).map_err(|error| Mistake::of_toml(Path::new("orbit"), text, &error))
    }

    /// The period, s.
    #[must_use]
    pub const fn period(&self) -> f64 {
        self.period
    }

    /// The orbit of the mean elements of two lines from their epoch on.
    fn of_lines(lines: &Lines) -> Self {
        let axes = turned_plane(lines.inclination, lines.ascending_node, lines.argument_of_perigee);
        Self { period: lines.period, eccentricity: lines.eccentricity, phase: lines.mean_anomaly, axes }
    }

    /// The orbit through a place, m, with a velocity, m/s, about a mass with this `GM`, m³/s².
    fn of_state(place: Vector3<f64>, velocity: Vector3<f64>, GM: f64) -> Result<Self, &'static str> {
        const OPEN: &str = "this `position` and `velocity` are on no closed orbit about a mass with this `GM`";
        // Lengths in the distance, and times so that GM is one.
        let distance = place.norm();
        let (out, moving) = (place / distance, velocity * (distance / GM).sqrt());
        let axis = 1.0 / (2.0 - moving.norm_squared());
        let areal = out.cross(&moving);
        let towards = moving.cross(&areal) - out;
        let eccentricity = towards.norm();
        let period = of_axis(axis * distance, GM);
        let (true, Some(period), Some(normal)) = (axis > 0.0 && eccentricity < 1.0, period, areal.try_normalize(1e-9))
        else {
            return Err(OPEN);
        };
        let near = if eccentricity < ROUND { out } else { towards / eccentricity };
        let on = normal.cross(&near);
        let phase = mean_anomaly(out.dot(&on).atan2(out.dot(&near)), eccentricity);
        Ok(Self { period, eccentricity, phase, axes: [near, on] })
    }

    /// The clock with this many steps per orbit, and their mean length, s.
    pub(crate) fn clock(&self, steps: NonZeroU32) -> Result<(Clock, f64), SetupError> {
        let clock = Clock::orbit_from(self.phase, self.eccentricity, self.period, steps.get())?;
        Ok((clock, self.period / f64::from(steps.get())))
    }

    /// The mean motion `2π/T`, rad/s.
    #[must_use]
    pub fn rate(&self) -> f64 {
        TAU / self.period
    }

    /// The body's position relative to the mass at a time, s: in space, in semi-major axes.
    #[must_use]
    pub fn place(&self, time: f64) -> Vector3<f64> {
        let e = self.eccentricity;
        // Whole turns are removed first, as they would cost digits of the angle.
        let anomaly = eccentric_anomaly(self.phase + TAU * ((time % self.period) / self.period), e);
        let (sin, cos) = anomaly.sin_cos();
        self.axes[0] * (cos - e) + self.axes[1] * (((1.0 - e) * (1.0 + e)).sqrt() * sin)
    }

    /// The angular velocity of the direction of the mass at a time, s, in space, rad/s: `n √(1 − e²) (a/r)²` about the
    /// normal, by Kepler's second law.
    #[must_use]
    pub fn turning(&self, time: f64) -> Vector3<f64> {
        let [near, on] = &self.axes;
        let rate = self.rate() * ((1.0 - self.eccentricity) * (1.0 + self.eccentricity)).sqrt();
        near.cross(on) * (rate / self.place(time).norm_squared())
    }

    /// The flux density of a dipole in the mass, fixed in space, at a time, s: `(a/r)³ (B − 3 (B·r̂) r̂)`, in the unit of `B`,
    /// the field above the dipole's equator, a semi-major axis away.
    #[must_use]
    pub fn dipole_field(&self, equator: Vector3<f64>, time: f64) -> Vector3<f64> {
        let place = self.place(time);
        let square = place.norm_squared();
        (equator - place * (3.0 * equator.dot(&place) / square)) / (square * square.sqrt())
    }

    /// The local vertical frame at a time, s: its axes in space as columns. The third points to the mass, the second
    /// against the normal of the orbit, and the first completes them, ahead.
    #[must_use]
    pub fn local_vertical(&self, time: f64) -> Matrix3<f64> {
        let down = -self.place(time).normalize();
        let [near, on] = &self.axes;
        let right = -near.cross(on);
        Matrix3::from_columns(&[right.cross(&down), right, down])
    }
}

/// Solves Kepler's equation `E − e sin E = M` to rounding.
///
/// From `M` to half a turn the left side is convex: Newton's iteration decreases to the root from any point above.
fn eccentric_anomaly(mean: f64, e: f64) -> f64 {
    let mean = mean - TAU * (mean / TAU).round();
    let wanted = mean.abs();
    let mut anomaly = (wanted + e).min(PI);
    loop {
        let next = anomaly - (anomaly - e * anomaly.sin() - wanted) / (1.0 - e * anomaly.cos());
        // The iterate increases by rounding errors only. At a zero slope the division has no result.
        if next >= anomaly || next.is_nan() {
            return anomaly.copysign(mean);
        }
        anomaly = next;
    }
}
