//! The flow (2.8) is a Poisson map of the semidirect product: `DΦ B(z) DΦᵀ = B(Φ(z))` for `z = (μ, w)` with
//! `B = [[μ̂, ŵ], [ŵ, 0]]`, and `B = μ̂` where nothing is advected.

mod common;

use common::measure::derivative;
use common::random::Random;
use common::tops::{FreeBody, FullTop, HeavyTop};
use liestep::{DiscreteLagrangian, DiscreteLiePoisson, Regular, SO3};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// The six-point differences of values near one leave 10⁻¹².
const TOLERANCE: f64 = 1e-10;

/// The largest entry of `DΦ B(z) DΦᵀ − B(Φ(z))`.
fn defect<const N: usize>(
    flow: impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
    tensor: impl Fn(&SVector<f64, N>) -> SMatrix<f64, N, N>,
    z: &SVector<f64, N>,
) -> f64 {
    let mut tangent = SMatrix::<f64, N, N>::zeros();
    for k in 0..N {
        let direction = SVector::<f64, N>::from_fn(|i, _| f64::from(u8::from(i == k)));
        tangent.set_column(k, &derivative(|t| flow(&(z + direction * t))));
    }
    (tangent * tensor(z) * tangent.transpose() - tensor(&flow(z))).amax()
}

fn halves(z: &SVector<f64, 6>) -> (Vector3<f64>, Vector3<f64>) {
    (z.fixed_rows::<3>(0).into_owned(), z.fixed_rows::<3>(3).into_owned())
}

fn semidirect(z: &SVector<f64, 6>) -> SMatrix<f64, 6, 6> {
    let (momentum, w) = halves(z);
    let mut tensor = SMatrix::<f64, 6, 6>::zeros();
    tensor.fixed_view_mut::<3, 3>(0, 0).copy_from(&momentum.cross_matrix());
    tensor.fixed_view_mut::<3, 3>(0, 3).copy_from(&w.cross_matrix());
    tensor.fixed_view_mut::<3, 3>(3, 0).copy_from(&w.cross_matrix());
    tensor
}

/// The claim holds for any `w`, not only for unit vectors, and for large steps: the largest here turns by about 60°.
fn assert_poisson_with_vector<L>(lagrangian: &L, seed: u64)
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Regular + Clone,
{
    let mut random = Random::new(seed);
    let mut worst = 0.0_f64;
    for h in [0.01, 0.1, 0.3] {
        let flow = DiscreteLiePoisson::new(lagrangian.clone(), h).unwrap();
        let map = |z: &SVector<f64, 6>| {
            let (momentum, w) = halves(z);
            let step = flow.step(&momentum, &w, &Vector3::zeros()).unwrap();
            SVector::<f64, 6>::from_fn(|i, _| if i < 3 { step.momentum[i] } else { step.advected[i - 3] })
        };
        for _ in 0..10 {
            let z = SVector::<f64, 6>::from_fn(|i, _| random.signed() * if i < 3 { 2.0 } else { 1.0 });
            worst = worst.max(defect(map, semidirect, &z));
        }
    }
    println!("{worst:.1e}");
    assert!(worst < TOLERANCE, "{worst:e}");
}

#[test]
fn p1_tops() {
    assert_poisson_with_vector(&HeavyTop::thesis(), 11);
    assert_poisson_with_vector(&HeavyTop::asymmetric(), 12);
}

#[test]
fn p1_tops_with_a_full_inertia_tensor() {
    let axes = Random::new(13).rotation();
    assert_poisson_with_vector(&FullTop::in_axes(&HeavyTop::asymmetric(), axes.as_matrix()), 14);
}

#[test]
fn p1_free_bodies() {
    let mut random = Random::new(15);
    for h in [0.01, 0.1, 0.3] {
        let flow = DiscreteLiePoisson::new(FreeBody::with_moments([2.0, 3.0, 4.5]), h).unwrap();
        let map = |z: &Vector3<f64>| flow.step(z, &(), &Vector3::zeros()).unwrap().momentum;
        for _ in 0..10 {
            let defect =
                defect(map, Vector3::cross_matrix as fn(&Vector3<f64>) -> Matrix3<f64>, &(random.vector() * 3.0));
            assert!(defect < TOLERANCE, "{defect:e}");
        }
    }
}
