//! Steps a second of eight heavy tops (3.13) on one core: one after another, and in SIMD lanes.
//!
//! ```text
//! cargo bench --bench ensemble                                    the target's common instructions
//! RUSTFLAGS="-C target-cpu=native" cargo bench --bench ensemble   those of this machine
//! ```
//!
//! The second also compiles the scalar kernels for this machine. What can be gained is bounded by the lanes of a
//! register: x86-64 has two `f64` or four `f32` in common, four or eight with AVX, eight or sixteen with AVX-512.
//!
//! The tops differ in body, tilt and spin about the looping case of \[RDAE, figure 3.8\], `h = 0.01 s`. All kernels make the
//! same steps, which is asserted before they are timed, and take turns within one run.

use core::hint::black_box;
use std::time::Instant;

use liestep::{DiagonalNonstandardInertia, Real, SO3, State, Stepper, lagrangian};
use nalgebra::{RealField, SimdValue, UnitQuaternion, Vector3};
use simba::simd::{WideF32x8, WideF64x4};

const TOPS: usize = 8;
/// Steps of each top in a batch.
const BATCH: u32 = 5_000;
const ROUNDS: usize = 200;

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

fn quantiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [values.len() / 10, values.len() / 2, values.len() * 9 / 10].map(|index| values[index])
}

fn print(name: &str, values: Vec<f64>) {
    let [low, median, high] = quantiles(values);
    println!("{name:<36}{low:>8.2}{median:>8.2}{high:>8.2}");
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
    let (mut fast, mut slow) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        slow.push(rate(&mut scalars));
        fast.push(rate(&mut wide));
    }
    let ratios = fast.iter().zip(&slow).map(|(fast, slow)| fast / slow).collect();
    println!("{:<36}{:>8}{:>8}{:>8}", format!("eight tops in {name}"), "10 %", "median", "90 %");
    print("one after another, 10⁶ steps a second", slow);
    print("in lanes", fast);
    print("lanes : one after another", ratios);
}

fn main() {
    // Two registers' worth of a type of four lanes: simba has no `f64` in eight but for arrays, which the compiler
    // doesn't turn into vector code.
    let two = [lanes::<WideF64x4, 4>(0), lanes::<WideF64x4, 4>(4)];
    compare::<WideF64x4, 4, 2>("f64, two by four", two, core::array::from_fn(single));
    compare::<WideF32x8, 8, 1>("f32", [lanes::<WideF32x8, 8>(0)], core::array::from_fn(single));
}
