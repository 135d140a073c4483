//! What the macro derives, against truths that share none of its code: dual numbers of the declared `l_d`, differences of the
//! staged step, and the thesis' formulas typed by hand.

use checks::random::Random;
use checks::structure::{System, stages::assert_stages};
use liestep::mechanics::{DiagonalNonstandardInertia, DiscreteLagrangian, Effect as _, Inertia};
use liestep::numbers::{Entries, Real};
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::{Matrix3, RealField, Vector3, convert};
use num_dual::HyperDual64;

use crate::dual_numbers::assert_terms;

/// (3.13) with any inertia tensor.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
struct Top<T: Real> {
    J_d: NonstandardInertia<T>,
    m: T,
    g: T,
    rho: Vector3<T>,
    up: Vector3<T>,
}

/// (3.13) in principal axes.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
struct DiagonalTop<T: Real> {
    J_d: DiagonalNonstandardInertia<T>,
    m: T,
    g: T,
    rho: Vector3<T>,
    up: Vector3<T>,
}

/// No advected parameter.
#[lagrangian(group = SO3, l_d = (J_d.trace() - (F * J_d).trace()) / h)]
struct FreeBody<T: Real> {
    J_d: NonstandardInertia<T>,
}

/// Two advected vectors, quadratic and quartic in `F`, with every operation of the syntax.
#[lagrangian(
    group = SO3,
    advected(w = up, b = field),
    l_d = {
        let d = F - I;
        let kinetic = (d * J.trace() * d.transpose()).trace() / (4.0 * h) - (d * J * d.transpose()).trace() / (2.0 * h);
        let tip = F * rho;
        let twist = vee(F * A - (F * A).transpose());
        let triple = w.cross(&b).dot(&tip);
        kinetic - 0.5 * h * (k * w.dot(&(rho + tip)) + k * b.dot(&(F * (A * rho))).powi(2) / 3.0)
            + h * k * (twist.dot(&w) - 0.25 * triple * tip[2] + (A * F * A.transpose() * F).trace())
            - h * (w.component_mul(&b).dot(&(F.transpose() * rho)) + k * (F - A).norm_squared() - w.x * F[(1, 2)])
            - 0.3 * h * (tip.cross_matrix() * A * b).dot(&w) + k * (w.dot(&tip) - w.dot(&rho))
    },
)]
struct Everything<T: Real> {
    J: Inertia<T>,
    A: Matrix3<T>,
    k: T,
    rho: Vector3<T>,
    up: Vector3<T>,
    field: Vector3<T>,
}

/// Smooth functions: the logarithmic kinetic term of Bobenko and Suris, a spring, an oscillating field.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = -(2.0 * k / h) * ((1.0 + F.trace()) / 4.0).ln()
        - h * k * ((F * rho - w).norm() + (k * w.dot(&rho)).sin() + (w.dot(&(F * rho)) / k).exp())
        - h / (3.0 + (F * rho).dot(&w).powi(2)) + h * (w.dot(&(F.transpose() * rho))).cos(),
)]
struct Smooth<T: Real> {
    k: T,
    rho: Vector3<T>,
    up: Vector3<T>,
}

fn real<T: RealField>(value: f64) -> T {
    convert(value)
}

fn vector<T: RealField + Copy>(random: &mut Random) -> Vector3<T> {
    random.vector().map(convert)
}

fn tensor<T: RealField + Copy>(random: &mut Random) -> NonstandardInertia<T> {
    let root = random.matrix();
    NonstandardInertia::new((root * root.transpose() + Matrix3::identity()).map(convert)).unwrap()
}

fn top<T: RealField + Copy>(seed: u64) -> Top<T> {
    let mut r = Random::new(seed);
    Top { J_d: tensor(&mut r), m: real(1.3), g: real(9.81), rho: vector(&mut r), up: vector(&mut r) }
}

fn diagonal_top<T: RealField + Copy>(seed: u64) -> DiagonalTop<T> {
    let mut r = Random::new(seed);
    let diagonal = r.vector().map(|x| convert(0.1 + x.abs()));
    let J_d = DiagonalNonstandardInertia::from_diagonal(diagonal).unwrap();
    DiagonalTop { J_d, m: real(0.7), g: real(9.81), rho: vector(&mut r), up: vector(&mut r) }
}

fn free_body<T: RealField + Copy>(seed: u64) -> FreeBody<T> {
    FreeBody { J_d: tensor(&mut Random::new(seed)) }
}

fn everything<T: RealField + Copy>(seed: u64) -> Everything<T> {
    let mut r = Random::new(seed);
    let J = tensor(&mut r).to_inertia();
    let A = r.matrix().map(convert);
    Everything { J, A, k: real(0.8), rho: vector(&mut r), up: vector(&mut r), field: vector(&mut r) }
}

fn smooth<T: RealField + Copy>(seed: u64) -> Smooth<T> {
    let mut r = Random::new(seed);
    Smooth { k: real(1.7), rho: vector(&mut r), up: vector(&mut r) }
}

/// The increments to compare at: the identity, 1e-8 away, anywhere, near a half turn.
fn rotations() -> Vec<Matrix3<f64>> {
    Random::new(11).hard_rotations().iter().map(|f| *f.as_matrix()).collect()
}

/// All derived terms and the stages; traces that cancel in `l_d` are `cancelling` over `h`.
fn compare<L, H>(name: &str, build: fn(u64) -> L, hyper: fn(u64) -> H, cancelling: fn(&L) -> f64)
where
    L: System<3, 3>,
    H: DiscreteLagrangian<Scalar = HyperDual64, Group = SO3<HyperDual64>, Advected: Entries<HyperDual64>>,
{
    for (seed, h) in [(0, 0.01), (1, 0.05), (2, 0.1), (3, 0.02)] {
        let (system, long) = (build(seed), hyper(seed));
        assert_terms(name, (&system, h, cancelling(&system) / h), |f, w, h| long.l_d(f, w, h), seed);
        assert_stages(&system, seed);
    }
}

#[test]
fn heavy_tops_and_free_bodies() {
    compare("a full tensor", top, top, |top| top.J_d.as_matrix().trace());
    compare("principal axes", diagonal_top, diagonal_top, |top| top.J_d.to_matrix().trace());
    compare("no advected parameter", free_body, free_body, |body| body.J_d.as_matrix().trace());
}

#[test]
fn every_operation_and_smooth_functions() {
    compare("every operation", everything, everything, |body| body.J.to_nonstandard().as_matrix().trace());
    compare("smooth functions", smooth, smooth, |body| 2.0 * body.k);
}

/// (3.17), (3.18) and the diamond of section 3.2.1, typed by hand, with `p = 2 vee(Π^)` (errata E1, E5).
#[test]
fn heavy_top_by_the_formulas_of_the_thesis() {
    for (index, f) in rotations().into_iter().enumerate() {
        let top: Top<f64> = top(index as u64);
        let mut r = Random::new(7 + index as u64);
        let (h, w) = (0.02, r.vector());
        let (J_d, rho, weight) = (top.J_d.as_matrix(), top.rho, top.m * top.g);
        let twice_vee = |m: Matrix3<f64>| Vector3::new(m.m32, m.m13, m.m21) * 2.0;
        let (rho_w, w_rho) = (rho * w.transpose(), w * rho.transpose());
        let f_t = f.transpose();
        let equation_3_17 = ((f * J_d - J_d * f_t) / h - (rho_w - w_rho) * (0.5 * h * weight)) * 0.5;
        let equation_3_18 = ((J_d * f - f_t * J_d) / h - (f_t * w_rho - rho_w * f) * (0.5 * h * weight)) * 0.5;
        let diamond = (w_rho - rho_w + w_rho * f_t - f * rho_w) * (-0.25 * h * weight);
        let scale = J_d.norm() / h + h * weight;
        for (found, typed) in [
            (top.legendre_minus(&f, &w, h), equation_3_17),
            (top.left_momentum(&f, &w, h), equation_3_18),
            (top.diamond(&f, &w, h), diamond),
        ] {
            assert!((found - twice_vee(typed)).norm() <= 1e-13 * scale);
        }
    }
}

/// The continuous limit: `l_d(exp hξ, w)/h` tends to `½ ξ·Jξ + s·ξ − V`.
#[test]
fn continuous_limit() {
    let system: Everything<f64> = everything(3);
    let mut r = Random::new(5);
    let (xi, w) = (r.vector(), (r.vector(), r.vector()));
    let limit = 0.5 * xi.dot(&(system.inertia(&w) * xi)) + system.momentum_bias(&w).dot(&xi) - system.potential(&w);
    let error = |h: f64| {
        let f = SO3::from(nalgebra::UnitQuaternion::from_scaled_axis(xi * h));
        (system.l_d(f.as_matrix(), &w, h) / h - limit).abs()
    };
    assert!(error(1e-5) < 1e-3, "{}", error(1e-5));
    assert!(error(1e-5) < 0.11 * error(1e-4));
}
