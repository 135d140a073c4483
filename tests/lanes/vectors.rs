//! The gain of wider vector registers: the same steps with those of the target, of AVX2 and of AVX-512.
//!
//! ```text
//! cargo bench -p liestep-lanes --bench vectors              fails if a gain is lost
//! cargo bench -p liestep-lanes --bench vectors -- native    builds itself for this machine, too, and fails if that is slower;
//!                                          further words are options for the compiler, as -C target-feature=-avx512f
//! cargo bench -p liestep-lanes --bench vectors -- time      nothing but the nanoseconds that the others compare
//! ```
//!
//! A loop of collocation that the compiler no longer vectorises, or a kernel that isn't inlined into the dispatched
//! function, leads to a ratio near one. Kernels take turns within one run, and the fastest batch of each counts.
//!
//! The single top is the fourth of `lanes.rs`, stepped by splittings with the exact motion of its asymmetric body.
//! Eight tops in lanes are all of them, for a step of (3.13), a splitting, a composition, and such splittings. Eight
//! alone are eight steps of one.

mod eight_tops;
#[path = "../benches/kernels/kernel.rs"]
mod kernel;

use core::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::rc::Rc;

use liestep::delegate_plan;
use liestep::mechanics::{self, DiscreteLagrangian, Effect, Scalar, SceneVisitor};
use liestep::methods::{CompositionScheme, ExactBody, ProcessedScheme, SplittingScheme};
use liestep::motion::{Motion, Plan, PlanFacts, Runs, StepReport, Summation};
use liestep::numbers::{Real, Vectors};
use liestep::prelude::*;
use nalgebra::Vector3;
use simba::simd::{AutoF64x4, AutoF64x8, WideF64x4};

use eight_tops::{TOPS, Top, lanes, top};
use kernel::{Effort, Failure, Group, Kernel, arguments, built, measure};

const EFFORT: Effort = Effort { batch: 100, rounds: 1000, counted: 1000 };

/// A plan with other registers: those of the target, four or eight.
#[derive(Clone)]
struct With<P, const LEVEL: usize>(P);

impl<S: Effect, P: Plan<S>, const LEVEL: usize> Plan<S> for With<P, LEVEL> {
    type Kept = P::Kept;

    const FACTS: PlanFacts = PlanFacts {
        vectors: [Vectors::AsCompiled, Vectors::Four, Vectors::Eight][LEVEL],
        runs: Runs::Merged,
        ..P::FACTS
    };

    delegate_plan!(0, |kept| *kept; step_size keep cost);

    fn refolded(&self, scene: &S, h: Scalar<S>) -> Result<Self, SetupError> {
        self.0.refolded(scene, h).map(Self)
    }

    #[inline(always)]
    fn step<M: Summation<mechanics::Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        self.0.step(scene, motion, kept)
    }

    #[inline(always)]
    fn run<M: Summation<mechanics::Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
        steps: u64,
    ) -> Result<u64, StepError> {
        self.0.run(scene, motion, kept, steps)
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        self.0.describe(visitor);
    }
}

/// Batches of steps, each from the start.
fn batch<S, P>(
    name: &str,
    stepper: Stepper<S, P>,
    attitude: mechanics::Group<S>,
    velocity: mechanics::Vector<S>,
) -> Kernel
where
    S: Effect + 'static,
    P: Plan<S, Kept: 'static> + 'static,
{
    let stepper = Rc::new(stepper);
    Kernel::new(name, move || {
        let (stepper, start) = (Rc::clone(&stepper), stepper.start(attitude, velocity)?);
        Ok(move |steps| {
            let mut state = black_box(start);
            stepper.run(&mut state, u64::from(steps))?;
            black_box(state);
            Ok(0)
        })
    })
}

/// A stepper with each kind of registers.
fn levels<S, P>(stepper: &Stepper<S, P>, attitude: mechanics::Group<S>, velocity: mechanics::Vector<S>) -> [Kernel; 3]
where
    S: Effect + Clone + 'static,
    P: Plan<S, Kept: 'static> + Clone + 'static,
{
    let with = || (stepper.scene().clone(), stepper.plan().clone());
    let ((a, p), (b, q), (c, r)) = (with(), with(), with());
    [
        batch("as compiled", Stepper::with_plan(a, With::<P, 0>(p)).expect("a scene"), attitude, velocity),
        batch("four", Stepper::with_plan(b, With::<P, 1>(q)).expect("a scene"), attitude, velocity),
        batch("eight", Stepper::with_plan(c, With::<P, 2>(r)).expect("a scene"), attitude, velocity),
    ]
}

/// The kernels with each kind of registers, and the least gain of each over the one before.
struct Row {
    name: String,
    kernels: [Kernel; 3],
    least: [f64; 2],
}

fn collocation<const PAIRS: usize>(least: [f64; 2]) -> Row {
    let (scene, attitude, velocity) = top::<f64>(3);
    let stepper = Stepper::collocated::<PAIRS>(scene, 0.1).expect("a usable step");
    Row { name: format!("Gauss, {} stages", 2 * PAIRS), kernels: levels(&stepper, attitude, velocity), least }
}

/// One top by splittings: registers of four gain, by 1.07 to 1.17 where this was written. Registers of eight, which
/// aren't requested, took up to 14 percent longer on a machine whose 512-bit operations take two passes.
fn one() -> Vec<Row> {
    let (scene, attitude, velocity) = top::<f64>(3);
    let body = ExactBody::new(&NonstandardInertia::from(scene.J_d).to_inertia());
    let split = Stepper::split(scene.clone(), 0.05, body, SplittingScheme::FORCE_GRADIENT_2).expect("a usable step");
    let processed = Stepper::processed(scene, 0.05, body, ProcessedScheme::SIX_A).expect("a usable step");
    let row = |way: &str, kernels| Row { name: format!("one top: {way}"), kernels, least: [1.0, 0.0] };
    vec![
        row("force gradient 2-4", levels(&split, attitude, velocity)),
        row("processed 3-6 a", levels(&processed, attitude, velocity)),
    ]
}

/// Eight tops in lanes of this type, by these methods.
fn in_lanes<T>(name: &str, gain: f64) -> Vec<Row>
where
    T: Real<Element: Real + nalgebra::RealField> + 'static,
    Top<T>: DiscreteLagrangian<Scalar = T, Group = SO3<T>, Advected = Vector3<T>> + liestep::mechanics::Regular,
{
    let (scene, attitude, velocity) = lanes::<T>(0);
    let h = || nalgebra::convert::<f64, T>(0.05);
    let body = ExactBody::new(&NonstandardInertia::from(scene.J_d).to_inertia());
    let row = |way: &str, kernels, gain| Row { name: format!("{name}: {way}"), kernels, least: [gain, 0.0] };
    let declared = Stepper::new(scene.clone(), h()).expect("a usable step");
    let composed = Stepper::composed(scene.clone(), h(), CompositionScheme::KAHAN_LI_6).expect("a usable step");
    let split = |scheme| Stepper::split(scene.clone(), h(), body, scheme).expect("a usable step");
    let processed = Stepper::processed(scene.clone(), h(), body, ProcessedScheme::SIX_A).expect("a usable step");
    vec![
        row("(3.13)", levels(&declared, attitude, velocity), gain),
        row("Kahan-Li 6", levels(&composed, attitude, velocity), gain),
        row("Nyström 11-6", levels(&split(SplittingScheme::NYSTROM_11), attitude, velocity), gain),
        row("force gradient 5-6", levels(&split(SplittingScheme::FORCE_GRADIENT_5), attitude, velocity), gain),
        row("processed 3-6 a", levels(&processed, attitude, velocity), gain),
    ]
}

fn rows() -> Vec<Row> {
    let mut rows = vec![collocation::<2>([1.3, 0.0]), collocation::<4>([1.5, 1.15])];
    rows.extend(one());
    rows.extend(in_lanes::<AutoF64x8>("8 lanes, AutoF64x8", 1.25));
    rows.extend(in_lanes::<WideF64x4>("4 lanes, WideF64x4", 0.0));
    rows.extend(in_lanes::<AutoF64x4>("4 lanes, AutoF64x4", 0.0));
    rows
}

/// Whether the machine has the registers of this level.
fn has(level: usize) -> bool {
    #[cfg(target_arch = "x86_64")]
    return [is_x86_feature_detected!("avx2"), is_x86_feature_detected!("avx512f")][level];
    #[cfg(not(target_arch = "x86_64"))]
    return level > 1;
}

/// Prints a table of the gains; fails if one is lost.
fn gains() -> Result<(), Failure> {
    println!("{:<40}{:>12}{:>12}{:>12}{:>8}{:>8}", "ns a step", "as compiled", "four", "eight", "gain", "gain");
    let mut lost = Vec::new();
    for Row { name, kernels, least } in rows() {
        let [two, four, eight] = fastest(kernels)?;
        let gains = [two / four, four / eight];
        println!("{name:<40}{two:>12.1}{four:>12.1}{eight:>12.1}{:>8.2}{:>8.2}", gains[0], gains[1]);
        // A program that is compiled for wider registers has no gain.
        let is_compiled = [cfg!(target_feature = "avx2"), cfg!(target_feature = "avx512f")];
        for level in 0..2 {
            if has(level) && !is_compiled[level] && gains[level] < least[level] {
                lost.push(format!("{name}: {:.2} instead of {}", gains[level], least[level]));
            }
        }
    }
    measure(&[], vec![alone()], &[])?;
    if lost.is_empty() { Ok(()) } else { Err(lost.join("; ").into()) }
}

/// The times of these kernels in turns.
fn fastest<const N: usize>(kernels: [Kernel; N]) -> Result<[f64; N], Failure> {
    let times = Group::new("", EFFORT, kernels).fastest()?;
    Ok(core::array::from_fn(|k| times[k]))
}

/// The exact motion of a body in eight lanes, compared with eight single bodies.
fn alone() -> Group {
    let wide = lanes::<AutoF64x8>(0);
    let scheme = SplittingScheme::FORCE_GRADIENT_5;
    let body = ExactBody::new(&NonstandardInertia::from(wide.0.J_d).to_inertia());
    let stepper = Stepper::split(wide.0, nalgebra::convert(0.05), body, scheme).expect("a usable step");
    let apart = Kernel::new("eight alone", move || {
        let one = |number| {
            let (scene, attitude, velocity) = top::<f64>(number);
            let body = ExactBody::new(&NonstandardInertia::from(scene.J_d).to_inertia());
            let stepper = Stepper::split(scene, 0.05, body, scheme)?;
            let start = stepper.start(attitude, velocity)?;
            Ok::<_, Failure>((stepper, start))
        };
        let all = (0..TOPS).map(one).collect::<Result<Vec<_>, _>>()?;
        Ok(move |steps| {
            for (stepper, start) in &all {
                let mut state = black_box(*start);
                stepper.run(&mut state, u64::from(steps))?;
                black_box(state);
            }
            Ok(0)
        })
    });
    Group::new("exact motion", EFFORT, [apart, batch("in lanes", stepper, wide.1, wide.2)])
}

/// Prints the nanoseconds a step of each kernel with its own choice of registers, a line each.
fn times() -> Result<(), Failure> {
    for Row { name, kernels, .. } in rows() {
        let [_, four, eight] = kernels;
        let is_collocation = name.starts_with("Gauss, 8");
        let [time] = fastest([if is_collocation { eight } else { four }])?;
        println!("{time:.2} {name}");
    }
    Ok(())
}

/// The times of the program at this path.
fn times_of(program: &Path) -> Result<Vec<(f64, String)>, Failure> {
    let output = Command::new(program).arg("time").output()?;
    let lines = String::from_utf8(output.stdout)?;
    let line = |line: &str| -> Option<(f64, String)> {
        let (time, name) = line.split_once(' ')?;
        Some((time.parse().ok()?, name.to_owned()))
    };
    Ok(lines.lines().filter_map(line).collect())
}

/// Compares this program with itself compiled for this machine's processor; fails if that is slower.
fn native(flags: &[String]) -> Result<(), Failure> {
    let flags = format!("-C target-cpu=native {}", flags.join(" "));
    let place = built("vectors", &["--target-dir", "target/native"], Some(&flags))?;
    let programs = [std::env::current_exe()?, place];
    let mut best: [Vec<(f64, String)>; 2] = Default::default();
    for _ in 0..3 {
        for (best, program) in best.iter_mut().zip(&programs) {
            let times = times_of(program)?;
            if best.is_empty() {
                *best = times;
            } else {
                best.iter_mut().zip(times).for_each(|(best, time)| best.0 = best.0.min(time.0));
            }
        }
    }
    println!("{:<40}{:>12}{:>12}{:>8}", "ns a step", "default", "native", "ratio");
    let mut slower = Vec::new();
    for ((default, name), (native, _)) in best[0].iter().zip(&best[1]) {
        println!("{name:<40}{default:>12.1}{native:>12.1}{:>8.2}", native / default);
        if *native > SLOWER * default {
            slower.push(name.as_str());
        }
    }
    if slower.is_empty() {
        Ok(())
    } else {
        Err(format!("slower if compiled for this machine: {}", slower.join("; ")).into())
    }
}

/// A ratio up to this is noise.
const SLOWER: f64 = 1.1;

fn main() -> Result<(), Failure> {
    let words = arguments();
    match words.first().map(String::as_str) {
        None => gains(),
        Some("native") => native(&words[1..]),
        Some("time") => times(),
        Some(other) => Err(format!("`native`, `time` or nothing, not {other}").into()),
    }
}
