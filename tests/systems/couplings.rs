//! Systems of bodies whose terms couple two of them within a step: friction in joints, springs between attitudes, and
//! kinetic energies of two bodies.

use core::array::from_fn;

use declarations::{FallingBody, FloatingBody, RodElement};
use liestep::effects::{Drag, RigidBody};
use liestep::groups::{Advected as _, LieGroup as _, R3};
use liestep::laws::samples::Random;
use liestep::mechanics::{Coupling, DiscreteLagrangian as _, Each, Force as _, Term as _};
use liestep::methods::{Joint, Multibody, MultibodyStepper};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, SetupError, Stepper, force, lagrangian};
use nalgebra::{Matrix3, Vector3, Vector6};

type Body = (SO3, R3);

/// Friction between two bodies: the torque `c` times their relative angular velocity, half of its impulse at either end
/// of a step.
#[force(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    displacement(eta_1, eta_2),
    work = {
        let rate = Q * vee(F_2) - vee(F_1);
        -0.5 * c * (rate.dot(&(Q * eta_2 - eta_1)) + rate.dot(&(Q * (F_2 * eta_2_next) - F_1 * eta_1_next)))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Friction {
    c: f64, // N m s
}

/// Friction whose whole impulse is at the beginning of a step.
#[force(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    displacement(eta_1, eta_2),
    work = -c * (Q * vee(F_2) - vee(F_1)).dot(&(Q * eta_2 - eta_1)),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct EarlyFriction {
    c: f64, // N m s
}

/// A spring between two attitudes: half of `½ k θ²` at either end of a step, for the angle `θ` between them.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = -0.25 * h * k * (log(Q).norm_squared() + log(F_1.transpose() * Q * F_2).norm_squared()),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Torsion {
    k: f64, // N m
}

/// Light balls on bars between points of two bodies, with their kinetic energy.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = {
        let apart = (F_1 - I) * A - Q * (F_2 - I) * B;
        (apart * apart.transpose()).trace() / (2.0 * h)
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bars {
    A: Matrix3<f64>,
    B: Matrix3<f64>,
}

const BARS: Bars = Bars {
    A: Matrix3::new(0.1, 0.2, 0.05, 0.0, 0.1, -0.1, 0.2, 0.0, 0.1),
    B: Matrix3::new(-0.1, 0.1, 0.2, 0.1, 0.05, 0.0, 0.0, 0.2, 0.1),
};

fn inertia(moments: [f64; 3]) -> NonstandardInertia {
    NonstandardInertia::from_principal_moments(moments.into()).unwrap()
}

fn six(turn: &Vector3<f64>, shift: &Vector3<f64>) -> Vector6<f64> {
    Vector6::from_fn(|k, _| if k < 3 { turn[k] } else { shift[k - 3] })
}

/// The whole momentum, and that of rotation about the origin.
fn whole(stepper: &MultibodyStepper, state: &[f64]) -> Vector6<f64> {
    (0..stepper.bodies()).fold(Vector6::zeros(), |sum, body| {
        let ((attitude, place), momentum) = (stepper.attitude(state, body), stepper.momentum(state, body));
        let [turning, linear] = [0, 3].map(|first| momentum.fixed_rows::<3>(first).into_owned());
        sum + six(&(attitude.as_matrix() * turning + place.translation().cross(&linear)), &linear)
    })
}

fn place(stepper: &MultibodyStepper, state: &[f64], body: usize) -> Vector3<f64> {
    stepper.attitude(state, body).1.translation()
}

/// A hub on which two pendulums hang by ball joints with friction, as liquid in two tanks: the start is that of `slosh`.
fn tanks(h: f64, friction: [f64; 2]) -> (MultibodyStepper, Box<[f64]>) {
    let mut system = Multibody::new();
    system.body(FloatingBody { m: 10.0, J_d: inertia([4.0, 3.0, 2.0]) });
    let (pivots, arm) = ([Vector3::new(0.5, 0.1, 0.0), Vector3::new(-0.4, 0.0, 0.2)], Vector3::z() * 0.3);
    for (pivot, c) in pivots.into_iter().zip(friction) {
        let bob = system.body(FloatingBody { m: 1.0, J_d: inertia([0.01, 0.012, 0.008]) });
        system.join(Joint::ball([pivot, arm]), Some(0), bob);
        system.between([Some(0), Some(bob)], Friction { c });
    }
    let stepper = system.stepper(h).unwrap();
    let turns = [Vector3::new(0.5, 0.2, 0.1), Vector3::new(-0.3, 0.6, 0.0)].map(SO3::exp);
    let (turning, moving) = (Vector3::new(5.0, 1.0, 8.0), Vector3::x() * 0.1);
    let mut start = vec![(SO3::identity(), R3::identity())];
    let mut velocities = vec![six(&turning, &moving)];
    for ((turn, pivot), of_bob) in turns.iter().zip(pivots).zip([[4.0, 0.0, 8.5], [5.5, 2.0, 7.0]]) {
        let (arm, of_bob) = (turn.as_matrix() * arm, Vector3::from(of_bob));
        start.push((*turn, R3::from(pivot - arm)));
        let moved = moving + turning.cross(&pivot) - of_bob.cross(&arm);
        velocities.push(six(&turn.as_matrix().tr_mul(&of_bob), &moved));
    }
    let state = stepper.start(&start, &velocities).unwrap();
    (stepper, state)
}

/// A solver of order eight at a tolerance of 1e-13, by Newton's and Euler's equations with the joints' accelerations, has these
/// places, this velocity and this energy after four seconds.
#[test]
fn slosh_with_friction_moves_as_by_a_solver() {
    let expected = [Vector3::new(-0.331_988_047, -0.251_236_204, 0.893_789_196), {
        Vector3::new(0.053_473_325, 0.357_817_365, -0.412_639_849)
    }];
    let turning = Vector3::new(3.961_734_577, -2.998_242_038, 6.442_989_358);
    let off = |h: f64, steps: u64| {
        let (stepper, mut state) = tanks(h, [0.05, 0.02]);
        assert!((stepper.energy(&state) - 136.687_665_877).abs() < 1e-9);
        stepper.run(&mut state, steps).unwrap();
        let of_places: Vec<f64> = (0..2).map(|k| (place(&stepper, &state, k + 1) - expected[k]).norm()).collect();
        let of_turn = (stepper.velocity(&state, 0).fixed_rows::<3>(0) - turning).norm();
        [of_places[0], of_places[1], of_turn, (stepper.energy(&state) - 119.350_021_404).abs()]
    };
    let (coarse, fine) = (off(0.002, 2000), off(0.001, 4000));
    println!("{coarse:?}, {fine:?}");
    for (coarse, fine) in coarse.iter().zip(&fine) {
        assert!((coarse / fine - 4.0).abs() < 0.05, "not of order two: {coarse:e}, {fine:e}");
    }
    assert!(fine.iter().all(|&off| off < 2e-3), "{fine:?}");
}

/// Friction and kinetic couplings are internal: the momenta of free bodies stay, whatever the step.
#[test]
fn isolated_bodies_keep_their_momenta() {
    for h in [0.005, 0.02] {
        let (mut steppers, mut random) = (Vec::new(), Random::new(3));
        steppers.push(tanks(h, [0.05, 5.0]));
        let mut system = Multibody::new();
        for k in 0..4 {
            system.body(FloatingBody { m: 1.0 + 0.2 * f64::from(k), J_d: inertia([0.3, 0.4, 0.5]) });
        }
        system.between([Some(0), Some(1)], BARS);
        system.between([Some(3), Some(1)], BARS);
        system.between([Some(2), Some(0)], Friction { c: 2.0 });
        system.between([Some(3), Some(2)], EarlyFriction { c: 0.5 });
        system.between([Some(0), Some(3)], Torsion { k: 0.7 });
        let stepper = system.stepper(h).unwrap();
        let at: [Body; 4] =
            from_fn(|_| (SO3::exp(random.sample::<Vector3<f64>>() * 0.5), R3::from(random.sample::<Vector3<f64>>())));
        let velocities: [Vector6<f64>; 4] = from_fn(|_| random.sample());
        let state = stepper.start(&at, &velocities).unwrap();
        steppers.push((stepper, state));
        for (stepper, mut state) in steppers {
            let before = whole(&stepper, &state);
            let energy = stepper.energy(&state);
            for _ in 0..20 {
                stepper.step(&mut state).unwrap();
            }
            let off = (whole(&stepper, &state) - before).norm() / before.norm();
            println!("{off:e} of the momentum, energy {energy} to {}", stepper.energy(&state));
            assert!(off < 1e-14, "{off:e}");
        }
    }
}

/// Every step satisfies the discrete Lagrange–d'Alembert principle: the momenta at its ends are those of the Lagrangians less
/// the declared forces, along twelve displacements of each end.
#[test]
fn a_step_is_that_of_the_virtual_work() {
    let (h, friction) = (0.05, EarlyFriction { c: 0.7 });
    let bodies = [[0.3, 0.4, 0.5], [0.2, 0.25, 0.3]].map(|J| FloatingBody { m: 1.3, J_d: inertia(J) });
    let mut system = Multibody::new();
    for body in bodies {
        system.body(body);
    }
    system.between([Some(1), Some(0)], friction);
    system.between([Some(0), Some(1)], BARS);
    let stepper = system.stepper(h).unwrap();
    let mut random = Random::new(8);
    let start: [Body; 2] =
        from_fn(|_| (SO3::exp(random.sample::<Vector3<f64>>()), R3::from(random.sample::<Vector3<f64>>())));
    let mut state = stepper.start(&start, &[random.sample(), random.sample()]).unwrap();
    for _ in 0..3 {
        let [now, before] = [0, 1].map(|body| (stepper.attitude(&state, body), stepper.momentum(&state, body)));
        let report = stepper.step(&mut state).unwrap();
        let [next, after] = [0, 1].map(|body| (stepper.attitude(&state, body), stepper.momentum(&state, body)));
        let f = [(now, next), (before, after)].map(|(now, next)| now.0.inverse().compose(&next.0).matrix());
        // Attitudes of the first and the second body, in the order of each term.
        let (turns, reversed) = ((f[0].0, f[1].0), (f[1].0, f[0].0));
        let bars = BARS.advected().seen_from(&(now.0.0, before.0.0));
        let rubbing = friction.advected().seen_from(&(before.0.0, now.0.0));
        let work = |end: [f64; 2], body: usize, k: usize| {
            let axis = Vector6::ith(3 * (1 - body) + k, 1.0);
            friction.virtual_work(&reversed, &rubbing, h, &(axis * end[0]), &(axis * end[1]))
        };
        let of_bars = [BARS.legendre_minus(&turns, &bars, h), BARS.legendre_plus(&turns, &bars, h)];
        for (body, (of_body, momenta)) in [(now.1, next.1), (before.1, after.1)].into_iter().enumerate() {
            let alone = [bodies[body].legendre_minus(&f[body], &(), h), bodies[body].legendre_plus(&f[body], &(), h)];
            let ends = [[1.0, 0.0], [0.0, 1.0]].map(|end| Vector3::from_fn(|k, _| work(end, body, k)));
            let of_pair = of_bars.map(|both| both.fixed_rows::<3>(3 * body).into_owned());
            let zero = Vector3::zeros();
            let off = [
                of_body - alone[0] - six(&(of_pair[0] - ends[0]), &zero),
                momenta - alone[1] - six(&(of_pair[1] + ends[1]), &zero),
            ];
            assert!(off.iter().all(|off| off.amax() < 1e-13), "{off:?}, {} iterations", report.iterations);
        }
    }
}

/// An arm on a vertical pin, and a rod on a horizontal one at its end, both with friction of 0.1 N m s. A solver of order eight
/// has these places after a second.
#[test]
fn a_furuta_pendulum_with_friction() {
    let mut system = Multibody::new();
    let (down, up, half) = (Vector3::z() * -0.2, Vector3::z(), Vector3::x() * 0.15);
    let falling = |m, J| FallingBody { m, J_d: inertia(J), g: 9.81, up };
    let arm = system.body(falling(0.2, [0.0002, 0.0016, 0.0016]));
    let rod = system.body(falling(0.1, [0.0014, 0.0014, 0.0001]));
    let pin = |above, below, axis| Joint::pin([above, below], [axis; 2]);
    system.join(pin(Vector3::zeros(), -half, up), None, arm);
    system.join(pin(half, -down, Vector3::x()), Some(arm), rod);
    system.between([None, Some(arm)], Friction { c: 0.1 });
    system.between([Some(arm), Some(rod)], Friction { c: 0.1 });
    let stepper = system.stepper(1e-3).unwrap();
    let (turn, at_end) = (SO3::exp(Vector3::x() * 2.0), half * 2.0);
    let hanging = turn.as_matrix() * down;
    let start = [(SO3::identity(), R3::from(half)), (turn, R3::from(at_end + hanging))];
    let (of_arm, of_rod) = (up * 3.0, Vector3::new(1.0, 0.0, 3.0));
    let moving = of_arm.cross(&at_end) + of_rod.cross(&hanging);
    let velocities = [six(&of_arm, &of_arm.cross(&half)), six(&turn.as_matrix().tr_mul(&of_rod), &moving)];
    let mut state = stepper.start(&start, &velocities).unwrap();
    stepper.run(&mut state, 1000).unwrap();
    let expected = [
        Vector3::new(0.122_658_176_638, 0.086_342_178_012, 0.0),
        Vector3::new(0.194_560_588_851, 0.244_788_276_282, -0.179_512_888_286),
    ];
    let off = from_fn::<_, 2, _>(|body| (place(&stepper, &state, body) - expected[body]).norm());
    println!("{off:?}");
    assert!(off.iter().all(|&off| off < 2e-6), "{off:?}");
}

/// A sphere on a ball joint with a spring of 1 N m a radian swings as cos(t/√J).
#[test]
fn a_spring_in_a_joint_swings_as_a_cosine() {
    let mut system = Multibody::new();
    let body = system.body(FloatingBody { m: 2.0, J_d: inertia([1.0; 3]) });
    let joint = Joint::ball([Vector3::zeros(), Vector3::zeros()]);
    system.join(joint, None, body);
    system.between([None, Some(body)], Torsion { k: 1.0 });
    let stepper = system.stepper(1e-3).unwrap();
    let axis = Vector3::new(0.6, 0.0, 0.8);
    let start = [(SO3::exp(axis * 0.5), R3::identity())];
    let mut state = stepper.start(&start, &[Vector6::zeros()]).unwrap();
    let mut off = 0.0_f64;
    for step in 1..=10_000 {
        stepper.step(&mut state).unwrap();
        let angle = stepper.attitude(&state, body).0.log().dot(&axis);
        off = off.max((angle / 0.5 - (f64::from(step) * 1e-3).cos()).abs());
    }
    println!("{off:e}");
    assert!(off < 1e-6, "{off:e}");
}

/// Means of the energy of a chain with friction fall, and it never exceeds its start by more than without friction, from weak to
/// strong friction `x = c h/J`.
#[test]
fn friction_of_any_strength_takes_energy() {
    const MOMENT: f64 = 0.1;
    let run = |x: f64, steps: [usize; 2]| {
        let h = 0.01;
        let mut system = Multibody::new();
        let half = Vector3::x() * 0.5;
        for k in 0..3_usize {
            let body =
                system.body(FallingBody { m: 1.0, J_d: inertia([0.02, MOMENT, MOMENT]), g: 9.81, up: Vector3::z() });
            let before = k.checked_sub(1);
            let above = before.map_or(Vector3::zeros(), |_| half);
            system.join(Joint::ball([above, -half]), before, body);
            system.between([before, Some(body)], Friction { c: x * MOMENT / h });
        }
        let stepper = system.stepper(h).unwrap();
        let row = from_fn::<Body, 3, _>(|k| {
            let along = Vector3::x() * (0.5 + f64::from(u8::try_from(k).unwrap()));
            (SO3::identity(), R3::from(along))
        });
        let turning = [Vector3::new(0.5, 1.0, 0.0), Vector3::y() * -1.0, Vector3::z()];
        let velocities = turning.map(|turn| six(&turn, &Vector3::zeros()));
        let mut state = stepper.start_nearest(&row, &velocities).unwrap();
        let start = stepper.energy(&state);
        let (mut means, mut above) = (vec![0.0; steps[0]], 0.0_f64);
        for mean in &mut means {
            for _ in 0..steps[1] {
                stepper.step(&mut state).unwrap();
                let energy = stepper.energy(&state);
                above = above.max(energy - start);
                #[allow(clippy::cast_precision_loss)] // few
                let share = 1.0 / steps[1] as f64;
                *mean += energy * share;
            }
        }
        (means, above)
    };
    let (_, band) = run(0.0, [4, 100]);
    for x in [1e-3, 1e-1, 1.0, 1e1, 1e3] {
        let (means, above) = run(x, [4, 100]);
        println!("{x:e}: {means:?}, above the start by {above:e} (undamped {band:e})");
        assert!(means.windows(2).all(|pair| pair[1] < pair[0]), "{x:e}: {means:?}");
        assert!(above <= band, "{x:e}: {above:e}");
    }
}

/// Rods in a row move as by the equations of the row, which are solved together.
#[test]
fn a_row_of_elements_has_the_steps_of_coupled_places() {
    const N: usize = 4;
    let half = Vector3::x() * 0.5;
    let J_d = NonstandardInertia::from_diagonal(Vector3::new(1.0 / 12.0, 1e-3, 1e-3)).unwrap();
    let (piece, element) = (FloatingBody { m: 1.0, J_d }, RodElement { k: 1e4, c: 20.0, a: half, b: -half });
    let row = Each::<N>::of([piece]) + Coupling::<N>::of([element]);
    let typed = Stepper::new(row, 0.01).unwrap();
    let mut system = Multibody::new();
    (0..N).for_each(|_| _ = system.body(piece));
    (1..N).for_each(|k| system.between([Some(k - 1), Some(k)], element));
    let stepper = system.stepper(0.01).unwrap();
    let turn = Vector3::new(0.3, 0.2, 1.0);
    let start = from_fn::<Body, N, _>(|k| {
        let k = f64::from(u8::try_from(k).unwrap());
        (SO3::exp(Vector3::new(0.02, 0.01, 0.05) * k), R3::from(Vector3::new(k, 0.03 * k * k, 0.0)))
    });
    let velocities =
        start.map(|(attitude, at): Body| six(&attitude.as_matrix().tr_mul(&turn), &turn.cross(&at.translation())));
    let mut expected = typed.start(start, Bodies(velocities)).unwrap();
    let mut state = stepper.start(&start, &velocities).unwrap();
    assert!((stepper.energy(&state) - typed.energy(&expected)).abs() < 1e-12 * typed.energy(&expected));
    typed.run(&mut expected, 50).unwrap();
    stepper.run(&mut state, 50).unwrap();
    for body in 0..N {
        let off = (place(&stepper, &state, body) - expected.attitude()[body].1.translation()).norm();
        let of_momentum = (stepper.momentum(&state, body) - expected.momentum().0[body]).norm();
        assert!(off < 1e-12 && of_momentum < 1e-10, "{off:e} {of_momentum:e}");
    }
}

/// The numbers of bodies don't matter, nor whether the ends of a term are neighbours in the tree of joints.
#[test]
fn a_term_across_joints_doesnt_depend_on_the_order_of_bodies() {
    const N: usize = 4;
    let half = Vector3::x() * 0.5;
    let end = |numbers: [usize; N]| {
        let mut system = Multibody::new();
        let mut chained = [0; N];
        (0..N).for_each(|place| chained[numbers[place]] = place);
        for number in chained {
            let m = 1.0 + 0.2 * f64::from(u8::try_from(number).unwrap());
            system.body(FallingBody { m, J_d: inertia([0.02, 0.1, 0.1]), g: 9.81, up: Vector3::z() });
        }
        for k in 0..N {
            let before = k.checked_sub(1);
            let above = before.map_or(Vector3::zeros(), |_| half);
            system.join(Joint::ball([above, -half]), before.map(|k| numbers[k]), numbers[k]);
        }
        let [first, .., last] = numbers;
        system.between([Some(first), Some(last)], Friction { c: 0.3 });
        system.between([Some(numbers[2]), Some(numbers[0])], BARS);
        let stepper = system.stepper(0.01).unwrap();
        let start: Vec<Body> = chained
            .map(|k| (SO3::identity(), R3::from(Vector3::x() * (0.5 + f64::from(u8::try_from(k).unwrap())))))
            .into();
        let turning = [Vector3::x(), Vector3::y() * 0.5, Vector3::z() * -0.3, Vector3::new(0.2, 0.1, 0.9)];
        let velocities = chained.map(|k| six(&turning[k], &Vector3::zeros()));
        let mut state = stepper.start_nearest(&start, &velocities).unwrap();
        stepper.run(&mut state, 60).unwrap();
        (numbers.map(|body| place(&stepper, &state, body)), stepper.energy(&state))
    };
    let (expected, energy) = end([0, 1, 2, 3]);
    for numbers in [[3, 2, 1, 0], [2, 0, 3, 1]] {
        let (places, other) = end(numbers);
        let off = places.iter().zip(&expected).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        println!("{off:e}, {:e}", other - energy);
        assert!(off < 1e-11 && (other - energy).abs() < 1e-11, "{off:e}");
    }
}

/// A mass.
#[lagrangian(group(d = R3), l_d = m * d.norm_squared() / (2.0 * h))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mass {
    m: f64,
}

/// The effects of one body are those of a body of a system, on its rotation alone.
#[test]
fn effects_of_rotations_act_on_bodies_of_a_system() {
    let (J_d, h) = (inertia([0.3, 0.4, 0.5]), 0.05);
    let drag = Drag { c: 0.2, J: J_d.to_inertia() };
    let alone = Stepper::new(RigidBody { J_d } + drag, h).unwrap();
    let turning = Vector3::new(1.0, 2.0, -0.5);
    let mut expected = alone.start(SO3::identity(), turning).unwrap();
    alone.run(&mut expected, 100).unwrap();
    for in_parts in [true, false] {
        let mut system = Multibody::new();
        if in_parts {
            system.body(RigidBody { J_d });
            system.on(0, Mass { m: 2.0 });
        } else {
            system.body(FloatingBody { m: 2.0, J_d });
        }
        system.on(0, drag);
        let stepper = system.stepper(h).unwrap();
        let mut state = stepper.start(&[(SO3::identity(), R3::identity())], &[six(&turning, &Vector3::x())]).unwrap();
        stepper.run(&mut state, 100).unwrap();
        let off = (stepper.attitude(&state, 0).0.as_matrix() - expected.attitude().as_matrix()).amax();
        let moved = (place(&stepper, &state, 0) - Vector3::x() * 5.0).norm();
        assert!(off < 1e-13 && moved < 1e-13, "{off:e} {moved:e}");
    }
    // A rotation without a mass isn't a body.
    let mut system = Multibody::new();
    system.body(RigidBody { J_d });
    assert!(matches!(system.stepper(h), Err(SetupError::SingularKinetic { .. })));
}

/// A bob of a tonne on a rod of ten milligrams: an update's rounding is some nanoradians in the rod's own spin, and steps are
/// those of the equations all the same. The places after ten seconds are those by a solver of order eight.
#[test]
fn bodies_whose_masses_differ_by_a_hundred_millions() {
    let expected = [[-0.012_140_005, 0.0, -0.499_852_599], [-0.030_111_062, 0.0, -1.199_620_176]].map(Vector3::from);
    let off = |h: f64, steps: u64| {
        let mut system = Multibody::new();
        let up = Vector3::z();
        let ball = |above: f64, below: f64| Joint::ball([up * above, up * below]);
        let body = |m, J: f64| FallingBody { m, J_d: inertia([J; 3]), g: 9.81, up };
        let rod = system.body(body(1e-5, 8.333_333e-7));
        let bob = system.body(body(1000.0, 16.0));
        system.join(ball(0.0, 0.5), None, rod);
        system.join(ball(-0.5, 0.2), Some(rod), bob);
        let stepper = system.stepper(h).unwrap();
        let centres = [-0.5, -1.2];
        let start = centres.map(|z| (SO3::identity(), R3::from(Vector3::z() * z)));
        let velocities = centres.map(|z| six(&Vector3::y(), &(Vector3::x() * z)));
        let mut state = stepper.start(&start, &velocities).unwrap();
        let energy = stepper.energy(&state);
        stepper.run(&mut state, steps).unwrap();
        let (gap, change) = (stepper.widest_gap(&state), (stepper.energy(&state) / energy - 1.0).abs());
        println!("joints open by {gap:e}, energy by {change:e}");
        assert!(gap < 1e-14 && change < 1e-5, "{gap:e} {change:e}");
        from_fn::<_, 2, _>(|body| (place(&stepper, &state, body) - expected[body]).norm())
    };
    let (coarse, fine) = (off(0.002, 5000), off(0.001, 10_000));
    println!("{coarse:?} {fine:?}");
    for (coarse, fine) in coarse.iter().zip(&fine) {
        assert!(*fine < 5e-5 && (coarse / fine - 4.0).abs() < 0.05, "{coarse:e} {fine:e}");
    }
}
