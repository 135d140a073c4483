//! Lagrangians that aren't quadratic in the velocity, and the limits of their discretisations.

use std::rc::Rc;

use crate::common::expanded;
use crate::continuous::{equations, read};
use liestep_derivation::declared::errors::Errors;
use liestep_derivation::declared::{Tree, lower};
use liestep_derivation::judged;
use liestep_derivation::judged::verify::Motion;
use liestep_derivation::mathematics::derive;
use liestep_derivation::mathematics::symbolic::Rational;

/// The limit of a discretised `l` that isn't quadratic is `l`, by the series in `h`, and not another Lagrangian.
#[test]
fn the_limit_of_what_isnt_quadratic() {
    let kinetic = "0.5 * Omega.dot(&(J_d * Omega)) * (1.0 + w.dot(&rho)) + m * Omega.norm_squared().powi(2)";
    let l = |kinetic: &str, sign: char| {
        format!("group = SO3, velocity = Omega, advected(w = up), l = {kinetic} {sign} m * (2.0 + w.dot(&rho)).sqrt()")
    };
    let fields = "struct Top { J_d: Inertia, m: f64, rho: Vector3<f64>, up: Vector3<f64> }";
    for rule in ["trapezoid", "trapezoid(Cayley)", "trapezoid(exp)", "midpoint(exp)", "chord", "chord(exp)"] {
        let (declaration, tree) = read(&format!("{}, discretise = {rule}", l(kinetic, '-')), fields);
        let mut errors = Errors::default();
        let asked = declaration.discretisation().expect("a rule");
        let discrete = judged::discretised(&declaration, &tree, asked, &mut errors).expect("a fit");
        let own = equations(&l(kinetic, '-'), fields);
        let has_limit =
            |tree: &Rc<Tree>| Motion::new(&declaration, Some(tree), &own.names, &own.derived).has_limit(&discrete);
        assert_eq!(has_limit(&tree), Some(true), "{rule}");
        for other in [l(kinetic, '+'), l(&kinetic.replace("+ m", "- m"), '-')] {
            assert_eq!(has_limit(&read(&other, fields).1), Some(false), "{rule}: a sign of {other}");
        }
    }
}

/// A root that has values below the velocity of light alone, and one that has none. The field has roots of all numbers, so
/// this says nothing of where `l` has a value.
#[test]
fn the_limit_of_a_root() {
    let l = |inside: &str, sign: char| {
        format!(
            "group = R3, velocity = v, advected(w = field), discretise = trapezoid(exp), \
             l = -(m * c * c) * ({inside}).sqrt() {sign} m * w.dot(&origin)"
        )
    };
    let fields = "struct Fast { m: f64, c: f64, origin: Vector4<f64>, field: Vector4<f64> }";
    let limit = |made: &str, other: &str| {
        let (declaration, tree) = read(made, fields);
        let mut errors = Errors::default();
        let asked = declaration.discretisation().expect("a rule");
        let discrete = judged::discretised(&declaration, &tree, asked, &mut errors).expect("a fit");
        // The limit is compared with the declared `l`, whatever the equations.
        let any = equations(&l("1.0 - v.norm_squared() / (c * c)", '+'), fields);
        Motion::new(&declaration, Some(&read(other, fields).1), &any.names, &any.derived).has_limit(&discrete)
    };
    let [root, turned] = ["1.0 - v.norm_squared() / (c * c)", "1.0 + v.norm_squared() / (c * c)"];
    assert_eq!(limit(&l(root, '+'), &l(root, '+')), Some(true));
    assert_eq!(limit(&l(root, '+'), &l(turned, '+')), Some(false));
    assert_eq!(limit(&l(root, '+'), &l(root, '-')), Some(false));
    // An `l` without a value at any point is neither confirmed nor denied; a declaration with it is refused before.
    for undefined in ["1.0 / (v.norm_squared() - v.norm_squared())", "1.0 / v[0].powi(0).ln()"] {
        assert_eq!(limit(&l(undefined, '+'), &l(undefined, '+')), None, "{undefined}");
        let refused = expanded(&l(undefined, '+'), fields).to_string();
        assert!(refused.contains("what is divided by it has no value"), "{undefined}: {refused}");
    }
    let nowhere = "-1.0 - v.norm_squared() / (c * c)";
    assert_eq!(limit(&l(nowhere, '+'), &l(nowhere, '+')), Some(true));
    assert_eq!(limit(&l(nowhere, '+'), &l(nowhere, '-')), Some(false));
    // A term that rounding would hide is noticed in the field.
    let small = "1.0 + 1e-15 - v.norm_squared() / (c * c)";
    assert_eq!(limit(&l(root, '+'), &l(small, '+')), Some(false));
    assert_eq!(limit(&l(small, '+'), &l(small, '+')), Some(true));
}

/// The inertia, momentum and potential of such an `l` at rest are its derivatives there.
#[test]
fn what_isnt_quadratic_at_rest() {
    let fields = "struct Top { J_d: Inertia, m: f64, rho: Vector3<f64>, up: Vector3<f64> }";
    let arguments = "group = SO3, velocity = Omega, advected(w = up), discretise = trapezoid, \
        l = 0.5 * Omega.dot(&(J_d * Omega)) * (1.0 + w.dot(&rho)) + m * Omega.norm_squared().powi(2) \
            + Omega.dot(&rho) * w.dot(&rho) - m * w.dot(&rho)";
    let (declaration, tree) = read(arguments, fields);
    let mut errors = Errors::default();
    let asked = declaration.discretisation().expect("a rule");
    let discrete = judged::discretised(&declaration, &tree, asked, &mut errors).expect("a fit");
    let equations = equations(arguments, fields);
    let readings = lower::readings(&declaration, &discrete, &mut errors).expect("small");
    let readings = readings.into_iter().map(|reading| equations.behind(reading)).collect();
    let chosen = judged::cheapest(readings, derive::derive, &declaration, &discrete, &mut errors).expect("derived");
    let disagrees = |derived: &derive::Derivation| {
        let motion = Motion::new(&declaration, None, &equations.names, &equations.derived);
        motion.rest_holds(&chosen.lowered.names, chosen.kernel.beginning.limit(derived)).is_err()
    };
    assert!(!disagrees(&chosen.derived));
    for change in [0, 1, 2] {
        let mut changed = chosen.derived.clone();
        let limit = &mut changed.limit;
        let term = [&mut limit.inertia, &mut limit.bias, &mut limit.potential].into_iter().nth(change).expect("three");
        *term = term.clone().scaled(-Rational::ONE);
        assert!(disagrees(&changed), "{change}");
    }
}
