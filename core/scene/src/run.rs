//! A run of one scene, and its samples.

use std::fmt;

use liestep::accuracy::{AccuracyError, Choice};
use liestep::groups::Advected;
use liestep::motion::{AnyState, AnyStepper};
use liestep::{SO3, SetupError, StepError};
use nalgebra::{Matrix3, Vector3};

use crate::columns::table;
use crate::file::{Places, SceneFile};

/// A state, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sample {
    /// Since the start, s.
    pub time: f64,
    /// Body to space.
    pub attitude: SO3,
    /// Body frame, kg m²/s.
    pub momentum: Vector3<f64>,
    /// Body frame, rad/s.
    pub velocity: Vector3<f64>,
    /// Of the continuous limit, J.
    pub energy: f64,
}

impl Sample {
    fn of<A: Advected<SO3>>(stepper: &AnyStepper<SO3, A>, state: &AnyState<SO3, A>) -> Self {
        Self {
            time: stepper.time(state),
            attitude: state.attitude(),
            momentum: state.momentum(),
            velocity: stepper.velocity(state),
            energy: stepper.energy(state),
        }
    }

    pub(crate) fn matrix(&self) -> Matrix3<f64> {
        use liestep::groups::LieGroup as _;
        self.attitude.matrix()
    }

    /// The angular momentum in space, kg m²/s.
    #[must_use]
    pub fn spatial_momentum(&self) -> Vector3<f64> {
        self.matrix() * self.momentum
    }
}

/// A run that couldn't be started or finished.
#[derive(Debug)]
pub(crate) enum Stopped {
    Setup(SetupError),
    Start(SetupError),
    Asked(AccuracyError),
    Step { time: f64, cause: StepError },
}

impl Stopped {
    /// Which part of a file it is about.
    pub(crate) fn place(&self, places: &Places) -> (usize, usize) {
        match self {
            Self::Setup(SetupError::InvalidStep { .. }) | Self::Asked(_) | Self::Step { .. } => places.pace,
            // What a method asks of a scene.
            Self::Setup(
                SetupError::NotSeparable { .. }
                | SetupError::InertiaMismatch { .. }
                | SetupError::BiasMismatch
                | SetupError::NoForceGradient,
            ) => places.method,
            Self::Setup(_) => places.body,
            Self::Start(_) => places.start,
        }
    }
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Setup(cause) | Self::Start(cause) => cause.fmt(f),
            Self::Asked(cause) => cause.fmt(f),
            Self::Step { time, cause } => write!(f, "stopped at t = {time} s: {cause}"),
        }
    }
}

/// A run that came to its end.
#[derive(Clone, Debug)]
pub struct Run {
    samples: Vec<Sample>,
    /// s.
    step: f64,
    steps: u64,
    /// Where an accuracy was asked for.
    choice: Option<Choice>,
}

/// Makes so many steps, and keeps the state at every `stride`-th and at the end.
pub(crate) fn make<A: Advected<SO3>>(
    stepper: &AnyStepper<SO3, A>,
    mut state: AnyState<SO3, A>,
    (steps, stride): (u64, u64),
    choice: Option<Choice>,
) -> Result<Run, Stopped> {
    let mut samples = vec![Sample::of(stepper, &state)];
    let mut done = 0;
    while done < steps {
        let next = stride.min(steps - done);
        if stepper.run(&mut state, next).is_err() {
            return Err(stopped(stepper, state, next));
        }
        done += next;
        samples.push(Sample::of(stepper, &state));
    }
    Ok(Run { samples, step: stepper.step_size(), steps, choice })
}

/// Where one of so many steps can't be made, and why.
fn stopped<A: Advected<SO3>>(stepper: &AnyStepper<SO3, A>, mut state: AnyState<SO3, A>, steps: u64) -> Stopped {
    for _ in 0..steps {
        if let Err(cause) = stepper.step(&mut state) {
            return Stopped::Step { time: stepper.time(&state), cause };
        }
    }
    // Not reached, as the same steps have the same bits; the state is finite, so this is a cause that says nothing else.
    Stopped::Step { time: stepper.time(&state), cause: StepError::NonFinite { what: "state" } }
}

impl Run {
    /// The states that were kept, the first and the last among them.
    #[must_use]
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The step, s.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// How many steps were made.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// What was chosen where an accuracy was asked for.
    #[must_use]
    pub fn choice(&self) -> Option<&Choice> {
        self.choice.as_ref()
    }

    /// The samples as comma-separated values, with the columns that the scene asks for.
    #[must_use]
    pub fn table(&self, scene: &SceneFile) -> String {
        table(scene.columns(), &self.samples)
    }

    /// A line about the beginning and the end, and the table of the choice if there was one.
    #[must_use]
    pub fn summary(&self, scene: &SceneFile) -> String {
        let (Some(first), Some(last)) = (self.samples.first(), self.samples.last()) else {
            return String::new();
        };
        let [before, after] = [first, last].map(|s| s.spatial_momentum().norm());
        let choice = self.choice.as_ref().map(ToString::to_string).unwrap_or_default();
        format!(
            "{}\n  {}, {} steps of {} s\n  energy {:.6} J → {:.6} J, momentum {:.6} → {:.6} kg m²/s\n{choice}",
            scene.title(),
            scene.sum(),
            self.steps,
            self.step,
            first.energy,
            last.energy,
            before,
            after,
        )
    }
}
