//! Random declarations, as text.

use crate::common::random::Random;
use liestep_derivation::declared::Role;

pub(super) struct Kind {
    pub(super) role: Role,
    /// The arguments before the expression, the possible first terms of it, and the arguments behind it.
    pub(super) head: &'static str,
    beginnings: &'static [&'static str],
    pub(super) tail: &'static str,
    /// The factor of a term, as `h * ` for a potential.
    weight: &'static str,
    /// Vectors that depend on the motion, the first of which is in each term, and scalars that depend on it.
    vectors: &'static [&'static str],
    scalars: &'static [&'static str],
}

const TRACE: &str = "((F - I) * J * (F - I).transpose()).trace() / (2.0 * h)";
const OF_BODY: &[&str] = &["w", "(F * a)", "(F.transpose() * w)", "(A * (F * b))"];
const PLAIN: Kind = Kind {
    role: Role::Lagrangian,
    head: "group = SO3, advected(w = up), l_d = ",
    beginnings: &[TRACE, "{ let d = F - I; (d * J * d.transpose()).trace() / (2.0 * h) }"],
    tail: "",
    weight: "h * ",
    vectors: OF_BODY,
    scalars: &["k"],
};
pub(super) const KINDS: [Kind; 12] = [
    PLAIN,
    Kind {
        head: "group = SO3, advected(w = up), given(u = wind), l_d = ",
        vectors: &["w", "u", "(F * u)", "(F.transpose() * w)"],
        beginnings: &["0.5 * log(F).dot(&(J * log(F))) / h - h * u.dot(&(F * w))"],
        ..PLAIN
    },
    // A kind whose increments are small, as its terms have roots.
    Kind {
        beginnings: &[
            "-(h * h - ((F - I) * J * (F - I).transpose()).trace()).sqrt()",
            "-h * (1.0 - ((F - I) * J * (F - I).transpose()).trace() / (h * h)).sqrt()",
            "{ let q = vee(F) / h; -h * (1.0 - q.dot(&(J * q))).sqrt() }",
        ],
        ..PLAIN
    },
    Kind {
        head: "group = SE2, advected(w = up), l_d = ",
        beginnings: &["((F - I) * A * A.transpose() * (F - I).transpose()).trace() / (2.0 * h)"],
        vectors: &["w", "(F * a)", "(inverse(F) * w)", "(A * (F * b))"],
        ..PLAIN
    },
    Kind {
        head: "group(F = SO3, d_1 = R3, d_2 = R3), advected(w = up.seen_from(F), R = F.seen_from(space), x = d_1.seen_from(space), r = d_2.seen_from(d_1)), l_d = ",
        beginnings: &[
            "((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) + k * d_1.norm_squared() / h + m * d_2.norm_squared() / (2.0 * h) - 0.1 * d_1.dot(&(R * ((F - I) * b))) / h - h * (x.dot(&(R * w)) + m * r.norm_squared())",
            "((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) + d_1.dot(&(A * A.transpose() * d_1)) / h + k * d_2.norm_squared() / h + 0.1 * w.dot(&((F - I) * a)).powi(2) / h - h * (x.dot(&(R * w)) + m * r.norm_squared())",
        ],
        vectors: &[
            "w",
            "(F * a)",
            "(R.transpose() * (x + d_1))",
            "(R.transpose() * r)",
            "(R.transpose() * (r + d_2 - d_1))",
            "(F.transpose() * w)",
        ],
        scalars: &["k", "(R * F * A).trace()", "(inverse(F) * A).trace()", "r.norm_squared()"],
        ..PLAIN
    },
    Kind {
        head: "group(F = SO3, s = R1), advected(w = up.seen_from(F), y = s.seen_from(space)), l_d = ",
        beginnings: &[
            "((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) + 0.5 * k * s * s / h + 0.1 * s * a.dot(&vee(F)) / h - 0.5 * h * m * (y * y + (y + s) * (y + s))",
            "{ let z = y + s; 0.5 * k * s * s / h - h * m * z * z } + ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h)",
        ],
        scalars: &["y", "(y + s)", "y * y", "(y + s) * (y + s)"],
        ..PLAIN
    },
    Kind {
        head: "group(F_1 = SO3, d = R3, F_2 = SO3), advected(w = up.seen_from(F_1), Q = F_2.seen_from(F_1), R = F_1.seen_from(space)), l_d = ",
        beginnings: &[
            "((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h) + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / h + k * d.norm_squared() / h + 0.1 * vee(F_1).dot(&(Q * vee(F_2 - F_2.transpose()))) / h - 0.1 * d.dot(&(R * ((F_1 - I) * b))) / h",
            "((F_1 - I) * J * (F_1 - I).transpose()).trace() / (2.0 * h) + ((F_2 - I) * J * (F_2 - I).transpose()).trace() / h + k * d.norm_squared() / h + 0.1 * ((F_1 - I) * a).dot(&(Q * ((F_2 - I) * b))) / h - 0.1 * d.dot(&(R * ((F_1 - I) * b))) / h",
        ],
        vectors: &["w", "log(Q)", "(Q * (F_2 * a))", "(F_1.transpose() * (Q * b))", "(F_1 * a)", "(R.transpose() * d)"],
        scalars: &["k", "log(Q).norm_squared()", "(F_1.transpose() * Q * F_2).trace()", "(Q * A).trace()"],
        ..PLAIN
    },
    Kind {
        head: "group = SO3, velocity = xi, advected(w = up), l = ",
        beginnings: &["0.5 * xi.dot(&(J_c * xi))", "{ let p = J_c * xi; 0.5 * p.dot(&xi) }"],
        tail: ", discretise = trapezoid(Cayley)",
        weight: "",
        vectors: &["w", "(A * w)", "a"],
        ..PLAIN
    },
    Kind {
        head: "group = SO3, velocity = xi, advected(w = up), given(u = wind), l = ",
        beginnings: &["0.5 * xi.dot(&(J_c * xi)) + w.dot(&xi) - w.dot(&u)"],
        tail: ", discretise = chord(Cayley)",
        weight: "",
        vectors: &["w", "(A * w)", "u"],
        ..PLAIN
    },
    Kind {
        head: "group(F = SO3, s = R1), velocity(xi, v), advected(w = up.seen_from(F), y = s.seen_from(space)), l = ",
        beginnings: &["0.5 * xi.dot(&(J_c * xi)) + 0.5 * m * v * v - 0.5 * k * y * y"],
        tail: ", discretise = trapezoid(Cayley)",
        weight: "",
        vectors: &["w", "(A * w)", "a"],
        scalars: &["y", "y * y"],
        ..PLAIN
    },
    Kind {
        role: Role::Force,
        head: "group = SO3, advected(w = up), work = ",
        beginnings: &[
            "-k * vee(F).dot(&(eta + eta_next))",
            "{ let d = vee(F); -k * d.dot(&eta) } - k * vee(F).dot(&eta_next)",
        ],
        vectors: &["w", "(F * a)", "(F.transpose() * w)", "(A * w)"],
        ..PLAIN
    },
    Kind {
        role: Role::Constraint,
        head: "group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3), advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)), zero = ",
        beginnings: &[
            "(R_1 * a).dot(&(R_2 * b)) - r.dot(&(R_1 * b))",
            "{ let u = R_1 * a; u.dot(&r) } - (R_2 * b).dot(&(R_1 * a))",
        ],
        weight: "",
        vectors: &["r", "(R_1 * a)", "(R_2 * b)", "(R_2 * (A * b))"],
        ..PLAIN
    },
];
#[rustfmt::skip]
const FIELDS: [(&str, &str); 9] = [
    ("J", "NonstandardInertia<f64>"), ("J_c", "Inertia<f64>"), ("A", "Matrix3<f64>"), ("a", "Vector3<f64>"), ("b", "Vector3<f64>"),
    ("up", "Vector3<f64>"), ("wind", "Vector3<f64>"), ("k", "f64"), ("m", "f64"),
];
/// Replacements that make a declaration wrong.
#[rustfmt::skip]
pub(super) const MISTAKES: [(&str, &str); 32] = [
    (" - h * ", " - "), (" - h * ", " - h * h * "), (".dot(&", ".dot("), ("2.0 * h", "2 * h"), ("* J *", "* K *"),
    ("advected(", "advectd("), ("SO3", "SO4"), ("w = up", "w = above"), (".trace()", ".tracee()"), (".dot(", ".dott("),
    ("h * ", "h * h.ln() * "), ("k * ", "F * "), ("&w", "&(w / (k - k))"), (" - h * ", " - h * (F - I).norm() * "),
    (" - ", " - ; "), ("discretise", "discretize"), ("Cayley", "Kayley"), ("velocity = xi", "velocity = zeta"),
    ("eta_next", "eta_after"), (".cross(&", ".dot(&"), (".dot(&eta)", ".dot(&eta).powi(2)"), ("group", "grup"),
    ("advected(w = up", "advected(w = up, w = up"), (" * ", " * * "),
    (".seen_from(", ".seen_by("), ("given(u = wind", "given(u = missing"), ("= R1", "= R9"), ("trapezoid(Cayley)", "trapezoid()"),
    ("(R_1 * a)", "(R_1.transpose() * a)"), ("zero = ", "zero = 0.0 * "), ("log(Q)", "log(w)"), ("y * y", "y.z * y"),
];

/// Tokens that replace other ones at random.
pub(super) const WORDS: [&str; 14] = ["F", "w", "a", "b", "k", "h", "+", "-", "*", "I", "J", "2.0", "( F * a )", "/"];

fn vector(random: &mut Random, kind: &Kind, depth: usize) -> String {
    let deeper = |random: &mut Random| vector(random, kind, depth - 1);
    match random.below(if depth == 0 { 4 } else { 7 }) {
        0 => kind.vectors[0].to_owned(),
        1 => ["a", "b"][random.below(2)].to_owned(),
        2 | 3 => kind.vectors[random.below(kind.vectors.len())].to_owned(),
        4 => format!("({} {} {})", deeper(random), ["+", "-"][random.below(2)], deeper(random)),
        5 => format!("{}.cross(&{})", deeper(random), deeper(random)),
        _ => format!("({} * {})", scalar(random, kind, 0), deeper(random)),
    }
}

fn scalar(random: &mut Random, kind: &Kind, depth: usize) -> String {
    let deeper = |random: &mut Random| scalar(random, kind, depth - 1);
    match random.below(if depth == 0 { 3 } else { 9 }) {
        0 => ["k", "m"][random.below(2)].to_owned(),
        1 => format!("{}.dot(&{})", vector(random, kind, depth), vector(random, kind, depth)),
        2 => kind.scalars[random.below(kind.scalars.len())].to_owned(),
        3 => format!("({} {} {})", deeper(random), ["+", "-", "*"][random.below(3)], deeper(random)),
        4 => format!("({}).{}()", deeper(random), ["sin", "cos"][random.below(2)]),
        5 => format!("(1.0 + {}.norm_squared()).{}()", vector(random, kind, 1), ["sqrt", "ln"][random.below(2)]),
        6 => format!("({}).powi({})", deeper(random), 2 + random.below(2)),
        7 => format!("{} / (2.0 + {}.norm_squared())", deeper(random), vector(random, kind, 1)),
        _ => format!("(0.1 * {}).exp()", deeper(random)),
    }
}

/// A sum of terms, of which none has two opposite summands, so that few are zero.
pub(super) fn right(random: &mut Random, kind: &Kind) -> String {
    let (weight, moving) = (kind.weight, kind.vectors[0]);
    let mut terms = vec![kind.beginnings[random.below(kind.beginnings.len())].to_owned()];
    for _ in 0..=random.below(3) {
        let (scalar, one, other) = (scalar(random, kind, 2), vector(random, kind, 1), vector(random, kind, 2));
        terms.push(match kind.role {
            Role::Force => format!(" - h * (1.0 + {scalar}) * ({one} + w).dot(&eta)"),
            _ => format!(" - {weight}((1.0 + {scalar}) * {moving}.dot(&a) + {moving}.dot(&({other} + b)).sin())"),
        });
    }
    let sum = terms.concat();
    let with_name =
        [sum.replace(&format!("{moving}.dot(&a)"), &format!("{moving}.dot(&(a + q))")), sum.replace(" + w)", " + q)")];
    match random.below(3) {
        // The sum stands in parentheses: a block at its beginning would end the statement.
        0 => {
            format!("{{ let q = {}; ({}) }}", vector(random, kind, 1), with_name[usize::from(kind.role == Role::Force)])
        }
        _ => sum,
    }
}

/// A discrete Lagrangian on a product.
pub(crate) fn on_a_product(seed: u64) -> (String, String) {
    let (mut random, mut kinds) = (Random::new(seed), KINDS.iter());
    let products = kinds.by_ref().filter(|kind| kind.head.starts_with("group(") && kind.head.ends_with("l_d = "));
    let products: Vec<&Kind> = products.collect();
    let kind = products[random.below(products.len())];
    declaration(kind, &right(&mut random, kind))
}

/// The arguments and the struct of a declaration, with the fields that occur in the arguments.
pub(super) fn declaration(kind: &Kind, expression: &str) -> (String, String) {
    let arguments = format!("{}{expression}{}", kind.head, kind.tail);
    let words: Vec<&str> = arguments.split(|letter: char| !letter.is_alphanumeric() && letter != '_').collect();
    let fields = FIELDS.iter().filter(|(name, _)| words.contains(name)).map(|(name, ty)| format!("{name}: {ty}"));
    (arguments.clone(), format!("struct Body {{ {} }}", fields.collect::<Vec<_>>().join(", ")))
}
