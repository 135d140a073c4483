use liestep::effects::RigidBody;
use liestep::groups::R3;
use liestep::mechanics::{Along, Between, Pairs};
use liestep::methods::Joint;
use liestep::{SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group(F = SO3, d = R3),
    advected(R = F.seen_from(space)),
    l_d = -0.5 * h * ((R * s).z + (R * F * s).z) - 0.5 * h * k * d.x,
)]
#[derive(Clone, Copy)]
struct Weight {
    s: Vector3<f64>,
    k: f64,
}

fn put(body: RigidBody, weight: Weight, joint: Joint) {
    let _ = Along::<3>::of([body]);
    let _ = Pairs::<3>::of([weight]);
    let _ = Between::<0, 1, 3>::of([joint]);
}

fn main() {}
