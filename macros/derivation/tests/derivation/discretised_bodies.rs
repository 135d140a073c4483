//! What `discretise` makes of continuous Lagrangians of several bodies, against what is typed.

use crate::common::bodies::{LINKS, OF_LINKS};
use crate::common::{expanded, is_refused, is_self_adjoint};
use crate::continuous::discrete;

/// With the matrices `(F − I)/h` what couples the links is taken at both ends, as typed here; at the second it isn't the
/// adjoint of the first, and so this is refused.
#[test]
fn the_trapezoidal_rule_of_coupled_bodies() {
    let declared = "group(F_1 = SO3, F_2 = SO3),
        advected(w_1 = up.seen_from(F_1), w_2 = up.seen_from(F_2), Q = F_2.seen_from(F_1)),
        l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
            + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
            + 0.5 * ((F_1 - I) * rho).dot(&(Q * ((F_2 - I) * s_2))) / h
            + 0.5 * ((F_1 - I) * rho).dot(&(F_1.transpose() * Q * F_2 * ((F_2 - I) * s_2))) / h
            - 0.5 * h * g * (w_1.dot(&(s_1 + F_1 * s_1)) + w_2.dot(&(s_2 + F_2 * s_2)))";
    let made = format!("{LINKS}, discretise = trapezoid");
    assert_eq!(discrete(&made, OF_LINKS), discrete(declared, OF_LINKS));
    for rule in ["trapezoid", "chord"] {
        let text = expanded(&format!("{LINKS}, discretise = {rule}"), OF_LINKS).to_string();
        assert!(text.contains("isn't its own adjoint") && !text.contains("puts the matrix"), "{rule}: {text}");
    }
}

/// Bodies whose velocities couple by what is fixed alone.
const APART: &str = "group(F_1 = SO3, d = R3, F_2 = SO3, t = R1), velocity(Omega_1, v, Omega_2, u),
    advected(w = up.seen_from(F_2), Q = F_2.seen_from(F_1), r = d.seen_from(space))";
const OF_APART: &str = "struct Apart { J: Inertia, A: Matrix3<f64>, B: Matrix3<f64>, m: f64, s: Vector3<f64>,
    up: Vector3<f64> }";

/// With the matrices `(F − I)/h` both rules are accepted where velocities don't couple by how bodies stand. Each form in
/// which a velocity may stand is what is typed here, of the first body, of another, and beside what is added.
#[test]
fn rules_of_the_matrix_of_several_bodies() {
    let l = "l = 0.5 * Omega_1.dot(&(J * Omega_1)) + 0.5 * (A * Omega_2).dot(&(m * (B * Omega_2)))
        + s.dot(&(A * Omega_2)) + Omega_1.dot(&(s * u)) + u * Omega_2.dot(&s) + v.dot(&(A * Omega_2))
        + 0.5 * (u * Omega_1).dot(&Omega_1) * u + m * v.norm_squared() + 0.5 * m * u.powi(2)
        - w.dot(&s).powi(2) - (Q * A).trace().powi(2) - r.norm_squared()";
    let kinetic = "((F_1 - I) * (0.5 * J.trace() * I - J) * (F_1 - I).transpose()).trace() / (2.0 * h)
        + m * ((F_2 - I) * (0.5 * (A.transpose() * B).trace() * I - A.transpose() * B) * (F_2 - I).transpose()).trace()
            / (2.0 * h)
        + (A.transpose() * s).dot(&vee(F_2)) + t * s.dot(&vee(F_1)) / h + t * s.dot(&vee(F_2)) / h
        + (A.transpose() * d).dot(&vee(F_2)) / h
        + t.powi(2) * ((F_1 - I) * (F_1 - I).transpose()).trace() / (4.0 * h.powi(3))
        + m * d.norm_squared() / h + m * t.powi(2) / (2.0 * h)";
    let ends = "0.5 * h * (w.dot(&s).powi(2) + w.dot(&(F_2 * s)).powi(2))
        + 0.5 * h * ((Q * A).trace().powi(2) + (F_1.transpose() * Q * F_2 * A).trace().powi(2))
        + 0.5 * h * (r.norm_squared() + (r + d).norm_squared())";
    let middle = "h * (0.5 * w.dot(&(s + F_2 * s))).powi(2)
        + h * (0.5 * ((Q + F_1.transpose() * Q * F_2) * A).trace()).powi(2) + h * (r + 0.5 * d).norm_squared()";
    let made = |rule: &str| format!("{APART}, {l}, discretise = {rule}");
    let typed = |potential: &str| {
        let apart = APART.replace("velocity(Omega_1, v, Omega_2, u),", "");
        discrete(&format!("{apart}, l_d = {kinetic} - ({potential})"), OF_APART)
    };
    assert_eq!(discrete(&made("trapezoid"), OF_APART), typed(ends));
    assert_eq!(discrete(&made("chord"), OF_APART), typed(middle));
    assert_ne!(typed(ends), typed(middle));
    for rule in ["trapezoid", "chord"] {
        let expansion = expanded(&made(rule), OF_APART);
        assert!(!is_refused(&expansion), "{rule}: {expansion}");
        assert!(is_self_adjoint(&expansion), "{rule}");
    }
}

/// A velocity that stands elsewhere isn't that of a matrix, and the message names it, its increment, and its forms. What is
/// added isn't a matrix, and may stand anywhere.
#[test]
fn velocities_that_no_matrix_stands_for() {
    let of = |term: &str| {
        let l = "l = 0.5 * Omega_1.dot(&(J * Omega_1)) + 0.5 * Omega_2.dot(&(A * (B * Omega_2))) + m * v.norm_squared()
            + 0.5 * m * u.powi(2) - w.dot(&s) - (Q * A).trace() - r.norm_squared()";
        expanded(&format!("{APART}, {l} + {term}, discretise = trapezoid"), OF_APART).to_string()
    };
    for (term, increment, velocity) in [
        ("Omega_1.cross(&s).norm_squared()", "F_1", "Omega_1"),
        ("Omega_2.x.powi(2)", "F_2", "Omega_2"),
        ("Omega_1.dot(&(Q * Omega_2))", "F_1", "Omega_1"),
        ("s.dot(&Omega_1) * Omega_2.x", "F_2", "Omega_2"),
    ] {
        let text = of(term);
        let place = format!("puts the matrix `({increment} - I) / h` in the place of the velocity `{velocity}`");
        let forms =
            format!("`hat({velocity})`, in `{velocity}.dot(&(J * {velocity}))` or in `s.dot(&{velocity})` alone");
        assert!(text.contains(&place) && text.contains(&forms), "{term}: {text}");
        assert!(!text.contains("isn't its own adjoint"), "{term}: {text}");
    }
    let text = of("v.cross(&s).norm_squared() * (1.0 + u.powi(2)).sqrt()");
    assert!(!text.contains("compile_error"), "{text}");
}

/// Of what is added, in the middle and at both ends, as typed.
#[test]
fn rules_of_what_is_added() {
    let parameters = "struct Places { m: f64, k: f64 }";
    let group = "group(d_1 = R3, d_2 = R3, t = R1)";
    let seen = "advected(r = d_2.seen_from(d_1), x = t.seen_from(space))";
    let l = "l = 0.5 * m * (v_1.norm_squared() + v_2.norm_squared() + u.powi(2))
        - k * r.norm_squared().powi(2) - x.powi(2) * r.x";
    let kinetic = "0.5 * m * (d_1.norm_squared() + d_2.norm_squared() + t.powi(2)) / h";
    let potential = |r: &str, x: &str| format!("(k * ({r}).norm_squared().powi(2) + ({x}).powi(2) * ({r}).x)");
    let [now, next] = [potential("r", "x"), potential("r + d_2 - d_1", "x + t")];
    let ends = format!("0.5 * h * ({now} + {next})");
    let middle = format!("h * {}", potential("r + 0.5 * (d_2 - d_1)", "x + 0.5 * t"));
    for (rule, expected) in [
        ("trapezoid", &ends),
        ("trapezoid(Cayley)", &ends),
        ("trapezoid(exp)", &ends),
        ("midpoint(exp)", &middle),
        ("chord", &middle),
        ("chord(Cayley)", &middle),
        ("chord(exp)", &middle),
    ] {
        let made = format!("{group}, velocity(v_1, v_2, u), {seen}, {l}, discretise = {rule}");
        let typed = format!("{group}, {seen}, l_d = {kinetic} - {expected}");
        assert_eq!(discrete(&made, parameters), discrete(&typed, parameters), "{rule}");
        assert!(is_self_adjoint(&expanded(&made, parameters)), "{rule}");
    }
}
