//! The table of a body.

use std::fmt;
use std::marker::PhantomData;

use liestep::NonstandardInertia;
use liestep::mechanics::{DiagonalNonstandardInertia, Inertia, InertiaError};
use nalgebra::{Matrix3, Vector3};
use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, Error as _, MapAccess, SeqAccess, Visitor};

use crate::file::key::refuse;
use crate::file::quantity;
use crate::file::quantity::{Triple, short};

/// A body: one of its inertias, and the discretisation of its kinetic energy.
#[derive(Clone, Copy)]
pub(crate) struct Body {
    /// The inertia as written in the file, or converted from the nonstandard one.
    pub(crate) J: Inertia,
    pub(crate) mass: Distribution,
    pub(crate) kinetic: Kinetic,
}

/// The nonstandard inertia in principal axes, or in any axes.
#[derive(Clone, Copy)]
pub(crate) enum Distribution {
    Principal(DiagonalNonstandardInertia),
    Full(NonstandardInertia),
}

/// The kinetic term, by the names of [`liestep::effects`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Kinetic {
    /// The kinetic energy of (3.13), quadratic in `F − I`.
    #[default]
    Rigid,
    Cayley,
    Geodesic,
    FourthOrder,
    SixthOrder,
}

impl Body {
    /// Sets principal moments by their key; returns whether a body has them.
    pub(crate) fn put(&mut self, key: &str, numbers: &[f64]) -> bool {
        let made = principal(key, numbers);
        made.map(|(J, J_d)| (self.J, self.mass) = (J, Distribution::Principal(J_d))).is_some()
    }
}

/// The inertia of principal moments by their key, as `moments` or `J_d.effective`; none that a body can't have.
pub(crate) fn principal(key: &str, numbers: &[f64]) -> Option<(Inertia, DiagonalNonstandardInertia)> {
    let &[x, y, z] = numbers else { return None };
    let (key, is_effective) = key.strip_suffix(".effective").map_or((key, false), |key| (key, true));
    let mut value = Triple::ZERO;
    value.value = Vector3::new(x, y, z);
    let inertia = AnyInertia { value, is_effective };
    match key {
        "moments" => Moments::try_from(inertia).ok().map(|Moments { J, J_d }| (J, J_d)),
        "J_d" => NonstandardMoments::try_from(inertia).ok().map(|of| (of.inertia(), of.0)),
        _ => None,
    }
}

impl Kinetic {
    /// Order of the free body's step.
    pub(crate) fn order(self) -> u32 {
        match self {
            Self::Rigid | Self::Cayley | Self::Geodesic => 2,
            Self::FourthOrder => 4,
            Self::SixthOrder => 6,
        }
    }
}

#[derive(Clone, Copy, Deserialize)]
#[serde(field_identifier)]
enum Key {
    #[serde(rename = "moments")]
    Moments,
    #[serde(rename = "J_d")]
    Nonstandard,
    #[serde(rename = "J")]
    Full,
    #[serde(rename = "kinetic")]
    Kinetic,
}

pub(crate) const INERTIA: &str =
    "a body has one of `moments` (of inertia, principal), `J_d` (nonstandard, principal), `J` (of inertia, 3 by 3)";

impl<'de> Deserialize<'de> for Body {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        source.deserialize_map(BodyTable)
    }
}

struct BodyTable;

/// Written by hand, so that a superfluous key is refused at its place.
impl<'de> Visitor<'de> for BodyTable {
    type Value = Body;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table with an inertia")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut table: M) -> Result<Body, M::Error> {
        let (mut inertia, mut kinetic) = (None, Kinetic::default());
        while let Some(key) = table.next_key()? {
            match key {
                Key::Kinetic => kinetic = table.next_value()?,
                _ if inertia.is_some() => return refuse(&mut table, INERTIA),
                Key::Moments => {
                    let Moments { J, J_d } = table.next_value()?;
                    inertia = Some((J, Distribution::Principal(J_d)));
                }
                Key::Nonstandard => {
                    let made: NonstandardMoments = table.next_value()?;
                    inertia = Some((made.inertia(), Distribution::Principal(made.0)));
                }
                Key::Full => {
                    let InertiaRows(J) = table.next_value()?;
                    inertia = Some((J, Distribution::Full(J.to_nonstandard())));
                }
            }
        }
        let (J, mass) = inertia.ok_or_else(|| M::Error::custom(INERTIA))?;
        Ok(Body { J, mass, kinetic })
    }
}

/// The reason why no body has these principal moments, with their numbers.
fn impossible(moments: &Vector3<f64>) -> Option<String> {
    let mut sorted: [f64; 3] = (*moments).into();
    sorted.sort_by(f64::total_cmp);
    let [least, middle, largest] = sorted;
    if least < 0.0 {
        return Some(format!("no body has this inertia: the principal moment {} is negative", short(least)));
    }
    let [l, m, s] = [largest, middle, least].map(short);
    (largest > middle + least).then(|| {
        format!("no body has this inertia: {l} > {m} + {s}, and a principal moment is at most the sum of the others; {EFFECTIVE}")
    })
}

/// An inertia in one of its forms, `[…]`, or `{ effective = […] }` of what is no rigid body.
pub(crate) struct AnyInertia<T> {
    pub(crate) value: T,
    pub(crate) is_effective: bool,
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for AnyInertia<T> {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        source.deserialize_any(ListOrTable(PhantomData))
    }
}

struct ListOrTable<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for ListOrTable<T> {
    type Value = AnyInertia<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a sequence")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Self::Value, A::Error> {
        let value = T::deserialize(SeqAccessDeserializer::new(list))?;
        Ok(AnyInertia { value, is_effective: false })
    }

    fn visit_map<M: MapAccess<'de>>(self, mut table: M) -> Result<Self::Value, M::Error> {
        let wrong = || M::Error::custom("an inertia is a list, or `{ effective = […] }` where no rigid body has it");
        if table.next_key::<String>()?.as_deref() != Some("effective") {
            return Err(wrong());
        }
        let value = table.next_value()?;
        match table.next_key::<String>()? {
            None => Ok(AnyInertia { value, is_effective: true }),
            Some(_) => Err(wrong()),
        }
    }
}

/// The message for an inertia that no rigid body has.
fn unlike_bodies(impossible: Option<String>, error: InertiaError) -> String {
    impossible.unwrap_or_else(|| match error {
        InertiaError::TriangleInequality { smallest } => {
            format!("no body has this inertia: J_d has the negative eigenvalue {}; {EFFECTIVE}", short(smallest))
        }
        error => error.to_string(),
    })
}

const EFFECTIVE: &str = "if it is meant, as with rotors or in a fluid, write `{ effective = […] }`";

/// Principal moments of inertia, which satisfy the triangle inequality or are effective.
#[derive(Deserialize)]
#[serde(try_from = "AnyInertia<Triple<quantity::Inertia>>")]
pub(crate) struct Moments {
    pub(crate) J: Inertia,
    pub(crate) J_d: DiagonalNonstandardInertia,
}

impl TryFrom<AnyInertia<Triple<quantity::Inertia>>> for Moments {
    type Error = String;

    fn try_from(moments: AnyInertia<Triple<quantity::Inertia>>) -> Result<Self, String> {
        let AnyInertia { value: moments, is_effective } = moments;
        if is_effective {
            let J = Inertia::effective(Matrix3::from_diagonal(&moments.value));
            let both = J.and_then(|J| Ok(Self { J, J_d: DiagonalNonstandardInertia::effective(moments.value)? }));
            return both.map_err(|error| error.to_string());
        }
        let J_d = DiagonalNonstandardInertia::from_principal_moments(moments.value);
        let made = J_d.and_then(|J_d| Ok(Self { J: Inertia::from_principal_moments(moments.value)?, J_d }));
        made.map_err(|error| unlike_bodies(impossible(&moments.value), error))
    }
}

/// Principal nonstandard moments of a possible body.
#[derive(Deserialize)]
#[serde(try_from = "AnyInertia<Triple<quantity::Inertia>>")]
pub(crate) struct NonstandardMoments(pub(crate) DiagonalNonstandardInertia);

impl NonstandardMoments {
    /// The inertia of these.
    pub(crate) fn inertia(&self) -> Inertia {
        NonstandardInertia::from(self.0).to_inertia()
    }
}

impl TryFrom<AnyInertia<Triple<quantity::Inertia>>> for NonstandardMoments {
    type Error = String;

    fn try_from(diagonal: AnyInertia<Triple<quantity::Inertia>>) -> Result<Self, String> {
        let AnyInertia { value: diagonal, is_effective } = diagonal;
        let d = diagonal.value;
        let made = if is_effective {
            DiagonalNonstandardInertia::effective(Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y))
        } else {
            DiagonalNonstandardInertia::from_diagonal(d)
        };
        made.map(Self).map_err(|error| unlike_bodies(None, error))
    }
}

/// The inertia tensor in any axes, by its rows.
#[derive(Deserialize)]
#[serde(try_from = "AnyInertia<Vec<Triple<quantity::Inertia>>>")]
pub(crate) struct InertiaRows(pub(crate) Inertia);

impl TryFrom<AnyInertia<Vec<Triple<quantity::Inertia>>>> for InertiaRows {
    type Error = String;

    fn try_from(rows: AnyInertia<Vec<Triple<quantity::Inertia>>>) -> Result<Self, String> {
        let AnyInertia { value: rows, is_effective } = rows;
        let [x, y, z]: [Vector3<f64>; 3] = rows
            .iter()
            .map(|row| row.value)
            .collect::<Vec<_>>()
            .try_into()
            .map_err(|_| format!("`J` has three rows of three components, found {} rows", rows.len()))?;
        let matrix = Matrix3::from_rows(&[x, y, z].map(|row| row.transpose()));
        if is_effective {
            return Inertia::effective(matrix).map(Self).map_err(|error| error.to_string());
        }
        let principal = || (matrix == matrix.transpose()).then(|| impossible(&matrix.symmetric_eigenvalues()));
        Inertia::new(matrix).map(Self).map_err(|error| unlike_bodies(principal().flatten(), error))
    }
}
