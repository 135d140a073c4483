use liestep::groups::SE3;
use liestep::mechanics::{Inertia, NonstandardInertia};
use liestep::{SO3, force, lagrangian};
use nalgebra::{Matrix3, Vector3, Vector6};

#[force(group = SO3, work = {
    let x = h * tau.dot(&eta);
    x;
})]
struct ForceEndsWithASemicolon {
    tau: Vector3<f64>,
}

#[force(group = SO3, work = h * tau.dot(&eta))]
struct ForceFieldUnused {
    tau: Vector3<f64>,
    unused: f64,
}

#[force(group = SO3, work = h * tau.dott(&eta) + h * tau.determinant())]
struct ForceMethodUnknown {
    tau: Vector3<f64>,
}

#[force(group = SO3, work = h * (tau + eta))]
struct ForceNotAScalar {
    tau: Vector3<f64>,
}

#[force(group = SO3, work = c * eta.norm_squared() + h * c * F.trace())]
struct ForceNotLinear {
    c: f64,
}

#[force(group = SO3, work = h * tau.dot(&eta))]
enum ForceOnAnEnumeration {
    Tau(Vector3<f64>),
}

#[force(group(F_1 = SO3, F_2 = SO3), work = h * tau.dot(&eta))]
struct Push {
    tau: Vector3<f64>,
}

#[force(group(F_1 = SO3, d = R3), displacement(eta_1), work = h * tau.dot(&eta_1))]
struct Pull {
    tau: Vector3<f64>,
}

#[force(group = SO3, displacement(eta), work = h * tau.dot(&eta))]
struct Turn {
    tau: Vector3<f64>,
}

#[force(group(F_1 = SO3, F_2 = SO3), displacement = eta_1, work = h * tau.dot(&eta_1))]
struct Lift {
    tau: Vector3<f64>,
}

#[force(group(F_1 = SO3, d = R3), displacement(tau, s), work = h * tau.dot(&s))]
struct Shift {
    tau: Vector3<f64>,
}

#[force(group(F_1 = SO3, F_2 = SO3), displacement(eta_1, eta_2), work = h * vee(F_1).dot(&eta_2_next))]
struct Across {}

#[force(group(F_1 = SO3, F_2 = SO3), displacement(eta, eta), work = h * tau.dot(&eta))]
struct Both {
    tau: Vector3<f64>,
}

#[force(group = SO3, work = h * c * F.trace())]
struct ForceWithoutDisplacement {
    c: f64,
}

#[force(group = SO3, given = u, work = 0.5 * h * torque.dot(&eta))]
struct WithoutBrackets {
    torque: Vector3<f64>,
}

#[force(group = SO3, given(J = inertia), work = 0.5 * h * eta.dot(&(J * eta_next)))]
struct OfAnInertia {
    inertia: Inertia,
}

#[force(group = SO3, given(u = torque), work = 0.5 * h * torque.dot(&eta))]
struct OfTheField {
    torque: Vector3<f64>,
}

#[force(group = SO3, given(u = torque, v = strength), work = 0.5 * h * u.dot(&eta))]
struct Unused {
    torque: Vector3<f64>,
    strength: f64,
}

#[force(group = SE3, given(u = wrench), work = 0.5 * h * (hat(u) * eta)[0])]
struct OfAnotherSize {
    wrench: Vector6<f64>,
}

#[force(group = SE3, given(u = push), work = 0.5 * h * (hat(u) * hat(eta)).trace())]
struct WithoutTheTurn {
    push: Vector3<f64>,
}

#[lagrangian(group = SO3, gradients = true, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct WithAValue {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, gradients, gradients, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Twice {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, velocity = Omega, gradients, l = 0.5 * Omega.dot(&(J * Omega)))]
struct WithoutAStep {
    J: Matrix3<f64>,
}

// What is asked for doesn't add a message to that of the mistake.
#[lagrangian(group = SO3, gradients, l_d = ((F - I) * K * (F - I).transpose()).trace() / (2.0 * h))]
struct Misspelt {
    J_d: NonstandardInertia,
}

#[force(group = SO3, l_d = 0.5 * h * c * F.trace())]
struct LagrangianInAForce {
    c: f64,
}

fn main() {}
