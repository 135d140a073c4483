use liestep::methods::{Joined, Joints};
use liestep::{constraint, lagrangian};
use nalgebra::Vector3;

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(Q = F_2.seen_from(F_1)),
    zero = Q - Q.transpose(),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Weld {}

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(Q = F_2.seen_from(F_1), r = d_2.seen_from(d_1)),
    zero = {
        let turned = vee(Q);
        (r, turned, turned.dot(&e))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Overheld {
    e: Vector3<f64>,
}

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R = F_2.seen_from(space), x = d_2.seen_from(space)),
    zero = x + R * below - pivot,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct ConstraintOnOneBody {
    below: Vector3<f64>,
    pivot: Vector3<f64>,
}

#[constraint(group(F_1 = SO3, F_2 = SO3), advected(Q = F_2.seen_from(F_1)), zero = vee(Q))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Aligned {}

#[constraint(group = SO3, advected(w = up), zero = w.dot(&e))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Level {
    e: Vector3<f64>,
    up: Vector3<f64>,
}

#[constraint(group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3), advected(r = d_2.seen_from(d_1)), zero = r)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Single {
    offset: Vector3<f32>,
}

#[lagrangian(group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3), advected(r = d_2.seen_from(d_1)), zero = r)]
struct Misplaced {}

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

#[constraint(group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3), advected(r = d_2.seen_from(d_1)), zero = [r.x, r.y])]
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

#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    zero = r + F_2 * below - h * d_1,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct ConstraintWithAnIncrement {
    below: Vector3<f64>,
}

fn constraint_with_an_increment() {
    let _ = Joints::tree([Joined::to_space(ConstraintWithAnIncrement { below: Vector3::x() }, 0)]);
}

fn main() {}
