//! Scenes and their visitors, compiled identically into every program that counts their steps.

use core::hint::black_box;
use std::time::Instant;

use liestep::groups::LieGroup;
use liestep::mechanics::Regular;
use liestep::motion::Plan;
use liestep::{SO3, StateOf, Stepper};
use nalgebra::{UnitQuaternion, Vector3, Vector6};

const STEP: f64 = 0.01;
/// Long enough to hide the clock, short enough that a disturbance spoils few batches.
const BATCH: u32 = 20_000;
const ROUNDS: usize = 100;

/// A stepper and an initial state.
pub(crate) type Ready<L, P> = (Stepper<L, P>, StateOf<L, P>);

/// A visitor of scenes.
pub(crate) trait Visit {
    fn visit<L: Regular<Scalar = f64, Group: Begin>>(&mut self, name: &'static str, scene: L) {
        let stepper = Stepper::new(scene, STEP).expect("a usable step");
        let (attitude, velocity) = L::Group::begin();
        let state = stepper.start(attitude, velocity).expect("a usable start");
        self.visit_from(name, (stepper, state));
    }

    /// Visits a scene with any plan, from a state.
    fn visit_from<L: Regular<Scalar = f64>, P: Plan<L>>(&mut self, name: &'static str, ready: Ready<L, P>);
}

#[inline(never)]
fn run<L: Regular<Scalar = f64>, P: Plan<L>>(stepper: &Stepper<L, P>, state: &mut StateOf<L, P>, steps: u32) {
    for _ in 0..steps {
        stepper.step(state).expect("a solvable step");
    }
}

/// The initial state of a group's scenes.
pub(crate) trait Begin: LieGroup<Scalar = f64> {
    fn begin() -> (Self, Self::Vector);
}

/// The tilt and the spin of the thesis' looping top.
impl Begin for SO3 {
    fn begin() -> (Self, Vector3<f64>) {
        let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
        (attitude.into(), Vector3::new(0.5, 2.0, 12.0))
    }
}

/// Two links that swing.
impl Begin for (SO3, SO3) {
    fn begin() -> (Self, Vector6<f64>) {
        let attitude = |angle: f64| SO3::from(UnitQuaternion::from_scaled_axis(Vector3::new(angle, 0.0, 0.0)));
        ((attitude(0.8), attitude(-0.4)), Vector6::new(0.5, -1.0, 2.0, 1.0, 0.3, -0.5))
    }
}

/// Times every scene.
pub(crate) struct Time;

impl Visit for Time {
    fn visit_from<L: Regular<Scalar = f64>, P: Plan<L>>(&mut self, name: &'static str, (by, from): Ready<L, P>) {
        let mut times: Vec<f64> = (0..ROUNDS)
            .map(|_| {
                // Each batch starts anew: a torque would accelerate the body until no step is solvable.
                let mut state = from;
                let start = Instant::now();
                run(black_box(&by), black_box(&mut state), BATCH);
                start.elapsed().as_secs_f64() * 1e9 / f64::from(BATCH)
            })
            .collect();
        times.sort_by(f64::total_cmp);
        println!("{name:<28}{:>8.1} ns a step", times[ROUNDS / 2]);
    }
}

/// The visitor that runs one scene.
pub(crate) struct Count<'a> {
    wanted: &'a str,
    steps: u32,
    /// Whether the scene exists.
    pub(crate) found: bool,
}

impl<'a> Count<'a> {
    pub(crate) fn new(wanted: &'a str, steps: u32) -> Self {
        Self { wanted, steps, found: false }
    }
}

impl Visit for Count<'_> {
    fn visit_from<L: Regular<Scalar = f64>, P: Plan<L>>(&mut self, name: &'static str, (by, mut from): Ready<L, P>) {
        if name == self.wanted {
            self.found = true;
            run(black_box(&by), black_box(&mut from), self.steps);
        }
    }
}
