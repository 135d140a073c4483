//! Right declarations that look strange: each expands without an error.

use super::{expanded, is_refused};
use crate::mathematics::group::{NAMES, built_in};

const ITEM: &str = "struct Top { J_d: NonstandardInertia, m: f64, rho: Vector3<f64>, up: Vector3<f64> }";
const KINETIC: &str = "((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)";

/// The message, where there is one.
fn refusal(l_d: &str) -> Option<String> {
    message(&format!("group = SO3, advected(w = up), l_d = {l_d}"), ITEM)
}

fn message(arguments: &str, item: &str) -> Option<String> {
    let expansion = expanded(arguments, item);
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

/// Any smooth `l_d`: its limit needn't be quadratic in the velocity, nor `h` stand in powers alone.
#[test]
fn of_any_degree() {
    for kinetic in [
        "-h * (1.0 - ((F - I) * J_d * (F - I).transpose()).trace() / (h * h)).sqrt()",
        "-(h * h - ((F - I) * J_d * (F - I).transpose()).trace()).sqrt()",
        "{ let u = vee(F) / h; -h * (1.0 - u.dot(&(J_d * u))).sqrt() }",
        "{ let q = vee(F).dot(&(J_d * vee(F))); q / (2.0 * h) + q.powi(2) / (8.0 * h.powi(3)) }",
        "{ let q = log(F).dot(&(J_d * log(F))); m * q / h + m * q.powi(3) / h.powi(5) }",
        "h * (1.0 + vee(F).dot(&(J_d * vee(F))) / h.powi(2)).ln()",
        "h * ((J_d.trace() - (F * J_d).trace()) / h.powi(2)).exp()",
        "J_d.trace() * vee(F).norm_squared() / (h + h.powi(3))",
        "8.0 * vee(F).dot(&(J_d * vee(F))) / (h * (1.0 + F.trace()).powi(2))",
    ] {
        assert_eq!(refusal(&format!("{kinetic} - h * m * w.dot(&rho)")), None, "{kinetic}");
    }
}

/// A square is one, however it is written.
#[test]
fn squares_as_products() {
    let spring = "group(F = SO3, d = R1), advected(w = up.seen_from(F), s = d.seen_from(space))";
    let item = "struct Bob { J: Inertia, m: f64, k: f64, a: Vector3<f64>, up: Vector3<f64> }";
    let l = |potential: &str| {
        format!("{spring}, velocity(Omega, u), l = 0.5 * Omega.dot(&(J * Omega)) + 0.5 * m * u * u - {potential}")
    };
    let l_d = |potential: &str| {
        let kinetic = "((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) + m * d * d / (2.0 * h)";
        format!("{spring}, l_d = {kinetic} - {potential}")
    };
    for declaration in [
        l("0.5 * k * s * s - s * w.dot(&a)") + ", discretise = trapezoid",
        l("0.5 * k * s * (s + 1.0) - s * w.dot(&a)") + ", discretise = chord",
        l_d("0.25 * h * k * (s * s + (s + d) * (s + d)) - h * w.dot(&a)"),
        l_d("0.125 * h * k * (2.0 * s + d) * (2.0 * s + d) - h * w.dot(&a)"),
    ] {
        assert_eq!(message(&declaration, item), None, "{declaration}");
    }
}

/// Of a vector of one the entry has an index and no letter.
#[test]
fn a_vector_of_one() {
    let item = "struct Top { J_d: NonstandardInertia, v: SVector<f64, 1> }";
    let message = |entry: &str| message(&format!("group = SO3, l_d = {KINETIC} - h * {entry} * F.trace()"), item);
    assert_eq!(message("v[0]"), None);
    assert!(message("v.x").is_some_and(|text| text.contains("write an entry by its index, `v[0]`")));
}

/// The thesis' trace in each discretisation of each group: accepted, or refused with advice that is accepted.
#[test]
fn no_circle_of_advice() {
    let affine = "Sim2, generators = [[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]]";
    let groups = NAMES.map(|name| (name, built_in(name).expect("a group").size));
    for (group, rows) in groups.into_iter().chain([(affine, 3)]) {
        let item = format!(
            "struct Body {{ J: SMatrix<f64, {rows}, {rows}>, r: SVector<f64, {rows}>, up: SVector<f64, {rows}> }}"
        );
        let refusal = |rule: &str| {
            let l = "0.5 * (hat(xi) * J * J.transpose() * hat(xi).transpose()).trace() - w.dot(&r)";
            message(&format!("group = {group}, velocity = xi, advected(w = up), l = {l}, discretise = {rule}"), &item)
        };
        let advice = ["trapezoid(Cayley)", "chord(Cayley)"];
        for rule in advice {
            assert_eq!(refusal(rule), None, "{group}, {rule}");
        }
        for rule in ["trapezoid", "trapezoid(exp)", "chord", "chord(exp)", "midpoint(exp)"] {
            if let Some(text) = refusal(rule) {
                assert!(
                    advice.iter().any(|advice| text.contains(&format!("write `{advice}`"))),
                    "{group}, {rule}: {text}"
                );
            }
        }
    }
}

/// Two bodies of three points that attract each other, in one expression.
#[test]
fn many_norms() {
    let inverse = |a: usize, b: usize, at: &str| match at {
        "w" => format!("1.0 / (x + Q * b_{b} - a_{a}).norm()"),
        _ => format!("1.0 / (x + d - F_1 * a_{a} + Q * F_2 * b_{b}).norm()"),
    };
    let pairs = (1..=3).flat_map(|a| (1..=3).map(move |b| (a, b)));
    let sum: Vec<String> = pairs.flat_map(|(a, b)| [inverse(a, b, "w"), inverse(a, b, "F")]).collect();
    let declaration = format!(
        "group(F_1 = SO3, F_2 = SO3, d = R3), advected(Q = F_2.seen_from(F_1), x = place.seen_from(F_1)),
        l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
            + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
            + 0.5 * h * k * ({})",
        sum.join(" + ")
    );
    let points = ["a_1", "a_2", "a_3", "b_1", "b_2", "b_3"].map(|name| format!("{name}: Vector3<f64>, ")).concat();
    let fields = format!(
        "struct Bodies {{ J_1: NonstandardInertia, J_2: NonstandardInertia, m: f64, k: f64, {points} place: Vector3<f64> }}"
    );
    assert_eq!(message(&declaration, &fields), None);
}
