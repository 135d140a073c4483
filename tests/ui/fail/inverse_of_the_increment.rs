use liestep::{NonstandardInertia, SO3, lagrangian};

#[lagrangian(
    group = SO3,
    l_d = (inverse(F) * J_d).trace() / h,
)]
struct Body {
    J_d: NonstandardInertia,
}

fn main() {}
