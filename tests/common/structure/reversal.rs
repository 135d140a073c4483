//! A step of `−h` undoes one of `h` if `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)`, also for parameters off the orbit of the
//! declared ones.

use liestep::groups::LieGroup as _;
use liestep::laws::samples::Random;
use liestep::mechanics::inertia;
use liestep::motion::DiscreteLiePoisson;

use super::numbers::numbers;
use super::{Group as _, System, norm, norm_of_map, random_advected, step};

/// The relative distance from the start after a step of `h` and one of `−h`, at random states.
pub fn error_of_return<L: System + Clone>(lagrangian: &L, h: f64, seed: u64) -> f64 {
    let mut random = Random::new(seed);
    let forth = DiscreteLiePoisson::new(lagrangian.clone(), h).unwrap();
    let back = DiscreteLiePoisson::new(lagrangian.clone(), -h).unwrap();
    let mut worst = 0.0_f64;
    for _ in 0..10 {
        let w = random_advected(lagrangian, &mut random);
        let velocity = random.sample();
        let f = L::Group::along(&velocity, h).matrix();
        let momentum = lagrangian.legendre_minus(&f, &w, h);
        let there = step(&forth, &momentum, &w);
        let returned = step(&back, &there.momentum, &there.advected);
        // The rounding error is that of the terms of `μ`, which are of the order of `J/h` times the increment.
        let inertia = norm_of_map::<L>(&inertia(lagrangian, &lagrangian.advected()));
        let size = inertia * norm(&velocity) + norm(&momentum);
        let before = numbers(&w);
        let missed = (numbers(&returned.advected) - &before).norm();
        worst = worst.max(norm(&(returned.momentum - momentum)) / size).max(missed / before.norm().hypot(1.0));
    }
    worst
}
