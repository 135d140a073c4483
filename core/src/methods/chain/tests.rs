//! Tests of a step's internals: momenta are conserved by unsolved increments, equations are solved to rounding, and
//! vector instructions don't change a digit.

use std::println;

use nalgebra::{Matrix3, Vector3};

use super::elimination::{LinkConstants, Work, newton, outwards};
use super::plan::{at_rest, follow};
use super::{Chain, Link};
use crate::groups::SO3;
use crate::mechanics::NonstandardInertia;
use crate::numbers::{Bodies, Plain, Register, padded, vector};

const ZERO: Plain = Plain::ZERO;

/// A substitute for the solver.
type Solve<'a> = &'a dyn Fn(&[LinkConstants], &mut [Work<Plain>]);

fn link(central: Matrix3<f64>, m: f64, c: [f64; 3], rho: [f64; 3]) -> Link {
    let [c, rho] = [c, rho].map(Vector3::from);
    Link { J_d: NonstandardInertia::new(central + c * c.transpose() * m).unwrap(), m, c, rho }
}

/// A chain, its initial attitudes and its initial velocities.
type ChainStart = (Chain<3>, [SO3; 3], [Vector3<f64>; 3]);

/// Links without any symmetry, under an oblique vertical.
fn oblique() -> ChainStart {
    let central = Matrix3::new(0.3, 0.02, -0.03, 0.02, 0.2, 0.01, -0.03, 0.01, 0.4);
    let links = [
        link(central, 1.2, [0.1, 0.05, -0.5], [0.1, 0.2, -1.0]),
        link(central, 0.7, [0.05, -0.1, -0.4], [-0.2, 0.1, -0.8]),
        link(central, 0.9, [-0.05, 0.1, -0.3], [0.0; 3]),
    ];
    let attitudes = [0.1, 0.5, -0.4].map(|angle| SO3::from_euler_angles(angle, 0.7, -angle));
    let velocities = [[0.5, -1.0, 2.0], [1.0, 0.3, -0.5], [-0.2, 0.4, 1.5]].map(Vector3::from);
    (Chain { links, g: 9.81, up: Vector3::new(0.6, 0.0, 0.8) }, attitudes, velocities)
}

/// `chain3` of the reference data in `tests/data/several_bodies.json`.
fn reference() -> ChainStart {
    let central = |moments: [f64; 3]| {
        let moments = Vector3::from(moments);
        Matrix3::from_diagonal_element(0.5 * moments.sum()) - Matrix3::from_diagonal(&moments)
    };
    let links = [
        link(central([0.1, 0.12, 0.05]), 1.0, [0.1, 0.0, -0.5], [0.0, 0.2, -1.0]),
        link(central([0.06, 0.05, 0.02]), 0.8, [0.0, 0.05, -0.4], [0.1, 0.0, -0.8]),
        link(central([0.03, 0.025, 0.01]), 0.5, [-0.05, 0.0, -0.3], [0.0, 0.0, -0.6]),
    ];
    let attitudes = [[0.5, 0.0, 0.0], [0.0, 0.7, 0.0], [0.3, -0.2, 0.4]].map(|turn| SO3::exp(turn.into()));
    let velocities = [[0.5, -1.0, 2.0], [1.0, 0.3, -0.5], [-0.7, 2.0, 1.5]].map(Vector3::from);
    (Chain { links, g: 9.81, up: Vector3::z() }, attitudes, velocities)
}

/// The momentum about the vertical is conserved even by increments that don't solve the equations: the kicks of a step
/// are moments of internal forces and of weights. Energy isn't conserved by them, and momenta grow with it, in the
/// first case a thousandfold; so the tolerance for rounding is relative to the largest momentum.
#[test]
fn momentum_of_badly_solved_steps() {
    badly_solved_steps(10_000);
}

/// Ten times as many steps.
#[test]
#[ignore = "takes seconds: cargo test --workspace --lib -- --ignored chain"]
fn momentum_of_a_hundred_thousand_badly_solved_steps() {
    badly_solved_steps(100_000);
}

fn badly_solved_steps(many: u32) {
    let unsolved = |links: &[LinkConstants], work: &mut [Work<Plain>]| {
        for work in &mut *work {
            work.half = work.half * ZERO.of([0.999; 4]);
        }
        outwards(ZERO, links, work);
    };
    let once = |links: &[LinkConstants], work: &mut [Work<Plain>]| {
        newton(ZERO, links, work, f64::INFINITY);
    };
    let badly: [(f64, u32, Solve<'_>, f64); 3] =
        [(0.01, 10_000, &unsolved, 1e-3), (0.0025, 10_000, &unsolved, 5e-4), (0.01, many, &once, 1e-10)];
    let cases = [oblique(), reference()].into_iter().flat_map(|started| badly.map(|case| (started, case)));
    for ((chain, attitudes, start), (h, steps, solve, off)) in cases {
        let stepper = chain.stepper(h).unwrap();
        let mut state = stepper.start(attitudes, Bodies(start)).unwrap();
        let before = stepper.vertical_momentum(&state);
        let (mut least, mut largest) = (f64::INFINITY, 0.0_f64);
        for _ in 0..steps {
            let plan = stepper.plan();
            let mut work = at_rest(ZERO);
            let kick = plan.prepare(ZERO, &state, &mut work);
            outwards(ZERO, &plan.links, &mut work);
            newton(ZERO, &plan.links, &mut work, f64::INFINITY);
            solve(&plan.links, &mut work);
            // The length of the next Newton update, which isn't applied.
            let update = newton(ZERO, &plan.links, &mut work.clone(), f64::INFINITY);
            least = least.min((update.length / update.size).sqrt());
            plan.proceed(stepper.scene(), &mut state.motion, &work, kick).unwrap();
            largest = state.momentum().0.iter().map(Vector3::norm).fold(largest, f64::max);
        }
        let moved = (stepper.vertical_momentum(&state) - before).abs();
        println!("h = {h}: moved by {moved:.1e} of {largest:.0}; the increments are off by {least:.1e} at least");
        assert!(moved < 1e-13 * largest && least > off, "{moved:e} {largest} {least:e}");
    }
}

/// Five bent, slim links: their inertias have the ratio `slimness`, and their joints lie `off` from their long axes.
/// The mass of the last is `last` times that of the others. All move across their long axes and spin about them.
fn slim(slimness: f64, off: f64, last: f64, spin: f64) -> (Chain<5>, [SO3; 5], [Vector3<f64>; 5]) {
    let turns = [0.2, 1.1, -0.7, 0.5, -1.3];
    let links = turns.map(|x: f64| {
        let central = Matrix3::from_diagonal(&Vector3::new(0.4 * slimness, 0.6 * slimness, 1.0)) / 12.0;
        link(central, 1.0, [off * x, -off, -0.5], [-off, off * x, -1.0])
    });
    let mut chain = Chain { links, g: 9.81, up: Vector3::z() };
    let [.., end] = &mut chain.links;
    *end = Link { J_d: NonstandardInertia::new(end.J_d.as_matrix() * last).unwrap(), m: last, ..*end };
    let attitudes = turns.map(|x| SO3::from_euler_angles(x, 0.8 * x * x, -x));
    let velocities = turns.map(|x| Vector3::new(1.0 + x, -2.0 * x, spin * x.signum()));
    (chain, attitudes, velocities)
}

/// A solution is accurate to rounding: another Newton iteration moves it no farther than later iterations do, up to a
/// factor for their scatter. This holds for ratios of inertias or masses of 1e4, for which the Jacobian might change
/// more along an update than earlier updates indicate.
#[test]
fn nothing_but_roundings_is_missing() {
    for (slimness, off, last, spin, h) in [
        (1e-4, 0.0, 1.0, 3.0, 0.005),
        (1e-4, 0.0, 1.0, 100.0, 0.005),
        (1e-4, 0.01, 1.0, 3.0, 0.0005),
        (1e-4, 0.01, 1.0, 30.0, 0.0002),
        (1e-4, 0.03, 1.0, 30.0, 0.0005),
        (1e-2, 0.0, 1e4, 3.0, 0.00005),
        (1e-2, 0.01, 1e4, 3.0, 0.00005),
        (1e-2, 0.01, 1e2, 3.0, 0.001),
        (1e-2, 0.01, 1e-4, 10.0, 0.002),
        (1.0, 0.2, 1.0, 30.0, 0.002),
        (1.0, 0.2, 1.0, 100.0, 0.001),
    ] {
        let (chain, attitudes, velocities) = slim(slimness, off, last, spin);
        let stepper = chain.stepper(h).unwrap();
        let mut state = stepper.start(attitudes, Bodies(velocities)).unwrap();
        let (mut missing, mut worst, mut iterations) = (0.0_f64, 0.0_f64, 0);
        for step in 0..2000 {
            let plan = stepper.plan();
            let mut work = at_rest(ZERO);
            let kick = plan.prepare(ZERO, &state, &mut work);
            let (made, is_solved) = plan.solve(ZERO, &mut work, &state.kept.guess.next);
            assert!(is_solved, "{slimness:e} {off} {last:e} {spin} {h}: no step {step}");
            iterations += made;
            let mut more = work;
            // The unit is the rounding error of all unknowns.
            let mut further = || {
                let updated = newton(ZERO, &plan.links, &mut more, f64::INFINITY);
                (updated.length / updated.size).sqrt() / f64::EPSILON
            };
            let first = further();
            let left = (0..4).map(|_| further()).fold(1.0, f64::max);
            (missing, worst) = (missing.max(first), worst.max(first / left));
            plan.proceed(stepper.scene(), &mut state.motion, &work, kick).unwrap();
            follow(&mut state.kept, &work, step == 0);
        }
        println!(
            "{slimness:e} {off} {last:e} {spin} {h}: {missing:.1} roundings, {worst:.1} times what is left; {iterations}"
        );
        assert!(worst < 16.0, "{slimness:e} {off} {last:e} {spin} {h}: {missing} {worst}");
    }
}

/// A shortened update has the requested length and the direction of the whole one, however long that is.
#[test]
fn a_shortened_update_is_a_part_of_the_whole() {
    let (chain, ..) = oblique();
    let links = [LinkConstants::from(&chain.links[2])];
    for size in [1e2, 1e10, 1e17, 1e30] {
        for start in [0.0, 0.3] {
            let mut work = [Work::none(ZERO)];
            work[0].half = ZERO.of([start, -start, start, 0.0]);
            work[0].target = ZERO.of(padded(&(Vector3::new(0.3, -1.0, 2.0) * size)));
            outwards(ZERO, &links, &mut work);
            let before = vector(work[0].half);
            let updated = newton(ZERO, &links, &mut work, 0.25);
            let moved = vector(work[0].half) - before;
            assert!(!updated.is_whole && updated.length.sqrt() > 0.01 * size, "{size:e} {start}");
            assert!((moved.norm() - 0.25).abs() < 1e-15, "{size:e} {start}: {moved}");
            let off = moved.normalize() + vector(work[0].update).normalize();
            assert!(off.norm() < 1e-14, "{size:e} {start}: {off}");
        }
    }
}

/// A step has identical digits with the machine's vector instructions and without.
#[cfg(all(feature = "dispatch", not(debug_assertions)))]
#[test]
fn vector_instructions_change_no_digit() {
    use super::plan::Step;
    use crate::numbers::OnRegisters as _;

    for (chain, attitudes, velocities) in [oblique(), reference()] {
        let stepper = chain.stepper(0.01).unwrap();
        let mut state = stepper.start(attitudes, Bodies(velocities)).unwrap();
        let mut other = state;
        for step in 0..1000 {
            let report = stepper.step(&mut state);
            let step_by_numbers = Step(stepper.plan(), stepper.scene(), &mut other.motion, &mut other.kept);
            assert_eq!(report, step_by_numbers.run(ZERO), "{step}");
            assert_eq!(state, other, "{step}");
        }
    }
}
