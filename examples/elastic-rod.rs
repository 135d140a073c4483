//! An elastic rod as a row of bodies whose potential is evaluated in the middle of a step, compared with the same rod
//! with halves of its potential at both ends.
//!
//! ```text
//! cargo run --release -p liestep-examples --example elastic-rod            the energy errors of both, by the length of the step
//! cargo run --release -p liestep-examples --example elastic-rod -- times   µs a step, and ns a body, of rows of 10 to 100 bodies
//! ```

use core::array::from_fn;
use std::error::Error;
use std::time::Instant;

use liestep::groups::R3;
use liestep::mechanics::{Along, Coupling, Each, Placement, Regular};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use nalgebra::{Vector3, Vector6};
use rods::{FloatingBody, RodElement};

// A dependency on the package of all declarations would be built for every example, even for the first of README.
#[allow(dead_code, unreachable_pub)] // the other examples use the rest
#[path = "declarations/rods.rs"]
mod rods;

type Failure = Box<dyn Error>;
type Body = (SO3, R3);

/// The potential of a [`RodElement`], up to terms of higher order in the bending, by the mean of the potentials at both
/// ends of a step.
#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(
        R_1 = F_1.seen_from(space),
        R_2 = F_2.seen_from(space),
        Q = F_2.seen_from(F_1),
        r = d_2.seen_from(d_1),
    ),
    l_d = -0.25 * h * k * ((r + R_2 * b - R_1 * a).norm_squared()
            + (r + d_2 - d_1 + R_2 * F_2 * b - R_1 * F_1 * a).norm_squared())
        + 0.25 * h * c * (Q.trace() + (F_1.transpose() * Q * F_2).trace() - 6.0),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ends {
    k: f64,          // N/m
    c: f64,          // N m
    a: Vector3<f64>, // of the one, from its centre of mass, in its frame, m
    b: Vector3<f64>, // of the next, likewise
}

/// The stiffnesses against shifts, N/m, and against turns, N m.
const STIFF: (f64, f64) = (1e6, 20.0);
/// Half the length of a piece of one metre and one kilogram, m.
const HALF: Vector3<f64> = Vector3::new(0.5, 0.0, 0.0);

/// The longest stable step with the potential at both ends, `2/ω`. A wave `exp(iqn)` of shifts across the rod and of
/// turns has `ω² = 4 (k/m)(sin²(q/2) + 3 cos²(q/2))` with an inertia of `m l²/12`; one of turns along it has less.
fn bound() -> f64 {
    2.0 / (12.0 * STIFF.0).sqrt()
}

fn pieces<const N: usize>() -> Result<Placement<Each<N>, FloatingBody, 1>, Failure> {
    let J_d = NonstandardInertia::from_diagonal(Vector3::new(1.0 / 12.0, 1e-3, 1e-3))?;
    Ok(Each::<N>::of([FloatingBody { m: 1.0, J_d }]))
}

fn middle<const N: usize>() -> Result<impl Rod<N>, Failure> {
    let (k, c) = STIFF;
    Ok(pieces::<N>()? + Coupling::<N>::of([RodElement { k, c, a: HALF, b: -HALF }]))
}

fn ends<const N: usize>() -> Result<impl Rod<N>, Failure> {
    let (k, c) = STIFF;
    Ok(pieces::<N>()? + Along::<N>::of([Ends { k, c, a: HALF, b: -HALF }]))
}

trait Rod<const N: usize>: Regular<Scalar = f64, Group = [Body; N]> {}

impl<L: Regular<Scalar = f64, Group = [Body; N]>, const N: usize> Rod<N> for L {}

/// A coil, each piece turned against the one before, that rotates about a perpendicular axis.
fn coil<const N: usize>() -> ([Body; N], Bodies<Vector6<f64>, N>) {
    let (mut corner, omega) = (Vector3::zeros(), Vector3::new(0.3, 0.2, 1.0));
    #[allow(clippy::cast_precision_loss)] // small counts
    let pieces = from_fn(|k| {
        let attitude = SO3::exp(Vector3::new(0.1, 0.05, 0.2) * k as f64);
        let half = attitude.as_matrix() * HALF;
        corner += half * 2.0;
        (attitude, R3::from(corner - half))
    });
    let moving = pieces.map(|(attitude, place): Body| {
        let (turn, shift) = (attitude.as_matrix().tr_mul(&omega), omega.cross(&place.translation()));
        Vector6::from_fn(|k, _| if k < 3 { turn[k] } else { shift[k - 3] })
    });
    (pieces, Bodies(moving))
}

/// The largest relative energy error; if a step fails, its time and its error.
fn energy_off<const N: usize>(rod: impl Rod<N>, h: f64) -> Result<String, Failure> {
    const DURATION: f64 = 1.0; // s
    let stepper = Stepper::new(rod, h)?;
    let (places, velocities) = coil::<N>();
    let mut state = stepper.start(places, velocities)?;
    let (energy, mut off) = (stepper.energy(&state), 0.0_f64);
    while stepper.time(&state) < DURATION {
        if let Err(error) = stepper.step(&mut state) {
            return Ok(format!("{off:.1e} until {:.4} s: {error}", stepper.time(&state)));
        }
        let now = (stepper.energy(&state) / energy - 1.0).abs();
        if now.is_nan() {
            return Ok(format!("{off:.1e} until {:.4} s: the energy isn't a number", stepper.time(&state)));
        }
        off = off.max(now);
    }
    Ok(format!("{off:.1e}"))
}

fn kept() -> Result<(), Failure> {
    println!("{:>12} {:>12} {:>12}", "h ω/2", "in the middle", "at the ends");
    for part in [0.1, 0.5, 0.9, 1.1, 3.0, 10.0] {
        let h = part * bound();
        println!("{part:>12} {:>12} {:>12}", energy_off(middle::<6>()?, h)?, energy_off(ends::<6>()?, h)?);
    }
    Ok(())
}

/// The number of timed runs, and the steps of each. The same number of steps comes before the timing, because the first
/// step differs from later ones.
const RUNS: usize = 30;
const STEPS: u32 = 100;

/// The least time of a step in µs, and its iterations.
fn time<const N: usize>(rod: impl Rod<N>, h: f64) -> Result<(f64, f64), Failure> {
    let stepper = Stepper::new(rod, h)?;
    let (places, velocities) = coil::<N>();
    let mut first = stepper.start(places, velocities)?;
    stepper.run(&mut first, STEPS.into())?;
    let (mut least, mut iterations) = (f64::INFINITY, 0);
    for _ in 0..RUNS {
        let (mut state, begin) = (first, Instant::now());
        iterations = stepper.run(&mut state, STEPS.into())?;
        least = least.min(begin.elapsed().as_secs_f64());
    }
    #[allow(clippy::cast_precision_loss)] // small counts
    Ok((least * 1e6 / f64::from(STEPS), iterations as f64 / f64::from(STEPS)))
}

/// Prints the times of a step: in the middle at ten times the longest step of the other, and of that at half of it.
fn times<const N: usize>() -> Result<(), Failure> {
    let [middle, ends] = [time(middle::<N>()?, 10.0 * bound())?, time(ends::<N>()?, 0.5 * bound())?];
    #[allow(clippy::cast_precision_loss)] // a small count
    let of_a_body = |(step, _): (f64, f64)| step * 1e3 / N as f64;
    println!(
        "{N:>6} {:>10.1} {:>10.0} {:>6.2} {:>12.2} {:>10.0} {:>6.2}",
        middle.0,
        of_a_body(middle),
        middle.1,
        ends.0,
        of_a_body(ends),
        ends.1
    );
    Ok(())
}

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => kept(),
        ["times"] => {
            println!("# bodies; in the middle: µs a step, ns a body, iterations; at the ends: the same");
            times::<10>()?;
            times::<20>()?;
            times::<50>()?;
            times::<100>()
        }
        _ => Err("nothing, or `times`".into()),
    }
}
