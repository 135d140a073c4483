use liestep::groups::SE3;
use liestep::force;
use liestep::mechanics::Inertia;
use nalgebra::{Vector3, Vector6};

#[force(group = SO3, given = u, work = 0.5 * h * torque.dot(&eta))]
struct WithoutBrackets {
    torque: Vector3<f64>,
}

#[force(group = SO3, given(J = inertia), work = 0.5 * h * eta.dot(&(J * eta_next)))]
struct OfAnInertia {
    inertia: Inertia,
}

#[force(group = SO3, given(u = torque), work = 0.5 * h * torque.dot(&eta))]
struct OfTheField {
    torque: Vector3<f64>,
}

#[force(group = SO3, given(u = torque, v = strength), work = 0.5 * h * u.dot(&eta))]
struct Unused {
    torque: Vector3<f64>,
    strength: f64,
}

#[force(group = SE3, given(u = wrench), work = 0.5 * h * (hat(u) * eta)[0])]
struct OfAnotherSize {
    wrench: Vector6<f64>,
}

#[force(group = SE3, given(u = push), work = 0.5 * h * (hat(u) * hat(eta)).trace())]
struct WithoutTheTurn {
    push: Vector3<f64>,
}

fn main() {}
