use liestep::{SO3, lagrangian};
use liestep::groups::R3;
use liestep::mechanics::Inertia;
use nalgebra::Vector3;

#[lagrangian(
    group(F = SO3, d = R3),
    velocity(Omega, v),
    advected(R = F.seen_from(space)),
    l = 0.5 * Omega.dot(&(J * Omega)) - (R * s).z,
)]
struct Standing {
    J: Inertia,
    s: Vector3<f64>,
}

#[lagrangian(group = SO3, velocity(Omega_1, Omega_2), l = 0.5 * Omega_1.dot(&(J * Omega_2)))]
struct One {
    J: Inertia,
}

#[lagrangian(group(F_1 = SO3, F_2 = SO3), velocity(Omega, Omega), l = 0.5 * Omega.dot(&(J * Omega)))]
struct Twice {
    J: Inertia,
}

#[lagrangian(group(F_1 = SO3, F_2 = SO3), velocity(), l = 0.5 * J.trace())]
struct Nameless {
    J: Inertia,
}

fn main() {}
