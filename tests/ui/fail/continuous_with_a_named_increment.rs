use liestep::{NonstandardInertia, SO3, lagrangian};

#[lagrangian(group(G = SO3), velocity = Omega, l = 0.5 * Omega.dot(&(J_d * Omega)) + (G * J_d).trace())]
struct Body {
    J_d: NonstandardInertia,
}

fn main() {}
