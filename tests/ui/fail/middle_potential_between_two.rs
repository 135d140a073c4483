use liestep::groups::R3;
use liestep::lagrangian;
use liestep::mechanics::{Between, Effect, Placed};

#[lagrangian(
    group(d_1 = R3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    l_d = -0.5 * h * k * (r + 0.5 * (d_2 - d_1)).norm_squared(),
)]
#[derive(Clone, Copy)]
struct Tied {
    k: f64,
}

// What a stepper asks of the pair when it is built.
const _: bool = <Placed<Between<0, 2, 3>, Tied, 1> as Effect>::PARTS.unknown;

fn main() {}
