//! A run of one scene, and its samples.

use std::fmt;

use liestep::accuracy::{Accuracy, AccuracyError, Choice};
use liestep::groups::{Advected, LieGroup as _};
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::motion::{AnyState, Motion};
use liestep::{SO3, SetupError, State, StepError, Stepper};
use nalgebra::{Matrix3, Vector3};
use workbench::csv;

use super::file::SceneFile;

/// A state, in SI units.
#[derive(Clone, Copy)]
pub(crate) struct Sample {
    pub(super) time: f64,
    /// Body to space.
    pub(super) attitude: Matrix3<f64>,
    /// Body frame.
    pub(super) momentum: Vector3<f64>,
    /// Body frame.
    pub(super) velocity: Vector3<f64>,
    pub(super) energy: f64,
}

impl Sample {
    fn of<A: Advected<SO3>>(state: &Motion<SO3, A>, time: f64, velocity: Vector3<f64>, energy: f64) -> Self {
        Self { time, attitude: state.attitude().matrix(), momentum: state.momentum(), velocity, energy }
    }

    pub(super) fn spatial_momentum(&self) -> Vector3<f64> {
        self.attitude * self.momentum
    }
}

/// A run that couldn't be started or finished.
#[derive(Debug)]
pub(crate) enum Stopped {
    Setup(SetupError),
    Asked(AccuracyError),
    Step { time: f64, cause: StepError },
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Setup(cause) => cause.fmt(f),
            Self::Asked(cause) => cause.fmt(f),
            Self::Step { time, cause } => write!(f, "stopped at t = {time} s: {cause}"),
        }
    }
}

impl std::error::Error for Stopped {}

impl From<SetupError> for Stopped {
    fn from(cause: SetupError) -> Self {
        Self::Setup(cause)
    }
}

impl From<AccuracyError> for Stopped {
    fn from(cause: AccuracyError) -> Self {
        Self::Asked(cause)
    }
}

/// A run that came to its end.
pub(crate) struct Run {
    pub(crate) samples: Vec<Sample>,
    /// s.
    pub(super) step: f64,
    steps: u64,
    /// Where an accuracy was asked for.
    choice: Option<Choice>,
}

/// More samples than a picture has room for.
const MOST_SAMPLES: u64 = 20_000;

/// The samples of a run of so many steps, from the state and by the step given.
fn sampled<S>(
    steps: u64,
    mut state: S,
    mut step: impl FnMut(&mut S) -> Result<(), Stopped>,
    sample: impl Fn(&S) -> Sample,
) -> Result<Vec<Sample>, Stopped> {
    let mut samples = vec![sample(&state)];
    let stride = steps.div_ceil(MOST_SAMPLES);
    for number in 1..=steps {
        step(&mut state)?;
        if number % stride == 0 || number == steps {
            samples.push(sample(&state));
        }
    }
    Ok(samples)
}

/// A run of a file's scene by these steps.
pub(super) struct Task<'a> {
    pub(super) file: &'a SceneFile,
    /// s.
    pub(super) step: f64,
    pub(super) steps: u32,
}

/// A run of a file's scene that isn't to be wrong by more at its end.
pub(super) struct Question<'a> {
    pub(super) file: &'a SceneFile,
    pub(super) tolerance: f64,
}

/// Makes the steps of a scene.
pub(super) fn simulate<L>(scene: L, task: &Task<'_>) -> Result<Run, Stopped>
where
    L: Regular<Scalar = f64, Group = SO3>,
{
    let stepper = Stepper::new(scene, task.step)?;
    let state = stepper.start(task.file.start.attitude, task.file.start.velocity)?;
    let advance = |state: &mut _| match stepper.step(state) {
        Ok(_) => Ok(()),
        Err(cause) => Err(Stopped::Step { time: stepper.time(state), cause }),
    };
    let sample = |state: &State<SO3, L::Advected>| {
        Sample::of(state, stepper.time(state), stepper.velocity(state), stepper.energy(state))
    };
    let (step, steps) = (task.step, u64::from(task.steps));
    Ok(Run { samples: sampled(steps, state, advance, sample)?, step, steps, choice: None })
}

/// Makes the steps that an accuracy takes.
pub(super) fn ask<L>(scene: L, question: &Question<'_>) -> Result<Run, Stopped>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected: 'static> + Regular + Clone + 'static,
{
    let Question { file, tolerance } = *question;
    let accuracy = Accuracy { tolerance, horizon: file.run.duration };
    let stepper = Stepper::for_accuracy(scene, accuracy, file.start.attitude, file.start.velocity)?;
    let advance = |state: &mut _| match stepper.step(state) {
        Ok(_) => Ok(()),
        Err(cause) => Err(Stopped::Step { time: stepper.time(state), cause }),
    };
    let sample = |state: &AnyState<SO3, L::Advected>| {
        Sample::of(state, stepper.time(state), stepper.velocity(state), stepper.energy(state))
    };
    let choice = stepper.choice().clone();
    let samples = sampled(choice.steps, stepper.start(), advance, sample)?;
    Ok(Run { samples, step: stepper.step_size(), steps: choice.steps, choice: Some(choice) })
}

/// The samples as comma-separated values.
pub(crate) fn table(samples: &[Sample]) -> String {
    let names = [
        "time_s",
        "omega_x_rad_per_s",
        "omega_y_rad_per_s",
        "omega_z_rad_per_s",
        "spatial_momentum_x_kg_m2_per_s",
        "spatial_momentum_y_kg_m2_per_s",
        "spatial_momentum_z_kg_m2_per_s",
        "energy_J",
        "axis_x",
        "axis_y",
        "axis_z",
    ];
    let row = |s: &Sample| {
        let (o, p, a) = (s.velocity, s.spatial_momentum(), s.attitude.column(2));
        [s.time, o.x, o.y, o.z, p.x, p.y, p.z, s.energy, a.x, a.y, a.z]
    };
    csv::table(names, samples.iter().map(row))
}

impl Run {
    /// A line about the beginning and the end, and the table of the choice if there was one.
    pub(crate) fn summary(&self, file: &SceneFile) -> String {
        let (Some(first), Some(last)) = (self.samples.first(), self.samples.last()) else {
            return String::new();
        };
        let [before, after] = [first, last].map(|s| s.spatial_momentum().norm());
        let choice = self.choice.as_ref().map(ToString::to_string).unwrap_or_default();
        format!(
            "{}\n  {}, {} steps of {} s\n  energy {:.6} J → {:.6} J, momentum {:.6} → {:.6} kg m²/s\n{choice}",
            file.title,
            file.sum(),
            self.steps,
            self.step,
            first.energy,
            last.energy,
            before,
            after,
        )
    }
}
