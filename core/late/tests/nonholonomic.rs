//! Constraints on velocities that are texts: Suslov's problem beside its closed solution.

use declarations::{FallingDisk, Rolling};
use liestep::mechanics::Effect as _;
use liestep::motion::Propagator as _;
use liestep::with::Method;
use liestep_late::{Declaration, LateError, Whole, WholeError};

const BODY: &str = "#[lagrangian(group = SO3, velocity = Omega, l = 0.5 * Omega.dot(&(J * Omega)), \
                    discretise = trapezoid(Cayley))] struct Body { J: Inertia }";
const SUSLOV: &str =
    "#[nonholonomic(group = SO3, velocity = Omega, zero = a.dot(&Omega))] struct Suslov { a: Vector3<f64> }";

const J: [f64; 9] = [2.0, 0.0, 0.0, 0.0, 1.5, 0.4, 0.0, 0.4, 1.0];
const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

fn stepper(axes: &[[f64; 3]], h: f64, method: &str) -> Result<Whole, WholeError> {
    let mut terms = vec![Declaration::parse(BODY).unwrap()];
    terms.extend(axes.iter().map(|_| Declaration::parse(SUSLOV).unwrap()));
    let sum = Declaration::sum(&terms).unwrap();
    let numbers = [&J[..], axes.as_flattened()].concat();
    Whole::of(sum, &numbers, h, method.parse::<Method>().unwrap())
}

/// The velocity at a time that was `(−1.2, 0.7, 0)` at zero: `√J_1 Ω_1 = √2E tanh u`, `√J_2 Ω_2 = √2E sech u`.
fn exact(t: f64) -> [f64; 3] {
    let (j_1, j_2, j_23) = (J[0], J[4], J[5]);
    let (x, y) = (j_1.sqrt() * -1.2, j_2.sqrt() * 0.7);
    let size = x.hypot(y);
    let u = (x / size).atanh() - j_23 * size / (j_2 * j_1.sqrt()) * t;
    [size * u.tanh() / j_1.sqrt(), size / u.cosh() / j_2.sqrt(), 0.0]
}

fn velocity(stepper: &Whole, steps: u64) -> [f64; 3] {
    let mut state = stepper.start(&IDENTITY, &[-1.2, 0.7, 0.0]).unwrap();
    stepper.run(&mut state, steps).unwrap();
    let mut velocity = [0.0; 3];
    stepper.velocity(&state, &mut velocity);
    velocity
}

fn error(method: &str, steps: u64) -> f64 {
    let stepper = stepper(&[[0.0, 0.0, 2.0]], 3.0 / f64::from(u32::try_from(steps).unwrap()), method).unwrap();
    let found = velocity(&stepper, steps);
    found.iter().zip(exact(3.0)).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn suslovs_problem_is_of_order_two_and_its_composition_of_order_four() {
    for (method, order) in [("step", 2.0), ("composition Suzuki 4", 4.0)] {
        let errors = [20, 40, 80].map(|steps| error(method, steps));
        let orders = [0, 1].map(|k| (errors[k] / errors[k + 1]).log2());
        println!("{method}: {errors:?} {orders:?}");
        assert!((orders[1] - order).abs() < 0.05, "{method}: {errors:?} {orders:?}");
    }
}

#[test]
fn each_velocity_and_each_increment_satisfies_the_constraint() {
    let axis = [0.0, 0.6, 0.8];
    let stepper = stepper(&[axis], 0.05, "step").unwrap();
    let mut state = stepper.start(&IDENTITY, &[-1.2, 0.8, -0.6]).unwrap();
    let energy = stepper.energy(&state);
    let (mut worst, mut band) = (0.0_f64, 0.0_f64);
    for _ in 0..1000 {
        let before = state.clone();
        stepper.step(&mut state).unwrap();
        let mut velocity = [0.0; 3];
        stepper.velocity(&state, &mut velocity);
        // The Cayley vector of `F = RᵀR⁺` is along the skew part of F.
        let f = |i: usize, j: usize| (0..3).map(|k| before[3 * k + i] * state[3 * k + j]).sum::<f64>();
        let skew = [f(2, 1) - f(1, 2), f(0, 2) - f(2, 0), f(1, 0) - f(0, 1)];
        for vector in [velocity, skew] {
            worst = worst.max(axis.iter().zip(vector).map(|(a, b)| a * b).sum::<f64>().abs());
        }
        band = band.max((stepper.energy(&state) - energy).abs());
    }
    println!("constraint {worst:e}, energy {band:e}");
    assert!(worst < 1e-14, "{worst:e}");
    assert!(band < 2e-3 * energy, "{band:e}");
}

#[test]
fn impossible_constraints_are_refused() {
    use liestep::SetupError::{RedundantConstraint, ViolatedConstraint};
    let axes = [[0.0, 0.0, 1.0], [0.0, 0.0, -3.0]];
    let twice = stepper(&axes, 0.1, "step").unwrap();
    assert_eq!(twice.start(&IDENTITY, &[1.0, 2.0, 0.0]), Err(RedundantConstraint { constraint: 1 }));
    let once = stepper(&axes[..1], 0.1, "step").unwrap();
    let found = once.start(&IDENTITY, &[3.0, 0.0, 4.0]);
    assert!(matches!(found, Err(ViolatedConstraint { constraint: 0, by }) if (by - 0.8).abs() < 1e-12), "{found:?}");
    let all = stepper(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], 0.1, "step").unwrap_err();
    let message = "3 constraints on velocities leave no motion on a group of dimension 3: leave some out";
    assert_eq!(all.to_string(), message);
    let alone = Whole::<liestep_late::Interpreter>::of(
        Declaration::parse(SUSLOV).unwrap(),
        &[0.0, 0.0, 1.0],
        0.1,
        Method::default(),
    );
    assert!(matches!(alone, Err(WholeError::Declaration(LateError::Step(_)))), "{alone:?}");
}

/// A scene of a million steps: its name, stepper, attitude and velocity.
type Scene = (&'static str, Whole, Vec<f64>, Vec<f64>);

fn sleigh() -> Scene {
    let sum = Declaration::sum(&[
        Declaration::parse(
            "#[lagrangian(group = SE2, velocity = xi, discretise = trapezoid(Cayley),
                l = 0.5 * m * ((xi[1]).powi(2) + (xi[2] + a * xi[0]).powi(2)) + 0.5 * I_0 * (xi[0]).powi(2))]
            struct Plate { m: f64, I_0: f64, a: f64 }",
        )
        .unwrap(),
        Declaration::parse("#[nonholonomic(group = SE2, velocity = xi, zero = s * xi[2])] struct Blade { s: f64 }")
            .unwrap(),
    ])
    .unwrap();
    let sleigh = Whole::of(sum, &[1.3, 0.4, 0.6, 1.0], 0.05, Method::default()).unwrap();
    ("sleigh", sleigh, IDENTITY.to_vec(), vec![1.1, -0.8, 0.0])
}

/// A disk that doesn't roll in a circle: its inclination goes up and down.
fn disk() -> Scene {
    let [m, g, radius, theta] = [1.2, 9.81, 0.5, 1.1_f64];
    let rolling = Declaration::parse(Rolling::DECLARATION).unwrap();
    let body = Declaration::parse(FallingDisk::DECLARATION).unwrap();
    let across = m * radius * radius / 4.0;
    let mut numbers = vec![across, 0.0, 0.0, 0.0, across, 0.0, 0.0, 0.0, 2.0 * across, m, g, 0.0, 0.0, 1.0, 0.0];
    for e in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        numbers.extend(e);
        numbers.extend([radius, 0.0, 0.0, 1.0, 0.0]);
    }
    let sum = Declaration::sum(&[body, rolling, rolling, rolling]).unwrap();
    let (sin, cos) = theta.sin_cos();
    #[rustfmt::skip]
    let attitude = vec![
        1.0, 0.0, 0.0, 0.0,
        0.0, cos, -sin, 0.0,
        0.0, sin, cos, radius * sin,
        0.0, 0.0, 0.0, 1.0,
    ];
    let (spin, turn) = (6.0, -1.5);
    (
        "disk",
        Whole::of(sum, &numbers, 0.01, Method::default()).unwrap(),
        attitude,
        vec![0.0, turn, spin, -radius * spin, 0.0, 0.0],
    )
}

/// The speed of a disk's point of contact.
fn slip(state: &[f64], velocity: &[f64]) -> f64 {
    // The vertical in the body's axes is the third row of the attitude; the contact is below the centre, in the disk.
    let (x, y) = (state[8], state[9]);
    let r = [x, y].map(|part| -0.5 * part / x.hypot(y));
    let [a, b, c] = [velocity[0], velocity[1], velocity[2]];
    let slip = [velocity[3] - c * r[1], velocity[4] + c * r[0], velocity[5] + a * r[1] - b * r[0]];
    slip.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// The energy over a million steps stays in the band of the first thousand, and the velocities satisfy the constraints.
#[test]
#[ignore = "a million steps: `cargo test --release -p liestep-late --test nonholonomic -- --ignored --nocapture`"]
fn the_energy_of_a_million_steps_is_bounded() {
    let suslov = stepper(&[[0.0, 0.6, 0.8]], 0.05, "step").unwrap();
    let scenes = [sleigh(), ("Suslov", suslov, IDENTITY.to_vec(), vec![-1.2, 0.8, -0.6]), disk()];
    for (name, stepper, attitude, velocity) in scenes {
        let mut state = stepper.start(&attitude, &velocity).unwrap();
        let energy = stepper.energy(&state);
        let (mut bands, mut worst, mut now) = ([0.0_f64; 2], 0.0_f64, velocity);
        for row in 0..2_000 {
            let steps = if row < 1_000 { 1 } else { 1_000 };
            stepper.run(&mut state, steps).unwrap();
            let band = &mut bands[usize::from(steps > 1)];
            *band = band.max((stepper.energy(&state) - energy).abs());
            stepper.velocity(&state, &mut now);
            worst = worst.max(match name {
                "sleigh" => now[2].abs(),
                "Suslov" => (0.6 * now[1] + 0.8 * now[2]).abs(),
                _ => slip(&state, &now),
            });
        }
        println!("{name}: {bands:?} of {energy}, constraint {worst:e}");
        assert!(bands[1] <= bands[0] * 1.1, "{name}: {bands:?}");
        assert!(worst < 1e-14, "{name}: {worst:e}");
    }
}
