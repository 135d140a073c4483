//! P5 for every declared system: the flow on increments and the flow on momenta are one motion.

use checks::structure::{System, two_flows};

use crate::samples::every_system;

/// Of 30 steps; the worst leaves 1.5e-14.
const ROUNDING: f64 = 1e-13;

fn p5<L: System + Clone>(system: &L, name: &str) {
    let parting = two_flows::parting(system, 0.01, 30, 44);
    println!("{name}: the flows (2.5) and (2.8) part by {parting:.1e}");
    assert!(parting < ROUNDING, "{name}: the flows (2.5) and (2.8) part by {parting:e}");
}

every_system!(p5);
