//! Loops of joints.

use core::array::from_fn;

use checks::drift::tenths;
use declarations::motions::{matrix, number, read, vector};
use liestep::groups::R3;
use liestep::laws::samples::Random;
use liestep::methods::Joint;
use liestep::motion::{AnyStepper, Propagator};
use liestep::{NonstandardInertia, SO3, SetupError, StepError};
use nalgebra::{Vector3, Vector6};
use serde_json::Value;

use super::super::{all, apart, order};
use super::{
    Body, Components, Connection, EPSILON, LEFT, Linkage, MassAndInertia, RIGHT, assert_no_work, ball, chained,
    falling, jointed, plain, rod, row, six, system, watched,
};

/// The joints of the reference's closed loop.
pub(super) fn loop_of_three() -> [Connection<Joint>; 4] {
    let data = &read("closed loop")["parameters"];
    let end = |body: usize, side: &str| plain(&data["bodies"][body][side]);
    let tree = [
        Connection::to_space(ball(Vector3::zeros(), end(0, "left")), 0),
        Connection::between(ball(end(0, "right"), end(1, "left")), 0, 1),
        Connection::between(ball(end(1, "right"), end(2, "left")), 1, 2),
    ];
    let last = Connection::to_space(ball(plain(&data["pivot"]), end(2, "right")), 2);
    [tree[0], tree[1], tree[2], last]
}

/// The closed loop of the reference.
pub(super) fn closed_loop(h: f64) -> Linkage<3> {
    let data = &read("closed loop")["parameters"];
    let bodies = all(&data["bodies"], |body| MassAndInertia {
        m: number(&body["m"]),
        K: NonstandardInertia::from_principal_moments(plain(&body["J"])).unwrap(),
    });
    let bodies = falling(bodies.try_into().unwrap(), number(&data["g"]), Vector3::z());
    jointed(bodies, &loop_of_three(), h).unwrap()
}

pub(super) fn state_of(value: &Value) -> ([Body; 3], Components<3>) {
    let bodies = &value["bodies"];
    let of = |k: usize| {
        let attitude = SO3::try_from(matrix(&bodies[k]["R"])).unwrap();
        (attitude, R3::from(vector(&bodies[k]["x"])))
    };
    (from_fn(of), from_fn(|k| six(&vector(&bodies[k]["Omega_body"]), &vector(&bodies[k]["v"]))))
}

/// The reference is Newton's and Euler's equations in inertial coordinates, independent of reduced equations: order 2,
/// in attitudes, positions and velocities.
#[test]
fn a_closed_loop() {
    let states = &read("closed loop")["states"];
    let ((start, velocity), (end, expected)) = (state_of(&states[0]), state_of(&states[1]));
    let errors = [(0.01, 100), (0.005, 200), (0.0025, 400)].map(|(h, steps)| {
        let stepper = closed_loop(h);
        let mut state = stepper.start(&start, &velocity).unwrap();
        assert!((stepper.energy(&state) - number(&states[0]["energy"])).abs() < 1e-13);
        let [_, gap] = watched(&stepper, &mut state, 0.0, steps);
        assert!(gap < 4.0 * EPSILON * 2.0, "{gap:e}");
        let found = stepper.attitudes(&state);
        let places = found.iter().zip(&end).map(|(a, b)| (a.1.translation() - b.1.translation()).amax());
        let attitudes = apart(&found.map(|body| body.0), &end.map(|body| body.0));
        let velocities = stepper.velocities(&state);
        let slower = velocities.iter().zip(&expected).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
        [attitudes, places.fold(0.0, f64::max), slower]
    });
    for of in 0..3 {
        order(&errors.map(|errors| errors[of]));
    }
}

/// Checks over a hundred thousand stretches that the energy is bounded and the joints stay closed.
fn assert_bounded(stretch: u64) {
    let (start, velocity) = state_of(&read("closed loop")["states"][0]);
    let stepper = closed_loop(0.01);
    let mut state = stepper.start(&start, &velocity).unwrap();
    let (energy, mut gap) = (stepper.energy(&state), 0.0_f64);
    let (means, most) = tenths(|| {
        stepper.run(&mut state, stretch).unwrap();
        gap = gap.max(stepper.widest_gap(&state));
        stepper.energy(&state) - energy
    });
    let [first, second] = [&means[..5], &means[5..]].map(|half| half.iter().sum::<f64>() / 5.0);
    println!("energy {energy:.4}: within {most:.4}, means {means:.5?}; gap {gap:.1e}");
    assert!(most < 0.004 && (first - second).abs() < 2e-4 && gap < 4.0 * EPSILON * 2.0);
    assert!(stepper.defect(&state) < 1e-12);
}

/// The energy of a loop is bounded over a hundred thousand steps, its joints stay closed, and the functions around a
/// step work with it.
#[test]
fn energy_of_a_closed_loop() {
    assert_bounded(1);
    let (start, velocity) = state_of(&read("closed loop")["states"][0]);
    let stepper = closed_loop(0.01);

    let mut there = stepper.start(&start, &velocity).unwrap();
    stepper.run(&mut there, 40).unwrap();
    let back = stepper.with_step(-0.01).unwrap();
    let mut returned = back.adopt(&there);
    back.run(&mut returned, 40).unwrap();
    assert!(apart(&stepper.turns(&returned), &start.map(|body| body.0)) < 1e-12);
    let first = stepper.start(&start, &velocity).unwrap();
    let any = AnyStepper::new(stepper.stepper.clone());
    let at = any.state_at(&any.state_of(&first).unwrap(), 0.4).unwrap();
    assert!(apart(&stepper.turns(at.numbers()), &stepper.turns(&there)) < 1e-12);
    let part = stepper.part(&first, 0.3).unwrap();
    assert!(stepper.widest_gap(&part) < 4.0 * EPSILON * 2.0);

    let saved = serde_json::to_string(&there).unwrap();
    let mut resumed: Box<[f64]> = serde_json::from_str(&saved).unwrap();
    stepper.run(&mut resumed, 10).unwrap();
    stepper.run(&mut there, 10).unwrap();
    assert_eq!(resumed, there);
}

/// The bounds over a million steps, some three hours of motion.
#[test]
#[ignore = "takes a minute: `cargo test -p liestep-long-tests --test systems a_million_steps_of_a_closed_loop -- --ignored --nocapture`"]
fn a_million_steps_of_a_closed_loop() {
    assert_bounded(10);
}

/// A free ring of six conserves its momentum and its angular momentum; hung up at one point under gravity, the angular
/// momentum about the vertical.
#[test]
fn momenta_of_a_ring() {
    const N: usize = 6;
    // A hexagon, upright; the first side begins at the origin.
    let (places, _) = row([0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(|k| core::f64::consts::FRAC_PI_3 * k));
    let mut random = Random::new(8);
    let moving: Components<N> = from_fn(|_| {
        let (omega, v): (Vector3<f64>, Vector3<f64>) = (random.sample(), random.sample());
        six(&omega, &v)
    });

    let (tree, last) = (chained::<N>(), Connection::between(ball(RIGHT, LEFT), N - 1, 0));
    let mut ring = tree;
    ring[0] = last;
    ring.rotate_left(1);
    let free = jointed(falling([rod(1.0); N], 0.0, Vector3::z()), &ring, 0.01).unwrap();
    let mut state = free.start_nearest(&places, &moving).unwrap();
    let ([p, l], energy) = (free.whole(&state), free.energy(&state));
    let [off, gap] = watched(&free, &mut state, energy, 5000);
    let [dp, dl] = free.whole(&state);
    // The ring has flown away, and the rounding of positions has grown with its distance.
    let far = free.attitude(&state, 0).1.translation().norm();
    let moved = [(dp - p).amax(), (dl - l).amax()];
    println!("free: {moved:?}, energy within {off:.1e}, gap {gap:.1e} at {far:.0} m");
    assert!(moved[0] < 1e-12 && moved[1] < 1e-10 && gap < 4.0 * EPSILON * far.max(1.0) && off < 1e-2 * energy);

    let hung: Vec<_> = tree.into_iter().chain([last]).collect();
    let hanging = jointed(falling([rod(1.0); N], 9.81, Vector3::z()), &hung, 0.005).unwrap();
    let mut state = hanging.start_nearest(&places, &moving).unwrap();
    let (vertical, energy) = (hanging.whole(&state)[1].z, hanging.energy(&state));
    hanging.run(&mut state, 5000).unwrap();
    let moved = hanging.whole(&state)[1].z - vertical;
    println!("hung up: {moved:.1e}, energy {:.1e}", hanging.energy(&state) - energy);
    assert!(moved.abs() < 1e-11 && (hanging.energy(&state) - energy).abs() < 0.1);
}

/// Three links of one metre with these masses between pivots at this distance, under gravity.
fn garland(masses: [f64; 3], apart: f64) -> Linkage<3> {
    let [first, second, third] = chained();
    let joints = [first, second, third, Connection::to_space(ball(Vector3::x() * apart, RIGHT), 2)];
    jointed(falling(masses.map(rod), 9.81, Vector3::z()), &joints, 0.002).unwrap()
}

/// A loop whose bodies differ by ten thousand in mass conserves energy and joints. It can't be stretched.
#[test]
fn a_loop_of_unlike_masses() {
    for masses in [[1e4, 1.0, 1.0], [1.0, 1e4, 1.0], [1.0, 1e-4, 1.0]] {
        let stepper = garland(masses, 0.9);
        let about = row([1.6, 0.3, -1.5]).0;
        let mut state = stepper.start_nearest(&about, &[Vector6::from_element(0.2); 3]).unwrap();
        let before = stepper.energy(&state);
        let [most, gap] = watched(&stepper, &mut state, before, 2000);
        let scale = 9.81 * masses.iter().sum::<f64>();
        println!("{masses:?}: energy {:.1e}, gap {gap:.1e}", most / scale);
        assert!(most < 1e-3 * scale && gap < 4.0 * EPSILON * 2.0);
    }
}

/// A heavy body stretches the light ones of its loop until the loop is at its singular position, like a blow: until
/// then energy and joints are conserved, and then the error names the joint, and the state stays.
#[test]
fn a_loop_that_is_stretched_names_the_joint() {
    let stepper = garland([1e4, 1.0, 1.0], 2.0);
    let mut state = stepper.start_nearest(&row([0.9, 0.0, -0.9]).0, &[Vector6::from_element(0.5); 3]).unwrap();
    let (energy, mut gap) = (stepper.energy(&state), 0.0_f64);
    for step in 0..2000 {
        let before = state.clone();
        if let Err(error) = stepper.step(&mut state) {
            let off = (stepper.energy(&state) - energy) / energy;
            println!("after {step} steps: {error}; energy {off:.1e}, gap {gap:.1e}");
            assert!(matches!(error, StepError::SingularJoint { joint: 3, .. }) && state == before);
            assert!(step > 100 && off.abs() < 1e-2 && gap < 4.0 * EPSILON * 2.0);
            return;
        }
        gap = gap.max(stepper.widest_gap(&state));
    }
    panic!("it is never stretched");
}

/// Two stretched links between pivots: the error names the joint that closes the loop, and the state stays.
#[test]
fn a_singular_position_names_the_joint() {
    let bodies = falling([rod(1.0); 2], 9.81, Vector3::z());
    let of = |apart: f64| {
        let [first, second] = chained();
        jointed(bodies, &[first, second, Connection::to_space(ball(Vector3::x() * apart, RIGHT), 1)], 0.01).unwrap()
    };
    let stepper = of(2.0);
    let straight = [0.5, 1.5].map(|x| (SO3::identity(), R3::from(Vector3::x() * x)));
    let still = [Vector6::zeros(); 2];
    let refused = stepper.start(&straight, &still).unwrap_err();
    println!("{refused}");
    assert!(matches!(refused, SetupError::RedundantJoint { joint: 2, .. }));
    assert!(matches!(stepper.start_nearest(&straight, &still), Err(SetupError::RedundantJoint { joint: 2, .. })));
    // The motion starts in another configuration, and is adopted here.
    let bent = of(1.9);
    let tilt = 0.95_f64.acos();
    let about = [1.0, -1.0].map(|side| {
        let attitude = SO3::exp(Vector3::y() * (tilt * side));
        (attitude, R3::from(Vector3::new(0.95 - 0.475 * side, 0.0, -0.5 * tilt.sin())))
    });
    let mut state = bent.start_nearest(&about, &still).unwrap();
    bent.run(&mut state, 10).unwrap();
    let free = system::<Joint, 2>(bodies, &[]).stepper(0.01).unwrap();
    let motion = free.start(&straight, &still).unwrap();
    let mut taken = stepper.adopt(&motion);
    let before = taken.clone();
    let error = stepper.step(&mut taken).unwrap_err();
    println!("{error}");
    assert!(matches!(error, StepError::SingularJoint { joint: 2, .. }) && taken == before);
    // An impulse can't be distributed there, either.
    let error = stepper.step_forced(&mut taken, &[Vector6::ith(5, 1.0); 2]).unwrap_err();
    assert!(matches!(error, StepError::SingularJoint { joint: 2, .. }) && taken == before);
}

/// Three rods of 1 m between pivots that are farther apart stay open, and the error reports the gap.
#[test]
fn joints_that_cannot_close_stay_open() {
    for (apart, missing) in [(3.001, 1e-3), (3.1, 0.1), (4.0, 1.0)] {
        let stepper = garland([1.0; 3], apart);
        let error = stepper.start_nearest(&row([0.9, 0.0, -0.9]).0, &[Vector6::zeros(); 3]).unwrap_err();
        println!("{error}");
        let SetupError::OffConstraint { by, .. } = error else { panic!("{error}") };
        // The gap is distributed over four joints.
        assert!(by > 0.25 * missing && by < 2.0 * missing, "{by:e} of {missing}");
    }
}

/// A planar linkage of pins alone: the last one is redundant in part.
#[test]
fn redundant_pins_are_named() {
    let pin = |above, below| Joint::pin([above, below], [Vector3::y(); 2]);
    let (places, corner) = row([0.9, 0.0, -0.9]);
    let of = |third, last| {
        let pins = [Connection::to_space(pin(Vector3::zeros(), LEFT), 0), Connection::between(pin(RIGHT, LEFT), 0, 1)];
        let joints = [pins[0], pins[1], Connection::between(third, 1, 2), Connection::to_space(last, 2)];
        jointed(falling([rod(1.0); 3], 9.81, Vector3::z()), &joints, 0.005).unwrap()
    };
    let still = [Vector6::zeros(); 3];
    let redundant = of(pin(RIGHT, LEFT), pin(corner, RIGHT));
    let error = redundant.start(&places, &still).unwrap_err();
    println!("{error}");
    assert!(matches!(error, SetupError::RedundantJoint { joint: 3, .. }));
    // A last body with balls at both ends makes it a linkage with one degree of freedom, plus that body's spin.
    let linkage = of(ball(RIGHT, LEFT), ball(corner, RIGHT));
    let mut state = linkage.start(&places, &still).unwrap();
    let energy = linkage.energy(&state);
    let [off, gap] = watched(&linkage, &mut state, energy, 2000);
    // The pins and the planar start keep the motion in its plane.
    let sideways = linkage.attitudes(&state).iter().map(|body| body.1.translation().y.abs()).fold(0.0, f64::max);
    println!("energy {off:.1e}, gap {gap:.1e}, sideways {sideways:.1e}");
    assert!(off < 2e-2 && gap < 4.0 * EPSILON * 2.0 && sideways < 1e-12);
}

/// A garland of three bodies whose middle one is connected by a fourth to a third pivot: two loops with that body in
/// common. For each choice of the joints that close loops, joints do no work, and the motion is the same.
#[test]
fn two_loops() {
    let bodies = falling([1.0, 1.3, 0.8, 0.6].map(rod), 9.81, Vector3::z());
    let (places, corner) = row([0.9, 0.1, -0.7]);
    // The fourth body is at right angles to the garland, from a point of the middle body that isn't its centre.
    let at = Vector3::new(0.1, 0.0, 0.05);
    let (knot, start) = (ball(at, LEFT), super::place(&places[1]).of(&at));
    let fourth = SO3::exp(Vector3::z() * 1.1);
    let along = fourth.as_matrix() * Vector3::x();
    let [first, second, third] = chained();
    let last = Connection::to_space(ball(corner, RIGHT), 2);
    let others = [Connection::between(knot, 1, 3), Connection::to_space(ball(start + along, RIGHT), 3)];
    let all = [first, second, third, last, others[0], others[1]];
    let places = [places[0], places[1], places[2], (fourth, R3::from(start + along * 0.5))];
    let mut random = Random::new(12);
    let moving: Components<4> = from_fn(|_| random.sample());
    let ends = [[3, 5], [0, 4], [2, 1]].map(|apart| {
        let others = (0..6).filter(|k| !apart.contains(k));
        let joints: Vec<_> = others.chain(apart).map(|k| all[k]).collect();
        let stepper = jointed(bodies, &joints, 0.005).unwrap();
        let mut state = stepper.start_nearest(&places, &moving).unwrap();
        let (energy, before) = (stepper.energy(&state), stepper.motion(&state));
        assert!(energy > stepper.energy(&stepper.start(&places, &[Vector6::zeros(); 4]).unwrap()) + 0.1);
        stepper.step(&mut state).unwrap();
        let motions = [before, stepper.motion(&state)];
        assert_no_work((&stepper.scene(), 0.005), &all, &[Vector6::zeros(); 4], motions);
        let [off, gap] = watched(&stepper, &mut state, energy, 399);
        println!("energy {energy:.3} within {off:.1e}, gap {gap:.1e}");
        assert!(off < 1e-2 && gap < 4.0 * EPSILON * 2.0);
        stepper.turns(&state)
    });
    for other in &ends[1..] {
        assert!(apart(&ends[0], other) < 1e-11, "{:e}", apart(&ends[0], other));
    }
}
