use liestep::constraint;
use nalgebra::Vector3;

#[constraint(group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3), advected(r = d_2.seen_from(d_1)), zero = (r, r.x))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Component {}

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    zero = {
        let along = r.dot(&n);
        (along, r.norm_squared() - length, r.norm_squared() - along.powi(2) - length)
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Combined {
    n: Vector3<f64>,
    length: f64,
}

#[constraint(group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3), advected(r = d_2.seen_from(d_1)), zero = r.cross(&n))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cross {
    n: Vector3<f64>,
}

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    zero = (r.norm() - length, 0.0),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Nothing {
    length: f64,
}

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    zero = (r, r + r.dot(&n) * n),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Twice {
    n: Vector3<f64>,
}

#[constraint(group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3), advected(r = d_2.seen_from(d_1)), zero = (r.x, r))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Whole {}

// Zero but for rounding.
#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R = F_1.seen_from(space), r = d_2.seen_from(d_1)),
    zero = (r.norm() - 1.0, (R * n).norm_squared() - 1.0),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Length {
    n: Vector3<f64>,
}

fn main() {}
