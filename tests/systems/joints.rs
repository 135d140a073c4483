//! Joints of all kinds, with springs, friction and motors in them, against closed forms and equations of few angles; functions
//! of joints that the others imply.

use declarations::{FallingBody, FloatingBody};
use liestep::effects::joints::{
    DryFriction, JointDamping, JointSpring, JointTorque, SliderDamping, SliderFriction, SliderSpring,
};
use liestep::groups::{LieGroup as _, R3};
use liestep::methods::{Joint, Multibody, MultibodyStepper};
use liestep::{NonstandardInertia, SO3, SetupError, StepError, lagrangian};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3, Vector6};

type Body = (SO3, R3);

pub(crate) fn inertia(moments: [f64; 3]) -> NonstandardInertia {
    NonstandardInertia::from_principal_moments(moments.into()).unwrap()
}

pub(crate) fn falling(m: f64, moments: [f64; 3]) -> FallingBody {
    FallingBody { m, J_d: inertia(moments), g: 9.81, up: Vector3::z() }
}

pub(crate) fn floating(m: f64, moments: [f64; 3]) -> FloatingBody {
    FloatingBody { m, J_d: inertia(moments) }
}

pub(crate) fn at(x: f64, y: f64, z: f64) -> Body {
    (SO3::identity(), R3::from(Vector3::new(x, y, z)))
}

pub(crate) fn six(turn: [f64; 3], shift: [f64; 3]) -> Vector6<f64> {
    Vector6::from_fn(|k, _| if k < 3 { turn[k] } else { shift[k - 3] })
}

pub(crate) fn position(stepper: &MultibodyStepper, state: &[f64], body: usize) -> Vector3<f64> {
    stepper.attitude(state, body).1.translation()
}

/// A mass without extent, and its weight.
#[lagrangian(
    group(d = R3),
    advected(x = d.seen_from(space)),
    l_d = m * d.norm_squared() / (2.0 * h) - 0.5 * h * m * g * (x + x + d)[2],
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Point {
    m: f64,
    g: f64,
}

/// The solution of `y'' = f(y, y')` after a time by many steps of the Runge–Kutta method of order four.
pub(crate) fn solved<const N: usize>(
    f: impl Fn(&[f64; N], &[f64; N]) -> [f64; N],
    start: ([f64; N], [f64; N]),
    time: f64,
) -> ([f64; N], [f64; N]) {
    let (mut y, mut v) = start;
    let steps = 20_000;
    let h = time / f64::from(steps);
    let moved = |y: &[f64; N], v: &[f64; N], part: f64| core::array::from_fn(|k| y[k] + part * h * v[k]);
    for _ in 0..steps {
        let (v1, a1) = (v, f(&y, &v));
        let v2: [f64; N] = moved(&v, &a1, 0.5);
        let a2 = f(&moved(&y, &v1, 0.5), &v2);
        let v3: [f64; N] = moved(&v, &a2, 0.5);
        let a3 = f(&moved(&y, &v2, 0.5), &v3);
        let v4: [f64; N] = moved(&v, &a3, 1.0);
        let a4 = f(&moved(&y, &v3, 1.0), &v4);
        let sum = |[a, b, c, d]: [f64; 4]| (a + 2.0 * (b + c) + d) * h / 6.0;
        y = core::array::from_fn(|k| y[k] + sum([v1[k], v2[k], v3[k], v4[k]]));
        v = core::array::from_fn(|k| v[k] + sum([a1[k], a2[k], a3[k], a4[k]]));
    }
    (y, v)
}

/// Checks that the second error is a quarter of the first.
pub(crate) fn assert_second_order([coarse, fine]: [f64; 2]) {
    println!("{coarse:e}, {fine:e}");
    assert!((coarse / fine - 4.0).abs() < 0.1, "not of order two: {coarse:e}, {fine:e}");
}

/// A porch swing: two rods and a seat on four pins, of whose functions three are implied by the others. It moves as a pendulum.
#[test]
fn a_porch_swing_on_four_pins() {
    let rod = falling(1.0, [0.083_333_3, 0.083_333_3, 0.001]);
    let swing = |h: f64, steps: u64| {
        let mut system = Multibody::new();
        let (left, right) = (system.body(rod), system.body(rod));
        let seat = system.body(falling(1.0, [0.001, 0.083_333_3, 0.083_333_3]));
        let half = Vector3::z() * 0.5;
        let along = Vector3::x();
        let mut pin = |points, above, below| system.join(Joint::pin(points, [Vector3::y(); 2]), above, below);
        pin([Vector3::zeros(), half], None, left);
        pin([-half, along * -0.5], Some(left), seat);
        pin([along * 0.5, -half], Some(seat), right);
        pin([along, half], None, right);
        let places = [at(0.0, 0.0, -0.5), at(1.0, 0.0, -0.5), at(0.5, 0.0, -1.0)];
        let (turning, still) = (six([0.0, 2.0, 0.0], [-1.0, 0.0, 0.0]), six([0.0; 3], [-2.0, 0.0, 0.0]));
        let velocities = [turning, turning, still];
        let redundant = system.clone().stepper(h).unwrap().start(&places, &velocities).unwrap_err();
        assert!(matches!(redundant, SetupError::RedundantJoint { joint: 3, .. }), "{redundant}");
        let (system, left_out) = system.independent(&places).unwrap();
        assert_eq!(left_out.iter().map(|one| (one.joint, one.functions)).collect::<Vec<_>>(), [(3, 3)]);
        let stepper = system.stepper(h).unwrap();
        let mut state = stepper.start(&places, &velocities).unwrap();
        stepper.run(&mut state, steps).unwrap();
        assert!(stepper.widest_gap(&state) < 1e-13);
        (position(&stepper, &state, left), position(&stepper, &state, seat))
    };
    // θ'' = −1.2 g sin θ, with the moments 2 (1/12 + 1/4) + 1 about the pins.
    let ([angle], _) = solved(|[y], _| [-2.0 * 9.81 / (2.0 * 0.333_333_3 + 1.0) * y.sin()], ([0.0], [2.0]), 1.0);
    let expected = Vector3::new(-0.5 * angle.sin(), 0.0, -0.5 * angle.cos());
    // The values of a solver of order eight for the three bodies.
    assert!((expected - Vector3::new(0.063_246, 0.0, -0.495_984)).amax() < 1e-6, "{expected}");
    let off = [(0.01, 100), (0.005, 200)].map(|(h, steps)| {
        let (rod, seat) = swing(h, steps);
        assert!((seat - (rod * 2.0 + Vector3::x() * 0.5)).amax() < 1e-13);
        (rod - expected).norm()
    });
    assert_second_order(off);
}

/// Two shafts whose axes meet at 30 degrees turn together by a cross on four pins: `tan θ_2 = tan θ_1 cos β`, with three implied
/// functions.
#[test]
fn a_cardan_joint() {
    let bend = 30.0_f64.to_radians();
    let [first, second] = [Vector3::x(), Vector3::new(bend.cos(), bend.sin(), 0.0)];
    let mut system = Multibody::new();
    let shaft = [0.02, 0.05, 0.05];
    let (input, cross, output) = (
        system.body(floating(1.0, shaft)),
        system.body(floating(0.1, [0.003, 0.003, 0.002])),
        system.body(floating(1.0, shaft)),
    );
    let zero = [Vector3::zeros(); 2];
    // All axes are at rest in those of space: the cross has its arms along z and across both the other shaft and z.
    let arm = second.cross(&Vector3::z());
    system.join(Joint::pin(zero, [first; 2]), None, input);
    system.join(Joint::pin(zero, [Vector3::z(); 2]), Some(input), cross);
    system.join(Joint::pin(zero, [arm; 2]), Some(cross), output);
    system.join(Joint::pin(zero, [second; 2]), None, output);
    let places = [at(0.0, 0.0, 0.0); 3];
    let (system, left_out) = system.independent(&places).unwrap();
    assert_eq!(left_out.iter().map(|one| one.functions).sum::<usize>(), 3);
    let stepper = system.stepper(0.002).unwrap();
    // With the input's arm along z the output turns by cos β of the input's rate.
    let rate = 2.0;
    let turning = second * (rate / bend.cos());
    let crossing = first * rate + Vector3::z() * (turning - first * rate).dot(&Vector3::z());
    let velocities = [first * rate, crossing, turning].map(|turn| six(turn.into(), [0.0; 3]));
    let mut state = stepper.start_nearest(&places, &velocities).unwrap();
    let energy = stepper.energy(&state);
    let angle = |state: &[f64], body: usize, axis: &Vector3<f64>, across: &Vector3<f64>| {
        let turned = stepper.attitude(state, body).0.as_matrix() * across;
        turned.dot(&axis.cross(across)).atan2(turned.dot(across))
    };
    let (mut off, mut spread) = (0.0_f64, [f64::INFINITY, 0.0_f64]);
    for _ in 0..2000 {
        stepper.step(&mut state).unwrap();
        let theta = angle(&state, input, &first, &Vector3::z());
        let phi = angle(&state, output, &second, &Vector3::z());
        off = off.max((phi.sin() * theta.cos() - bend.cos() * theta.sin() * phi.cos()).abs());
        let ratio = stepper.velocity(&state, output).norm() / stepper.velocity(&state, input).norm();
        spread = [spread[0].min(ratio), spread[1].max(ratio)];
    }
    println!("{off:e}, {spread:?}, gap {:e}", stepper.widest_gap(&state));
    assert!(off < 1e-12 && stepper.widest_gap(&state) < 1e-13);
    // The ratio of the rates is between cos β and its inverse.
    assert!((spread[0] - bend.cos()).abs() < 1e-3 && (spread[1] - 1.0 / bend.cos()).abs() < 1e-3);
    assert!((stepper.energy(&state) - energy).abs() < 1e-3 * energy);
}

/// A cart on a slider with a pole on a pin: the equations of cart and pole.
#[test]
fn a_cart_and_a_pole() {
    let (cart, m, half, moment) = (2.0, 0.5, 0.4, 0.03);
    let acceleration = |[_, angle]: &[f64; 2], [_, rate]: &[f64; 2]| {
        let (s, c) = angle.sin_cos();
        // (M + m) x'' + m l cos θ θ'' = m l sin θ θ'², m l cos θ x'' + (J + m l²) θ'' = m g l sin θ
        let (a, b, d) = (cart + m, m * half * c, moment + m * half * half);
        let (f, g) = (m * half * s * rate * rate, m * 9.81 * half * s);
        let determinant = a * d - b * b;
        [(d * f - b * g) / determinant, (a * g - b * f) / determinant]
    };
    let ([x, angle], _) = solved(acceleration, ([0.0, 0.3], [0.1, 0.0]), 1.5);
    let off = [(0.005, 300), (0.0025, 600)].map(|(h, steps)| {
        let mut system = Multibody::new();
        let (base, pole) = (system.body(falling(cart, [1.0; 3])), system.body(falling(m, [moment, moment, 0.001])));
        let (zero, up) = (Vector3::zeros(), Vector3::z() * half);
        system.join(Joint::slider([zero; 2], Vector3::x() * 3.0, Matrix3::identity()), None, base);
        system.join(Joint::pin([zero, -up], [Vector3::y(); 2]), Some(base), pole);
        let stepper = system.stepper(h).unwrap();
        let tilt = SO3::exp(Vector3::y() * 0.3);
        let start = [at(0.0, 0.0, 0.0), (tilt, R3::from(tilt.as_matrix() * up))];
        let moving = six([0.0; 3], [0.1, 0.0, 0.0]);
        let mut state = stepper.start(&start, &[moving; 2]).unwrap();
        stepper.run(&mut state, steps).unwrap();
        let end = position(&stepper, &state, pole) - position(&stepper, &state, base);
        assert!(stepper.widest_gap(&state) < 1e-13);
        let turned = SO3::exp(Vector3::y() * angle).as_matrix() * up;
        (position(&stepper, &state, base).x - x).hypot((end - turned).norm())
    });
    assert_second_order(off);
}

/// A free body and one on each kind of joint, with its friction, keep the momentum of both; friction takes energy.
#[test]
fn all_kinds_keep_the_momenta() {
    let axes = [Vector3::new(1.0, 2.0, -1.0), Vector3::new(0.3, 1.0, 0.5)];
    let points = [Vector3::new(0.3, -0.1, 0.2), Vector3::new(-0.4, 0.1, 0.0)];
    let turned = Rotation3::rotation_between(&axes[1], &axes[0]).unwrap();
    let across = Rotation3::rotation_between(&axes[1], &axes[0].cross(&Vector3::x())).unwrap();
    let unit = axes[0].normalize();
    let kinds = [
        (Joint::ball(points), turned, [3, 0]),
        (Joint::pin(points, axes), turned, [1, 0]),
        (Joint::universal(points, axes), across, [2, 0]),
        (Joint::cylinder(points, axes), turned, [1, 1]),
        (Joint::slider(points, axes[0], *turned.matrix()), turned, [0, 1]),
        (Joint::weld(points, *turned.matrix()), turned, [0, 0]),
        (Joint::plane(points, axes), turned, [1, 2]),
        (Joint::distance(points, 0.5), turned, [3, 2]),
    ];
    for (number, (joint, relative, [turns, shifts])) in kinds.into_iter().enumerate() {
        let mut system = Multibody::new();
        let first = system.body(floating(2.0, [0.3, 0.5, 0.4]));
        let second = system.body(floating(1.0, [0.1, 0.15, 0.12]));
        system.join(joint, Some(first), second);
        if turns > 0 {
            system.between([Some(first), Some(second)], JointDamping { c: 0.05 });
            system.between([Some(first), Some(second)], DryFriction { torque: 0.02, rate: 0.01 });
        }
        if shifts == 1 {
            system.between([Some(first), Some(second)], SliderDamping { c: 0.7, axis: unit, at_2: Vector3::zeros() });
            system.between(
                [Some(first), Some(second)],
                SliderFriction { force: 0.3, speed: 0.2, axis: unit, at_2: Vector3::zeros() },
            );
        }
        let stepper = system.stepper(0.005).unwrap();
        let apart = if number == 7 { Vector3::new(0.3, 0.4, 0.0) } else { Vector3::zeros() };
        let origin = points[0] + apart - relative * points[1];
        let places = [at(0.0, 0.0, 0.0), (SO3::try_from(*relative.matrix()).unwrap(), R3::from(origin))];
        let velocities = [six([0.3, -1.0, 0.5], [0.1, 0.2, 0.0]), six([1.5, 0.2, -0.7], [0.3, -0.4, 0.5])];
        let mut state = stepper.start_nearest(&places, &velocities).unwrap();
        let whole = |state: &[f64]| {
            (0..2).fold(Vector6::zeros(), |sum: Vector6<f64>, body| {
                let (momentum, place) = (stepper.momentum(state, body), stepper.attitude(state, body));
                let [turning, linear] = [0, 3].map(|k| momentum.fixed_rows::<3>(k).into_owned());
                sum + six((place.0.as_matrix() * turning + place.1.translation().cross(&linear)).into(), linear.into())
            })
        };
        let (before, mut energy) = (whole(&state), stepper.energy(&state));
        let start = energy;
        for _ in 0..400 {
            for _ in 0..5 {
                stepper.step(&mut state).unwrap();
            }
            let now = stepper.energy(&state);
            // Rounding where nothing rubs, and the oscillation of the discrete energy.
            assert!(now < energy + 1e-4 * start, "{number}: {energy} {now}");
            energy = now;
        }
        let off = (whole(&state) - before).amax();
        println!(
            "{number}: momentum within {off:.1e}, energy {start:.4} to {energy:.4}, gap {:.1e}",
            stepper.widest_gap(&state)
        );
        assert!(off < 2e-13 && stepper.widest_gap(&state) < 1e-13);
        assert!(number == 5 || number == 7 || energy < 0.999 * start, "{number}: nothing rubbed");
    }
}

/// A ball joint with a spring: an oscillation of `cos(t √(k/J))`, at any angle below half a turn.
#[test]
fn a_ball_joint_with_a_spring() {
    let (J, k, start) = (0.7, 1.0, 2.0);
    let axis = Unit::new_normalize(Vector3::new(1.0, -2.0, 0.5));
    let turn = |angle: f64| *Rotation3::from_axis_angle(&axis, angle).matrix();
    let rest = *Rotation3::new(Vector3::new(0.2, 0.7, -0.4)).matrix();
    let off = [(0.002, 5000), (0.001, 10_000)].map(|(h, steps)| {
        let mut system = Multibody::new();
        let body = system.body(floating(1.0, [J; 3]));
        system.join(Joint::ball([Vector3::zeros(); 2]), None, body);
        system.between([None, Some(body)], JointSpring { k, rest });
        let stepper = system.stepper(h).unwrap();
        let attitude = SO3::try_from(turn(start) * rest).unwrap();
        let mut state = stepper.start(&[(attitude, R3::identity())], &[Vector6::zeros()]).unwrap();
        stepper.run(&mut state, steps).unwrap();
        let expected = turn(start * (10.0 * (k / J).sqrt()).cos()) * rest;
        (stepper.attitude(&state, body).0.as_matrix() - expected).norm()
    });
    assert_second_order(off);
    assert!(off[1] < 1e-5);
}

/// A motor between a hub and a wheel, which are free: rates grow as `τ t / J` of each, and the angular momentum stays.
#[test]
fn a_motor_in_a_pin() {
    let mut system = Multibody::new();
    let (hub, wheel) = (system.body(floating(3.0, [0.5, 0.5, 0.8])), system.body(floating(1.0, [0.05, 0.05, 0.1])));
    system.join(Joint::pin([Vector3::zeros(); 2], [Vector3::z(); 2]), Some(hub), wheel);
    let axis = Vector3::z();
    system.between([Some(hub), Some(wheel)], JointTorque { torque: 0.02, axis_1: axis, axis_2: axis });
    let stepper = system.stepper(0.01).unwrap();
    let mut state = stepper.start(&[at(0.0, 0.0, 0.0); 2], &[Vector6::zeros(); 2]).unwrap();
    stepper.run(&mut state, 300).unwrap();
    let momentum = [hub, wheel].map(|body| stepper.momentum(&state, body)[2]);
    assert!((momentum[0] + 0.06).abs() < 1e-14 && (momentum[1] - 0.06).abs() < 1e-14, "{momentum:?}");
}

/// A mass on a slider with a spring, friction and a constant force: a damped oscillation in closed form, of order two.
#[test]
fn a_damped_mass_on_a_slider() {
    let (m, k, c, force, rest) = (1.5_f64, 12.0, 0.9, 3.0, 0.2);
    let axis = Vector3::new(0.0, 0.6, 0.8);
    // y'' = (−k (y − rest) − c y' + f)/m from rest at y = 1.
    let (centre, decay) = (rest + force / k, 0.5 * c / m);
    let rate = (k / m - decay * decay).sqrt();
    let at_end = 2.5_f64;
    let phase = rate * at_end;
    let expected = centre + (1.0 - centre) * (-decay * at_end).exp() * (phase.cos() + decay / rate * phase.sin());
    let off = [(0.01, 250), (0.005, 500)].map(|(h, steps)| {
        let mut system = Multibody::new();
        let body = system.body(floating(m, [0.2; 3]));
        system.join(Joint::slider([Vector3::zeros(); 2], axis, Matrix3::identity()), None, body);
        system.between([None, Some(body)], SliderSpring { k, rest, force, axis, at_2: Vector3::zeros() });
        system.between([None, Some(body)], SliderDamping { c, axis, at_2: Vector3::zeros() });
        let stepper = system.stepper(h).unwrap();
        let start = (SO3::identity(), R3::from(axis));
        let mut state = stepper.start(&[start], &[Vector6::zeros()]).unwrap();
        stepper.run(&mut state, steps).unwrap();
        (position(&stepper, &state, body).dot(&axis) - expected).abs()
    });
    assert_second_order(off);
}

/// A parallelogram that starts flat, where one function more is implied than elsewhere: the step that opens it is an error.
#[test]
fn a_function_that_is_implied_at_the_start_alone() {
    let mut system = Multibody::new();
    let rod = floating(1.0, [0.083, 0.083, 0.001]);
    let (left, right) = (system.body(rod), system.body(rod));
    let seat = system.body(rod);
    let half = Vector3::z() * 0.5;
    let mut pin = |points, above, below| system.join(Joint::pin(points, [Vector3::y(); 2]), above, below);
    pin([Vector3::zeros(), half], None, left);
    pin([-half, half], Some(left), seat);
    pin([-half, -half], Some(seat), right);
    pin([-Vector3::z(), half], None, right);
    let places = [at(0.0, 0.0, -0.5), at(0.0, 0.0, -1.5), at(0.0, 0.0, -1.5)];
    let (system, left_out) = system.independent(&places).unwrap();
    assert_eq!(left_out[0].functions, 4);
    let stepper = system.stepper(0.01).unwrap();
    let turning = |rate: f64, x: f64| six([0.0, rate, 0.0], [x, 0.0, 0.0]);
    // The left rod turns alone, and the seat follows.
    let velocities = [turning(1.0, -0.5), turning(0.3, -0.15), turning(0.0, -0.65)];
    let mut state = stepper.start_nearest(&places, &velocities).unwrap();
    let stopped = (0..1000).find_map(|_| stepper.step(&mut state).err());
    assert!(matches!(stopped, Some(StepError::SingularJoint { joint: 3, .. })), "{stopped:?}");
}

/// A parallelogram of three heavy rods falls through its change point, where it is flat and could go on with its cranks turning
/// opposite ways. It goes on as a parallelogram, which moves as a pendulum.
#[test]
fn a_parallelogram_passes_its_change_point() {
    let down = Vector3::new(0.010_193_6, -1.0, 0.0).normalize();
    let moments = [0.083_333_3, 4.208_333_3, 4.208_333_3];
    let rod = FallingBody { m: 50.0, J_d: inertia(moments), g: 9.8105, up: -down };
    let [half, zero] = [Vector3::x() * 0.5, Vector3::zeros()];
    let passed = |h: f64, steps: u32| {
        let mut system = Multibody::new();
        let [crank, coupler, follower] = [0; 3].map(|_| system.body(rod));
        let mut pin = |points, above, below| system.join(Joint::pin(points, [Vector3::z(); 2]), above, below);
        pin([zero, -half], None, crank);
        pin([half, -half], Some(crank), coupler);
        pin([half, half], Some(coupler), follower);
        pin([Vector3::x(), -half], None, follower);
        let turned = Rotation3::from_axis_angle(&Vector3::z_axis(), core::f64::consts::FRAC_PI_2);
        let standing = |x: f64| (SO3::from(turned), R3::from(Vector3::new(x, 0.5, 0.0)));
        let places = [standing(0.0), at(0.5, 1.0, 0.0), standing(1.0)];
        let (system, _) = system.independent(&places).unwrap();
        let stepper = system.stepper(h).unwrap();
        let mut state = stepper.start(&places, &[Vector6::zeros(); 3]).unwrap();
        let (mut before, mut flat) = (std::f64::consts::FRAC_PI_2, None);
        for step in 0..steps {
            stepper.step(&mut state).unwrap_or_else(|error| panic!("step {step} of {h} s: {error}"));
            assert!(stepper.widest_gap(&state) < 1e-14);
            let [x, y] = [0, 1].map(|k| position(&stepper, &state, crank)[k]);
            let (angle, rate) = (y.atan2(x), stepper.velocity(&state, crank)[2]);
            if before > 0.0 && angle <= 0.0 {
                flat = Some((h * f64::from(step + 1) - angle / rate, rate));
            }
            before = angle;
        }
        let turned = stepper.attitude(&state, coupler).0.as_matrix() - Matrix3::identity();
        assert!(turned.amax() < 1e-11, "{turned}");
        (before, flat.unwrap())
    };
    // The coupler moves without turning, at the ends of both cranks.
    let moment = 2.0 * (moments[2] + 12.5) + 50.0;
    let pull = |[y]: &[f64; 1], _: &[f64; 1]| [100.0 * 9.8105 * (down.y * y.cos() - down.x * y.sin()) / moment];
    let ([angle], _) = solved(pull, ([std::f64::consts::FRAC_PI_2], [0.0]), 2.0);
    assert!((angle + 1.944_82).abs() < 1e-5, "{angle}");
    let (_, (time, rate)) = passed(0.0005, 4000);
    assert!((time - 1.688_72).abs() < 1e-5 && (rate + 4.874).abs() < 5e-3, "flat at {time} s, by {rate} rad/s");
    assert_second_order([(0.01, 200), (0.005, 400)].map(|(h, steps)| (passed(h, steps).0 - angle).abs()));
}

/// A point mass on a pin and one on a pin at a body swing as in equations of angles; on a ball joint, a point mass may turn without
/// moving, which is refused.
#[test]
fn point_masses_on_pins() {
    let point = |m: f64| Point { m, g: 9.81 };
    let (zero, half) = (Vector3::zeros(), Vector3::z() * 0.5);
    let swing = |h: f64, steps: u64| {
        let mut system = Multibody::new();
        let bob = system.body(point(1.0));
        system.join(Joint::pin([zero, half], [Vector3::y(); 2]), None, bob);
        let stepper = system.stepper(h).unwrap();
        let start = six([0.0, 1.0, 0.0], [-0.5, 0.0, 0.0]);
        let mut state = stepper.start(&[at(0.0, 0.0, -0.5)], &[start]).unwrap();
        assert!((stepper.velocity(&state, bob) - start).amax() < 1e-15);
        assert!((stepper.energy(&state) - (0.125 - 0.5 * 9.81)).abs() < 1e-14);
        stepper.run(&mut state, steps).unwrap();
        assert!(stepper.widest_gap(&state) < 1e-14);
        position(&stepper, &state, bob)
    };
    let ([angle], _) = solved(|[y], _| [-2.0 * 9.81 * y.sin()], ([0.0], [1.0]), 1.0);
    let expected = Vector3::new(-0.5 * angle.sin(), 0.0, -0.5 * angle.cos());
    // The values of a solver of order eight.
    assert!((expected - Vector3::new(0.107_334, 0.0, -0.488_344)).amax() < 1e-6, "{expected}");
    assert_second_order([(0.01, 100), (0.005, 200)].map(|(h, steps)| (swing(h, steps) - expected).norm()));
    // The double pendulum of two point masses, by equations of its two angles.
    let double = |h: f64, steps: u64| {
        let mut system = Multibody::new();
        let (upper, lower) = (system.body(point(1.0)), system.body(point(0.5)));
        system.join(Joint::pin([zero, half], [Vector3::y(); 2]), None, upper);
        system.join(Joint::pin([zero, half], [Vector3::y(); 2]), Some(upper), lower);
        let stepper = system.stepper(h).unwrap();
        let velocities = [six([0.0, 1.0, 0.0], [-0.5, 0.0, 0.0]), six([0.0, 3.0, 0.0], [-2.0, 0.0, 0.0])];
        let mut state = stepper.start(&[at(0.0, 0.0, -0.5), at(0.0, 0.0, -1.0)], &velocities).unwrap();
        stepper.run(&mut state, steps).unwrap();
        position(&stepper, &state, lower)
    };
    let angles = |[a, b]: &[f64; 2], [u, v]: &[f64; 2]| {
        let (sine, cosine, g) = ((a - b).sin(), (a - b).cos(), 9.81 / 0.5);
        // (1 + ½) a'' + ½ b'' cos(a−b) = −½ v² sin(a−b) − 1.5 g sin a,  b'' + a'' cos(a−b) = u² sin(a−b) − g sin b
        let (first, second) = (-0.5 * v * v * sine - 1.5 * g * a.sin(), u * u * sine - g * b.sin());
        let a2 = (first - 0.5 * cosine * second) / (1.5 - 0.5 * cosine * cosine);
        [a2, second - a2 * cosine]
    };
    let ([a, b], _) = solved(angles, ([0.0; 2], [1.0, 3.0]), 1.0);
    let expected = Vector3::new(-0.5 * (a.sin() + b.sin()), 0.0, -0.5 * (a.cos() + b.cos()));
    assert_second_order([(0.005, 200), (0.0025, 400)].map(|(h, steps)| (double(h, steps) - expected).norm()));
    let mut system = Multibody::new();
    let bob = system.body(point(1.0));
    system.join(Joint::ball([zero, half]), None, bob);
    let refused = system.stepper(0.01).and_then(|stepper| stepper.start(&[at(0.0, 0.0, -0.5)], &[Vector6::zeros()]));
    assert!(matches!(refused, Err(SetupError::SingularKinetic { .. })), "{refused:?}");
}
