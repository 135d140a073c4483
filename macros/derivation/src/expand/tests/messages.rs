//! Mistakes by their messages, where what the message underlines is plain.

use super::tokens;
use crate::declared::Role;

/// The messages of an expansion.
fn messages(role: Role, arguments: &str, item: &str) -> Vec<String> {
    let text = crate::expand::expand(role, tokens(arguments), &tokens(item)).to_string();
    let messages = text.split("compile_error ! {").skip(1).map(|rest| rest.split('}').next().unwrap_or_default());
    messages.map(|message| message.trim().trim_matches('"').to_owned()).collect()
}

/// Each mistake has one message.
#[test]
fn of_mistakes() {
    let item = "struct Top { J_d: NonstandardInertia }";
    let kinetic = "((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)";
    let l_d = |rest: &str| (Role::Lagrangian, format!("group = SO3, l_d = {kinetic} {rest}"), item);
    let l = |rest: &str| {
        (
            Role::Lagrangian,
            format!("group = SO3, velocity = u, l = 0.5 * k * u.dot(&u) {rest}"),
            "struct Top { k: f64 }",
        )
    };
    let torque = "struct Torque { tau: Vector3<f64> }";
    let work = |work: &str| (Role::Force, format!("group = SO3, work = {work}"), torque);
    let given = "struct Top { J_d: NonstandardInertia, up: Tensor<f64> }";
    let pull = format!("group = SO3, advected(w = up), l_d = {kinetic} - h * w.z");
    let line = "struct Top { J_d: NonstandardInertia, v: SVector<f64, 1> }";
    let mut wrong = Vec::new();
    for ((role, arguments, item), expected) in [
        ((Role::Lagrangian, pull, given), "this type has no meaning"),
        (l_d(", given(u = missing)"), "the struct has no field `missing`"),
        (l_d("+ { const A: f64 = 1.0; h * A * F.trace() }"), "only `let name = …;` may stand before"),
        (l_d("+ { use std::f64::consts::PI; h * PI * F.trace() }"), "only `let name = …;` may stand before"),
        (l(", discretise = trapezoid()"), "write a retraction, `trapezoid(Cayley)` or `trapezoid(exp)`"),
        (l(" / (u - u).norm_squared()"), "this is zero whatever the parameters"),
        (l_d(", gradient"), "did you mean `gradients`?"),
        (l_d("; advected(w = up)"), "a comma stands between arguments"),
        (l_d(",, gradients"), "there is one comma too many"),
        (l_d(", crate = 3"), "write where liestep is found"),
        (l_d("- h.ln() * h * F.trace()"), "take the `h` out of the root or the logarithm"),
        (work("h * tau.dot(&eta) * h.ln()"), "take the `h` out of the root or the logarithm"),
        (l_d("- h F.trace()"), "a comma is missing before this, or within an expression an operator"),
        (
            (Role::Lagrangian, format!("group = SO3, l_d = {kinetic} - h * v.x * F.trace()"), line),
            "write an entry by its index, `v[0]`",
        ),
        (work("0.5 * h * tau.dot(&(eta - eta))"), "this work is zero whatever the parameters"),
        (work("0.0 * h * tau.dot(&eta)"), "this work is zero whatever the parameters"),
    ] {
        let found = messages(role, &arguments, item);
        if found.len() != 1 || !found[0].contains(expected) {
            wrong.push((arguments, found));
        }
    }
    let of_bodies = |advected: &str, zero: &str| {
        let bodies = "group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3)";
        let arguments = format!("{bodies}, advected({advected}), zero = {zero}");
        (Role::Constraint, arguments, "struct Joint { a: Vector3<f64>, b: Vector3<f64> }")
    };
    let attitudes = "R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space)";
    let place = "R_1 = F_1.seen_from(space), r = d_2.seen_from(d_1), Q = F_2.seen_from(F_1)";
    let sum = "group(F = SO3, d = R3), displacement(e, s), work = h * tau.dot(&(e + 2.0 * s))".to_owned();
    for ((role, arguments, item), expected) in [
        ((Role::Force, sum, torque), "a turn can't be added to a shift"),
        (of_bodies(attitudes, "(R_1 * R_2 * a).dot(&b)"), "write `R_1.transpose()`"),
        (of_bodies(place, "R_1 * r - Q * a"), "`R_1` brings vectors the other way: write `R_1.transpose()`"),
        (of_bodies(place, "R_1.transpose() * (r - Q * a) - b"), "bring one over, `r - R_1 * …`"),
        (
            of_bodies("R_1 = F_1.seen_from(space), y = d_3.seen_from(space)", "(R_1 * a).dot(&y)"),
            "`d_3` is neither a field",
        ),
        (of_bodies("y = d_2.seen_from(space)", "y.z - a.dot(&b)"), "is on space as the body above"),
        (
            (Role::Constraint, "group = SO3, advected(y = d_2.seen_from(d_1)), zero = y.z".to_owned(), torque),
            "a constraint is on two bodies",
        ),
    ] {
        let found = messages(role, &arguments, item);
        if found.len() != 1 || !found[0].contains(expected) {
            wrong.push((arguments, found));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    let tensor = "struct Top { J_d: NonstandardInertia, k: f64, v: Tensor<f64> }";
    let found = messages(Role::Lagrangian, &format!("group = SO3, l_d = {kinetic}"), tensor);
    assert!(found[0].contains("MixedTensor"), "{found:#?}");
}

/// A group whose generators are a mistake is said to be one once.
#[test]
fn of_a_group() {
    let group = crate::expand::matrix_group(tokens("pub type Large = [[[1.0], [2.0]]];")).to_string();
    assert!(group.contains("macro_rules ! __liestep_Large") && group.contains("compile_error"), "{group}");
}
