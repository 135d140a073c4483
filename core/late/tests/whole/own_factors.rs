//! Products with groups of the user's: a body in space beside a drop that keeps its volume, whose weights depend on each other;
//! by factors, by one matrix of blocks, and compiled.

// A declaration names its fields by the letters of its formula.
#![allow(non_snake_case)]

use liestep::groups::{LieGroup as _, SE3};
use liestep::mechanics::Effect as _;
use liestep::motion::Propagator as _;
use liestep::numbers::Entries as _;
use liestep::with::Method;
use liestep::{Stepper, lagrangian};
use liestep_late::{Declaration, LateError, Whole, numbers};
use nalgebra::{Matrix3, Matrix4, SVector, Vector3, Vector4};

use crate::special_linear::SL3;
use crate::{Free, Generators, matrix, orthogonal, special_linear, written};

/// A body in SE(3), and a drop whose weight depends on the body's height.
#[lagrangian(
    group(F = SE3, Q = SL3!),
    advected(w = height.seen_from(F), u = up.seen_from(Q)),
    l_d = ((F - I) * K * (F - I).transpose()).trace() / (2.0 * h)
        + (((Q - I) * J * (Q - I).transpose()).trace() + ((I - inverse(Q)) * J * (I - inverse(Q)).transpose()).trace())
            / (4.0 * h)
        - 0.5 * h * (w.dot(&weight) * (1.0 + u.dot(&p)) + (F.transpose() * w).dot(&weight) * (1.0 + (Q.transpose() * u).dot(&p))),
)]
#[derive(Clone, Debug)]
struct BodyAndDrop {
    K: Matrix4<f64>,
    J: Matrix3<f64>,
    weight: Vector4<f64>,
    p: Vector3<f64>,
    height: Vector4<f64>,
    up: Vector3<f64>,
}

const KINETIC: &str = "(((F - I) * M * (F - I).transpose()).trace() \
    + ((I - inverse(F)) * M * (I - inverse(F)).transpose()).trace()) / (4 * h)";
const OF_BODY: [f64; 16] = [2.0, 0.1, -0.05, 0.0, 0.1, 1.5, 0.08, 0.0, -0.05, 0.08, 1.1, 0.0, 0.0, 0.0, 0.0, 1.3];
const OF_DROP: [f64; 9] = [1.0, 0.05, 0.02, 0.05, 1.1, 0.03, 0.02, 0.03, 1.2];
const WEIGHT: [f64; 4] = [0.3, -0.2, 0.4, 2.0];
const P: [f64; 3] = [0.1, -0.2, 0.3];
const UP: [f64; 3] = [0.2, 0.1, 1.0];
const BODY: [f64; 6] = [0.3, -0.7, 1.1, 0.2, 0.5, -0.4];
const DROP: [f64; 8] = [0.0, 0.3, -0.08, -0.28, 0.15, 0.24, -0.21, -0.17];

fn scene() -> BodyAndDrop {
    BodyAndDrop {
        K: Matrix4::from_row_slice(&OF_BODY),
        J: Matrix3::from_row_slice(&OF_DROP),
        weight: WEIGHT.into(),
        p: P.into(),
        height: Vector4::new(0.0, 0.0, 1.0, 0.0),
        up: UP.into(),
    }
}

fn identity(rows: usize) -> Vec<f64> {
    (0..rows * rows).map(|at| if at % (rows + 1) == 0 { 1.0 } else { 0.0 }).collect()
}

fn parsed(text: &str) -> &'static Declaration {
    Declaration::parse(text).expect("a declaration")
}

fn whole(declaration: &'static Declaration, values: &[f64], method: &str, steps: u32) -> Whole {
    let method: Method = method.parse().expect("a method");
    Whole::of(declaration, values, 1.0 / f64::from(steps), method).expect("a stepper")
}

fn apart(pairs: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    pairs.into_iter().fold(0.0, |most, (a, b)| (a - b).abs().max(most))
}

/// The state after a second, and the change of the momentum in space relative to it.
fn second(whole: &Whole, attitude: &[f64], velocity: &[f64], steps: u32) -> (Box<[f64]>, f64) {
    let mut state = whole.start(attitude, velocity).expect("a start");
    let [mut before, mut after] = [vec![0.0; velocity.len()], vec![0.0; velocity.len()]];
    whole.spatial_momentum(&state, &mut before);
    whole.run(&mut state, steps.into()).expect("steps");
    whole.spatial_momentum(&state, &mut after);
    let size = before.iter().fold(0.0_f64, |size, entry| size.max(entry.abs()));
    (state, apart(before.into_iter().zip(after)) / size)
}

/// The generators of a factor as blocks of matrices with more rows.
fn block(own: &Generators, first: usize, rows: usize) -> Generators {
    let size = own[0].len().isqrt();
    let place = |at: usize| (first + at / size) * rows + first + at % size;
    let wide = |one: &Vec<f64>| {
        let mut wide = vec![0.0; rows * rows];
        one.iter().enumerate().for_each(|(at, &entry)| wide[place(at)] = entry);
        wide
    };
    own.iter().map(wide).collect()
}

fn poses() -> Generators {
    let turns = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| matrix(4, &[(i, j, -1.0), (j, i, 1.0)]));
    turns.into_iter().chain((0..3).map(|k| matrix(4, &[(k, 3, 1.0)]))).collect()
}

/// Two free factors, both of the text's own, are one group of block-diagonal matrices: another chart, and another solve.
#[test]
fn a_product_is_a_group_of_blocks() {
    let [poses, drops] = [poses(), special_linear()];
    let both: Generators = block(&poses, 0, 7).into_iter().chain(block(&drops, 4, 7)).collect();
    let rows =
        |size: usize, first: usize| (0..size * size).map(move |at| (at, (first + at / size) * 7 + first + at % size));
    let mut M = vec![0.0; 49];
    rows(4, 0).for_each(|(at, place)| M[place] = OF_BODY[at]);
    rows(3, 4).for_each(|(at, place)| M[place] = OF_DROP[at]);
    let as_blocks = parsed(&format!(
        "#[lagrangian(group = Both, generators = {}, l_d = {KINETIC})] struct Both {{ M: SMatrix<f64, 7, 7> }}",
        written(&both)
    ));
    let kinetic = |F: &str, M: &str| KINETIC.replace('F', F).replace('M', M);
    for order in ["F = Poses, Q = Drops", "Q = Drops, F = Poses"] {
        let by_factors = parsed(&format!(
            "#[lagrangian(group({order}), generators(Drops = {}, Poses = {}), l_d = {} + {})]
            struct Own {{ K: Matrix4<f64>, J: Matrix3<f64> }}",
            written(&drops),
            written(&poses),
            kinetic("F", "K"),
            kinetic("Q", "J"),
        ));
        let values = by_factors.numbers(&[("K", &OF_BODY), ("J", &OF_DROP)]).expect("numbers");
        let is_first = order.starts_with('F');
        let (attitude, velocity) = if is_first {
            ([identity(4), identity(3)].concat(), [&BODY[..], &DROP].concat())
        } else {
            ([identity(3), identity(4)].concat(), [&DROP[..], &BODY].concat())
        };
        let own = whole(by_factors, &values, "step", 100);
        let (state, drift) = second(&own, &attitude, &velocity, 100);
        assert!(drift < 1e-14, "{order}: {drift:e}");
        let values = as_blocks.numbers(&[("M", &M)]).expect("numbers");
        let blocks = whole(as_blocks, &values, "step", 100);
        let (expected, _) = second(&blocks, &identity(7), &[&BODY[..], &DROP].concat(), 100);
        let [body, drop] = if is_first { [0, 16] } else { [9, 0] };
        let pairs = rows(4, 0).map(|(at, place)| (state[body + at], expected[place]));
        let pairs = pairs.chain(rows(3, 4).map(|(at, place)| (state[drop + at], expected[place])));
        let off = apart(pairs);
        assert!(off < 1e-11, "{order}: {off:e}");
    }
}

#[test]
fn orders_are_two_and_four() {
    let declaration = parsed(BodyAndDrop::DECLARATION);
    let values = declaration.described(&numbers(&scene())).expect("numbers");
    let (start, velocity) = ([identity(4), identity(3)].concat(), [&BODY[..], &DROP].concat());
    let by = |method: &str, steps: u32| second(&whole(declaration, &values, method, steps), &start, &velocity, steps).0;
    let exact = by("composition Kahan-Li 8", 200);
    for (method, steps, order) in [("step", 100, 2.0), ("composition Suzuki 4", 40, 4.0)] {
        let error = |steps| apart(by(method, steps)[..39].iter().zip(&*exact).map(|(&a, &b)| (a, b)));
        let found = (error(steps) / error(2 * steps)).log2();
        assert!((found - order).abs() < 0.05, "{method}: {found}");
    }
}

#[test]
fn the_compiled_step_is_that_of_the_text() {
    let stepper = Stepper::new(scene(), 0.01).expect("a stepper");
    let velocity = [&BODY[..], &DROP].concat();
    let start = (SE3::identity(), SL3::identity());
    let mut state = stepper.start(start, SVector::<f64, 14>::from_column_slice(&velocity)).expect("a start");
    let declaration = parsed(BodyAndDrop::DECLARATION);
    let values = declaration.described(&numbers(&scene())).expect("numbers");
    let whole = whole(declaration, &values, "step", 100);
    let mut data = whole.start(&[identity(4), identity(3)].concat(), &velocity).expect("a start");
    for step in 0..200 {
        assert_eq!(stepper.step(&mut state), whole.step(&mut data), "step {step}");
        let mut entries = Vec::new();
        state.attitude().0.matrix().each(&mut |entry| entries.push(entry));
        state.attitude().1.matrix().each(&mut |entry| entries.push(entry));
        entries.extend(state.momentum().iter());
        assert_eq!(entries, data[..39], "step {step}");
    }
}

/// A discretisation by the Cayley map is refused where a factor has none, and so is a generator without coordinates.
#[test]
fn factors_without_coordinates_are_refused() {
    let refused = |text: &str| match Declaration::parse(text) {
        Err(LateError::Mistakes(all)) => all[0].message.clone(),
        other => panic!("{other:?}"),
    };
    let own = |generators: &str, rest: &str| {
        format!(
            "#[lagrangian(group(F = SO3, Q = Own), generators(Own = {generators}), {rest})] struct Two {{ k: f64 }}"
        )
    };
    let l =
        "velocity(Omega, xi), discretise = trapezoid(Cayley), l = k * (Omega.norm_squared() + xi.norm_squared()) / 2";
    let message = refused(&own(&written(&special_linear()), l));
    assert!(message.contains("declare `l_d` by hand"), "{message}");
    let l_d = "k * ((F - I).norm_squared() + (Q - I).norm_squared()) / h";
    let message = refused(&own("[[[0, 1], [0, 0]], [[1, 0], [0, 2]]]", &format!("l_d = {l_d}")));
    assert!(message.contains("the cube of this generator"), "{message}");
}

/// Rotations of eight dimensions: the text has 1,792 numbers in its generators, and a step sixty thousand operations.
#[test]
fn generators_may_have_many_numbers() {
    let (_, drift) = Free::on(8, &orthogonal(8), true).end("step", 50);
    assert!(drift < 1e-14, "{drift:e}");
    let long = format!("#[lagrangian(group = Own, generators = [[[{}]]], l_d = 1)] struct Long;", "0, ".repeat(5_000));
    assert!(
        matches!(Declaration::parse(&long), Err(LateError::Mistakes(all)) if all[0].message.contains("4096 numbers"))
    );
    let signs = long.replace("0, 0, ", "0 - 0 - ");
    assert!(
        matches!(Declaration::parse(&signs), Err(LateError::Mistakes(all)) if all[0].message.contains("2000 tokens in a chain"))
    );
}
