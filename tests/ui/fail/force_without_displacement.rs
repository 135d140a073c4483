use liestep::{SO3, force};

#[force(group = SO3, work = h * c * F.trace())]
struct Push {
    c: f64,
}

fn main() {}
