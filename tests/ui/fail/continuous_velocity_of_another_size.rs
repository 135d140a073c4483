use liestep::groups::SE3;
use liestep::lagrangian;
use liestep::mechanics::Inertia;

#[lagrangian(group = SE3, velocity = xi, l = 0.5 * xi.dot(&(J * xi)))]
struct Body {
    J: Inertia,
}

fn main() {}
