use liestep::force;
use nalgebra::Vector3;

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

fn main() {}
