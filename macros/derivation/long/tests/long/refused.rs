//! Right declarations that earlier versions refused, and advice that is accepted.

use liestep_derivation::mathematics::group::{NAMES, built_in};

use crate::common::{expanded, message, struct_of};

const KINETIC: &str = "((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)";

/// A declaration on these fields: its arguments and its struct.
fn with(fields: &[&str], arguments: String) -> [String; 2] {
    let item = struct_of(fields, &arguments);
    [arguments, item]
}

const FIELDS: [&str; 7] = [
    "J_d: NonstandardInertia",
    "B: NonstandardInertia",
    "m: f64",
    "k: f64",
    "rho: Vector3<f64>",
    "up: Vector3<f64>",
    "place: Vector3<f64>",
];

fn square(f: &str, j: &str) -> String {
    format!("(({f} - I) * {j} * ({f} - I).transpose()).trace() / (2.0 * h)")
}

/// Potentials with `log` and `exp` of relative configurations and of advected matrices; and a body's position beside
/// its attitude.
fn functions_of_what_is_seen() -> Vec<[String; 2]> {
    let mut all = Vec::new();
    for u in
        ["log(Q).norm_squared()", "log(Q).dot(&rho)", "log(F_1.transpose() * Q * F_2).norm_squared()", "log(Q).norm()"]
    {
        let kinetic = square("F_1", "J_d") + " + " + &square("F_2", "B");
        let seen = "group(F_1 = SO3, F_2 = SO3), advected(Q = F_2.seen_from(F_1))";
        all.push(format!("{seen}, l_d = {kinetic} - h * m * {u}"));
    }
    for u in ["exp(w)[(0, 2)]", "exp(w).trace()", "exp(0.1 * w.cross(&rho))[(0, 2)]", "w.norm().sqrt().sin()"] {
        all.push(format!("group = SO3, advected(w = up), l_d = {KINETIC} - h * m * {u}"));
    }
    let both = "group(F = SO3, d = R3), advected(R = F.seen_from(space), x = d.seen_from(space))";
    let turning = "0.5 * (hat(O) * J_d * hat(O).transpose()).trace()";
    for u in ["(x + R * rho).norm_squared()", "(x + R * rho - up).norm_squared()", "(x + R * rho).norm()"] {
        all.push(format!("{both}, l_d = {KINETIC} + 0.5 * m * d.norm_squared() / h - h * m * {u}"));
        let l = format!("{turning} + 0.5 * m * v.norm_squared() - m * {u}");
        all.push(format!("{both}, velocity(O, v), l = {l}, discretise = trapezoid"));
    }
    let about_another_point = "0.5 * m * (v + R * O.cross(&rho)).norm_squared() - m * (x + R * rho).z";
    all.push(format!("{both}, velocity(O, v), l = {turning} + {about_another_point}, discretise = trapezoid(Cayley)"));
    all.into_iter().map(|arguments| with(&FIELDS, arguments)).collect()
}

/// Lagrangians `l_d` that are smooth: their limit needn't be quadratic in the velocity, nor `h` stand in powers alone.
fn of_any_degree() -> Vec<[String; 2]> {
    let kinetic = [
        "-h * (1.0 - ((F - I) * J_d * (F - I).transpose()).trace() / (h * h)).sqrt()",
        "-(h * h - ((F - I) * J_d * (F - I).transpose()).trace()).sqrt()",
        "{ let u = vee(F) / h; -h * (1.0 - u.dot(&(J_d * u))).sqrt() }",
        "{ let q = vee(F).dot(&(J_d * vee(F))); q / (2.0 * h) + q.powi(2) / (8.0 * h.powi(3)) }",
        "{ let q = log(F).dot(&(J_d * log(F))); m * q / h + m * q.powi(3) / h.powi(5) }",
        "h * (1.0 + vee(F).dot(&(J_d * vee(F))) / h.powi(2)).ln()",
        "h * ((J_d.trace() - (F * J_d).trace()) / h.powi(2)).exp()",
        "J_d.trace() * vee(F).norm_squared() / (h + h.powi(3))",
        "8.0 * vee(F).dot(&(J_d * vee(F))) / (h * (1.0 + F.trace()).powi(2))",
        "{ let s = 1.0 + F.trace(); 8.0 * vee(F).dot(&(J_d * vee(F))) / (h * s.powi(2)) }",
    ];
    let of = |kinetic| format!("group = SO3, advected(w = up), l_d = {kinetic} - h * m * w.dot(&rho)");
    kinetic.into_iter().map(|kinetic| with(&FIELDS, of(kinetic))).collect()
}

/// Squares written as products are squares.
fn squares_as_products() -> Vec<[String; 2]> {
    let spring = "group(F = SO3, d = R1), advected(w = up.seen_from(F), s = d.seen_from(space))";
    let l = |potential: &str| {
        let kinetic = "0.5 * (hat(O) * J_d * hat(O).transpose()).trace() + 0.5 * m * u * u";
        format!("{spring}, velocity(O, u), l = {kinetic} - {potential}")
    };
    let l_d = |potential: &str| format!("{spring}, l_d = {KINETIC} + m * d * d / (2.0 * h) - {potential}");
    let all = [
        l("0.5 * k * s * s - s * w.dot(&rho)") + ", discretise = trapezoid",
        l("0.5 * k * s * (s + 1.0) - s * w.dot(&rho)") + ", discretise = chord",
        l_d("0.25 * h * k * (s * s + (s + d) * (s + d)) - h * w.dot(&rho)"),
        l_d("0.125 * h * k * (2.0 * s + d) * (2.0 * s + d) - h * w.dot(&rho)"),
    ];
    all.map(|arguments| with(&FIELDS, arguments)).into()
}

/// The trace of the thesis on each group, one of four rows among them, discretised by a rule.
fn trace_by(rule: &str) -> Vec<[String; 2]> {
    let affine = "Sim2, generators = [[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]]";
    let groups = NAMES.map(|name| (name, built_in(name).expect("a group").size)).into_iter().chain([(affine, 3)]);
    let of_group = |(group, rows): (&str, usize)| {
        let fields = ["J: SMatrix<f64, N, N>", "r: SVector<f64, N>", "up: SVector<f64, N>"];
        let fields = fields.map(|field| field.replace('N', &rows.to_string()));
        let l = "0.5 * (hat(xi) * J * J.transpose() * hat(xi).transpose()).trace() - w.dot(&r)";
        let arguments = format!("group = {group}, velocity = xi, advected(w = up), l = {l}, discretise = {rule}");
        with(&fields.each_ref().map(String::as_str), arguments)
    };
    groups.map(of_group).collect()
}

const BY_CAYLEY: [&str; 2] = ["trapezoid(Cayley)", "chord(Cayley)"];

/// The trace of the thesis is accepted in each discretisation, or refused with advice that is accepted.
#[test]
fn no_circle_of_advice() {
    for rule in ["trapezoid", "trapezoid(exp)", "chord", "chord(exp)", "midpoint(exp)"] {
        for [arguments, item] in trace_by(rule) {
            if let Some(text) = message(&arguments, &item) {
                let is_advice = |advice| text.contains(&format!("write `{advice}`"));
                assert!(BY_CAYLEY.into_iter().any(is_advice), "{arguments}: {text}");
            }
        }
    }
}

/// Two bodies of three points that attract each other, in one expression.
fn many_norms() -> [String; 2] {
    let inverse = |a: usize, b: usize, at: &str| match at {
        "w" => format!("1.0 / (x + Q * b_{b} - a_{a}).norm()"),
        _ => format!("1.0 / (x + d - F_1 * a_{a} + Q * F_2 * b_{b}).norm()"),
    };
    let pairs = (1..=3).flat_map(|a| (1..=3).map(move |b| (a, b)));
    let sum: Vec<String> = pairs.flat_map(|(a, b)| [inverse(a, b, "w"), inverse(a, b, "F")]).collect();
    let declaration = format!(
        "group(F_1 = SO3, F_2 = SO3, d = R3), advected(Q = F_2.seen_from(F_1), x = place.seen_from(F_1)),
        l_d = {} + {} + m * d.norm_squared() / (2.0 * h) + 0.5 * h * k * ({})",
        square("F_1", "J_d"),
        square("F_2", "B"),
        sum.join(" + ")
    );
    let points = ["a_1", "a_2", "a_3", "b_1", "b_2", "b_3"].map(|name| format!("{name}: Vector3<f64>"));
    with(&[&FIELDS[..], &points.each_ref().map(String::as_str)].concat(), declaration)
}

/// Declarations of each kind that earlier versions refused.
pub(crate) fn once_refused() -> Vec<[String; 2]> {
    let by_cayley = BY_CAYLEY.map(trace_by).concat();
    [functions_of_what_is_seen(), of_any_degree(), squares_as_products(), by_cayley, vec![many_norms()]].concat()
}

#[test]
fn what_was_once_refused_is_certified() {
    for [arguments, item] in once_refused() {
        let text = expanded(&arguments, &item).to_string();
        let is_certified = text.contains("are identities; a wrong one would pass") && !text.contains("not certified");
        assert!(is_certified, "{arguments}: {text}");
    }
}
