//! Parameters that vary along the orbit of a scene: vectors that are fixed in space, or functions of time.

use std::fmt;
use std::marker::PhantomData;

use nalgebra::Vector3;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer, StrDeserializer};
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor};

use crate::file::kepler::Orbit;
use crate::file::quantity::{Direction, FluxDensity, PositiveScalar, Quantity, Rate, Scalar, Triple, in_si, si};

/// A time of a scene, s, with its orbit.
#[derive(Clone, Copy)]
pub(crate) struct Time<'a> {
    pub(crate) time: f64,
    pub(crate) orbit: Option<&'a Orbit>,
}

impl Time<'_> {
    /// A vector of the orbit at this time; NaN without an orbit, which is refused when the file is read.
    fn along(&self, vector: impl FnOnce(&Orbit, f64) -> Vector3<f64>) -> Vector3<f64> {
        self.orbit.map_or_else(|| Vector3::repeat(f64::NAN), |orbit| vector(orbit, self.time))
    }
}

/// A vector that is constant, or one that the orbit determines as a function of time.
#[derive(Clone, Copy)]
pub(crate) enum VectorInTime<F, T> {
    Fixed(F),
    Turns(T),
}

/// The direction of the mass.
pub(crate) type DirectionInTime = VectorInTime<Direction, Nadir>;
/// The angular velocity of the air.
pub(crate) type AirInTime = VectorInTime<Triple<Rate>, OnOrbit>;
/// A magnetic flux density.
pub(crate) type FieldInTime = VectorInTime<Triple<FluxDensity>, DipoleField>;

/// The word `"nadir"`, the direction of the mass.
#[derive(Clone, Copy, Deserialize)]
pub(crate) enum Nadir {
    #[serde(rename = "nadir")]
    Nadir,
}

/// The word `"orbit"`: with the direction of the mass.
#[derive(Clone, Copy, Deserialize)]
pub(crate) enum OnOrbit {
    #[serde(rename = "orbit")]
    Orbit,
}

/// The field along the orbit of a magnetic dipole in the middle of the mass, fixed in space.
#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DipoleField {
    /// The field above the dipole's equator, one semi-major axis away.
    equator: Triple<FluxDensity>,
}

/// The direction of the mass at a time, s, with the length `(a/r)^{3/2}`: a gravity gradient, quadratic in it, falls with
/// the third power of the distance.
pub(crate) fn towards_mass(orbit: &Orbit, time: f64) -> Vector3<f64> {
    let place = orbit.place(time);
    let distance = place.norm();
    -place / (distance * distance * distance.sqrt())
}

impl DipoleField {
    pub(crate) fn at(&self, orbit: &Orbit, time: f64) -> Vector3<f64> {
        orbit.dipole_field(self.equator.value, time)
    }
}

impl DirectionInTime {
    pub(crate) fn at(&self, time: Time<'_>) -> Vector3<f64> {
        match self {
            Self::Fixed(direction) => direction.0,
            Self::Turns(Nadir::Nadir) => time.along(towards_mass),
        }
    }
}

impl AirInTime {
    /// The angular velocity at a time, in space, rad/s.
    pub(crate) fn at(&self, time: Time<'_>) -> Vector3<f64> {
        match self {
            Self::Fixed(rate) => rate.value,
            Self::Turns(OnOrbit::Orbit) => time.along(|orbit, time| orbit.turning(time)),
        }
    }
}

impl FieldInTime {
    pub(crate) fn at(&self, time: Time<'_>) -> Vector3<f64> {
        match self {
            Self::Fixed(field) => field.value,
            Self::Turns(dipole) => time.along(|orbit, time| dipole.at(orbit, time)),
        }
    }
}

/// A parameter of an effect.
pub(crate) trait Parameter {
    /// The SI unit of each number, where the numbers may have any values.
    const UNIT: Option<&'static str> = None;

    /// Whether the parameter varies along the orbit.
    fn is_on_orbit(&self) -> bool {
        false
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
    const UNIT: Option<&'static str> = Some(si::<Q>());

    fn put(&mut self, _: usize, number: f64, unit: &str) -> bool {
        put(Some(&mut self.value), in_si::<Q>(number, unit))
    }
}

/// Over time zero is a term that is off.
impl<Q: Quantity> Parameter for PositiveScalar<Q> {
    const UNIT: Option<&'static str> = Some(si::<Q>());

    fn put(&mut self, _: usize, number: f64, unit: &str) -> bool {
        put(Some(&mut self.value), in_si::<Q>(number, unit).filter(|&number| number >= 0.0))
    }
}

impl<Q: Quantity> Parameter for Triple<Q> {
    const UNIT: Option<&'static str> = Some(si::<Q>());

    fn put(&mut self, component: usize, number: f64, unit: &str) -> bool {
        put(self.value.get_mut(component), in_si::<Q>(number, unit))
    }
}

impl<P: Parameter> Parameter for Option<P> {
    const UNIT: Option<&'static str> = P::UNIT;
}

impl Parameter for Direction {}

impl<F: Parameter, T> Parameter for VectorInTime<F, T> {
    const UNIT: Option<&'static str> = F::UNIT;

    fn put(&mut self, component: usize, number: f64, unit: &str) -> bool {
        if let Self::Fixed(vector) = self { vector.put(component, number, unit) } else { false }
    }

    fn is_on_orbit(&self) -> bool {
        matches!(self, Self::Turns(_))
    }
}

impl<'de, F: Deserialize<'de>, T: Deserialize<'de>> Deserialize<'de> for VectorInTime<F, T> {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        source.deserialize_any(ListOrWord(PhantomData))
    }
}

struct ListOrWord<F, T>(PhantomData<(F, T)>);

impl<'de, F: Deserialize<'de>, T: Deserialize<'de>> Visitor<'de> for ListOrWord<F, T> {
    type Value = VectorInTime<F, T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("three numbers; along an orbit \"nadir\" for a direction, \"orbit\" for air, `{ equator = […] }` for a field")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Self::Value, A::Error> {
        F::deserialize(SeqAccessDeserializer::new(list)).map(VectorInTime::Fixed)
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<Self::Value, A::Error> {
        T::deserialize(MapAccessDeserializer::new(table)).map(VectorInTime::Turns)
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<Self::Value, E> {
        T::deserialize(StrDeserializer::new(word)).map(VectorInTime::Turns)
    }
}
