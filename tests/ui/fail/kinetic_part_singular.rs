use liestep::lagrangian;
use liestep::groups::SE3;

#[lagrangian(group = SE3, l_d = k * (4.0 - F.trace()) / h)]
struct Body {
    k: f64,
}

fn main() {}
