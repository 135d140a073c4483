//! SL(3), which the Cayley map leaves: the compiled step beside that of the text.

// A declaration names its fields by the letters of its formula.
#![allow(non_snake_case)]

use liestep::groups::{CayleyRetraction, LieGroup as _, Retraction, matrix_group};
use liestep::mechanics::Effect as _;
use liestep::methods::CompositionScheme;
use liestep::motion::{Plan, Propagator as _};
use liestep::numbers::Entries as _;
use liestep::with::Method;
use liestep::{SetupError, Stepper, lagrangian};
use liestep_late::{Declaration, Whole, numbers};
use nalgebra::{Matrix3, RealField, SMatrix, SVector, Vector3};

matrix_group! {
    /// Maps of space that keep volumes.
    pub(crate) type SL3 = [
        [[0.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
    ];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 3, 3>) -> T {
        (m.determinant() - T::one()).abs()
    }
}

/// A drop that flows and keeps its volume, with a stiffness against a direction in space.
#[lagrangian(
    group = SL3!,
    advected(w = up),
    l_d = (((F - I) * J * (F - I).transpose()).trace() + ((I - inverse(F)) * J * (I - inverse(F)).transpose()).trace())
        / (4.0 * h)
        - 0.5 * h * (w.dot(&p) + (F.transpose() * w).dot(&p)),
)]
#[derive(Clone, Debug)]
struct Drop {
    J: Matrix3<f64>,
    p: Vector3<f64>,
    up: Vector3<f64>,
}

type Velocity = SVector<f64, 8>;

fn drop(weight: f64) -> Drop {
    let J = Matrix3::new(1.0, 0.05, 0.02, 0.05, 1.1, 0.03, 0.02, 0.03, 1.2);
    Drop { J, p: Vector3::new(0.1, -0.2, 0.3) * weight, up: Vector3::new(0.2, 0.1, 1.0) }
}

fn velocity() -> Velocity {
    Velocity::from([0.0, 0.3, -0.08, -0.28, 0.15, 0.24, -0.21, -0.17])
}

/// The motion of a second in so many steps, and the drift of the momentum in space.
fn end<P: Plan<Drop>>(stepper: Result<Stepper<Drop, P>, SetupError>, steps: u32) -> (Matrix3<f64>, Velocity, f64) {
    let stepper = stepper.unwrap();
    let mut state = stepper.start(SL3::identity(), velocity()).unwrap();
    let before = state.momentum();
    stepper.run(&mut state, steps.into()).unwrap();
    let (g, momentum) = (state.attitude(), state.momentum());
    assert!(g.defect() < 1e-14, "{:e}", g.defect());
    let spatial = g.inverse().adjoint_transpose(&momentum);
    (g.matrix(), momentum, (spatial - before).norm() / before.norm())
}

fn order(of: impl Fn(u32) -> (Matrix3<f64>, Velocity, f64), [coarse, fine, exact]: [u32; 3]) -> f64 {
    let (g, momentum, drift) = of(exact);
    assert!(drift < 1e-14, "the momentum in space is conserved: {drift:e}");
    let error = |steps: u32| {
        let (other, of, _) = of(steps);
        ((other - g).norm_squared() + (of - momentum).norm_squared()).sqrt()
    };
    (error(coarse) / error(fine)).log2() / f64::from(fine / coarse).log2()
}

#[test]
fn orders_are_two_and_four() {
    let step = |steps: u32| 1.0 / f64::from(steps);
    let two = order(|steps| end(Stepper::new(drop(0.0), step(steps)), steps), [10, 20, 320]);
    assert!((two - 2.0).abs() < 0.01, "{two}");
    let composed = |steps| Stepper::composed(drop(0.0), step(steps), CompositionScheme::SUZUKI_4);
    let four = order(|steps| end(composed(steps), steps), [8, 16, 96]);
    assert!((four - 4.0).abs() < 0.03, "{four}");
}

/// Numbers of a state, of the compiled step and of the text's.
#[test]
fn the_compiled_step_is_that_of_the_text() {
    let scene = drop(1.0);
    let stepper = Stepper::new(scene.clone(), 0.01).unwrap();
    let mut state = stepper.start(SL3::identity(), velocity()).unwrap();
    let declaration = Declaration::parse(Drop::DECLARATION).unwrap();
    let values = declaration.described(&numbers(&scene)).unwrap();
    let whole: Whole = Whole::of(declaration, &values, 0.01, Method::default()).unwrap();
    let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let mut data = whole.start(&identity, velocity().as_slice()).unwrap();
    for step in 0..10_000 {
        let (compiled, read) = (stepper.step(&mut state), whole.step(&mut data));
        assert_eq!(compiled, read, "step {step}");
        if compiled.is_err() {
            // A drop that is stretched without end leaves the reach of a step of this length.
            assert!(step > 800, "step {step}");
            break;
        }
        let mut entries = Vec::new();
        state.attitude().matrix().each(&mut |entry| entries.push(entry));
        entries.extend(state.momentum().iter());
        assert_eq!(entries, data[..17], "step {step}");
    }
}

/// Volumes are kept to rounding, which grows like a random walk.
#[test]
fn volumes_are_kept() {
    // A turn about an axis of the first two coordinates stays bounded, where a stretch would grow without end.
    let stepper = Stepper::new(drop(0.0), 0.01).unwrap();
    let turn = Velocity::from([-0.3, 0.2, 0.3, 0.1, -0.2, -0.1, 0.0, 0.0]);
    let mut state = stepper.start(SL3::identity(), turn).unwrap();
    let before = state.momentum();
    stepper.run(&mut state, 10_000).unwrap();
    let (g, after) = (state.attitude(), state.momentum());
    let size = g.matrix().norm() * g.inverse().matrix().norm();
    assert!(size < 1e3, "{size}");
    assert!((g.matrix().determinant() - 1.0).abs() < 1e-14 * size, "{:e}", g.matrix().determinant() - 1.0);
    let spatial = g.inverse().adjoint_transpose(&after);
    assert!((spatial - before).norm() < 1e-14 * size * before.norm(), "{:e}", (spatial - before).norm());
}

/// The tangent is the derivative of the increment, by central differences; coordinates are found again.
#[test]
fn the_tangent_is_a_derivative() {
    let half = Velocity::from([0.1, -0.3, 0.2, 0.25, -0.1, 0.15, 0.3, -0.2]);
    let element = |y: &Velocity| <CayleyRetraction as Retraction<SL3>>::retract(&(y * 2.0));
    let (f, tangent) = (element(&half), <CayleyRetraction as Retraction<SL3>>::tangent_of_half(&half));
    assert!(f.defect() < 1e-15, "{:e}", f.defect());
    for k in 0..8 {
        let mut along = Velocity::zeros();
        along[k] = 1e-5;
        let slope = (element(&(half + along)).matrix() - element(&(half - along)).matrix()) / 2e-5;
        let column = SL3::vee(&(slope * f.inverse().matrix()));
        assert!((column - tangent.column(k)).norm() < 1e-9, "{k}: {column} {tangent}");
        assert!((slope * f.inverse().matrix()).trace().abs() < 1e-9);
    }
    let xi = <CayleyRetraction as Retraction<SL3>>::local_coordinates(&f).unwrap();
    assert!((xi - half * 2.0).norm() < 1e-14, "{xi}");
}
