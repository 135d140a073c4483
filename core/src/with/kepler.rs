//! Places on a Kepler orbit.

use core::f64::consts::{PI, TAU};

use nalgebra::{Matrix3, Vector3};

use super::clock::Clock;
use crate::error::SetupError;

roots!();
#[cfg(not(feature = "std"))]
use nalgebra::RealField as _;

/// A closed orbit about a distant mass, by Kepler's laws: the place `r(t)` of a satellite, and the local vertical.
///
/// Places are in space, and their unit is the semi-major axis; the mean motion `n = 2π/T` takes the place of the mass, as
/// `GM = n² a³`. A gravity gradient at the place `r` is `3 n² n̂ × J n̂/|r|³` with `n̂ = −r/|r|`.
///
/// # Examples
///
/// The nadir in the middle of each step, for a body that is driven along its orbit:
///
/// ```
/// use liestep::with::Kepler;
///
/// // A height of 500 km at the inclination of 97.4 degrees, from the ascending node on.
/// let GM = 3.986_004_418e14;
/// let period = Kepler::period_of(6_878_137.0, GM)?;
/// let orbit = Kepler::new(period, 0.0, 0.0, Kepler::plane(1.7, 0.0, 0.0))?;
/// let nadir = |time: f64| -orbit.place(time).normalize();
/// assert!((nadir(0.25 * period) + orbit.local_vertical(0.0).column(0)).norm() < 1e-14);
/// # Ok::<(), liestep::SetupError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kepler {
    /// s.
    period: f64,
    eccentricity: f64,
    /// Mean anomaly at the start, rad.
    phase: f64,
    /// Unit vectors in space: towards pericentre, and a quarter turn further along the orbit.
    axes: [Vector3<f64>; 2],
}

/// Smallest eccentricity that has a pericentre; below, the orbit begins at it.
const ROUND: f64 = 1e-12;

const fn refused<T>(field: &'static str, cause: &'static str) -> Result<T, SetupError> {
    Err(SetupError::Parameter { field, cause })
}

impl Kepler {
    /// The orbit of a period, s, an eccentricity and a mean anomaly at the time zero, rad. The `axes` are directions in
    /// space: to pericentre, and one ahead of it in the plane of the orbit.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] if the period isn't positive and finite, the eccentricity isn't at least 0 and below 1, the
    /// anomaly isn't finite, or the directions have no plane.
    pub fn new(period: f64, eccentricity: f64, mean_anomaly: f64, axes: [Vector3<f64>; 2]) -> Result<Self, SetupError> {
        if !(period > 0.0 && period.is_finite()) {
            return refused("period", "isn't positive and finite");
        }
        if !(0.0..1.0).contains(&eccentricity) {
            return refused("eccentricity", "isn't that of an ellipse");
        }
        if !mean_anomaly.is_finite() {
            return refused("anomaly", "isn't finite");
        }
        let near = axes[0].try_normalize(0.0);
        let plane = near.and_then(|near| Some((near, (axes[1] - near * near.dot(&axes[1])).try_normalize(1e-9)?)));
        match plane {
            Some((near, on)) if (near.sum() + on.sum()).is_finite() => {
                Ok(Self { period, eccentricity, phase: mean_anomaly % TAU, axes: [near, on] })
            }
            _ => refused("axes", "have no plane"),
        }
    }

    /// The orbit through a place, m, with a velocity, m/s, in space at the time zero, about a mass with this `GM`, m³/s². With
    /// the place `r` and the velocity `v` its axis is `a = 1/(2/r − v²/GM)`, and the vector of its eccentricity
    /// `v × (r × v)/GM − r̂`.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] if they are on no closed orbit.
    pub fn of_state(place: Vector3<f64>, velocity: Vector3<f64>, GM: f64) -> Result<Self, SetupError> {
        // Lengths in the distance, and times so that GM is one.
        let distance = place.norm();
        let (out, moving) = (place / distance, velocity * (distance / GM).sqrt());
        let axis = 1.0 / (2.0 - moving.norm_squared());
        let areal = out.cross(&moving);
        let towards = moving.cross(&areal) - out;
        let eccentricity = towards.norm();
        let (true, Some(normal)) = (axis > 0.0 && eccentricity < 1.0, areal.try_normalize(1e-9)) else {
            return refused("velocity", "is that of no closed orbit at this place");
        };
        let near = if eccentricity < ROUND { out } else { towards / eccentricity };
        let on = normal.cross(&near);
        let anomaly = Self::mean_anomaly(out.dot(&on).atan2(out.dot(&near)), eccentricity);
        Self::new(Self::period_of(axis * distance, GM)?, eccentricity, anomaly, [near, on])
    }

    /// The period `2π √(a³/GM)`, s, of a semi-major axis, m, about a mass with this `GM`, m³/s²: Kepler's third law.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] if there is no such period.
    pub fn period_of(semi_major_axis: f64, GM: f64) -> Result<f64, SetupError> {
        let period = TAU * semi_major_axis * (semi_major_axis / GM).sqrt();
        if period > 0.0 && period.is_finite() { Ok(period) } else { refused("axis", "has no period about this mass") }
    }

    /// The directions to pericentre and ahead of it, the first two axes of space turned by `R_z(Ω) R_x(i) R_z(ω)`: by the
    /// inclination, the ascending node and the argument of pericentre, rad.
    #[must_use]
    pub fn plane(inclination: f64, ascending_node: f64, argument: f64) -> [Vector3<f64>; 2] {
        let ((sin_node, cos_node), (sin_tilt, cos_tilt)) = (ascending_node.sin_cos(), inclination.sin_cos());
        let rising = Vector3::new(cos_node, sin_node, 0.0);
        let ahead = Vector3::new(-cos_tilt * sin_node, cos_tilt * cos_node, sin_tilt);
        let (sin, cos) = argument.sin_cos();
        [rising * cos + ahead * sin, ahead * cos - rising * sin]
    }

    /// The mean anomaly of a true one, rad.
    #[must_use]
    pub fn mean_anomaly(true_anomaly: f64, eccentricity: f64) -> f64 {
        let ((sin, cos), e) = (true_anomaly.sin_cos(), eccentricity);
        let eccentric = (((1.0 - e) * (1.0 + e)).sqrt() * sin).atan2(e + cos);
        eccentric - e * eccentric.sin()
    }

    /// A clock with this many steps per orbit, `dt ∝ r^{3/2}`, from the place at the time zero on, see
    /// [`Clock::orbit_from`].
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] if there is no step.
    pub fn clock(&self, steps: u32) -> Result<Clock, SetupError> {
        Clock::orbit_from(self.phase, self.eccentricity, self.period, steps)
    }

    /// The period, s.
    #[must_use]
    pub const fn period(&self) -> f64 {
        self.period
    }

    /// The mean motion `n = 2π/T`, rad/s.
    #[must_use]
    pub fn rate(&self) -> f64 {
        TAU / self.period
    }

    /// The place relative to the mass at a time, s: in space, in semi-major axes.
    #[must_use]
    pub fn place(&self, time: f64) -> Vector3<f64> {
        let e = self.eccentricity;
        // Whole turns are removed first, as they would cost digits of the angle.
        let anomaly = eccentric_anomaly(self.phase + TAU * ((time % self.period) / self.period), e);
        let (sin, cos) = anomaly.sin_cos();
        self.axes[0] * (cos - e) + self.axes[1] * (((1.0 - e) * (1.0 + e)).sqrt() * sin)
    }

    /// The angular velocity of the local vertical at a time, s, in space, rad/s: `n √(1 − e²) (a/r)²` about the normal, by
    /// Kepler's second law.
    #[must_use]
    pub fn turning(&self, time: f64) -> Vector3<f64> {
        let [near, on] = &self.axes;
        let rate = self.rate() * ((1.0 - self.eccentricity) * (1.0 + self.eccentricity)).sqrt();
        near.cross(on) * (rate / self.place(time).norm_squared())
    }

    /// The flux density in space of a dipole in the mass, fixed in space, at a time, s: `(a/r)³ (B − 3 (B·r̂) r̂)`, in the unit
    /// of `B`, the field above the dipole's equator, a semi-major axis away.
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
