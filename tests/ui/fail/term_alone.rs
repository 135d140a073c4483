use liestep::Stepper;
use liestep::effects::Gravity;
use nalgebra::Vector3;

fn main() {
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let _ = Stepper::new(gravity, 0.01);
}
