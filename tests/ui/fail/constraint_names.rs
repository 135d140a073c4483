use liestep::constraint;
use nalgebra::Vector3;

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(r = d_2.seen_from(d_1), unused = F_1.seen_from(space)),
    zero = r,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Together {}

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    zero = r.dot(&(R * axis)) - Omega.norm(),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Across {
    axis: Vector3<f64>,
}

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    given(u = length),
    zero = r.norm_squared() - u,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Winch {
    length: f64,
}

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(w = up.seen_from(F_1), v = up.seen_from(F_2)),
    zero = w.dot(&v),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Crossed {
    up: Vector3<f64>,
}

#[constraint(group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3), advected(Q = F_2.seen_from(F_1)))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Nothing {}

#[constraint(group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3), advected(r = d_2.seen_from(d_1)), zero = r)]
struct NoCopy {}

fn main() {}
