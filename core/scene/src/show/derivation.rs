//! The derived equations of the effects, as text.

use liestep::effects::{CayleyBody, FourthOrderBody, GeodesicBody, PrincipalBody, RigidBody, SixthOrderBody};
use liestep::mechanics::Effect;

use crate::file::arrangement::BODIES;
use crate::file::body::{Distribution, Kinetic};
use crate::file::effects::EFFECTS;
use crate::file::scene::SceneFile;
use crate::file::system::System;
use crate::run::bodies::Heavy;
use crate::run::springs::Springs;

/// The kinetic terms: their names in commands, and what is derived of them.
const BODIES_DERIVED: [(&str, &str); 6] = [
    ("principal-body", <PrincipalBody as Effect>::DERIVATION),
    ("rigid-body", <RigidBody as Effect>::DERIVATION),
    ("cayley-body", <CayleyBody as Effect>::DERIVATION),
    ("geodesic-body", <GeodesicBody as Effect>::DERIVATION),
    ("fourth-order-body", <FourthOrderBody as Effect>::DERIVATION),
    ("sixth-order-body", <SixthOrderBody as Effect>::DERIVATION),
];

fn all() -> impl Iterator<Item = (String, &'static str)> {
    let bodies = BODIES_DERIVED.iter().map(|(name, text)| ((*name).to_owned(), *text));
    bodies.chain(EFFECTS.iter().map(|effect| (effect.name("-"), effect.derivation)))
}

/// The names that [`derivation`] knows: the kinetic terms and the effects.
pub fn derived() -> impl Iterator<Item = String> {
    all().map(|(name, _)| name)
}

/// What the library derived of an effect, from its declaration to the constants of a step.
#[must_use]
pub fn derivation(name: &str) -> Option<&'static str> {
    all().find(|(other, _)| other == name).map(|(_, text)| text)
}

impl SceneFile {
    /// What was derived of each term of the scene.
    #[must_use]
    pub fn derivation(&self) -> String {
        if let Some(lagrangian) = &self.lagrangian {
            return lagrangian.declaration().derivation.to_owned();
        }
        let Some(body) = self.body else { return String::new() };
        let body = match (body.kinetic, body.mass) {
            (Kinetic::Rigid, Distribution::Principal(_)) => "principal-body",
            (Kinetic::Rigid, Distribution::Full(_)) => "rigid-body",
            (Kinetic::Cayley, _) => "cayley-body",
            (Kinetic::Geodesic, _) => "geodesic-body",
            (Kinetic::FourthOrder, _) => "fourth-order-body",
            (Kinetic::SixthOrder, _) => "sixth-order-body",
        };
        let names = std::iter::once(body.to_owned()).chain(self.effects().map(|effect| effect.name("-")));
        let terms = names.filter_map(|name| derivation(&name).map(|text| format!("{name}\n\n{text}")));
        terms.collect::<Vec<_>>().join("\n")
    }
}

/// What joints hold, as in the documentation of `BallJoint` and `PinJoint`.
const BALLS: &str =
    "joints from a body a, or space, to a body b: x_b + R_b ρ_b − x_a − R_a ρ_a = 0 at both ends of a step\n";
const PINS: &str = "pins, with e_1 and e_2 across the axis n_a: R_a e_1 · R_b n_b = R_a e_2 · R_b n_b = 0, too\n";

impl System {
    /// What was derived of a body, what springs add, and what joints hold.
    #[must_use]
    pub fn derivation(&self) -> String {
        let gravity = if self.gravity.is_some() { "" } else { "without gravity, g = 0\n" };
        let springs = if self.springs.is_empty() { "" } else { Springs::<BODIES>::DERIVATION };
        let joints = if self.joints.is_empty() { "" } else { BALLS };
        let pins = if self.has_pins() { PINS } else { "" };
        format!("{}{gravity}{springs}{joints}{pins}", Heavy::DERIVATION)
    }
}
