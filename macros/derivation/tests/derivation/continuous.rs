//! Continuous Lagrangians, and what is made of them.

use std::rc::Rc;

use expect_test::expect_file;

use crate::common::bodies::{CART, LINKS, OF_CART, OF_LINKS};
use crate::common::{HEAVY_TOP, expanded, is_refused, tokens, top};
use crate::printed::{continuous_derivation, derivation, page};
use liestep_derivation::declared::errors::Errors;
use liestep_derivation::declared::{Declaration, Role, Tree, check, lower, parse};
use liestep_derivation::judged::verify::{Motion, Objection};
use liestep_derivation::judged::{self, Equations};
use liestep_derivation::mathematics::derive::{self, Derivation, Inverse};
use liestep_derivation::mathematics::symbolic::{Expression, Rational, substitute};

/// Example 3 of the thesis.
const TOP: &str = "group = SO3, velocity = Omega, advected(w = up),
    l = 0.5 * Omega.dot(&(J * Omega)) - m * g * w.dot(&rho)";

/// The same with the matrix `J_d`, as in section 3.2.
const TOP_OF_MATRICES: &str = "group = SO3, velocity = Omega, advected(w = up),
    l = 0.5 * (hat(Omega) * J_d * hat(Omega).transpose()).trace() - m * g * w.dot(&rho)";

const PARAMETERS: &str = "struct Top { J: Inertia, m: f64, g: f64, rho: Vector3<f64>, up: Vector3<f64> }";

pub(super) fn read(arguments: &str, item: &str) -> (Declaration, Rc<Tree>) {
    let mut errors = Errors::default();
    let declaration = parse::declaration(Role::Lagrangian, &tokens(arguments), &tokens(item), &mut errors);
    let declaration = declaration.expect("a declaration");
    let tree = check::check(&declaration, &mut errors).expect("a Lagrangian");
    (declaration, tree)
}

pub(super) fn equations(arguments: &str, item: &str) -> Equations {
    let (declaration, tree) = read(arguments, item);
    let mut errors = Errors::default();
    let equations = judged::of_declared(&declaration, &tree, &mut errors);
    assert!(errors.is_empty(), "{errors:?}");
    equations.expect("regular")
}

/// `l_d` in normal form, multiplied out.
pub(super) fn discrete(arguments: &str, item: &str) -> Expression {
    let (declaration, tree) = read(arguments, item);
    let mut errors = Errors::default();
    let tree = match declaration.discretisation() {
        Some(asked) => judged::discretised(&declaration, &tree, asked, &mut errors).expect("a fit"),
        None => tree,
    };
    let readings = lower::readings(&declaration, &tree, &mut errors).expect("small");
    readings.into_iter().find(|reading| reading.declared.lets.is_empty()).expect("short").declared.expression
}

/// The matrix `(F − I)/h` for the velocity, and the trapezoidal rule, make (3.13), the same sum of the same terms; what
/// is generated for a step is the same too, token by token.
#[test]
fn the_trapezoidal_rule_makes_the_heavy_top() {
    let item = top("NonstandardInertia");
    let made = format!("{TOP_OF_MATRICES}, discretise = trapezoid");
    assert_eq!(discrete(&made, &item), discrete(HEAVY_TOP, &item));
    // Another rule for the potential is another Lagrangian, where the potential isn't linear.
    let bent = TOP_OF_MATRICES.replace("w.dot(&rho)", "w.dot(&rho).powi(2)");
    let [trapezoid, chord] =
        ["trapezoid", "chord"].map(|rule| discrete(&format!("{bent}, discretise = {rule}"), &item));
    assert_ne!(trapezoid, chord);
    let stages = |arguments: &str| {
        let text = expanded(arguments, &item).to_string();
        let after = text.split_once("fn constants").expect("stages").1;
        after.split_once("impl").expect("an end").0.to_owned()
    };
    assert_eq!(stages(&made), stages(HEAVY_TOP));
}

/// In principal axes or not, with `J` for `J_d`: the same steps up to `J_d = ½ tr(J) I − J`.
#[test]
fn the_ordinary_inertia_is_a_nonstandard_one() {
    let text = derivation(&format!("{TOP}, discretise = trapezoid"), PARAMETERS);
    assert!(text.contains("l_d = −(1/(2 h)) tr(F) tr(J) + (1/h) tr(F J) + (1/(2 h)) tr(J)"), "{text}");
}

/// The thesis' equations for the heavy top.
#[test]
fn of_the_heavy_top() {
    expect_file!["printed/heavy_top_continuous.txt"].assert_eq(&continuous_derivation(TOP, PARAMETERS));
    expect_file!["printed/heavy_top_limit.txt"]
        .assert_eq(&continuous_derivation(HEAVY_TOP, &top("NonstandardInertia")));
    expect_file!["printed/heavy_top_continuous_page.txt"].assert_eq(&page(TOP, PARAMETERS));
}

/// A kinetic energy that depends on `w`, one that isn't quadratic, and another group.
#[test]
fn of_others() {
    let varying = "group = SO3, velocity = Omega, advected(w = up),
        l = 0.5 * Omega.dot(&(J * Omega)) + 0.5 * k * w.dot(&Omega).powi(2) + k * s.dot(&Omega)";
    let item = "struct Body { J: Inertia, k: f64, s: Vector3<f64>, up: Vector3<f64> }";
    expect_file!["printed/varying_inertia.txt"].assert_eq(&continuous_derivation(varying, item));
    let relativistic = "group = R1, velocity = v, l = -m * c * c * (1.0 - v.norm_squared() / (c * c)).sqrt()";
    expect_file!["printed/relativistic_particle.txt"]
        .assert_eq(&continuous_derivation(relativistic, "struct Particle { m: f64, c: f64 }"));
    let planar = "group = SE2, velocity = xi, advected(a = anchor),
        l = 0.5 * xi.dot(&(M * xi)) - 0.5 * k * (a - p).norm_squared()";
    let item = "struct Planar { M: Matrix3<f64>, k: f64, p: Point2<f64>, anchor: Point2<f64> }";
    expect_file!["printed/planar_body.txt"].assert_eq(&continuous_derivation(planar, item));
}

/// How `ξ` follows from `μ` is known exactly.
#[test]
fn inverses() {
    let inverse = |l: &str, item: &str| {
        equations(&format!("group = SO3, velocity = Omega, advected(w = up), l = {l}"), item).derived.inverse
    };
    let item = "struct Body { J: Inertia, k: f64, up: Vector3<f64> }";
    assert_eq!(inverse("0.5 * Omega.dot(&(J * Omega)) - k * w.x", item), Inverse::Constant);
    // What cancels doesn't count.
    let cancelled = "0.5 * Omega.dot(&(J * Omega)) + k * w.x * (Omega - Omega).norm_squared()";
    assert_eq!(inverse(cancelled, item), Inverse::Constant);
    assert_eq!(inverse("0.5 * (1.0 + k * w.x.powi(2)) * Omega.dot(&(J * Omega))", item), Inverse::Varying);
    assert_eq!(inverse("0.5 * Omega.dot(&(J * Omega)) + k * Omega.x.powi(4) - w.x", item), Inverse::Nonlinear);
}

/// Found in exact arithmetic, for all values of the parameters: a sphere's, those of translations, and of no body with
/// an inertia of its own.
#[test]
fn right_symmetries() {
    let found = |arguments: &str, item: &str| equations(arguments, item).right_symmetries.len();
    let sphere = "group = SO3, velocity = Omega, l = 0.5 * j * Omega.norm_squared()";
    assert_eq!(found(sphere, "struct Sphere { j: f64 }"), 3);
    let symmetric = "group = SO3, velocity = Omega, advected(w = up),
        l = 0.5 * a * (Omega.x.powi(2) + Omega.y.powi(2)) + 0.5 * b * Omega.z.powi(2) - k * w.z";
    let item = "struct Lagrange { a: f64, b: f64, k: f64, up: Vector3<f64> }";
    assert_eq!(found(symmetric, item), 1);
    assert_eq!(equations(symmetric, item).right_symmetries[0], [0, 0, 1].map(Rational::integer));
    assert_eq!(found(&symmetric.replace("k * w.z", "k * w.x"), item), 0);
    assert_eq!(found(TOP, PARAMETERS), 0);
    let free = "group = R3, velocity = v, l = 0.5 * m * v.norm_squared()";
    assert_eq!(found(free, "struct Particle { m: f64 }"), 3);
}

const EVERYTHING: &str = "group = SE2, velocity = xi, advected(w = up, v = way, S = field),
    l = 0.5 * (1.0 + w.dot(&r).powi(2)) * xi.dot(&(M * xi)) + v.dot(&xi) * w.dot(&(S * v)).sin()
        + (hat(xi) * S).trace() - (1.0 + (S * M).trace().powi(2)).sqrt()";
const FIELDS: &str = "struct Everything { M: Matrix3<f64>, r: Vector3<f64>, up: Vector3<f64>,
    way: ContravariantVector<f64, 3>, field: MixedTensor<f64, 3> }";

/// Each exact check sees a sign that is turned, and a factor.
#[test]
fn a_turned_sign_is_seen() {
    for (arguments, item) in [(TOP, PARAMETERS), (EVERYTHING, FIELDS), (LINKS, OF_LINKS), (CART, OF_CART)] {
        let (declaration, tree) = read(arguments, item);
        let Equations { names, derived, .. } = equations(arguments, item);
        let check = |change: &dyn Fn(&mut derive::Continuous)| {
            let mut changed = derived.clone();
            change(&mut changed);
            match Motion::new(&declaration, Some(&tree), &names, &changed).holds() {
                Err(Objection::Disagrees(term)) => Some(term),
                found => found.map_or_else(|other| panic!("{other:?}"), |_| None),
            }
        };
        assert_eq!(check(&|_| ()), None);
        let turned = |expression: &Expression| expression.clone().scaled(-Rational::ONE);
        assert_eq!(check(&|derived| derived.momentum = turned(&derived.momentum)), Some("momentum ∂l/∂ξ"));
        assert_eq!(check(&|derived| derived.hessian = turned(&derived.hessian)), Some("inertia ∂²l/∂ξ²"));
        assert_eq!(check(&|derived| derived.diamond = turned(&derived.diamond)), Some("diamond term ∂l/∂w ⋄ w"));
        let halved = |derived: &mut derive::Continuous| {
            derived.diamond = derived.diamond.clone().scaled(Rational::new(1, 2));
        };
        assert_eq!(check(&halved), Some("diamond term ∂l/∂w ⋄ w"));
        let turn = |derived: &mut derive::Continuous| derived.diamond_of_any = turned(&derived.diamond_of_any);
        assert_eq!(check(&turn), Some("diamond along all matrices"));
        if !derived.advection.is_zero() {
            let turn = |derived: &mut derive::Continuous| derived.advection = turned(&derived.advection);
            assert_eq!(check(&turn), Some("change of the momentum with w"));
        }
    }
}

/// The limit of what is made of `l` is `l`; of another it isn't.
#[test]
fn the_limit_is_what_was_discretised() {
    let rules = ["trapezoid", "trapezoid(Cayley)", "trapezoid(exp)", "midpoint(exp)", "chord", "chord(exp)"];
    for rule in rules {
        let arguments = format!("{TOP}, discretise = {rule}");
        let (declaration, tree) = read(&arguments, PARAMETERS);
        let mut errors = Errors::default();
        let asked = declaration.discretisation().expect("a rule");
        let discrete = judged::discretised(&declaration, &tree, asked, &mut errors).expect("a fit");
        let readings = lower::readings(&declaration, &discrete, &mut errors).expect("small");
        let chosen = judged::cheapest(readings, derive::derive, &declaration, &discrete, &mut errors).expect("derived");
        let own = equations(&arguments, PARAMETERS);
        let disagrees = |derived: &Derivation| {
            let motion = Motion::new(&declaration, None, &own.names, &own.derived);
            motion.rest_holds(&chosen.lowered.names, chosen.kernel.beginning.limit(derived)).is_err()
        };
        assert!(!disagrees(&chosen.derived), "{rule}");
        let mut changed = chosen.derived.clone();
        changed.limit.potential = changed.limit.potential.scaled(-Rational::ONE);
        assert!(disagrees(&changed), "{rule}: the potential's sign");
        let mut changed = chosen.derived.clone();
        changed.limit.inertia = changed.limit.inertia.scaled(Rational::integer(2));
        assert!(disagrees(&changed), "{rule}: a factor of the inertia");
    }
}

/// Anisotropic added mass in the ambient matrix isn't self-adjoint on SE(2): that is refused.
#[test]
fn what_isnt_self_adjoint_is_refused() {
    let body = |rule: &str| {
        let arguments = format!(
            "group = SE2, velocity = xi, discretise = {rule},
            l = 0.5 * j * (hat(xi) * hat(xi).transpose()).trace() + 0.5 * k * r.dot(&(hat(xi) * s)).powi(2)"
        );
        expanded(&arguments, "struct Body { j: f64, k: f64, r: Vector3<f64>, s: Vector3<f64> }").to_string()
    };
    assert!(body("trapezoid").contains("isn't its own adjoint"));
    assert!(!body("trapezoid(Cayley)").contains("compile_error"));
}

/// An even power of a norm is smooth, and is what it is of `norm_squared`.
#[test]
fn powers_of_norms() {
    let of = |l: &str| equations(&format!("group = SO3, velocity = Omega, l = {l}"), "struct Body { m: f64 }").derived;
    let squared = of("0.5 * m * Omega.norm_squared()");
    assert_eq!(of("0.5 * m * Omega.norm().powi(2)").lagrangian, squared.lagrangian);
    assert_eq!(of("{ let speed = Omega.norm(); 0.5 * m * speed.powi(2) }").hessian, squared.hessian);
    let fourth = of("m * Omega.norm_squared() + m * Omega.norm_squared().powi(2)");
    assert_eq!(of("m * Omega.norm().powi(2) + m * Omega.norm().powi(4)").lagrangian, fourth.lagrangian);
    let matrices = "group = SE2, velocity = xi, l = m * hat(xi).norm().powi(2) + m * xi.norm().powi(2)";
    assert!(!is_refused(&expanded(matrices, "struct Body { m: f64 }")));
    assert_eq!(of("0.5 * m * Omega.norm() * Omega.norm()").momentum, squared.momentum);
}

/// As the normal form shows.
#[test]
fn the_second_derivative_is_symmetric() {
    let Equations { derived, .. } = equations(EVERYTHING, FIELDS);
    let [eta, zeta] = derived.directions[0].map(|direction| direction.components);
    let exchanged = [(eta, zeta), (zeta, eta)].map(|(from, to)| (from, Expression::symbol(to, &derived.symbols)));
    let exchanged = std::collections::BTreeMap::from(exchanged);
    let turned = substitute(&derived.hessian, &exchanged, &derived.symbols);
    assert_eq!(turned, derived.hessian);
}

/// Of several bodies one covector after the other, by the names that are declared.
#[test]
fn of_several_bodies() {
    expect_file!["printed/links.txt"].assert_eq(&continuous_derivation(LINKS, OF_LINKS));
    expect_file!["printed/cart.txt"].assert_eq(&continuous_derivation(CART, OF_CART));
    // A wheel, and a body that nothing moves.
    let wheel = "group(F = SO3, t = R1, d = R2), velocity(Omega, u, v),
        l = 0.5 * Omega.dot(&(J * Omega)) + 0.5 * m * (u + s.dot(&Omega)).powi(2) + 0.5 * m * v.norm_squared()";
    let text = continuous_derivation(wheel, "struct Wheel { J: Inertia, m: f64, s: Vector3<f64> }");
    assert!(text.contains("kept = h(μ); Ad*_{g⁻¹} μ; μ_2; (μ_3)_1; (μ_3)_2    ["), "{text}");
}
