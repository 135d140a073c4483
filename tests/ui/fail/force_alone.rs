use liestep::Stepper;
use liestep::effects::Torque;
use nalgebra::Vector3;

fn main() {
    let _ = Stepper::new(Torque { torque: Vector3::z() }, 0.01);
}
