use liestep::groups::R3;
use liestep::mechanics::Inertia;
use liestep::{SO3, lagrangian};

#[lagrangian(
    group(F = SO3, d = R3),
    velocity(Omega, v),
    l = 0.5 * Omega.dot(&(J * Omega)) + 0.5 * m * (v.x.powi(2) + v.z.powi(2)) + v.y,
)]
struct Body {
    J: Inertia,
    m: f64,
}

fn main() {}
