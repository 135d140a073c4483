use liestep::effects::Gravity;
use liestep::lagrangian;
use liestep::groups::SE2;
use nalgebra::Vector3;

#[lagrangian(group = SE2, l_d = m * ((F - I) * (F - I).transpose()).trace() / (2.0 * h))]
struct Puck {
    m: f64,
}

fn main() {
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let _ = Puck { m: 1.0 } + gravity;
}
