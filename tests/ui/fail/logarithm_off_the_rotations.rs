use liestep::lagrangian;
use liestep::groups::SE2;

#[lagrangian(group = SE2, l_d = m * log(F).norm_squared() / h)]
struct Plate {
    m: f64,
}

fn main() {}
