use liestep::motion::DiscreteEulerPoincare;
use liestep::effects::{RigidBody, Torque};

fn claim(body: RigidBody, torque: Torque) {
    let _ = DiscreteEulerPoincare::new(body + torque, 0.01);
}

fn main() {}
