//! Euler angles: three turns about axes that turn with the body, in any of the twelve sequences.

use std::fmt;

use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};

use crate::file::quantity::{Angle, Triple};

/// A sequence of axes, numbered from zero: the first and the last may be one axis, neighbours may not.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "String")]
pub(crate) struct Sequence([usize; 3]);

impl Sequence {
    /// Precession, nutation and spin.
    const ZXZ: Self = Self([2, 0, 2]);
    /// Yaw, pitch and roll.
    pub(crate) const ZYX: Self = Self([2, 1, 0]);
}

impl TryFrom<String> for Sequence {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        let letters: Vec<usize> =
            name.chars().filter_map(|letter| "xyz".find(letter).or_else(|| "123".find(letter))).collect();
        match letters[..] {
            [a, b, c] if name.chars().count() == 3 && a != b && b != c => Ok(Self([a, b, c])),
            _ => Err(format!(
                "`{name}` is no sequence: take one of xyz, xzy, yxz, yzx, zxy, zyx, xyx, xzx, yxy, yzy, zxz, zyz, or its \
                 digits, as 321 for zyx; the axes turn with the body, the first turn is the first letter's"
            )),
        }
    }
}

/// Angles of a sequence, rad: the attitude `R_a(α) R_b(β) R_c(γ)`.
#[derive(Clone, Copy)]
pub(crate) struct Angles {
    pub(crate) sequence: Sequence,
    pub(crate) angles: Vector3<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AnglesTable {
    sequence: Sequence,
    angles: Triple<Angle>,
}

impl Angles {
    fn turns(&self) -> [UnitQuaternion<f64>; 3] {
        [0, 1, 2].map(|place| {
            let axis = Vector3::ith_axis(self.sequence.0[place]);
            UnitQuaternion::from_axis_angle(&axis, self.angles[place])
        })
    }

    /// The attitude, body to space.
    pub(crate) fn attitude(&self) -> UnitQuaternion<f64> {
        let [first, second, third] = self.turns();
        first * second * third
    }

    /// The angular velocity `Ω = (RᵀR')^∨`, body frame: each rate about its axis, as the later turns see it.
    pub(crate) fn velocity(&self, rates: &Vector3<f64>) -> Vector3<f64> {
        let [_, second, third] = self.turns();
        let of = |place: usize| Vector3::ith(self.sequence.0[place], rates[place]);
        (second * third).inverse() * of(0) + third.inverse() * of(1) + of(2)
    }
}

/// Roll, pitch and yaw of `R_z(yaw) R_y(pitch) R_x(roll)`, rad.
pub(crate) fn roll_pitch_yaw(attitude: &Rotation3<f64>) -> [f64; 3] {
    let R = attitude.matrix();
    // The pitch is known to rounding, at a quarter turn, too.
    [R.m32.atan2(R.m33), (-R.m31).atan2(R.m11.hypot(R.m21)), R.m21.atan2(R.m11)]
}

impl<'de> Deserialize<'de> for Angles {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        source.deserialize_any(ListOrTable)
    }
}

struct ListOrTable;

impl<'de> Visitor<'de> for ListOrTable {
    type Value = Angles;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("three angles z-x-z, or `{ sequence = \"zyx\", angles = […] }`")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Angles, A::Error> {
        let angles = Triple::<Angle>::deserialize(SeqAccessDeserializer::new(list))?.value;
        Ok(Angles { sequence: Sequence::ZXZ, angles })
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<Angles, A::Error> {
        let AnglesTable { sequence, angles } = AnglesTable::deserialize(MapAccessDeserializer::new(table))?;
        Ok(Angles { sequence, angles: angles.value })
    }
}
