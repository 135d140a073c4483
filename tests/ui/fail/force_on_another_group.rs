use liestep::{SE2, force};

#[force(group = SE2, work = h * c * eta[0])]
struct Push {
    c: f64,
}


fn main() {}
