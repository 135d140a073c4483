//! The step of `−h` undoes that of `h` where `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)`, for parameters off the orbit of the
//! declared ones too.

use liestep::groups::LieGroup as _;
use liestep::laws::samples::{Random, along};
use liestep::motion::DiscreteLiePoisson;
use nalgebra::SVector;

use super::numbers::Numbers as _;
use super::{System, random_advected, step};

/// How far a step of `h` and one of `−h` end from where they started, at random states, relative to these.
pub fn error_of_return<L: System<N, D> + Clone, const N: usize, const D: usize>(
    lagrangian: &L,
    h: f64,
    seed: u64,
) -> f64 {
    let mut random = Random::new(seed);
    let forth = DiscreteLiePoisson::new(lagrangian.clone(), h).unwrap();
    let back = DiscreteLiePoisson::new(lagrangian.clone(), -h).unwrap();
    let mut worst = 0.0_f64;
    for _ in 0..10 {
        let w = random_advected(lagrangian, &mut random);
        let velocity: SVector<f64, D> = random.sample();
        let f = along::<L::Group, N, D>(&velocity, h).matrix();
        let momentum = lagrangian.legendre_minus(&f, &w, h);
        let there = step(&forth, &momentum, &w);
        let returned = step(&back, &there.momentum, &there.advected);
        // Rounding is that of the parts of `μ`, which are of the order of `J/h` times the increment.
        let size = lagrangian.inertia(&lagrangian.advected()).norm() * velocity.norm() + momentum.norm();
        let (numbers, before) = (returned.advected.numbers(), w.numbers());
        let missed: f64 = numbers.iter().zip(&before).map(|(a, b)| (a - b).powi(2)).sum();
        let length: f64 = 1.0 + before.iter().map(|number| number * number).sum::<f64>();
        worst = worst.max((returned.momentum - momentum).norm() / size).max((missed / length).sqrt());
    }
    worst
}
