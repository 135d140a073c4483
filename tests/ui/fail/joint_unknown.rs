use liestep::groups::R3;
use liestep::mechanics::Each;
use liestep::methods::{Joined, Joints};
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group(F = SO3, d = R3),
    l_d = ((F - I) * K * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Free {
    K: NonstandardInertia,
    m: f64,
}

fn main() {
    let bodies = Each::<2>::of([Free { K: NonstandardInertia::from_diagonal(Vector3::z()).unwrap(), m: 1.0 }]);
    let joints = Joints::tree([Joined::between(Vector3::<f64>::z(), 0, 1)]);
    let _ = Stepper::jointed(bodies, joints, 0.01);
}
