//! Each check fails on a broken term.

mod dual;
mod residue;
mod series;

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::common::{HEAVY_TOP, checked_as, expanded, struct_of, top};
use liestep_derivation::declared::errors::Errors;
use liestep_derivation::declared::lower::{Reading, readings};
use liestep_derivation::declared::{Declaration, Name, Role, Tree};
use liestep_derivation::judged::verify::degree::{Content, Degree, Largest};
use liestep_derivation::judged::verify::evaluation::Evaluation;
use liestep_derivation::judged::verify::value::Value;
use liestep_derivation::judged::verify::{KineticPart, Objection, Subject, Sureness, degree, kinetic_part, verify};
use liestep_derivation::judged::{Choice, cheapest, held};
use liestep_derivation::mathematics::derive::{Derivation, SelfAdjointness, derive};
use liestep_derivation::mathematics::symbolic::{Expression, Rational};
use liestep_derivation::program::{Kernel, kernel};

/// A declaration after all phases before the check.
struct Case {
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
    fn new(arguments: &str, item: &str) -> Self {
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

    fn verified(&self) -> Result<SelfAdjointness, &'static str> {
        self.found(&self.derived, &kernel(&self.derived))
    }

    fn sureness(&self) -> Sureness {
        verify(self.subject(), &kernel(&self.derived)).expect("right").sureness
    }

    /// What is found after a change of the derived terms.
    fn after(&self, change: impl Fn(&mut Derivation)) -> Result<SelfAdjointness, &'static str> {
        let mut derived = self.derived.clone();
        change(&mut derived);
        self.found(&derived, &kernel(&derived))
    }

    fn kinetic_part(&self) -> KineticPart {
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

/// Whatever is wrong with any entry of these, the tables of small errors have.
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

/// Whatever the sizes of what is new beside what isn't.
#[test]
fn functions_that_repeat_others() {
    let said = |zero: &str| -> Vec<String> {
        let seen = [
            ("R_1", "R_1 = F_1.seen_from(space)"),
            ("R_2", "R_2 = F_2.seen_from(space)"),
            ("r.", "r = d_2.seen_from(d_1)"),
        ];
        let seen: Vec<&str> = seen.iter().filter(|(name, _)| zero.contains(name)).map(|(_, seen)| *seen).collect();
        let arguments =
            format!("group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3), advected({}), zero = {zero}", seen.join(", "));
        let fields = ["a: Vector3<f64>", "b: Vector3<f64>", "k: f64"];
        let (declaration, trees) = checked_as(Role::Constraint, &arguments, &struct_of(&fields, zero));
        let mut errors = Errors::default();
        let held = held(&declaration, trees, &mut errors);
        assert_eq!(held.is_some(), errors.is_empty(), "{zero}");
        errors.iter().map(ToString::to_string).collect()
    };
    for new in [
        "(r.x, 1e12 * r.x + r.y)",
        "(r.x, 1e-12 * r.y)",
        "(r.norm() - k, k * r.norm() + 1e-12 * r.x)",
        "R_1 * a - R_2 * b",
        "(r.norm() - k, (R_1 * a).dot(&(R_2 * b)), r.dot(&(R_1 * a)))",
    ] {
        assert_eq!(said(new), Vec::<String>::new(), "{new}");
    }
    let follow = [
        ("(r.x, 1e12 * r.x)", "this follows"),
        ("(r.norm() - k, r.norm_squared())", "this follows"),
        ("(r.x, r.dot(&a) * a)", "of these 3 functions the second and the third follow from those before them"),
        ("(r.x, r.x * a + r.y * b)", "of these 3 functions the second and the third follow from those before them"),
        ("(r.x, r.component_mul(&a))", "of these 3 functions the first follows from those before it"),
        ("(r.cross(&a))", "of these 3 functions the third follows from those before it"),
        ("(r, r.component_mul(&a))", "these 3 functions follow from those before them"),
    ];
    // What is zero but for rounding.
    let constant = ("(r.x, (R_1 * a).norm_squared() - (R_2 * b).norm_squared())", "this doesn't depend on where");
    for (zero, message) in follow.into_iter().chain([constant]) {
        let said = said(zero);
        assert!(said.len() == 1 && said[0].starts_with(message), "{zero}: {said:?}");
    }
}

#[test]
fn adjoints() {
    let rho = "struct Top { I1: f64, k: f64, rho: Vector3<f64>, up: Vector3<f64> }";
    let log_trace = |kick: &str| {
        let l_d = format!("-(2.0 * I1 / h) * ((1.0 + F.trace()) / 4.0).ln() - h * k * w.dot(&({kick}))");
        Case::new(&format!("group = SO3, advected(w = up), l_d = {l_d}"), rho).verified()
    };
    assert_eq!(log_trace("0.5 * (rho + F * rho)"), Ok(SelfAdjointness::Symbolic));
    assert_eq!(log_trace("rho"), Ok(SelfAdjointness::No));
    assert_eq!(log_trace("F * rho"), Ok(SelfAdjointness::No));
    let [top, planar] = both();
    assert_eq!(top.verified(), Ok(SelfAdjointness::Symbolic));
    // Isometries leave |F − I|² alone, which a normal form without FᵀF = I can't see.
    assert_eq!(planar.verified(), Ok(SelfAdjointness::Exact));
    // A symbolic form that claims too much is an error.
    let declared = Case::new(
        "group = SO3, l_d = (J_d.trace() - (F * J_d).trace()) / h + h * F[(0, 1)]",
        "struct Body { J_d: NonstandardInertia }",
    );
    assert_eq!(declared.verified(), Ok(SelfAdjointness::No));
    assert_eq!(declared.after(|d| d.adjoint_defect = Expression::zero((1, 1))), Err("adjoint"));
}

/// Isometries keep the distance of points, not of vectors with different last coordinates.
#[test]
fn tethers_between_points() {
    let plate = |tether: &str, [point, anchor]: [&str; 2]| {
        let l_d = format!("((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * {tether}");
        let arguments = format!("group = SE2, advected(a = anchor), l_d = {l_d}");
        let item = format!("struct Plate {{ J: Matrix3<f64>, p: {point}, anchor: {anchor} }}");
        Case::new(&arguments, &item).verified()
    };
    let both = "((a - p).norm_squared() + (a - F * p).norm_squared())";
    let [points, vectors] = [["Point2<f64>"; 2], ["Vector3<f64>", "ContravariantVector<f64, 3>"]];
    assert_eq!(plate(both, points), Ok(SelfAdjointness::Exact));
    assert_eq!(plate(both, vectors), Ok(SelfAdjointness::ForPoints));
    for types in [points, vectors, [points[0], vectors[1]]] {
        assert_eq!(plate("(a - p).norm_squared()", types), Ok(SelfAdjointness::No));
    }
    // Both have to be points.
    assert_eq!(plate(both, [points[0], vectors[1]]), Ok(SelfAdjointness::ForPoints));
}

#[test]
fn added_mass_has_to_be_symmetrised() {
    let body = |translation: &str| {
        let l_d = format!("((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) + {translation} / (2.0 * h)");
        Case::new(&format!("group = SE3, l_d = {l_d}"), "struct Body { J: Matrix4<f64>, a: f64, b: f64 }").verified()
    };
    let inertial = "(a * F[(0, 3)].powi(2) + b * F[(1, 3)].powi(2))";
    let column = |k: usize| format!("(F[(0, {k})] * F[(0, 3)] + F[(1, {k})] * F[(1, 3)] + F[(2, {k})] * F[(2, 3)])");
    let turned = format!("(a * {}.powi(2) + b * {}.powi(2))", column(0), column(1));
    assert_eq!(body(inertial), Ok(SelfAdjointness::No));
    assert_eq!(body(&turned), Ok(SelfAdjointness::No));
    assert_eq!(body(&format!("0.5 * ({inertial} + {turned})")), Ok(SelfAdjointness::Exact));
}

/// On all groups an inverse is one, and a word with it is varied, reversed and taken to the limit.
#[test]
fn inverses() {
    let body = |group: &str, size: usize, other: &str| {
        let square = |d: &str| format!("(({d}) * J * ({d}).transpose()).trace()");
        let l_d = format!("({} + {}) / h", square("F - I"), square(other));
        Case::new(&format!("group = {group}, l_d = {l_d}"), &format!("struct Body {{ J: Matrix{size}<f64> }}"))
    };
    for (group, size) in [("SE2", 3), ("SL2", 2), ("Heisenberg", 3), ("SO3", 3), ("R1", 2)] {
        let both = body(group, size, "I - inverse(F)");
        assert_eq!(both.verified(), Ok(SelfAdjointness::Symbolic), "{group}");
        assert_eq!(both.kinetic_part(), KineticPart::Regular, "{group}");
        let skewed = body(group, size, "J - J * inverse(F)").verified();
        // On the line both squares are of the same number.
        let expected = if group == "R1" { SelfAdjointness::Exact } else { SelfAdjointness::No };
        assert_eq!(skewed, Ok(expected), "{group}");
    }
}

/// By hand: a field and `h` count as 1, `F` on a group of dimension one as 2/Δ with a denominator of degree 2.
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
    // Of two divisors one counts as often as there are quotients: 4/(Δ h (h + k)), less the same, has five.
    assert_eq!(of("F[(0, 1)] / h + k / (h + k)"), 5);
    assert_eq!(of("k + F[(0, 1)]"), 3);
    // Over a common denominator 5/(Δ² h).
    assert_eq!(of("k * F[(0, 1)] / h + F[(0, 1)].powi(2)"), 5);
    // One function, whose argument is 3/Δ and has four values on the two sides with their negatives.
    assert_eq!(of("(k + F[(0, 1)]).sin()"), 1 + 16 * 10);
    // A tower of powers is too high for few points to decide.
    let tower = (1..13).map(|k| format!("let x{k} = x{}.powi(16);", k - 1)).collect::<Vec<_>>().concat();
    assert!(of(&format!("{{ let x0 = k * F[(0, 1)]; {tower} x12 }}")) > 1 << 48);
    let declared = Case::new("group = R1, l_d = k * F[(0, 1)].powi(2) / h", "struct Body { k: f64 }");
    assert!(matches!(declared.sureness(), Sureness::Certified(100..)));
}

/// What is wrong by a multiple of `2⁶¹ − 1` passes, and then nothing is claimed.
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

/// As a divisor, and as all that a potential, a kinetic part, a force or a constraint is multiplied by.
#[test]
fn constants_that_are_zero_in_the_field_refuse_nothing() {
    let l_d = "group = SO3, advected(w = u), l_d = ";
    let l = "group = SO3, velocity = xi, advected(w = u), discretise = trapezoid(Cayley), l = ";
    let work = "group = SO3, advected(w = u), work = ";
    let zero = "group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
        advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space)), zero = ";
    let chord = "((F - I) * J * (F - I).transpose()).trace()";
    let squared = "(hat(xi) * J * hat(xi).transpose()).trace()";
    for (role, head, term) in [
        (Role::Lagrangian, l_d, format!("{chord} / (2.0 * h) - h * w.dot(&r) / P")),
        (Role::Lagrangian, l_d, format!("{chord} / (2.0 * h) - h * w.dot(&r).powi(2) * P")),
        (Role::Lagrangian, l_d, format!("{chord} / (2.0 * h) - h * (1.0 + w.dot(&r) / P).sqrt()")),
        (Role::Lagrangian, l_d, format!("P * {chord} / h - h * w.dot(&r)")),
        (Role::Lagrangian, l, format!("0.5 * {squared} - w.dot(&r) / P")),
        (Role::Lagrangian, l, format!("0.5 * {squared} - w.dot(&r).powi(2) * P")),
        (Role::Lagrangian, l, format!("P * {squared} - w.dot(&r)")),
        (Role::Force, work, "-P * h * w.cross(&r).dot(&eta)".to_owned()),
        (Role::Constraint, zero, "P * (R_1 * r - R_2 * u)".to_owned()),
        (Role::Constraint, zero, "(R_1 * r - R_2 * u) / P".to_owned()),
    ] {
        let arguments = format!("{head}{}", term.replace('P', "2305843009213693951.0"));
        let item = struct_of(&["J: NonstandardInertia", "r: Vector3<f64>", "u: Vector3<f64>"], &arguments);
        let [tokens, item] = [arguments.as_str(), item.as_str()].map(|text| text.parse().expect("tokens"));
        let expansion = liestep_derivation::expand(role, tokens, &item).to_string();
        assert!(!expansion.contains("compile_error"), "{arguments}: {expansion}");
        assert!(expansion.contains("a constant is a multiple of 2⁶¹ − 1"), "{arguments}");
    }
}

/// Groups of other generators have no Cayley transforms; there series are compared, and see what is wrong.
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
    let other =
        Case::new(&format!("{squeezes}, l_d = k * (F[(0, 0)] + 1.0 / F[(1, 1)]) / h"), "struct Body { k: f64 }");
    assert_eq!(other.verified(), Ok(SelfAdjointness::No));
}

/// `ln x² = 2 ln x` isn't a relation of just any function.
#[test]
fn adjoints_with_functions() {
    let body = |kick: &str| {
        let l_d = format!("((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) + h * F[(0, 3)] * ({kick})");
        Case::new(&format!("group = SE3, l_d = {l_d}"), "struct Body { J: Matrix4<f64>, k: f64 }").verified()
    };
    assert_eq!(body("k.ln() + (1.0 / k).ln()"), Ok(SelfAdjointness::Exact));
    assert_eq!(body("k.powi(2).ln() - 2.0 * k.ln()"), Ok(SelfAdjointness::No));
    assert_eq!(body("(2.0 * k - k).sin() + (-k).sin()"), Ok(SelfAdjointness::Exact));
}

#[test]
fn singular_kinetic_parts() {
    for declared in both() {
        assert_eq!(declared.kinetic_part(), KineticPart::Regular);
    }
    let kinetic_part = |group: &str, l_d: &str| {
        let arguments = format!("group = {group}, l_d = {l_d}");
        Case::new(&arguments, &struct_of(&["k: f64", "J: Matrix4<f64>", "v: Vector3<f64>"], l_d)).kinetic_part()
    };
    let rotation = "k * (4.0 - F.trace()) / h + 0.0 * h * (F * J).trace()";
    assert_eq!(kinetic_part("SE3", rotation), KineticPart::Singular(vec![3, 4, 5]));
    let axis = "k * v.dot(&vee(F - F.transpose())).powi(2) / h";
    assert_eq!(kinetic_part("SO3", axis), KineticPart::Singular(Vec::new()));
    assert_eq!(kinetic_part("SO3", "k * (F - I).norm() / h"), KineticPart::NotSmooth);
    assert_eq!(kinetic_part("SO3", "k * (F - I).norm_squared() / h"), KineticPart::Regular);
}

#[test]
fn kinetic_parts_that_are_not_stationary() {
    let kinetic_part = |group: &str, l_d: &str| {
        let arguments = format!("group = {group}, l_d = {l_d}");
        Case::new(&arguments, &struct_of(&["k: f64", "A: Matrix3<f64>", "B: Matrix3<f64>"], l_d)).kinetic_part()
    };
    assert_eq!(kinetic_part("SO3", "k * (F * A).trace() / h"), KineticPart::NotStationary(vec![1]));
    assert_eq!(kinetic_part("SO3", "(F * (k * A + B)).trace() / h"), KineticPart::NotStationary(vec![1, 2]));
    assert_eq!(kinetic_part("SO3", "(F * (A + A.transpose())).trace() / h"), KineticPart::Regular);
    let squared = "((F - I) * B * (F - I).transpose()).trace() / h";
    assert_eq!(kinetic_part("SO3", &format!("(F * A).trace() / h + {squared}")), KineticPart::NotStationary(vec![0]));
    assert_eq!(kinetic_part("SO3", "k * F[(0, 1)] / h"), KineticPart::NotStationary(Vec::new()));
    // The normal form knows neither that generators have no trace, nor that columns of I are orthogonal.
    assert_eq!(kinetic_part("SL2", "k * (F.trace() - 2.0) / h"), KineticPart::Regular);
    assert_eq!(kinetic_part("R1", "k * F[(0, 1)].powi(2) / h"), KineticPart::Regular);
}
