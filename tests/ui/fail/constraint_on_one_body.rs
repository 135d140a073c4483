use liestep::constraint;
use nalgebra::Vector3;

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R = F_2.seen_from(space), x = d_2.seen_from(space)),
    zero = x + R * below - pivot,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pivot {
    below: Vector3<f64>,
    pivot: Vector3<f64>,
}

fn main() {}
