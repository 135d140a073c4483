use liestep::force;
use liestep::groups::SE2;

#[force(group = SE2, work = h * c * eta[0])]
struct Push {
    c: f64,
}


fn main() {}
