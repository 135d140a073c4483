//! The list of the effects with their tables in a file. Every other list of effects is generated from it.

use std::sync::Arc;

use liestep::effects::{
    AirDrag, Dipole, Drag, Gravity, GravityGradient, MagneticDamping, Rotor, Spring, Thrust, Torque,
};
use liestep::mechanics::{Effect, Inertia};
use liestep::methods::Multibody;
use liestep_late::numbers;
use serde::Deserialize;

use crate::file::orbit::{AirInTime, DirectionInTime, FieldInTime, Nadir, Parameter, Time, VectorInTime};
use crate::file::quantity;
use crate::file::quantity::{
    Acceleration, Damping, Direction, Force, GravitationalParameter, Length, MagneticGain, MagneticMoment, Mass,
    Momentum, PositiveScalar, Scalar, Stiffness, Triple,
};

/// An effect's parameters in a file.
pub(crate) trait Table {
    /// The effect's parameters for a body of this inertia, at a time.
    fn numbers(&self, J: &Inertia, time: Time<'_>) -> Vec<f64>;

    /// Adds the effect to one of several bodies, which has this inertia, at a time.
    fn act_on(&self, J: &Inertia, system: &mut Multibody, body: (usize, Time<'_>));

    /// The parameter that varies along the orbit.
    fn on_orbit(&self) -> Option<&'static str>;

    /// Sets a number in this key and component, see [`Parameter::put`](crate::file::orbit::Parameter::put).
    fn put(&mut self, place: (&str, usize), number: f64, unit: &str) -> bool;

    /// A copy of the parameters, which nothing else refers to.
    fn copied(&self) -> Arc<dyn Table + Send + Sync>;
}

/// Passes the list to a macro, after the macro's own arguments. An entry has the effect's table, its keys with their
/// types, and the effect's value for them.
macro_rules! effects {
    ($then:ident $($given:tt)*) => {
        $then! {
            { $($given)* }
            gravity: GravityTable { m: PositiveScalar<Mass>, g: Scalar<Acceleration>, rho: Triple<Length>, up: Direction }
                => |_, _, p| -> Gravity {
                    Gravity { m: p.m.value, g: p.g.value, rho: p.rho.value, up: p.up.0 }
                }
            gravity_gradient: GravityGradientTable {
                GM: Option<PositiveScalar<GravitationalParameter>>, r: Option<PositiveScalar<Length>>, direction: DirectionInTime
            }
                => |J, t, p| -> GravityGradient {
                    let (GM, r) = match (p.direction, p.GM, p.r) {
                        (VectorInTime::Fixed(_), Some(GM), Some(r)) => (GM.value, r.value),
                        // Kepler's third law.
                        (VectorInTime::Turns(Nadir::Nadir), ..) => (t.orbit.map_or(f64::NAN, |orbit| orbit.rate()).powi(2), 1.0),
                        // A gravity gradient without these values is refused when the file is read.
                        _ => (f64::NAN, f64::NAN),
                    };
                    GravityGradient { GM, r, J: *J, direction: p.direction.at(t) }
                }
            dipole: DipoleTable { moment: Triple<MagneticMoment>, field: FieldInTime }
                => |_, t, p| -> Dipole { Dipole { moment: p.moment.value, field: p.field.at(t) } }
            spring: SpringTable {
                k: PositiveScalar<Stiffness>, length: Scalar<Length>, at: Triple<Length>, anchor: Triple<Length>
            }
                => |_, _, p| -> Spring {
                    Spring { k: p.k.value, length: p.length.value, at: p.at.value, anchor: p.anchor.value }
                }
            rotor: RotorTable { spin: Triple<Momentum> } => |_, _, p| -> Rotor { Rotor { spin: p.spin.value } }
            drag: DragTable { c: PositiveScalar<Damping> } => |J, _, p| -> Drag { Drag { c: p.c.value, J: *J } }
            air_drag: AirDragTable { c: PositiveScalar<Damping>, air: AirInTime }
                => |J, t, p| -> AirDrag { AirDrag { c: p.c.value, air: p.air.at(t), J: *J } }
            torque: TorqueTable { torque: Triple<quantity::Torque> }
                => |_, _, p| -> Torque { Torque { torque: p.torque.value } }
            thrust: ThrustTable { at: Triple<Length>, thrust: Triple<Force> }
                => |_, _, p| -> Thrust { Thrust { at: p.at.value, thrust: p.thrust.value } }
            magnetic_damping: MagneticDampingTable { k: PositiveScalar<MagneticGain>, field: FieldInTime }
                => |J, t, p| -> MagneticDamping {
                    MagneticDamping { k: p.k.value, field: p.field.at(t), J: *J }
                }
        }
    };
}
pub(crate) use effects;

/// The facts about an effect that don't depend on a file.
pub(crate) struct EffectEntry {
    /// The effect's table in a file.
    pub(crate) key: &'static str,
    /// The effect's derivation, and the text of its declaration.
    pub(crate) derived: (&'static str, &'static str),
    /// The keys of its parameters with their SI units; none of a direction, whose length is one.
    pub(crate) units: &'static [(&'static str, Option<&'static str>)],
}

impl EffectEntry {
    /// The name with this separator between its words.
    pub(crate) fn name(&self, between: &str) -> String {
        self.key.replace('_', between)
    }

    /// Whether the effect is a force rather than a Lagrangian.
    pub(crate) fn does_work(&self) -> bool {
        self.derived.1.starts_with("#[force")
    }
}

macro_rules! tables {
    ({} $(
        $name:ident: $table:ident { $($field:ident: $type:ty),+ }
            => |$J:pat_param, $t:pat_param, $parameters:ident| -> $effect:ty $value:block
    )+) => {
        $(
            #[derive(Clone, Copy, Deserialize)]
            #[serde(deny_unknown_fields)]
            pub(crate) struct $table {
                $(pub(crate) $field: $type),+
            }

            impl $table {
                pub(crate) fn effect(&self, $J: &Inertia, $t: Time<'_>) -> $effect {
                    let $parameters = self;
                    $value
                }
            }

            impl Table for $table {
                fn numbers(&self, J: &Inertia, time: Time<'_>) -> Vec<f64> {
                    numbers(&self.effect(J, time))
                }

                fn act_on(&self, J: &Inertia, system: &mut Multibody, (body, time): (usize, Time<'_>)) {
                    system.on(body, self.effect(J, time));
                }

                fn on_orbit(&self) -> Option<&'static str> {
                    [$(self.$field.is_on_orbit().then_some(stringify!($field))),+].into_iter().flatten().next()
                }

                fn put(&mut self, (key, component): (&str, usize), number: f64, unit: &str) -> bool {
                    match key {
                        $(stringify!($field) => self.$field.put(component, number, unit),)+
                        _ => false,
                    }
                }

                fn copied(&self) -> Arc<dyn Table + Send + Sync> {
                    Arc::new(*self)
                }
            }
        )+

        /// All effects, in the order of the list.
        pub(crate) const EFFECTS: &[EffectEntry] = &[$(EffectEntry {
            key: stringify!($name),
            derived: (<$effect as Effect>::DERIVATION, <$effect as Effect>::DECLARATION),
            units: &[$((stringify!($field), <$type as Parameter>::UNIT)),+],
        }),+];
    };
}

effects!(tables);
