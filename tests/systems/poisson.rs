//! P1 for every declared system. With `z = (μ, w)` the tensor of a top is `B = [[μ̂, ŵ], [ŵ, 0]]`, and `B = μ̂` where nothing
//! is advected.

use checks::random::Random;
use checks::structure::poisson::tensor;
use checks::structure::{System, poisson};
use declarations::HeavyTop;
use liestep::SO3;
use nalgebra::DMatrix;

use crate::samples::every_system;

fn p1<L: System + Clone>(system: &L, name: &str) {
    print!("{name}: ");
    poisson::assert_poisson(system, &[0.01, 0.1, 0.3], 41);
}

every_system!(p1);

#[test]
fn of_the_thesis() {
    p1(&HeavyTop::thesis(), "the thesis' top");
}

/// The tensor that the claims are made with is that of the thesis.
#[test]
fn tensor_of_so3() {
    let mut random = Random::new(16);
    let (momentum, w) = (random.vector(), random.vector());
    let mut expected = DMatrix::zeros(6, 6);
    expected.view_mut((0, 0), (3, 3)).copy_from(&momentum.cross_matrix());
    expected.view_mut((0, 3), (3, 3)).copy_from(&w.cross_matrix());
    expected.view_mut((3, 0), (3, 3)).copy_from(&w.cross_matrix());
    assert!((tensor::<SO3, _>(&momentum, &w) - expected).amax() < 1e-12);
    assert!((tensor::<SO3, _>(&momentum, &()) - momentum.cross_matrix()).amax() < 1e-12);
}
