use liestep::effects::{Gravity, RigidBody};
use liestep::{SO3, State, Stepper};
use liestep::mechanics::Sum;
use nalgebra::Vector3;

fn claim(stepper: &Stepper<Sum<RigidBody, Gravity>>, state: &State<SO3, ((), Vector3<f64>)>) -> Vector3<f64> {
    stepper.spatial_momentum(state)
}

fn main() {}
