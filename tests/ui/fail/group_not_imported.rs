use liestep::{NonstandardInertia, lagrangian};

#[lagrangian(group = SO3, l_d = -(F * J_d).trace() / h)]
struct Top {
    J_d: NonstandardInertia,
}

fn main() {}
