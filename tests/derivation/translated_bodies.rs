//! Bodies with rotation and translation: the derived terms, compared with dual numbers of the declared `l_d`, up to
//! large turns and translations. The selection of the terms is random.

use checks::random::Random;
use checks::structure::stages::assert_stages;
use liestep::groups::{R1, R3};
use liestep::mechanics::DiscreteLagrangian;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::{Matrix3, RealField, Vector3, Vector4, convert};
use num_dual::HyperDual64;

use crate::dual_numbers::assert_terms;

// The functions are used at both ends of a step, and one of them calls another.
#[lagrangian(
    group(F = SO3, d_1 = R3, t = R1, d_2 = R3),
    advected(
        w = up.seen_from(F),
        R = F.seen_from(space),
        r = d_2.seen_from(d_1),
        x = d_1.seen_from(space),
        s = t.seen_from(space),
    ),
    l_d = {
        let lever = R * ((F - I) * rho);
        let spring = |y: Vector3<T>| 0.5 * b[0] * y.norm_squared() + b[1] * (1.0 + y.norm_squared()).sqrt();
        let U = |R: Matrix3<T>, y: Vector3<T>, place: Vector3<T>, angle: T| {
            let seen = R.transpose() * y;
            spring(y) + b[2] * (place - R * rho).dot(&up_there) + b[3] * angle.cos() * seen.dot(&(A * seen))
        };
        let kinetic = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) + m * d_1.norm_squared() / (2.0 * h)
            + m * d_2.norm_squared() / (2.0 * h) + m * (t + rho.dot(&vee(F))).powi(2) / (2.0 * h);
        let coupled = a[0] * d_1.dot(&lever) / h + a[1] * t * d_2.x / h + a[2] * d_1.dot(&(R * (F * (A * (F.transpose() * (R.transpose() * d_2)))))) / h;
        let gauge = a[3] * t * w.dot(&rho) + a[3] * (d_1 - d_2).dot(&(R * (F * rho)));
        kinetic + coupled + gauge
            - 0.5 * h * (U(R, r, x, s) + U(R * F, r + d_2 - d_1, x + d_1, s + t) + w.dot(&rho) + w.dot(&(F * rho)))
    },
)]
struct TranslatedBodies<T: RealField + Copy> {
    J: NonstandardInertia<T>,
    A: Matrix3<T>,
    m: T,
    rho: Vector3<T>,
    a: Vector4<T>,
    b: Vector4<T>,
    up: Vector3<T>,
    up_there: Vector3<T>,
}

/// The bodies of a seed.
fn carried<T: RealField + Copy>(seed: u64) -> TranslatedBodies<T> {
    let mut r = Random::new(seed);
    let root = r.matrix();
    let J = NonstandardInertia::new((root * root.transpose() + Matrix3::identity()).map(convert)).unwrap();
    let A = r.matrix().map(convert);
    let mut coefficients = || Vector4::from_fn(|_, _| r.signed()).map(|x| convert(if x < -0.3 { 0.0 } else { x }));
    let (a, b) = (coefficients(), coefficients());
    let mut vector = || r.vector().map(convert);
    TranslatedBodies { J, A, m: convert(0.8), rho: vector(), a, b, up: vector(), up_there: vector() }
}

#[test]
fn bodies_that_are_translated() {
    type Long = (SO3<HyperDual64>, R3<HyperDual64>, R1<HyperDual64>, R3<HyperDual64>);
    for seed in 0..20_u32 {
        let h = 0.01 + 0.005 * f64::from(seed);
        let seed = u64::from(seed);
        let (system, long) = (carried::<f64>(seed), carried::<HyperDual64>(seed));
        let cancelling = system.J.as_matrix().trace() / h;
        assert_terms::<_, Long, _>("translated", (&system, h, cancelling), |f, w, h| long.l_d(f, w, h), (seed, 3.0));
        assert_stages(&system, seed);
    }
}
