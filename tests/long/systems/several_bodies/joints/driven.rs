//! Prescribed parameters of steps, and potentials between jointed bodies.

use core::array::from_fn;

use declarations::SuspendedLoad;
use declarations::motions::{number, read};
use liestep::groups::R3;
use liestep::laws::samples::Random;
use liestep::mechanics::Along;
use liestep::methods::Joint;
use liestep::motion::Propagator as _;
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::{SVector, UnitQuaternion, Vector3, Vector6};

use super::super::{all, apart};
use super::loops::{closed_loop, loop_of_three, state_of};
use super::{
    Components, Connection, EPSILON, LEFT, Linkage, MassAndInertia, RIGHT, assert_no_work, ball, chained, falling,
    jointed, plain, rod, row, six, system,
};

/// A force that is prescribed for each step: if it is the weight of the bodies, the step is that under gravity, and
/// velocities satisfy the constraints.
#[test]
fn a_control_force() {
    let (start, velocity) = state_of(&read("closed loop")["states"][0]);
    let heavy = closed_loop(0.01);
    let data = &read("closed loop")["parameters"];
    let weights = all(&data["bodies"], |body| number(&body["m"]) * number(&data["g"]));
    let bodies = all(&data["bodies"], |body| MassAndInertia {
        m: number(&body["m"]),
        K: NonstandardInertia::from_principal_moments(plain(&body["J"])).unwrap(),
    });
    let floating: [_; 3] = falling(bodies.try_into().unwrap(), 0.0, Vector3::z());
    let pushed = jointed(floating, &loop_of_three(), 0.01).unwrap();
    let force: Components<3> = from_fn(|k| -Vector6::ith(5, weights[k]));
    let mut expected = heavy.start(&start, &velocity).unwrap();
    heavy.run(&mut expected, 100).unwrap();
    let mut state = pushed.start(&start, &velocity).unwrap();
    for _ in 0..100 {
        pushed.step_forced(&mut state, &force).unwrap();
        pushed.start_with_momentum(&pushed.attitudes(&state), &pushed.momenta(&state)).unwrap();
    }
    let off = apart(&pushed.turns(&state), &heavy.turns(&expected));
    println!("{off:?}");
    assert!(off < 1e-12);
}

/// A planar linkage whose last joint, which closes the loop, is a pin, under a force that changes with each step.
#[test]
fn a_loop_that_a_pin_closes_is_driven() {
    let pin = |above, below| Joint::pin([above, below], [Vector3::y(), Vector3::new(0.2, 2.0, 0.0)]);
    let (places, corner) = row([0.9, 0.0, -0.9]);
    let tree = [
        Connection::to_space(ball(Vector3::zeros(), LEFT), 0),
        Connection::between(pin(RIGHT, LEFT), 0, 1),
        Connection::between(ball(RIGHT, LEFT), 1, 2),
    ];
    let last = Connection::to_space(pin(corner, RIGHT), 2);
    let joints = [tree[0], tree[1], tree[2], last];
    let stepper = jointed(falling([1.0, 0.7, 1.2].map(rod), 9.81, Vector3::z()), &joints, 0.005).unwrap();
    let mut random = Random::new(4);
    let moving: Components<3> = from_fn(|_| random.sample());
    let mut state = stepper.start_nearest(&places, &moving).unwrap();
    let mut gap = 0.0_f64;
    for step in 0..500 {
        let force: Components<3> = from_fn(|_| random.sample::<Vector6<f64>>() * 5.0);
        let before = stepper.motion(&state);
        stepper.step_forced(&mut state, &force).unwrap();
        if step % 100 == 0 {
            let motions = [before, stepper.motion(&state)];
            assert_no_work((&stepper.scene(), 0.005), &joints, &force, motions);
        }
        gap = gap.max(stepper.widest_gap(&state));
        stepper.start_with_momentum(&stepper.attitudes(&state), &stepper.momenta(&state)).unwrap();
    }
    assert!(gap < 4.0 * EPSILON * 3.0, "{gap:e}");
}

/// A spring between points of two bodies.
#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
    l_d = -0.25 * h * stiffness * ((r + R_2 * at_2 - R_1 * at_1).norm_squared()
        + (r + d_2 - d_1 + R_2 * F_2 * at_2 - R_1 * F_1 * at_1).norm_squared()),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cord {
    stiffness: f64,
    at_1: Vector3<f64>,
    at_2: Vector3<f64>,
}

/// Springs across the joints of a chain: joints do no work, and the conserved energy includes the springs'.
#[test]
fn bodies_that_joints_and_springs_hold() {
    const N: usize = 3;
    let joints = chained::<N>();
    let bodies = falling([rod(1.0); N], 9.81, Vector3::z());
    let cord = |stiffness| Cord { stiffness, at_1: Vector3::new(0.1, 0.2, 0.0), at_2: Vector3::new(-0.1, 0.2, 0.1) };
    let of = |stiffness: f64, h: f64| {
        let mut system = system(bodies, &joints);
        for k in 1..N {
            system.between([Some(k - 1), Some(k)], cord(stiffness));
        }
        Linkage { bodies, stepper: system.stepper(h).unwrap() }
    };
    let (stepper, free) = (of(30.0, 0.005), of(0.0, 0.005));
    let mut random = Random::new(9);
    let moving: Components<N> = from_fn(|_| random.sample());
    let start = stepper.start_nearest(&row([0.9, 0.2, -0.7]).0, &moving).unwrap();
    let off = |h: f64, steps: u32| {
        let stepper = of(30.0, h);
        let (mut state, energy, mut off) = (stepper.adopt(&start), stepper.energy(&start), 0.0_f64);
        for step in 0..steps {
            let before = stepper.motion(&state);
            stepper.step(&mut state).unwrap();
            if step % 200 == 0 {
                let scene = stepper.scene() + Along::<N>::of([cord(30.0)]);
                assert_no_work((&scene, h), &joints, &[Vector6::zeros(); N], [before, stepper.motion(&state)]);
            }
            off = off.max((stepper.energy(&state) - energy).abs());
            assert!(stepper.widest_gap(&state) < 4.0 * EPSILON * 3.0);
        }
        off
    };
    let errors = [off(0.005, 200), off(0.0025, 400)];
    let later = off(0.005, 2000);
    println!("energy within {errors:?}, and in ten seconds {later:.1e}");
    assert!((errors[0] / errors[1] - 4.0).abs() < 0.4 && later < 0.1);
    let (mut state, mut other) = (start.clone(), free.adopt(&start));
    stepper.run(&mut state, 200).unwrap();
    free.run(&mut other, 200).unwrap();
    assert!(apart(&stepper.turns(&state), &free.turns(&other)) > 0.1, "springs don't matter");
}

/// A load on a cable, declared with the cable's attitude as a coordinate, has to rounding the motion of two bodies on a
/// ball joint whose positions are coordinates, too: under forces that change with each step.
#[test]
fn a_load_under_a_quadrotor() {
    let [J_d, K] = [[0.02, 0.03, 0.04], [0.002, 0.0015, 0.001]]
        .map(|moments| NonstandardInertia::from_principal_moments(Vector3::from(moments)).unwrap());
    let (m, m_load, g, up, cable) = (1.0, 0.4, 9.81, Vector3::z(), Vector3::new(0.1, 0.05, -0.9));
    for h in [0.01, -0.005] {
        let declared = Stepper::new(SuspendedLoad { J_d, m, K, m_load, cable, g, up }, h).unwrap();
        let joint = Connection::between(Joint::ball([Vector3::zeros(), -cable]), 0, 1);
        let two = jointed(falling([MassAndInertia { m, K: J_d }, MassAndInertia { m: m_load, K }], g, up), &[joint], h)
            .unwrap();
        let mut random = Random::new(31);
        let [attitude, hanging] =
            [0.4, -0.7].map(|angle| SO3::from(UnitQuaternion::from_scaled_axis(Vector3::new(angle, 0.2, -angle))));
        let (x, velocity): (Vector3<f64>, SVector<f64, 9>) = (random.sample(), random.sample());
        let mut state = declared.start((attitude, R3::from(x), hanging), velocity).unwrap();
        let along = hanging.as_matrix() * cable;
        let [turning, v, of_cable] = [0, 3, 6].map(|first| velocity.fixed_rows::<3>(first).into_owned());
        let of_load = v + hanging.as_matrix() * of_cable.cross(&cable);
        let places = [(attitude, R3::from(x)), (hanging, R3::from(x + along))];
        let mut other = two.start(&places, &[six(&turning, &v), six(&of_cable, &of_load)]).unwrap();
        assert!((declared.energy(&state) - two.energy(&other)).abs() < 1e-13);
        for _ in 0..200 {
            let [torque, thrust]: [Vector3<f64>; 2] = from_fn(|_| random.sample());
            let force = SVector::<f64, 9>::from_fn(|k, _| {
                if k < 3 {
                    0.1 * torque[k]
                } else if k < 6 {
                    10.0 * thrust[k - 3]
                } else {
                    0.0
                }
            });
            declared.step_forced(&mut state, &force).unwrap();
            let pushed = six(&(torque * 0.1), &(thrust * 10.0));
            two.step_forced(&mut other, &[pushed, Vector6::zeros()]).unwrap();
        }
        let (found, expected) = (state.attitude(), two.attitudes(&other));
        let errors = [
            apart(&[found.0, found.2], &expected.map(|body| body.0)),
            (found.1.translation() - expected[0].1.translation()).amax(),
            (declared.velocity(&state).fixed_rows::<3>(6) - two.velocity(&other, 1).fixed_rows::<3>(0)).amax(),
        ];
        println!("{h}: {errors:?}");
        assert!(errors[0] < 1e-11 && errors[1] < 1e-11 && errors[2] < 1e-10, "{errors:?}");
    }
}
