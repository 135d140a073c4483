//! Two bodies that feel each other's velocities and attitudes: what is derived, against dual numbers of the declared
//! `l_d`, with turns of each body typed by hand.

use checks::random::Random;
use liestep::groups::{Configuration, LieGroup as _, Relative, SeenFrom};
use liestep::mechanics::{DiscreteLagrangian, Effect, Matrix, Term, Vector};
use liestep::numbers::Real;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::{Matrix3, RealField, Vector3, Vector6, convert};
use num_dual::{Dual64, HyperDual64};

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(
        w = up.seen_from(F_1),
        v = field.seen_from(F_2),
        Q = F_2.seen_from(F_1),
        R = F_1.seen_from(space),
    ),
    l_d = {
        // Called with the inverse of a field, and with another matrix.
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

type Matrices<T> = (Matrix3<T>, Matrix3<T>);
/// `w`, `v`, `Q` and `R`, any numbers of them.
type Values = (Vector3<f64>, Vector3<f64>, Matrix3<f64>, Matrix3<f64>);

/// Of a seed.
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

/// `I + ε E_k` in the component that the axis `k` belongs to.
fn turned<T: RealField + Copy>(k: usize, epsilon: T) -> Matrices<T> {
    let turn = |body: usize| {
        let generator = if k / 3 == body { Vector3::ith(k % 3, 1.0).cross_matrix() } else { Matrix3::zeros() };
        Matrix3::identity() + generator.map(convert::<f64, T>) * epsilon
    };
    (turn(0), turn(1))
}

fn product<T: RealField + Copy>(left: &Matrices<T>, right: &Matrices<T>) -> Matrices<T> {
    (left.0 * right.0, left.1 * right.1)
}

fn lifted<T: RealField + Copy>(f: &Matrices<f64>) -> Matrices<T> {
    (f.0.map(convert), f.1.map(convert))
}

/// `e·w`: what is seen by bodies that are turned by `e⁻¹`, which for these `e` is the transpose.
fn acted<T: Real + RealField + Copy>(e: &Matrices<T>, w: &Values) -> <Pair<T> as Term>::Advected {
    (
        SeenFrom(e.0 * w.0.map(convert::<f64, T>)),
        SeenFrom(e.1 * w.1.map(convert::<f64, T>)),
        Relative(e.0 * w.2.map(convert::<f64, T>) * e.1.transpose()),
        Configuration(w.3.map(convert::<f64, T>) * e.0.transpose()),
    )
}

/// `μ⁺` of a step by `F`, from `a = μ + kick_before(w)`, `Ad*_F`, and what is written in the new `w⁺ = F⁻¹·w`.
pub(crate) fn transported<L: Effect<Scalar = f64>>(
    (l, h): (&L, f64),
    (momentum, w): (&Vector<L>, &L::Advected),
    (increment, next): (&Matrix<L>, &L::Advected),
    coadjoint: impl Fn(&Vector<L>) -> Vector<L>,
) -> Vector<L> {
    let constants = l.constants(h);
    coadjoint(&(*momentum + L::kick_before(&constants, w))) + L::kick_after(&constants, increment, next)
}

fn inverse(f: &Matrices<f64>) -> Matrices<f64> {
    (f.0.transpose(), f.1.transpose())
}

/// `F − I`.
fn increment(f: &Matrices<f64>) -> Matrices<f64> {
    (f.0 - Matrix3::identity(), f.1 - Matrix3::identity())
}

/// Each body's by its own.
fn coadjoint(f: &Matrices<f64>, a: &Vector6<f64>) -> Vector6<f64> {
    let [first, second] = [(f.0, 0), (f.1, 3)].map(|(f, start)| f.transpose() * a.fixed_rows::<3>(start));
    Vector6::from_fn(|k, _| if k < 3 { first[k] } else { second[k - 3] })
}

/// What a declaration on a product derives, against dual numbers of its `l_d` along the turns of each component.
macro_rules! assert_derived {
    ($dimension:literal of $system:expr, $first:expr, $second:expr; $f:expr, $values:expr, $w:expr, $h:expr) => {
        let (system, first, second, f, values, w, h) = (&$system, &$first, &$second, $f, $values, $w, $h);
        let (right, left) = (system.right_momentum(&f, &w, h), system.left_momentum(&f, &w, h));
        let (diamond, momentum) = (system.diamond(&f, &w, h), system.legendre_minus(&f, &w, h));
        let jacobian = system.momentum_jacobian(&f, &w, h);
        let scale = right.norm() + left.norm() + diamond.norm() + jacobian.norm();
        let close = |what: &str, found: f64, expected: f64| {
            assert!((found - expected).abs() <= 1e-13 * scale, "{what}: {found} instead of {expected}, scale {scale}");
        };
        let next = (&increment(&f), &acted(&inverse(&f), &values));
        let after = transported((system, h), (&momentum, &w), next, |a| coadjoint(&f, a));
        let still = turned(0, Dual64::from(0.0));
        let at = |f: &Matrices<Dual64>, e: &Matrices<Dual64>| first.l_d(f, &acted(e, &values), Dual64::from(h)).eps;
        for k in 0..$dimension {
            let (turn, f_k) = (turned(k, Dual64::new(0.0, 1.0)), lifted(&f));
            close("right momentum", right[k], at(&product(&turn, &f_k), &still));
            close("left momentum", left[k], at(&product(&f_k, &turn), &still));
            close("transport", after[k], at(&product(&f_k, &turn), &still));
            close("diamond", diamond[k], -at(&f_k, &turn));
            close("momentum", momentum[k], at(&product(&turn, &f_k), &turn));
            for j in 0..$dimension {
                let turn = turned(k, HyperDual64::new(0.0, 1.0, 0.0, 0.0));
                let inner = turned(j, HyperDual64::new(0.0, 0.0, 1.0, 0.0));
                let moved = product(&turn, &product(&inner, &lifted(&f)));
                let value = second.l_d(&moved, &acted(&turn, &values), HyperDual64::from(h));
                close("Jacobian", jacobian[(k, j)], value.eps1eps2);
            }
        }
        let energy = -first.l_d(&lifted(&f), &acted(&still, &values), Dual64::new(h, 1.0)).eps;
        assert!((system.discrete_energy(&f, &w, h) - energy).abs() <= 1e-13 * (energy.abs() + scale / h));
    };
}
pub(crate) use assert_derived;

#[test]
fn two_bodies() {
    let rotations = Random::new(11).hard_rotations();
    for (index, pair_of) in rotations.windows(2).enumerate() {
        let seed = index as u64;
        let (system, first, second) = (pair::<f64>(seed), pair::<Dual64>(seed), pair::<HyperDual64>(seed));
        let mut r = Random::new(1000 + seed);
        let h = 0.01 + 0.1 * r.signed().abs();
        let f = (*pair_of[0].as_matrix(), *pair_of[1].as_matrix());
        // Relative attitudes and those in space are rotations, which the derivation uses.
        let rotation = |r: &mut Random| *SO3::from(nalgebra::UnitQuaternion::from_scaled_axis(r.vector())).as_matrix();
        let values = (r.vector(), r.vector(), rotation(&mut r), rotation(&mut r));
        let w = acted(&<(SO3, SO3)>::identity().matrix(), &values);
        assert_derived!(6 of system, first, second; f, values, w, h);
    }
}
