//! A tour of plausible declarations: what is right is accepted, and what is wrong is told once, in these words.
//!
//! Kinetic parts, potentials and forces are combined, so that a mistake in one is found whatever stands beside it. The
//! files of trybuild show the places of mistakes; here are more of them, and no compiler is asked.

use super::{is_refused, tokens};
use crate::declared::Role;

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

/// Kinetic parts that are wrong, and the beginning of what is said.
const WRONG_BODIES: [(&str, &str); 6] = [
    ("(F * J_d * F.transpose()).trace() / (2.0 * h)", "this is the same for all `F`, so it does nothing"),
    (
        "((F - I) * J_d * (F - I).transpose()).trace() / 2.0",
        "this vanishes like h^2 as h → 0: a kinetic part goes like `h`",
    ),
    (
        "((F - I) * J_d * (F - I).transpose()).trace() * h",
        "this vanishes like h^3 as h → 0: a kinetic part goes like `h`",
    ),
    ("((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h * h)", "a term with `F` goes like h^-2"),
    (
        "((F - I) * J_d * (F - I)).trace() / (2.0 * h)",
        "the kinetic part is negative: check its sign, and the `.transpose()`",
    ),
    ("(F - I).norm() * A.trace() / h", "the kinetic part has no second derivative at `F = I`"),
];

/// Potentials that are wrong.
const WRONG_POTENTIALS: [(&str, &str); 19] = [
    ("0.5 * m * w.dot(&(rho + F * rho))", "this goes like 1 as h → 0: a potential goes like `h`"),
    ("m * w.dot(&rho) / h", "this goes like 1/h as h → 0: a potential goes like `h`"),
    ("h * h * m * w.dot(&rho)", "this vanishes like h^2 as h → 0: a potential goes like `h`"),
    ("h * m * (F - I).norm()", "this is the root or the logarithm of what is zero at `F = I`"),
    ("h * m * log(F).norm()", "this is the root or the logarithm of what is zero at `F = I`"),
    ("h * m / (3.0 - F.trace())", "this divisor is zero at `F = I`"),
    ("h * 0.0 / 0.0 * w.dot(&rho)", "this is zero whatever the parameters"),
    ("h * m * u.dot(&rho)", "`u` isn't known here: make it a field of the struct"),
    ("h * m * up.dot(&rho)", "`up` is the spatial value of `w`: write `w`"),
    ("h * m * w.dot(&(rho * F))", "a vector of 3 can't be multiplied by a 3 × 3 matrix"),
    ("h * m * rho.tan()", "`tan` isn't known in a Lagrangian: write the sine over the cosine"),
    ("h * m.abs()", "`abs` isn't smooth"),
    ("h * tan(m)", "`tan` isn't known in a Lagrangian: write the sine over the cosine"),
    ("h * m.powf(0.5)", "`powf` isn't known in a Lagrangian: write `x.powi(2)`"),
    ("h * m * F.inverse().trace()", "`inverse` is a function: write `inverse(F)`"),
    ("h * PI * m", "`PI` isn't known here: make it a field of the struct, or write `3.14159"),
    ("2 * h * m * w.dot(&rho)", "write `2.0`"),
    ("h * m * F.trace", "`trace` is a method: write `.trace()`"),
    ("h * m * w[3]", "there is no such entry in a vector of 3"),
];

/// Work that is right.
const WORKS: [&str; 4] = [
    "0.5 * h * m * rho.dot(&(eta + eta_next))",
    "-0.5 * m * vee(F).dot(&(eta + eta_next))",
    "h * w.cross(&rho).dot(&eta)",
    "-m * (A * log(F)).dot(&eta_next)",
];

/// Work that is wrong.
const WRONG_WORKS: [(&str, &str); 5] = [
    ("0.5 * rho.dot(&(eta + eta_next))", "this goes like 1 as h → 0: virtual work goes like `h`"),
    ("m * vee(F).dot(&eta) / h", "this goes like 1 as h → 0: virtual work goes like `h`"),
    ("h * rho.dot(&eta) / h.powi(2)", "this goes like 1/h as h → 0: virtual work goes like `h`"),
    ("h * rho.dot(&eta).powi(2)", "virtual work is linear in the displacements"),
    ("h * m * rho.dot(&F)", "`dot` needs two vectors of one size"),
];

/// What is told in another way where something stands beside it.
const ALONE: [(Role, &str, &str); 5] = [
    (
        Role::Lagrangian,
        "(F - I) * J_d * (F - I).transpose() / (2.0 * h)",
        "a Lagrangian is a scalar, but this is a 3 × 3",
    ),
    (Role::Lagrangian, "h * m * F.trace() / (m - m)", "this is zero whatever the parameters"),
    (Role::Lagrangian, "h * m", "the Lagrangian doesn't depend on `F`"),
    (Role::Force, "h * m * rho.dot(&rho)", "virtual work needs a displacement"),
    (Role::Force, "h * m * eta", "virtual work is a scalar, but this is a vector of 3"),
];

const FIELDS: [(&str, &str); 5] = [
    ("J_d", "J_d: NonstandardInertia"),
    ("A", "A: Matrix3<f64>"),
    ("m", "m: f64"),
    ("rho", "rho: Vector3<f64>"),
    ("w", "up: Vector3<f64>"),
];

/// The expansion of an expression, in a struct of the fields that it names.
fn declared(role: Role, expression: &str) -> proc_macro2::TokenStream {
    let names: Vec<&str> = expression.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    let is_used = |name: &str| names.contains(&name) || (name == "w" && names.contains(&"up"));
    let fields: Vec<&str> = FIELDS.iter().filter(|(name, _)| is_used(name)).map(|(_, field)| *field).collect();
    let advected = if is_used("w") { "advected(w = up)," } else { "" };
    let arguments = format!("group = SO3, {advected} {} = {expression}", role.key());
    let item = tokens(&format!("struct Tour {{ {} }}", fields.join(", ")));
    super::super::expand(role, tokens(&arguments), &item)
}

fn messages(expansion: &proc_macro2::TokenStream) -> Vec<String> {
    let text = expansion.to_string();
    let parts = text.split("compile_error ! { \"").skip(1);
    parts.filter_map(|part| part.split("\" }").next()).map(|message| message.replace("\\\"", "\"")).collect()
}

#[track_caller]
fn assert_accepted(role: Role, expression: &str) {
    let expansion = declared(role, expression);
    assert!(!is_refused(&expansion), "{expression}: {:?}", messages(&expansion));
}

/// It is told once, and so.
#[track_caller]
fn assert_told(role: Role, expression: &str, words: &str) {
    let found = messages(&declared(role, expression));
    assert!(found.len() == 1 && found[0].starts_with(words), "{expression}: {found:?}");
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

#[test]
fn what_is_wrong_is_told_once() {
    let ([body, ..], [potential, ..]) = (BODIES, POTENTIALS);
    for (wrong, words) in WRONG_BODIES {
        assert_told(Role::Lagrangian, wrong, words);
        assert_told(Role::Lagrangian, &format!("{wrong} - {potential}"), words);
    }
    for (wrong, words) in WRONG_POTENTIALS {
        assert_told(Role::Lagrangian, wrong, words);
        assert_told(Role::Lagrangian, &format!("{body} - {wrong}"), words);
    }
    for (role, wrong, words) in ALONE {
        assert_told(role, wrong, words);
    }
    for (wrong, words) in WRONG_WORKS {
        assert_told(Role::Force, wrong, words);
        assert_told(Role::Force, &format!("{} + {wrong}", WORKS[0]), words);
    }
}
