//! Derived terms with an error of one part in `2⁵⁰` are refused, for each term of every declaration.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::rc::Rc;

use proc_macro2::TokenStream;

use crate::common::bodies::{CART, LINKS, OF_CART, OF_LINKS};
use crate::common::{HEAVY_TOP, checked_as, evaluated, tokens, top};
use crate::generated::texts::on_a_product;
use crate::refused::once_refused;
use crate::time::declarations_in;
use liestep_derivation::declared::errors::Errors;
use liestep_derivation::declared::{Declaration, Role, Tree, check, lower, parse};
use liestep_derivation::judged::verify::identities::{Identities, Terms};
use liestep_derivation::judged::verify::number::Number;
use liestep_derivation::judged::verify::residue::Residue;
use liestep_derivation::judged::verify::sample::{Element, Sample};
use liestep_derivation::judged::verify::{Findings, Objection, Row, Subject, Sureness, constraint, verify};
use liestep_derivation::judged::{self, Choice, cheapest, held};
use liestep_derivation::mathematics::derive::{Derivation, View, derive};
use liestep_derivation::mathematics::symbolic::{Expression, Rational, SymbolId, degree};
use liestep_derivation::program::{ByNumbers, Derivatives, Input, Kernel, NodeId, WeightedGradient, kernel};

/// The relative errors of a coefficient.
const ERRORS: [(i128, i128); 2] = [(1, 10_000_000), (1, 1 << 50)];

/// A derived term of a declaration, by its name and its place in the derivation.
type Term = (&'static str, fn(&mut Derivation) -> Option<&mut Expression>);

const TERMS: [Term; 14] = [
    ("right momentum map", |d| Some(&mut d.right_momentum)),
    ("left momentum map", |d| Some(&mut d.left_momentum)),
    ("diamond", |d| Some(&mut d.diamond)),
    ("momentum equation", |d| Some(&mut d.momentum)),
    ("Jacobian", |d| Some(&mut d.jacobian)),
    ("energy", |d| Some(&mut d.energy)),
    ("kick before", |d| Some(&mut d.kick_before)),
    ("unknown part", |d| Some(&mut d.unknown)),
    ("kick after", |d| Some(&mut d.kick_after)),
    ("kick derivative", |d| d.kick_derivative.as_mut()),
    ("cleared residual", |d| d.cleared.as_mut().map(|cleared| &mut cleared.residual)),
    ("cleared Jacobian", |d| d.cleared.as_mut().map(|cleared| &mut cleared.jacobian)),
    ("momentum at the start", |d| d.ends.as_mut().map(|ends| &mut ends.momenta[0])),
    ("momentum at the end", |d| d.ends.as_mut().map(|ends| &mut ends.momenta[1])),
];

/// The stages of a step, as they are emitted.
const STAGES: [fn(&mut Kernel) -> &mut [NodeId]; 5] = [
    |kernel| &mut kernel.kick_before,
    |kernel| &mut kernel.residual,
    |kernel| &mut kernel.jacobian,
    |kernel| &mut kernel.kick_after,
    |kernel| kernel.kick_derivative.as_deref_mut().unwrap_or_default(),
];

/// The degree of a monomial in a symbol.
type Degrees<'a> = &'a dyn Fn(SymbolId) -> usize;

/// The choice of the monomials with an error, by their places and degrees.
type Place = Box<dyn for<'a> Fn(usize, Degrees<'a>) -> bool>;

/// Counts for each term: of the declarations that have it, of the errors tried, and of those refused.
type Table = BTreeMap<&'static str, [usize; 3]>;

fn assert_all_refused(table: &Table) {
    println!("{:24} declarations   tried refused", "term");
    for (term, [declarations, tried, refused]) in table {
        println!("{term:24} {declarations:12} {tried:7} {refused:7}");
    }
    assert!(table.values().all(|[_, tried, refused]| tried == refused), "some pass");
}

struct Case {
    declaration: Declaration,
    tree: Rc<Tree>,
    chosen: Choice,
}

impl Case {
    /// The derivation of a declaration, or `None` if it has no step.
    fn new(role: Role, arguments: &TokenStream, item: &TokenStream) -> Option<Self> {
        let mut errors = Errors::default();
        let declaration = parse::declaration(role, arguments, item, &mut errors)?;
        let mut tree = check::check(&declaration, &mut errors)?;
        let mut equations = None;
        if declaration.continuous.is_some() {
            equations = Some(judged::of_declared(&declaration, &tree, &mut errors)?);
            tree = judged::discretised(&declaration, &tree, declaration.discretisation()?, &mut errors)?;
        }
        let mut readings = lower::readings(&declaration, &tree, &mut errors)?;
        if let Some(equations) = &equations {
            readings = readings.into_iter().map(|reading| equations.behind(reading)).collect();
        }
        let chosen = cheapest(readings, derive, &declaration, &tree, &mut errors)?;
        Some(Self { declaration, tree, chosen })
    }

    fn subject<'a>(&'a self, derived: &'a Derivation) -> Subject<'a> {
        Subject { declaration: &self.declaration, tree: &self.tree, lowered: &self.chosen.lowered, derived }
    }

    fn found(&self, derived: &Derivation, kernel: &Kernel) -> Result<Findings, Objection> {
        verify(self.subject(derived), kernel)
    }

    /// The values of all emitted outputs at one point.
    fn emitted(&self, derived: &Derivation, kernel: &Kernel) -> Vec<Residue> {
        let (mut number, group) = (Residue::stream(9), &self.declaration.group);
        let element = Element::by_cayley(group, &mut number).expect("points");
        let sample: Sample<Residue> = Sample::at(self.subject(derived), element, &mut number);
        emitted(&Identities::new(sample.of, kernel), &sample, number)
    }

    /// Whether a wrong term is refused; none if the wrong term isn't emitted.
    fn is_refused(&self, change: impl Fn(&mut Derivation)) -> Option<bool> {
        let mut derived = self.chosen.derived.clone();
        change(&mut derived);
        let kernel = kernel(&derived);
        let is_refused = matches!(self.found(&derived, &kernel), Err(Objection::Disagrees(_)));
        let reaches = || self.emitted(&derived, &kernel) != self.emitted(&self.chosen.derived, &self.chosen.kernel);
        (is_refused || reaches()).then_some(is_refused)
    }

    /// The places of errors in a term: all of its monomials, one of the first `most`, or those with a relative
    /// configuration.
    fn places(&self, term: &Expression, most: usize) -> Vec<(Option<&'static str>, Place)> {
        let mut places: Vec<(_, Place)> = vec![(None, Box::new(|_: usize, _: Degrees| true))];
        for first in 0..term.len().min(most) {
            places.push((None, Box::new(move |place: usize, _: Degrees| place == first)));
        }
        let bodies = self.declaration.advected.iter().zip(&self.chosen.lowered.declared.advected);
        for (w, carried) in bodies.filter(|(_, carried)| term.contains(carried.symbol)) {
            if matches!(w.seen, View::Relative { .. } | View::Configuration(_)) {
                let id = carried.symbol;
                places.push((Some("what a body sees"), Box::new(move |_: usize, degree: Degrees| degree(id) > 0)));
            }
        }
        places
    }

    /// Checks that errors of each term are refused; `is_meant` selects terms and errors.
    fn check_terms(&self, most: usize, table: &mut Table, is_meant: impl Fn(usize, usize) -> bool) {
        for (at, (name, of)) in TERMS.into_iter().enumerate() {
            let Some(term) = of(&mut self.chosen.derived.clone()).filter(|term| !term.is_zero()).cloned() else {
                continue;
            };
            let is_force = self.declaration.role == Role::Force;
            let (name, most) = if is_force { ("a term of a force", term.len()) } else { (name, most) };
            let mut met = BTreeSet::new();
            for (error, (numerator, denominator)) in ERRORS.into_iter().enumerate().filter(|(e, _)| is_meant(at, *e)) {
                for (row, is_place) in self.places(&term, most) {
                    let wrong = larger(&term, Rational::new(numerator, denominator), &is_place);
                    let found =
                        self.is_refused(|derived| of(derived).into_iter().for_each(|term| term.clone_from(&wrong)));
                    let Some(is_refused) = found else { continue };
                    let row = row.unwrap_or(name);
                    let [declarations, tried, refused] = table.entry(row).or_default();
                    *declarations += usize::from(met.insert(row));
                    *tried += 1;
                    *refused += usize::from(is_refused);
                    if !is_refused {
                        println!("{name}, {row}, error {error}: passes for {}", self.declaration.item.ident);
                    }
                }
            }
        }
    }

    /// Checks that an error in each entry of each stage is refused.
    fn check_stages(&self) {
        let Choice { derived, kernel, .. } = &self.chosen;
        for (stage, of) in STAGES.into_iter().enumerate() {
            for at in 0..of(&mut kernel.clone()).len() {
                let mut wrong = kernel.clone();
                let node = of(&mut wrong)[at];
                let error = wrong.graph.constant(Rational::new(1, 1 << 50));
                of(&mut wrong)[at] = wrong.graph.add(node, error);
                let found = self.found(derived, &wrong).map(|verified| verified.sureness);
                assert!(
                    matches!(found, Err(Objection::Disagrees(_))),
                    "entry {at} of stage {stage} of {}: {found:?}",
                    self.declaration.item.ident
                );
            }
        }
    }
}

/// The term with the selected coefficients larger by a relative error.
fn larger(term: &Expression, error: Rational, is_meant: &Place) -> Expression {
    let mut sum = term.clone();
    for (place, (monomial, coefficient)) in term.terms().enumerate() {
        if is_meant(place, &|id| degree(monomial, id)) {
            sum.add_term(monomial.clone(), coefficient * error);
        }
    }
    sum
}

fn prepared(role: Role, arguments: &str, item: &str) -> Case {
    Case::new(role, &tokens(arguments), &tokens(item)).expect("a step")
}

#[test]
fn small_errors_of_terms_and_stages() {
    let two = "group(F_1 = SO3, F_2 = SO3), advected(w_1 = up.seen_from(F_1), Q = F_2.seen_from(F_1)),
        l_d = {
            let U = |y: Vector3<f64>| { let z = y.dot(&rho); z * (1.0 + y.norm_squared()).sqrt() };
            ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
                + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
                - 0.5 * h * (k * (Q.trace() + (F_1.transpose() * Q * F_2).trace()) + g * (U(w_1) + U(F_1 * w_1)))
        }";
    let bodies = "struct Two { J_1: NonstandardInertia, J_2: NonstandardInertia, k: f64, g: f64, rho: Vector3<f64>,
        up: Vector3<f64> }";
    let planar = "group = SE2, advected(w = up),
        l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * g * w.dot(&(r + F * r))";
    let of_planar = "struct Planar { J: Matrix3<f64>, g: f64, r: Vector3<f64>, up: Vector3<f64> }";
    let drag = "group = SO3, advected(b = field),
        work = h * c * b.cross(&(F * b)).dot(&eta) - vee(F).dot(&(D * (eta + eta_next)))";
    let of_drag = "struct Drag { D: Matrix3<f64>, c: f64, field: Vector3<f64> }";
    let ([of_top, gradients], log) = (
        [top("NonstandardInertia"), format!("{HEAVY_TOP}, gradients")],
        "group = SO3, advected(w = up), l_d = 0.5 * log(F).dot(&(J * log(F))) / h - h * (1.0 + w.norm()).sqrt().exp()",
    );
    let of_log = "struct Geodesic { J: Inertia, up: Vector3<f64> }";
    let midpoint = "discretise = trapezoid(Cayley)";
    let own = [
        (Role::Lagrangian, gradients.as_str(), of_top.as_str()),
        (Role::Lagrangian, planar, of_planar),
        (Role::Lagrangian, two, bodies),
        (Role::Lagrangian, log, of_log),
        (Role::Lagrangian, &format!("{LINKS}, {midpoint}"), OF_LINKS),
        (Role::Lagrangian, &format!("{CART}, {midpoint}"), OF_CART),
        (Role::Force, drag, of_drag),
    ];
    let mut table = Table::new();
    for (role, arguments, item) in own {
        let prepared = prepared(role, arguments, item);
        prepared.check_terms(3, &mut table, |_, _| true);
        prepared.check_stages();
    }
    for seed in 0..6 {
        let (arguments, item) = on_a_product(seed);
        prepared(Role::Lagrangian, &arguments, &item).check_terms(1, &mut table, |_, _| true);
    }
    assert_all_refused(&table);
}

/// A derivative of a step to be made wrong, and the name of its term.
type Derivative = (&'static str, fn(&mut Derivatives) -> &mut NodeId);

const DERIVATIVES: [Derivative; 12] = [
    ("derivative of a step", |all| &mut all.blocks[0][0][5]),
    ("derivative of a step", |all| &mut all.blocks[0][1][3]),
    ("derivative of a step", |all| &mut all.blocks[1][0][1]),
    ("derivative of a step", |all| &mut all.blocks[1][1][7]),
    ("derivative by the parameters", |all| &mut all.by_numbers[0][1].1[0]),
    ("derivative by the parameters", |all| &mut all.by_numbers[1][2].1[5]),
    ("adjoint of a step", |all| &mut all.by_turn[1]),
    ("gradient of a step", |all| &mut all.gradient.by_place[1]),
    ("gradient of a step", |all| &mut all.gradient.by_numbers[0][1].1[0]),
    ("gradient of a step", |all| &mut all.gradient.by_numbers[1][2].1[0]),
    ("gradient of a kick", |all| &mut of_kick(all).by_place[0]),
    ("gradient of a kick", |all| &mut of_kick(all).by_numbers[1][1].1[0]),
];

fn of_kick(all: &mut Derivatives) -> &mut WeightedGradient {
    all.of_kick.as_mut().expect("a potential has one")
}

/// Errors of each emitted derivative of a step are refused, and so are errors of both numbers of an off-diagonal entry,
/// which share one symbol.
#[test]
fn small_errors_of_gradients() {
    let prepared = prepared(Role::Lagrangian, &format!("{HEAVY_TOP}, gradients"), &top("NonstandardInertia"));
    let of = prepared.subject(&prepared.chosen.derived);
    let found = |change: &dyn Fn(&mut Derivatives)| {
        let mut identities = Identities::new(of, &prepared.chosen.kernel);
        change(identities.derivatives.as_mut().expect("asked for"));
        identities.confirmed().map(|(sureness, _)| sureness)
    };
    let by = |error: Rational, place: fn(&mut Derivatives) -> &mut NodeId| {
        found(&|all| {
            let (node, share) = (*place(all), all.graph.constant(error));
            let share = all.graph.multiply(node, share);
            *place(all) = all.graph.add(node, share);
        })
    };
    for (at, (term, place)) in DERIVATIVES.into_iter().enumerate() {
        assert_eq!(by(Rational::new(1, 1 << 50), place), Err(Objection::Disagrees(term)), "{at}");
    }
    // The derivative by either number of an off-diagonal entry is doubled, and the inertia of a kick changes its sign.
    let at =
        |by: &ByNumbers, number| by[0].iter().position(|(own, _)| *own == number).expect("an entry of the inertia");
    let doubled = found(&|all| {
        for number in [1, 3] {
            let at = at(&all.by_numbers, number);
            let twice = |node: &NodeId| all.graph.add(*node, *node);
            all.by_numbers[0][at].1 = all.by_numbers[0][at].1.iter().map(twice).collect();
        }
    });
    assert_eq!(doubled, Err(Objection::Disagrees("derivative by the parameters")));
    let turned = found(&|all| {
        let at = at(&of_kick(all).by_numbers, 4);
        let node = of_kick(all).by_numbers[0][at].1[0];
        of_kick(all).by_numbers[0][at].1[0] = all.graph.negate(node);
    });
    assert_eq!(turned, Err(Objection::Disagrees("gradient of a kick")));
    let right = found(&|_| ());
    assert!(matches!(right, Ok(Sureness::Certified(100..))), "{right:?}");
}

/// Each rule of differentiation of a step is right forwards and in reverse.
#[test]
fn derivatives_of_all_functions() {
    let l_d = "0.5 * log(F).dot(&(J * log(F))) / h - h * (1.0 + w.norm_squared()).sqrt() * (m / (2.0 + w.z)).ln()
        - h * (w.x * k).sin() * (m * w.y).cos() / (1.0 + (k - w.z).exp()) - h * exp(k * w).trace() * m.powi(3)";
    let item = "struct Body { J: Inertia, k: f64, m: f64, up: Vector3<f64> }";
    let prepared = prepared(Role::Lagrangian, &format!("group = SO3, advected(w = up), l_d = {l_d}, gradients"), item);
    let found = prepared.found(&prepared.chosen.derived, &prepared.chosen.kernel).map(|found| found.sureness);
    assert!(matches!(found, Ok(Sureness::Certified(100..))), "{found:?}");
}

/// Checks that errors of each slope of a constraint are refused; returns the number of slopes.
fn check_slopes(declaration: &Declaration, trees: &[Rc<Tree>]) -> usize {
    let held = || held(declaration, trees.to_vec(), &mut Errors::default()).expect("a constraint");
    let (sureness, rows) = constraint(declaration, &held()).expect("right");
    assert!(matches!(sureness, Sureness::Certified(100..)) && rows.iter().all(|row| *row == Row::New));
    for body in 0..2 {
        for (by, at) in (0..3 * held().rows()).flat_map(|at| [(0, at), (1, at)]) {
            for (numerator, denominator) in ERRORS {
                let mut held = held();
                let error = held.graph.constant(Rational::new(numerator, denominator));
                let entry = &mut held.entries[body][by][at];
                *entry = held.graph.add(*entry, error);
                let found = constraint(declaration, &held).map(|(sureness, _)| sureness);
                assert_eq!(found, Err(Objection::Disagrees("slope")), "{body} {by} {at}");
            }
        }
    }
    2 * 2 * 3 * held().rows() * ERRORS.len()
}

#[test]
fn small_errors_of_slopes() {
    let arguments = "group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
        advected(R_1 = F_1.seen_from(space), Q = F_2.seen_from(F_1), r = d_2.seen_from(d_1)),
        zero = (R_1.transpose() * r + Q * below, (Q * below).dot(&axis).sin())";
    let item = "struct Joint { below: Vector3<f64>, axis: Vector3<f64> }";
    let (declaration, trees) = checked_as(Role::Constraint, arguments, item);
    assert_eq!(check_slopes(&declaration, &trees), 2 * 2 * 3 * 4 * 2);
}

/// All declarations of the repository, of other tests and of [`once_refused`] are tried with one term and error in
/// `share` of them, another one in the next declaration; returns the number of declarations.
fn check_everywhere(share: usize, most: usize) -> usize {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let (mut all, mut table, mut count) = (Vec::new(), Table::new(), 0);
    for folder in ["core/src", "examples", "tests", "tests/ui/pass"] {
        declarations_in(&root.join(folder), &mut all);
    }
    let texts = once_refused().into_iter();
    all.extend(texts.map(|[text, item]| (text.clone(), Role::Lagrangian, tokens(&text), tokens(&item))));
    for (name, role, arguments, item) in all {
        if role == Role::Constraint {
            let mut errors = Errors::default();
            let declaration = parse::declaration(role, &arguments, &item, &mut errors).expect("a declaration");
            let tried = check_slopes(&declaration, &check::functions(&declaration, &mut errors).expect("functions"));
            let row = table.entry("slope of a constraint").or_default();
            *row = [row[0] + 1, row[1] + tried, row[2] + tried];
        } else if let Some(prepared) = Case::new(role, &arguments, &item) {
            let found = prepared.found(&prepared.chosen.derived, &prepared.chosen.kernel);
            assert!(found.is_ok(), "{name}: {:?}", found.err());
            if Element::by_cayley(&prepared.declaration.group, &mut Residue::stream(1)).is_some() {
                prepared.check_terms(most, &mut table, |term, error| (2 * term + error + count).is_multiple_of(share));
            }
        } else {
            continue;
        }
        count += 1;
    }
    assert_all_refused(&table);
    count
}

#[test]
fn small_errors_in_turn() {
    assert!(check_everywhere(11, 0) > 100);
}

#[test]
#[ignore = "some minutes: `cargo test -p liestep-derivation-long-tests small_errors_everywhere -- --ignored --nocapture`"]
fn small_errors_everywhere() {
    assert!(check_everywhere(1, 1) > 100);
}

/// The values of all emitted outputs at one point.
fn emitted<T: Number>(identities: &Identities, sample: &Sample<T>, mut number: impl FnMut() -> T) -> Vec<T> {
    let mut vector = || identities.of.derived.group.generators.iter().map(|_| number()).collect::<Vec<T>>();
    let inputs = identities.inputs_of_stages(sample, [&vector(), &vector()]);
    let input =
        |input: Input| inputs.get(&input.symbol).map_or(T::UNDEFINED, |value| value.at(input.row, input.column));
    let Terms { graph, momentum, jacobian, right, left, diamond, energy } = &identities.terms;
    let terms = [momentum.as_slice(), jacobian, right, left, diamond, energy.as_slice()].concat();
    let kernel = identities.kernel;
    let stages = [&kernel.kick_before, &kernel.residual, &kernel.jacobian, &kernel.kick_after];
    let change = kernel.kick_derivative.clone().unwrap_or_default();
    let stages = stages.into_iter().chain([&change]).flatten().copied().collect::<Vec<_>>();
    let mut all = [evaluated(graph, &terms, &input), evaluated(&kernel.graph, &stages, &input)].concat();
    if let Some(Derivatives { graph, blocks, momenta, .. }) = &identities.derivatives {
        all.extend(evaluated(graph, &[blocks.as_flattened().concat(), momenta.clone()].concat(), &input));
    }
    all
}
