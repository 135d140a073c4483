//! P5: the flow (2.5) on increments and the flow (2.8) on momenta are one motion, put together by (2.10).

use liestep::groups::LieGroup as _;
use liestep::laws::samples::{Random, along};
use liestep::motion::{DiscreteEulerPoincare, DiscreteLiePoisson, reconstruct};
use nalgebra::{DVector, SVector};

use super::numbers::Numbers as _;
use super::{System, seen_at_random, step};

/// The most by which momenta, parameters and places part in so many steps, relative to their sizes.
///
/// Each step of (2.5) reads the momentum off the increment, and so rounds it to `ε J/h`.
pub fn parting<L: System<N, D> + Clone, const N: usize, const D: usize>(l: &L, h: f64, steps: u32, seed: u64) -> f64 {
    let mut random = Random::new(seed);
    let on_momenta = DiscreteLiePoisson::new(l.clone(), h).unwrap();
    let on_increments = DiscreteEulerPoincare::new(l.clone(), h).unwrap();
    let place = along::<L::Group, N, D>(&random.sample(), 0.5);
    // Not at rest.
    let velocity: SVector<f64, D> = random.sample::<SVector<f64, D>>() * 0.4 + SVector::repeat(0.6);
    let mut f = along::<L::Group, N, D>(&velocity, h);
    let (mut by_momenta, mut by_increments) = (place, place);
    let mut w = seen_at_random(l, &mut random);
    let (mut seen, mut momentum) = (w, l.legendre_minus(&f.matrix(), &w, h));
    let mut worst = 0.0_f64;
    for _ in 0..steps {
        let after = step(&on_momenta, &momentum, &seen);
        by_momenta = by_momenta.advance(&after.increment);
        (momentum, seen) = (after.momentum, after.advected);
        by_increments = reconstruct(&by_increments, &f);
        (f, w) = on_increments.step(&f, &w).unwrap();
        let apart: SVector<f64, D> = l.legendre_minus(&f.matrix(), &w, h) - momentum;
        let (numbers, expected) = (DVector::from_vec(w.numbers()), DVector::from_vec(seen.numbers()));
        let places = by_increments.matrix() - by_momenta.matrix();
        worst = worst
            .max(apart.norm() / (l.inertia(&l.advected()).norm() / h + momentum.norm()))
            .max((numbers - &expected).norm() / (1.0 + expected.norm()))
            .max(places.norm() / by_momenta.matrix().norm());
    }
    worst
}
