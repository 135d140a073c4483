//! Processed splittings: orders, what they keep, and that looking at a motion doesn't disturb it.

use checks::random::Random;
use checks::structure::poisson::{TOLERANCE, defect_of};
use declarations::{FreeBody, HeavyTop, Motion};
use liestep::effects::{Gravity, PrincipalBody};
use liestep::mechanics::{DiagonalNonstandardInertia, Sum};
use liestep::methods::{ExactBody, KineticFlow, ProcessedScheme, SplittingScheme};
use liestep::numbers::Lanes;
use liestep::prelude::*;
use nalgebra::Vector3;
use simba::simd::WideF64x4;
use workbench::measure::{order, relative};

use crate::convergence::{End, TOPS, counts};
use crate::splitting::symmetric;

fn end<K: KineticFlow<f64>>(kinetic: K, scheme: ProcessedScheme, motion: &Motion, h: f64, steps: u32) -> End {
    let processed = Stepper::processed(motion.top.clone(), h, kinetic, scheme).unwrap();
    let mut state = processed.start(motion.attitude, motion.velocity).unwrap();
    processed.run(&mut state, steps.into()).unwrap();
    (state.attitude(), processed.velocity(&state))
}

fn exact(top: &HeavyTop) -> ExactBody {
    ExactBody::new(&top.ordinary_inertia())
}

/// On tops with and without symmetry. What the ends leave is as large as the kernel's error, and on the chaotic top they
/// cancel in part.
#[test]
fn processed_splittings_have_their_orders() {
    for (scheme, coarsest) in [
        (ProcessedScheme::SIX_A, 240),
        (ProcessedScheme::SIX_B, 160),
        (ProcessedScheme::FOUR_A, 500),
        (ProcessedScheme::FOUR_B, 500),
        (ProcessedScheme::FOUR_C, 500),
    ] {
        for name in TOPS {
            let motion = Motion::read(name);
            let (attitude, velocity) = motion.at(10.0);
            let errors: Vec<_> = counts(coarsest, 1.25, 5)
                .into_iter()
                .map(|steps| {
                    let h = 10.0 / f64::from(steps);
                    let found = end(exact(&motion.top), scheme, &motion, h, steps);
                    (h, relative(found.0.as_matrix(), &attitude).hypot(relative(&found.1, &velocity)))
                })
                .collect();
            let order = order(&errors, 2e-13);
            let listed: Vec<_> = errors.iter().map(|(_, error)| format!("{error:.1e}")).collect();
            println!("{}, {name}: order {order:.2}, errors {}", scheme.name(), listed.join(" "));
            assert!((order - f64::from(scheme.order())).abs() < 0.35, "{}, {name}: {order}", scheme.name());
        }
    }
}

/// Read after each step, some or none: the same bits.
#[test]
fn looking_does_not_disturb() {
    let motion = Motion::chaotic();
    for scheme in ProcessedScheme::ALL {
        let processed = Stepper::processed(motion.top.clone(), 0.05, exact(&motion.top), scheme).unwrap();
        let start = processed.start(motion.attitude, motion.velocity).unwrap();
        let (mut single, mut some, mut many) = (start, start, start);
        for _ in 0..100 {
            processed.step(&mut single).unwrap();
        }
        for part in [1, 0, 40, 7, 52] {
            processed.run(&mut some, part).unwrap();
        }
        processed.run(&mut many, 100).unwrap();
        assert_eq!(single, many, "{}", scheme.name());
        assert_eq!(some, many, "{}", scheme.name());
    }
}

#[test]
fn s5_a_step_of_the_negative_length_is_the_inverse_map() {
    let mut random = Random::new(71);
    for scheme in ProcessedScheme::ALL {
        let top = HeavyTop::asymmetric();
        let there = Stepper::processed(top.clone(), 0.2, exact(&top), scheme).unwrap();
        let back = there.inverse().unwrap();
        for _ in 0..10 {
            let before = there.start(random.rotation(), random.vector() * 3.0).unwrap();
            let mut state = before;
            there.run(&mut state, 3).unwrap();
            let mut state = back.adopt(&state);
            back.run(&mut state, 3).unwrap();
            let error = relative(&state.attitude().matrix(), &before.attitude().matrix());
            assert!(error.max(relative(&state.momentum(), &before.momentum())) < 1e-13, "{}", scheme.name());
        }
    }
}

#[test]
fn p1_processed_splittings_are_poisson_maps() {
    let mut random = Random::new(72);
    for scheme in ProcessedScheme::ALL {
        for h in [0.1, 0.4] {
            let top = HeavyTop::asymmetric();
            let step = |momentum: &Vector3<f64>, w: &Vector3<f64>| {
                let processed = Stepper::processed(HeavyTop { up: *w, ..top.clone() }, h, exact(&top), scheme).unwrap();
                let mut state = processed.start_with_momentum(SO3::identity(), *momentum).unwrap();
                processed.step(&mut state).unwrap();
                (state.momentum(), state.advected())
            };
            let defect = defect_of::<HeavyTop, 3, 3>(step, &(random.vector() * 3.0), &random.vector()).0;
            println!("{}, h = {h}: {defect:.1e}", scheme.name());
            assert!(defect < TOLERANCE, "{}, h = {h}: {defect:e}", scheme.name());
        }
    }
}

/// A million steps of the chaotic top: the momentum about the vertical, lengths, and rotations that stay rotations. The
/// energy stays within the bound that it has at first.
#[test]
fn momenta_are_kept() {
    let motion = Motion::chaotic();
    for scheme in ProcessedScheme::ALL {
        let processed = Stepper::processed(motion.top.clone(), 0.1, exact(&motion.top), scheme).unwrap();
        let mut state = processed.start(motion.attitude, motion.velocity).unwrap();
        let (vertical, energy) = (state.momentum_along(&Vector3::z()), processed.energy(&state));
        let mut windows = Vec::new();
        for _ in 0..10 {
            let mut widest = 0.0_f64;
            for _ in 0..100 {
                processed.run(&mut state, 1000).unwrap();
                widest = widest.max((processed.energy(&state) - energy).abs() / energy.abs());
            }
            windows.push(widest);
        }
        let drift = ((state.momentum_along(&Vector3::z()) - vertical) / vertical).abs();
        let (length, defect) = ((state.advected().norm() - 1.0).abs(), state.orthogonality_defect());
        let (first, last) = (windows[0], windows[9]);
        println!("{}: {drift:.1e}, {length:.1e}, {defect:.1e}, {first:.1e} to {last:.1e}", scheme.name());
        assert!(drift.max(length).max(defect) < 2e-12, "{}: {drift:e}, {length:e}, {defect:e}", scheme.name());
        assert!(last < 2.0 * first, "{}: {windows:?}", scheme.name());
    }
}

/// Each lane of a run is, bit for bit, a run of its own.
#[test]
fn each_lane_moves_as_alone() {
    let moments = [1.6, 2.6, 3.0];
    let J_d = DiagonalNonstandardInertia::from_principal_moments(moments.into()).unwrap();
    let inertia = Inertia::from_principal_moments(moments.into()).unwrap();
    let rho = Vector3::new(0.1, 0.2, 0.3);
    let alone = PrincipalBody { J_d } + Gravity { m: 1.0, g: 9.81, rho, up: Vector3::z() };
    let together: Sum<PrincipalBody<WideF64x4>, Gravity<WideF64x4>> = Lanes::splat(&alone);
    let mut random = Random::new(73);
    let starts: [(SO3, Vector3<f64>); 4] = core::array::from_fn(|_| (random.rotation(), random.vector() * 3.0));
    for scheme in [ProcessedScheme::SIX_A, ProcessedScheme::FOUR_A] {
        let flow = ExactBody::<WideF64x4>::new(&Lanes::splat(&inertia));
        let stepper = Stepper::processed(together, nalgebra::convert(0.1), flow, scheme).unwrap();
        let attitude = SO3::gathered(&starts.map(|(attitude, _)| attitude)).unwrap();
        let velocity = Vector3::gathered(&starts.map(|(_, velocity)| velocity)).unwrap();
        let mut state = stepper.start(attitude, velocity).unwrap();
        stepper.run(&mut state, 20).unwrap();
        let single = Stepper::processed(alone, 0.1, ExactBody::new(&inertia), scheme).unwrap();
        for (k, (attitude, velocity)) in starts.into_iter().enumerate() {
            let mut of_lane = single.start(attitude, velocity).unwrap();
            single.run(&mut of_lane, 20).unwrap();
            let momentum: Vector3<WideF64x4> = state.momentum();
            assert_eq!(momentum.lane(k), of_lane.momentum(), "{}, lane {k}", scheme.name());
        }
    }
}

/// A symmetric top by its own flow, to what any other has.
#[test]
fn other_flows_will_do() {
    let motion = Motion::looping();
    let [own, exact] = [
        end(symmetric(&motion.top), ProcessedScheme::SIX_A, &motion, 0.05, 100),
        end(exact(&motion.top), ProcessedScheme::SIX_A, &motion, 0.05, 100),
    ];
    assert!(relative(own.0.as_matrix(), exact.0.as_matrix()) < 1e-12);
}

/// A push acts on what is read: the torque of a step is that of a splitting to the order of both.
#[test]
fn a_push_acts_on_what_is_read() {
    let motion = Motion::chaotic();
    let processed = Stepper::processed(motion.top.clone(), 0.01, exact(&motion.top), ProcessedScheme::SIX_A).unwrap();
    let split = Stepper::split(motion.top.clone(), 0.01, exact(&motion.top), SplittingScheme::NYSTROM_14).unwrap();
    let mut states = (
        processed.start(motion.attitude, motion.velocity).unwrap(),
        split.start(motion.attitude, motion.velocity).unwrap(),
    );
    for torque in [Vector3::new(5.0, -3.0, 2.0), Vector3::zeros(), Vector3::new(-1.0, 4.0, 2.0)] {
        processed.step_forced(&mut states.0, &torque).unwrap();
        split.step_forced(&mut states.1, &torque).unwrap();
    }
    assert!(relative(&states.0.momentum(), &states.1.momentum()) < 1e-10);
}

/// A processed free body moves as by one exact drift: kicks and their gradients are none.
#[test]
fn a_free_body_is_processed_exactly() {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.6, 2.6, 3.0)).unwrap();
    let flow = ExactBody::new(&J_d.to_inertia());
    let scene = FreeBody { J_d };
    let velocity = Vector3::new(0.3, -1.0, 0.8);
    let processed = Stepper::processed(scene.clone(), 1.0, flow, ProcessedScheme::SIX_A).unwrap();
    let whole = Stepper::split(scene, 10.0, flow, SplittingScheme::STRANG).unwrap();
    let mut states =
        (processed.start(SO3::identity(), velocity).unwrap(), whole.start(SO3::identity(), velocity).unwrap());
    processed.run(&mut states.0, 10).unwrap();
    whole.step(&mut states.1).unwrap();
    assert!(relative(&states.0.momentum(), &states.1.momentum()) < 1e-13);
}
