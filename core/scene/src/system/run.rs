//! The run of a system.

use liestep::groups::LieGroup as _;
use liestep::motion::Moment;
use liestep::with::{RunError, Sink};
use liestep::{SO3, SetupError, StepError};
use nalgebra::Vector3;

use super::file::{BODIES, LOOPS, System};
use super::held::Held;
use crate::columns::drawn;
use crate::mistake::Mistake;

/// The systems that there are, the smallest first. With loops there is the largest only: each is code of its own.
pub(super) const SIZES: [Size; 4] =
    [Size::of::<2, 0>(), Size::of::<4, 0>(), Size::of::<BODIES, 0>(), Size::of::<BODIES, LOOPS>()];

/// A system of so many bodies and loops.
#[derive(Clone, Copy)]
pub(super) struct Size {
    pub(super) bodies: usize,
    pub(super) loops: usize,
    simulate: Simulate,
}

/// Simulates so many steps.
type Simulate = fn(&System, u64, &mut dyn FnMut(f64), Option<&mut dyn Sink>) -> Result<SystemRun, Mistake>;

impl Size {
    const fn of<const N: usize, const L: usize>() -> Self {
        Self { bodies: N, loops: L, simulate: System::simulate_in::<N, L> }
    }
}

/// What tells how far joints are open.
const GAP: &str = "lengths in m and cosines of axes together";

/// A state, in SI units.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SystemSample {
    /// Since the start, s.
    pub time: f64,
    /// In the order of the file.
    pub bodies: Vec<BodySample>,
    /// Of the continuous limit, J.
    pub energy: f64,
    /// Of all, kg m/s.
    pub momentum: Vector3<f64>,
    /// Of all, about the origin, kg m²/s.
    pub angular_momentum: Vector3<f64>,
    /// Of the joint that is open farthest, m; of pins with the cosines of their axes.
    pub gap: f64,
}

/// The state of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BodySample {
    /// Body to space.
    pub attitude: SO3,
    /// The same as `w, x, y, z`, of the two that nearer to the sample before.
    pub quaternion: [f64; 4],
    /// Of the centre of mass in space, m.
    pub position: Vector3<f64>,
    /// Body frame, rad/s.
    pub velocity: Vector3<f64>,
    /// Of the centre of mass in space, m/s.
    pub moving: Vector3<f64>,
}

/// A run that came to its end.
#[derive(Clone, Debug)]
pub struct SystemRun {
    samples: Vec<SystemSample>,
    step: f64,
    steps: u64,
}

impl SystemRun {
    /// The states that were kept for pictures, the first and the last among them: those of each `k`-th step
    /// between, with the least `k` for which that is 20 000 at most.
    #[must_use]
    pub fn samples(&self) -> &[SystemSample] {
        &self.samples
    }

    /// How many steps were made.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Lines about the beginning and the end.
    #[must_use]
    pub fn summary(&self, system: &System) -> String {
        let (Some(first), Some(last)) = (self.samples.first(), self.samples.last()) else { return String::new() };
        let widest = self.samples.iter().map(|sample| sample.gap).fold(0.0, f64::max);
        let unit = if system.has_pins() { "(m and cosines)" } else { "m" };
        let joints = if system.joints.is_empty() {
            String::new()
        } else {
            format!(", joints open by {widest:.1e} {unit} at most")
        };
        format!(
            "{}\n  {}, {} steps of {} s\n  energy {:.6} J → {:.6} J{joints}\n",
            system.title,
            system.sum(),
            self.steps,
            self.step,
            first.energy,
            last.energy,
        )
    }
}

/// The states of a run, one after the other.
struct Samples<'a, const N: usize, const L: usize> {
    stepper: &'a Held<N, L>,
    /// Of the bodies that the file has.
    quaternions: Vec<[f64; 4]>,
}

impl<const N: usize, const L: usize> Samples<'_, N, L> {
    fn of(&mut self, now: &Moment<'_, Held<N, L>>) -> SystemSample {
        let (attitudes, momenta, velocities) = (now.attitude(), now.momentum(), now.velocity());
        let three = |of: &nalgebra::Vector6<f64>, first: usize| of.fixed_rows::<3>(first).into_owned();
        let (mut momentum, mut angular_momentum) = (Vector3::zeros(), Vector3::zeros());
        let bodies = self.quaternions.iter_mut().enumerate().map(|(place, quaternion)| {
            let (attitude, position) = (attitudes[place].0, attitudes[place].1.translation());
            let (turning, linear) = (three(&momenta.0[place], 0), three(&momenta.0[place], 3));
            momentum += linear;
            angular_momentum += attitude.as_matrix() * turning + position.cross(&linear);
            attitude.write_numbers(quaternion);
            let velocity = &velocities.0[place];
            BodySample {
                attitude,
                quaternion: *quaternion,
                position,
                velocity: three(velocity, 0),
                moving: three(velocity, 3),
            }
        });
        let bodies = bodies.collect();
        let (energy, gap) = (now.energy(), self.stepper.widest_gap(now));
        SystemSample { time: now.time(), bodies, energy, momentum, angular_momentum, gap }
    }
}

impl System {
    /// Simulates the system.
    ///
    /// # Errors
    ///
    /// A [`Mistake`] of the kind [`Run`](crate::Kind::Run) where it can't be started or a step not be made.
    pub fn run(&self) -> Result<SystemRun, Mistake> {
        self.run_told(&mut |_| ())
    }

    /// As [`run`](Self::run), with a function that is told a hundred times what share of the run is made, from 0 to 1.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub fn run_told(&self, told: &mut dyn FnMut(f64)) -> Result<SystemRun, Mistake> {
        self.simulate(u64::from(self.steps), told, None)
    }

    /// As [`run_told`](Self::run_told), and writes the [columns](Self::columns), a row of each `every`-th step and of the last, as they
    /// come.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run), and of the kind [`Table`](crate::Kind::Table) where a row can't be written.
    pub fn run_recorded(&self, told: &mut dyn FnMut(f64), table: &mut dyn Sink) -> Result<SystemRun, Mistake> {
        self.simulate(u64::from(self.steps), told, Some(table))
    }

    /// Simulates so many steps at most.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub fn first(&self, most: u32) -> Result<SystemRun, Mistake> {
        self.simulate(u64::from(most.min(self.steps)), &mut |_| (), None)
    }

    /// In a system with room for its bodies and loops.
    fn simulate(
        &self,
        steps: u64,
        told: &mut dyn FnMut(f64),
        table: Option<&mut dyn Sink>,
    ) -> Result<SystemRun, Mistake> {
        (self.arranged.size.simulate)(self, steps, told, table)
    }

    fn simulate_in<const N: usize, const L: usize>(
        &self,
        steps: u64,
        told: &mut dyn FnMut(f64),
        mut table: Option<&mut dyn Sink>,
    ) -> Result<SystemRun, Mistake> {
        let stepper = self.stepper::<N, L>().map_err(|error| self.refused(error))?;
        let (bodies, velocities) = self.start();
        let started =
            if self.nearest { stepper.start_nearest(bodies, velocities) } else { stepper.start(bodies, velocities) };
        let mut state = started.map_err(|error| self.refused(error))?;
        let failed = |error: &dyn std::fmt::Display| {
            Mistake::of_table(&self.path, format!("the table can't be written: {error}"))
        };
        if let Some(table) = &mut table {
            table.begin(&self.columns()).map_err(|error| failed(&error))?;
        }
        let (mut drawing, mut kept) = (Samples::new(self, &stepper), Vec::new());
        let (mut writing, mut written) = (Samples::new(self, &stepper), None);
        let observed = stepper
            .observed(&mut state)
            .every(drawn(steps), |now| kept.push(drawing.of(now)))
            .every(self.output.stride(steps), |now| {
                let Some(table) = &mut table else { return Ok(()) };
                written = Some(now.time());
                table.write(&self.output.row(&writing.of(now)))
            })
            .progress(told);
        let ended = observed.steps(steps);
        let now = Moment::of_step(&stepper, &state);
        if kept.last().is_none_or(|sample: &SystemSample| sample.time < now.time()) {
            kept.push(Samples::new(self, &stepper).of(&now));
        }
        let mut closed = Ok(());
        if let Some(table) = &mut table {
            if written < Some(now.time()) {
                closed = table.write(&self.output.row(&writing.of(&now)));
            }
            closed = closed.and(table.end());
        }
        ended.map_err(|error| match error {
            RunError::Step { time, cause } => self.stopped(time, &cause),
            RunError::Observer { cause, .. } => failed(&cause),
            other => Mistake::of_run(&self.path, self.places.pace, other.to_string()),
        })?;
        closed.map_err(|error| failed(&error))?;
        Ok(SystemRun { samples: kept, step: self.step, steps })
    }

    /// Where the joint is that the library gives this number.
    fn of_joint(&self, joint: usize) -> (usize, usize) {
        self.arranged.number(joint).map_or(self.places.pace, |joint| self.places.joints[joint])
    }

    /// Why it can't be started, with the place of the body or the joint.
    fn refused(&self, error: SetupError) -> Mistake {
        let (place, message) = match error {
            SetupError::OffConstraint { joint, by } => {
                let message = if self.nearest {
                    format!(
                        "no places next to these were found where the joints are closed: this one stays open by {by:e} ({GAP}); give places nearer to such, or other joints"
                    )
                } else {
                    format!(
                        "this joint is open by {by:e} ({GAP}) at the start; give other places, or let `nearest = true` of `run` close the joints"
                    )
                };
                (self.of_joint(joint), message)
            }
            SetupError::OffVelocity { joint, by } => {
                let message = if self.nearest {
                    format!(
                        "no velocities next to these were found that keep this joint closed: they open it by {by:e} ({GAP}, per second); give others"
                    )
                } else {
                    format!(
                        "the velocities open this joint by {by:e} ({GAP}, per second); give others, or let `nearest = true` of `run` find those next to them"
                    )
                };
                (self.of_joint(joint), message)
            }
            SetupError::RedundantJoint { joint, pivot } => {
                let message = format!(
                    "the other joints, or its own functions, do a part of what this one is to do (pivot {pivot:e}); leave it out, or make a `pin` a `ball`"
                );
                (self.of_joint(joint), message)
            }
            SetupError::Joint { joint, cause } => {
                (self.of_joint(joint), format!("this joint {cause}; check the bodies that it joins"))
            }
            SetupError::JointParameter { joint, field, cause } => {
                (self.of_joint(joint), format!("parameter `{field}` of this joint {cause}; give it another value"))
            }
            SetupError::BodyParameter { body, field, cause } if body < self.bodies.len() => {
                let name = &self.bodies[body].name;
                let message = format!("parameter `{field}` of the body `{name}` {cause}; give it another value");
                (self.places.bodies[body], message)
            }
            error => (self.places.pace, error.to_string()),
        };
        Mistake::of_run(&self.path, place, message)
    }

    /// Why a step can't be made.
    fn stopped(&self, time: f64, cause: &StepError) -> Mistake {
        let (place, why) = match *cause {
            StepError::SingularJoint { joint, pivot } => {
                let why = format!(
                    "this joint comes to a singular position (pivot {pivot:e}), where its force isn't determined; make a `pin` a `ball`, take a smaller `step`, or another start"
                );
                (self.of_joint(joint), why)
            }
            StepError::UnsolvedBody { body, turn, determinant } if body < self.bodies.len() => {
                let name = &self.bodies[body].name;
                let why = format!(
                    "no increment of the body `{name}` that continues the identity: it would turn by {turn:.2e} rad, and its part of the Jacobian has the determinant {determinant:e}; take a smaller `step`"
                );
                (self.places.bodies[body], why)
            }
            _ => (self.places.pace, cause.to_string()),
        };
        Mistake::of_run(&self.path, place, format!("stopped at t = {time} s: {why}"))
    }
}

impl<'a, const N: usize, const L: usize> Samples<'a, N, L> {
    fn new(system: &System, stepper: &'a Held<N, L>) -> Self {
        Self { stepper, quaternions: vec![[0.0; 4]; system.bodies.len()] }
    }
}
