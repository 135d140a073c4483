//! The derived terms compared with independent results: dual numbers of the declared `l_d`, and differences of the
//! staged step.

use checks::any_scalar;
use checks::random::Random;
use checks::structure::{System, stages::assert_stages};
use liestep::mechanics::{DiagonalNonstandardInertia, DiscreteLagrangian, Inertia};
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

/// A Lagrangian without advected parameters.
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
struct AllTerms<T: Real> {
    J: Inertia<T>,
    A: Matrix3<T>,
    k: T,
    rho: Vector3<T>,
    up: Vector3<T>,
    field: Vector3<T>,
}

/// Smooth functions: the logarithmic kinetic term of Bobenko and Suris, a spring, an oscillating field, and a turn that
/// depends on an advected parameter.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = -(2.0 * k / h) * ((1.0 + F.trace()) / 4.0).ln()
        - h * k * ((F * rho - w).norm() + (k * w.dot(&rho)).sin() + (w.dot(&(F * rho)) / k).exp())
        - h / (3.0 + (F * rho).dot(&w).powi(2)) + h * (w.dot(&(F.transpose() * rho))).cos()
        + h * k * (exp(w)[(0, 2)] + exp(w.cross(&(F * rho)) * k)[(1, 2)]),
)]
struct LogarithmicTerm<T: Real> {
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

fn diagonal_top<T: RealField + Copy>(seed: u64) -> any_scalar::Top<T> {
    let mut r = Random::new(seed);
    let diagonal = r.vector().map(|x| convert(0.1 + x.abs()));
    let J_d = DiagonalNonstandardInertia::from_diagonal(diagonal).unwrap();
    any_scalar::Top { J_d, weight: real(6.867), rho: vector(&mut r), up: vector(&mut r) }
}

fn free_body<T: RealField + Copy>(seed: u64) -> FreeBody<T> {
    FreeBody { J_d: tensor(&mut Random::new(seed)) }
}

fn everything<T: RealField + Copy>(seed: u64) -> AllTerms<T> {
    let mut r = Random::new(seed);
    let J = tensor(&mut r).to_inertia();
    let A = r.matrix().map(convert);
    AllTerms { J, A, k: real(0.8), rho: vector(&mut r), up: vector(&mut r), field: vector(&mut r) }
}

fn smooth<T: RealField + Copy>(seed: u64) -> LogarithmicTerm<T> {
    let mut r = Random::new(seed);
    LogarithmicTerm { k: real(1.7), rho: vector(&mut r), up: vector(&mut r) }
}

/// Checks all derived terms and the stages; cancelling traces in `l_d` are `cancelling` over `h`.
fn compare<L, H>(name: &str, build: fn(u64) -> L, hyper: fn(u64) -> H, cancelling: fn(&L) -> f64)
where
    L: System<Group = SO3>,
    H: DiscreteLagrangian<Scalar = HyperDual64, Group = SO3<HyperDual64>, Advected: Entries<HyperDual64>>,
{
    for (seed, h) in [(0, 0.01), (1, 0.05), (2, 0.1), (3, 0.02)] {
        let (system, long) = (build(seed), hyper(seed));
        assert_terms::<_, SO3<HyperDual64>, _>(
            name,
            (&system, h, cancelling(&system) / h),
            |f, w, h| long.l_d(f, w, h),
            (seed, 0.5),
        );
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
