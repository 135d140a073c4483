use liestep::Stepper;
use liestep::effects::RigidBody;
use liestep::groups::R3;

fn remedied(body: RigidBody, line: Stepper<Line>) {
    let _ = Stepper::new(body, 0.1).unwrap().or_fallback(line);
}

#[liestep::lagrangian(group = R3, l_d = m * (F - I).norm_squared() / (2.0 * h))]
struct Line {
    m: f64,
}

fn main() {}
