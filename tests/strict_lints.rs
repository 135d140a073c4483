//! A crate that denies all warnings: an expansion adds none, under clippy's pedantic lints neither.

#![deny(warnings, missing_docs, non_snake_case, unused, rust_2018_idioms, unreachable_pub)]
#![deny(clippy::all, clippy::pedantic, clippy::nursery)]
#![forbid(unsafe_code)]

use liestep::mechanics::DiagonalNonstandardInertia;
use liestep::numbers::Real;
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::Vector3;

/// A heavy top in any scalar.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * inertia * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * w.dot(&(lever + F * lever)),
)]
#[derive(Clone, Debug)]
pub struct Top<T: Real> {
    /// Inertia about the pivot, kg m².
    pub inertia: NonstandardInertia<T>,
    /// The weight times the centre of mass, N m.
    pub lever: Vector3<T>,
    /// The vertical.
    pub up: Vector3<T>,
}

/// A ball on a spring, with a `let`, an index and functions.
#[lagrangian(
    group = SO3,
    advected(w = up, b = field),
    l_d = {
        let turned = F * lever;
        (inertia.trace() - (F * inertia).trace()) / h - h * (w.dot(&turned).sin() + vee(F).dot(&b).powi(2) + turned[0])
    },
)]
struct Ball {
    inertia: DiagonalNonstandardInertia,
    lever: Vector3<f64>,
    up: Vector3<f64>,
    field: Vector3<f64>,
}

#[test]
fn steps() {
    let (z, velocity) = (Vector3::z(), Vector3::new(0.1, 0.0, 1.0));
    let inertia = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap();
    let stepper = Stepper::new(Top { inertia, lever: z, up: z }, 0.01).unwrap();
    let mut state = stepper.start(SO3::identity(), velocity).unwrap();
    assert!(stepper.step(&mut state).is_ok());
    let inertia = DiagonalNonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap();
    let stepper = Stepper::new(Ball { inertia, lever: z, up: z, field: velocity }, 0.01).unwrap();
    let mut state = stepper.start(SO3::identity(), velocity).unwrap();
    assert!(stepper.step(&mut state).is_ok());
}
