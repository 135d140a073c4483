//! The momenta of a declared `l_d` are its derivatives, and hang together as the theory says:
//!
//! ```text
//! (L_F)* δl_d/δF = Ad*_F (R_F)* δl_d/δF,     μ⁺ = Ad*_F (μ + δl_d/δw ⋄ w),     w⁺ = F⁻¹ w
//! ```
//!
//! so `(μ, w)` moves on a coadjoint orbit of the semidirect product, and `|w|²` and `μ·w` are exact.

mod common;

use common::measure::{derivative, relative};
use common::random::Random;
use common::tops::{FreeBody, FullTop, HeavyTop};
use liestep::{DiscreteLagrangian, DiscreteLiePoisson, Effect, LieGroup as _, Retraction, SO3};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// Two products of 3 × 3 matrices, relative to the entries of `J/h`.
const ROUNDING: f64 = 1e-14;

fn exp(v: Vector3<f64>) -> Matrix3<f64> {
    UnitQuaternion::from_scaled_axis(v).to_rotation_matrix().into_inner()
}

fn gradient(f: impl Fn(Vector3<f64>) -> f64) -> Vector3<f64> {
    Vector3::from_fn(|k, _| derivative(|s| f(Vector3::ith(k, s))))
}

/// The six-point differences leave 10⁻¹³ of what they differentiate, which exceeds its derivatives some ten times.
const DIFFERENCES: f64 = 1e-11;

/// Random `F` and `w`.
fn samples(seed: u64) -> impl Iterator<Item = (SO3, Vector3<f64>)> {
    let mut random = Random::new(seed);
    (0..20).map(move |_| (random.rotation(), random.vector()))
}

/// `advected` turns a random vector into what the Lagrangian advects, `turn` moves that by a rotation.
fn assert_derivatives<L: DiscreteLagrangian<Scalar = f64, Group = SO3>>(
    l: &L,
    advected: impl Fn(Vector3<f64>) -> L::Advected,
) {
    for (f, v) in samples(21) {
        let (f, w, h) = (*f.as_matrix(), advected(v), 0.1);
        let scale = l.inertia().norm() / h;
        let close = |a: Vector3<f64>, b: Vector3<f64>| assert!((a - b).norm() < DIFFERENCES * scale, "{a} {b}");
        close(l.right_momentum(&f, &w, h), gradient(|s| l.l_d(&(exp(s) * f), &w, h)));
        close(l.left_momentum(&f, &w, h), gradient(|s| l.l_d(&(f * exp(s)), &w, h)));
        close(l.diamond(&f, &w, h), -gradient(|s| l.l_d(&f, &advected(exp(s) * v), h)));
        close(l.legendre_minus(&f, &w, h), gradient(|s| l.l_d(&(exp(s) * f), &advected(exp(s) * v), h)));
        close(l.legendre_plus(&f, &w, h), l.left_momentum(&f, &w, h));
        let jacobian = l.momentum_jacobian(&f, &w, h);
        for k in 0..3 {
            let row = gradient(|s| l.legendre_minus(&(exp(s) * f), &w, h)[k]);
            close(jacobian.row(k).transpose(), row);
        }
        // `1/h` has the seventh derivative `7!/h⁸`, so that the six points of a hundredth of `h` leave 4·10⁻¹¹ of `1/h²`.
        let rate = derivative(|s| l.l_d(&f, &w, h + s));
        assert!((l.discrete_energy(&f, &w, h) + rate).abs() < 1e-9 * scale / h, "{rate}");
    }
}

#[test]
fn p2_momenta_are_derivatives_of_the_declared_lagrangian() {
    let axes = *Random::new(22).rotation().as_matrix();
    assert_derivatives(&HeavyTop::thesis(), |v| v);
    assert_derivatives(&HeavyTop::asymmetric(), |v| v);
    assert_derivatives(&FullTop::in_axes(&HeavyTop::asymmetric(), &axes), |v| v);
    assert_derivatives(&FreeBody::with_moments([2.0, 3.0, 4.5]), |_| ());
}

fn assert_left_is_moved_right<L: DiscreteLagrangian<Scalar = f64, Group = SO3>>(
    l: &L,
    advected: impl Fn(Vector3<f64>) -> L::Advected,
) {
    for (f, v) in samples(23) {
        for h in [1e-3, 0.1] {
            let (m, w) = (f.matrix(), advected(v));
            let right = l.right_momentum(&m, &w, h);
            let scale = l.inertia().norm() / h;
            assert!((l.left_momentum(&m, &w, h) - f.adjoint_transpose(&right)).norm() < ROUNDING * scale);
            let moved = f.adjoint_transpose(&(l.legendre_minus(&m, &w, h) + l.diamond(&m, &w, h)));
            assert!((l.legendre_plus(&m, &w, h) - moved).norm() < ROUNDING * scale);
        }
    }
}

#[test]
fn p2_left_momentum_is_the_right_one_moved() {
    let axes = *Random::new(24).rotation().as_matrix();
    assert_left_is_moved_right(&HeavyTop::thesis(), |v| v);
    assert_left_is_moved_right(&HeavyTop::asymmetric(), |v| v);
    assert_left_is_moved_right(&FullTop::in_axes(&HeavyTop::asymmetric(), &axes), |v| v);
    assert_left_is_moved_right(&FreeBody::with_moments([2.0, 3.0, 4.5]), |_| ());
}

/// A step solves `𝔽l_d⁻(F, w) = μ` and ends at `μ⁺ = 𝔽l_d⁺(F, w)`, `w⁺ = F⁻¹w`; both Casimirs stay.
#[test]
fn p2_a_step_is_the_discrete_lie_poisson_map_and_keeps_the_casimirs() {
    let top = HeavyTop::asymmetric();
    let mut random = Random::new(25);
    for h in [1e-3, 0.1, 0.3] {
        let flow = DiscreteLiePoisson::new(top.clone(), h).unwrap();
        for _ in 0..20 {
            let (momentum, w) = (random.vector() * 3.0, random.vector());
            let step = flow.step(&momentum, &w, &Vector3::zeros()).unwrap();
            let f = step.element();
            let scale = top.inertia().norm() / h;
            assert!((top.legendre_minus(f.as_matrix(), &w, h) - momentum).norm() < ROUNDING * scale);
            assert!((top.legendre_plus(f.as_matrix(), &w, h) - step.momentum).norm() < ROUNDING * scale);
            assert!(relative(&step.advected, &f.adjoint_transpose(&w)) < 1e-15);
            assert!((step.advected.norm_squared() - w.norm_squared()).abs() < 2e-15);
            assert!((step.momentum.dot(&step.advected) - momentum.dot(&w)).abs() < 1e-14);
            assert!(f.defect() < 2e-15);
        }
    }
}

/// The staged form of the equations is the plain one: the Newton system vanishes where `𝔽l_d⁻ = μ`, and its Jacobian
/// is its derivative.
#[test]
fn p2_the_staged_newton_system_is_the_momentum_equation() {
    let top = HeavyTop::asymmetric();
    let mut random = Random::new(26);
    for h in [1e-3, 0.1] {
        let constants = top.constants(h);
        for _ in 0..20 {
            let (xi, w) = (random.vector(), random.vector());
            let f: SO3 = <HeavyTop as Effect>::Retraction::retract(&xi);
            let f = f.matrix();
            let a = top.legendre_minus(&f, &w, h) + HeavyTop::kick_before(&constants, &w);
            let terms = HeavyTop::step_terms(&constants, &a, &w);
            let system = |xi: Vector3<f64>| HeavyTop::newton_system(&constants, &terms, &xi);
            let (residual, jacobian) = system(xi);
            let scale = jacobian.norm();
            assert!(residual.norm() < ROUNDING * scale, "{residual}");
            for k in 0..3 {
                let row = gradient(|s| system(xi + s).0[k]);
                assert!((jacobian.row(k).transpose() - row).norm() < DIFFERENCES * scale);
            }
        }
    }
}
