use liestep::effects::RigidBody;
use liestep::mechanics::Each;
use liestep::methods::{BallJoint, Joined, Joints};
use liestep::{NonstandardInertia, Stepper};
use nalgebra::Vector3;

fn main() {
    let J_d = NonstandardInertia::from_diagonal(Vector3::z()).unwrap();
    let joints = Joints::tree([Joined::between(BallJoint { above: Vector3::z(), below: Vector3::z() }, 0, 1)]);
    let _ = Stepper::jointed(Each::<2>::of([RigidBody { J_d }]), joints, 0.01);
}
