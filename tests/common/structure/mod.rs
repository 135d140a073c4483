//! The claims about structure, for a Lagrangian on any group with any advected parameters.

pub mod equations;
pub mod forces;
pub mod momenta;
pub mod numbers;
pub mod placed;
pub mod poisson;
pub mod reversal;
pub mod stages;
pub mod symmetry;
pub mod symplectic;
pub mod two_flows;

use liestep::groups::{Advected as _, ExponentialRetraction, LieGroup, Retraction};
use liestep::laws::samples::{Random, derivative};
use liestep::mechanics::{DiscreteLagrangian, Regular, Term};
use liestep::motion::{DiscreteLiePoisson, Increment};
use liestep::numbers::Coordinates;

use numbers::{from_numbers, numbers};

/// A group over `f64` with an exponential.
pub trait Group: LieGroup<Scalar = f64> {
    /// The element `exp(t ξ̂)`.
    fn along(xi: &Self::Vector, t: f64) -> Self;

    /// The element `exp(s E_k)`.
    fn turn(k: usize, s: f64) -> Self {
        Self::along(&axis(k, s), 1.0)
    }
}

impl<G: LieGroup<Scalar = f64>> Group for G
where
    ExponentialRetraction: Retraction<G>,
{
    fn along(xi: &G::Vector, t: f64) -> G {
        ExponentialRetraction::retract(&(*xi * t))
    }
}

/// A Lagrangian over `f64`.
pub trait System: DiscreteLagrangian<Scalar = f64, Group: Group> + Regular {}

impl<L: DiscreteLagrangian<Scalar = f64, Group: Group> + Regular> System for L {}

/// Components of velocities and of momenta.
pub type Vector<L> = <<L as Term>::Group as LieGroup>::Vector;

/// The vector `s` along the `k`th axis.
pub fn axis<V: Coordinates<f64>>(k: usize, s: f64) -> V {
    V::axis(k) * s
}

/// The length of a vector of components.
pub fn norm<V: Coordinates<f64>>(components: &V) -> f64 {
    components.dot(components).sqrt()
}

/// The Frobenius norm of a map of components; for several bodies that of its blocks.
pub fn norm_of_map<L: Term<Scalar = f64>>(map: &<Vector<L> as Coordinates<f64>>::Square) -> f64 {
    (0..L::Group::DIMENSION).map(|k| norm(&Vector::<L>::column(map, k))).fold(0.0, f64::hypot)
}

/// The derivatives at zero along each axis.
pub fn gradient<L: Term<Scalar = f64>>(value: &dyn Fn(usize, f64) -> f64) -> Vector<L> {
    from_numbers((0..L::Group::DIMENSION).map(|k| derivative(|s| value(k, s))))
}

/// The declared parameters in the frame of a random attitude.
///
/// The attitude is within half a unit of each coordinate: on a group that stretches, larger parameters lead to
/// functions so steep that differences at a spacing of 10⁻³ have errors above rounding.
pub fn seen_at_random<L: Term<Scalar = f64, Group: Group>>(lagrangian: &L, random: &mut Random) -> L::Advected {
    lagrangian.advected().seen_from(&L::Group::along(&random.sample(), 0.5))
}

/// Parameters near those of a random attitude, each number changed by up to a tenth: off the orbit of the declared
/// value, but away from singularities of the potential. For several bodies they are on the orbit, because derivations
/// assume that relative attitudes are rotations.
pub fn random_advected<L: Term<Scalar = f64, Group: Group>>(lagrangian: &L, random: &mut Random) -> L::Advected {
    let seen = seen_at_random(lagrangian, random);
    if L::Group::BODIES > 1 || !L::Group::FACTORS.is_whole() {
        return seen;
    }
    from_numbers(numbers(&seen).iter().map(|number| number + 0.1 * random.signed()))
}

/// A step from a guess of zero.
///
/// The flow's own function is inlined at each call, with all of the generated code; this is one copy for all claims.
#[inline(never)]
pub fn step<L: System>(flow: &DiscreteLiePoisson<L>, momentum: &Vector<L>, w: &L::Advected) -> Increment<L> {
    flow.step(momentum, w, &Vector::<L>::zero()).unwrap_or_else(|error| panic!("{error}: {momentum:?} {w:?}"))
}
