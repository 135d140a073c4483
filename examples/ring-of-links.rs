//! A ring of rods on ball joints, suspended at one joint and released: a closed loop.
//!
//! ```text
//! cargo run --release -p liestep-examples --example ring-of-links
//! ```

use core::array::from_fn;
use std::error::Error;
use std::f64::consts::{FRAC_PI_2, TAU};

use liestep::groups::R3;
use liestep::mechanics::Each;
use liestep::methods::{BallJoint, Joints, PlacedJoint};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, Stepper};
use nalgebra::{Vector3, Vector6};
use rods::FallingBody;

// A dependency on the package of all declarations would be built for every example, even for the first of README.
#[allow(dead_code, unreachable_pub)] // the other examples use the rest
#[path = "declarations/rods.rs"]
mod rods;

/// A rod of one metre and one kilogram, along its x axis.
fn rod() -> Result<FallingBody, Box<dyn Error>> {
    let J_d = NonstandardInertia::from_diagonal(Vector3::new(1.0 / 12.0, 0.005, 0.005))?;
    Ok(FallingBody { m: 1.0, J_d, g: 9.81, up: Vector3::z() })
}

/// A joint between the ends of two rods, or at the beginning of the first, which hangs at the origin.
fn joint(below: usize) -> PlacedJoint<BallJoint> {
    let [left, right] = [-0.5, 0.5].map(|x| Vector3::x() * x);
    match below.checked_sub(1) {
        None => PlacedJoint::to_space(BallJoint { above: Vector3::zeros(), below: left }, below),
        Some(above) => PlacedJoint::between(BallJoint { above: right, below: left }, above, below),
    }
}

/// The ring is released from a vertical circle.
fn main() -> Result<(), Box<dyn Error>> {
    const N: usize = 16;
    let closing = PlacedJoint { above: Some(N - 1), below: 0, ..joint(1) };
    let joints = Joints::tree(from_fn::<_, N, _>(joint)).closed_by([closing]);
    let stepper = Stepper::jointed(Each::<N>::of([rod()?]), joints, 0.002)?;
    #[allow(clippy::cast_precision_loss)] // a small count
    let turns = from_fn::<_, N, _>(|k| TAU * (k as f64 + 0.5) / N as f64 - FRAC_PI_2);
    let mut corner = Vector3::zeros();
    let about = turns.map(|turn| {
        let attitude = SO3::exp(Vector3::y() * turn);
        let along = attitude.as_matrix() * Vector3::x();
        corner += along;
        (attitude, R3::from(corner - along * 0.5))
    });
    let mut state = stepper.start_nearest(about, Bodies([Vector6::zeros(); N]))?;
    let energy = stepper.energy(&state);
    println!("{:>6} {:>16} {:>12} {:>10}", "t, s", "opposite, m", "energy, J", "gap, m");
    for _ in 0..=10 {
        let opposite = state.attitude()[N / 2].1.translation();
        let off = stepper.energy(&state) - energy;
        println!("{:6.1} {:16.4} {off:12.1e} {:10.1e}", stepper.time(&state), opposite.z, stepper.widest_gap(&state));
        stepper.run(&mut state, 250)?;
    }
    Ok(())
}
