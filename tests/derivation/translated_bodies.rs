//! Bodies that turn and are translated: what is derived, against dual numbers of the declared `l_d`, with turns and
//! translations typed by hand. Which terms there are is random.

use checks::random::Random;
use liestep::groups::{Configuration, R1, R3, Relative, SeenFrom};
use liestep::mechanics::{DiscreteLagrangian, Effect, Term};
use liestep::numbers::Real;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::{Matrix2, Matrix3, Matrix4, RealField, SVector, Vector3, Vector4, convert};
use num_dual::{Dual64, HyperDual64};

use crate::several_bodies::{assert_derived, transported};

// With functions: what both ends of a step have, one of them calling another.
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
struct Carried<T: RealField + Copy> {
    J: NonstandardInertia<T>,
    A: Matrix3<T>,
    m: T,
    rho: Vector3<T>,
    a: Vector4<T>,
    b: Vector4<T>,
    up: Vector3<T>,
    up_there: Vector3<T>,
}

type Matrices<T> = (Matrix3<T>, Matrix4<T>, Matrix2<T>, Matrix4<T>);
/// `w`, `R`, `r`, `x` and `s`, any numbers of them.
type Values = (Vector3<f64>, Matrix3<f64>, Vector3<f64>, Vector3<f64>, f64);

/// Of a seed.
fn carried<T: RealField + Copy>(seed: u64) -> Carried<T> {
    let mut r = Random::new(seed);
    let root = r.matrix();
    let J = NonstandardInertia::new((root * root.transpose() + Matrix3::identity()).map(convert)).unwrap();
    let A = r.matrix().map(convert);
    let mut coefficients = || Vector4::from_fn(|_, _| r.signed()).map(|x| convert(if x < -0.3 { 0.0 } else { x }));
    let (a, b) = (coefficients(), coefficients());
    let mut vector = || r.vector().map(convert);
    Carried { J, A, m: convert(0.8), rho: vector(), a, b, up: vector(), up_there: vector() }
}

/// `I + ε E_k` of all factors.
fn turned<T: RealField + Copy>(k: usize, epsilon: T) -> Matrices<T> {
    let mut all: Matrices<T> = (Matrix3::identity(), Matrix4::identity(), Matrix2::identity(), Matrix4::identity());
    match k {
        0..3 => all.0 += Vector3::ith(k, 1.0).cross_matrix().map(convert::<f64, T>) * epsilon,
        3..6 => all.1[(k - 3, 3)] = epsilon,
        6 => all.2[(0, 1)] = epsilon,
        _ => all.3[(k - 7, 3)] = epsilon,
    }
    all
}

fn product<T: RealField + Copy>(left: &Matrices<T>, right: &Matrices<T>) -> Matrices<T> {
    (left.0 * right.0, left.1 * right.1, left.2 * right.2, left.3 * right.3)
}

fn lifted<T: RealField + Copy>(f: &Matrices<f64>) -> Matrices<T> {
    (f.0.map(convert), f.1.map(convert), f.2.map(convert), f.3.map(convert))
}

/// The translation by a vector.
fn shift<T: RealField + Copy>(x: &Vector3<T>) -> Matrix4<T> {
    Matrix4::new_translation(x)
}

/// `e·w`, for `e` one of [`turned`]: what is added has its sign turned, what turns is transposed.
fn acted<T: Real + RealField + Copy>(e: &Matrices<T>, w: &Values) -> <Carried<T> as Term>::Advected {
    let place = |matrix: &Matrix4<T>| Vector3::new(matrix[(0, 3)], matrix[(1, 3)], matrix[(2, 3)]);
    let (first, angle, second) = (place(&e.1), e.2[(0, 1)], place(&e.3));
    let (r, x) = (w.2.map(convert::<f64, T>), w.3.map(convert::<f64, T>));
    let mut s = Matrix2::identity();
    s[(0, 1)] = convert::<f64, T>(w.4) - angle;
    (
        SeenFrom(e.0 * w.0.map(convert::<f64, T>)),
        Configuration(w.1.map(convert::<f64, T>) * e.0.transpose()),
        Relative(shift(&(r + first - second))),
        Configuration(shift(&(x - first))),
        Configuration(s),
    )
}

fn inverse(f: &Matrices<f64>) -> Matrices<f64> {
    let back = |matrix: &Matrix4<f64>| Matrix4::identity() * 2.0 - matrix;
    (f.0.transpose(), back(&f.1), Matrix2::identity() * 2.0 - f.2, back(&f.3))
}

/// `F − I`.
fn increment(f: &Matrices<f64>) -> Matrices<f64> {
    (f.0 - Matrix3::identity(), f.1 - Matrix4::identity(), f.2 - Matrix2::identity(), f.3 - Matrix4::identity())
}

/// What is translated keeps its own.
fn coadjoint(f: &Matrices<f64>, a: &SVector<f64, 10>) -> SVector<f64, 10> {
    let turned = f.0.transpose() * a.fixed_rows::<3>(0);
    SVector::from_fn(|k, _| if k < 3 { turned[k] } else { a[k] })
}

#[test]
fn bodies_that_are_translated() {
    for (index, rotation) in Random::new(12).hard_rotations().iter().enumerate() {
        let seed = index as u64;
        let (system, first, second) = (carried::<f64>(seed), carried::<Dual64>(seed), carried::<HyperDual64>(seed));
        let mut r = Random::new(2000 + seed);
        let h = 0.01 + 0.1 * r.signed().abs();
        let mut wheel = Matrix2::identity();
        wheel[(0, 1)] = r.signed();
        let f = (*rotation.as_matrix(), shift(&r.vector()), wheel, shift(&r.vector()));
        let attitude = *SO3::from(nalgebra::UnitQuaternion::from_scaled_axis(r.vector())).as_matrix();
        let values = (r.vector(), attitude, r.vector(), r.vector(), r.signed());
        let w = acted(&turned(0, 0.0), &values);
        assert_derived!(10 of system, first, second; f, values, w, h);
    }
}
