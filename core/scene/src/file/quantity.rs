//! Numbers with units: a number in SI units, or a text such as `"30 deg"`.

use std::fmt;
use std::marker::PhantomData;

use nalgebra::Vector3;
use serde::Deserialize;
use serde::de::{Deserializer, Error, Visitor};

/// A physical quantity.
pub(crate) trait Quantity {
    /// The name with an article.
    const NAME: &'static str;
    /// Units, each with its size in the first, the SI unit.
    const UNITS: &'static [(&'static str, f64)];
    /// The largest number without a unit. A larger one was probably meant in another unit.
    const LARGEST_BARE: f64 = f64::INFINITY;
}

/// The SI unit of a quantity.
pub(crate) const fn si<Q: Quantity>() -> &'static str {
    match Q::UNITS {
        [(unit, _), ..] => unit,
        [] => "",
    }
}

macro_rules! quantities {
    ($($quantity:ident: $name:literal $(up to $most:ident)? in $($unit:literal $size:expr),+;)+) => {$(
        #[derive(Clone, Copy)]
        pub(crate) struct $quantity;

        impl Quantity for $quantity {
            const NAME: &'static str = $name;
            const UNITS: &'static [(&'static str, f64)] = &[$(($unit, $size)),+];
            $(const LARGEST_BARE: f64 = $most;)?
        }
    )+

        /// The units of each quantity.
        const QUANTITIES: &[&[(&str, f64)]] = &[$($quantity::UNITS),+];

        /// A quantity of any kind, for the parameters of a file's own declarations.
        #[derive(Clone, Copy)]
        pub(crate) struct Any;

        impl Quantity for Any {
            const NAME: &'static str = "a number";
            const UNITS: &'static [(&'static str, f64)] = &[("", 1.0), $($(($unit, $size)),+),+];
        }
    };
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// A slug is the mass that a pound of force accelerates by a foot per second squared: pounds of force, N, times feet, m.
const SLUG_FOOT: f64 = 4.448_221_615_260_5 * 0.3048;
/// The largest angle without a unit: a whole turn as typed, rad.
const TURN: f64 = 6.3;

quantities! {
    Acceleration: "an acceleration" in "m/s²" 1.0;
    Angle: "an angle" up to TURN in "rad" 1.0, "deg" DEGREE, "°" DEGREE;
    Damping: "a damping coefficient" in "N m s" 1.0;
    Density: "a density" in "kg/m³" 1.0, "g/cm³" 1e3;
    Duration: "a time" in "s" 1.0, "ms" 1e-3, "min" 60.0, "h" 3600.0, "d" 86_400.0;
    FluxDensity: "a magnetic flux density" in "T" 1.0, "mT" 1e-3, "µT" 1e-6, "nT" 1e-9, "G" 1e-4;
    Energy: "an energy" in "J" 1.0, "mJ" 1e-3, "kJ" 1e3;
    Force: "a force" in "N" 1.0, "mN" 1e-3, "kN" 1e3;
    GravitationalParameter: "a gravitational parameter" in "m³/s²" 1.0, "km³/s²" 1e9;
    Inertia: "a moment of inertia" in "kg m²" 1.0, "kg cm²" 1e-4, "kg mm²" 1e-6, "g cm²" 1e-7, "slug ft²" SLUG_FOOT;
    LinearDamping: "a coefficient of friction" in "N s/m" 1.0, "kg/s" 1.0;
    Length: "a length" in "m" 1.0, "cm" 1e-2, "mm" 1e-3, "km" 1e3;
    MagneticGain: "a magnetic gain" in "A m² s/T" 1.0;
    MagneticMoment: "a magnetic moment" in "A m²" 1.0;
    Mass: "a mass" in "kg" 1.0, "g" 1e-3, "t" 1e3;
    Momentum: "an angular momentum" in "kg m²/s" 1.0, "N m s" 1.0, "mN m s" 1e-3;
    Number: "a number" in "" 1.0;
    Rate: "an angular velocity" in "rad/s" 1.0, "deg/s" DEGREE, "°/s" DEGREE, "rpm" 6.0 * DEGREE;
    Speed: "a speed" in "m/s" 1.0, "km/h" 1.0 / 3.6, "km/s" 1e3;
    Stiffness: "a stiffness" in "N/m" 1.0;
    TurningStiffness: "a stiffness against turning" in "N m/rad" 1.0, "N m" 1.0, "N m/deg" 1.0 / DEGREE;
    Torque: "a torque" in "N m" 1.0, "mN m" 1e-3, "µN m" 1e-6;
}

/// A number with a unit, converted to SI units; none where it isn't finite or the unit is unknown.
pub(crate) fn in_si<Q: Quantity>(number: f64, unit: &str) -> Option<f64> {
    let size = if unit.is_empty() { 1.0 } else { size::<Q>(unit)? };
    Some(number * size).filter(|number| number.is_finite())
}

/// A unit with powers as digits above the line, and spaces for products.
fn plain(unit: &str) -> String {
    unit.replace("^2", "²").replace("^3", "³").replace(['*', '·'], " ")
}

/// The size of a unit in another one of the same quantity; none where no quantity has both.
#[must_use]
pub fn ratio(unit: &str, other: &str) -> Option<f64> {
    let [unit, other] = [unit, other].map(plain);
    QUANTITIES.iter().find_map(|units| {
        let size = |unit: &str| units.iter().find(|(name, _)| *name == unit).map(|(_, size)| *size);
        Some(size(&unit)? / size(&other)?)
    })
}

/// The size of a unit in the SI unit.
fn size<Q: Quantity>(unit: &str) -> Option<f64> {
    Q::UNITS.iter().find(|(name, _)| *name == unit).map(|(_, size)| *size)
}

/// A finite number, in SI units.
#[derive(Clone, Copy)]
pub(crate) struct Scalar<Q> {
    pub(crate) value: f64,
    quantity: PhantomData<Q>,
}

/// A finite number above zero, in SI units.
#[derive(Clone, Copy)]
pub(crate) struct PositiveScalar<Q> {
    pub(crate) value: f64,
    quantity: PhantomData<Q>,
}

/// Three finite numbers, in SI units.
#[derive(Clone, Copy)]
pub(crate) struct Triple<Q> {
    pub(crate) value: Vector3<f64>,
    quantity: PhantomData<Q>,
}

/// A unit vector, normalised from typed digits.
#[derive(Clone, Copy)]
pub(crate) struct Direction(pub(crate) Vector3<f64>);

impl<'de, Q: Quantity> Deserialize<'de> for Scalar<Q> {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        let value = source.deserialize_any(NumberOrText::<Q>(PhantomData))?;
        Ok(Self { value, quantity: PhantomData })
    }
}

impl<'de, Q: Quantity> Deserialize<'de> for PositiveScalar<Q> {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        let Scalar { value, quantity } = Scalar::<Q>::deserialize(source)?;
        if value > 0.0 { Ok(Self { value, quantity }) } else { Err(D::Error::custom("must be above zero")) }
    }
}

impl<Q> Triple<Q> {
    pub(crate) const ZERO: Self = Self { value: Vector3::new(0.0, 0.0, 0.0), quantity: PhantomData };
}

impl<'de, Q: Quantity> Deserialize<'de> for Triple<Q> {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        let components = Vec::<Scalar<Q>>::deserialize(source)?;
        match components.as_slice() {
            [x, y, z] => Ok(Self { value: Vector3::new(x.value, y.value, z.value), quantity: PhantomData }),
            other => Err(D::Error::custom(format!("expected three components, found {}", other.len()))),
        }
    }
}

impl<'de> Deserialize<'de> for Direction {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        let vector = Triple::<Number>::deserialize(source)?.value;
        // Divided by the largest component first, as squares may overflow or underflow.
        let unit = (vector / vector.amax()).try_normalize(0.5).filter(|unit| unit.iter().all(|x| x.is_finite()));
        let unit = unit.ok_or_else(|| D::Error::custom("a direction can't be zero"))?;
        let length = vector.dot(&unit);
        if (length - 1.0).abs() <= OFF_UNIT {
            return Ok(Self(unit));
        }
        let [x, y, z] = [unit.x, unit.y, unit.z].map(|part| short((part * 1e6).round() / 1e6));
        Err(D::Error::custom(format!(
            "a direction has the length 1, and this {}: write [{x}, {y}, {z}]",
            short(length)
        )))
    }
}

fn finite<E: Error>(value: f64) -> Result<f64, E> {
    if value.is_finite() { Ok(value) } else { Err(E::custom("must be finite")) }
}

/// Largest deviation of a direction's length from one, which parts with three digits may have.
pub const OFF_UNIT: f64 = 1e-3;

struct NumberOrText<Q>(PhantomData<Q>);

impl<Q: Quantity> Visitor<'_> for NumberOrText<Q> {
    type Value = f64;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match Q::UNITS {
            [(si, _), ..] if !si.is_empty() => write!(f, "{} in {si}, or a text with a unit", Q::NAME),
            _ => f.write_str(Q::NAME),
        }
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<f64, E> {
        let value = finite(value)?;
        if value.abs() <= Q::LARGEST_BARE {
            return Ok(value);
        }
        let units: Vec<_> = Q::UNITS.iter().map(|(unit, _)| format!("\"{} {unit}\"", short(value))).take(2).collect();
        Err(E::custom(format!("{} has no unit: write {}", short(value), units.join(" or "))))
    }

    #[allow(clippy::cast_precision_loss)] // equal to the number with a decimal point
    fn visit_i64<E: Error>(self, value: i64) -> Result<f64, E> {
        self.visit_f64(value as f64)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<f64, E> {
        let (number, unit) = text.trim().split_once(' ').unwrap_or((text.trim(), ""));
        let value: f64 = number.parse().map_err(|_| {
            E::custom(format!("`{text}` doesn't begin with a number; a quantity is written as in \"30 deg\""))
        })?;
        let written = plain(unit.trim());
        match size::<Q>(&written) {
            Some(size) => finite(value * size),
            // A quantity of any kind has too many units to list.
            None if Q::UNITS.len() > 8 => {
                Err(E::custom(format!("`{unit}` isn't a unit that is known here: take one of SI, or leave it out")))
            }
            None => {
                let names: Vec<_> = Q::UNITS.iter().map(|(name, _)| format!("`{name}`")).collect();
                Err(E::custom(format!("{} isn't in `{unit}` but in {}", Q::NAME, names.join(", "))))
            }
        }
    }
}

/// A number rounded to three digits.
pub(crate) fn round(value: f64) -> String {
    short(format!("{value:.2e}").parse().unwrap_or(value))
}

/// A number as a person would write it, without the rounding errors of its last digits.
pub(crate) fn short(value: f64) -> String {
    // Debug formatting uses an exponent where there would be many zeros, and adds a point to whole numbers.
    let text = format!("{:?}", format!("{value:.9e}").parse::<f64>().unwrap_or(value));
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}
