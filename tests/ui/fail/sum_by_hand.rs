use liestep::{NonstandardInertia, SO3, lagrangian};

#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Body {
    J_d: NonstandardInertia,
}

impl core::ops::Add for Body {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        other
    }
}

fn main() {}
