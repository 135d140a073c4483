use liestep::lagrangian;

#[lagrangian(
    group = Line,
    generators = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [0.0, 0.0]], [[2.0, -1.0], [0.0, 0.0]]],
    l_d = m * ((F - I) * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Twice {
    m: f64,
}

type Line = ();

fn main() {}
