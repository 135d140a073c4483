use liestep::Stepper;
use liestep::effects::RigidBody;

fn claim(body: RigidBody) {
    let _ = Stepper::collocated::<4>(body, 0.1).unwrap().linearised();
}

fn main() {}
