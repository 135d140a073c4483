//! A tour of plausible declarations: what is right is accepted. `mistakes/tour.txt` has what is wrong, alone and with
//! another term beside it.

use crate::common::{is_refused, struct_of, tokens};
use liestep_derivation::declared::Role;

/// Kinetic parts that are right.
const BODIES: [&str; 6] = [
    "((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)",
    "{ let d = F - I; (d * J_d * d.transpose()).trace() * 0.5 / h }",
    "((I - F).transpose() * (I - F) * A).trace() / (2.0 * h)",
    "(J_d.trace() - (F * J_d).trace()) / h",
    "0.5 / h * log(F).dot(&(A * log(F)))",
    "vee(F).dot(&(A * vee(F))) / (2.0 * h)",
];

/// Potentials that are right.
const POTENTIALS: [&str; 9] = [
    "0.5 * h * m * w.dot(&(rho + F * rho))",
    "h * m * w.dot(&rho)",
    "0.5 * h * m * (w.dot(&rho).powi(-1) + w.dot(&(F * rho)).powi(-1))",
    "h * m / (w - rho).norm()",
    "h * m * (2.0 + w.dot(&rho)).ln()",
    "h * (m - 0.9).sqrt() * w.dot(&(F * rho))",
    "h * m * (w.dot(&rho)).sin().exp()",
    "m * w.dot(&((F - I) * rho))",
    "h.powi(3) * m * w.dot(&rho)",
];

/// Work that is right.
const WORKS: [&str; 4] = [
    "0.5 * h * m * rho.dot(&(eta + eta_next))",
    "-0.5 * m * vee(F).dot(&(eta + eta_next))",
    "h * w.cross(&rho).dot(&eta)",
    "-m * (A * log(F)).dot(&eta_next)",
];

const FIELDS: [&str; 5] =
    ["J_d: NonstandardInertia", "A: Matrix3<f64>", "m: f64", "rho: Vector3<f64>", "up: Vector3<f64>"];

/// The expansion of an expression, in a struct of the fields that it names.
fn declared(role: Role, expression: &str) -> proc_macro2::TokenStream {
    let is_seen = expression.split(|c: char| !c.is_alphanumeric()).any(|name| name == "w");
    let advected = if is_seen { "advected(w = up)," } else { "" };
    let arguments = format!("group = SO3, {advected} {} = {expression}", role.key());
    liestep_derivation::expand(role, tokens(&arguments), &tokens(&struct_of(&FIELDS, &arguments)))
}

#[track_caller]
fn assert_accepted(role: Role, expression: &str) {
    let expansion = declared(role, expression);
    assert!(!is_refused(&expansion), "{expression}: {expansion}");
}

#[test]
fn what_is_right_is_accepted() {
    let [body, ..] = BODIES;
    for other in BODIES {
        assert_accepted(Role::Lagrangian, other);
    }
    for potential in POTENTIALS {
        assert_accepted(Role::Lagrangian, &format!("{body} - ({potential})"));
        assert_accepted(Role::Lagrangian, potential);
    }
    for work in WORKS {
        assert_accepted(Role::Force, work);
    }
}
