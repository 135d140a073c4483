//! Declarations that are right though they look strange: their steps by the macro and by programs, and their motions.

use liestep::groups::{LieGroup as _, R3, SE3};
use liestep::mechanics::Effect as _;
use liestep::motion::Propagator as _;
use liestep::{SO3, Stepper, lagrangian};
use liestep_late::{Declaration, Whole};
use nalgebra::{Vector3, Vector6};

/// A body whose translation feels a vortex about an axis, where it has no derivative.
#[lagrangian(
    group(F = SO3, d = R3),
    velocity(Omega, v),
    advected(x = d.seen_from(space)),
    l = 0.5 * Omega.norm_squared() + 0.5 * v.norm_squared() + v.y * (x.x * x.x + x.y * x.y).sqrt(),
    discretise = trapezoid(Cayley),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Vortex {}

/// A point about an attracting centre, whose steps become longer as r³ᐟ².
#[lagrangian(
    group(d = R3),
    velocity = v,
    advected(x = d.seen_from(space)),
    given(E_0 = energy),
    pace = x.norm() * x.norm().sqrt(),
    l = 0.5 * v.norm_squared() + GM / x.norm(),
    discretise = trapezoid,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Orbit {
    GM: f64,
    energy: f64,
}

fn homogeneous(place: Vector3<f64>) -> Vec<f64> {
    let [x, y, z] = place.into();
    vec![1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, y, 0.0, 0.0, 1.0, z, 0.0, 0.0, 0.0, 1.0]
}

fn place(matrix: &[f64]) -> Vector3<f64> {
    Vector3::new(matrix[3], matrix[7], matrix[11])
}

const TURNED: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// A Lagrangian that has no derivative at the identity is stepped from where it has one: the end after a second by
/// `DOP853`, and the error of second order.
#[test]
fn a_vortex_about_an_axis() {
    let exact = Vector3::new(1.442_594_97, 0.857_328_94, 0.0);
    let vortex = Declaration::parse(Vortex::DECLARATION).expect("a declaration");
    let error = |steps: u32| {
        let h = 1.0 / f64::from(steps);
        let stepper = Stepper::new(Vortex {}, h).expect("a stepper");
        let start = (SO3::identity(), R3::from(Vector3::x()));
        let velocity = Vector6::new(0.0, 0.0, 0.0, 0.0, 1.0, 0.0);
        let mut state = stepper.start(start, velocity).expect("a start");
        let whole: Whole = Whole::of(vortex, &[], h, "step".parse().expect("a method")).expect("a whole step");
        let attitude = [TURNED.to_vec(), homogeneous(Vector3::x())].concat();
        let mut slice = whole.start(&attitude, velocity.as_slice()).expect("a start");
        for step in 0..steps {
            assert_eq!(stepper.step(&mut state), whole.step(&mut slice), "step {step}");
            let found = state.attitude().1.translation();
            assert_eq!(found, place(&slice[9..25]), "step {step}");
            assert_eq!(state.momentum().as_slice(), &slice[whole.layout().momentum()], "step {step}");
        }
        (state.attitude().1.translation() - exact).norm()
    };
    let errors = [error(50), error(100)];
    assert!(errors[1] < 3e-5 && (errors[0] / errors[1] - 4.0).abs() < 0.05, "{errors:?}");
}

/// A step that is too long has its error where the motion starts, in both ways, and leaves the state; a step of no length
/// has none.
#[test]
fn an_extreme_step_from_a_vortex() {
    let vortex = Declaration::parse(Vortex::DECLARATION).expect("a declaration");
    let start = (SO3::identity(), R3::from(Vector3::x()));
    let attitude = [TURNED.to_vec(), homogeneous(Vector3::x())].concat();
    let velocity = Vector6::new(0.0, 0.0, 0.0, 0.0, 1.0, 0.0);
    for h in [1e155, -1e155] {
        let stepper = Stepper::new(Vortex {}, h).expect("a stepper");
        let mut state = stepper.start(start, velocity).expect("a start");
        let whole: Whole = Whole::of(vortex, &[], h, "step".parse().expect("a method")).expect("a whole step");
        let mut slice = whole.start(&attitude, velocity.as_slice()).expect("a start");
        let before = (state.momentum(), slice.clone());
        let error = stepper.step(&mut state).expect_err("no step");
        assert_eq!(Err(error), whole.step(&mut slice));
        assert_eq!(before, (state.momentum(), slice));
    }
    for h in [f64::NAN, f64::INFINITY, 1e-320] {
        assert!(Stepper::new(Vortex {}, h).is_err(), "{h}");
        assert!(
            Whole::<liestep_late::Interpreter>::of(vortex, &[], h, "step".parse().expect("a method")).is_err(),
            "{h}"
        );
    }
}

/// The place is on Kepler's ellipse, with an error of second order, and the steps by programs are the same.
#[test]
fn an_orbit_by_its_pace() {
    const ECCENTRICITY: f64 = 0.6;
    let orbit = Orbit { GM: 1.0, energy: -0.5 };
    let declaration = Declaration::parse(Orbit::DECLARATION).expect("a declaration");
    let numbers = declaration.numbers(&[("GM", &[1.0]), ("energy", &[-0.5])]).expect("numbers");
    let at = Vector3::new(-1.0 - ECCENTRICITY, 0.0, 0.0);
    let speed = ((1.0 - ECCENTRICITY) / (1.0 + ECCENTRICITY)).sqrt();
    // A velocity is that by the time of the steps.
    let velocity = Vector3::new(0.0, -speed * at.norm().powf(1.5), 0.0);
    let error = |steps: u32| {
        let h = 6.0 / f64::from(steps);
        let stepper = Stepper::new(orbit, h).expect("a stepper");
        let mut state = stepper.start(R3::from(at), velocity).expect("a start");
        let whole: Whole = Whole::of(declaration, &numbers, h, "step".parse().expect("a method")).expect("a step");
        let mut slice = whole.start(&homogeneous(at), velocity.as_slice()).expect("a start");
        let mut farthest = 0.0_f64;
        for step in 0..steps {
            assert_eq!(stepper.step(&mut state), whole.step(&mut slice), "step {step}");
            let now = state.attitude().translation();
            assert_eq!(now, place(&slice), "step {step}");
            // Kepler's ellipse has the centre in a focus: r = (1 − e²)/(1 + e cos θ).
            let apart = now.norm() + ECCENTRICITY * now.x - (1.0 - ECCENTRICITY * ECCENTRICITY);
            farthest = farthest.max(apart.abs());
        }
        farthest
    };
    let errors = [error(200), error(400)];
    assert!(errors[1] < 2e-3 && (errors[0] / errors[1] - 4.0).abs() < 0.2, "{errors:?}");
}

/// A translation alone is a vector: a falling point and one on a line, as in their formulas.
#[test]
fn translations_alone() {
    let falling = Declaration::parse(
        "#[lagrangian(group(d = R3), velocity(v), advected(x = d.seen_from(space)), discretise = trapezoid,
            l = m * v.norm_squared() / 2 - m * g * x.z)]
        struct Falling { m: f64, g: f64 }",
    )
    .expect("a declaration");
    let numbers = falling.numbers(&[("m", &[2.0]), ("g", &[9.81])]).expect("numbers");
    let whole: Whole = Whole::of(falling, &numbers, 0.01, "step".parse().expect("a method")).expect("a step");
    let mut state = whole.start(&homogeneous(Vector3::y()), &[1.0, 0.0, 3.0]).expect("a start");
    whole.run(&mut state, 100).expect("steps");
    let expected = Vector3::new(1.0, 1.0, 3.0 - 0.5 * 9.81);
    assert!((place(&state) - expected).norm() < 1e-12, "{:?}", place(&state));
    let spring = Declaration::parse(
        "#[lagrangian(group(s = R1), advected(x = s.seen_from(space)),
            l_d = s * s / (2 * h) - h * k / 8 * (2 * x + s) * (2 * x + s))]
        struct Spring { k: f64 }",
    )
    .expect("a declaration");
    let (h, k) = (0.1, 4.0);
    let whole: Whole = Whole::of(spring, &[k], h, "step".parse().expect("a method")).expect("a step");
    let mut state = whole.start(&[1.0, 0.5, 0.0, 1.0], &[0.0]).expect("a start");
    whole.run(&mut state, 50).expect("steps");
    // The midpoint rule turns by 2 atan(ω h/2) in a step.
    let expected = 0.5 * (50.0 * 2.0 * (0.5 * k.sqrt() * h).atan()).cos();
    assert!((state[1] - expected).abs() < 1e-12, "{} {expected}", state[1]);
}

/// A square of the kinetic energy that is multiplied out moves as its `let` does, with the energy `T + 3 c T²`.
#[test]
fn a_kinetic_energy_that_stiffens() {
    const TEXTS: [&str; 2] = [
        "{ let K = ((F - I) * J * (F - I).transpose()).trace() / (2 * h); K + c * K * K / h }",
        "((F - I) * J * (F - I).transpose()).trace() / (2 * h)
            + c * ((F - I) * J * (F - I).transpose()).trace() / (2 * h)
                * ((F - I) * J * (F - I).transpose()).trace() / (2 * h) / h",
    ];
    let (c, Omega) = (0.1, Vector3::new(0.4, -0.3, 0.8));
    // Moments of inertia (3.5, 3, 2.5) of the nonstandard inertia (1, 1.5, 2).
    let kinetic = 0.5 * Vector3::new(3.5, 3.0, 2.5).dot(&Omega.component_mul(&Omega));
    let ends = TEXTS.map(|l_d| {
        let text = format!("#[lagrangian(group = SO3, l_d = {l_d})] struct Stiff {{ J: NonstandardInertia, c: f64 }}");
        let declaration = Declaration::parse(&text).expect("a declaration");
        let J = [1.0, 0.0, 0.0, 0.0, 1.5, 0.0, 0.0, 0.0, 2.0];
        let numbers = declaration.numbers(&[("J", &J), ("c", &[c])]).expect("numbers");
        let whole: Whole = Whole::of(declaration, &numbers, 0.01, "step".parse().expect("a method")).expect("a step");
        let mut state = whole.start(&TURNED, Omega.as_slice()).expect("a start");
        let energy = whole.energy(&state);
        assert!((energy - (kinetic + 3.0 * c * kinetic * kinetic)).abs() < 1e-13, "{energy}");
        whole.run(&mut state, 100).expect("steps");
        state[..12].to_vec()
    });
    let apart = ends[0].iter().zip(&ends[1]).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(apart < 1e-13, "{apart:e}");
}

/// A kinetic energy of all velocities of the affine maps of space is derived, though it is one long term.
#[test]
fn twelve_velocities() {
    let generator = |at: usize| {
        let row = |i: usize| (0..4).map(|j| if 4 * i + j == at { "1" } else { "0" }).collect::<Vec<_>>().join(", ");
        format!("[[{}], [{}], [{}], [{}]]", row(0), row(1), row(2), row(3))
    };
    let generators = (0..12).map(generator).collect::<Vec<_>>().join(", ");
    let text = format!(
        "#[lagrangian(group = Affine, generators = [{generators}], velocity = xi, l = xi.dot(M * xi) / 2,
            discretise = trapezoid(Cayley))]
        struct Deforming {{ M: SMatrix<f64, 12, 12> }}"
    );
    let declaration = Declaration::parse(&text).expect("a declaration");
    assert!(declaration.is_self_adjoint && declaration.is_quadratic);
}

/// A rigid motion whose velocity has names for its parts, in a place that knows no vectors.
mod rigid {
    use liestep::groups::SE3;
    use liestep::lagrangian;

    #[lagrangian(
        group = SE3,
        velocity(Omega, v),
        l = 0.5 * (2.0 * Omega.x * Omega.x + 3.0 * Omega.y * Omega.y + 4.0 * Omega.z * Omega.z) + 0.5 * m * v.norm_squared(),
        discretise = trapezoid(Cayley),
    )]
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub(crate) struct Rigid {
        pub(crate) m: f64,
    }
}

/// The momentum of a rigid motion is that of its parts, and the steps by programs are the same.
#[test]
fn parts_of_a_velocity() {
    let stepper = Stepper::new(rigid::Rigid { m: 5.0 }, 0.01).expect("a stepper");
    let velocity = Vector6::new(0.3, -0.2, 0.1, 1.0, 2.0, -1.0);
    let mut state = stepper.start(SE3::identity(), velocity).expect("a start");
    let expected = Vector6::new(0.6, -0.6, 0.4, 5.0, 10.0, -5.0);
    assert!((state.momentum() - expected).norm() < 1e-14, "{:?}", state.momentum());
    let declaration = Declaration::parse(rigid::Rigid::DECLARATION).expect("a declaration");
    let whole: Whole = Whole::of(declaration, &[5.0], 0.01, "step".parse().expect("a method")).expect("a step");
    let mut slice = whole.start(&homogeneous(Vector3::zeros()), velocity.as_slice()).expect("a start");
    for step in 0..100 {
        assert_eq!(stepper.step(&mut state), whole.step(&mut slice), "step {step}");
        assert_eq!(state.momentum().as_slice(), &slice[whole.layout().momentum()], "step {step}");
    }
}
