//! Right declarations that look strange: each expands without an error.

use crate::common::message;

const ITEM: &str = "struct Top { J_d: NonstandardInertia, m: f64, rho: Vector3<f64>, up: Vector3<f64> }";
const KINETIC: &str = "((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)";

/// The message, where there is one.
fn refusal(l_d: &str) -> Option<String> {
    message(&format!("group = SO3, advected(w = up), l_d = {l_d}"), ITEM)
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

/// A term that is zero at `F = I`, for some parameters or by a number is one, and so are two that cancel beside others.
#[test]
fn zero_here_and_there() {
    assert_right(&[
        "0.5 * h * (F - I).norm_squared() * w.dot(&rho)",
        "h * w.cross(&rho).dot(&vee(F))",
        "h * (w.norm_squared() - 1.0)",
        "h * (m - 1.0) * w.dot(&rho)",
        "(1.0 - 1.0) * (F - I).norm_squared() / h",
        "{ let off = 0.0; off * h * w.dot(&(F * rho)) }",
        "(F * J_d).trace() / h + (J_d * F.transpose()).trace() / h",
    ]);
    // Of another group, where no trace is zero, and of a plain matrix.
    let item = "struct Planar { J: Matrix3<f64>, r: Vector3<f64>, up: Vector3<f64> }";
    for term in ["((F - I) * J * (F + I).transpose()).trace() * h", "h * w.dot(&(F * r))"] {
        let kinetic = "((F - I) * J * J.transpose() * (F - I).transpose()).trace() / h";
        assert_eq!(
            message(&format!("group = SE2, advected(w = up), l_d = {kinetic} - {term} - h * w.dot(&r)"), item),
            None
        );
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
