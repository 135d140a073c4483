//! What the macro derives, against three truths that share none of its code: dual numbers of the declared `l_d`,
//! central differences of it, and the thesis' formulas typed by hand.

use checks::random::Random;
use liestep::groups::Retraction as _;
use liestep::mechanics::{DiagonalNonstandardInertia, DiscreteLagrangian, Effect as _, Inertia};
use liestep::numbers::Real;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::{Matrix3, RealField, Vector3, convert};
use num_dual::{Dual64, HyperDual64};

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

/// The trace of any rotation is above this.
const ANY: f64 = -2.0;

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

/// Advected parameters from a list of vectors.
trait Vectors<T> {
    fn of(vectors: &[Vector3<T>]) -> Self;
}

impl<T> Vectors<T> for () {
    fn of(_: &[Vector3<T>]) {}
}

impl<T: Copy + nalgebra::Scalar> Vectors<T> for Vector3<T> {
    fn of(vectors: &[Vector3<T>]) -> Self {
        vectors[0]
    }
}

impl<T: Copy + nalgebra::Scalar> Vectors<T> for (Vector3<T>, Vector3<T>) {
    fn of(vectors: &[Vector3<T>]) -> Self {
        (vectors[0], vectors[1])
    }
}

/// The increments to compare at: the identity, 1e-8 away, anywhere, near a half turn.
fn rotations() -> Vec<Matrix3<f64>> {
    Random::new(11).hard_rotations().iter().map(|f| *f.as_matrix()).collect()
}

fn generator(k: usize) -> Matrix3<f64> {
    Vector3::ith(k, 1.0).cross_matrix()
}

fn lift<T: RealField + Copy>(matrix: Matrix3<f64>) -> Matrix3<T> {
    matrix.map(convert)
}

/// `I + ε E_k`, exact to first order in a dual `ε`.
fn turned<T: RealField + Copy>(k: usize, epsilon: T) -> Matrix3<T> {
    Matrix3::identity() + lift::<T>(generator(k)) * epsilon
}

fn close(what: &str, found: f64, expected: f64, scale: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * scale, "{what}: {found} instead of {expected}, scale {scale}");
}

/// Compares all derived terms of one Lagrangian at many increments, those of a trace of at least −1 or more.
fn compare<L, D, H>(build: fn(u64) -> L, dual: fn(u64) -> D, hyper: fn(u64) -> H, least_trace: f64)
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected: Vectors<f64>>,
    D: DiscreteLagrangian<Scalar = Dual64, Group = SO3<Dual64>, Advected: Vectors<Dual64>>,
    H: DiscreteLagrangian<Scalar = HyperDual64, Group = SO3<HyperDual64>, Advected: Vectors<HyperDual64>>,
{
    for (index, f) in rotations().into_iter().enumerate().filter(|(_, f)| f.trace() >= least_trace) {
        let seed = index as u64;
        let (system, first, second) = (build(seed), dual(seed), hyper(seed));
        let mut r = Random::new(1000 + seed);
        let h = 0.01 + 0.1 * r.signed().abs();
        let ws = [r.vector(), r.vector()];
        let w = L::Advected::of(&ws);
        let duals = |turn: &Matrix3<Dual64>| D::Advected::of(&ws.map(|w| turn * w.map(Dual64::from)));
        let hypers = |turn: &Matrix3<HyperDual64>| H::Advected::of(&ws.map(|w| turn * w.map(HyperDual64::from)));
        let still = Matrix3::identity();
        let (right, left) = (system.right_momentum(&f, &w, h), system.left_momentum(&f, &w, h));
        let (diamond, momentum) = (system.diamond(&f, &w, h), system.legendre_minus(&f, &w, h));
        let jacobian = system.momentum_jacobian(&f, &w, h);
        let scale = right.norm() + left.norm() + diamond.norm() + jacobian.norm();
        let epsilon = Dual64::new(0.0, 1.0);
        let at = |f: &Matrix3<Dual64>, w: &D::Advected| first.l_d(f, w, Dual64::from(h)).eps;
        for k in 0..3 {
            let turn = turned(k, epsilon);
            let (fd, ws) = (lift(f), duals(&still));
            close("right momentum", right[k], at(&(turn * fd), &ws), scale, 1e-12);
            close("left momentum", left[k], at(&(fd * turn), &ws), scale, 1e-12);
            // E·w = −Eᵀ w = E w for skew E.
            close("diamond", diamond[k], -at(&fd, &duals(&turn)), scale, 1e-12);
            close("momentum", momentum[k], at(&(turn * fd), &duals(&turn)), scale, 1e-12);
            let s = 1e-6;
            let difference = |delta: &dyn Fn(f64) -> f64| (delta(s) - delta(-s)) / (2.0 * s);
            let moved = |s: f64| SO3::from(nalgebra::UnitQuaternion::from_scaled_axis(Vector3::ith(k, s)));
            let value = difference(&|s| system.l_d(&(moved(s).as_matrix() * f), &w, h));
            close("right momentum by differences", right[k], value, scale, 1e-7);
            let value = difference(&|s| system.l_d(&(f * moved(s).as_matrix()), &w, h));
            close("left momentum by differences", left[k], value, scale, 1e-7);
            for j in 0..3 {
                let turn = turned(k, HyperDual64::new(0.0, 1.0, 0.0, 0.0));
                let inner = turned(j, HyperDual64::new(0.0, 0.0, 1.0, 0.0));
                let value = second.l_d(&(turn * inner * lift(f)), &hypers(&turn), HyperDual64::from(h));
                close("Jacobian", jacobian[(k, j)], value.eps1eps2, scale, 1e-12);
                let moved = |s: f64| SO3::from(nalgebra::UnitQuaternion::from_scaled_axis(Vector3::ith(j, s)));
                let value = difference(&|s| system.legendre_minus(&(moved(s).as_matrix() * f), &w, h)[k]);
                close("Jacobian by differences", jacobian[(k, j)], value, scale, 1e-7);
            }
        }
        let energy = -first.l_d(&lift(f), &duals(&still), Dual64::new(h, 1.0)).eps;
        close("energy", system.discrete_energy(&f, &w, h), energy, energy.abs() + scale, 1e-12);
        stages(&system, &f, &w, h);
    }
}

/// The staged step says the same as the unstaged terms.
fn stages<L>(system: &L, f: &Matrix3<f64>, w: &L::Advected, h: f64)
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3>,
{
    use liestep::groups::{Advected as _, LieGroup as _};
    let element = SO3::from_matrix_unchecked(*f);
    let Some(xi) = L::Retraction::local_coordinates(&element) else { return };
    if xi.norm() > 1e3 {
        return; // a half turn is out of Cayley's reach, and near it the coordinates have no digits
    }
    let constants = system.constants(h);
    let before = L::kick_before(&constants, w);
    let momentum = system.legendre_minus(f, w, h);
    let a = momentum + before;
    let scale = a.norm() + before.norm() + system.momentum_jacobian(f, w, h).norm();
    // At the solution the residual vanishes, up to a factor whose size the Jacobian shows.
    let terms = L::step_terms(&constants, &a, w);
    let half = xi * 0.5;
    let (residual, jacobian) = L::newton_system(&constants, &terms, &half);
    let size = jacobian.norm() * (1.0 + half.norm()) + residual.norm();
    assert!(residual.norm() <= 1e-12 * size, "residual {residual} of {size}");
    // Away from it, the residual is that multiple of U − a.
    let offset = Vector3::new(0.3, -0.2, 0.5) * scale;
    let terms = L::step_terms(&constants, &(a + offset), w);
    let (residual, jacobian) = L::newton_system(&constants, &terms, &half);
    let factor = 0.5 * h * (1.0 + half.norm_squared()).powi(L::DENOMINATORS.cast_signed());
    assert!((residual + offset * factor).norm() <= 1e-11 * size.max(residual.norm()));
    for j in 0..3 {
        let s = 1e-6 * (1.0 + half.norm());
        let at = |s: f64| L::newton_system(&constants, &terms, &(half + Vector3::ith(j, s))).0;
        let column = (at(s) - at(-s)) / (2.0 * s);
        assert!((jacobian.column(j) - column).norm() <= 1e-6 * jacobian.norm(), "column {j} of {jacobian}: {column}");
    }
    // μ⁺ = Ad*_F a + k₁⁺ is (L_F)* δl_d/δF.
    let increment = element.increment();
    let next = w.advect(&increment);
    let after = element.adjoint_transpose(&a) + L::kick_after(&constants, &increment, &next);
    let expected = system.legendre_plus(f, w, h);
    assert!((after - expected).norm() <= 1e-12 * (scale + after.norm()), "{after} instead of {expected}");
}

#[test]
fn heavy_top_with_a_full_tensor() {
    compare(top, top, top, ANY);
}

#[test]
fn heavy_top_in_principal_axes() {
    compare(diagonal_top, diagonal_top, diagonal_top, ANY);
}

#[test]
fn free_body_without_advected_parameters() {
    compare(free_body, free_body, free_body, ANY);
}

#[test]
fn two_advected_vectors_and_every_operation() {
    compare(everything, everything, everything, ANY);
}

#[test]
fn smooth_functions() {
    // At a half turn ln((1 + tr F)/4) is singular, and central differences reach across.
    compare(smooth, smooth, smooth, -0.9);
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
