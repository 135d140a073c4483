//! The claims about structure, for a Lagrangian on any matrix group with any advected parameters.

pub mod momenta;
pub mod numbers;
pub mod poisson;
pub mod reversal;
pub mod stages;
pub mod symmetry;
pub mod two_flows;

use liestep::groups::Advected as _;
use liestep::laws::samples::{MatrixLieGroup, Random, along};
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::motion::{DiscreteLiePoisson, Increment};
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
///
/// It is within half a unit of each coordinate: where the group stretches, larger parameters make functions of them so
/// steep that differences at a spacing of 10⁻³ miss their derivatives by more than rounding.
pub fn seen_at_random<L: System<N, D>, const N: usize, const D: usize>(
    lagrangian: &L,
    random: &mut Random,
) -> L::Advected {
    lagrangian.advected().seen_from(&along::<L::Group, N, D>(&random.sample(), 0.5))
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

/// A step from the cold guess.
///
/// The flow's own is inlined wherever it is called, with all of the generated code: this is one copy for all claims.
#[inline(never)]
pub fn step<L: System<N, D>, const N: usize, const D: usize>(
    flow: &DiscreteLiePoisson<L>,
    momentum: &SVector<f64, D>,
    w: &L::Advected,
) -> Increment<L> {
    flow.step(momentum, w, &SVector::zeros()).unwrap_or_else(|error| panic!("{error}: {momentum} {w:?}"))
}
