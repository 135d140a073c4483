use liestep::{SO3, force};

#[force(group = SO3, work = c * eta.norm_squared() + h * c * F.trace())]
struct Push {
    c: f64,
}

fn main() {}
