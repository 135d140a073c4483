//! The claims about structure, for a Lagrangian on any matrix group with any advected parameters.

pub mod momenta;
pub mod numbers;
pub mod poisson;
pub mod reversal;
pub mod stages;
pub mod symmetry;

use liestep::laws::samples::{MatrixLieGroup, Random, along};
use liestep::{Advected as _, DiscreteLagrangian, Regular};
use nalgebra::SVector;

use numbers::Numbers;

/// A Lagrangian over `f64` on a group of `N` × `N` matrices of dimension `D`.
pub trait System<const N: usize, const D: usize>:
    DiscreteLagrangian<Scalar = f64, Group: MatrixLieGroup<N, D>, Advected: Numbers> + Regular
{
}

impl<L, const N: usize, const D: usize> System<N, D> for L where
    L: DiscreteLagrangian<Scalar = f64, Group: MatrixLieGroup<N, D>, Advected: Numbers> + Regular
{
}

/// `s` along the `k`th axis.
pub fn axis<const D: usize>(k: usize, s: f64) -> SVector<f64, D> {
    SVector::from_fn(|i, _| if i == k { s } else { 0.0 })
}

/// `exp(s E_k)`.
pub fn turn<L: System<N, D>, const N: usize, const D: usize>(k: usize, s: f64) -> L::Group {
    along::<L::Group, N, D>(&axis(k, s), 1.0)
}

/// The declared parameters seen from a random attitude.
pub fn seen_at_random<L: System<N, D>, const N: usize, const D: usize>(
    lagrangian: &L,
    random: &mut Random,
) -> L::Advected {
    lagrangian.advected().seen_from(&random.element::<L::Group, N, D>())
}

/// The same, each number off by up to a tenth: not on the orbit of the declared value, and not near a singularity of
/// the potential that this keeps away from.
pub fn random_advected<L: System<N, D>, const N: usize, const D: usize>(
    lagrangian: &L,
    random: &mut Random,
) -> L::Advected {
    let seen = seen_at_random(lagrangian, random).numbers();
    L::Advected::from_numbers(seen.into_iter().map(|number| number + 0.1 * random.signed()))
}
