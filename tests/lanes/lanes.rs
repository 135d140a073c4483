//! Steps of eight heavy tops (3.13) on one core, one after another and in SIMD lanes, and of a chain of ten links. The
//! table `systems` of `liestep-benches` measures several bodies.
//!
//! ```text
//! cargo bench -p liestep-lanes --bench lanes                                    scalars by the target's common instructions
//! RUSTFLAGS="-C target-cpu=native" cargo bench -p liestep-lanes --bench lanes   scalars by the instructions of this machine
//! cargo bench -p liestep-lanes --bench lanes -- instructions                    fails if a step in lanes exceeds its limit
//! cargo bench -p liestep-lanes --bench lanes -- count "f64: AutoF64x8" 1000     1000 steps of all tops by one kernel, nothing else
//! ```
//!
//! A step is one of all eight. A step of lanes is dispatched to the machine's instructions, whatever it was compiled
//! for, but types of lanes differ in their use. Types of simba that are arrays depend on the compiler, which puts most
//! of `AutoF64x8` into registers of four `f64` if there is AVX2, and less of narrower types. `WideF64x4` and
//! `WideF32x8` are pairs of registers of x86-64's common instructions, two `f64` or four `f32` each, unless the program
//! is compiled for more; AVX then only saves moves between registers. `vectors.rs` measures the gain of each kind of
//! registers.
//!
//! The bodies, tilts and spins of the tops vary about the looping case of \[RDAE, figure 3.8\], `h = 0.01 s`. All
//! kernels make the same steps, which is checked before the timing.

mod eight_tops;
#[path = "../benches/kernels/kernel.rs"]
mod kernel;

use core::hint::black_box;

use liestep::methods::{Chain, Link};
use liestep::numbers::{Bodies, Lanes as _, Real};
use liestep::prelude::*;
use nalgebra::{RealField, Vector3};
use simba::simd::{AutoF64x8, WideF32x8, WideF64x4};

use eight_tops::{TOPS, Top, top};
use kernel::{Effort, Failure, Group, Kernel, arguments, instructions, measure};

/// A batch is well below a slice of the scheduler's time.
const EFFORT: Effort = Effort { batch: 500, rounds: 4_000, counted: 2_000 };

type TopRun<T> = (Stepper<Top<T>>, State<SO3<T>, Vector3<T>>);

/// The tops from `first` on, one in each lane.
fn lanes<T: Real<Element: Real + RealField>>(first: usize) -> TopRun<T> {
    let (wide, attitude, velocity) = eight_tops::lanes::<T>(first);
    let stepper = Stepper::new(wide, nalgebra::convert(0.01)).expect("a usable step");
    let state = stepper.start(attitude, velocity).expect("a usable start");
    (stepper, state)
}

fn single<E: Real + RealField>(number: usize) -> TopRun<E> {
    let (top, attitude, velocity) = top(number);
    let stepper = Stepper::new(top, nalgebra::convert(0.01)).expect("a usable step");
    let state = stepper.start(attitude, velocity).expect("a usable start");
    (stepper, state)
}

#[inline(never)]
fn run<T: Real, const N: usize>(ensemble: &mut [TopRun<T>; N], steps: u32) {
    for _ in 0..steps {
        for (stepper, state) in &mut *ensemble {
            stepper.step(state).expect("a solvable step");
        }
    }
}

/// Steps each top a thousand times and compares with the scalars, whose bits the lanes must have.
fn assert_same<T, const LANES: usize, const N: usize>()
where
    T: Real<Element: Real + RealField>,
{
    let mut wide: [TopRun<T>; N] = core::array::from_fn(|k| lanes(k * LANES));
    let mut scalars: [TopRun<T::Element>; TOPS] = core::array::from_fn(single);
    run(&mut wide, 1000);
    run(&mut scalars, 1000);
    for (number, (_, scalar)) in scalars.iter().enumerate() {
        let state = &wide[number / LANES].1;
        assert_eq!(state.momentum().lane(number % LANES), scalar.momentum(), "top {number}");
        assert_eq!(state.advected().lane(number % LANES), scalar.advected(), "top {number}");
    }
}

/// The eight tops as `N` ensembles of this number of lanes.
fn tops<T: Real<Element: Real + RealField> + 'static, const N: usize>(
    name: &str,
    each: fn(usize) -> TopRun<T>,
) -> Kernel {
    Kernel::new(name, move || {
        let mut ensemble: [TopRun<T>; N] = core::array::from_fn(|k| each(k * TOPS / N));
        Ok(move |steps| {
            run(black_box(&mut ensemble), steps);
            Ok(0)
        })
    })
}

/// Ten rods on ball joints, which dispatch to vector instructions themselves.
fn chain() -> Kernel {
    Kernel::new("ten links", || {
        let J_d = NonstandardInertia::from_diagonal(Vector3::new(0.005, 0.005, 1.0 / 3.0))?;
        let rod = Link { J_d, m: 1.0, c: -Vector3::z() * 0.5, rho: -Vector3::z() };
        let stepper = Chain { links: [rod; 10], g: 9.81, up: Vector3::z() }.stepper(0.01)?;
        let tilted = core::array::from_fn(|k| SO3::from_euler_angles([0.4, -0.3][k % 2], 0.5, 0.0));
        let start = stepper.start(tilted, Bodies([Vector3::new(0.1, 0.2, 0.0); 10]))?;
        Ok(move |steps| {
            stepper.run(&mut start.clone(), u64::from(steps))?;
            Ok(0)
        })
    })
}

fn groups() -> Vec<Group> {
    let of_f64 = [
        tops::<f64, TOPS>("alone", single),
        tops::<AutoF64x8, 1>("AutoF64x8", lanes),
        tops::<WideF64x4, 2>("two WideF64x4", lanes),
    ];
    let of_f32 = [tops::<f32, TOPS>("alone", single), tops::<WideF32x8, 1>("WideF32x8", lanes)];
    vec![
        Group::new("f64", EFFORT, of_f64),
        Group::new("f32", EFFORT, of_f32),
        Group::new("chain", Effort { rounds: 40, counted: 1_000, ..EFFORT }, [chain()]),
    ]
}

/// Kernels, the number of steps in their counts, and the most instructions of a step with AVX2. A function of the step
/// that isn't inlined isn't compiled for the vector instructions, and takes a third more.
const MOST_INSTRUCTIONS: [(&str, u32, f64); 2] =
    [("f64: AutoF64x8", 2_000, 1_600.0), ("chain: ten links", 1_000, 22_000.0)];

/// Checks that a step in lanes is still inlined completely.
fn instructions_in_lanes() -> Result<(), Failure> {
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
        println!("{kernel:<20}{made:>10.1} instructions a step, at most {most}");
        if made > most {
            return Err(format!("a step of {kernel} takes more instructions than it may").into());
        }
    }
    Ok(())
}

fn main() -> Result<(), Failure> {
    let words = arguments();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["instructions"] => return instructions_in_lanes(),
        ["count", ..] => {}
        _ => {
            assert_same::<AutoF64x8, 8, 1>();
            assert_same::<WideF64x4, 4, 2>();
            assert_same::<WideF32x8, 8, 1>();
        }
    }
    measure(&[], groups(), &words)
}
