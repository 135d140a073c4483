//! Gravity and a magnetic field.

use liestep::mechanics::Term as _;
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    advected(w = up, b = field),
    l_d = ((F - I) * inertia * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * w.dot(&(rho + F * rho)) + h * b.dot(&(F * dipole)),
)]
struct Magnet {
    inertia: NonstandardInertia,
    rho: Vector3<f64>,
    dipole: Vector3<f64>,
    up: Vector3<f64>,
    field: Vector3<f64>,
}

fn main() {
    let inertia = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap();
    let magnet = Magnet { inertia, rho: Vector3::z(), dipole: Vector3::x(), up: Vector3::z(), field: Vector3::y() };
    assert_eq!(magnet.advected(), (Vector3::z(), Vector3::y()));
    let stepper = Stepper::new(magnet, 0.01).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, 0.0, 5.0)).unwrap();
    stepper.step(&mut state).unwrap();
    let (w, b) = state.advected();
    assert!(w.dot(&b).abs() < 1e-15 && w != Vector3::z() && b != Vector3::y());
}
