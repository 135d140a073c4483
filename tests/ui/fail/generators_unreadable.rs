use liestep::lagrangian;
use nalgebra::Matrix2;

#[lagrangian(
    group = Own,
    generators = [[[0, -1], [1, 0]]],
    l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Integers {
    A: Matrix2<f64>,
}

#[lagrangian(
    group = Own,
    generators = [[[0.0, -1.0]]],
    l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Oblong {
    A: Matrix2<f64>,
}

#[lagrangian(
    group = Own,
    generators = [],
    l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Nothing {
    A: Matrix2<f64>,
}

#[lagrangian(
    group = Own,
    generators = [[[0.0, 0.5 + 0.5], [1.0, 0.0]]],
    l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Sum {
    A: Matrix2<f64>,
}

#[lagrangian(
    group = Own,
    generators = 5.0,
    l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Number {
    A: Matrix2<f64>,
}

#[lagrangian(
    group = Own,
    generators = [[[0.0, -1.0], 1.0]],
    l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Row {
    A: Matrix2<f64>,
}

#[lagrangian(
    group = Own,
    generators = [[[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]]],
    l_d = ((F - I) * A * (F - I).transpose()).trace() / (2.0 * h),
)]
struct Large {
    A: Matrix2<f64>,
}

fn main() {}
