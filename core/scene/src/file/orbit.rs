//! Orbits, and parameters that vary along them: vectors that are fixed in space, or functions of time.

use std::f64::consts::{PI, TAU};
use std::fmt;
use std::marker::PhantomData;
use std::num::NonZeroU32;

use liestep::SetupError;
use liestep::with::Clock;
use nalgebra::Vector3;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};

use crate::file::quantity::{
    Angle, Direction, Duration, FluxDensity, Number, PositiveScalar, Quantity, Rate, Scalar, Triple, in_si, short,
};

/// A closed orbit about a distant mass, by Kepler's laws.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "OrbitTable")]
pub(crate) struct Orbit {
    /// s.
    period: f64,
    eccentricity: f64,
    /// Mean anomaly at the start, rad.
    phase: f64,
    /// Unit vectors in space: towards pericentre, and a quarter turn further along the orbit.
    axes: [Vector3<f64>; 2],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OrbitTable {
    period: PositiveScalar<Duration>,
    /// Axis of the motion, which is right-handed about it.
    normal: Direction,
    eccentricity: Option<Scalar<Number>>,
    phase: Option<Scalar<Angle>>,
    /// Direction of pericentre, projected across the normal.
    periapsis: Option<Direction>,
}

impl TryFrom<OrbitTable> for Orbit {
    type Error = &'static str;

    fn try_from(table: OrbitTable) -> Result<Self, &'static str> {
        let eccentricity = table.eccentricity.map_or(0.0, |number| number.value);
        if !(0.0..1.0).contains(&eccentricity) {
            return Err("an orbit's `eccentricity` is from 0, a circle, to below 1");
        }
        let normal = table.normal.0;
        let across = |direction: Vector3<f64>| (direction - normal * normal.dot(&direction)).try_normalize(1e-6);
        let periapsis = match table.periapsis {
            Some(direction) => across(direction.0),
            None => across(Vector3::x()).or_else(|| across(Vector3::y())),
        };
        let periapsis = periapsis.ok_or("`periapsis` is a direction in the plane of the orbit, across its `normal`")?;
        let phase = table.phase.map_or(0.0, |angle| angle.value);
        Ok(Self { period: table.period.value, eccentricity, phase, axes: [periapsis, normal.cross(&periapsis)] })
    }
}

impl Orbit {
    /// The clock with this many steps per orbit, and their mean length, s.
    pub(crate) fn clock(&self, steps: NonZeroU32) -> Result<(Clock, f64), SetupError> {
        let clock = Clock::orbit_from(self.phase, self.eccentricity, self.period, steps.get())?;
        Ok((clock, self.period / f64::from(steps.get())))
    }

    /// The orbit's keys and values, rounded for display.
    pub(crate) fn said(&self) -> [(&'static str, String); 5] {
        let [near, on] = &self.axes;
        // A zero without its rounding error and its sign.
        let direction = |v: Vector3<f64>| format!("{:?}", v.map(|x| (x * 1e9).round() / 1e9 + 0.0).data.0[0]);
        [
            ("period", short(self.period) + " s"),
            ("normal", direction(near.cross(on))),
            ("eccentricity", short(self.eccentricity)),
            ("phase", short(self.phase.to_degrees()) + " deg"),
            ("periapsis", direction(*near)),
        ]
    }

    /// The mean motion `2π/T`, rad/s.
    pub(crate) fn rate(&self) -> f64 {
        TAU / self.period
    }

    /// The body's position relative to the mass at a time, s: in space, in semi-major axes.
    pub(crate) fn place(&self, time: f64) -> Vector3<f64> {
        let e = self.eccentricity;
        // Whole turns are removed first, as they would cost digits of the angle.
        let anomaly = eccentric_anomaly(self.phase + TAU * ((time % self.period) / self.period), e);
        let (sin, cos) = anomaly.sin_cos();
        self.axes[0] * (cos - e) + self.axes[1] * ((1.0 - e) * (1.0 + e)).sqrt() * sin
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

/// A vector that is constant, or a table that determines it as a function of time.
#[derive(Clone, Copy)]
pub(crate) enum VectorInTime<F, T> {
    Fixed(F),
    Turns(T),
}

/// The direction of the mass.
pub(crate) type DirectionInTime = VectorInTime<Direction, OnOrbit>;
/// The angular velocity of the air.
pub(crate) type AirInTime = VectorInTime<Triple<Rate>, OnOrbit>;
/// A magnetic flux density.
pub(crate) type FieldInTime = VectorInTime<Triple<FluxDensity>, DipoleField>;

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct OnOrbit {
    pub(crate) orbit: Orbit,
}

/// The field along the orbit of a magnetic dipole in the middle of the mass, fixed in space.
#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DipoleField {
    orbit: Orbit,
    /// The field above the dipole's equator, one semi-major axis away.
    equator: Triple<FluxDensity>,
}

impl VectorInTime<Direction, OnOrbit> {
    /// The direction of the mass at a time, s, with the length `(a/r)^{3/2}`: a gravity gradient, quadratic in it,
    /// falls with the third power of the distance.
    pub(crate) fn at(&self, time: f64) -> Vector3<f64> {
        match self {
            Self::Fixed(direction) => direction.0,
            Self::Turns(OnOrbit { orbit }) => {
                let place = orbit.place(time);
                let distance = place.norm();
                -place / (distance * distance * distance.sqrt())
            }
        }
    }
}

impl VectorInTime<Triple<Rate>, OnOrbit> {
    /// The angular velocity at a time, s, in space, rad/s. Along an orbit it is that of the direction of the mass,
    /// `n √(1 − e²) (a/r)²` by Kepler's second law.
    pub(crate) fn at(&self, time: f64) -> Vector3<f64> {
        match self {
            Self::Fixed(rate) => rate.value,
            Self::Turns(OnOrbit { orbit }) => {
                let [near, on] = &orbit.axes;
                let rate = orbit.rate() * ((1.0 - orbit.eccentricity) * (1.0 + orbit.eccentricity)).sqrt();
                near.cross(on) * (rate / orbit.place(time).norm_squared())
            }
        }
    }
}

impl VectorInTime<Triple<FluxDensity>, DipoleField> {
    /// The flux density at a time, s, in space, T: `(a/r)³ (B − 3 (B·r̂) r̂)`, with `B` at the equator.
    pub(crate) fn at(&self, time: f64) -> Vector3<f64> {
        match self {
            Self::Fixed(field) => field.value,
            Self::Turns(DipoleField { orbit, equator }) => {
                let place = orbit.place(time);
                let (square, field) = (place.norm_squared(), equator.value);
                (field - place * (3.0 * field.dot(&place) / square)) / (square * square.sqrt())
            }
        }
    }
}

/// A parameter of an effect.
pub(crate) trait Parameter {
    /// The orbit along which the parameter varies.
    fn orbit(&self) -> Option<&Orbit> {
        None
    }

    /// Sets a component, numbered from zero, to a number with a unit. `false` where nothing is set and the number has
    /// to be read from a text: it may be refused, or the value may be more than a number.
    fn put(&mut self, _component: usize, _number: f64, _unit: &str) -> bool {
        false
    }
}

/// Sets a place to a value, where both exist; returns whether they do.
pub(crate) fn put(place: Option<&mut f64>, value: Option<f64>) -> bool {
    place.zip(value).map(|(place, value)| *place = value).is_some()
}

impl<Q: Quantity> Parameter for Scalar<Q> {
    fn put(&mut self, _: usize, number: f64, unit: &str) -> bool {
        put(Some(&mut self.value), in_si::<Q>(number, unit))
    }
}

impl<Q: Quantity> Parameter for PositiveScalar<Q> {
    fn put(&mut self, _: usize, number: f64, unit: &str) -> bool {
        put(Some(&mut self.value), in_si::<Q>(number, unit).filter(|&number| number > 0.0))
    }
}

impl<Q: Quantity> Parameter for Triple<Q> {
    fn put(&mut self, component: usize, number: f64, unit: &str) -> bool {
        put(self.value.get_mut(component), in_si::<Q>(number, unit))
    }
}

impl<Q> Parameter for Option<Q> {}
impl Parameter for Direction {}

impl<F> Parameter for VectorInTime<F, OnOrbit> {
    fn orbit(&self) -> Option<&Orbit> {
        if let Self::Turns(OnOrbit { orbit }) = self { Some(orbit) } else { None }
    }
}

impl Parameter for FieldInTime {
    fn orbit(&self) -> Option<&Orbit> {
        if let Self::Turns(DipoleField { orbit, .. }) = self { Some(orbit) } else { None }
    }
}

impl<'de, F: Deserialize<'de>, T: Deserialize<'de>> Deserialize<'de> for VectorInTime<F, T> {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        source.deserialize_any(ListOrTable(PhantomData))
    }
}

struct ListOrTable<F, T>(PhantomData<(F, T)>);

impl<'de, F: Deserialize<'de>, T: Deserialize<'de>> Visitor<'de> for ListOrTable<F, T> {
    type Value = VectorInTime<F, T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("three numbers, or a table with an `orbit`")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Self::Value, A::Error> {
        F::deserialize(SeqAccessDeserializer::new(list)).map(VectorInTime::Fixed)
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<Self::Value, A::Error> {
        T::deserialize(MapAccessDeserializer::new(table)).map(VectorInTime::Turns)
    }
}
