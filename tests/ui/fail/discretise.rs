use liestep::groups::SE2;
use liestep::mechanics::Inertia;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::{Matrix3, Vector3};

// The second end isn't the adjoint of the first, as the kinetic energy depends on how the bodies stand.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    velocity(Omega_1, Omega_2),
    advected(Q = F_2.seen_from(F_1)),
    l = 0.5 * (hat(Omega_1) * J * hat(Omega_1).transpose()).trace()
        + 0.5 * (hat(Omega_2) * J * hat(Omega_2).transpose()).trace()
        + (hat(Omega_1) * rho).dot(&(Q * (hat(Omega_2) * s))),
    discretise = trapezoid,
)]
struct BodiesAmbientTrapezoid {
    J: NonstandardInertia,
    rho: Vector3<f64>,
    s: Vector3<f64>,
}

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    velocity(Omega_1, Omega_2),
    l = 0.5 * Omega_1.dot(&(J * Omega_1)) + 0.5 * Omega_2.dot(&(J * Omega_2)) + 0.5 * m * Omega_2.cross(&s).norm_squared(),
    discretise = trapezoid,
)]
struct BodiesDiscretiseNoMatrix {
    J: Inertia,
    m: f64,
    s: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = up), l_d = (F * J).trace() / h - h * w.dot(&(F * rho)), discretise = trapezoid)]
struct DiscretiseADiscreteOne {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    velocity = Omega,
    advected(w = up),
    l = 0.5 * Omega.dot(&(J * Omega)) - w.dot(&rho),
    discretise = midpoint,
)]
struct DiscretiseAtTheAmbientMidpoint {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    velocity = Omega,
    advected(w = up),
    l = 0.5 * Omega.dot(&(J * Omega)) - w.dot(&rho),
    discretise = midpoint(Cayley),
)]
struct DiscretiseAtTheCayleyMidpoint {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    velocity = Omega,
    advected(w = up),
    l = 0.5 * Omega.dot(&(J * Omega)) - w.dot(&rho),
    discretise = trapezoid(cay),
)]
struct DiscretiseByAnUnknownRetraction {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    velocity = Omega,
    advected(w = up),
    l = 0.5 * Omega.cross(&rho).norm_squared() + 0.5 * Omega.dot(&(J * Omega)) - w.dot(&rho),
    discretise = trapezoid,
)]
struct DiscretiseNoMatrix {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SE2,
    velocity = xi,
    l = 0.5 * j * (hat(xi) * hat(xi).transpose()).trace() + 0.5 * k * r.dot(&(hat(xi) * s)).powi(2),
    discretise = trapezoid,
)]
struct DiscretiseNotSelfAdjoint {
    j: f64,
    k: f64,
    r: Vector3<f64>,
    s: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    velocity = Omega,
    advected(w = up),
    l = 0.5 * Omega.dot(&(J * Omega)) - w.dot(&rho),
    discretise = trapezium,
)]
struct DiscretiseUnknown {
    J: Inertia,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(group = SE2, velocity = xi, advected(w = up), l = 0.5 * xi.dot(&(M * xi)) - w.dot(&r), discretise = midpoint(exp))]
struct DiscretiseWithoutALogarithm {
    M: Matrix3<f64>,
    r: Vector3<f64>,
    up: Vector3<f64>,
}

fn main() {}
