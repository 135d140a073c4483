use liestep::{NonstandardInertia, SO3, force, lagrangian};

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Body {
    J_d: NonstandardInertia,
}

#[force(group = SO3, work = h * J_d.trace() * eta[0])]
#[liestep::lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Damped {
    J_d: NonstandardInertia,
}

fn main() {}
