//! A ring of rods on ball joints, hung up at one joint and let go: a closed loop; and what a step of joined bodies
//! takes.
//!
//! ```text
//! cargo run --release --example ring-of-links
//! cargo run --release --example ring-of-links -- times          µs a step of chains with joints, and in their minimal form
//! cargo run --release --example ring-of-links -- count 100 50   steps of a chain of a hundred, to count instructions
//! ```

use core::array::from_fn;
use std::error::Error;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::time::Instant;

use liestep::groups::R3;
use liestep::mechanics::{Each, Placed};
use liestep::methods::{BallJoint, Chain, ChainStepper, Joined, Jointed, Joints, Link};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, Stepper};
use nalgebra::{Vector3, Vector6};
use rods::FallingBody;

// The package of all declarations would be built for every example then, also for the first that README runs.
#[allow(dead_code, unreachable_pub)] // others take the rest
#[path = "declarations/rods.rs"]
mod rods;

type Failure = Box<dyn Error>;

/// A rod of one metre and one kilogram, along its x axis.
fn rod() -> Result<FallingBody, Failure> {
    let J_d = NonstandardInertia::from_diagonal(Vector3::new(1.0 / 12.0, 0.005, 0.005))?;
    Ok(FallingBody { m: 1.0, J_d, g: 9.81, up: Vector3::z() })
}

/// Between the ends of two rods, and at the beginning of the first, which hangs at the origin.
fn joint(below: usize) -> Joined<BallJoint> {
    let [left, right] = [-0.5, 0.5].map(|x| Vector3::x() * x);
    match below.checked_sub(1) {
        None => Joined::to_space(BallJoint { above: Vector3::zeros(), below: left }, below),
        Some(above) => Joined::between(BallJoint { above: right, below: left }, above, below),
    }
}

/// A ring is let go from a circle on its edge.
fn ring() -> Result<(), Failure> {
    const N: usize = 16;
    let closing = Joined { above: Some(N - 1), below: 0, ..joint(1) };
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

type Joined3<const N: usize> =
    Stepper<Placed<Each<N>, FallingBody, 1>, Jointed<Placed<Each<N>, FallingBody, 1>, BallJoint, 3, N, N, 0>>;

/// A chain of rods that zigzags downwards, by joints and in its minimal form.
fn chain<const N: usize>(h: f64) -> Result<(Joined3<N>, ChainStepper<N>, [SO3; N]), Failure> {
    let rod = rod()?;
    let joined = Stepper::jointed(Each::<N>::of([rod]), Joints::tree(from_fn(joint)), h)?;
    let c = Vector3::x() * 0.5;
    let about_joint = NonstandardInertia::new(rod.J_d.as_matrix() + c * c.transpose())?;
    let link = Link { J_d: about_joint, m: rod.m, c, rho: Vector3::x() };
    let minimal = Chain { links: [link; N], g: rod.g, up: rod.up }.stepper(h)?;
    let tilted = from_fn(|k| SO3::from_euler_angles(0.0, if k % 2 == 0 { 1.2 } else { 1.7 }, 0.5));
    Ok((joined, minimal, tilted))
}

/// Where the rods are.
fn placed<const N: usize>(attitudes: &[SO3; N]) -> [(SO3, R3); N] {
    let mut end = Vector3::zeros();
    attitudes.map(|attitude| {
        let along = attitude.as_matrix() * Vector3::x();
        end += along;
        (attitude, R3::from(end - along * 0.5))
    })
}

/// How often a short run is timed.
const RUNS: usize = 50;

/// Prints the least times of a step, in turns.
fn time<const N: usize>(h: f64) -> Result<(), Failure> {
    let (joined, minimal, attitudes) = chain::<N>(h)?;
    let first = joined.start(placed(&attitudes), Bodies([Vector6::zeros(); N]))?;
    let other = minimal.start(attitudes, Bodies([Vector3::zeros(); N]))?;
    let steps = (1000 / N).max(10);
    let (mut least, mut iterations) = ([f64::INFINITY; 2], 0);
    #[allow(clippy::cast_precision_loss)] // a small count
    let of_a_step = |begin: Instant| begin.elapsed().as_secs_f64() * 1e6 / steps as f64;
    for _ in 0..RUNS {
        let (mut state, begin) = (first, Instant::now());
        iterations = joined.run(&mut state, steps as u64)?;
        least[0] = least[0].min(of_a_step(begin));
        let (mut state, begin) = (other, Instant::now());
        minimal.run(&mut state, steps as u64)?;
        least[1] = least[1].min(of_a_step(begin));
    }
    #[allow(clippy::cast_precision_loss)] // small counts
    let iterations = iterations as f64 / steps as f64;
    println!("{N:>4} {h:>6} {:>12.3} {:>12.3} {iterations:>11.2}", least[0], least[1]);
    Ok(())
}

/// Makes steps of a chain and nothing else.
fn count<const N: usize>(steps: u64) -> Result<(), Failure> {
    let (joined, _, attitudes) = chain::<N>(0.005)?;
    let mut state = joined.start(placed(&attitudes), Bodies([Vector6::zeros(); N]))?;
    joined.run(&mut state, steps)?;
    println!("{}", state.attitude()[N - 1].1.translation().z);
    Ok(())
}

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => ring(),
        ["times"] => {
            println!("# links, step s, µs a step with joints, in the minimal form, iterations");
            time::<2>(0.01)?;
            time::<10>(0.01)?;
            time::<50>(0.005)?;
            time::<100>(0.005)
        }
        ["count", "10", steps] => count::<10>(steps.parse()?),
        ["count", "100", steps] => count::<100>(steps.parse()?),
        _ => Err("nothing, `times`, or `count` with 10 or 100 links and a number of steps".into()),
    }
}
