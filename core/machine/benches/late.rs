//! A declaration that is read while a program runs, beside the compiled one:
//! `cargo bench -p liestep-machine --features cranelift`.
//!
//! Times of a step, in those of the compiled step; the time from a text to the first step, and from each text of the
//! repository to its machine code; `-- instructions` counts those of a step, by valgrind.

#[path = "../../../tests/benches/kernels/kernel.rs"]
mod kernel;

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

use kernel::{Effort, Failure, Group, Kernel, arguments, measure};

const STEP: f64 = 0.01;
const LANES: u32 = 8;
const EFFORT: Effort = Effort { batch: 1_000, rounds: 200, counted: 10_000 };

type LateTop<B> = Late<SO3, Vector3<f64>, WithKinetic, B>;

fn main() -> Result<(), Failure> {
    let words = arguments();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let (rho, up) = (Vector3::new(0.1, -0.2, 0.4), Vector3::z());
    let inertia = Inertia::from_principal_moments(Vector3::new(2.0, 2.5, 3.0))?;
    let fourth = FourthOrderTop { J: inertia, weight: 1.5 * 9.81, rho, up };
    let full = FullTop { J_d: inertia.to_nonstandard(), m: 1.5, g: 9.81, rho, up };
    let groups = vec![
        Group::new("(3.13), any inertia", EFFORT, kernels(full)?),
        Group::new("of the fourth order", EFFORT, kernels(fourth)?),
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

/// Kernels of a declaration: compiled, and read at run time in each way.
fn kernels<S>(scene: S) -> Result<[Kernel; 6], Failure>
where
    S: Regular<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Clone + 'static,
{
    let machine: LateTop<Machine> = Late::like(&scene)?;
    let interpreted: LateTop<Interpreter> = Late::like(&scene)?;
    Ok([
        alone("compiled", scene),
        alone("machine code", machine.clone()),
        alone("specialised", machine.clone().specialised()),
        alone("interpreted", interpreted.clone()),
        in_lanes("in lanes of eight", interpreted),
        in_lanes("machine code in lanes", machine),
    ])
}

fn started<S>(scene: S) -> Result<(Stepper<S>, StateOf<S>), Failure>
where
    S: Regular<Scalar = f64, Group = SO3>,
{
    let stepper = Stepper::new(scene, STEP)?;
    let state = stepper.start(SO3::exp(Vector3::new(0.8, 0.0, 0.0)), Vector3::new(0.5, 2.0, 6.0))?;
    Ok((stepper, state))
}

fn alone<S: Regular<Scalar = f64, Group = SO3> + Clone + 'static>(name: &str, scene: S) -> Kernel {
    Kernel::new(name, move || {
        let (stepper, mut state) = started(scene.clone())?;
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
        let bodies = (0..LANES).map(|_| started(scene.clone())).collect::<Result<Vec<_>, _>>()?;
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
        let late: LateTop<Machine> = Late::parse(&text).expect("a declaration");
        let inertia = [2.0, 0.0, 0.0, 0.0, 2.5, 0.0, 0.0, 0.0, 3.0];
        let numbers: [(&str, &[f64]); 5] =
            [("J_d", &inertia), ("m", &[1.5]), ("g", &[9.81]), ("rho", &[0.1, 0.0, 0.4]), ("up", &[0.0, 0.0, 1.0])];
        let late = numbers.iter().try_fold(late, |late, (name, value)| late.with(name, value)).expect("numbers");
        let (stepper, mut state) = started(late).expect("a start");
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
