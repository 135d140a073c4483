//! The derived equations of the effects, as text.

use liestep::effects::joints::{
    Armature, DryFriction, JointDamping, JointSpring, JointTorque, SliderArmature, SliderDamping, SliderFriction,
    SliderSpring,
};
use liestep::effects::{CayleyBody, FourthOrderBody, GeodesicBody, PrincipalBody, RigidBody, SixthOrderBody};
use liestep::mechanics::Effect;
use liestep_late::{Declaration, LateError, Sums};

use crate::file::effects::{EFFECTS, EffectEntry};
use crate::file::joint::{Joint, Number};
use crate::file::joint_kind::Kind;
use crate::file::scene::Scene;
use crate::file::scene_file::SceneFile;
use crate::file::system::System;
use crate::run::bodies::{Coil, Cord, HeavyBody, Tide};
use crate::run::data::LibraryBody;
use crate::run::model::Model;

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
    C(Sums),
    /// The step as data, with the claims that are to be checked.
    Certificate,
    /// The declarations of the step in C99, for other units.
    Header(Sums),
    /// A step of many members in `OpenCL` C, CUDA and C99.
    Gpu(Sums),
    /// A step in JavaScript.
    JavaScript,
}

impl Form {
    fn of(self, declaration: &Declaration) -> Result<String, LateError> {
        match self {
            Self::Latex => Ok(liestep_late::latex(declaration)),
            Self::Rust => Ok(liestep_late::rust(declaration)),
            Self::C(sums) => liestep_late::c(declaration, sums),
            Self::Certificate => liestep_late::certificate(declaration),
            Self::Header(sums) => liestep_late::header(declaration, sums),
            Self::Gpu(sums) => liestep_late::gpu(declaration, sums),
            Self::JavaScript => liestep_late::javascript(declaration),
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

impl Scene {
    /// The derivations of the scene's terms, and of several bodies the constraints of their joints.
    #[must_use]
    pub fn derivation(&self) -> String {
        self.file.system.as_ref().map_or_else(|| self.file.derivation(), |system| system.derivation(&self.file))
    }

    /// The derivation of the sum of all terms, in this form. In C it is followed by the scene's numbers, if its steps are equal
    /// and its numbers constant. None of several bodies.
    ///
    /// # Errors
    ///
    /// The sum can't be written in this form, see [`LateError::Step`].
    #[must_use]
    pub fn written(&self, form: Form) -> Option<Result<String, LateError>> {
        self.file.system.is_none().then(|| self.file.written(form))
    }
}

impl SceneFile {
    /// The derivations of the scene's terms.
    fn derivation(&self) -> String {
        let listed = self.terms().filter_map(|name| derivation(&name).map(|text| format!("{name}\n\n{text}")));
        let own = self.own().map(|one| one.declaration.derivation.clone());
        listed.chain(own).collect::<Vec<_>>().join("\n")
    }

    /// The derivation of the sum of all terms, in this form.
    fn written(&self, form: Form) -> Result<String, LateError> {
        let listed = self.terms().filter_map(|name| declaration(&name)).map(Declaration::parse);
        let own = self.own().map(|one| Ok(one.declaration));
        let sum = Declaration::sum(&listed.chain(own).collect::<Result<Vec<_>, _>>()?)?;
        let text = form.of(sum)?;
        let numbers = match form {
            Form::C(sums) | Form::Header(sums) => Model::of(self).ok().and_then(|model| model.numbered(sums)),
            _ => None,
        };
        Ok(match (form, numbers) {
            (Form::Header(_), Some([head, _])) => text + &head,
            (_, Some(both)) => text + &both.concat(),
            (_, None) => text,
        })
    }

    /// The names of the body and the effects.
    fn terms(&self) -> impl Iterator<Item = String> {
        let body = self.body.and_then(|body| LibraryBody::of(self, body.J));
        let body =
            body.and_then(|body| KINETIC.iter().find(|(_, (_, text))| *text == body.text).map(|(name, _)| *name));
        body.map(str::to_owned).into_iter().chain(self.effects().map(|(effect, _)| effect.name("-")))
    }
}

/// The constraint of a ball joint, which other kinds have, too, as in the documentation of `liestep::methods::Joint`.
const BALLS: &str =
    "joints from a body a, or space, to a body b: x_b + R_b ρ_b − x_a − R_a ρ_a = 0 at both ends of a step\n";

/// The other constraints of a joint of this kind, with `s` for the left side of the above.
fn constraints(kind: Kind) -> &'static str {
    match kind {
        Kind::Ball => "",
        Kind::Pin => "pins, with e_1 and e_2 across the axis n_a: R_a e_1 · R_b n_b = R_a e_2 · R_b n_b = 0, too\n",
        Kind::Universal => "universal joints: R_a n_a · R_b n_b = 0, too\n",
        Kind::Weld => {
            "welds, with the columns c_i of Q: R_a e_1 · R_b c_2 = R_a e_2 · R_b c_3 = R_a e_3 · R_b c_1 = 0, too\n"
        }
        Kind::Cylinder => {
            "cylinders, with e_1 and e_2 across the axis n_a, and s the distance of both points: R_a e_1 · s = R_a e_2 · s = R_a e_1 · R_b n_b = R_a e_2 · R_b n_b = 0\n"
        }
        Kind::Slider => {
            "sliders, with e_1 and e_2 across the axis, and s the distance of both points: R_a e_1 · s = R_a e_2 · s = 0, and the three cosines of a weld\n"
        }
        Kind::Plane => {
            "planes, with e_1 and e_2 across the axis n_a, and s the distance of both points: R_a n_a · s = R_a e_1 · R_b n_b = R_a e_2 · R_b n_b = 0\n"
        }
        Kind::Distance => "rods of the length l between two points at the distance s: (s · s / l − l) / 2 = 0\n",
    }
}

impl System {
    /// The derivation of a body, the terms of springs and of joints, and the constraints of joints.
    fn derivation(&self, file: &SceneFile) -> String {
        let gravity = if self.gravity.is_some() { "" } else { "without gravity, g = 0\n" };
        let coils = |is_long: bool| self.springs.iter().any(|spring| (spring.of.length != 0.0) == is_long);
        let springs = if coils(true) { Coil::DERIVATION } else { "" };
        let cords = if coils(false) { Cord::DERIVATION } else { "" };
        let any = |is: &dyn Fn(&Joint) -> bool| self.joints.iter().any(|joint| is(&joint.of));
        let has = |slides: bool, numbers: &[Number]| {
            any(&|joint| (joint.kind == Kind::Slider) == slides && joint.has(numbers))
        };
        let terms = [
            (JointSpring::DERIVATION, has(false, &[Number::Stiffness])),
            (JointTorque::DERIVATION, has(false, &[Number::Effort])),
            (JointDamping::DERIVATION, has(false, &[Number::Damping])),
            (DryFriction::DERIVATION, has(false, &[Number::Friction])),
            (Armature::DERIVATION, has(false, &[Number::Armature])),
            (SliderSpring::DERIVATION, has(true, &[Number::Stiffness, Number::Effort])),
            (SliderDamping::DERIVATION, has(true, &[Number::Damping])),
            (SliderFriction::DERIVATION, has(true, &[Number::Friction])),
            (SliderArmature::DERIVATION, has(true, &[Number::Armature])),
        ];
        let terms: String = terms.into_iter().filter_map(|(text, is_there)| is_there.then_some(text)).collect();
        let balls = if any(&|joint| joint.kind.has_one_point()) { BALLS } else { "" };
        let kinds = Kind::ALL.into_iter().filter(|kind| any(&|joint| joint.kind == *kind)).map(constraints);
        let kinds: String = kinds.collect();
        let is_used = |one: &&EffectEntry| {
            let mut used = self.effects().chain(file.effects().map(|(effect, _)| effect));
            used.any(|effect| effect.key == one.key)
        };
        let effects: String = EFFECTS.iter().filter(is_used).map(|effect| effect.derived.0).collect();
        let tide = file.gravity_gradient.map_or("", |_| Tide::DERIVATION);
        format!("{}{gravity}{tide}{effects}{springs}{cords}{terms}{balls}{kinds}", HeavyBody::DERIVATION)
    }
}
