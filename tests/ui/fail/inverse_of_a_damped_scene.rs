use liestep::effects::{Drag, RigidBody};
use liestep::Stepper;
use liestep::mechanics::Sum;

fn claim(damped: &Stepper<Sum<RigidBody, Drag>>) {
    let _ = damped.inverse();
}

fn main() {}
