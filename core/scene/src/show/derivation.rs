//! The derived equations of the effects, as text.

use liestep::effects::{CayleyBody, FourthOrderBody, GeodesicBody, PrincipalBody, RigidBody, SixthOrderBody};
use liestep::mechanics::Effect;
use liestep_late::{Declaration, LateError};

use crate::file::body::{Distribution, Kinetic};
use crate::file::effects::EFFECTS;
use crate::file::lagrangian::DeclaredTerm;
use crate::file::scene::SceneFile;
use crate::file::system::System;
use crate::run::bodies::{Coil, Cord, HeavyBody};

/// A term's derivation, and the text of its declaration.
type Derivation = (&'static str, &'static str);

const fn derived_of<E: Effect>() -> Derivation {
    (E::DERIVATION, E::DECLARATION)
}

/// The kinetic terms.
const KINETIC: [(&str, Derivation); 6] = [
    ("principal-body", derived_of::<PrincipalBody>()),
    ("rigid-body", derived_of::<RigidBody>()),
    ("cayley-body", derived_of::<CayleyBody>()),
    ("geodesic-body", derived_of::<GeodesicBody>()),
    ("fourth-order-body", derived_of::<FourthOrderBody>()),
    ("sixth-order-body", derived_of::<SixthOrderBody>()),
];

fn all() -> impl Iterator<Item = (String, Derivation)> {
    let kinetic = KINETIC.iter().map(|(name, derived)| ((*name).to_owned(), *derived));
    kinetic.chain(EFFECTS.iter().map(|effect| (effect.name("-"), effect.derived)))
}

/// The names for [`derivation`]: the kinetic terms and the effects.
pub fn derived() -> impl Iterator<Item = String> {
    all().map(|(name, _)| name)
}

/// The derivation of a term, from its declaration to the constants of a step.
#[must_use]
pub fn derivation(name: &str) -> Option<&'static str> {
    all().find(|(other, _)| other == name).map(|(_, (text, _))| text)
}

/// The form of a derivation other than plain text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The equations as LaTeX.
    Latex,
    /// The straight-line code of a step in Rust.
    Rust,
    /// A step in C99.
    C,
}

impl Form {
    fn of(self, declaration: &Declaration) -> Result<String, LateError> {
        match self {
            Self::Latex => Ok(liestep_late::latex(declaration)),
            Self::Rust => liestep_late::rust(declaration),
            Self::C => liestep_late::c(declaration),
        }
    }
}

/// The declaration of a term, as text.
#[must_use]
pub fn declaration(name: &str) -> Option<&'static str> {
    all().find(|(other, _)| other == name).map(|(_, (_, text))| text)
}

/// The derivation of a term in this form.
#[must_use]
pub fn written(name: &str, form: Form) -> Option<Result<String, LateError>> {
    Some(Declaration::parse(declaration(name)?).and_then(|declaration| form.of(declaration)))
}

impl SceneFile {
    /// The derivations of the scene's terms.
    #[must_use]
    pub fn derivation(&self) -> String {
        let listed = self.terms().filter_map(|name| derivation(&name).map(|text| format!("{name}\n\n{text}")));
        let own = self.own().map(|one| one.declaration.derivation.clone());
        listed.chain(own).collect::<Vec<_>>().join("\n")
    }

    /// The derivation of the sum of all terms, in this form.
    ///
    /// # Errors
    ///
    /// The sum can't be written in this form, see [`LateError::Step`].
    pub fn written(&self, form: Form) -> Result<String, LateError> {
        let listed = self.terms().filter_map(|name| declaration(&name)).map(Declaration::parse);
        let own = self.own().map(|one| Ok(one.declaration));
        form.of(Declaration::sum(&listed.chain(own).collect::<Result<Vec<_>, _>>()?)?)
    }

    fn own(&self) -> impl Iterator<Item = &DeclaredTerm> {
        self.lagrangian.iter().chain(&self.force)
    }

    /// The names of the body and the effects.
    fn terms(&self) -> impl Iterator<Item = String> {
        let body = self.body.map(|body| match (body.kinetic, body.mass) {
            (Kinetic::Rigid, Distribution::Principal(_)) => "principal-body",
            (Kinetic::Rigid, Distribution::Full(_)) => "rigid-body",
            (Kinetic::Cayley, _) => "cayley-body",
            (Kinetic::Geodesic, _) => "geodesic-body",
            (Kinetic::FourthOrder, _) => "fourth-order-body",
            (Kinetic::SixthOrder, _) => "sixth-order-body",
        });
        body.map(str::to_owned).into_iter().chain(self.effects().map(|(effect, _)| effect.name("-")))
    }
}

/// The constraints of joints, as in the documentation of `BallJoint` and `PinJoint`.
const BALLS: &str =
    "joints from a body a, or space, to a body b: x_b + R_b ρ_b − x_a − R_a ρ_a = 0 at both ends of a step\n";
const PINS: &str = "pins, with e_1 and e_2 across the axis n_a: R_a e_1 · R_b n_b = R_a e_2 · R_b n_b = 0, too\n";

impl System {
    /// The derivation of a body, the terms of springs, and the constraints of joints.
    #[must_use]
    pub fn derivation(&self) -> String {
        let gravity = if self.gravity.is_some() { "" } else { "without gravity, g = 0\n" };
        let has = |is_long: bool| self.springs.iter().any(|spring| (spring.of.length != 0.0) == is_long);
        let springs = if has(true) { Coil::DERIVATION } else { "" };
        let cords = if has(false) { Cord::DERIVATION } else { "" };
        let joints = if self.joints.is_empty() { "" } else { BALLS };
        let pins = if self.has_pins() { PINS } else { "" };
        format!("{}{gravity}{springs}{cords}{joints}{pins}", HeavyBody::DERIVATION)
    }
}
