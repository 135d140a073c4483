use liestep::lagrangian;
use liestep::mechanics::NonstandardInertia;
use nalgebra::Matrix3;

#[lagrangian(group = SO3, gradients = true, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct WithAValue {
    J_d: NonstandardInertia,
}

#[lagrangian(
    group = SO3, gradients, gradients, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
)]
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

fn main() {}
