//! Right declarations that look strange: each expands without an error.

use super::{expanded, is_refused};

const ITEM: &str = "struct Top { J_d: NonstandardInertia, m: f64, rho: Vector3<f64>, up: Vector3<f64> }";
const KINETIC: &str = "((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)";

/// The message, where there is one.
fn refusal(l_d: &str) -> Option<String> {
    let arguments = format!("group = SO3, advected(w = up), l_d = {l_d}");
    let expansion = expanded(&arguments, ITEM);
    let text = expansion.to_string();
    is_refused(&expansion).then(|| text.split("compile_error").nth(1).unwrap_or_default().chars().take(200).collect())
}

fn assert_right(terms: &[&str]) {
    for term in terms {
        assert_eq!(refusal(&format!("{KINETIC} - {term} - h * m * w.dot(&rho)")), None, "{term}");
    }
}

#[test]
fn near_a_pole() {
    assert_right(&[
        "0.5 * h * m * (w.dot(&rho).powi(-1) + w.dot(&(F * rho)).powi(-1))",
        "0.5 * h * m * (w.dot(&rho).powi(-3) + w.dot(&(F * rho)).powi(-3))",
        "h * m / w.dot(&rho)",
        "h * m / (w.dot(&rho) - 1.0)",
        "h / (m - 1.0) * w.dot(&rho)",
    ]);
}

#[test]
fn off_a_domain() {
    assert_right(&[
        "h * m * w.dot(&rho).ln()",
        "h * m * (w.dot(&(F * rho))).ln()",
        "h * (1.0 - m).sqrt() * w.dot(&rho)",
        "h * (m - 0.9).ln() * w.dot(&rho)",
        "h * (-m).sqrt() * w.dot(&rho)",
        "h * (w.dot(&(F * rho)) - m - 5.0).sqrt()",
        "h * (m - 20.0).ln() * w.dot(&rho)",
        "h * (0.01 - m).ln() * w.dot(&rho)",
    ]);
}

#[test]
fn steep() {
    let square = "let a = F * F; let b = a * a; let c = b * b; let d = c * c; let e = d * d; let f = e * e;";
    assert_right(&[&format!("{{ {square} h * m * w.dot(&(f * f * rho)) }}"), "h * (20.0 * w.dot(&(F * rho))).sin()"]);
}

/// References, however they are come by.
#[test]
fn by_reference() {
    assert_right(&[
        "{ let a = &rho; h * m * w.dot(a) }",
        "{ let a = &rho; let b = &a; h * m * w.dot(&a) + h * m * w.dot(b) }",
        "h * m * w.dot(&&rho)",
        "{ let a = { &rho }; h * m * w.dot(a) }",
        "h * m * w.dot((&rho))",
        "{ let a = vee(F); h * m * w.dot(&a) + h * vee({ F }).dot(&w) }",
    ]);
}

/// Each order in `h` is right, or says that it is meant.
#[test]
fn of_unusual_orders() {
    assert_right(&[
        // A constant, of any order.
        "h * m",
        "J_d.trace() / h",
        "m",
        // A potential of both ends, by its difference.
        "0.5 * h * m * (w.dot(&(F * rho)) - w.dot(&rho))",
        "h * m * w.dot(&(F * rho - rho))",
        // Linear in the velocity.
        "m * vee(F).dot(&rho)",
        "w.dot(&((F - I) * rho))",
        "(w.dot(&(F * rho)) - w.dot(&rho))",
        // Corrections.
        "h.powi(2) * m * w.dot(&rho)",
        "h.powi(3) * m * w.dot(&rho).powi(2)",
        "h.powi(3) * (vee(F).dot(&rho) / h).powi(2)",
        "vee(F).dot(&rho).powi(4) / h",
        // Another energy from the same.
        "h * m * (w - rho).norm_squared()",
        "h * (m * w.dot(&(F * rho))).exp()",
        "h * (F[(2, 2)] * m).exp()",
        // Zero, as a macro may write it.
        "0.0 * w.dot(&rho)",
    ]);
    // Multiplied out, with parts that are constant or cancel.
    for kinetic in [
        "-(F * J_d).trace() / h",
        "J_d.trace() / h - (F * J_d).trace() / h",
        "(J_d.trace() - (F * J_d).trace()) / h",
        "J_d.trace() / (2.0 * h) - (F * J_d).trace() / h + (F * J_d * F.transpose()).trace() / (2.0 * h)",
        "h * ((J_d.trace() - (F * J_d).trace()) / (h * h) - m * w.dot(&rho))",
        "log(F).dot(&(J_d * log(F))) / (2.0 * h)",
        "((F - I) * J_d * (F - I).transpose()).trace() / h / (2.0 - 0.0 * h)",
    ] {
        assert_eq!(refusal(&format!("{kinetic} - h * m * w.dot(&rho)")), None, "{kinetic}");
    }
}

/// Of what another body sees and of what is advected, `log` and `exp`; and a body's place with its attitude, twice.
#[test]
fn functions_of_what_is_seen() {
    let assert_accepted = |what: &str, arguments: &str, fields: &[&str]| {
        let is_used = |field: &&&str| {
            let name = field.split(':').next();
            arguments.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| Some(word) == name)
        };
        let fields: Vec<&str> = fields.iter().filter(is_used).copied().collect();
        let expansion = expanded(arguments, &format!("struct Body {{ {} }}", fields.join(", ")));
        assert!(!is_refused(&expansion), "{what}: {expansion}");
    };
    let fields =
        ["J_d: NonstandardInertia", "B: NonstandardInertia", "m: f64", "rho: Vector3<f64>", "up: Vector3<f64>"];
    let square = |f: &str, j: &str| format!("(({f} - I) * {j} * ({f} - I).transpose()).trace() / (2.0 * h)");
    for u in
        ["log(Q).norm_squared()", "log(Q).dot(&rho)", "log(F_1.transpose() * Q * F_2).norm_squared()", "log(Q).norm()"]
    {
        let kinetic = square("F_1", "J_d") + " + " + &square("F_2", "B");
        let seen = "group(F_1 = SO3, F_2 = SO3), advected(Q = F_2.seen_from(F_1))";
        assert_accepted(u, &format!("{seen}, l_d = {kinetic} - h * m * {u}"), &fields);
    }
    for u in ["exp(w)[(0, 2)]", "exp(w).trace()", "exp(0.1 * w.cross(&rho))[(0, 2)]", "w.norm().sqrt().sin()"] {
        let kinetic = square("F", "J_d");
        assert_accepted(u, &format!("group = SO3, advected(w = up), l_d = {kinetic} - h * m * {u}"), &fields);
    }
    let both = "group(F = SO3, d = R3), advected(R = F.seen_from(space), x = d.seen_from(space))";
    let turning = "0.5 * (hat(O) * J_d * hat(O).transpose()).trace()";
    for u in ["(x + R * rho).norm_squared()", "(x + R * rho - up).norm_squared()", "(x + R * rho).norm()"] {
        let l_d = square("F", "J_d") + " + 0.5 * m * d.norm_squared() / h";
        assert_accepted(u, &format!("{both}, l_d = {l_d} - h * m * {u}"), &fields);
        let l = format!("{turning} + 0.5 * m * v.norm_squared() - m * {u}");
        assert_accepted(u, &format!("{both}, velocity(O, v), l = {l}, discretise = trapezoid"), &fields);
    }
    let about_another_point = "0.5 * m * (v + R * O.cross(&rho)).norm_squared() - m * (x + R * rho).z";
    let l = format!("{turning} + {about_another_point}");
    assert_accepted(&l, &format!("{both}, velocity(O, v), l = {l}, discretise = trapezoid(Cayley)"), &fields);
}
