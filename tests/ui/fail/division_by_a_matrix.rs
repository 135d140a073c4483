use liestep::{NonstandardInertia, SO3, lagrangian};

#[lagrangian(group = SO3, l_d = (J_d / F).trace() / h)]
struct Top {
    J_d: NonstandardInertia,
}

fn main() {}
