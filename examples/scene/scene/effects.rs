//! The tables of a body and of each effect, with their parameters.

// The letters of the field.
#![allow(non_snake_case)]

use std::fmt;

use liestep::NonstandardInertia;
use liestep::effects::{Dipole, Drag, Gravity, GravityGradient, MagneticDamping, PrincipalBody, Rotor, Spring, Torque};
use liestep::mechanics::{DiagonalNonstandardInertia, InertiaError};
use serde::Deserialize;
use serde::de::{Deserializer, Error as _, MapAccess, Visitor};

use super::quantity;
use super::quantity::{
    Acceleration, Damping, Direction, FluxDensity, GravitationalParameter, Inertia, Length, MagneticGain,
    MagneticMoment, Mass, Momentum, Positive, Scalar, Stiffness, Triple,
};
use super::refused::refused;

/// A body in its principal axes, by its moments of inertia or by its nonstandard ones.
#[derive(Clone, Copy)]
pub(super) struct Body(pub(super) PrincipalBody);

#[derive(Deserialize)]
#[serde(field_identifier)]
enum BodyKey {
    #[serde(rename = "moments")]
    Moments,
    #[serde(rename = "J_d")]
    Nonstandard,
}

const BODY: &str = "a body has either `moments` (of inertia) or `J_d` (nonstandard)";

impl<'de> Deserialize<'de> for Body {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
        source.deserialize_map(BodyTable)
    }
}

struct BodyTable;

/// By hand, so that a key too many is refused where it stands.
impl<'de> Visitor<'de> for BodyTable {
    type Value = Body;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table with an inertia")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut table: M) -> Result<Body, M::Error> {
        let mut J_d = None;
        while let Some(key) = table.next_key()? {
            J_d = Some(match (key, J_d) {
                (_, Some(_)) => return refused(&mut table, BODY),
                (BodyKey::Moments, None) => table.next_value::<Moments>()?.0,
                (BodyKey::Nonstandard, None) => table.next_value::<Nonstandard>()?.0,
            });
        }
        J_d.map(|J_d| Body(PrincipalBody { J_d })).ok_or_else(|| M::Error::custom(BODY))
    }
}

/// Moments of inertia that a body can have.
#[derive(Deserialize)]
#[serde(try_from = "Triple<Inertia>")]
struct Moments(DiagonalNonstandardInertia);

impl TryFrom<Triple<Inertia>> for Moments {
    type Error = InertiaError;

    fn try_from(moments: Triple<Inertia>) -> Result<Self, InertiaError> {
        DiagonalNonstandardInertia::from_principal_moments(moments.value).map(Self)
    }
}

/// The same, nonstandard.
#[derive(Deserialize)]
#[serde(try_from = "Triple<Inertia>")]
struct Nonstandard(DiagonalNonstandardInertia);

impl TryFrom<Triple<Inertia>> for Nonstandard {
    type Error = InertiaError;

    fn try_from(diagonal: Triple<Inertia>) -> Result<Self, InertiaError> {
        DiagonalNonstandardInertia::from_diagonal(diagonal.value).map(Self)
    }
}

/// An effect by its parameters in a file.
pub(super) trait Table {
    type Effect;

    /// The effect on this body.
    fn effect(&self, body: &PrincipalBody) -> Self::Effect;
}

macro_rules! tables {
    ($(
        $table:ident { $($field:ident: $kind:ty),+ $(,)? } => |$body:pat_param, $parameters:ident| -> $effect:ty $value:block
    )+) => {$(
        #[derive(Clone, Copy, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(super) struct $table {
            $($field: $kind),+
        }

        impl Table for $table {
            type Effect = $effect;

            fn effect(&self, $body: &PrincipalBody) -> $effect {
                let $parameters = self;
                $value
            }
        }
    )+};
}

tables! {
    GravityTable { m: Positive<Mass>, g: Scalar<Acceleration>, rho: Triple<Length>, up: Direction }
        => |_, p| -> Gravity {
            Gravity { m: p.m.value, g: p.g.value, rho: p.rho.value, up: p.up.0 }
        }
    GravityGradientTable { GM: Positive<GravitationalParameter>, r: Positive<Length>, direction: Direction }
        => |body, p| -> GravityGradient {
            let J = NonstandardInertia::from(body.J_d).to_inertia();
            GravityGradient { GM: p.GM.value, r: p.r.value, J, direction: p.direction.0 }
        }
    DipoleTable { moment: Triple<MagneticMoment>, field: Triple<FluxDensity> }
        => |_, p| -> Dipole { Dipole { moment: p.moment.value, field: p.field.value } }
    SpringTable { k: Positive<Stiffness>, length: Scalar<Length>, at: Triple<Length>, anchor: Triple<Length> }
        => |_, p| -> Spring {
            Spring { k: p.k.value, length: p.length.value, at: p.at.value, anchor: p.anchor.value }
        }
    RotorTable { spin: Triple<Momentum> } => |_, p| -> Rotor { Rotor { spin: p.spin.value } }
    DragTable { c: Positive<Damping> }
        => |body, p| -> Drag {
            Drag { c: p.c.value, J: NonstandardInertia::from(body.J_d).to_inertia() }
        }
    MagneticDampingTable { k: Positive<MagneticGain>, field: Triple<FluxDensity> }
        => |body, p| -> MagneticDamping {
            let J = NonstandardInertia::from(body.J_d).to_inertia();
            MagneticDamping { k: p.k.value, field: p.field.value, J }
        }
    TorqueTable { torque: Triple<quantity::Torque> } => |_, p| -> Torque { Torque { torque: p.torque.value } }
}
