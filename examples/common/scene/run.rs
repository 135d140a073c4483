//! A run of one scene, and its samples.

use std::fmt;

use liestep::{LieGroup as _, Regular, SO3, SetupError, StepError, Stepper};
use nalgebra::{Matrix3, Vector3};

use super::file::SceneFile;
use crate::csv;

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
    pub(super) fn spatial_momentum(&self) -> Vector3<f64> {
        self.attitude * self.momentum
    }
}

/// A run that couldn't be started or finished.
#[derive(Debug)]
pub(crate) enum Stopped {
    Setup(SetupError),
    Step { time: f64, cause: StepError },
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Setup(cause) => cause.fmt(f),
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

/// More samples than a picture has room for.
const MOST_SAMPLES: u32 = 20_000;

/// Makes the steps of a scene.
pub(super) fn simulate<L: Regular<Scalar = f64, Group = SO3>>(
    scene: L,
    file: &SceneFile,
) -> Result<Vec<Sample>, Stopped> {
    let stepper = Stepper::new(scene, file.run.step)?;
    let mut state = stepper.start(file.start.attitude, file.start.velocity)?;
    let sample = |state: &_| Sample {
        time: stepper.time(state),
        attitude: state.attitude().matrix(),
        momentum: state.momentum(),
        velocity: stepper.velocity(state),
        energy: stepper.energy(state),
    };
    let mut samples = vec![sample(&state)];
    let stride = file.run.steps.div_ceil(MOST_SAMPLES);
    for step in 1..=file.run.steps {
        stepper.step(&mut state).map_err(|cause| Stopped::Step { time: stepper.time(&state), cause })?;
        if step % stride == 0 || step == file.run.steps {
            samples.push(sample(&state));
        }
    }
    Ok(samples)
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

/// A line about the beginning and the end.
pub(crate) fn summary(file: &SceneFile, samples: &[Sample]) -> String {
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else {
        return String::new();
    };
    let [before, after] = [first, last].map(|s| s.spatial_momentum().norm());
    format!(
        "{}\n  {}, {} steps of {} s\n  energy {:.6} J → {:.6} J, momentum {:.6} → {:.6} kg m²/s\n",
        file.title,
        file.sum(),
        file.run.steps,
        file.run.step,
        first.energy,
        last.energy,
        before,
        after,
    )
}
