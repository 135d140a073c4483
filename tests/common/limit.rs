//! The continuous limit of a declared system, from its `l_d` alone: `l(ξ, w) = lim l_d(exp hξ, w)/h`, its momentum
//! (1.14), and its energy (1.16), whose derivative is the velocity.

use liestep::Stepper;
use liestep::groups::LieGroup as _;
use liestep::laws::samples::Random;
use liestep::mechanics::inertia;
use liestep::numbers::Coordinates as _;

use crate::structure::{Group as _, System, Vector, axis, gradient, norm, norm_of_map};

/// The error of the limit, and that of its differences over a spacing of 10⁻³.
const LIMIT: f64 = 1e-9;
const DIFFERENCES: f64 = 1e-6;

/// The value at zero of a polynomial through values at `h`, `h/2`, `h/4`, … (Neville).
fn limit(value: impl Fn(f64) -> f64) -> f64 {
    let mut table: Vec<f64> = (0..6).map(|k| value(0.04 / f64::from(1 << k))).collect();
    for level in 1..table.len() {
        for i in (level..table.len()).rev() {
            table[i] += (table[i] - table[i - 1]) / f64::from((1 << level) - 1);
        }
    }
    table[table.len() - 1]
}

pub fn assert_limit<L: System + Clone>(system: &L, name: &str) {
    let mut random = Random::new(16);
    let stepper = Stepper::new(system.clone(), 0.01).unwrap();
    let (attitude, velocity) = (L::Group::along(&random.sample(), 0.3), random.sample());
    let state = stepper.start(attitude, velocity).unwrap();
    let (momentum, w) = (state.momentum(), state.advected());
    let l = |xi: Vector<L>| limit(|h| system.l_d(&L::Group::along(&xi, h).matrix(), &w, h) / h);
    let scale = norm_of_map::<L>(&inertia(system, &w)) + system.limit(None, &w).l.abs() + norm(&momentum);

    let missed = norm(&(gradient::<L>(&|k, t| l(velocity + axis(k, t))) - momentum)) / scale;
    let legendre = (stepper.energy(&state) - (momentum.dot(&velocity) - l(velocity))).abs() / scale;
    println!("{name}: (1.14) {missed:.1e}, (1.16) {legendre:.1e}");
    assert!(missed < DIFFERENCES, "{name}: μ = δl/δξ, (1.14): off by {missed:e}");
    assert!(legendre < LIMIT, "{name}: h = μ·ξ − l, (1.16): off by {legendre:e}");

    let h = |momentum| stepper.energy(&stepper.start_with_momentum(attitude, momentum).unwrap());
    let missed = norm(&(gradient::<L>(&|k, t| h(momentum + axis(k, t))) - stepper.velocity(&state)));
    assert!(missed < LIMIT * scale, "{name}: δh/δμ = ξ: off by {missed:e}");
}
