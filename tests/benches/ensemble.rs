//! Steps a second of eight heavy tops (3.13) on one core: one after another, and in SIMD lanes.
//!
//! ```text
//! cargo bench --bench ensemble                                    scalars by the target's common instructions
//! RUSTFLAGS="-C target-cpu=native" cargo bench --bench ensemble   by those of this machine
//! cargo bench --bench ensemble -- count f64-lanes 1000            1000 steps of all tops by one kernel, nothing else
//! ```
//!
//! The last is for counting instructions, as in `heavy_top_step.rs`; the kernels are `f64`, `f64-lanes`, `f32` and
//! `f32-lanes`. A step of lanes takes the instructions of the machine, whatever it was compiled for, but types of lanes
//! differ in what they make of that. Those of simba that are arrays leave it to the compiler, which makes registers of
//! four `f64` of most of `AutoF64x8` where there is AVX2, and of less of narrower ones. `WideF64x4` and `WideF32x8` are
//! pairs of registers of x86-64's common instructions, two `f64` or four `f32` each, unless the program is compiled for
//! more; AVX then only saves them moves between registers.
//!
//! The tops differ in body, tilt and spin about the looping case of \[RDAE, figure 3.8\], `h = 0.01 s`. All kernels
//! make the same steps, which is asserted before they are timed, and take turns within one run. The fastest batch of
//! each counts: what else the machine does only slows, and slows the longer batches more often, so that medians would
//! flatter the lanes.

use core::hint::black_box;
use std::time::Instant;

use liestep::numbers::Real;
use liestep::prelude::*;
use nalgebra::{RealField, SimdValue, UnitQuaternion, Vector3};
use simba::simd::{AutoF64x8, WideF32x8, WideF64x4};

const TOPS: usize = 8;
/// Steps of each top in a batch: well below a slice of the scheduler's time, so that some batches of each kernel meet
/// no other process.
const BATCH: u32 = 500;
const ROUNDS: usize = 4_000;

/// (3.13) in principal axes.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * weight * w.dot(&(rho + F * rho)),
)]
#[derive(Clone)]
#[allow(non_snake_case)] // the letters of the field
struct Top<T: Real> {
    J_d: DiagonalNonstandardInertia<T>,
    weight: T,
    rho: Vector3<T>,
    up: Vector3<T>,
}

type Running<T> = (Stepper<Top<T>>, State<SO3<T>, Vector3<T>>);

/// The top with the given number, and its attitude and velocity.
#[allow(clippy::cast_precision_loss)] // a top's number, below eight
fn top<E: Real + RealField>(number: usize) -> (Top<E>, SO3<E>, Vector3<E>) {
    let vector = |x: f64, y: f64, z: f64| Vector3::new(x, y, z).map(nalgebra::convert::<f64, E>);
    let t = number as f64 / TOPS as f64;
    let moments = vector(3.0 + 0.2 * t, 3.0 - 0.3 * t, 4.0);
    let top = Top {
        J_d: DiagonalNonstandardInertia::from_principal_moments(moments).expect("a body"),
        weight: nalgebra::convert(9.81),
        rho: vector(0.0, 0.1 * t, 1.0),
        up: Vector3::z(),
    };
    let (tilt, precession, nutation, spin) = (0.8 + 0.1 * t, 3.0, 0.5, 10.0 - t);
    let attitude = UnitQuaternion::from_scaled_axis(vector(tilt, 0.0, 0.0)).into();
    (top, attitude, vector(nutation, precession * tilt.sin(), spin + precession * tilt.cos()))
}

/// The tops from `first` on, one in each lane.
fn lanes<T, const N: usize>(first: usize) -> Running<T>
where
    T: Real<Element: Real + RealField> + From<[T::Element; N]>,
{
    let all: [_; N] = core::array::from_fn(|lane| top::<T::Element>(first + lane));
    let gather = |entry: &dyn Fn(usize) -> T::Element| T::from(core::array::from_fn(entry));
    let vector = |of: &dyn Fn(usize) -> Vector3<T::Element>| Vector3::from_fn(|i, _| gather(&|lane| of(lane)[i]));
    let wide = Top {
        J_d: all.each_ref().map(|lane| lane.0.J_d).into(),
        weight: gather(&|lane| all[lane].0.weight),
        rho: vector(&|lane| all[lane].0.rho),
        up: vector(&|lane| all[lane].0.up),
    };
    let stepper = Stepper::new(wide, nalgebra::convert(0.01)).expect("a usable step");
    let attitude: SO3<T> = all.each_ref().map(|lane| lane.1).into();
    let state = stepper.start(attitude, vector(&|lane| all[lane].2)).expect("a usable start");
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

/// Steps each top a thousand times and compares with the scalars, whose digits the lanes must have.
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
        assert_eq!(state.momentum().extract(number % LANES), scalar.momentum(), "top {number}");
        assert_eq!(state.advected().extract(number % LANES), scalar.advected(), "top {number}");
    }
}

/// Millions of steps of one top a second.
#[allow(clippy::cast_precision_loss)] // eight
fn rate<T: Real, const N: usize>(ensemble: &mut [Running<T>; N]) -> f64 {
    let start = Instant::now();
    run(black_box(ensemble), BATCH);
    f64::from(BATCH) * TOPS as f64 / start.elapsed().as_secs_f64() / 1e6
}

/// Scalars against one kind of lanes.
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
        "f64-lanes" => run(black_box(&mut [lanes::<AutoF64x8, 8>(0)]), steps),
        "f32" => run(black_box(&mut core::array::from_fn::<_, TOPS, _>(single::<f32>)), steps),
        "f32-lanes" => run(black_box(&mut [lanes::<WideF32x8, 8>(0)]), steps),
        _ => panic!("the kernels are f64, f64-lanes, f32 and f32-lanes, not {kernel}"),
    }
}

fn main() {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    if let [word, kernel, steps] = arguments.as_slice()
        && word == "count"
    {
        return count(kernel, steps.parse().expect("a number of steps"));
    }
    println!("{:<20}{:>12}{:>12}{:>12}", "10⁶ steps a second", "alone", "in lanes", "ratio");
    compare::<AutoF64x8, 8, 1>("f64, AutoF64x8", [lanes::<AutoF64x8, 8>(0)], core::array::from_fn(single));
    let two = [lanes::<WideF64x4, 4>(0), lanes::<WideF64x4, 4>(4)];
    compare::<WideF64x4, 4, 2>("f64, two WideF64x4", two, core::array::from_fn(single));
    compare::<WideF32x8, 8, 1>("f32, WideF32x8", [lanes::<WideF32x8, 8>(0)], core::array::from_fn(single));
}
