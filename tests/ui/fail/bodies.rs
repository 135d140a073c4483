use liestep::groups::R3;
use liestep::mechanics::Inertia;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    velocity = Omega,
    advected(w = up.seen_from(F_1)),
    l = 0.5 * Omega.dot(&(J_1 * J_2 * Omega)) - w.z,
)]
struct BodiesContinuous {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SE3),
    advected(w = up.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct BodiesFactorOfAnotherGroup {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_1 = SO3),
    advected(w = up.seen_from(F_1)),
    l_d = ((F_1 - I) * J_1 * J_2 * (F_1 - I).transpose()).trace() / (2.0 * h) - h * w.z,
)]
struct BodiesFactorTwice {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1), Q = F_2.seen_from(F_1)),
    l_d = ((F_1 - I) * (J_1 + Q * J_2 * Q.transpose()) * (F_1 - I).transpose()).trace() / (2.0 * h) - h * w.z,
)]
struct BodiesFactorUnused {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    generators = [[[0.0, -1.0], [1.0, 0.0]]],
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h),
)]
struct BodiesGenerators {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1), Q = F_2.seen_from(F_1)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct BodiesRelativeUnused {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_1), Q = F_2.seen_from(F_2)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * Q.trace() * w.z,
)]
struct BodiesSeenFromItself {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(w = up.seen_from(F_3)),
    l_d = (F_1.trace() + F_2.trace()) / h - h * w.z,
)]
struct BodiesSeenFromNobody {
    up: Vector3<f64>,
}

#[lagrangian(
    group(F = SO3, d = R3),
    velocity(Omega, v),
    l = 0.5 * Omega.dot(&(J * Omega)) + 0.5 * m * (v.x.powi(2) + v.z.powi(2)) + v.y,
)]
struct BodiesSingular {
    J: Inertia,
    m: f64,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    velocity(Omega_1, Omega_2),
    l = 0.5 * Omega_1.dot(&(J_1 * Omega_1)) + 0.5 * Omega_2.dot(&(J_2 * Omega_2)) - k * F_2.trace(),
)]
struct BodiesStepInAContinuousOne {
    J_1: Inertia,
    J_2: Inertia,
    k: f64,
}

#[lagrangian(group(F_1 = SO3, F_2 = SO3), l = 0.5 * Omega.dot(&(J * Omega)) - F_2.trace())]
struct BodiesStepWithoutVelocities {
    J: Inertia,
}

#[lagrangian(group(F_1 = SO3, F_2 = SO3, d_1 = R3, d_2 = R3, d_3 = R3), l_d = m * d_1.norm_squared() / (2.0 * h))]
struct BodiesTooMany {
    m: f64,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    velocity = (Omega_1, Omega_2),
    l = 0.5 * Omega_1.dot(&(J * Omega_1)) + 0.5 * Omega_2.dot(&(J * Omega_2)),
)]
struct BodiesVelocitiesByEquals {
    J: Inertia,
}

#[lagrangian(group(F_1 = SO3, d = R3, F_2 = SO3), velocity(), l = 0.5 * J.trace())]
struct BodiesVelocitiesNameless {
    J: Inertia,
}

#[lagrangian(group = SO3, velocity(Omega_1, Omega_2), l = 0.5 * Omega_1.dot(&(J * Omega_2)))]
struct BodiesVelocitiesOfOne {
    J: Inertia,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    velocity(Omega_1, Omega_2),
    advected(Q = F_2.seen_from(F_1)),
    l = 0.5 * Omega_1.dot(&(J_1 * Omega_1)) + 0.5 * Omega_2.dot(&(J_2 * Omega_2)) - k * Omega_1.dot(&Omega_2) - k * Q.trace(),
)]
struct BodiesVelocityFrames {
    J_1: Inertia,
    J_2: Inertia,
    k: f64,
}

#[lagrangian(group(F_1 = SO3, F_2 = SO3), velocity(Omega, Omega), l = 0.5 * Omega.dot(&(J * Omega)))]
struct BodiesVelocityTwice {
    J: Inertia,
}

#[lagrangian(
    group(F = SO3, d = R3),
    velocity(Omega, v),
    advected(R = F.seen_from(space)),
    l = 0.5 * Omega.dot(&(J * Omega)) - (R * s).z,
)]
struct BodiesVelocityUnused {
    J: Inertia,
    s: Vector3<f64>,
}

#[lagrangian(group(F_1 = SO3, F_2 = SO3), advected(w = up), l_d = (F_1.trace() + F_2.trace()) / h - h * w.z)]
struct BodiesWhoSees {
    up: Vector3<f64>,
}

fn main() {}
