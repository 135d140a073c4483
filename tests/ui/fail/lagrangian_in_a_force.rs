use liestep::{SO3, force};

#[force(group = SO3, l_d = 0.5 * h * c * F.trace())]
struct Push {
    c: f64,
}

fn main() {}
