use liestep::mechanics::{Along, Effect, Parts, Placed};
use liestep::{SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = ((F_1 - I) * rho).dot(&(Q * ((F_2 - I) * s))) / h,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Linked {
    rho: Vector3<f64>,
    s: Vector3<f64>,
}

const PARTS: Parts = <Placed<Along<3>, Linked, 1> as Effect>::PARTS;

fn main() {
    let _ = PARTS;
}
