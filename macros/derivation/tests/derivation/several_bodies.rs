//! Declarations of several bodies: what they conserve, and what is solved together.

use proc_macro2::TokenStream;

use crate::common::{expanded, is_refused, tokens};
use liestep_derivation::declared::errors::Errors;
use liestep_derivation::declared::{Kind, Role, check, parse, parts};
use liestep_derivation::judged::conserved;

const BODIES: &str = "struct Bodies { J_1: NonstandardInertia, J_2: NonstandardInertia, k: f64, up: Vector3<f64>, \
                      other: Vector3<f64> }";
const KINETIC: &str = "((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
    + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)";

/// The bodies of each momentum, and the field that it is along.
fn momenta(advected: &str) -> Vec<(Vec<usize>, Option<usize>)> {
    let arguments = format!("group(F_1 = SO3, F_2 = SO3), advected({advected}), l_d = 0.0");
    let mut errors = Errors::default();
    let declaration = parse::declaration(Role::Lagrangian, &tokens(&arguments), &tokens(BODIES), &mut errors);
    assert!(errors.is_empty(), "{advected}");
    let all = conserved(&declaration.expect("a declaration"));
    all.into_iter().map(|one| (one.bodies, one.along)).collect()
}

#[test]
fn conserved_momenta_are_read_off_what_is_seen() {
    let (up, both) = (Some(3), vec![0, 1]);
    assert_eq!(momenta("Q = F_2.seen_from(F_1)"), [(both.clone(), None)]);
    assert_eq!(momenta("w = up.seen_from(F_1), Q = F_2.seen_from(F_1)"), [(both.clone(), up)]);
    assert_eq!(momenta("w = up.seen_from(F_1), v = up.seen_from(F_2), Q = F_1.seen_from(F_2)"), [(both, up)]);
    assert_eq!(momenta("w = up.seen_from(F_1)"), [(vec![0], up), (vec![1], None)]);
    assert_eq!(momenta("w = up.seen_from(F_1), v = other.seen_from(F_2), Q = F_1.seen_from(F_2)"), []);
    assert_eq!(momenta("R = F_1.seen_from(space)"), [(vec![1], None)]);
    assert_eq!(momenta("R = F_1.seen_from(space), Q = F_2.seen_from(F_1)"), []);
}

/// By the names that the user gave.
#[test]
fn the_page_names_the_bodies() {
    let page = |advected: &str, potential: &str| {
        let arguments =
            format!("group(F_1 = SO3, F_2 = SO3), advected({advected}), l_d = {KINETIC} - h * k * {potential}")
                .replace("F_1", "F_down")
                .replace("F_2", "F_w");
        let expansion = expanded(&arguments, &BODIES.replace(", other: Vector3<f64>", ""));
        assert!(!is_refused(&expansion), "{expansion}");
        expansion.to_string()
    };
    let together = page("w = up.seen_from(F_1), Q = F_2.seen_from(F_1)", "(w.z + Q.trace())");
    assert!(together.contains("`up·Σ R Π` over the bodies of `F_down`, `F_w`."));
    assert!(together.contains("w⁺ = F_down⁻¹·w = F_downᵀ w for w in V*"));
    let alone = page("w = up.seen_from(F_1)", "w.z");
    assert!(alone.contains("`up·R Π` over the body of `F_down`; `R Π` over the body of `F_w`."));
}

/// Each share of a diamond is that of one parameter, and a covector is in the names of the declaration.
#[test]
fn shares_of_the_diamond() {
    let arguments = "group(F = SO3, s = R1), advected(w = up.seen_from(F), y = s.seen_from(space)),
        l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) + 0.5 * m * s * s / h - h * y * w.dot(&a)";
    let item = "struct Bead { J: NonstandardInertia, m: f64, a: Vector3<f64>, up: Vector3<f64> }";
    let text = expanded(arguments, item).to_string();
    for line in [
        "δl_d/δ(w, y) ⋄ (w, y) = h y (a wᵀ − w aᵀ)^∨;  −h ⟨a, w⟩    [(2.1)]",
        "δl_d/δw ⋄ w = h y (a wᵀ − w aᵀ)^∨;  0    [of w alone]",
        "δl_d/δy ⋄ y = 0;  −h ⟨a, w⟩    [of y alone]",
        "(R_F)* δl_d/δF = (1/h) (F J − J Fᵀ)^∨;  (s m/h)    [",
    ] {
        assert!(text.contains(line), "{line} isn't in {text}");
    }
}

/// Attitudes couple bodies at the ends of a step, and velocities in the middle of it.
#[test]
fn what_couples_is_solved_together() {
    let declared = |coupling: &str| {
        let arguments = format!(
            "group(F_1 = SO3, F_2 = SO3), advected(w = up.seen_from(F_1), v = other.seen_from(F_2), \
             Q = F_2.seen_from(F_1)), l_d = {KINETIC} - h * (w.z + v.z) + {coupling}"
        );
        let expansion = expanded(&arguments, BODIES);
        assert!(!is_refused(&expansion), "{expansion}");
        expansion.to_string()
    };
    let apart = declared("0.5 * h * k * (Q.trace() + (F_1.transpose() * Q * F_2).trace())");
    assert!(apart.contains("const APART") && apart.contains("Solved apart: `F_1`; `F_2`."));
    let together = declared("k * vee(F_1).dot(&(Q * vee(F_2))) / h");
    assert!(!together.contains("const APART") && together.contains("Solved together: `F_1`, `F_2`, 6 unknowns."));
    assert!(
        together.contains("const INERTIA_IS_CONSTANT : :: liestep :: __private :: core :: primitive :: bool = false")
    );
    assert!(apart.contains("Conserved: no momentum"));
    assert!(apart.contains("F = (F_1, F_2) = g⁻¹ g⁺"));
}

/// What compares turns, or repeats one, needs no frame in common; what a body sees does.
#[test]
fn turns_are_compared() {
    let is_right = |potential: &str| {
        let arguments = format!(
            "group(F_1 = SO3, F_2 = SO3), advected(w = up.seen_from(F_1), v = other.seen_from(F_2), \
             Q = F_2.seen_from(F_1)), l_d = {KINETIC} - h * k * (w.z + v.z + {potential} + Q.trace())"
        );
        !is_refused(&expanded(&arguments, BODIES))
    };
    for right in [
        "(Q - Q.transpose()).norm_squared()",
        "(Q + Q.transpose()).norm_squared()",
        "(Q * Q).trace()",
        "(Q * Q * Q).trace()",
        "w.dot(&(Q * Q * w))",
        "w.dot(&((Q - Q.transpose()) * v))",
        "vee(Q - Q.transpose()).norm_squared()",
        "(vee(F_1) - vee(F_2)).norm_squared() / h.powi(2)",
        "(2.0 * vee(F_1)).dot(&(-vee(F_2))) / h.powi(2)",
        "(F_1 - F_2).norm_squared() / h.powi(2)",
        "((F_1 - I) * J_1 * (F_1 - I).transpose() + (F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / h.powi(2)",
        "{ let a = vee(F_1); let b = vee(F_2); (a - b).norm_squared() / h.powi(2) }",
    ] {
        assert!(is_right(right), "{right}");
    }
    for mistake in [
        "w.dot(&v)",
        "(w - v).norm_squared()",
        "w.dot(&vee(F_2))",
        "(Q * w).z",
        "(F_1.transpose() * Q.transpose() * F_2).trace()",
    ] {
        assert!(!is_right(mistake), "{mistake}");
    }
}

/// What two calls are called with are two values, and so is what is shadowed.
#[test]
fn a_name_is_one_value_in_the_derivation() {
    let arguments = "group(F_1 = SO3, F_2 = SO3), advected(w = up.seen_from(F_1), v = up.seen_from(F_2), \
                     Q = F_2.seen_from(F_1)), l_d = {
                         let U = |Q: Matrix3<f64>, y: Vector3<f64>| { let r = y + Q * y; r.dot(&r) * (Q + I).trace() };
                         let y = U(F_1 * F_1 + I, w + F_1 * w);
                         let y = y + U(F_2 * F_2 + I, v + F_2 * v);
                         ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
                             + ((F_2 - I) * J_1 * (F_2 - I).transpose()).trace() / (2.0 * h)
                             - h * (y + y * y + Q.trace())
                     }";
    let item = "struct Bodies { J_1: NonstandardInertia, up: Vector3<f64> }";
    let mut errors = Errors::default();
    let declaration = parse::declaration(Role::Lagrangian, &tokens(arguments), &tokens(item), &mut errors);
    let tree = check::check(&declaration.expect("a declaration"), &mut errors).expect("a Lagrangian");
    assert!(errors.is_empty());
    let mut names = std::collections::BTreeMap::new();
    for part in parts(&tree) {
        if let Kind::Bound(name, _) = &part.kind {
            names.insert(std::rc::Rc::as_ptr(part), name.clone());
        }
    }
    let different: std::collections::BTreeSet<_> = names.values().cloned().collect();
    assert_eq!(different.len(), names.len(), "{names:?}");
    let expected = ["Q_2", "Q_3", "r", "r_2", "y", "y_2", "y_3", "y_4"];
    assert_eq!(different.into_iter().collect::<Vec<_>>(), expected);
}

/// One body by another name.
#[test]
fn one_factor_is_a_group() {
    let item = "struct Body { J_1: NonstandardInertia }";
    let l_d = "((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)";
    assert!(!is_refused(&expanded(&format!("group(F_1 = SO3), l_d = {l_d}"), item)));
    assert!(is_refused(&expanded("group(), l_d = h", item)));
}

/// What a declaration of that role makes.
fn of_role(role: Role, arguments: &str, item: &str) -> TokenStream {
    liestep_derivation::expand(role, tokens(arguments), &tokens(item))
}

/// The messages name what was declared, and what means nothing there is a name as any other.
#[test]
fn names_of_several_bodies() {
    let force = |displacements: &str, work: &str| {
        let arguments = format!("group(F_1 = SO3, d_1 = R3), displacement({displacements}), work = {work}");
        of_role(Role::Force, &arguments, "struct Push { eta: Vector3<f64>, eta_next: f64 }")
    };
    let missing = force("turn, s", "h * eta_next * eta.norm()");
    let needed = "a displacement: `turn` or `s` at the beginning of the step, `turn_next` or `s_next` at its end";
    assert!(missing.to_string().contains(needed), "{missing}");
    for displacements in ["turn, s", "r#fn, r#type"] {
        let [turn, s] = displacements.split(", ").collect::<Vec<_>>()[..] else { panic!("two names") };
        let next = s.trim_start_matches("r#");
        let pushed =
            force(displacements, &format!("h * (eta.dot(&{turn}) + eta_next * eta.dot(&({s} + {next}_next)))"));
        assert!(!is_refused(&pushed), "{pushed}");
        assert!(syn::parse2::<syn::File>(pushed).is_ok());
    }
    let bodies = "group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3), advected(r = d_2.seen_from(d_1))";
    let held = |zero: &str| {
        let item = "#[derive(Clone, Copy, Debug, PartialEq)] struct Strut { F: Vector3<f64>, h: f64 }";
        of_role(Role::Constraint, &format!("{bodies}, zero = {zero}"), item)
    };
    let strut = held("(r - F).norm_squared() - h * h");
    assert!(!is_refused(&strut), "{strut}");
    let constant = held("(r - F, h - 1.0)");
    assert!(constant.to_string().contains("doesn't depend on where the bodies are"), "{constant}");
}
