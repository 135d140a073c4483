//! The tables of the effects, with their parameters.

use liestep::effects::{Dipole, Drag, Gravity, GravityGradient, MagneticDamping, Rotor, Spring, Thrust, Torque};
use liestep::mechanics::Inertia;
use serde::Deserialize;

use crate::file::quantity;
use crate::file::quantity::{
    Acceleration, Damping, Direction, FluxDensity, Force, GravitationalParameter, Length, MagneticGain, MagneticMoment,
    Mass, Momentum, Positive, Scalar, Stiffness, Triple,
};

/// An effect by its parameters in a file.
pub(crate) trait Table {
    type Effect;

    /// The effect on the body with this inertia.
    fn effect(&self, J: &Inertia) -> Self::Effect;
}

macro_rules! tables {
    ($(
        $table:ident { $($field:ident: $kind:ty),+ $(,)? } => |$J:pat_param, $parameters:ident| -> $effect:ty $value:block
    )+) => {$(
        #[derive(Clone, Copy, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(crate) struct $table {
            $(pub(crate) $field: $kind),+
        }

        impl Table for $table {
            type Effect = $effect;

            fn effect(&self, $J: &Inertia) -> $effect {
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
        => |J, p| -> GravityGradient {
            GravityGradient { GM: p.GM.value, r: p.r.value, J: *J, direction: p.direction.0 }
        }
    DipoleTable { moment: Triple<MagneticMoment>, field: Triple<FluxDensity> }
        => |_, p| -> Dipole { Dipole { moment: p.moment.value, field: p.field.value } }
    SpringTable { k: Positive<Stiffness>, length: Scalar<Length>, at: Triple<Length>, anchor: Triple<Length> }
        => |_, p| -> Spring {
            Spring { k: p.k.value, length: p.length.value, at: p.at.value, anchor: p.anchor.value }
        }
    RotorTable { spin: Triple<Momentum> } => |_, p| -> Rotor { Rotor { spin: p.spin.value } }
    DragTable { c: Positive<Damping> } => |J, p| -> Drag { Drag { c: p.c.value, J: *J } }
    MagneticDampingTable { k: Positive<MagneticGain>, field: Triple<FluxDensity> }
        => |J, p| -> MagneticDamping { MagneticDamping { k: p.k.value, field: p.field.value, J: *J } }
    TorqueTable { torque: Triple<quantity::Torque> } => |_, p| -> Torque { Torque { torque: p.torque.value } }
    ThrustTable { at: Triple<Length>, thrust: Triple<Force> }
        => |_, p| -> Thrust { Thrust { at: p.at.value, thrust: p.thrust.value } }
}
