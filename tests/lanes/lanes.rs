//! Steps a second of eight heavy tops (3.13) on one core: one after another, and in SIMD lanes. `lanes_of_systems.rs`
//! measures several bodies.
//!
//! ```text
//! cargo bench --bench lanes                                    scalars by the target's common instructions
//! RUSTFLAGS="-C target-cpu=native" cargo bench --bench lanes   scalars by the instructions of this machine
//! cargo bench --bench lanes -- instructions                    fails if a step in lanes exceeds its limit
//! cargo bench --bench lanes -- count f64-lanes 1000            1000 steps of all tops by one kernel, nothing else
//! ```
//!
//! The kernels for `count` are `f64`, `f64-lanes`, `f32`, `f32-lanes` and `chain`, a chain of ten links; valgrind
//! counts their instructions. A step of lanes is dispatched to the machine's instructions, whatever it was compiled
//! for, but types of lanes differ in their use. Types of simba that are arrays depend on the compiler, which puts most
//! of `AutoF64x8` into registers of four `f64` if there is AVX2, and less of narrower types. `WideF64x4` and
//! `WideF32x8` are pairs of registers of x86-64's common instructions, two `f64` or four `f32` each, unless the program
//! is compiled for more; AVX then only saves moves between registers. `vectors.rs` measures the gain of each kind of
//! registers.
//!
//! The bodies, tilts and spins of the tops vary about the looping case of \[RDAE, figure 3.8\], `h = 0.01 s`. All
//! kernels make the same steps, which is asserted before the timing, and take turns within one run. The fastest batch
//! of each counts: other load of the machine only slows, and affects longer batches more often, so that medians would
//! favour the lanes.

#[path = "../benches/counting.rs"]
mod counting;
mod eight_tops;

use core::hint::black_box;
use std::time::Instant;

use liestep::methods::{Chain, Link};
use liestep::numbers::{Bodies, Lanes as _, Real};
use liestep::prelude::*;
use nalgebra::{RealField, Vector3};
use simba::simd::{AutoF64x8, WideF32x8, WideF64x4};

use counting::{Uncounted, instructions};
use eight_tops::{TOPS, Top, top};

/// Steps of each top in a batch: well below a slice of the scheduler's time, so that some batches of each kernel aren't
/// interrupted.
const BATCH: u32 = 500;
const ROUNDS: usize = 4_000;

type Running<T> = (Stepper<Top<T>>, State<SO3<T>, Vector3<T>>);

/// The tops from `first` on, one in each lane.
fn lanes<T: Real<Element: Real + RealField>>(first: usize) -> Running<T> {
    let (wide, attitude, velocity) = eight_tops::lanes::<T>(first);
    let stepper = Stepper::new(wide, nalgebra::convert(0.01)).expect("a usable step");
    let state = stepper.start(attitude, velocity).expect("a usable start");
    (stepper, state)
}

fn single<E: Real + RealField>(number: usize) -> Running<E> {
    let (top, attitude, velocity) = top(number);
    let stepper = Stepper::new(top, nalgebra::convert(0.01)).expect("a usable step");
    let state = stepper.start(attitude, velocity).expect("a usable start");
    (stepper, state)
}

#[inline(never)]
fn run<T: Real, const N: usize>(ensemble: &mut [Running<T>; N], steps: u32) {
    for _ in 0..steps {
        for (stepper, state) in &mut *ensemble {
            stepper.step(state).expect("a solvable step");
        }
    }
}

/// Steps each top a thousand times and compares with the scalars, whose bits the lanes must have.
fn assert_same<T, const LANES: usize, const N: usize>(
    mut wide: [Running<T>; N],
    mut scalars: [Running<T::Element>; TOPS],
) where
    T: Real<Element: Real>,
{
    run(&mut wide, 1000);
    run(&mut scalars, 1000);
    for (number, (_, scalar)) in scalars.iter().enumerate() {
        let state = &wide[number / LANES].1;
        assert_eq!(state.momentum().lane(number % LANES), scalar.momentum(), "top {number}");
        assert_eq!(state.advected().lane(number % LANES), scalar.advected(), "top {number}");
    }
}

/// Millions of steps of one top a second.
#[allow(clippy::cast_precision_loss)] // eight
fn rate<T: Real, const N: usize>(ensemble: &mut [Running<T>; N]) -> f64 {
    let start = Instant::now();
    run(black_box(ensemble), BATCH);
    f64::from(BATCH) * TOPS as f64 / start.elapsed().as_secs_f64() / 1e6
}

/// Times scalars and one kind of lanes.
fn compare<T, const LANES: usize, const N: usize>(
    name: &str,
    mut wide: [Running<T>; N],
    mut scalars: [Running<T::Element>; TOPS],
) where
    T: Real<Element: Real>,
{
    assert_same::<T, LANES, N>(wide.clone(), scalars.clone());
    let (mut fast, mut slow) = (0.0_f64, 0.0_f64);
    for _ in 0..ROUNDS {
        slow = slow.max(rate(&mut scalars));
        fast = fast.max(rate(&mut wide));
    }
    println!("{name:<20}{slow:>12.1}{fast:>12.1}{:>12.2}", fast / slow);
}

fn count(kernel: &str, steps: u32) {
    match kernel {
        "f64" => run(black_box(&mut core::array::from_fn::<_, TOPS, _>(single::<f64>)), steps),
        "f64-lanes" => run(black_box(&mut [lanes::<AutoF64x8>(0)]), steps),
        "f32" => run(black_box(&mut core::array::from_fn::<_, TOPS, _>(single::<f32>)), steps),
        "f32-lanes" => run(black_box(&mut [lanes::<WideF32x8>(0)]), steps),
        "chain" => swing(u64::from(steps)).expect("solvable steps"),
        _ => panic!("the kernels are f64, f64-lanes, f32, f32-lanes and chain, not {kernel}"),
    }
}

/// Ten rods on ball joints, which dispatch to vector instructions themselves.
fn swing(steps: u64) -> Result<(), Uncounted> {
    let J_d = NonstandardInertia::from_diagonal(Vector3::new(0.005, 0.005, 1.0 / 3.0))?;
    let rod = Link { J_d, m: 1.0, c: -Vector3::z() * 0.5, rho: -Vector3::z() };
    let stepper = Chain { links: [rod; 10], g: 9.81, up: Vector3::z() }.stepper(0.01)?;
    let tilted = core::array::from_fn(|k| SO3::from_euler_angles([0.4, -0.3][k % 2], 0.5, 0.0));
    let mut state = stepper.start(tilted, Bodies([Vector3::new(0.1, 0.2, 0.0); 10]))?;
    stepper.run(&mut state, steps)?;
    Ok(())
}

/// Kernels, the number of steps in their counts, and the most instructions of a step with AVX2. A function of the step
/// that isn't inlined isn't compiled for the vector instructions, and takes a third more.
const MOST_INSTRUCTIONS: [(&str, u32, f64); 2] = [("f64-lanes", 2_000, 1_550.0), ("chain", 1_000, 22_000.0)];

/// Checks that a step in lanes is still inlined completely.
fn instructions_in_lanes() -> Result<(), Uncounted> {
    #[cfg(target_arch = "x86_64")]
    let has_avx2 = std::arch::is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    let has_avx2 = false;
    if !has_avx2 {
        println!("skipped: the bound is for AVX2, which this machine hasn't");
        return Ok(());
    }
    for (kernel, steps, most) in MOST_INSTRUCTIONS {
        let made = instructions(&std::env::current_exe()?, &["count", kernel], steps)?;
        println!("{kernel:<10}{made:>10.1} instructions a step, at most {most}");
        if made > most {
            return Err(format!("a step of {kernel} takes more instructions than it may").into());
        }
    }
    Ok(())
}

fn main() -> Result<(), Uncounted> {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["count", kernel, steps] => {
            count(kernel, steps.parse()?);
            return Ok(());
        }
        ["instructions"] => return instructions_in_lanes(),
        _ => {}
    }
    println!("{:<20}{:>12}{:>12}{:>12}", "10⁶ steps a second", "alone", "in lanes", "ratio");
    compare::<AutoF64x8, 8, 1>("f64, AutoF64x8", [lanes::<AutoF64x8>(0)], core::array::from_fn(single));
    let two = [lanes::<WideF64x4>(0), lanes::<WideF64x4>(4)];
    compare::<WideF64x4, 4, 2>("f64, two WideF64x4", two, core::array::from_fn(single));
    compare::<WideF32x8, 8, 1>("f32, WideF32x8", [lanes::<WideF32x8>(0)], core::array::from_fn(single));
    Ok(())
}
