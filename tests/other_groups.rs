//! Lagrangians on groups other than SO(3): every derived term against central differences of the declared `l_d`, the
//! staged step against the unstaged terms, and what the discrete flow conserves exactly.

// The letters of the field.
#![allow(non_snake_case)]

mod common;

use common::random::Random;
use liestep::{
    Advected, Coordinates, DiscreteLagrangian, DiscreteLiePoisson, Generators, Heisenberg, LieGroup, MatrixGroup, R2,
    Regular, Retraction, SE2, SE3, SL2, SO2, SU2, Stepper, lagrangian,
};
use liestep::{ContravariantTensor, ContravariantVector, CovariantTensor, MixedTensor};
use nalgebra::{Matrix2, Matrix3, Matrix4, RealField, SMatrix, SVector, Vector2, Vector3, Vector4};

/// A planar pendulum.
#[lagrangian(
    group = SO2,
    advected(w = up),
    l_d = inertia * (2.0 - F.trace()) / h - 0.5 * h * weight * w.dot(&(rho + F * rho)),
)]
struct Pendulum {
    inertia: f64,
    weight: f64,
    rho: Vector2<f64>,
    up: Vector2<f64>,
}

/// A planar body in uniform gravity: `J = ∫ X Xᵀ dm` and `r = ∫ X dm` in homogeneous coordinates.
#[lagrangian(
    group = SE2,
    advected(w = up),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * g * w.dot(&(r + F * r)),
)]
struct PlanarBody {
    J: Matrix3<f64>,
    g: f64,
    r: Vector3<f64>,
    up: Vector3<f64>,
}

/// The same in space.
#[lagrangian(
    group = SE3,
    advected(w = up),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * g * w.dot(&(r + F * r)),
)]
struct Body {
    J: Matrix4<f64>,
    g: f64,
    r: Vector4<f64>,
    up: Vector4<f64>,
}

/// A top in unit quaternions, with a potential that a rotation by 2π would change.
#[lagrangian(
    group = SU2,
    advected(w = up),
    l_d = ((F - I) * J * (F - I).transpose()).trace() * 2.0 / h - 0.5 * h * k * w.dot(&(rho + F * rho)),
)]
struct Quaternion {
    J: Matrix4<f64>,
    k: f64,
    rho: Vector4<f64>,
    up: Vector4<f64>,
}

/// A pseudo-rigid motion of unit determinant, with a nonlinear potential.
#[lagrangian(
    group = SL2,
    advected(w = covector),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * (k * w.dot(&(r + F * r)) + k * w.dot(&(F * r)).powi(2) + k * w.dot(&r).powi(2)),
)]
struct PseudoRigid {
    J: Matrix2<f64>,
    k: f64,
    r: Vector2<f64>,
    covector: Vector2<f64>,
}

/// A left-invariant metric on the Heisenberg group, with a potential.
#[lagrangian(
    group = Heisenberg,
    advected(w = covector),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * k * w.dot(&(r + F * r)),
)]
struct Nilpotent {
    J: Matrix3<f64>,
    k: f64,
    r: Vector3<f64>,
    covector: Vector3<f64>,
}

/// A particle in the plane, in uniform gravity: exactly a parabola.
#[lagrangian(
    group = R2,
    advected(w = up),
    l_d = m * (F - I).norm_squared() / (2.0 * h) - 0.5 * h * m * g * w.dot(&(origin + F * origin)),
)]
struct Particle {
    m: f64,
    g: f64,
    origin: Vector3<f64>,
    up: Vector3<f64>,
}

/// The affine maps `x ↦ a x + b` of the line: a group of one's own.
#[derive(Clone, Copy, Debug, PartialEq)]
struct AffineGenerators;

impl Generators<2, 2> for AffineGenerators {
    const GENERATORS: [[[f64; 2]; 2]; 2] = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [0.0, 0.0]]];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> T {
        m[(1, 0)].abs() + (m[(1, 1)] - T::one()).abs()
    }
}

type Affine<T = f64> = MatrixGroup<AffineGenerators, T, 2, 2>;

/// A scale and a shift.
#[lagrangian(
    group = Affine,
    generators = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [0.0, 0.0]]],
    advected(w = covector),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * k * w.dot(&(r + F * r)).powi(2),
)]
struct Scaling {
    J: Matrix2<f64>,
    k: f64,
    r: Vector2<f64>,
    covector: Vector2<f64>,
}

/// Every kind of advected parameter on SL(2), whose representation isn't orthogonal.
#[lagrangian(
    group = SL2,
    advected(w = covector, v = vector, S = tensor, B = form, A = map),
    l_d = {
        let potential = w.dot(&(F * r)) + (F.transpose() * covariant).dot(&v) + (S * F).trace() + (B * F * r).dot(&r)
            + (A * F).trace() * w.dot(&v) + (S * B).trace() + (A * S * F).trace();
        ((F - I) * (F - I).transpose()).trace() * m / (2.0 * h) - 0.5 * h * potential
    },
)]
struct Kinds {
    m: f64,
    r: Vector2<f64>,
    covariant: Vector2<f64>,
    covector: Vector2<f64>,
    vector: ContravariantVector<f64, 2>,
    tensor: ContravariantTensor<f64, 2>,
    form: CovariantTensor<f64, 2>,
    map: MixedTensor<f64, 2>,
}

fn kinds() -> Kinds {
    let mut r = Random::new(8);
    Kinds {
        m: 1.5,
        r: column(&mut r),
        covariant: column(&mut r),
        covector: column(&mut r),
        vector: ContravariantVector(column(&mut r)),
        tensor: ContravariantTensor(tensor(&mut r)),
        form: CovariantTensor(tensor(&mut r)),
        map: MixedTensor(tensor(&mut r)),
    }
}

/// A symmetric positive definite matrix.
fn tensor<const N: usize>(r: &mut Random) -> SMatrix<f64, N, N> {
    let root = SMatrix::<f64, N, N>::from_fn(|_, _| r.signed());
    root * root.transpose() + SMatrix::identity()
}

fn column<const N: usize>(r: &mut Random) -> SVector<f64, N> {
    SVector::from_fn(|_, _| r.signed())
}

/// `s` along the `k`th axis.
fn along<const D: usize>(k: usize, s: f64) -> SVector<f64, D> {
    SVector::from_fn(|i, _| if i == k { s } else { 0.0 })
}

/// The truth about one Lagrangian on a group of N × N matrices of dimension D, at random increments.
fn compare<L, const N: usize, const D: usize>(system: &L, random: fn(&mut Random) -> L::Advected)
where
    L: DiscreteLagrangian<Scalar = f64>,
    L::Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>, Matrix = SMatrix<f64, N, N>>,
    SVector<f64, D>: Coordinates<f64, Square = SMatrix<f64, D, D>>,
{
    let mut r = Random::new(3);
    for size in [0.0, 1e-8, 0.1, 0.5, 0.5, 0.5] {
        let h = 0.05;
        let xi = column::<D>(&mut r) * size;
        let element = L::Retraction::retract(&xi);
        let (f, w) = (element.matrix(), random(&mut r));
        let exp_element = |k: usize, s: f64| L::Retraction::retract(&(along::<D>(k, s)));
        let exp = |k: usize, s: f64| exp_element(k, s).matrix();
        // A retraction agrees with the exponential to first order, and central differences see no more.
        let slope = |g: &dyn Fn(f64) -> f64| (g(1e-5) - g(-1e-5)) / 2e-5;
        let (right, left) = (system.right_momentum(&f, &w, h), system.left_momentum(&f, &w, h));
        let (diamond, momentum) = (system.diamond(&f, &w, h), system.legendre_minus(&f, &w, h));
        let jacobian = system.momentum_jacobian(&f, &w, h);
        let scale = right.norm() + left.norm() + diamond.norm() + jacobian.norm();
        let close = |what: &str, found: f64, expected: f64| {
            assert!((found - expected).abs() <= 1e-7 * scale, "{what}: {found} instead of {expected}, scale {scale}");
        };
        for k in 0..D {
            // What an attitude g sees is g⁻¹·w.
            let carried = |s: f64| w.seen_from(&exp_element(k, -s));
            close("right", right[k], slope(&|s| system.l_d(&(exp(k, s) * f), &w, h)));
            close("left", left[k], slope(&|s| system.l_d(&(f * exp(k, s)), &w, h)));
            close("diamond", diamond[k], -slope(&|s| system.l_d(&f, &carried(s), h)));
            close("momentum", momentum[k], slope(&|s| system.l_d(&(exp(k, s) * f), &carried(s), h)));
            for j in 0..D {
                let value = slope(&|s| system.legendre_minus(&(exp(j, s) * f), &w, h)[k]);
                close("Jacobian", jacobian[(k, j)], value);
            }
        }
        close("energy", system.discrete_energy(&f, &w, h), -slope(&|s| system.l_d(&f, &w, h + s)));
        assert!((left - element.adjoint_transpose(&right)).norm() <= 1e-12 * scale, "left = Ad* right");
        stages(system, &xi, &w, h, scale);
    }
}

/// The staged step says the same as the unstaged terms.
fn stages<L, const N: usize, const D: usize>(system: &L, xi: &SVector<f64, D>, w: &L::Advected, h: f64, scale: f64)
where
    L: DiscreteLagrangian<Scalar = f64>,
    L::Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>, Matrix = SMatrix<f64, N, N>>,
    SVector<f64, D>: Coordinates<f64, Square = SMatrix<f64, D, D>>,
{
    let element = L::Retraction::retract(xi);
    let f = element.matrix();
    let constants = system.constants(h);
    let a = system.legendre_minus(&f, w, h) + L::kick_before(&constants, w);
    let offset = SVector::<f64, D>::from_fn(|k, _| scale * (0.3 - 0.2 * if k % 2 == 0 { 1.0 } else { -1.0 }));
    let terms = L::step_terms(&constants, &(a + offset), w);
    let (residual, jacobian) = L::newton_system(&constants, &terms, xi);
    let factor = -residual.dot(&offset) / offset.norm_squared();
    assert!(factor > 0.0);
    assert!((residual + offset * factor).norm() <= 1e-12 * residual.norm(), "{residual} along {offset}");
    for j in 0..D {
        let at = |s: f64| L::newton_system(&constants, &terms, &(xi + along::<D>(j, s))).0;
        let column = (at(1e-6) - at(-1e-6)) / 2e-6;
        assert!((jacobian.column(j) - column).norm() <= 1e-6 * jacobian.norm(), "column {j} of {jacobian}: {column}");
    }
    let increment = element.increment();
    let next = Advected::<L::Group>::advect(w, &increment);
    let after = element.adjoint_transpose(&a) + L::kick_after(&constants, &increment, &next);
    assert!((after - system.legendre_plus(&f, w, h)).norm() <= 1e-12 * (scale + after.norm()));
}

/// How far 100 steps and as many back end from the start; on the way the energy stays near.
fn there_and_back<L, const N: usize, const D: usize>(forth: L, back: L) -> f64
where
    L: DiscreteLagrangian<Scalar = f64, Advected = SVector<f64, N>> + Regular,
    L::Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>, Matrix = SMatrix<f64, N, N>>,
    SVector<f64, D>: Coordinates<f64, Square = SMatrix<f64, D, D>>,
{
    let mut r = Random::new(9);
    let (forth, back) = (Stepper::new(forth, 0.01).unwrap(), DiscreteLiePoisson::new(back, -0.01).unwrap());
    let mut state = forth.start(L::Group::identity(), column::<D>(&mut r)).unwrap();
    let (start, w, energy) = (state.momentum(), state.advected(), forth.energy(&state));
    for _ in 0..100 {
        forth.step(&mut state).unwrap();
        let change = (forth.energy(&state) - energy).abs();
        assert!(change < 1e-2 * (1.0 + energy.abs()), "{change} of {energy}");
    }
    assert!((state.momentum() - start).norm() > 1e-3, "something has moved");
    let (mut momentum, mut advected) = (state.momentum(), state.advected());
    for _ in 0..100 {
        let step = back.step(&momentum, &advected, &SVector::zeros()).unwrap();
        (momentum, advected) = (step.momentum, step.advected);
    }
    (momentum - start).norm() / (1.0 + start.norm()) + (advected - w).norm() / (1.0 + w.norm())
}

fn pendulum() -> Pendulum {
    Pendulum { inertia: 1.3, weight: 9.81, rho: Vector2::new(0.1, -0.4), up: Vector2::y() }
}

fn planar_body() -> PlanarBody {
    PlanarBody { J: tensor(&mut Random::new(1)), g: 9.81, r: Vector3::new(0.2, 0.1, 1.0), up: Vector3::y() }
}

fn body() -> Body {
    Body { J: tensor(&mut Random::new(1)), g: 9.81, r: Vector4::new(0.2, 0.1, -0.3, 1.0), up: Vector4::z() }
}

fn quaternion() -> Quaternion {
    let mut r = Random::new(2);
    Quaternion { J: tensor(&mut r), k: 0.7, rho: column(&mut r), up: column(&mut r) }
}

fn pseudo_rigid() -> PseudoRigid {
    let mut r = Random::new(4);
    PseudoRigid { J: tensor(&mut r), k: 0.6, r: column(&mut r), covector: column(&mut r) }
}

fn nilpotent() -> Nilpotent {
    let mut r = Random::new(5);
    Nilpotent { J: tensor(&mut r), k: 0.8, r: column(&mut r), covector: column(&mut r) }
}

fn scaling() -> Scaling {
    let mut r = Random::new(6);
    Scaling { J: tensor(&mut r), k: 0.8, r: column(&mut r), covector: column(&mut r) }
}

fn particle() -> Particle {
    Particle { m: 2.0, g: 9.81, origin: Vector3::z(), up: Vector3::y() }
}

macro_rules! on_a_group {
    ($($name:ident $system:ident $n:literal $d:literal),+ $(,)?) => {
        $(
            #[test]
            fn $name() {
                compare::<_, $n, $d>(&$system(), column::<$n>);
            }
        )+
    };
}

on_a_group!(
    so2 pendulum 2 1,
    se2 planar_body 3 3,
    se3 body 4 6,
    su2 quaternion 4 3,
    sl2 pseudo_rigid 2 3,
    heisenberg nilpotent 3 3,
    r2 particle 3 2,
    affine scaling 2 2,
);

/// All five kinds at once, each in a term of its own and in one with another.
#[test]
fn kinds_of_advected_parameters() {
    compare::<_, 2, 3>(&kinds(), |r| {
        let bilinear = CovariantTensor(SMatrix::from_fn(|_, _| r.signed()));
        let (tensor, map) = (SMatrix::from_fn(|_, _| r.signed()), SMatrix::from_fn(|_, _| r.signed()));
        (column(r), ContravariantVector(column(r)), ContravariantTensor(tensor), bilinear, MixedTensor(map))
    });
}

/// Where `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)`, a step of `−h` undoes one of `h`.
#[test]
fn self_adjoint_declarations_reverse() {
    let ours = [
        there_and_back::<_, 2, 1>(pendulum(), pendulum()),
        there_and_back::<_, 3, 3>(planar_body(), planar_body()),
        there_and_back::<_, 4, 6>(body(), body()),
        there_and_back::<_, 4, 3>(quaternion(), quaternion()),
        there_and_back::<_, 3, 2>(particle(), particle()),
    ];
    assert!(ours.iter().all(|&error| error <= 1e-12), "{ours:?}");
}

/// Off the orthogonal groups the square of `F − I` isn't that of `F⁻¹ − I`, and the scheme isn't symmetric.
#[test]
fn one_sided_kinetic_terms_do_not_reverse() {
    assert!(there_and_back::<_, 2, 3>(pseudo_rigid(), pseudo_rigid()) > 1e-6);
    assert!(there_and_back::<_, 3, 3>(nilpotent(), nilpotent()) > 1e-6);
}

/// On R² the scheme is Störmer and Verlet's, and a uniform field gives the exact parabola.
#[test]
fn a_particle_falls_on_a_parabola() {
    let stepper = Stepper::new(particle(), 0.1).unwrap();
    let mut state = stepper.start(R2::identity(), Vector2::new(3.0, 4.0)).unwrap();
    for _ in 0..10 {
        stepper.step(&mut state).unwrap();
    }
    let g = state.attitude().matrix();
    assert!((g[(0, 2)] - 3.0).abs() < 1e-13);
    assert!((g[(1, 2)] - (4.0 - 0.5 * 9.81)).abs() < 1e-13);
}
