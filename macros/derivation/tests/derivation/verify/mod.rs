//! The self-check fails on each broken term.

mod dual;
mod residue;
mod series;

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::common::{HEAVY_TOP, checked_as, expanded, top};
use liestep_derivation::declared::errors::Errors;
use liestep_derivation::declared::lower::{Reading, readings};
use liestep_derivation::declared::{Declaration, Name, Role, Tree};
use liestep_derivation::judged::verify::degree::{Content, Degree, Largest};
use liestep_derivation::judged::verify::evaluation::Evaluation;
use liestep_derivation::judged::verify::value::Value;
use liestep_derivation::judged::verify::{KineticPart, Objection, Subject, Sureness, degree, kinetic_part, verify};
use liestep_derivation::judged::{Choice, cheapest};
use liestep_derivation::mathematics::derive::{Derivation, SelfAdjointness, derive};
use liestep_derivation::mathematics::symbolic::{Expression, Rational};
use liestep_derivation::program::{Kernel, kernel};

/// A declaration after all phases before the check.
pub(crate) struct Case {
    declaration: Declaration,
    tree: Rc<Tree>,
    lowered: Reading,
    derived: Derivation,
}

fn checked(arguments: &str, item: &str) -> (Declaration, Rc<Tree>) {
    let (declaration, trees) = checked_as(Role::Lagrangian, arguments, item);
    (declaration, trees[0].clone())
}

impl Case {
    pub(crate) fn new(arguments: &str, item: &str) -> Self {
        let (declaration, tree) = checked(arguments, item);
        let mut errors = Errors::default();
        let readings = readings(&declaration, &tree, &mut errors).expect("small");
        let chosen = cheapest(readings, derive, &declaration, &tree, &mut errors);
        let Choice { lowered, derived, .. } = chosen.unwrap_or_else(|| {
            panic!("nothing to derive: {}", errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
        });
        Self { declaration, tree, lowered, derived }
    }

    fn subject(&self) -> Subject<'_> {
        let Self { declaration, tree, lowered, derived } = self;
        Subject { declaration, tree, lowered, derived }
    }

    fn found(&self, derived: &Derivation, kernel: &Kernel) -> Result<SelfAdjointness, &'static str> {
        let found = verify(Subject { derived, ..self.subject() }, kernel);
        found.map(|verified| verified.self_adjointness).map_err(|unconfirmed| match unconfirmed {
            Objection::Disagrees(term) => term,
            other => panic!("{other:?}"),
        })
    }

    pub(crate) fn verified(&self) -> Result<SelfAdjointness, &'static str> {
        self.found(&self.derived, &kernel(&self.derived))
    }

    fn sureness(&self) -> Sureness {
        verify(self.subject(), &kernel(&self.derived)).expect("right").sureness
    }

    /// The result of the self-check after a change of the derived terms.
    fn after(&self, change: impl Fn(&mut Derivation)) -> Result<SelfAdjointness, &'static str> {
        let mut derived = self.derived.clone();
        change(&mut derived);
        self.found(&derived, &kernel(&derived))
    }

    pub(crate) fn kinetic_part(&self) -> KineticPart {
        kinetic_part(self.subject())
    }
}

fn negate(expression: &mut Expression) {
    *expression = expression.clone().scaled(-Rational::ONE);
}

/// A top on SO(3), whose step is in Cayley coordinates, and a planar body on SE(2), whose step is in `F`.
fn both() -> [Case; 2] {
    let top = Case::new(HEAVY_TOP, &top("NonstandardInertia"));
    let planar = Case::new(
        "group = SE2, advected(w = up),
        l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * g * w.dot(&(r + F * r))",
        "struct Planar { J: Matrix3<f64>, g: f64, r: Vector3<f64>, up: Vector3<f64> }",
    );
    [top, planar]
}

type Of = fn(&mut Derivation) -> &mut Expression;

/// The self-check names the broken term; the tables of small errors have every entry of these terms.
#[test]
fn what_is_wrong_is_named() {
    let terms: [(&str, Of); 8] = [
        ("right momentum map", |d| &mut d.right_momentum),
        ("left momentum map", |d| &mut d.left_momentum),
        ("diamond term", |d| &mut d.diamond),
        ("momentum equation", |d| &mut d.momentum),
        ("discrete energy", |d| &mut d.energy),
        ("Newton Jacobian", |d| &mut d.jacobian),
        ("transported momentum", |d| &mut d.kick_after),
        ("Newton residual", |d| &mut d.kick_before),
    ];
    for declared in both() {
        assert!(declared.verified().is_ok());
        for (name, term) in terms {
            assert_eq!(declared.after(|derived| negate(term(derived))), Err(name));
        }
        // A negative multiple of the system has the same solution, but not the same branch.
        let mut kernel = kernel(&declared.derived);
        for output in kernel.residual.iter_mut().chain(&mut kernel.jacobian) {
            *output = kernel.graph.negate(*output);
        }
        assert_eq!(declared.found(&declared.derived, &kernel), Err("Newton residual"));
    }
}

fn with_one_sign_changed(expression: &Expression) -> Expression {
    let (first, coefficient) = expression.terms().last().expect("a term");
    let mut twice = Expression::zero(expression.shape());
    twice.add_term(first.clone(), coefficient + coefficient);
    expression.clone().minus(twice)
}

#[test]
fn adjoints() {
    // A Lagrangian that the symbolic form wrongly finds self-adjoint is an error.
    let declared = Case::new(
        "group = SO3, l_d = (J_d.trace() - (F * J_d).trace()) / h + h * F[(0, 1)]",
        "struct Body { J_d: NonstandardInertia }",
    );
    assert_eq!(declared.verified(), Ok(SelfAdjointness::No));
    assert_eq!(declared.after(|d| d.adjoint_defect = Expression::zero((1, 1))), Err("adjoint"));
}

/// The degrees of expressions, counted by hand: a field and `h` count as 1, `F` on a group of dimension one as 2/Δ with
/// a denominator of degree 2.
#[test]
fn degrees() {
    let of = |l_d: &str| {
        let (declaration, tree) = checked(&format!("group = R1, l_d = {l_d}"), "struct Body { k: f64 }");
        let mut number = Degree::stream();
        let (element, _) = degree::element(&declaration.group, 0, &mut number);
        let mut values = BTreeMap::from([(Name::Increment(0), element.matrices[0].clone())]);
        let mut variable = || Value::scalar(number());
        values.extend([(Name::Step, variable()), (Name::Field(0), variable())]);
        let (value, mut largest) = (Evaluation::new(&values).of(&tree).first(), Largest::default());
        largest.compared(value, value);
        largest.coincidences(Content::of_tree(&tree).functions)
    };
    // k F²/h is 5/(Δ² h), and so is a difference of two such fractions, with equal powers of Δ and of h.
    assert_eq!(of("k * F[(0, 1)].powi(2) / h"), 5);
    assert_eq!(of("k / h + F[(0, 1)] / h"), 3);
    assert_eq!(of("F[(0, 1)] / (h + 1.0) + k / (1.0 + h)"), 3);
    // A sum of quotients with two divisors is 4/(Δ h (h + k)), and less another such sum it has the degree five.
    assert_eq!(of("F[(0, 1)] / h + k / (h + k)"), 5);
    assert_eq!(of("k + F[(0, 1)]"), 3);
    // The sum over a common denominator is 5/(Δ² h).
    assert_eq!(of("k * F[(0, 1)] / h + F[(0, 1)].powi(2)"), 5);
    // A function counts by its argument, which is 3/Δ and has four values on the two sides with their negatives.
    assert_eq!(of("(k + F[(0, 1)]).sin()"), 1 + 16 * 10);
    // A tower of powers has too high a degree for few points to decide.
    let tower = (1..13).map(|k| format!("let x{k} = x{}.powi(16);", k - 1)).collect::<Vec<_>>().concat();
    assert!(of(&format!("{{ let x0 = k * F[(0, 1)]; {tower} x12 }}")) > 1 << 48);
    let declared = Case::new("group = R1, l_d = k * F[(0, 1)].powi(2) / h", "struct Body { k: f64 }");
    assert!(matches!(declared.sureness(), Sureness::Certified(100..)));
}

/// A derivation that is wrong by a multiple of `2⁶¹ − 1` passes, and then nothing is claimed.
#[test]
fn constants_that_are_zero_in_the_field() {
    let l_d = |mass: &str| format!("group = R1, l_d = k * F[(0, 1)].powi(2) / h + {mass} * F[(0, 1)].powi(2) / h");
    let item = "struct Body { k: f64 }";
    for mass in ["2305843009213693951.0", "4611686018427387902.0", "(2305843009213693950.0 + 1.0)"] {
        let declared = Case::new(&l_d(mass), item);
        assert_eq!(declared.sureness(), Sureness::Multiple, "{mass}");
        assert!(declared.after(|d| d.energy = with_one_sign_changed(&d.energy)).is_ok(), "{mass}");
        let expansion = expanded(&l_d(mass), item).to_string();
        assert_eq!(expansion.matches("of a step are not certified: a constant is a multiple of 2⁶¹ − 1").count(), 3);
    }
    let other = Case::new(&l_d("2305843009213693950.0"), item);
    assert!(matches!(other.sureness(), Sureness::Certified(100..)));
    assert_eq!(other.after(|d| d.energy = with_one_sign_changed(&d.energy)), Err("discrete energy"));
}

/// Groups without Cayley transforms are checked by series, which notice an error.
#[test]
fn groups_without_points() {
    let squeezes = "group = Mine, generators = [[[1.0, 0.0], [0.0, -2.0]]]";
    let l_d = "k * (F[(0, 0)] + 1.0 / F[(0, 0)]) / h";
    let declared = Case::new(&format!("{squeezes}, l_d = {l_d}"), "struct Body { k: f64 }");
    assert_eq!(declared.sureness(), Sureness::Series);
    assert_eq!(declared.after(|d| negate(&mut d.right_momentum)), Err("right momentum map"));
    let nearly = Rational::new(10_000_001, 10_000_000);
    assert_eq!(declared.after(|d| d.energy = d.energy.clone().scaled(nearly)), Err("discrete energy"));
    assert_eq!(declared.after(|d| negate(&mut d.kick_after)), Ok(SelfAdjointness::Exact));
    assert_eq!(declared.after(|d| negate(&mut d.jacobian)), Err("Newton Jacobian"));
}
