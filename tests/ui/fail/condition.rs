use liestep::{NonstandardInertia, SO3, lagrangian};

#[lagrangian(group = SO3, l_d = if h > 0.0 { (F * J_d).trace() / h } else { 0.0 })]
struct Top {
    J_d: NonstandardInertia,
}

fn main() {}
