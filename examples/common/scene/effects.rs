//! The tables of a body and of each effect, with their parameters.

// The letters of the field.
#![allow(non_snake_case)]

use liestep::effects::{Dipole, Drag, Gravity, GravityGradient, MagneticDamping, PrincipalBody, Rotor, Spring, Torque};
use liestep::{DiagonalNonstandardInertia, InertiaError, NonstandardInertia};
use serde::Deserialize;

use super::quantity;
use super::quantity::{
    Acceleration, Damping, Direction, FluxDensity, GravitationalParameter, Inertia, Length, MagneticGain,
    MagneticMoment, Mass, Momentum, Positive, Scalar, Stiffness, Triple,
};

/// A body in its principal axes, by its moments of inertia or by its nonstandard ones.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "BodyTable")]
pub(super) struct Body(pub(super) PrincipalBody);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BodyTable {
    moments: Option<Triple<Inertia>>,
    J_d: Option<Triple<Inertia>>,
}

impl TryFrom<BodyTable> for Body {
    type Error = String;

    fn try_from(table: BodyTable) -> Result<Self, String> {
        let J_d = match (table.moments, table.J_d) {
            (Some(moments), None) => DiagonalNonstandardInertia::from_principal_moments(moments.value),
            (None, Some(diagonal)) => DiagonalNonstandardInertia::new(diagonal.value),
            _ => return Err("a body has either `moments` (of inertia) or `J_d` (nonstandard)".to_owned()),
        };
        J_d.map(|J_d| Self(PrincipalBody { J_d })).map_err(|error: InertiaError| error.to_string())
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
