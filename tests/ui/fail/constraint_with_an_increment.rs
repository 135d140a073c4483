use liestep::constraint;
use liestep::methods::{Joined, Joints};
use nalgebra::Vector3;

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    zero = r + F_2 * below - h * d_1,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Hinge {
    below: Vector3<f64>,
}

fn main() {
    let _ = Joints::tree([Joined::to_space(Hinge { below: Vector3::x() }, 0)]);
}
