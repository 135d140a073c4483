//! P1 for tops and free bodies: with `z = (μ, w)` the tensor is `B = [[μ̂, ŵ], [ŵ, 0]]`, and `B = μ̂` where nothing is
//! advected. `tests/systems/poisson.rs` has the other declarations.

use checks::random::Random;
use checks::structure::poisson::{assert_poisson, tensor};
use declarations::{FreeBody, FullTop, HeavyTop};
use nalgebra::DMatrix;

const STEPS: [f64; 3] = [0.01, 0.1, 0.3];

/// The tensor that the claims are made with is that of the thesis.
#[test]
fn p1_tensor_of_so3() {
    let mut random = Random::new(16);
    let (momentum, w) = (random.vector(), random.vector());
    let mut expected = DMatrix::zeros(6, 6);
    expected.view_mut((0, 0), (3, 3)).copy_from(&momentum.cross_matrix());
    expected.view_mut((0, 3), (3, 3)).copy_from(&w.cross_matrix());
    expected.view_mut((3, 0), (3, 3)).copy_from(&w.cross_matrix());
    assert!((tensor::<HeavyTop, 3, 3>(&momentum, &w) - expected).amax() < 1e-12);
    assert!((tensor::<FreeBody, 3, 3>(&momentum, &()) - momentum.cross_matrix()).amax() < 1e-12);
}

#[test]
fn p1_tops() {
    assert_poisson(&HeavyTop::thesis(), &STEPS, 11);
    assert_poisson(&HeavyTop::asymmetric(), &STEPS, 12);
}

#[test]
fn p1_tops_with_a_full_inertia_tensor() {
    let axes = Random::new(13).rotation();
    assert_poisson(&FullTop::in_axes(&HeavyTop::asymmetric(), axes.as_matrix()), &STEPS, 14);
}

#[test]
fn p1_free_bodies() {
    assert_poisson(&FreeBody::with_moments([2.0, 3.0, 4.5]), &STEPS, 15);
}
