//! P1: the flow (2.8) is a Poisson map of the semidirect product, `DΦ B(z) DΦᵀ = B(Φ(z))` for `z = (μ, w)`.

use liestep::laws::samples::{MatrixLieGroup, Random, along};
use liestep::{Advected as _, DiscreteLiePoisson, LieGroup};
use nalgebra::{DMatrix, DVector, SVector};

use super::numbers::Numbers;
use super::{System, axis, random_advected, turn};
use crate::common::measure::derivative;

/// `B(z)`, from the brackets of the group and the action on the parameters:
///
/// ```text
/// {μ_k, μ_l} = −⟨μ, [E_k, E_l]⟩,     {μ_k, w} = E_k · w,     {w, w} = 0
/// ```
pub fn tensor<L: System<N, D>, const N: usize, const D: usize>(
    momentum: &SVector<f64, D>,
    w: &L::Advected,
) -> DMatrix<f64> {
    let numbers = DVector::from_vec(w.numbers());
    let mut tensor = DMatrix::zeros(D + numbers.len(), D + numbers.len());
    for k in 0..D {
        for l in 0..D {
            tensor[(k, l)] = -momentum.dot(&L::Group::lie_bracket(&axis(k, 1.0), &axis(l, 1.0)));
        }
        // What an attitude g sees is g⁻¹ · w.
        let moved = derivative(|s| DVector::from_vec(w.seen_from(&turn::<L, N, D>(k, -s)).numbers()));
        for (j, rate) in moved.iter().enumerate() {
            tensor[(k, D + j)] = *rate;
            tensor[(D + j, k)] = -rate;
        }
    }
    tensor
}

fn taken_apart<L: System<N, D>, const N: usize, const D: usize>(z: &DVector<f64>) -> (SVector<f64, D>, L::Advected) {
    (z.fixed_rows::<D>(0).into_owned(), L::Advected::from_numbers(z.iter().skip(D).copied()))
}

fn joined<const D: usize>(momentum: &SVector<f64, D>, w: &impl Numbers) -> DVector<f64> {
    DVector::from_iterator(D + w.numbers().len(), momentum.iter().copied().chain(w.numbers()))
}

/// The largest entry of `DΦ B(z) DΦᵀ − B(Φ(z))` for a step of the flow.
pub fn defect<L: System<N, D>, const N: usize, const D: usize>(
    flow: &DiscreteLiePoisson<L>,
    momentum: &SVector<f64, D>,
    w: &L::Advected,
) -> f64 {
    let step = |momentum: &SVector<f64, D>, w: &L::Advected| {
        let step = flow.step(momentum, w, &SVector::zeros()).unwrap_or_else(|error| panic!("{error}: {momentum}"));
        (step.momentum, step.advected)
    };
    defect_of::<L, N, D>(step, momentum, w)
}

/// The same for any map of momentum and parameters.
pub fn defect_of<L: System<N, D>, const N: usize, const D: usize>(
    map: impl Fn(&SVector<f64, D>, &L::Advected) -> (SVector<f64, D>, L::Advected),
    momentum: &SVector<f64, D>,
    w: &L::Advected,
) -> f64 {
    let z = joined(momentum, w);
    let mut tangent = DMatrix::zeros(z.len(), z.len());
    for k in 0..z.len() {
        let direction = DVector::from_fn(z.len(), |i, _| f64::from(u8::from(i == k)));
        let column = derivative(|t| {
            let (momentum, w) = taken_apart::<L, N, D>(&(&z + &direction * t));
            let (momentum, w) = map(&momentum, &w);
            joined(&momentum, &w)
        });
        tangent.set_column(k, &column);
    }
    let (after, w_after) = map(momentum, w);
    (&tangent * tensor::<L, N, D>(momentum, w) * tangent.transpose() - tensor::<L, N, D>(&after, &w_after)).amax()
}

/// The six-point differences of values near one leave 10⁻¹².
pub const TOLERANCE: f64 = 1e-10;

/// The claim holds for any `w`, not only for those on the orbit of the declared one, and for large steps: at `h = 0.3`
/// the largest turn by some 60°.
pub fn assert_poisson<L, const N: usize, const D: usize>(lagrangian: &L, steps: &[f64], seed: u64)
where
    L: System<N, D> + Clone,
    L::Group: MatrixLieGroup<N, D>,
{
    let mut random = Random::new(seed);
    let mut worst = 0.0_f64;
    for &h in steps {
        let flow = DiscreteLiePoisson::new(lagrangian.clone(), h).unwrap();
        for _ in 0..5 {
            let w = random_advected(lagrangian, &mut random);
            let velocity = random.sample::<SVector<f64, D>>() * 2.0;
            let f = along::<L::Group, N, D>(&velocity, h).matrix();
            worst = worst.max(defect(&flow, &lagrangian.legendre_minus(&f, &w, h), &w));
        }
    }
    println!("{worst:.1e}");
    assert!(worst < TOLERANCE, "{worst:e}");
}
