//! A declaration that is read while a program runs, beside the compiled one:
//! `cargo bench -p liestep-machine --features cranelift`.
//!
//! Times of a step, in those of the compiled step: measured in turns within one run, the fastest of all batches; the
//! time from a text to the first step, and from each text of the repository to its machine code; `-- instructions`
//! counts those of a step of (3.13), by valgrind.

#[path = "../../../tests/benches/counting.rs"]
mod counting;

use std::hint::black_box;
use std::time::Instant;

use declarations::{
    Alike, CayleyTop, ContinuousTop, DoublePendulum, ElasticFlow, FallingBody, Flyer, FourthOrderTop, FullTop,
    Gyrostat, LogTop, Magnet, OrbitingBody, RodElement, Satellite, SixthOrderTop, SuspendedLoad, TetheredPlate,
    TopOnCart, TwoBodies, UnderwaterBody,
};
use liestep::mechanics::{Effect, Inertia, Regular, WithKinetic};
use liestep::motion::{Batch, Batchable, Integrator};
use liestep::{SO3, StateOf, Stepper};
use liestep_late::{Backend, Declaration, Interpreter, Late, LateError, Program};
use liestep_machine::Machine;
use nalgebra::Vector3;
use simba::simd::AutoF64x8;

use counting::{Uncounted, instructions};

const STEPS: u32 = 1_000;
const ROUNDS: usize = 200;
const STEP: f64 = 0.01;
const LANES: u32 = 8;

type LateTop<B> = Late<SO3, Vector3<f64>, WithKinetic, B>;

fn main() -> Result<(), Uncounted> {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let (rho, up) = (Vector3::new(0.1, -0.2, 0.4), Vector3::z());
    let inertia = Inertia::from_principal_moments(Vector3::new(2.0, 2.5, 3.0)).expect("an inertia");
    let fourth = FourthOrderTop { J: inertia, weight: 1.5 * 9.81, rho, up };
    let full = FullTop { J_d: inertia.to_nonstandard(), m: 1.5, g: 9.81, rho, up };
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["count", "fourth", kind, steps] => return count(fourth, kind, steps.parse()?),
        ["count", _, kind, steps] => return count(full, kind, steps.parse()?),
        ["instructions"] => {
            for (scene, name) in [("full", "(3.13), any inertia"), ("fourth", "of the fourth order")] {
                for kind in KINDS {
                    let steps = instructions(&std::env::current_exe()?, &["count", scene, kind], 10 * STEPS)?;
                    println!("{name:22} {kind:22}{steps:8.0} instructions a step");
                }
            }
            return Ok(());
        }
        _ => first_steps(),
    }
    compare("(3.13), any inertia", full);
    compare("of the fourth order", fourth);
    texts();
    Ok(())
}

const KINDS: [&str; 6] =
    ["compiled", "machine code", "specialised", "interpreted", "in lanes of eight", "machine code in lanes"];

/// Runs steps of one kind.
fn count<S>(scene: S, kind: &str, steps: u32) -> Result<(), Uncounted>
where
    S: Regular<Scalar = f64, Group = SO3, Advected = Vector3<f64>>,
{
    let machine: LateTop<Machine> = Late::like(&scene)?;
    let interpreted: LateTop<Interpreter> = Late::like(&scene)?;
    let mut run = match kind {
        "compiled" => alone(scene),
        "machine code" => alone(machine),
        "specialised" => alone(machine.specialised()),
        "interpreted" => alone(interpreted),
        "in lanes of eight" => in_lanes(&interpreted),
        _ => in_lanes(&machine),
    };
    // The lanes share the number of steps.
    let often = if kind.contains("lanes") { steps / STEPS / LANES } else { steps / STEPS };
    (0..often).for_each(|_| {
        run();
    });
    Ok(())
}

fn started<S>(scene: S) -> (Stepper<S>, StateOf<S>)
where
    S: Regular<Scalar = f64, Group = SO3>,
{
    let stepper = Stepper::new(scene, STEP).expect("a stepper");
    let state = stepper.start(SO3::exp(Vector3::new(0.8, 0.0, 0.0)), Vector3::new(0.5, 2.0, 6.0)).expect("a start");
    (stepper, state)
}

/// The time of a step of one of several scenes, ns.
fn ns(clock: Instant, scenes: u32) -> f64 {
    clock.elapsed().as_secs_f64() * 1e9 / f64::from(STEPS) / f64::from(scenes)
}

fn alone<'a, S: Regular<Scalar = f64, Group = SO3> + 'a>(scene: S) -> Box<dyn FnMut() -> f64 + 'a>
where
    StateOf<S>: 'a,
{
    let (stepper, mut state) = started(scene);
    Box::new(move || {
        let clock = Instant::now();
        for _ in 0..STEPS {
            stepper.step(&mut state).expect("a step");
        }
        black_box(&state);
        ns(clock, 1)
    })
}

fn in_lanes<'a, S>(scene: &S) -> Box<dyn FnMut() -> f64 + 'a>
where
    S: Regular<Scalar = f64, Group = SO3> + Clone,
    Stepper<S>: Batchable<AutoF64x8> + Integrator<State = StateOf<S>> + 'a,
{
    let bodies: Vec<_> = (0..LANES).map(|_| started(scene.clone())).collect();
    let mut batch = Batch::<AutoF64x8, _>::new(&bodies).expect("they share a text");
    Box::new(move || {
        let clock = Instant::now();
        batch.run(u64::from(STEPS));
        ns(clock, LANES)
    })
}

fn compare<S>(name: &str, scene: S)
where
    S: Regular<Scalar = f64, Group = SO3, Advected = Vector3<f64>>,
{
    let machine: LateTop<Machine> = Late::like(&scene).expect("a declaration");
    let interpreted: LateTop<Interpreter> = Late::like(&scene).expect("a declaration");
    let lanes = [in_lanes(&interpreted), in_lanes(&machine)];
    let specialised = machine.clone().specialised();
    let mut kinds: Vec<_> = [alone(scene), alone(machine), alone(specialised), alone(interpreted)].into();
    kinds.extend(lanes);
    let mut least = [f64::INFINITY; KINDS.len()];
    for _ in 0..ROUNDS {
        for (least, kind) in least.iter_mut().zip(&mut kinds) {
            *least = least.min(kind());
        }
    }
    for (kind, ns) in KINDS.iter().zip(least) {
        println!("{name:22} {kind:22}{ns:8.0} ns a step, {:.2} times", ns / least[0]);
    }
}

/// Each text is derived anew, as it differs in its name.
fn first_steps() {
    let times = (0..20).map(|number| {
        let text = FullTop::DECLARATION.replace("FullTop", &format!("Top{number}"));
        let clock = Instant::now();
        let late: LateTop<Machine> = Late::parse(&text).expect("a declaration");
        let inertia = [2.0, 0.0, 0.0, 0.0, 2.5, 0.0, 0.0, 0.0, 3.0];
        let numbers: [(&str, &[f64]); 5] =
            [("J_d", &inertia), ("m", &[1.5]), ("g", &[9.81]), ("rho", &[0.1, 0.0, 0.4]), ("up", &[0.0, 0.0, 1.0])];
        let late = numbers.iter().try_fold(late, |late, (name, value)| late.with(name, value)).expect("numbers");
        let (stepper, mut state) = started(late);
        stepper.step(&mut state).expect("a step");
        clock.elapsed().as_secs_f64() * 1e3
    });
    let times: Vec<f64> = times.collect();
    let least = times.iter().copied().fold(f64::INFINITY, f64::min);
    println!("from the text of (3.13) to the first step: {:.1} ms the first time, {least:.1} ms at best", times[0]);
}

macro_rules! texts {
    ($($name:ident)+) => { [$((stringify!($name), <$name as Effect>::DECLARATION)),+] };
}

fn texts() {
    let all = texts! {
        Alike CayleyTop ContinuousTop DoublePendulum ElasticFlow FallingBody Flyer Gyrostat LogTop Magnet OrbitingBody
        RodElement Satellite SixthOrderTop SuspendedLoad TetheredPlate TopOnCart TwoBodies UnderwaterBody
    };
    for (name, text) in all {
        let text = text.replace(name, "Anew");
        let clock = Instant::now();
        let declaration = Declaration::parse(&text).expect("a declaration");
        let derived = clock.elapsed().as_secs_f64() * 1e3;
        let mut programs: Vec<&Program> = Vec::new();
        let all = declaration.programs.try_map(|program| {
            programs.push(program);
            Ok::<_, LateError>(())
        });
        drop(all);
        let clock = Instant::now();
        let codes = <Machine as Backend<f64>>::codes(&programs).expect("programs");
        codes.iter().for_each(<Machine as Backend<f64>>::prepare);
        black_box(codes);
        let made = clock.elapsed().as_secs_f64() * 1e3;
        let operations: usize = programs.iter().map(|program| program.operations.len()).sum();
        println!("{name:18} derived in {derived:6.1} ms, machine code of {operations:6} operations in {made:6.1} ms");
    }
}
