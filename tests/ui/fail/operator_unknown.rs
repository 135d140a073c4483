use liestep::{NonstandardInertia, SO3, lagrangian};

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - h * (m as f64)
        - h * m?
        - h * m.await
        - h * (m == 1.0)
        - h * (m % 2.0)
        - h * (m ^ 2)
        - h * m**2
        - h * (m << 2)
        - h * (m..m)
        - h * (m = 1.0)
        - h * (!m)
        - h * &mut m,
)]
struct Body {
    J_d: NonstandardInertia,
    m: f64,
}

fn main() {}
