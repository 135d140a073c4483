//! A falling chain of rods on ball joints: a picture of it, and the time of a step.
//!
//! ```text
//! cargo run --release -p liestep-examples --example hanging-chain -- examples/figures/hanging-chain.svg
//! cargo run --release -p liestep-examples --example hanging-chain -- times
//! python examples/hanging-chain/with_mujoco.py           the same chains in MuJoCo, beside these
//! ```
//!
//! The rods of one metre and one kilogram start horizontally. The picture displays them every tenth of a second, and
//! the path of the end. Times are the least of many runs of a thousand steps, as the time of a step depends on the
//! state of the swing; `times 20` times a chain of that length alone.

use std::error::Error;
use std::fmt::Write as _;
use std::time::Instant;

use liestep::methods::{Chain, Link};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3};
use nalgebra::{Matrix3, Vector3};

type Failure = Box<dyn Error>;

/// The step, s.
const STEP: f64 = 0.002;
const LINKS: usize = 20;
/// The steps between two pictures of the chain, and the number of pictures.
const APART: u64 = 50;
const PICTURES: u64 = 26;
/// Pixels per metre, and the position of the pivot in the picture.
const SCALE: f64 = 14.0;
const PIVOT: [f64; 2] = [300.0, 40.0];
const PICTURE: [u32; 2] = [600, 360];

/// Rods that hang along their axes.
fn rods<const N: usize>() -> Result<Chain<N>, Failure> {
    let e = Vector3::z();
    let central = Matrix3::from_diagonal(&Vector3::new(0.005, 0.005, 1.0 / 12.0));
    let inertia = NonstandardInertia::new(central + e * e.transpose() * 0.25)?;
    let link = Link { J_d: inertia, m: 1.0, c: e * -0.5, rho: -e };
    Ok(Chain { links: [link; N], g: 9.81, up: e })
}

/// The picture of one chain every few steps, and the largest energy error.
fn picture() -> Result<(String, f64), Failure> {
    let chain = rods::<LINKS>()?;
    let stepper = chain.stepper(STEP)?;
    let flat = SO3::exp(Vector3::new(0.0, -core::f64::consts::FRAC_PI_2, 0.0));
    let mut state = stepper.start([flat; LINKS], Bodies([Vector3::zeros(); LINKS]))?;
    let (energy, mut off) = (stepper.energy(&state), 0.0_f64);
    let place = |joint: &Vector3<f64>| [PIVOT[0] + SCALE * joint.x, PIVOT[1] - SCALE * joint.z];
    let [width, height] = PICTURE;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" fill=\"none\" \
         stroke-linejoin=\"round\" stroke-linecap=\"round\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
    );
    let mut way = String::new();
    for step in 0..=APART * (PICTURES - 1) {
        if step > 0 {
            stepper.step(&mut state)?;
        }
        let joints = stepper.joints(&state);
        off = off.max((stepper.energy(&state) - energy).abs());
        if step % 5 == 0 {
            let [x, y] = place(&joints[LINKS - 1]);
            write!(way, " {x:.1} {y:.1}")?;
        }
        if step % APART == 0 {
            let mut points = format!("{:.1} {:.1}", PIVOT[0], PIVOT[1]);
            for joint in &joints {
                let [x, y] = place(joint);
                write!(points, " {x:.1} {y:.1}")?;
            }
            // Later pictures are darker.
            let shade = 220 - step / APART * 170 / (PICTURES - 1);
            writeln!(svg, "<path d=\"M{points}\" stroke=\"rgb({shade},{shade},235)\" stroke-width=\"1.6\"/>")?;
        }
    }
    writeln!(svg, "<path d=\"M{}\" stroke=\"#d9730d\" stroke-width=\"1\"/>", way.trim_start())?;
    writeln!(svg, "<circle cx=\"{}\" cy=\"{}\" r=\"3\" fill=\"#333\"/>\n</svg>", PIVOT[0], PIVOT[1])?;
    // The energy of the fall: the weight of all links, from the height of the pivot to hanging down.
    let (mut fall, mut length) = (0.0, 0.0);
    for link in &chain.links {
        fall += chain.g * link.m * (length - link.c.z);
        length -= link.rho.z;
    }
    Ok((svg, off / fall))
}

/// The steps of a timed run, and the number of runs.
const TIMED: u64 = 1000;
const RUNS: usize = 40;

/// Prints the time of a step of this chain, unless another length is requested.
fn time<const N: usize>(h: f64, asked: Option<usize>) -> Result<(), Failure> {
    if asked.is_some_and(|links| links != N) {
        return Ok(());
    }
    let stepper = rods::<N>()?.stepper(h)?;
    let tilted = core::array::from_fn(|k| {
        let phase = if k % 2 == 0 { 0.4 } else { -0.3 };
        SO3::from_euler_angles(phase, 0.5, 0.0)
    });
    let first = stepper.start(tilted, Bodies([Vector3::new(0.1, 0.2, 0.0); N]))?;
    let (mut least, mut iterations) = (f64::INFINITY, 0);
    for _ in 0..RUNS {
        let mut state = first;
        let begin = Instant::now();
        iterations = stepper.run(&mut state, TIMED)?;
        #[allow(clippy::cast_precision_loss)] // a small count
        let of_a_step = begin.elapsed().as_secs_f64() * 1e6 / TIMED as f64;
        least = least.min(of_a_step);
    }
    #[allow(clippy::cast_precision_loss)] // small counts
    let iterations = iterations as f64 / TIMED as f64;
    println!("{N} {h} {least:.3} {iterations:.2}");
    Ok(())
}

fn main() -> Result<(), Failure> {
    let argument = std::env::args().nth(1).ok_or("a file to write is required, as in hanging-chain.svg, or `times`")?;
    if argument == "times" {
        let asked = std::env::args().nth(2).map(|links| links.parse()).transpose()?;
        println!("# links, step s, µs a step, iterations");
        time::<1>(0.01, asked)?;
        time::<2>(0.01, asked)?;
        time::<3>(0.01, asked)?;
        time::<5>(0.01, asked)?;
        time::<10>(0.01, asked)?;
        time::<20>(0.01, asked)?;
        time::<50>(0.005, asked)?;
        return time::<100>(0.005, asked);
    }
    let (svg, off) = picture()?;
    std::fs::write(&argument, svg)?;
    println!("{argument}: {LINKS} rods; the energy is within {off:.1e} of what the fall turns over");
    Ok(())
}
