//! Two bodies with coupled velocities and attitudes: the derived terms, compared with dual numbers of the declared
//! `l_d`, up to large turns of either.

use checks::random::Random;
use checks::structure::stages::assert_stages;
use liestep::mechanics::DiscreteLagrangian;
use liestep::numbers::Real;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::{Matrix3, RealField, Vector3, convert};
use num_dual::HyperDual64;

use crate::dual_numbers::assert_terms;

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(
        w = up.seen_from(F_1),
        v = field.seen_from(F_2),
        Q = F_2.seen_from(F_1),
        R = F_1.seen_from(space),
    ),
    l_d = {
        // A function of a field's inverse, and of another matrix.
        let U = |Q: Matrix3<T>, y: Vector3<T>| { let r = Q * y; (r + y).dot(&r) * y.z };
        let turns = (vee(F_1) - vee(F_2)).norm_squared() / h
            + h * vee(Q - Q.transpose()).dot(&s) + h * ((Q - Q.transpose()) * A * (Q * Q)).trace();
        ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
            + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
            + ((F_1 - I) * rho).dot(&(Q * ((F_2 - I) * s))) / h
            - 0.5 * h * k * (w.dot(&(rho + F_1 * rho)) + v.dot(&(A * (F_2 * s))))
            + h * k * ((A * Q).trace() + (F_1.transpose() * Q * F_2 * A).trace() + (R * F_1 * rho).dot(&(A * s)))
            - h * (Q * v).dot(&w) * (F_1 * s).dot(&(Q * (F_2 * rho)))
            - h * (U(inverse(J_1), w) + U(A, v)) + turns
    },
)]
struct Pair<T: Real> {
    J_1: NonstandardInertia<T>,
    J_2: NonstandardInertia<T>,
    A: Matrix3<T>,
    k: T,
    rho: Vector3<T>,
    s: Vector3<T>,
    up: Vector3<T>,
    field: Vector3<T>,
}

/// The pair of bodies of a seed.
fn pair<T: RealField + Copy + Real>(seed: u64) -> Pair<T> {
    let mut r = Random::new(seed);
    let mut tensor = || {
        let root = r.matrix();
        NonstandardInertia::new((root * root.transpose() + Matrix3::identity()).map(convert)).unwrap()
    };
    let (J_1, J_2) = (tensor(), tensor());
    let A = r.matrix().map(convert);
    let mut vector = || r.vector().map(convert);
    Pair { J_1, J_2, A, k: convert(0.8), rho: vector(), s: vector(), up: vector(), field: vector() }
}

#[test]
fn two_bodies() {
    type Long = (SO3<HyperDual64>, SO3<HyperDual64>);
    for seed in 0..20_u32 {
        let h = 0.01 + 0.005 * f64::from(seed);
        let seed = u64::from(seed);
        let (system, long) = (pair::<f64>(seed), pair::<HyperDual64>(seed));
        // The cancelling terms are squares of differences of matrices.
        let cancelling = (system.J_1.as_matrix().trace() + system.J_2.as_matrix().trace()) / h;
        assert_terms::<_, Long, _>("two bodies", (&system, h, cancelling), |f, w, h| long.l_d(f, w, h), (seed, 3.0));
        assert_stages(&system, seed);
    }
}
