//! Steps as one machine function are those of the interpreted driver, to the bit: states with their memories, iterations, and
//! errors, near and far from the identity; and machine code has a bounded place.

use std::collections::BTreeMap;

use declarations::{
    Alike, CayleyTop, ContinuousTop, DoublePendulum, ElasticFlow, FallingBody, FloatingBody, Flyer, FourthOrderTop,
    FreeBody, FullTop, Gyrostat, HeavyTop, LogTop, LogTraceTop, Magnet, OrbitingBody, Satellite, SixthOrderTop,
    SlidingTop, Spring as SpringTop, SuspendedLoad, TetheredPlate, TopOnCart, TwoBodies, UnderwaterBody,
};
use liestep::effects::{Drag, Gravity, GravityGradient, RigidBody, Rotor, Torque};
use liestep::laws::samples::Random;
use liestep::mechanics::Effect;
use liestep::motion::Propagator as _;
use liestep::motion::{AnyState, AnyStepper, Integrator as _};
use liestep::with::Method;
use liestep_derivation::ParameterKind;
use liestep_late::{Backend, BackendInLanes, Declaration, Interpreter, Whole, WholeError};
use liestep_machine::{Machine, used_memory};

fn metric(random: &mut Random, rows: usize) -> Vec<f64> {
    let root: Vec<f64> = (0..rows * rows).map(|_| random.signed()).collect();
    let entry = |i: usize, j: usize| (0..rows).map(|k| root[i * rows + k] * root[j * rows + k]).sum::<f64>() * 0.3;
    (0..rows * rows).map(|at| entry(at / rows, at % rows) + f64::from(u8::from(at / rows == at % rows))).collect()
}

/// Random numbers for which a declaration is valid, if its matrices are metrics.
fn numbers(declaration: &Declaration, random: &mut Random) -> Vec<f64> {
    let mut of = |kind: ParameterKind| -> Vec<f64> {
        match kind {
            ParameterKind::Scalar => vec![1.0 + 0.5 * random.signed()],
            ParameterKind::Vector(rows) => (0..rows).map(|_| random.signed()).collect(),
            ParameterKind::Matrix(rows) => metric(random, rows),
            ParameterKind::Inertia => metric(random, 3),
            ParameterKind::DiagonalInertia => (0..3).map(|_| 1.5 + 0.5 * random.signed()).collect(),
        }
    };
    declaration.parameters.iter().flat_map(|parameter| of(parameter.kind)).collect()
}

/// The identity of each factor.
fn identity(declaration: &Declaration) -> Vec<f64> {
    let rows = declaration.factors.iter().map(|factor| factor.generators[0].len().isqrt());
    rows.flat_map(|rows| (0..rows * rows).map(move |at| f64::from(u8::from(at / rows == at % rows)))).collect()
}

fn bits(state: &[f64]) -> Vec<u64> {
    state.iter().map(|number| if number.is_nan() { u64::MAX } else { number.to_bits() }).collect()
}

/// The counts of a comparison.
#[derive(Debug, Default)]
struct Counts {
    steps: u32,
    errors: u32,
    with_care: u32,
    iterations: BTreeMap<u32, u32>,
}

fn of<B: Backend<f64>>(text: &'static Declaration, all: &[f64], h: f64, method: &str) -> Result<Whole<B>, WholeError> {
    Whole::of(text, all, h, method.parse::<Method>().expect("a method"))
}

/// Compares the steps of a declaration with random numbers.
fn compare(declaration: &'static Declaration, method: &str, seed: u64, seen: &mut Counts) {
    let mut random = Random::new(seed);
    let values = numbers(declaration, &mut random);
    let n: usize = declaration.factors.iter().map(|factor| factor.generators.len()).sum();
    let velocity: Vec<f64> = (0..n).map(|_| random.signed()).collect();
    for (h, steps) in [(0.01, 1100), (-0.01, 100), (0.15, 100), (0.4, 100), (1.5, 30), (0.0, 3)] {
        let what = format!("{} by {method} of {h} s", declaration.name);
        let (one, other) =
            (of::<Interpreter>(declaration, &values, h, method), of::<Machine>(declaration, &values, h, method));
        let (Ok(one), Ok(other)) = (&one, &other) else {
            assert_eq!(one.map(|_| ()), other.map(|_| ()), "{what}");
            continue;
        };
        other.prepare();
        let starts = (one.start(&identity(declaration), &velocity), other.start(&identity(declaration), &velocity));
        let (Ok(mut expected), Ok(mut state)) = starts.clone() else {
            assert_eq!(starts.0, starts.1, "{what}");
            continue;
        };
        for step in 0..steps {
            let (report, found) = (one.step(&mut expected), other.step(&mut state));
            assert_eq!(found, report, "step {step} of {what}");
            assert_eq!(bits(&state), bits(&expected), "step {step} of {what}");
            let Ok(report) = report else {
                seen.errors += 1;
                break;
            };
            seen.steps += 1;
            seen.with_care += u32::from(report.iterations > 20);
            *seen.iterations.entry(report.iterations).or_default() += 1;
        }
    }
}

macro_rules! texts {
    ($($name:ident)+) => { [$(<$name as Effect>::DECLARATION),+] };
}

/// Volume-preserving maps, whose increments are products of Cayley maps; and functions that are calls.
const OTHERS: [&str; 2] = [
    "#[lagrangian(group = SL3, generators = [
        [[0., 1., 0.], [0., 0., 0.], [0., 0., 0.]], [[0., 0., 1.], [0., 0., 0.], [0., 0., 0.]],
        [[0., 0., 0.], [0., 0., 1.], [0., 0., 0.]], [[0., 0., 0.], [1., 0., 0.], [0., 0., 0.]],
        [[0., 0., 0.], [0., 0., 0.], [1., 0., 0.]], [[0., 0., 0.], [0., 0., 0.], [0., 1., 0.]],
        [[1., 0., 0.], [0., -1., 0.], [0., 0., 0.]], [[0., 0., 0.], [0., 1., 0.], [0., 0., -1.]],
    ], l_d = (((F - I) * J * (F - I).transpose()).trace()
        + ((I - inverse(F)) * J * (I - inverse(F)).transpose()).trace()) / (4 * h))]
    struct Flow { J: Matrix3<f64> }",
    "#[lagrangian(group = SO3, advected(w = up), l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * ((0.3 * w.dot(&rho)).sin() + (0.3 * w.dot(&(F * rho))).sin() + (0.2 * w.dot(&(F * rho))).exp()))]
    struct Waves { J: NonstandardInertia, rho: Vector3<f64>, up: Vector3<f64> }",
];

/// Three bodies with potentials of their relative attitudes.
const THREE: &str = "#[lagrangian(group(F_1 = SO3, F_2 = SO3, F_3 = SO3),
    advected(Q = F_2.seen_from(F_1), P = F_3.seen_from(F_1)),
    l_d = (((F_1 - I) * A * (F_1 - I).transpose()).trace() + ((F_2 - I) * B * (F_2 - I).transpose()).trace()
        + ((F_3 - I) * B * (F_3 - I).transpose()).trace()) / (2 * h)
        + h * k * ((D * Q).trace() + (D * F_1.transpose() * Q * F_2).trace() + P.trace()
            + (F_1.transpose() * P * F_3).trace()) / 2)]
    struct Three { A: Matrix3<f64>, B: Matrix3<f64>, D: Matrix3<f64>, k: f64 }";

/// A free motion on the group of these generators, each by the rows, columns and values of its entries.
fn free(name: &str, rows: usize, generators: &[Vec<(usize, usize, i8)>]) -> String {
    let matrix = |entries: &Vec<(usize, usize, i8)>| {
        let mut all = vec![vec![0; rows]; rows];
        entries.iter().for_each(|&(i, j, entry)| all[i][j] = entry);
        all
    };
    let generators: Vec<_> = generators.iter().map(matrix).collect();
    format!(
        "#[lagrangian(group = Own, generators = {generators:?}, l_d = (((F - I) * J * (F - I).transpose()).trace()
            + ((I - inverse(F)) * J * (I - inverse(F)).transpose()).trace()) / (4 * h))]
        struct {name} {{ J: SMatrix<f64, {rows}, {rows}> }}"
    )
}

/// Galilean maps, of five rows; rotations of four dimensions; symplectic maps of two places and momenta.
fn on_many_rows() -> [String; 3] {
    let turns = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| vec![(i, j, -1), (j, i, 1)]);
    let columns = (0..6).map(|k| vec![(k % 3, 3 + k / 3, 1)]);
    let galilean: Vec<_> = turns.into_iter().chain(columns).chain([vec![(3, 4, 1)]]).collect();
    let turns = (0..4).flat_map(|i| (i + 1..4).map(move |j| vec![(i, j, -1), (j, i, 1)]));
    let pairs = (0..2).flat_map(|i| (0..2).map(move |j| vec![(i, j, 1), (2 + j, 2 + i, -1)]));
    let others = [(0, 2), (2, 0)]
        .into_iter()
        .flat_map(|(i, j)| [vec![(i, j, 1)], vec![(i + 1, j + 1, 1)], vec![(i, j + 1, 1), (i + 1, j, 1)]]);
    let symplectic: Vec<_> = pairs.chain(others).collect();
    [
        free("Galilean", 5, &galilean),
        free("Rotations", 4, &turns.collect::<Vec<_>>()),
        free("Symplectic", 4, &symplectic),
    ]
}

fn parsed(text: &str) -> &'static Declaration {
    Declaration::parse(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[test]
fn steps_of_all_declarations() {
    let texts = texts! {
        HeavyTop FullTop CayleyTop LogTop LogTraceTop ContinuousTop SlidingTop FreeBody Magnet Satellite SpringTop
        FourthOrderTop SixthOrderTop ElasticFlow TetheredPlate Flyer OrbitingBody UnderwaterBody DoublePendulum TopOnCart
        FloatingBody FallingBody SuspendedLoad Gyrostat TwoBodies RigidBody
    };
    let mut seen = Counts::default();
    let many = on_many_rows();
    let all = texts.into_iter().chain(OTHERS).chain([THREE]).chain(many.iter().map(String::as_str)).map(parsed);
    let terms = texts! { RigidBody Gravity GravityGradient Rotor Drag Torque }.map(parsed);
    let pendulum = texts! { DoublePendulum Alike }.map(parsed);
    let sums = [&terms[..], &terms[..2], &pendulum].map(|terms| Declaration::sum(terms).expect("a sum"));
    for (seed, declaration) in (1..).zip(all.chain(sums)) {
        let before = used_memory();
        compare(declaration, "step", seed, &mut seen);
        assert!(used_memory() > before, "{} has machine code", declaration.name);
        compare(declaration, "composition Suzuki 4", seed, &mut seen);
        compare(declaration, "step, substeps 16", seed, &mut seen);
    }
    println!("{seen:?}");
    let has_settled_in = |count| seen.iterations.get(&count).is_some_and(|&steps| steps > 100);
    assert!(seen.steps > 50_000 && seen.errors > 20 && seen.with_care > 20 && (1..6).all(has_settled_in), "{seen:?}");
}

/// Bodies in lanes, each with numbers and a velocity of its own, against the same bodies alone; returns how many of them are
/// left at the end, and how many errors there were.
fn compare_lanes<B: BackendInLanes>(declaration: &'static Declaration, h: f64, seed: u64, count: usize) -> [usize; 2] {
    let mut random = Random::new(seed);
    let n: usize = declaration.factors.iter().map(|factor| factor.generators.len()).sum();
    let mut bodies: Vec<(AnyStepper, AnyState)> = Vec::new();
    for _ in 0..40 {
        let values = numbers(declaration, &mut random);
        let velocity: Vec<f64> = (0..n).map(|_| random.signed()).collect();
        let method = "step, substeps 4".parse().expect("a method");
        let Ok(whole) = Whole::<B>::of(declaration, &values, h, method) else { continue };
        whole.prepare();
        let stepper = whole.into_joinable();
        if let Ok(state) = stepper.start(&identity(declaration), &velocity)
            && bodies.len() < count
        {
            bodies.push((stepper, state));
        }
    }
    let Some((mut together, joined)) = AnyStepper::abreast(&bodies) else {
        panic!("{} bodies of {} by {h} s aren't joined", bodies.len(), declaration.name)
    };
    assert_eq!(joined, count, "{}", declaration.name);
    let mut errors = vec![None; count];
    // Attitudes are restored every 1,024 steps.
    let pieces = if h < 0.05 { [1, 1, 62, 1000] } else { [1, 1, 30, 30] };
    for piece in pieces {
        together.run(piece);
        for (lane, (stepper, state)) in bodies.iter_mut().enumerate() {
            if errors[lane].is_none() {
                errors[lane] = stepper.run_stretches(state, piece, &mut |_, _| 0).err();
            }
            let what = format!("lane {lane} of {} by {h} s", declaration.name);
            assert_eq!(together.error(lane), errors[lane].as_ref(), "{what}");
            assert_eq!(bits(&together.state(lane)), bits(state.numbers()), "{what}");
        }
    }
    let stopped = errors.iter().flatten().count();
    [count - stopped, stopped]
}

/// The declaration of a text under another name, whose code no other test has compiled.
fn renamed(text: &str) -> &'static Declaration {
    parsed(&text.replace("struct ", "struct Other"))
}

#[test]
fn lanes_of_all_declarations() {
    let texts = texts! {
        FullTop CayleyTop ContinuousTop SlidingTop Magnet Satellite FourthOrderTop ElasticFlow TetheredPlate Flyer
        OrbitingBody UnderwaterBody DoublePendulum TopOnCart SuspendedLoad Gyrostat TwoBodies
    };
    let terms = texts! { RigidBody Gravity GravityGradient Rotor Drag Torque }.map(renamed);
    let sum = Declaration::sum(&terms).expect("a sum");
    let mut seen = [0; 2];
    for (seed, declaration) in (1..).zip(texts.into_iter().chain(OTHERS).map(renamed).chain([sum])) {
        // Logarithms round by the lane that is farthest from the identity.
        let longest = if declaration.name.ends_with("FourthOrderTop") { 0.1 } else { 0.7 };
        for (h, count) in [(0.01, 8), (0.1, 5), (longest, 8)] {
            let [left, stopped] = if seed % 2 == 0 {
                compare_lanes::<Machine>(declaration, h, seed, count)
            } else {
                compare_lanes::<Interpreter>(declaration, h, seed, count)
            };
            seen = [seen[0] + left, seen[1] + stopped];
        }
    }
    println!("{seen:?}");
    assert!(seen[0] > 200 && seen[1] > 20, "{seen:?}");
    let [one, other] = [FullTop::DECLARATION, CayleyTop::DECLARATION].map(|text| {
        let declaration = renamed(text);
        let values = numbers(declaration, &mut Random::new(1));
        let whole: Whole<Machine> = Whole::of(declaration, &values, 0.01, Method::default()).expect("a stepper");
        let stepper = whole.into_joinable();
        let state = stepper.start(&identity(declaration), &[0.1, 0.2, 3.0]).expect("a start");
        (stepper, state)
    });
    let both = AnyStepper::abreast(&[one.clone(), other]).expect("one body");
    assert_eq!(both.1, 1, "two texts share no lanes");
    let mut later = one.clone();
    later.0.step(&mut later.1).expect("a step");
    assert_eq!(AnyStepper::abreast(&[one, later]).expect("one body").1, 1, "nor do two times");
}

/// Hostile numbers within a state have the same answers.
#[test]
fn hostile_states() {
    let declaration = parsed(&FullTop::DECLARATION.replace("FullTop", "HostileTop"));
    let values = numbers(declaration, &mut Random::new(1));
    let one: Whole<Interpreter> = Whole::of(declaration, &values, 0.1, Method::default()).expect("a stepper");
    let other: Whole<Machine> = Whole::of(declaration, &values, 0.1, Method::default()).expect("a stepper");
    other.prepare();
    let state = one.start(&identity(declaration), &[0.1, 0.2, 3.0]).expect("a start");
    for place in 0..state.len() - 1 {
        for number in [f64::NAN, f64::INFINITY, -1e300, 1e160, 1e40, 1e9, 5e-324, -0.0] {
            let [mut expected, mut found] = [0, 1].map(|_| {
                let mut state = state.clone();
                state[place] = number;
                state
            });
            let reports = (one.step(&mut expected), other.step(&mut found));
            assert_eq!(reports.0, reports.1, "{place} {number}");
            assert_eq!(bits(&expected), bits(&found), "{place} {number}");
        }
    }
    assert!(other.step(&mut state[1..].to_vec()).is_err());
}
