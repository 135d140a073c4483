use liestep::{SE2, lagrangian};

#[lagrangian(group = SE2, l_d = m * log(F).norm_squared() / h)]
struct Plate {
    m: f64,
}

fn main() {}
