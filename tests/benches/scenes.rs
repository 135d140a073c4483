//! What an effect adds to a step: instructions and nanoseconds of scenes, sums against declarations in one piece.
//!
//! ```text
//! cargo bench --bench scenes                       times a step of every scene
//! cargo bench --bench scenes -- count NAME 1000    runs 1000 steps of one scene and nothing else
//! ```
//!
//! Instructions a step are a difference of two counts, as in `heavy_top_step.rs`. A scene with gravity is there four times:
//! without it, behind a run-time flag, with the coefficient zero, and with it.

// The letters of the field.
#![allow(non_snake_case)]

mod switched;

use core::hint::black_box;
use std::time::Instant;

use liestep::effects::{
    Dipole, Drag, Gravity, GravityGradient, MagneticDamping, PrincipalBody, Rotor, Spring, Thrust, Torque,
};
use liestep::{DiagonalNonstandardInertia, Inertia, Regular, SO3, Stepper, lagrangian};
use nalgebra::{UnitQuaternion, Vector3};

use switched::Switched;

const STEP: f64 = 0.01;
/// Long enough to hide the clock, short enough that a disturbance spoils few batches.
const BATCH: u32 = 20_000;
const ROUNDS: usize = 100;

/// (3.13) in one piece.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
struct HeavyTop {
    J_d: DiagonalNonstandardInertia,
    m: f64,
    g: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

/// Body and rotor in one piece.
#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + spin.dot(&vee(F)),
)]
struct Gyrostat {
    J_d: DiagonalNonstandardInertia,
    spin: Vector3<f64>,
}

/// What is done with each scene.
trait Visit {
    fn visit<L: Regular<Scalar = f64, Group = SO3>>(&mut self, name: &'static str, scene: L);
}

fn visit_all(visit: &mut impl Visit) {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).expect("a body");
    let (body, spin) = (PrincipalBody { J_d }, Vector3::new(0.1, 0.2, 0.3));
    let (m, g, rho, up) = (1.0, 9.81, Vector3::new(0.3, 0.2, 0.4), Vector3::z());
    let gravity = Gravity { m, g, rho, up };
    let J = Inertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).expect("a body");
    visit.visit("body", body);
    visit.visit("body + gravity", body + gravity);
    visit.visit("heavy top in one piece", HeavyTop { J_d, m, g, rho, up });
    visit.visit("body + gravity with m = 0", body + Gravity { m: 0.0, ..gravity });
    visit.visit("body + gravity, flag off", body + Switched { effect: gravity, on: false });
    visit.visit("body + gravity, flag on", body + Switched { effect: gravity, on: true });
    visit.visit("body + gravity gradient", body + GravityGradient { GM: 1.0, r: 1.0, J, direction: up });
    visit.visit("body + dipole", body + Dipole { moment: rho, field: up });
    visit.visit("body + spring", body + Spring { k: 1.0, length: 0.5, at: rho, anchor: up });
    visit.visit("body + rotor", body + Rotor { spin });
    visit.visit("body + torque", body + Torque { torque: spin * 1e-3 });
    visit.visit("body + thrust", body + Thrust { at: rho, thrust: spin * 1e-3 });
    visit.visit("body + drag", body + Drag { c: 1e-3, J });
    visit.visit("body + magnetic damping", body + MagneticDamping { k: 1e-3, field: rho, J });
    visit.visit("gyrostat in one piece", Gyrostat { J_d, spin });
}

#[inline(never)]
fn run<L: Regular<Scalar = f64, Group = SO3>>(
    stepper: &Stepper<L>,
    state: &mut liestep::State<SO3, L::Advected>,
    steps: u32,
) {
    for _ in 0..steps {
        stepper.step(state).expect("a solvable step");
    }
}

/// The scene, with the tilt and the spin of the thesis' looping top.
fn start<L: Regular<Scalar = f64, Group = SO3>>(scene: L) -> (Stepper<L>, liestep::State<SO3, L::Advected>) {
    let stepper = Stepper::new(scene, STEP).expect("a usable step");
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
    let state = stepper.start(attitude, Vector3::new(0.5, 2.0, 12.0)).expect("a usable start");
    (stepper, state)
}

/// Times every scene.
struct Time;

impl Visit for Time {
    fn visit<L: Regular<Scalar = f64, Group = SO3>>(&mut self, name: &'static str, scene: L) {
        let (stepper, first) = start(scene);
        let mut times: Vec<f64> = (0..ROUNDS)
            .map(|_| {
                // From the beginning: a torque would wind the body up until no step can be made.
                let mut state = first;
                let start = Instant::now();
                run(black_box(&stepper), black_box(&mut state), BATCH);
                start.elapsed().as_secs_f64() * 1e9 / f64::from(BATCH)
            })
            .collect();
        times.sort_by(f64::total_cmp);
        println!("{name:<28}{:>8.1} ns a step", times[ROUNDS / 2]);
    }
}

/// Runs one scene.
struct Count<'a> {
    wanted: &'a str,
    steps: u32,
    found: bool,
}

impl Visit for Count<'_> {
    fn visit<L: Regular<Scalar = f64, Group = SO3>>(&mut self, name: &'static str, scene: L) {
        if name == self.wanted {
            self.found = true;
            let (stepper, mut state) = start(scene);
            run(black_box(&stepper), black_box(&mut state), self.steps);
        }
    }
}

fn main() {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    if let [word, wanted, steps] = arguments.as_slice()
        && word == "count"
    {
        let mut count = Count { wanted, steps: steps.parse().expect("a number of steps"), found: false };
        visit_all(&mut count);
        assert!(count.found, "there is no scene `{wanted}`");
        return;
    }
    visit_all(&mut Time);
}
