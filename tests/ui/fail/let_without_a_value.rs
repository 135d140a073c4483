use liestep::{NonstandardInertia, SO3, lagrangian};

#[lagrangian(group = SO3, l_d = { let d; (d * J_d).trace() / h })]
struct Top {
    J_d: NonstandardInertia,
}

fn main() {}
