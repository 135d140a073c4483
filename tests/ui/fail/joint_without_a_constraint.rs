use liestep::effects::RigidBody;
use liestep::methods::{Joined, Joints};
use nalgebra::Vector3;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Rope {
    above: Vector3<f64>,
    length: f64,
}

fn held(body: RigidBody, rope: Rope) {
    let joints = Joints::tree([Joined::to_space(rope, 0)]);
    let _ = liestep::Stepper::jointed(body, joints, 0.01);
}

fn main() {}
