use liestep::constraint;
use nalgebra::Vector3;

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(Q = F_2.seen_from(F_1)),
    zero = Q - Q.transpose(),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Weld {}

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(Q = F_2.seen_from(F_1), r = d_2.seen_from(d_1)),
    zero = {
        let turned = vee(Q);
        (r, turned, turned.dot(&e))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Overheld {
    e: Vector3<f64>,
}

fn main() {}
