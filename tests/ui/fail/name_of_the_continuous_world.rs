use liestep::{NonstandardInertia, SO3, lagrangian};

#[lagrangian(
    group = SO3,
    l_d = ((F - Matrix3::identity()) * J_d).trace() / h + h * omega[0] * t.sin() + h * stiffness,
)]
struct Top {
    J_d: NonstandardInertia,
}

fn main() {}
