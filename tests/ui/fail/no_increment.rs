use liestep::{NonstandardInertia, SO3, lagrangian};

#[lagrangian(group = SO3, l_d = h * J_d.trace())]
struct Top {
    J_d: NonstandardInertia,
}

fn main() {}
