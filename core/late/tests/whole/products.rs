//! Products of any groups: a body that moves in SE(3), whose weight a turning wheel changes, beside the same body by its turn
//! and its place; the compiled step beside that of the text.

// A declaration names its fields by the letters of its formula.
#![allow(non_snake_case)]

use liestep::groups::{LieGroup as _, SE3};
use liestep::mechanics::Effect as _;
use liestep::motion::Propagator as _;
use liestep::numbers::Entries as _;
use liestep::with::Method;
use liestep::{SO3, Stepper, lagrangian};
use liestep_late::{Declaration, Whole, numbers};
use nalgebra::{Matrix3, Matrix4, SVector, Vector3, Vector4};

/// A body in SE(3) and a wheel, which doesn't touch it: the weight depends on the direction of the wheel's axis.
#[lagrangian(
    group(F = SE3, Q = SO3),
    advected(w = height.seen_from(F), u = up.seen_from(Q)),
    l_d = ((F - I) * K * (F - I).transpose()).trace() / (2.0 * h) + ((Q - I) * J * (Q - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * (w.dot(&weight) * (1.0 + c * u.z)
            + (F.transpose() * w).dot(&weight) * (1.0 + c * (Q.transpose() * u).z)),
)]
#[derive(Clone, Debug)]
pub(crate) struct BodyAndWheel {
    K: Matrix4<f64>,
    J: Matrix3<f64>,
    weight: Vector4<f64>,
    c: f64,
    height: Vector4<f64>,
    up: Vector3<f64>,
}

/// The body and the wheel in the other order of factors.
const WHEEL_FIRST: &str = "#[lagrangian(
    group(Q = SO3, F = SE3),
    advected(w = height.seen_from(F), u = up.seen_from(Q)),
    l_d = ((F - I) * K * (F - I).transpose()).trace() / (2 * h) + ((Q - I) * J * (Q - I).transpose()).trace() / (2 * h)
        - h / 2 * (w.dot(weight) * (1 + c * u.z) + (F.transpose() * w).dot(weight) * (1 + c * (Q.transpose() * u).z)),
)] struct WheelAndBody {
    K: Matrix4<f64>, J: Matrix3<f64>, weight: Vector4<f64>, c: f64, height: Vector4<f64>, up: Vector3<f64>,
}";

/// The body by its turn and its place in space, not by a matrix of SE(3), and the wheel: `tr (F − I) K (F − I)ᵀ` is that of the
/// turn and `m |d|²`, and the height of the weight `s/W` is `(v · s + W z)/W`.
const BY_PLACE: &str = "#[lagrangian(
    group(F = SO3, d = R3, Q = SO3),
    advected(v = up.seen_from(F), x = d.seen_from(space), u = up.seen_from(Q)),
    l_d = ((F - I) * K * (F - I).transpose()).trace() / (2 * h) + m * d.norm_squared() / (2 * h)
        + ((Q - I) * J * (Q - I).transpose()).trace() / (2 * h)
        - h / 2 * ((v.dot(s) + W * x[2]) * (1 + c * u.z)
            + ((F.transpose() * v).dot(s) + W * (x + d)[2]) * (1 + c * (Q.transpose() * u).z)),
)] struct ByPlace {
    K: Matrix3<f64>, J: Matrix3<f64>, m: f64, s: Vector3<f64>, W: f64, c: f64, up: Vector3<f64>,
}";

const BODY: [f64; 9] = [2.0, 0.1, -0.05, 0.1, 1.5, 0.08, -0.05, 0.08, 1.1];
const WHEEL: [f64; 9] = [0.3, 0.0, 0.02, 0.0, 0.4, 0.0, 0.02, 0.0, 0.5];
const WEIGHT: [f64; 4] = [0.3, -0.2, 0.4, 7.0];
const TURNS: [[f64; 3]; 2] = [[0.3, -0.7, 1.1], [0.9, 0.4, -2.0]];
const SPEED: [f64; 3] = [0.2, 0.5, -0.4];

pub(crate) fn scene() -> BodyAndWheel {
    let mut K = Matrix4::zeros();
    K.fixed_view_mut::<3, 3>(0, 0).copy_from(&Matrix3::from_row_slice(&BODY));
    K[(3, 3)] = 1.3;
    let (J, height) = (Matrix3::from_row_slice(&WHEEL), Vector4::new(0.0, 0.0, 1.0, 0.0));
    BodyAndWheel { K, J, weight: WEIGHT.into(), c: 0.4, height, up: Vector3::z() }
}

fn identity(rows: usize) -> impl Iterator<Item = f64> {
    (0..rows * rows).map(move |at| if at % (rows + 1) == 0 { 1.0 } else { 0.0 })
}

fn whole(declaration: &'static Declaration, values: &[f64], steps: u32) -> Whole {
    Whole::of(declaration, values, 1.0 / f64::from(steps), Method::default()).expect("a stepper")
}

/// The state after two seconds, by `steps` steps a second.
fn end(whole: &Whole, attitude: &[f64], velocity: &[f64], steps: u32) -> Box<[f64]> {
    let mut state = whole.start(attitude, velocity).expect("a start");
    whole.run(&mut state, (2 * steps).into()).expect("steps");
    state
}

fn in_space(steps: u32) -> Box<[f64]> {
    let declaration = Declaration::parse(BodyAndWheel::DECLARATION).expect("a declaration");
    let values = declaration.described(&numbers(&scene())).expect("numbers");
    let start: Vec<f64> = identity(4).chain(identity(3)).collect();
    end(&whole(declaration, &values, steps), &start, &[TURNS[0], SPEED, TURNS[1]].concat(), steps)
}

fn apart(pairs: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    pairs.into_iter().fold(0.0, |most, (a, b)| (a - b).abs().max(most))
}

/// The places of numbers in the attitude of a body in space and a wheel, and in that of a turn, a place and a wheel.
fn entries() -> impl Iterator<Item = (usize, usize)> {
    let body = |at: usize| if at % 4 < 3 { 3 * (at / 4) + at % 4 } else { 9 + at };
    (0..12).map(move |at| (at, body(at))).chain((0..9).map(|at| (16 + at, 25 + at)))
}

#[test]
fn a_body_in_space_is_one_with_a_turn_and_a_place() {
    let declaration = Declaration::parse(BY_PLACE).expect("a declaration");
    let values = declaration
        .numbers(&[
            ("K", &BODY),
            ("J", &WHEEL),
            ("m", &[1.3]),
            ("s", &WEIGHT[..3]),
            ("W", &WEIGHT[3..]),
            ("c", &[0.4]),
            ("up", &[0.0, 0.0, 1.0]),
        ])
        .expect("numbers");
    let found = in_space(100);
    let by_place = whole(declaration, &values, 100);
    let start: Vec<f64> = identity(3).chain(identity(4)).chain(identity(3)).collect();
    let expected = end(&by_place, &start, &[TURNS[0], SPEED, TURNS[1]].concat(), 100);
    let moved = apart(entries().map(|(a, b)| (found[a], expected[b])));
    assert!(moved < 1e-11, "{moved:e}");
}

#[test]
fn factors_may_stand_in_any_order() {
    let declaration = Declaration::parse(WHEEL_FIRST).expect("a declaration");
    let values = declaration.described(&numbers(&scene())).expect("numbers");
    let start: Vec<f64> = identity(3).chain(identity(4)).collect();
    let other = end(&whole(declaration, &values, 100), &start, &[TURNS[1], TURNS[0], SPEED].concat(), 100);
    let found = in_space(100);
    let moved = apart((0..16).map(|at| (found[at], other[9 + at])).chain((0..9).map(|at| (found[16 + at], other[at]))));
    assert!(moved < 1e-12, "{moved:e}");
}

#[test]
fn the_compiled_step_is_that_of_the_text() {
    let stepper = Stepper::new(scene(), 0.01).expect("a stepper");
    let velocity = SVector::<f64, 9>::from_column_slice(&[TURNS[0], SPEED, TURNS[1]].concat());
    let start = (SE3::identity(), SO3::identity());
    let mut state = stepper.start(start, velocity).expect("a start");
    let declaration = Declaration::parse(BodyAndWheel::DECLARATION).expect("a declaration");
    let values = declaration.described(&numbers(&scene())).expect("numbers");
    let whole = whole(declaration, &values, 100);
    let entries: Vec<f64> = identity(4).chain(identity(3)).collect();
    let mut data = whole.start(&entries, velocity.as_slice()).expect("a start");
    for step in 0..2_000 {
        assert_eq!(stepper.step(&mut state), whole.step(&mut data), "step {step}");
        let mut entries = Vec::new();
        state.attitude().0.matrix().each(&mut |entry| entries.push(entry));
        state.attitude().1.matrix().each(&mut |entry| entries.push(entry));
        entries.extend(state.momentum().iter());
        assert_eq!(entries, data[..34], "step {step}");
    }
}

#[test]
fn the_order_is_two_and_by_a_composition_four() {
    let declaration = Declaration::parse(BodyAndWheel::DECLARATION).expect("a declaration");
    let values = declaration.described(&numbers(&scene())).expect("numbers");
    let start: Vec<f64> = identity(4).chain(identity(3)).collect();
    let by = |method: &str, steps: u32| {
        let method = method.parse().expect("a method");
        let whole: Whole = Whole::of(declaration, &values, 1.0 / f64::from(steps), method).expect("a stepper");
        end(&whole, &start, &[TURNS[0], SPEED, TURNS[1]].concat(), steps)
    };
    let exact = by("composition Kahan-Li 8", 200);
    for (method, steps, order) in [("step", 100, 2.0), ("composition Suzuki 4", 40, 4.0)] {
        let error = |steps| apart(by(method, steps)[..25].iter().zip(&exact[..]).map(|(&a, &b)| (a, b)));
        let found = (error(steps) / error(2 * steps)).log2();
        assert!((found - order).abs() < 0.05, "{method}: {found}");
    }
}
