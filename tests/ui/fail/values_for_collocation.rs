use liestep::effects::{Gravity, RigidBody};
use liestep::{NonstandardInertia, SO3, Stepper};
use nalgebra::Vector3;

fn main() {
    let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap() };
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let stepper = Stepper::collocated::<4>(body + gravity, 0.1).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::zeros()).unwrap();
    stepper.step_with(&mut state, &((), Vector3::x())).unwrap();
}
