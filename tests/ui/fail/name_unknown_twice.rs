use liestep::{NonstandardInertia, SO3, lagrangian};

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - h * k * F.trace() - h * k * k,
)]
struct Top {
    J_d: NonstandardInertia,
}

fn main() {}
