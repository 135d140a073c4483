use liestep::constraint;

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    zero = r.norm() == length,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Equation {
    length: f64,
}

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    zero = r.norm() = length,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Assignment {
    length: f64,
}

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    zero = [r.x, r.y],
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Array {}

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    velocity(Omega_1, v_1, Omega_2, v_2),
    zero = v_2 - v_1 + r,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct OfVelocities {}

fn main() {}
