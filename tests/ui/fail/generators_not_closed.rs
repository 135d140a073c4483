use liestep::lagrangian;

#[lagrangian(
    group = Turned,
    generators = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [1e-13, 0.0]]],
    l_d = m * ((F - I) * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Open {
    m: f64,
}

type Turned = ();

fn main() {}
