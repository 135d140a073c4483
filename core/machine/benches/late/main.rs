//! A declaration that is read while a program runs, beside the compiled one:
//! `cargo bench -p liestep-machine --features cranelift`.
//!
//! Times of a step, in those of the compiled step, of a text by machine code and interpreted. Then the time from a text to the
//! first step, and from each text of the repository to its machine code; `-- instructions` counts those of a
//! step, by valgrind.

#[path = "../../../../tests/benches/kernels/kernel.rs"]
mod kernel;
mod scenes;

use std::hint::black_box;
use std::time::Instant;

use declarations::{
    Alike, CayleyTop, ContinuousTop, DoublePendulum, ElasticFlow, FallingBody, Flyer, FourthOrderTop, FullTop,
    Gyrostat, LogTop, Magnet, OrbitingBody, RodElement, Satellite, SixthOrderTop, SuspendedLoad, TetheredPlate,
    TopOnCart, TwoBodies, UnderwaterBody,
};
use liestep::effects::{Gravity, RigidBody};
use liestep::mechanics::{Effect, Inertia, Regular};
use liestep::motion::{AnyStepper, Batch, Batchable, Integrator, Propagator as _};
use liestep::with::Method;
use liestep::{SO3, StateOf, Stepper};
use liestep_late::{Backend, BackendInLanes, Declaration, Interpreter, LateError, Program, Whole};
use liestep_machine::Machine;
use nalgebra::Vector3;
use simba::simd::AutoF64x8;

use kernel::{Effort, Failure, Group, Kernel, arguments, measure};
use scenes::{Start, entries, links_and_mass, listed, tied_body, top, top_start};

const STEP: f64 = 0.01;
const LANES: u32 = 8;
const EFFORT: Effort = Effort { batch: 1_000, rounds: 200, counted: 10_000 };

fn main() -> Result<(), Failure> {
    let words = arguments();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let inertia = Inertia::from_principal_moments(Vector3::new(2.0, 2.5, 3.0))?;
    let rho = Vector3::new(0.1, -0.2, 0.4);
    let fourth = FourthOrderTop { J: inertia, weight: 1.5 * 9.81, rho, up: Vector3::z() };
    let (full, start) = top()?;
    let (tied, tied_start) = tied_body();
    let (links, links_start) = links_and_mass()?;
    let top_kernels = kernels(full.clone(), start)?.into_iter().chain(lanes(&full)?);
    let groups = vec![
        Group::new("(3.13), any inertia", EFFORT, top_kernels),
        Group::new("SE(3), two advected", EFFORT, kernels(tied, tied_start)?),
        Group::new("nine unknowns", EFFORT, kernels(links, links_start)?),
        Group::new("of the fourth order", EFFORT, kernels(fourth, start)?),
    ];
    if words.is_empty() {
        first_steps();
    }
    measure(&[], groups, &words)?;
    if words.is_empty() {
        texts();
    }
    Ok(())
}

/// The declaration compiled, and read in each way.
fn kernels<S>(scene: S, start: Start<S>) -> Result<[Kernel; 3], Failure>
where
    S: Regular<Scalar = f64> + Clone + 'static,
{
    let (declaration, values) = Declaration::like(&scene)?;
    Ok([
        alone("compiled", scene, start),
        on_slices::<Machine, S>("machine code", declaration, values.clone(), start),
        on_slices::<Interpreter, S>("interpreted", declaration, values, start),
    ])
}

/// The declaration in lanes.
fn lanes(scene: &FullTop) -> Result<[Kernel; 3], Failure> {
    let (declaration, values) = Declaration::like(scene)?;
    let FullTop { J_d, m, g, rho, up } = *scene;
    Ok([
        in_lanes("compiled sum, in lanes", RigidBody { J_d } + Gravity { m, g, rho, up }),
        slices_in_lanes::<Interpreter>("interpreted, in lanes", declaration, values.clone()),
        slices_in_lanes::<Machine>("machine code, in lanes", declaration, values),
    ])
}

fn slices_in_lanes<B: BackendInLanes>(name: &str, declaration: &'static Declaration, values: Vec<f64>) -> Kernel {
    Kernel::new(name, move || {
        let (attitude, velocity) = top_start();
        let body = |_| {
            let stepper = Whole::<B>::of(declaration, &values, STEP, Method::default())?.into_joinable();
            let state = stepper.start(&entries(&attitude), &listed(&velocity))?;
            Ok::<_, Failure>((stepper, state))
        };
        let bodies = (0..LANES).map(body).collect::<Result<Vec<_>, _>>()?;
        let (mut bodies, _) = AnyStepper::abreast(&bodies).ok_or("no lanes")?;
        Ok(move |steps| {
            bodies.run(u64::from(steps / LANES));
            Ok(0)
        })
    })
}

fn started<S>(scene: S, (attitude, velocity): Start<S>) -> Result<(Stepper<S>, StateOf<S>), Failure>
where
    S: Regular<Scalar = f64>,
{
    let stepper = Stepper::new(scene, STEP)?;
    let state = stepper.start(attitude, velocity)?;
    Ok((stepper, state))
}

fn alone<S: Regular<Scalar = f64> + Clone + 'static>(name: &str, scene: S, start: Start<S>) -> Kernel {
    Kernel::new(name, move || {
        let (stepper, mut state) = started(scene.clone(), start)?;
        Ok(move |steps| {
            for _ in 0..steps {
                stepper.step(&mut state)?;
            }
            black_box(&state);
            Ok(0)
        })
    })
}

/// The step of a declaration as data.
fn on_slices<B: Backend<f64>, S: Regular<Scalar = f64> + 'static>(
    name: &str,
    declaration: &'static Declaration,
    values: Vec<f64>,
    (attitude, velocity): Start<S>,
) -> Kernel {
    Kernel::new(name, move || {
        let stepper: Whole<B> = Whole::of(declaration, &values, STEP, Method::default())?;
        stepper.prepare();
        let mut state = stepper.start(&entries(&attitude), &listed(&velocity))?;
        Ok(move |steps| {
            for _ in 0..steps {
                stepper.step(&mut state)?;
            }
            black_box(&state);
            Ok(0)
        })
    })
}

/// Eight scenes, which share the number of steps.
fn in_lanes<S>(name: &str, scene: S) -> Kernel
where
    S: Regular<Scalar = f64, Group = SO3> + Clone + 'static,
    Stepper<S>: Batchable<AutoF64x8> + Integrator<State = StateOf<S>> + 'static,
{
    Kernel::new(name, move || {
        let bodies = (0..LANES).map(|_| started(scene.clone(), top_start())).collect::<Result<Vec<_>, _>>()?;
        let mut batch = Batch::<AutoF64x8, _>::new(&bodies)?;
        Ok(move |steps| {
            batch.run(u64::from(steps / LANES));
            Ok(0)
        })
    })
}

/// Each text is derived anew, as it differs in its name.
fn first_steps() {
    let times = (0..20).map(|number| {
        let text = FullTop::DECLARATION.replace("FullTop", &format!("Top{number}"));
        let clock = Instant::now();
        let declaration = Declaration::parse(&text).expect("a declaration");
        let inertia = [2.0, 0.0, 0.0, 0.0, 2.5, 0.0, 0.0, 0.0, 3.0];
        let numbers: [(&str, &[f64]); 5] =
            [("J_d", &inertia), ("m", &[1.5]), ("g", &[9.81]), ("rho", &[0.1, 0.0, 0.4]), ("up", &[0.0, 0.0, 1.0])];
        let values = declaration.numbers(&numbers).expect("numbers");
        let stepper = Whole::<Machine>::of(declaration, &values, STEP, Method::default()).expect("a stepper");
        let (attitude, velocity) = top_start();
        let mut state = stepper.start(&entries(&attitude), &listed(&velocity)).expect("a start");
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
