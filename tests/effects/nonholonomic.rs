//! Constraints on velocities: closed solutions, the limit of drag, and the derived terms beside differences.

use declarations::{Blade, FallingDisk, Plate, Rolling, Suslov};
use liestep::groups::{Advected, CayleyRetraction, LieGroup, Retraction, SE2, SE3};
use liestep::laws::samples;
use liestep::mechanics::{Effect, Nonholonomic, Regular, Sum};
use liestep::motion::Propagator as _;
use liestep::{NonstandardInertia, SO3, SetupError, StateOf, Stepper, force, lagrangian};
use nalgebra::{Matrix3, Rotation3, Vector3, Vector4};

/// A body by the Cayley map, with a full tensor.
#[lagrangian(group = SO3, velocity = Omega, l = 0.5 * Omega.dot(&(J * Omega)), discretise = trapezoid(Cayley))]
#[derive(Clone, Copy)]
struct Body {
    J: Matrix3<f64>,
}

/// Drag against the same turn that Suslov's constraint forbids.
#[force(group = SO3, work = -0.5 * c * a.dot(&vee(F)) * a.dot(&(eta + eta_next)))]
struct Brake {
    c: f64,
    a: Vector3<f64>,
}

/// Orders between runs of which each has half the step of the one before.
fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect()
}

fn assert_order_two(name: &str, error: impl Fn(u32) -> f64, counts: [u32; 3]) {
    let errors = counts.map(error);
    let orders = orders(&errors);
    println!("{name}: {errors:?} {orders:?}");
    assert!((orders[1] - 2.0).abs() < 0.02, "{name}: {errors:?} {orders:?}");
}

/// The largest values of the constraints at the increments of so many steps and at the velocities after them, and the largest
/// change of the energy.
fn kept<S: Regular<Scalar = f64>>(stepper: &Stepper<S>, mut state: StateOf<S>, steps: u32, h: f64) -> [f64; 3] {
    let scene = stepper.scene();
    let (energy, mut worst) = (stepper.energy(&state), [0.0_f64; 3]);
    for _ in 0..steps {
        let before = state;
        stepper.step(&mut state).unwrap();
        let f = before.attitude().inverse().compose(&state.attitude()).matrix();
        let mut values = Vec::new();
        scene.constrained(Some((&f, h)), &before.advected(), &mut |value, _| values.push(value));
        let velocity = stepper.velocity(&state);
        let mut rates = Vec::new();
        scene.constrained(None, &state.advected(), &mut |_, own| {
            rates.push(liestep::numbers::Coordinates::dot(&own, &velocity));
        });
        assert!(!values.is_empty() && values.len() == rates.len());
        let largest = |all: &[f64]| all.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        worst[0] = worst[0].max(largest(&values));
        worst[1] = worst[1].max(largest(&rates));
        worst[2] = worst[2].max((stepper.energy(&state) - energy).abs());
    }
    worst
}

/// Suslov's body in a frame that nothing is aligned with, and its angular velocity at a time: `√J_1 Ω_1 = √2E tanh u`,
/// `√J_2 Ω_2 = √2E sech u` in the frame in which the constraint forbids the third axis and `J_12 = J_13 = 0`.
struct SuslovMotion {
    J: Matrix3<f64>,
    frame: Matrix3<f64>,
}

impl SuslovMotion {
    fn new() -> Self {
        let J = Matrix3::new(2.0, 0.0, 0.0, 0.0, 1.5, 0.4, 0.0, 0.4, 1.0);
        Self { J, frame: *Rotation3::from_scaled_axis(Vector3::new(0.4, -0.9, 0.3)).matrix() }
    }

    fn body(&self) -> Body {
        let J = self.frame * self.J * self.frame.transpose();
        Body { J: (J + J.transpose()) * 0.5 }
    }

    fn constraint(&self) -> Suslov {
        Suslov { a: self.frame * Vector3::new(0.0, 0.0, 1.7) }
    }

    fn velocity(&self, t: f64) -> Vector3<f64> {
        let (j_1, j_2, j_23) = (self.J[(0, 0)], self.J[(1, 1)], self.J[(1, 2)]);
        let (x, y) = (j_1.sqrt() * -1.2, j_2.sqrt() * 0.7);
        let size = x.hypot(y);
        let u = (x / size).atanh() - j_23 * size / (j_2 * j_1.sqrt()) * t;
        self.frame * Vector3::new(size * u.tanh() / j_1.sqrt(), size / u.cosh() / j_2.sqrt(), 0.0)
    }
}

#[test]
fn suslovs_problem_has_its_closed_solution() {
    let motion = SuslovMotion::new();
    let made = |steps: u32| {
        let stepper = Stepper::new(motion.body() + motion.constraint(), 3.0 / f64::from(steps)).unwrap();
        let mut state = stepper.start(SO3::identity(), motion.velocity(0.0)).unwrap();
        stepper.run(&mut state, u64::from(steps)).unwrap();
        (stepper.velocity(&state) - motion.velocity(3.0)).norm()
    };
    assert_order_two("Suslov", made, [30, 60, 120]);
    let stepper = Stepper::new(motion.body() + motion.constraint(), 0.05).unwrap();
    let state = stepper.start(SO3::identity(), motion.velocity(0.0)).unwrap();
    let [increments, velocities, energy] = kept(&stepper, state, 2_000, 0.05);
    println!("Suslov: {increments:e} {velocities:e} {energy:e}");
    assert!(increments < 1e-14 && velocities < 1e-14 && energy < 1e-3, "{increments:e} {velocities:e} {energy:e}");
}

/// More drag along the axis comes nearer to the constraint, in inverse proportion: the reaction does no work.
#[test]
fn suslovs_problem_is_the_limit_of_drag() {
    let motion = SuslovMotion::new();
    let (h, steps) = (0.01, 300);
    let velocity = |c: f64| {
        let brake = Brake { c, a: motion.frame * Vector3::z() };
        let stepper = Stepper::new(motion.body() + brake, h).unwrap();
        let mut state = stepper.start(SO3::identity(), motion.velocity(0.0)).unwrap();
        stepper.run(&mut state, steps).unwrap();
        stepper.velocity(&state)
    };
    let off = [1e2, 1e3, 1e4].map(|c| (velocity(c) - motion.velocity(3.0)).norm());
    println!("drag: {off:?}");
    assert!((off[0] / off[1] / 10.0 - 1.0).abs() < 0.1 && off[2] < off[1] / 5.0, "{off:?}");
}

/// `√m v_1 = √2E tanh u`, `√(J + ma²) ω = √2E sech u`.
#[test]
fn chaplygins_sleigh_has_its_closed_solution() {
    let plate = Plate { m: 1.3, J: 0.4, a: 0.6 };
    let whole: f64 = plate.J + plate.m * plate.a * plate.a;
    let (x, y) = (plate.m.sqrt() * -0.8, whole.sqrt() * 1.1);
    let size = x.hypot(y);
    let exact = |t: f64| {
        let u = (x / size).atanh() + plate.m.sqrt() * plate.a * size / whole * t;
        Vector3::new(size / u.cosh() / whole.sqrt(), size * u.tanh() / plate.m.sqrt(), 0.0)
    };
    let scene = || plate + Blade { sideways: 1.0 };
    let error = |steps: u32| {
        let stepper = Stepper::new(scene(), 2.0 / f64::from(steps)).unwrap();
        let mut state = stepper.start(SE2::identity(), exact(0.0)).unwrap();
        stepper.run(&mut state, u64::from(steps)).unwrap();
        (stepper.velocity(&state) - exact(2.0)).norm()
    };
    assert_order_two("sleigh", error, [40, 80, 160]);
    let stepper = Stepper::new(scene(), 0.05).unwrap();
    let state = stepper.start(SE2::identity(), exact(0.0)).unwrap();
    let [increments, velocities, energy] = kept(&stepper, state, 2_000, 0.05);
    println!("sleigh: {increments:e} {velocities:e} {energy:e}");
    assert!(increments < 1e-14 && velocities < 1e-14 && energy < 1e-3, "{increments:e} {velocities:e} {energy:e}");
}

/// A scene with the three components of rolling.
type Disk = Sum<Sum<Sum<FallingDisk, Rolling>, Rolling>, Rolling>;

/// A disk that rolls in a circle: its inclination from the vertical, its precession, and what follows from them.
struct Circle {
    theta: f64,
    precession: f64,
}

impl Circle {
    const M: f64 = 1.2;
    const R: f64 = 0.5;
    const G: f64 = 9.81;

    fn scene() -> Disk {
        let (m, radius) = (Self::M, Self::R);
        let height = Vector4::new(0.0, 0.0, 1.0, 0.0);
        let across = m * radius * radius / 4.0;
        let body = FallingDisk {
            J: Matrix3::from_diagonal(&Vector3::new(across, across, 2.0 * across)),
            m,
            g: Self::G,
            height,
        };
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()].map(|e| Rolling { e, radius, height });
        body + x + y + z
    }

    /// The spin `ω_3` about the axis, from the balance of moments about the horizontal diameter:
    /// `φ̇ (C + mR²) ω_3 sin θ − A φ̇² sin θ cos θ + mgR cos θ = 0`.
    fn spin(&self) -> f64 {
        let (sin, cos) = self.theta.sin_cos();
        let (across, along) = (Self::M * Self::R * Self::R / 4.0, Self::M * Self::R * Self::R / 2.0);
        (across * self.precession.powi(2) * sin * cos - Self::M * Self::G * Self::R * cos)
            / (self.precession * (along + Self::M * Self::R * Self::R) * sin)
    }

    /// Attitude and place at a time: the centre goes round at the distance `R |ω_3|/|φ̇|` from the axis of the precession.
    fn at(&self, t: f64) -> SE3 {
        let (phi, own) = (self.precession * t, (self.spin() - self.precession * self.theta.cos()) * t);
        let turned = Rotation3::from_axis_angle(&Vector3::z_axis(), phi)
            * Rotation3::from_axis_angle(&Vector3::x_axis(), self.theta);
        // The velocity of the centre is −R ω_3 along the horizontal diameter, which turns with φ.
        let distance = -Self::R * self.spin() / self.precession;
        let place = Vector3::new(distance * phi.sin(), -distance * phi.cos(), Self::R * self.theta.sin());
        let attitude = turned * Rotation3::from_axis_angle(&Vector3::z_axis(), own);
        SE3::from_rotation_and_translation(attitude.into(), place)
    }

    /// Angular velocity and velocity at the start, both in the body's axes.
    fn velocity(&self) -> nalgebra::Vector6<f64> {
        let spin = self.spin();
        nalgebra::Vector6::new(0.0, self.precession * self.theta.sin(), spin, -Self::R * spin, 0.0, 0.0)
    }
}

#[test]
fn a_disk_rolls_in_circles() {
    let circle = Circle { theta: 1.1, precession: -1.7 };
    let end = 1.5;
    let error = |steps: u32| {
        let stepper = Stepper::new(Circle::scene(), end / f64::from(steps)).unwrap();
        let mut state = stepper.start(circle.at(0.0), circle.velocity()).unwrap();
        stepper.run(&mut state, u64::from(steps)).unwrap();
        (state.attitude().matrix() - circle.at(end).matrix()).norm()
    };
    assert_order_two("disk", error, [50, 100, 200]);
    let h = 0.01;
    let stepper = Stepper::new(Circle::scene(), h).unwrap();
    let state = stepper.start(circle.at(0.0), circle.velocity()).unwrap();
    let [increments, velocities, energy] = kept(&stepper, state, 2_000, h);
    println!("disk: {increments:e} {velocities:e} {energy:e} of {}", stepper.energy(&state));
    assert!(increments < 1e-14 && velocities < 1e-14 && energy < 1e-3, "{increments:e} {velocities:e} {energy:e}");
}

/// The declared constraint by the trapezoidal rule with the library's Cayley map, of which the derivation knows nothing.
fn discretised<C: Nonholonomic<Scalar = f64>>(c: &C, f: &C::Group, w: &C::Advected, h: f64) -> f64
where
    CayleyRetraction: Retraction<C::Group>,
{
    let velocity = CayleyRetraction::local_coordinates(f).unwrap() * (1.0 / h);
    0.5 * h * (c.zero(&velocity, w) + c.zero(&velocity, &w.seen_from(f)))
}

/// The derived terms of a constraint beside differences of the declared one.
fn assert_derived<C: Nonholonomic<Scalar = f64>>(c: &C, place: &C::Group, xi: &<C::Group as LieGroup>::Vector)
where
    CayleyRetraction: Retraction<C::Group>,
{
    use liestep::numbers::Coordinates;
    let (h, w) = (0.3, c.advected().seen_from(place));
    let f = CayleyRetraction::retract(xi);
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-9 * (1.0 + a.abs()), "{a} {b}");
    near(c.at_increment(&f.matrix(), &w, h), discretised(c, &f, &w, h));
    let (slope, reaction) = (c.slope(&f.matrix(), &w, h), c.reaction(&w));
    for k in 0..<C::Group as LieGroup>::DIMENSION {
        let axis = <C::Group as LieGroup>::Vector::axis(k);
        let at = |t: f64| discretised(c, &CayleyRetraction::retract(&(axis * t)).compose(&f), &w, h);
        let eps = 1e-3;
        let difference = (8.0 * (at(eps) - at(-eps)) - (at(2.0 * eps) - at(-2.0 * eps))) / (12.0 * eps);
        near(slope.dot(&axis), difference);
        near(reaction.dot(&axis), c.zero(&axis, &w));
    }
}

#[test]
fn derived_terms_are_those_of_the_declared_constraint() {
    let mut r = samples::Random::new(11);
    for _ in 0..5 {
        let xi: Vector3<f64> = r.sample();
        assert_derived(&Suslov { a: r.sample() }, &SO3::identity(), &xi);
        let blade = Blade { sideways: r.signed() };
        assert_derived(&blade, &SE2::identity(), &xi);
        let rolling =
            Rolling { e: r.sample(), radius: 1.0 + r.signed() / 2.0, height: Vector4::new(0.0, 0.0, 1.0, 0.0) };
        let (turn, shift): (Vector3<f64>, Vector3<f64>) = (r.sample(), r.sample());
        let place = CayleyRetraction::retract(&nalgebra::Vector6::new(turn.x, turn.y, turn.z, 1.0, -2.0, 0.5));
        assert_derived(&rolling, &place, &nalgebra::Vector6::new(xi.x, xi.y, xi.z, shift.x, shift.y, shift.z));
    }
}

/// A text of the same declarations has the compiled steps.
#[test]
fn texts_have_the_steps_of_compiled_declarations() {
    let circle = Circle { theta: 1.1, precession: -1.7 };
    let h = 0.02;
    let text = |text| liestep_late::Declaration::parse(text).unwrap();
    let [body, rolling] = [FallingDisk::DECLARATION, Rolling::DECLARATION].map(text);
    let sum = liestep_late::Declaration::sum(&[body, rolling, rolling, rolling]).unwrap();
    let mut numbers = Vec::new();
    Circle::scene().describe(&mut Numbers(&mut numbers));
    let late: liestep_late::Whole =
        liestep_late::Whole::of(sum, &sum.described(&numbers).unwrap(), h, "step".parse().unwrap()).unwrap();
    let stepper = Stepper::new(Circle::scene(), h).unwrap();
    let mut typed = stepper.start(circle.at(0.0), circle.velocity()).unwrap();
    let mut text = late.start(circle.at(0.0).matrix().transpose().as_slice(), circle.velocity().as_slice()).unwrap();
    stepper.run(&mut typed, 200).unwrap();
    late.run(&mut text, 200).unwrap();
    let attitude = typed.attitude().matrix().transpose();
    let off = attitude.iter().zip(&text[..]).map(|(a, b)| (a - b).abs()).fold(0.0_f64, f64::max);
    let momentum = typed.momentum();
    let off = momentum.iter().zip(&text[16..]).map(|(a, b)| (a - b).abs()).fold(off, f64::max);
    println!("texts: {off:e}");
    assert!(off < 1e-11, "{off:e}");
}

/// Collects the numbers of a scene, matrices row by row.
struct Numbers<'a>(&'a mut Vec<f64>);

impl liestep::mechanics::SceneVisitor<f64> for Numbers<'_> {
    fn term(&mut self, _: &'static str) {}

    fn parameter(&mut self, _: &'static str, value: f64) {
        self.0.push(value);
    }
}

#[test]
fn impossible_constraints_are_refused() {
    let body = || Body { J: Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.5)) };
    let along = |a: Vector3<f64>| Suslov { a };
    let turned = |velocity: Vector3<f64>| {
        move |stepper: Stepper<Sum<Sum<Body, Suslov>, Suslov>>| stepper.start(SO3::identity(), velocity)
    };
    let twice = Stepper::new(body() + along(Vector3::z()) + along(Vector3::z() * -3.0), 0.1).unwrap();
    let found = turned(Vector3::x())(twice).map(|_| ());
    assert_eq!(found, Err(SetupError::RedundantConstraint { constraint: 1 }));
    let both = || Stepper::new(body() + along(Vector3::z()) + along(Vector3::x()), 0.1).unwrap();
    let found = turned(Vector3::new(0.6, 0.8, 0.0))(both()).map(|_| ());
    assert!(
        matches!(found, Err(SetupError::ViolatedConstraint { constraint: 1, by }) if (by - 0.6).abs() < 1e-12),
        "{found:?}"
    );
    assert!(turned(Vector3::y())(both()).is_ok());
    let all = Stepper::new(body() + along(Vector3::z()) + along(Vector3::x()) + along(Vector3::y()), 0.1).map(|_| ());
    assert_eq!(all, Err(SetupError::NoMotion { constraints: 3, dimension: 3 }));
    // A body by (3.13), whose system is cleared of denominators, has the constraint, too.
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5)).unwrap();
    let stepper = Stepper::new(liestep::effects::RigidBody { J_d } + along(Vector3::new(1.0, 1.0, 0.5)), 0.1).unwrap();
    let state = stepper.start(SO3::identity(), Vector3::new(1.0, -1.5, 1.0)).unwrap();
    let [increments, velocities, _] = kept(&stepper, state, 100, 0.1);
    assert!(increments < 1e-14 && velocities < 1e-14, "{increments:e} {velocities:e}");
}
