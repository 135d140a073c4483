//! The cost of a step of the heavy top (3.13): derived, written by hand for speed, and by Runge–Kutta.
//!
//! ```text
//! cargo bench                                 times a step, and the ratio of derived to by hand
//! cargo bench -- count derived 1000           runs 1000 steps of one kernel and nothing else
//! ```
//!
//! The kernels take turns within one run, so that other load of the machine affects all of them alike. Instructions a
//! step, which don't depend on it, are a difference of two counts:
//!
//! ```text
//! cargo bench --no-run                        prints the path of the executable
//! for n in 10000 20000; do
//!     valgrind --tool=callgrind --callgrind-out-file=/dev/null <executable> count derived $n
//! done
//! ```
//!
//! The scene is the looping case of \[RDAE, figure 3.8\] with `J_d = diag(2, 2, 1)` and `h = 0.01 s`.

mod by_hand;

use core::hint::black_box;
use std::time::Instant;

use declarations::HeavyTop;
use liestep::motion::{OwnStep, WarmStart};
use liestep::prelude::*;
use liestep::with::{Carry, CompensatedSums as Plan};
use nalgebra::{UnitQuaternion, Vector3};
use workbench::top_equations::Equations;

const STEP: f64 = 0.01;
const MOMENTS: [f64; 3] = [3.0, 3.0, 4.0];
const WEIGHT: f64 = 9.81;
const RHO: [f64; 3] = [0.0, 0.0, 1.0];
/// Long enough to hide the clock, short enough that a disturbance spoils few batches.
const BATCH: u32 = 20_000;
const ROUNDS: usize = 300;

type Derived = Stepper<HeavyTop>;
type DerivedState = State<SO3, Vector3<f64>>;
type Compensated = Stepper<HeavyTop, Plan<OwnStep<HeavyTop>>>;
type CompensatedMotion = State<SO3, Vector3<f64>, (WarmStart<Vector3<f64>>, Carry<SO3, Vector3<f64>>)>;

fn derived() -> (Derived, DerivedState) {
    let inertia = DiagonalNonstandardInertia::from_principal_moments(MOMENTS.into()).expect("a body");
    let top = HeavyTop { J_d: inertia, m: 1.0, g: WEIGHT, rho: RHO.into(), up: Vector3::z() };
    let stepper = Stepper::new(top, STEP).expect("a usable step");
    let (tilt, precession, nutation, spin) = (0.8_f64, 3.0, 0.5, 10.0);
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(tilt, 0.0, 0.0));
    let velocity = Vector3::new(nutation, precession * tilt.sin(), spin + precession * tilt.cos());
    let state = stepper.start(attitude, velocity).expect("a usable start");
    (stepper, state)
}

fn written_by_hand(start: &DerivedState) -> (by_hand::Top, by_hand::State) {
    let attitude = start.attitude();
    let r = attitude.as_matrix();
    let momentum: [f64; 3] = start.momentum().into();
    let first = [0, 1, 2].map(|k| 0.5 * STEP * momentum[k] / MOMENTS[k]);
    let state = by_hand::State {
        attitude: [0, 1, 2].map(|i| [r[(i, 0)], r[(i, 1)], r[(i, 2)]]),
        momentum,
        vertical: start.advected().into(),
        last: first,
        change: [0.0; 3],
        guess: first,
    };
    (by_hand::Top::new(MOMENTS, WEIGHT, RHO, STEP), state)
}

fn runge_kutta(start: &DerivedState) -> (Equations, workbench::top_equations::State) {
    let q = start.attitude().to_quaternion();
    let p = start.momentum();
    (Equations::new(MOMENTS, RHO.map(|entry| WEIGHT * entry)), [q.w, q.i, q.j, q.k, p.x, p.y, p.z])
}

#[inline(never)]
fn run_derived(stepper: &Derived, state: &mut DerivedState, steps: u32) {
    for _ in 0..steps {
        stepper.step(state).expect("a solvable step");
    }
}

#[inline(never)]
fn run_compensated(stepper: &Compensated, state: &mut CompensatedMotion, steps: u32) {
    for _ in 0..steps {
        stepper.step(state).expect("a solvable step");
    }
}

#[inline(never)]
fn run_by_hand(top: &by_hand::Top, state: &mut by_hand::State, steps: u32) {
    for _ in 0..steps {
        assert!(top.step(state), "a solvable step");
    }
}

#[inline(never)]
fn run_runge_kutta(top: &Equations, state: &mut workbench::top_equations::State, steps: u32) {
    for _ in 0..steps {
        *state = top.rk4_step(STEP, state);
    }
}

/// The largest difference between the derived and the hand-written kernel after a thousand steps, relative to the size
/// of each part.
fn disagreement() -> f64 {
    let (stepper, mut state) = derived();
    let (top, mut other) = written_by_hand(&state);
    run_derived(&stepper, &mut state, 1000);
    run_by_hand(&top, &mut other, 1000);
    let attitude = state.attitude();
    let attitude = (0..3)
        .flat_map(|i| (0..3).map(move |j| (i, j)))
        .map(|(i, j)| (attitude.as_matrix()[(i, j)] - other.attitude[i][j]).abs())
        .fold(0.0, f64::max);
    let momentum = (state.momentum() - Vector3::from(other.momentum)).norm() / state.momentum().norm();
    let vertical = (state.advected() - Vector3::from(other.vertical)).norm();
    attitude.max(momentum).max(vertical)
}

fn nanoseconds(run: impl FnOnce()) -> f64 {
    let start = Instant::now();
    run();
    start.elapsed().as_secs_f64() * 1e9 / f64::from(BATCH)
}

fn quantiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [values.len() / 10, values.len() / 2, values.len() * 9 / 10].map(|index| values[index])
}

fn compare() {
    let (stepper, mut a) = derived();
    let (top, mut b) = written_by_hand(&a);
    let (rival, mut c) = runge_kutta(&a);
    let compensated = derived().0.compensated();
    let mut d = compensated.adopt(&a);
    let mut times = [const { Vec::new() }; 4];
    for _ in 0..ROUNDS {
        times[0].push(nanoseconds(|| run_derived(black_box(&stepper), black_box(&mut a), BATCH)));
        times[1].push(nanoseconds(|| run_by_hand(black_box(&top), black_box(&mut b), BATCH)));
        times[2].push(nanoseconds(|| run_runge_kutta(black_box(&rival), black_box(&mut c), BATCH)));
        times[3].push(nanoseconds(|| run_compensated(black_box(&compensated), black_box(&mut d), BATCH)));
    }
    let ratios = times[0].iter().zip(&times[1]).map(|(derived, by_hand)| derived / by_hand).collect();
    println!("{:<28}{:>8}{:>8}{:>8}", "", "10 %", "median", "90 %");
    for (name, times) in ["derived", "by hand", "Runge-Kutta 4", "compensated"].into_iter().zip(times) {
        let [low, median, high] = quantiles(times);
        println!("{:<28}{low:>8.1}{median:>8.1}{high:>8.1}", format!("{name}, ns a step"));
    }
    let [low, median, high] = quantiles(ratios);
    println!("{:<28}{low:>8.2}{median:>8.2}{high:>8.2}", "derived : by hand");
}

fn count(kernel: &str, steps: u32) {
    let (stepper, mut a) = derived();
    match kernel {
        "derived" => run_derived(black_box(&stepper), black_box(&mut a), steps),
        "compensated" => {
            let compensated = stepper.compensated();
            let mut d = compensated.adopt(&a);
            run_compensated(black_box(&compensated), black_box(&mut d), steps);
        }
        "by-hand" => {
            let (top, mut b) = written_by_hand(&a);
            run_by_hand(black_box(&top), black_box(&mut b), steps);
        }
        "runge-kutta" => {
            let (rival, mut c) = runge_kutta(&a);
            run_runge_kutta(black_box(&rival), black_box(&mut c), steps);
        }
        _ => panic!("the kernels are derived, compensated, by-hand and runge-kutta, not {kernel}"),
    }
}

fn main() {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    if let [word, kernel, steps] = arguments.as_slice()
        && word == "count"
    {
        return count(kernel, steps.parse().expect("a number of steps"));
    }
    let disagreement = disagreement();
    println!("derived and by hand after 1000 steps: {disagreement:.1e} apart");
    assert!(disagreement < 1e-12, "the two kernels don't compute the same motion");
    compare();
}
