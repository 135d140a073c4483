//! Dry friction in joints, and rotors of motors in them, against closed forms.

use liestep::SO3;
use liestep::effects::joints::{Armature, DryFriction, JointTorque, SliderArmature, SliderFriction, SliderSpring};
use liestep::groups::{LieGroup as _, R3};
use liestep::methods::{CompositionScheme, Joint, Multibody, MultibodyStepper};
use nalgebra::{Matrix3, Rotation3, Vector3, Vector6};

use crate::joints::{assert_second_order, at, falling, floating, position, six, solved};

/// A wheel with dry friction on a pin slows down by `τ t / J` until it creeps.
#[test]
fn dry_friction_stops_a_wheel() {
    let (J, torque) = (0.4, 0.2);
    let mut system = Multibody::new();
    let wheel = system.body(floating(1.0, [0.3, 0.3, J]));
    system.join(Joint::pin([Vector3::zeros(); 2], [Vector3::z(); 2]), None, wheel);
    system.between([None, Some(wheel)], DryFriction { torque, rate: 1e-3 });
    let stepper = system.stepper(0.01).unwrap();
    let mut state = stepper.start(&[at(0.0, 0.0, 0.0)], &[six([0.0, 0.0, 3.0], [0.0; 3])]).unwrap();
    stepper.run(&mut state, 400).unwrap();
    let rate = stepper.velocity(&state, wheel)[2];
    assert!((rate - (3.0 - torque * 4.0 / J)).abs() < 1e-5, "{rate}");
    stepper.run(&mut state, 400).unwrap();
    assert!(stepper.velocity(&state, wheel)[2].abs() < 1e-3);
}

/// Dry friction is undone by steps back, so that a composition has its order where friction is smooth beside a step.
#[test]
fn dry_friction_has_the_order_of_a_composition() {
    let spun = |steps: u64| {
        let mut system = Multibody::new();
        let wheel = system.body(floating(1.0, [0.3, 0.3, 0.4]));
        system.join(Joint::pin([Vector3::zeros(); 2], [Vector3::z(); 2]), None, wheel);
        system.between([None, Some(wheel)], DryFriction { torque: 0.5, rate: 2.0 });
        #[allow(clippy::cast_precision_loss)]
        let stepper = system.stepper(2.0 / steps as f64).unwrap().composed(CompositionScheme::SUZUKI_4).unwrap();
        let mut state = stepper.start(&[at(0.0, 0.0, 0.0)], &[six([0.0, 0.0, 3.0], [0.0; 3])]).unwrap();
        stepper.run(&mut state, steps).unwrap();
        stepper.velocity(&state, wheel)[2]
    };
    let finest = spun(320);
    let [coarse, fine] = [10, 20].map(|steps| (spun(steps) - finest).abs());
    assert!((coarse / fine - 16.0).abs() < 2.0, "not of order four: {coarse:e}, {fine:e}");
}

/// A mass with dry friction on a slider slows down by `f t/m` until it creeps; where friction is viscous, as in closed form.
#[test]
fn dry_friction_stops_a_mass() {
    let (m, force) = (1.5, 0.3);
    let axis = Vector3::new(0.0, 0.6, 0.8);
    let moved = |speed: f64, start: f64, steps: u64| {
        let mut system = Multibody::new();
        let mass = system.body(floating(m, [0.2; 3]));
        system.join(Joint::slider([Vector3::zeros(); 2], axis, Matrix3::identity()), None, mass);
        system.between([None, Some(mass)], SliderFriction { force, speed, axis, at_2: Vector3::zeros() });
        let stepper = system.stepper(0.01).unwrap();
        let velocity = six([0.0; 3], (axis * start).into());
        let mut state = stepper.start(&[(SO3::identity(), R3::identity())], &[velocity]).unwrap();
        stepper.run(&mut state, steps).unwrap();
        (position(&stepper, &state, mass).dot(&axis), stepper.velocity(&state, mass))
    };
    let (way, velocity) = moved(1e-3, 2.0, 500);
    assert!((way - (2.0 * 5.0 - force * 25.0 / (2.0 * m))).abs() < 1e-4, "{way}");
    assert!((velocity.fixed_rows::<3>(3).dot(&axis) - (2.0 - force * 5.0 / m)).abs() < 1e-5, "{velocity}");
    let (_, velocity) = moved(1e-3, 2.0, 1200);
    assert!(velocity.norm() < 1e-3);
    // Slower than the speed by much it is friction of the coefficient f/u.
    let (way, _) = moved(100.0, 0.1, 500);
    let rate = force / 100.0 / m;
    assert!((way - 0.1 / rate * (1.0 - (-rate * 5.0_f64).exp())).abs() < 1e-6, "{way}");
}

/// A heavy mass on an inclined rail with dry friction. A friction that is weaker than its pull lets it slide with `g sin a − f/m`;
/// under a stronger one it creeps at the speed at which both are equal.
#[test]
fn a_mass_on_an_incline() {
    let (m, g) = (1.5, 9.81);
    let down = Vector3::new(0.8, 0.0, -0.6);
    let pull = m * g * 0.6;
    let moved = |share: f64, speed: f64, (start, steps): (f64, u64)| {
        let mut system = Multibody::new();
        let mass = system.body(falling(m, [0.2; 3]));
        system.join(Joint::slider([Vector3::zeros(); 2], down, Matrix3::identity()), None, mass);
        system.between(
            [None, Some(mass)],
            SliderFriction { force: share * pull, speed, axis: down, at_2: Vector3::zeros() },
        );
        let stepper = system.stepper(0.01).unwrap();
        let velocity = six([0.0; 3], (down * start).into());
        let mut state = stepper.start(&[at(0.0, 0.0, 0.0)], &[velocity]).unwrap();
        stepper.run(&mut state, steps).unwrap();
        let velocity = stepper.velocity(&state, mass);
        (position(&stepper, &state, mass).dot(&down), velocity.fixed_rows::<3>(3).dot(&down))
    };
    let (way, speed) = moved(0.7, 1e-3, (1.0, 200));
    let slide = g * 0.6 * 0.3;
    assert!((speed - (1.0 + slide * 2.0)).abs() < 1e-5, "{speed}");
    assert!((way - (2.0 + 0.5 * slide * 4.0)).abs() < 1e-5, "{way}");
    // f v/√(v² + u²) = m g sin a has the solution u k/√(1 − k²), k = m g sin a/f.
    for force in [1.25_f64, 2.0, 10.0] {
        let share = 1.0 / force;
        let creep = 0.02 * share / (1.0 - share * share).sqrt();
        let (_, speed) = moved(force, 0.02, (0.0, 400));
        assert!((speed - creep).abs() < 1e-9, "{force}: {speed} {creep}");
    }
}

/// A mass on a spring with dry friction: of second order where friction is smooth, and its
/// energy falls in each step, but for the oscillation of the spring's.
#[test]
fn friction_on_a_spring_is_of_second_order() {
    let (m, k, force, speed) = (1.5, 12.0, 3.0, 0.5);
    let axis = Vector3::new(0.0, 0.6, 0.8);
    let pull = |[y]: &[f64; 1], [v]: &[f64; 1]| [(-k * y - force * v / v.hypot(speed)) / m];
    let ([expected], _) = solved(pull, ([1.0], [0.0]), 1.5);
    let off = [(0.01, 150), (0.005, 300)].map(|(h, steps)| {
        let mut system = Multibody::new();
        let mass = system.body(floating(m, [0.2; 3]));
        system.join(Joint::slider([Vector3::zeros(); 2], axis, Matrix3::identity()), None, mass);
        system.between([None, Some(mass)], SliderSpring { k, rest: 0.0, force: 0.0, axis, at_2: Vector3::zeros() });
        system.between([None, Some(mass)], SliderFriction { force, speed, axis, at_2: Vector3::zeros() });
        let stepper = system.stepper(h).unwrap();
        let mut state = stepper.start(&[(SO3::identity(), R3::from(axis))], &[Vector6::zeros()]).unwrap();
        let (start, mut energy) = (stepper.energy(&state), stepper.energy(&state));
        for _ in 0..steps {
            stepper.step(&mut state).unwrap();
            let now = stepper.energy(&state);
            assert!(now < energy + 2e-3 * h * start, "{energy} {now}");
            energy = now;
        }
        assert!(energy < 0.5 * start);
        (position(&stepper, &state, mass).dot(&axis) - expected).abs()
    });
    assert_second_order(off);
}

/// Two free bodies on a slider with friction alone, weak or strong: the linear and the angular momentum stay.
#[test]
fn friction_between_bodies_keeps_the_momenta() {
    let axis = Vector3::new(0.6, 0.0, 0.8);
    for force in [1e-3, 1.0, 20.0] {
        let mut system = Multibody::new();
        let bodies = [floating(2.0, [0.3, 0.5, 0.4]), floating(1.0, [0.1, 0.15, 0.12])].map(|one| system.body(one));
        system.join(Joint::slider([Vector3::zeros(); 2], axis, Matrix3::identity()), Some(bodies[0]), bodies[1]);
        system.between(bodies.map(Some), SliderFriction { force, speed: 1e-3, axis, at_2: Vector3::zeros() });
        let stepper = system.stepper(0.005).unwrap();
        let turning = Vector3::new(0.3, -1.0, 0.5);
        let moving = Vector3::x() * 0.2 + axis * 0.5 + turning.cross(&(axis * 0.3));
        let places = [at(0.0, 0.0, 0.0), (SO3::identity(), R3::from(axis * 0.3))];
        let velocities = [six(turning.into(), [0.2, 0.0, 0.0]), six(turning.into(), moving.into())];
        let mut state = stepper.start(&places, &velocities).unwrap();
        let (before, energy) = (whole(&stepper, &state), stepper.energy(&state));
        stepper.run(&mut state, 1000).unwrap();
        let off = (whole(&stepper, &state) - before).amax();
        println!("{force:e}: momentum within {off:e}");
        assert!(off < 2e-13, "{force:e}: {off:e}");
        let rate = {
            let [one, other] = bodies.map(|body| stepper.attitude(&state, body));
            let apart = other.1.translation() - one.1.translation();
            let [one_moves, other_moves] =
                bodies.map(|body| stepper.velocity(&state, body).fixed_rows::<3>(3).into_owned());
            let turn = one.0.as_matrix() * stepper.velocity(&state, bodies[0]).fixed_rows::<3>(0);
            (one.0.as_matrix() * axis).dot(&(other_moves - one_moves - turn.cross(&apart)))
        };
        assert!(force < 1.0 || rate.abs() < 2e-3, "{force:e}: {rate}");
        assert!(stepper.energy(&state) < energy);
    }
}

/// The linear momentum of all bodies, and the angular momentum about the origin.
fn whole(stepper: &MultibodyStepper, state: &[f64]) -> Vector6<f64> {
    (0..stepper.bodies()).fold(Vector6::zeros(), |sum, body| {
        let (momentum, place) = (stepper.momentum(state, body), stepper.attitude(state, body));
        let [turning, linear] = [0, 3].map(|k| momentum.fixed_rows::<3>(k).into_owned());
        sum + six((place.0.as_matrix() * turning + place.1.translation().cross(&linear)).into(), linear.into())
    })
}

/// A motor between two free bodies on a pin whose rotor has the inertia `a`: `θ̇ = τ t/(a + J_1 J_2/(J_1 + J_2))`, exactly, and no
/// angular momentum.
#[test]
fn a_rotor_in_a_pin() {
    let (torque, a, [first, second]) = (0.02, 0.03, [0.8, 0.1]);
    let mut system = Multibody::new();
    let (hub, wheel) =
        (system.body(floating(3.0, [0.5, 0.5, first])), system.body(floating(1.0, [0.05, 0.06, second])));
    let turned = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.7);
    system.join(Joint::pin([Vector3::zeros(); 2], [Vector3::z(); 2]), Some(hub), wheel);
    let axis = Vector3::z();
    system.between([Some(hub), Some(wheel)], JointTorque { torque, axis_1: axis, axis_2: axis });
    system.between([Some(hub), Some(wheel)], Armature { a });
    let stepper = system.stepper(0.01).unwrap();
    let places = [at(0.0, 0.0, 0.0), (SO3::from(turned), R3::identity())];
    let mut state = stepper.start(&places, &[Vector6::zeros(); 2]).unwrap();
    stepper.run(&mut state, 300).unwrap();
    let rates = [hub, wheel].map(|body| stepper.velocity(&state, body)[2]);
    let expected = torque * 3.0 / (a + first * second / (first + second));
    assert!((rates[1] - rates[0] - expected).abs() < 1e-4 * expected, "{rates:?} {expected}");
    assert!((first * rates[0] + second * rates[1]).abs() < 1e-14, "{rates:?}");
    let kinetic = 0.5 * (first * rates[0].powi(2) + second * rates[1].powi(2) + a * (rates[1] - rates[0]).powi(2));
    assert!((stepper.energy(&state) - kinetic).abs() < 1e-6 * kinetic);
}

/// A pendulum with a rotor in its pin: `(J + m l² + a) θ'' = −m g l sin θ`, of order two, and of order four by a composition.
#[test]
fn a_pendulum_with_a_rotor() {
    let (m, arm, moment, a) = (1.2, 0.4, 0.05, 0.3);
    let whole = moment + m * arm * arm + a;
    let ([expected], _) = solved(|[y], _| [-m * 9.81 * arm / whole * y.sin()], ([0.9], [0.5]), 1.5);
    let swung = |scheme: Option<CompositionScheme>, h: f64, steps: u64| {
        let mut system = Multibody::new();
        let rod = system.body(falling(m, [moment, moment, 0.001]));
        system.join(Joint::pin([Vector3::zeros(), Vector3::z() * arm], [Vector3::y(); 2]), None, rod);
        system.between([None, Some(rod)], Armature { a });
        let stepper = system.stepper(h).unwrap();
        let stepper = scheme.map_or_else(|| stepper.clone(), |scheme| stepper.clone().composed(scheme).unwrap());
        let tilt = SO3::exp(Vector3::y() * 0.9);
        let place = tilt.as_matrix() * Vector3::z() * -arm;
        let moving = (Vector3::y() * 0.5).cross(&place);
        let mut state = stepper.start(&[(tilt, R3::from(place))], &[six([0.0, 0.5, 0.0], moving.into())]).unwrap();
        let energy = stepper.energy(&state);
        assert!((energy - (0.5 * whole * 0.25 - m * 9.81 * arm * 0.9_f64.cos())).abs() < 1e-13);
        stepper.run(&mut state, steps).unwrap();
        (position(&stepper, &state, rod) + SO3::exp(Vector3::y() * expected).as_matrix() * Vector3::z() * arm).norm()
    };
    assert_second_order([swung(None, 0.01, 150), swung(None, 0.005, 300)]);
    let [coarse, fine] = [(0.05, 30), (0.025, 60)].map(|(h, steps)| swung(Some(CompositionScheme::SUZUKI_4), h, steps));
    assert!((coarse / fine - 16.0).abs() < 1.5, "not of order four: {coarse:e}, {fine:e}");
}

/// Two masses on a slider between them, with a force and a rotor that the slider feels as `a`: `s̈ = f/(a + m_1 m_2/(m_1 + m_2))`.
#[test]
fn a_rotor_in_a_slider() {
    let (force, a, [first, second]) = (0.6, 0.9, [2.0, 0.5]);
    let axis = Vector3::new(0.0, 0.6, 0.8);
    let mut system = Multibody::new();
    let bodies = [first, second].map(|m| system.body(floating(m, [0.2, 0.3, 0.4])));
    system.join(Joint::slider([Vector3::zeros(); 2], axis, Matrix3::identity()), Some(bodies[0]), bodies[1]);
    system.between(bodies.map(Some), SliderSpring { k: 0.0, rest: 0.0, force, axis, at_2: Vector3::zeros() });
    system.between(bodies.map(Some), SliderArmature { a, axis, at_2: Vector3::new(0.1, 0.2, -0.3) });
    let stepper = system.stepper(0.01).unwrap();
    let places = [at(0.0, 0.0, 0.0), (SO3::identity(), R3::from(axis * 0.1))];
    let mut state = stepper.start(&places, &[Vector6::zeros(); 2]).unwrap();
    stepper.run(&mut state, 200).unwrap();
    let [one, other] = bodies.map(|body| stepper.velocity(&state, body).fixed_rows::<3>(3).dot(&axis));
    let expected = force * 2.0 / (a + first * second / (first + second));
    assert!((other - one - expected).abs() < 1e-12, "{one} {other} {expected}");
    assert!((first * one + second * other).abs() < 1e-13);
    assert!(
        (stepper.energy(&state)
            - (0.5 * (first * one * one + second * other * other) + 0.5 * a * expected * expected
                - force * (position(&stepper, &state, bodies[1]) - position(&stepper, &state, bodies[0])).dot(&axis)))
        .abs()
            < 1e-12
    );
}

/// Friction that is sharp beside a step: each step is solved, the mass stops within a step's way, and its speed never grows. A step's
/// impulse comes in two halves, so a friction whose half stops the mass turns its momentum round, as the implicit midpoint
/// rule does.
#[test]
fn sharp_friction_is_solved() {
    let axis = Vector3::z();
    for m in [1.0, 100.0] {
        for force in [1e3, 1e5] {
            for speed in [1e-2, 1e-3, 1e-4, 1e-6] {
                let mut system = Multibody::new();
                let mass = system.body(floating(m, [0.2; 3]));
                system.join(Joint::slider([Vector3::zeros(); 2], axis, Matrix3::identity()), None, mass);
                system.between([None, Some(mass)], SliderFriction { force, speed, axis, at_2: Vector3::zeros() });
                let stepper = system.stepper(5e-3).unwrap();
                let start = six([0.0; 3], (axis * 2.0).into());
                let mut state = stepper.start(&[at(0.0, 0.0, 0.0)], &[start]).unwrap();
                let stops = (m * 2.0 * 2.0 / (2.0 * force)).max(2.0 * 5e-3);
                let mut before = 2.0;
                for _ in 0..100 {
                    stepper.step(&mut state).unwrap();
                    let now = stepper.velocity(&state, mass)[5].abs();
                    // At rest a place's rounding error is a velocity of up to 1e-8 m/s, by the slope of friction.
                    assert!(now <= before * (1.0 + 1e-12) || now < 1e-8, "{m} {force} {speed}: {now} {before}");
                    before = now;
                }
                let way = position(&stepper, &state, mass)[2];
                assert!(way > 0.0 && way < 1.1 * stops, "{m} {force} {speed}: {way} {stops}");
            }
        }
    }
}
