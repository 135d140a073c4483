use liestep::effects::RigidBody;
use liestep::{NonstandardInertia, Stepper};
use nalgebra::Vector3;

fn main() {
    let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap() };
    let _ = Stepper::collocated::<4>(body, 0.1).unwrap().compensated();
}
