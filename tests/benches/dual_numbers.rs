//! The derived kernels against dual numbers put through the same declared `l_d`.
//!
//! ```text
//! cargo bench --bench dual-numbers
//! ```
//!
//! One Newton iteration needs the momentum equation and its Jacobian, the end of a step the left momentum. The derived
//! code gives them as the stages of a step do; dual numbers give all of them by
//!
//! ```text
//! l_d((I + Σ s_k E_k) F (I + Σ t_j E_j), (I + Σ s_k E_k) w)
//! ∂/∂s_k = momentum      ∂/∂t_j = left momentum      ∂²/∂s_k ∂t_j = Jacobian along F exp(t E_j)
//! ```
//!
//! in one evaluation with vectors `s` and `t`, or in nine with one pair each. That they agree is asserted before they
//! are timed; they take turns within one run, the fastest batch of each counts, and the ratio is that of the faster
//! kind of dual numbers.
//!
//! The declared expression multiplies matrices. Dual numbers are faster in an expression written for them, and that is
//! measured too.

use core::hint::black_box;
use std::time::Instant;

use liestep::groups::{CayleyRetraction, LieGroup as _, Retraction};
use liestep::mechanics::{DiagonalNonstandardInertia, DiscreteLagrangian, Inertia};
use liestep::numbers::Real;
use liestep::{SO3, lagrangian};
use nalgebra::{Matrix3, RealField, RowVector3, Vector3, convert};
use num_dual::{Derivative, DualNum, HyperDual64, HyperDualSVec64};

const STEP: f64 = 0.01;
/// Long enough to hide the clock, short enough that some batches of each kernel meet no other process.
const BATCH: u32 = 200;
const ROUNDS: usize = 1_000;

/// What one iteration and the end of a step need, in the pairs `s`, `t` of the module's page.
#[derive(Clone, Copy)]
struct Derivatives {
    momentum: Vector3<f64>,
    left_momentum: Vector3<f64>,
    jacobian: Matrix3<f64>,
}

/// A Lagrangian on SO(3) with one advected vector.
trait Top<T: Real>: DiscreteLagrangian<Scalar = T, Group = SO3<T>, Advected = Vector3<T>> {}

impl<T: Real, L> Top<T> for L where L: DiscreteLagrangian<Scalar = T, Group = SO3<T>, Advected = Vector3<T>> {}

/// `E_k M`: a permutation of the rows, with a sign.
#[inline(always)]
fn turned_rows(k: usize, m: &Matrix3<f64>) -> Matrix3<f64> {
    let (a, b) = ((k + 1) % 3, (k + 2) % 3);
    Matrix3::from_fn(|i, j| {
        if i == a {
            -m[(b, j)]
        } else if i == b {
            m[(a, j)]
        } else {
            0.0
        }
    })
}

/// `M E_j`.
#[inline(always)]
fn turned_columns(j: usize, m: &Matrix3<f64>) -> Matrix3<f64> {
    let (a, b) = ((j + 1) % 3, (j + 2) % 3);
    Matrix3::from_fn(|i, c| {
        if c == a {
            m[(i, b)]
        } else if c == b {
            -m[(i, a)]
        } else {
            0.0
        }
    })
}

/// `l_d` of a displaced `F` and `w`, in dual numbers.
trait Rival<D>: Fn(&Matrix3<D>, &Vector3<D>) -> D {}

impl<D, L: Fn(&Matrix3<D>, &Vector3<D>) -> D> Rival<D> for L {}

type Vectors = HyperDualSVec64<3, 3>;

/// One evaluation with sixteen parts. Products of displacements are known, so that nothing is multiplied to make `F`.
#[inline(never)]
fn in_vectors(l_d: &impl Rival<Vectors>, at: &Point) -> Derivatives {
    let by_s: [_; 3] = core::array::from_fn(|k| turned_rows(k, &at.f));
    let by_t: [_; 3] = core::array::from_fn(|j| turned_columns(j, &at.f));
    let by_both: [[_; 3]; 3] = core::array::from_fn(|k| core::array::from_fn(|j| turned_columns(j, &by_s[k])));
    let f = Matrix3::from_fn(|row, column| {
        Vectors::new(
            at.f[(row, column)],
            Derivative::some(Vector3::from_fn(|k, _| by_s[k][(row, column)])),
            Derivative::some(RowVector3::from_fn(|_, j| by_t[j][(row, column)])),
            Derivative::some(Matrix3::from_fn(|k, j| by_both[k][j][(row, column)])),
        )
    });
    let turned = SO3::hat(&-at.w);
    let w = Vector3::from_fn(|i, _| {
        let by_s = Derivative::some(turned.row(i).transpose());
        Vectors::new(at.w[i], by_s, Derivative::none(), Derivative::none())
    });
    let value = l_d(&f, &w);
    Derivatives {
        momentum: value.eps1.0.unwrap_or_default(),
        left_momentum: value.eps2.0.unwrap_or_default().transpose(),
        jacobian: value.eps1eps2.0.unwrap_or_default(),
    }
}

/// Nine evaluations with four parts.
#[inline(never)]
fn in_pairs(l_d: &impl Rival<HyperDual64>, at: &Point) -> Derivatives {
    let mut all =
        Derivatives { momentum: Vector3::zeros(), left_momentum: Vector3::zeros(), jacobian: Matrix3::zeros() };
    let turned = SO3::hat(&-at.w);
    for k in 0..3 {
        let by_s = turned_rows(k, &at.f);
        let w = Vector3::from_fn(|i, _| HyperDual64::new(at.w[i], turned[(i, k)], 0.0, 0.0));
        for j in 0..3 {
            let (by_t, by_both) = (turned_columns(j, &at.f), turned_columns(j, &by_s));
            let f = at.f.zip_zip_map(&by_s, &by_t, |f, s, t| HyperDual64::new(f, s, t, 0.0));
            let f = f.zip_map(&by_both, |f, both| HyperDual64::new(f.re, f.eps1, f.eps2, both));
            let value = l_d(&f, &w);
            (all.momentum[k], all.left_momentum[j]) = (value.eps1, value.eps2);
            all.jacobian[(k, j)] = value.eps1eps2;
        }
    }
    all
}

/// Where the kernels are evaluated.
struct Point {
    xi: Vector3<f64>,
    f: Matrix3<f64>,
    w: Vector3<f64>,
    /// The momentum that `F` is sought for.
    momentum: Vector3<f64>,
}

/// The derived step and iteration stages and left momentum: residual and Jacobian up to a factor, in half
/// the coordinates.
#[inline(never)]
fn derived<L: Top<f64>>(top: &L, constants: &L::Constants, at: &Point) -> (Vector3<f64>, Matrix3<f64>, Vector3<f64>) {
    let a = at.momentum + L::kick_before(constants, &at.w);
    let terms = L::step_terms(constants, &a, &at.w);
    let (residual, jacobian) = L::newton_system(constants, &terms, &(at.xi * 0.5));
    (residual, jacobian, top.legendre_plus(&at.f, &at.w, STEP))
}

/// The two kinds of dual numbers against each other and against what is derived.
fn assert_same<L: Top<f64>>(top: &L, at: &Point, duals: &[Derivatives]) {
    let (residual, _, left_momentum) = derived(top, &top.constants(STEP), at);
    let momentum = top.legendre_minus(&at.f, &at.w, STEP);
    // Displacing on the right by `η` is displacing on the left by `Ad_F η = F η`.
    let jacobian = top.momentum_jacobian(&at.f, &at.w, STEP) * at.f;
    for dual in duals {
        assert!((dual.momentum - momentum).norm() < 1e-12 * momentum.norm());
        assert!((dual.left_momentum - left_momentum).norm() < 1e-12 * momentum.norm());
        assert!((dual.jacobian - jacobian).norm() < 1e-12 * jacobian.norm());
        assert!((residual.normalize() - (dual.momentum - at.momentum).normalize()).norm() < 1e-10);
    }
}

fn nanoseconds(mut run: impl FnMut()) -> f64 {
    let start = Instant::now();
    for _ in 0..BATCH {
        run();
    }
    start.elapsed().as_secs_f64() * 1e9 / f64::from(BATCH)
}

fn compare<L: Top<f64>>(name: &str, top: &L, by_vectors: &impl Rival<Vectors>, by_pairs: &impl Rival<HyperDual64>) {
    let xi = Vector3::new(0.01, 0.03, 0.12);
    let f = <CayleyRetraction as Retraction<SO3>>::retract(&xi).matrix();
    let w = Vector3::new(0.0, 0.6, 0.8);
    let at = Point { xi, f, w, momentum: top.legendre_minus(&f, &w, STEP) * 1.01 };
    assert_same(top, &at, &[in_vectors(by_vectors, &at), in_pairs(by_pairs, &at)]);

    let constants = top.constants(STEP);
    let mut times = [f64::INFINITY; 3];
    for _ in 0..ROUNDS {
        times[0] = times[0].min(nanoseconds(|| {
            black_box(derived(black_box(top), black_box(&constants), black_box(&at)));
        }));
        times[1] = times[1].min(nanoseconds(|| {
            black_box(in_vectors(black_box(by_vectors), black_box(&at)));
        }));
        times[2] = times[2].min(nanoseconds(|| {
            black_box(in_pairs(black_box(by_pairs), black_box(&at)));
        }));
    }
    let [derived, vectors, pairs] = times;
    println!("{name:<24}{derived:>12.1}{vectors:>12.1}{pairs:>12.1}{:>12.1}", vectors.min(pairs) / derived);
}

/// (3.13) in principal axes.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
struct HeavyTop<T: Real> {
    J_d: DiagonalNonstandardInertia<T>,
    m: T,
    g: T,
    rho: Vector3<T>,
    up: Vector3<T>,
}

fn heavy_top<T: Real + RealField>() -> HeavyTop<T> {
    let diagonal = Vector3::new(2.0, 2.0, 1.0).map(convert);
    let inertia = DiagonalNonstandardInertia::from_diagonal(diagonal).expect("a body");
    HeavyTop { J_d: inertia, m: T::one(), g: convert(9.81), rho: Vector3::z(), up: Vector3::z() }
}

/// Of the fourth order, as in `examples/declarations/fourth_order_top.rs`; a generic scalar stands to the right of
/// vectors.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let xi = log(F);
        let x = vee(F) * (2.0 / (1.0 + F.trace()).sqrt());
        let next = F.transpose() * w;
        let f = (J * x).cross(&x) / h.powi(2) + (w + next).cross(&rho) * (0.5 * weight);
        xi.dot(&(J * xi)) / (2.0 * h) - 0.5 * h * weight * (w + next).dot(&rho)
            + (h / 12.0) * weight * (next - w).cross(&x).dot(&rho)
            - (h.powi(3) / 24.0) * f.dot(&(inverse(J) * f))
    },
)]
struct FourthOrderTop<T: Real> {
    J: Inertia<T>,
    weight: T,
    rho: Vector3<T>,
    up: Vector3<T>,
}

fn fourth_order_top<T: Real + RealField>() -> FourthOrderTop<T> {
    let inertia = Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0).map(convert)).expect("a body");
    FourthOrderTop { J: inertia, weight: convert(9.81), rho: Vector3::z(), up: Vector3::z() }
}

/// (3.13) with `tr((F − I) J_d (F − I)ᵀ) = Σ_ij (F − I)_ij² (J_d)_jj`.
fn by_entries<D: DualNum<Primitive = f64> + Copy>(top: &HeavyTop<f64>, f: &Matrix3<D>, w: &Vector3<D>) -> D {
    let HeavyTop { J_d: inertia, m, g, rho, .. } = top;
    let (mut kinetic, mut height) = (D::from(0.0), D::from(0.0));
    for i in 0..3 {
        let mut tip = D::from(rho[i]);
        for j in 0..3 {
            let d = if i == j { f[(i, j)] - 1.0 } else { f[(i, j)] };
            kinetic += d * d * inertia.diagonal()[j];
            tip += f[(i, j)] * rho[j];
        }
        height += w[i] * tip;
    }
    kinetic * (0.5 / STEP) - height * (0.5 * STEP * m * g)
}

/// A declared Lagrangian whose own `l_d` is put through dual numbers.
macro_rules! compare_declared {
    ($name:literal, $make:ident) => {
        let (vectors, pairs) = ($make::<Vectors>(), $make::<HyperDual64>());
        compare(
            $name,
            &$make(),
            &|f: &Matrix3<_>, w: &Vector3<_>| black_box(&vectors).l_d(f, w, STEP.into()),
            &|f: &Matrix3<_>, w: &Vector3<_>| black_box(&pairs).l_d(f, w, STEP.into()),
        );
    };
}

fn main() {
    println!("{:<24}{:>12}{:>12}{:>12}{:>12}", "ns", "derived", "in vectors", "in pairs", "ratio");
    compare_declared!("(3.13)", heavy_top);
    let top = heavy_top();
    compare(
        "(3.13), by entries",
        &top,
        &|f: &Matrix3<Vectors>, w: &Vector3<_>| by_entries(black_box(&top), f, w),
        &|f: &Matrix3<HyperDual64>, w: &Vector3<_>| by_entries(black_box(&top), f, w),
    );
    compare_declared!("L4", fourth_order_top);
}
