//! A ring of rods on ball joints, suspended at one joint and released: a closed loop.
//!
//! ```text
//! cargo run --release -p liestep-examples --example ring-of-links
//! ```

use std::error::Error;
use std::f64::consts::{FRAC_PI_2, TAU};

use liestep::groups::R3;
use liestep::methods::{Joint, Multibody};
use liestep::{NonstandardInertia, SO3};
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

/// The ring is released from a vertical circle. It hangs at the origin by the beginning of its first rod.
fn main() -> Result<(), Box<dyn Error>> {
    const N: usize = 16;
    let [left, right] = [-0.5, 0.5].map(|x| Vector3::x() * x);
    let mut ring = Multibody::new();
    for _ in 0..N {
        ring.body(rod()?);
    }
    ring.join(Joint::ball([Vector3::zeros(), left]), None, 0);
    for above in 0..N {
        ring.join(Joint::ball([right, left]), Some(above), (above + 1) % N);
    }
    let stepper = ring.stepper(0.002)?;
    #[allow(clippy::cast_precision_loss)] // a small count
    let turns: [f64; N] = std::array::from_fn(|k| TAU * (k as f64 + 0.5) / N as f64 - FRAC_PI_2);
    let mut corner = Vector3::zeros();
    let about = turns.map(|turn| {
        let attitude = SO3::exp(Vector3::y() * turn);
        let along = attitude.as_matrix() * Vector3::x();
        corner += along;
        (attitude, R3::from(corner - along * 0.5))
    });
    let mut state = stepper.start_nearest(&about, &[Vector6::zeros(); N])?;
    let energy = stepper.energy(&state);
    println!("{:>6} {:>16} {:>12} {:>10}", "t, s", "opposite, m", "energy, J", "gap, m");
    for quarter in 0..=10 {
        let opposite = stepper.attitude(&state, N / 2).1.translation();
        let off = stepper.energy(&state) - energy;
        let time = f64::from(quarter) * 0.5;
        println!("{time:6.1} {:16.4} {off:12.1e} {:10.1e}", opposite.z, stepper.widest_gap(&state));
        stepper.run(&mut state, 250)?;
    }
    Ok(())
}
