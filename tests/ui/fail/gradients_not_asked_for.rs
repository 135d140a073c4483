use liestep::effects::RigidBody;
use liestep::{SO3, Stepper, lagrangian};
use nalgebra::Vector3;

#[lagrangian(group = SO3, advected(w = up), l_d = -0.5 * h * weight * w.dot(&(rho + F * rho)))]
struct Weight {
    weight: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

fn claim(body: RigidBody, weight: Weight) {
    let _ = Stepper::new(body + weight, 0.01).unwrap().linearised();
}

fn main() {}
