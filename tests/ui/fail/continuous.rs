use liestep::groups::SE3;
use liestep::mechanics::Inertia;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::Vector3;

#[lagrangian(
    group = SO3,
    velocity = Omega,
    advected(w = up),
    l = 0.5 * Omega.dot(&(J * Omega)) - w.dot(&rho),
    l_d = (F * J).trace() / h - h * w.dot(&(F * rho)),
)]
struct ContinuousAndDiscrete {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    velocity = Omega,
    advected(w = up),
    l = 0.5 * (J * rho).dot(&rho) * Omega.x.powi(2) - w.dot(&rho),
)]
struct ContinuousDegenerate {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, velocity = Omega, advected(w = up), l = -0.5 * Omega.dot(&(J * Omega)) - w.dot(&rho))]
struct ContinuousNegative {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, velocity = Omega, advected(w = up), l = Omega.dot(&(J * Omega)).sqrt() - w.dot(&rho))]
struct ContinuousNotSmooth {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, velocity = w, advected(w = up), l = 0.5 * w.dot(&(J * w)) - w.dot(&rho))]
struct ContinuousVelocityAdvected {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = 0.5 * h * Omega.dot(&(J * Omega)) - h * w.dot(&(F * rho)))]
struct ContinuousVelocityInADiscreteOne {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l = 0.5 * Omega.dot(&(J * Omega)) - w.dot(&rho))]
struct ContinuousVelocityMissing {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, velocity = rho, advected(w = up), l = 0.5 * rho.dot(&(J * rho)) - w.dot(&rho))]
struct ContinuousVelocityOfAField {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SE3, velocity = xi, l = 0.5 * xi.dot(&(J * xi)))]
struct ContinuousVelocityOfAnotherSize {
    J: Inertia,
}

#[lagrangian(group = SO3, velocity = h, advected(w = up), l = 0.5 * h.dot(&(J * h)) - w.dot(&rho))]
struct ContinuousVelocityReserved {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, velocity = Omega, advected(w = up), l = -w.dot(&(J * rho)))]
struct ContinuousVelocityUnused {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group(G = SO3), velocity = Omega, l = 0.5 * Omega.dot(&(J_d * Omega)) + (G * J_d).trace())]
struct ContinuousWithANamedIncrement {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, velocity = Omega, advected(w = up), l = 0.5 * Omega.dot(&(J * Omega)) - h * w.dot(&rho))]
struct ContinuousWithAStep {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, velocity = Omega, advected(w = up), l = 0.5 * Omega.dot(&(J * Omega)) - w.dot(&(F * rho)))]
struct ContinuousWithAnIncrement {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = ((F - Matrix3::identity()) * J_d).trace() / h + h * omega[0] * t.sin() + h * stiffness)]
struct NameOfTheContinuousWorld {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, velocity = Omega, advected(w = up), l_d = (F * J).trace() / h - h * w.dot(&(F * rho)))]
struct VelocityOfADiscreteOne {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

fn main() {}
