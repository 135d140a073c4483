//! Continuous Lagrangians, and their discretisations.

use std::rc::Rc;

use crate::common::bodies::{CART, LINKS, OF_CART, OF_LINKS};
use crate::common::tokens;
use liestep_derivation::declared::errors::Errors;
use liestep_derivation::declared::{Declaration, Role, Tree, check, lower, parse};
use liestep_derivation::judged::verify::{Motion, Objection};
use liestep_derivation::judged::{self, Equations};
use liestep_derivation::mathematics::derive::{self, Derivation};
use liestep_derivation::mathematics::symbolic::{Expression, Rational, substitute};

/// Example 3 of the thesis.
const TOP: &str = "group = SO3, velocity = Omega, advected(w = up),
    l = 0.5 * Omega.dot(&(J * Omega)) - m * g * w.dot(&rho)";

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

const EVERYTHING: &str = "group = SE2, velocity = xi, advected(w = up, v = way, S = field),
    l = 0.5 * (1.0 + w.dot(&r).powi(2)) * xi.dot(&(M * xi)) + v.dot(&xi) * w.dot(&(S * v)).sin()
        + (hat(xi) * S).trace() - (1.0 + (S * M).trace().powi(2)).sqrt()";
const FIELDS: &str = "struct Everything { M: Matrix3<f64>, r: Vector3<f64>, up: Vector3<f64>,
    way: ContravariantVector<f64, 3>, field: MixedTensor<f64, 3> }";

/// A wrong sign or a wrong factor in any continuous equation fails the exact check.
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

/// The limit of a discretised `l` is `l`, and not another Lagrangian.
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

/// The second derivative by the velocity is symmetric, as its normal form shows.
#[test]
fn the_second_derivative_is_symmetric() {
    let Equations { derived, .. } = equations(EVERYTHING, FIELDS);
    let [eta, zeta] = derived.directions[0].map(|direction| direction.components);
    let exchanged = [(eta, zeta), (zeta, eta)].map(|(from, to)| (from, Expression::symbol(to, &derived.symbols)));
    let exchanged = std::collections::BTreeMap::from(exchanged);
    let turned = substitute(&derived.hessian, &exchanged, &derived.symbols);
    assert_eq!(turned, derived.hessian);
}
