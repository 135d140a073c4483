use liestep::methods::Constraint;
use nalgebra::Vector3;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Rope {
    above: Vector3<f64>,
    length: f64,
}

fn gap(joint: impl Constraint<1>) -> &'static str {
    joint.name()
}

fn main() {
    gap(Rope { above: Vector3::zeros(), length: 1.0 });
}
