//! Gauss collocation in quaternion and momentum.

use checks::order::{self, End, TOPS, counts, error, run};
use checks::random::Random;
use checks::structure::poisson::{TOLERANCE, defect_of};
use declarations::{FourthOrderTop, FreeBody, FullTop, HeavyTop, LogTop, Motion, Top as _};
use liestep::effects;
use liestep::laws::samples::derivative;
use liestep::mechanics::{DiagonalNonstandardInertia, inertia};
use liestep::prelude::*;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use workbench::measure::relative;

use crate::many_digits;
use crate::many_digits::collocation::{self, Tableau};

fn end<const PAIRS: usize>(motion: &Motion, h: f64, steps: u32) -> End {
    order::end(&Stepper::collocated::<PAIRS>(motion.top.clone(), h).unwrap(), motion, steps)
}

/// The order is measured in long numbers: in doubles, orders as high as these reach rounding before the leading error
/// term dominates, even from the first solvable step.
fn assert_order_of_long_collocation<const PAIRS: usize>(numbers: [(u32, u32); 4]) {
    let tableau = Tableau::new(2 * PAIRS);
    let order = u32::try_from(4 * PAIRS).unwrap();
    for (motion, (compared, coarsest)) in TOPS.into_iter().zip(numbers) {
        many_digits::assert_order(
            (&format!("{} stages", 2 * PAIRS), order),
            (motion, 10.0),
            (compared, &counts(coarsest, 1.2, 5)),
            |motion, h, steps| collocation::end(&tableau, motion, h, steps),
            end::<PAIRS>,
        );
    }
}

#[test]
fn six_stages_are_of_order_12() {
    assert_order_of_long_collocation::<3>([(60, 110), (50, 80), (60, 110), (40, 70)]);
}

#[test]
fn eight_stages_are_of_order_16() {
    assert_order_of_long_collocation::<4>([(50, 110), (36, 80), (50, 110), (32, 70)]);
}

/// The error at a step of some 50°.
#[test]
fn eight_stages_reach_rounding_in_long_steps() {
    for (motion, steps) in TOPS.into_iter().zip([90, 70, 90, 44]) {
        let motion = Motion::read(motion);
        let error = error(&end::<4>(&motion, 10.0 / f64::from(steps), steps), &motion.at(10.0));
        assert!(error < 2e-13, "{steps} steps: {error:e}");
    }
}

/// The defect of the map of momentum and parameters. A parameter off the orbit of the declared one is the vertical of
/// another top.
fn poisson_defect<const PAIRS: usize>(top: &HeavyTop, h: f64, momentum: &Vector3<f64>, w: &Vector3<f64>) -> f64 {
    let step = |momentum: &Vector3<f64>, w: &Vector3<f64>| {
        let gauss = Stepper::collocated::<PAIRS>(HeavyTop { up: *w, ..top.clone() }, h).unwrap();
        let state = run(&gauss, gauss.start_with_momentum(SO3::identity(), *momentum).unwrap(), 1);
        (state.momentum(), state.advected())
    };
    defect_of::<SO3, _>(step, momentum, w, &|f| derivative(f)).0
}

/// A control: collocation of the reduced equations `Π' = Π × Ω + τ`, `w' = w × Ω` has the same order and isn't Poisson,
/// and the test above detects this.
#[test]
fn p1_collocation_of_the_reduced_equations_is_not_poisson() {
    let top = HeavyTop::asymmetric();
    let inverse = inertia(&top, &top.advected()).try_inverse().unwrap();
    let h = 0.3;
    let step = |momentum: &Vector3<f64>, w: &Vector3<f64>| {
        let rate = |(momentum, w): (Vector3<f64>, Vector3<f64>)| {
            let velocity = inverse * momentum;
            (momentum.cross(&velocity) + w.cross(&top.rho) * (top.m * top.g), w.cross(&velocity))
        };
        // The two stages of the collocation, by fixed-point iteration.
        let off = 3.0_f64.sqrt() / 6.0;
        let a = [[0.25, 0.25 - off], [0.25 + off, 0.25]];
        let mut k = [rate((*momentum, *w)); 2];
        for _ in 0..100 {
            k = a.map(|[one, other]| {
                rate((momentum + (k[0].0 * one + k[1].0 * other) * h, w + (k[0].1 * one + k[1].1 * other) * h))
            });
        }
        (momentum + (k[0].0 + k[1].0) * (0.5 * h), w + (k[0].1 + k[1].1) * (0.5 * h))
    };
    let (momentum, w) = (Vector3::new(2.0, -1.0, 3.0), Vector3::new(0.6, 0.0, 0.8));
    let (reduced, _) = defect_of::<SO3, _>(step, &momentum, &w, &|f| derivative(f));
    let lifted = poisson_defect::<1>(&top, h, &momentum, &w);
    println!("reduced {reduced:.1e}, lifted {lifted:.1e}");
    assert!(reduced > 1e-6 && lifted < TOLERANCE, "{reduced:e}, {lifted:e}");
}

/// The invariants over a million steps.
fn assert_kept<const PAIRS: usize>(motion: &Motion, h: f64) {
    let gauss = Stepper::collocated::<PAIRS>(motion.top.clone(), h).unwrap();
    let start = gauss.start(motion.attitude, motion.velocity).unwrap();
    let vertical = start.momentum_along(&Vector3::z());
    let (mut drift, mut state) = (0.0_f64, start);
    for _ in 0..100 {
        state = run(&gauss, state, 10_000);
        drift = drift.max(((state.momentum_along(&Vector3::z()) - vertical) / vertical).abs());
    }
    let orthogonality = state.attitude().defect();
    let parameter = (state.advected().norm() - 1.0).abs();
    println!("{} stages: vertical {drift:.1e}, orthogonality {orthogonality:.1e}, |w| {parameter:.1e}", 2 * PAIRS);
    assert!(drift < 5e-13 && orthogonality < 2e-15 && parameter < 1e-15, "{drift:e}, {orthogonality:e}, {parameter:e}");
    let d = motion.top.J_d.diagonal();
    if d.x.to_bits() == d.y.to_bits() {
        let spin = (state.momentum().z - start.momentum().z).abs() / start.momentum().z.abs();
        assert!(spin < 5e-13, "spin {spin:e}");
    }
}

#[test]
fn a_million_steps_keep_the_momenta() {
    assert_kept::<4>(&Motion::looping(), 0.04);
    assert_kept::<4>(&Motion::read(TOPS[3]), 0.2);
}

#[test]
fn steps_of_few_stages_keep_the_momenta() {
    assert_kept::<2>(&Motion::read(TOPS[3]), 0.05);
}

/// The largest relative error of the energy in the first and the second half of these steps.
fn energy_errors<const PAIRS: usize>(motion: &Motion, h: f64, steps: u32) -> [f64; 2] {
    let gauss = Stepper::collocated::<PAIRS>(motion.top.clone(), h).unwrap();
    let mut state = gauss.start(motion.attitude, motion.velocity).unwrap();
    let energy = gauss.energy(&state);
    [0.0; 2].map(|start: f64| {
        (0..steps / 2).fold(start, |worst, _| {
            gauss.step(&mut state).unwrap();
            worst.max(((gauss.energy(&state) - energy) / energy).abs())
        })
    })
}

/// The energy isn't quadratic: at a long step it oscillates, and its error is no larger in the second half of the time.
#[test]
fn the_energy_does_not_drift() {
    let [first, second] = energy_errors::<2>(&Motion::looping(), 0.15, 200_000);
    println!("energy {first:.1e}, then {second:.1e}");
    assert!(first > 1e-9 && second < 1.1 * first && second < 1e-5, "{first:e}, {second:e}");
}

/// At a step that is accurate to rounding, the energy is conserved to rounding, on a chaotic motion too.
#[test]
fn the_energy_is_kept_at_shorter_steps() {
    for (name, h) in [(TOPS[0], 0.1), (TOPS[3], 0.1)] {
        let [first, second] = energy_errors::<4>(&Motion::read(name), h, 20_000);
        println!("{name}: energy {first:.1e}, then {second:.1e}");
        assert!(first < 1e-13 && second < 2e-13, "{name}: {first:e}, {second:e}");
    }
}

/// Gravity along a general direction, a full inertia tensor, a rotor and a spring, compared with two stages of order
/// four at steps a fiftieth as long.
#[test]
fn scenes_of_several_effects_are_integrated() {
    let J_d = NonstandardInertia::new(Matrix3::new(2.0, 0.2, -0.1, 0.2, 1.5, 0.3, -0.1, 0.3, 1.0)).unwrap();
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.1, 0.2, 0.3), up: Vector3::new(0.0, 0.6, 0.8) };
    let spring = effects::Spring { k: 2.0, length: 0.5, at: Vector3::x(), anchor: Vector3::new(0.0, 2.0, 1.0) };
    let scene = RigidBody { J_d } + gravity + spring + effects::Rotor { spin: Vector3::new(0.5, 0.0, 1.0) };
    let mut random = Random::new(53);
    let (attitude, velocity) = (random.rotation(), random.vector());
    let coarse = Stepper::collocated::<4>(scene, 0.1).unwrap();
    let fine = Stepper::collocated::<1>(scene, 0.002).unwrap();
    let start = coarse.start(attitude, velocity).unwrap();
    let few = run(&coarse, start, 20);
    let many = run(&fine, fine.start(attitude, velocity).unwrap(), 1000);
    let missed = (few.attitude().as_matrix() - many.attitude().as_matrix()).norm();
    assert!(missed < 1e-10 && relative(&few.momentum(), &many.momentum()) < 1e-10, "{missed:e}");
    assert!((coarse.energy(&few) - coarse.energy(&start)).abs() < 1e-11);
}

/// The macro's kinetic part is replaced, so its form and its axes don't matter.
#[test]
fn only_the_continuous_limit_matters() {
    let motion = Motion::looping();
    let log = LogTop::of(&motion.top);
    let full = FullTop::in_axes(&motion.top, &Matrix3::identity());
    let expected = end::<4>(&motion, 0.05, 100);
    let expected = (expected.0.matrix(), expected.1);
    let log = order::end(&Stepper::collocated::<4>(log, 0.05).unwrap(), &motion, 100);
    let full = order::end(&Stepper::collocated::<4>(full, 0.05).unwrap(), &motion, 100);
    assert!(error(&log, &expected) < 1e-12 && error(&full, &expected) < 1e-12);
}

#[test]
fn a_free_body_keeps_its_spatial_momentum() {
    let gauss = Stepper::collocated::<4>(FreeBody::with_moments([1.0, 2.0, 2.5]), 0.3).unwrap();
    let start = gauss.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02)).unwrap();
    let state = run(&gauss, start, 10_000);
    assert!(relative(&state.spatial_momentum(), &start.spatial_momentum()) < 2e-14);
}

#[test]
fn a_body_at_rest_begins_to_move_and_one_that_nothing_moves_stays() {
    let gauss = Stepper::collocated::<2>(HeavyTop::asymmetric(), 0.05).unwrap();
    let state = run(&gauss, gauss.start(SO3::identity(), Vector3::zeros()).unwrap(), 1);
    assert!(state.momentum().norm() > 0.1);
    let free = Stepper::collocated::<2>(FreeBody::with_moments([1.0, 2.0, 2.5]), 0.05).unwrap();
    let start = free.start(SO3::identity(), Vector3::zeros()).unwrap();
    assert_eq!(run(&free, start, 3).attitude(), start.attitude());
}

/// The torques of a top that hangs nearly at rest are small differences of large terms, whose rounding is large beside
/// the momentum. The reference takes quarter steps, from other guesses.
#[test]
fn a_top_that_hangs_nearly_at_rest_is_stepped() {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 2.5, 3.333)).unwrap();
    let gravity = effects::Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.1, 0.2, -1.0), up: Vector3::z() };
    let hanging = UnitQuaternion::rotation_between(&gravity.rho, &-gravity.up).unwrap();
    let mut random = Random::new(20);
    for (size, h) in [1e-4, 1e-6, 1e-8].into_iter().flat_map(|size| [0.05, 0.2, 0.4].map(|h| (size, h))) {
        let stepper = |h| Stepper::collocated::<4>(effects::PrincipalBody { J_d } + gravity, h).unwrap();
        let (gauss, finer) = (stepper(h), stepper(h / 4.0));
        for _ in 0..40 {
            let velocity = random.vector() * size;
            let start = gauss.start(hanging, velocity).unwrap();
            let first = run(&gauss, start, 1);
            let parts = run(&finer, finer.start(hanging, velocity).unwrap(), 4);
            let off = (first.momentum() - parts.momentum()).norm();
            // The bound is four roundings of the weight's torque over the step.
            let rounding = 4.0 * f64::EPSILON * h * gravity.m * gravity.g * gravity.rho.norm();
            assert!(off <= rounding + 1e-12 * first.momentum().norm(), "{size:e} {h}: {off:e} {rounding:e}");
            run(&gauss, first, 200);
        }
    }
}

/// The square of the momentum has no finite inverse.
#[test]
fn a_momentum_of_the_smallest_numbers_is_stepped() {
    let free = Stepper::collocated::<4>(FreeBody::with_moments([1.0, 2.0, 2.5]), 0.05).unwrap();
    let velocity = Vector3::new(1.0, 2.0, 3.0) * 1e-156;
    let state = run(&free, free.start(SO3::identity(), velocity).unwrap(), 10);
    let (momentum, expected): (Vector3<f64>, f64) = (state.momentum() * 1e156, Vector3::new(1.0, 4.0, 7.5).norm());
    assert!((momentum.norm() / expected - 1.0).abs() < 1e-12);
}

#[test]
fn a_step_too_long_is_an_error_and_leaves_the_state() {
    let motion = Motion::looping();
    let gauss = Stepper::collocated::<4>(motion.top.clone(), 2.0).unwrap();
    let mut state = gauss.start(motion.attitude, motion.velocity).unwrap();
    let before = state;
    let error = gauss.step(&mut state).unwrap_err();
    assert!(matches!(error, StepError::NotConverged { .. }), "{error:?}");
    assert_eq!(state, before);
}

#[test]
fn a_lagrangian_whose_potential_is_not_apart_is_refused() {
    let coupled = FourthOrderTop::of(&HeavyTop::thesis());
    let error = Stepper::collocated::<4>(coupled, 0.01).unwrap_err();
    assert!(matches!(error, SetupError::NotSeparable { defect } if defect > 1e-3), "{error:?}");
}
