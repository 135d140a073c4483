//! P5: the flow (2.5) on increments and the flow (2.8) on momenta are one motion, related by (2.10).

use liestep::groups::LieGroup as _;
use liestep::laws::samples::Random;
use liestep::mechanics::inertia;
use liestep::motion::{DiscreteEulerPoincare, DiscreteLiePoisson, reconstruct};

use super::numbers::{from_numbers, numbers};
use super::{Group as _, System, Vector, norm, norm_of_map, seen_at_random, step};

/// The largest relative distances of momenta, parameters and configurations over this number of steps.
///
/// Each step of (2.5) computes the momentum from the increment, and so rounds it to `ε J/h`.
pub fn parting<L: System + Clone>(l: &L, h: f64, steps: u32, seed: u64) -> f64 {
    let mut random = Random::new(seed);
    let on_momenta = DiscreteLiePoisson::new(l.clone(), h).unwrap();
    let on_increments = DiscreteEulerPoincare::new(l.clone(), h).unwrap();
    let place = L::Group::along(&random.sample(), 0.5);
    // The motion doesn't start at rest.
    let velocity: Vector<L> = from_numbers((0..L::Group::DIMENSION).map(|_| 0.4 * random.signed() + 0.6));
    let mut f = L::Group::along(&velocity, h);
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
        let apart = norm(&(l.legendre_minus(&f.matrix(), &w, h) - momentum));
        let inertia = norm_of_map::<L>(&inertia(l, &l.advected()));
        let (place, parameters) = (numbers(&by_momenta.matrix()), numbers(&seen));
        worst = worst
            .max(apart / (inertia / h + norm(&momentum)))
            .max((numbers(&w) - &parameters).norm() / (1.0 + parameters.norm()))
            .max((numbers(&by_increments.matrix()) - &place).norm() / place.norm());
    }
    worst
}
