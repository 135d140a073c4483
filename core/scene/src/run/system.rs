//! The run of a system of several bodies.

use std::error::Error;
use std::sync::Arc;

use liestep::methods::{MultibodyStepper, Redundancy};
use liestep::motion::{AnyStepper, Moment};
use liestep::recording::{self, Sink};
use liestep::{SO3, SetupError, StepError};
use nalgebra::{Matrix3, Vector3};

use crate::file::body::Kinetic;
use crate::file::joint::{Joint, Limits, Pose};
use crate::file::mistake::Mistake;
use crate::file::part::{Between, SystemBody};
use crate::file::quantity::{round, short};
use crate::file::sample::{BodySample, Sample};
use crate::file::system::System;
use crate::run::course::MemberStart;
use crate::run::course::{kind, of_any};
use crate::run::make::{Course, EventFunction, Listeners, Note, Run, Stop, fast_turn, make, told};

/// The quantity that violates a constraint, for messages.
const GAP: &str = "lengths in m and cosines of axes together";

fn pose(stepper: &MultibodyStepper, state: &[f64], body: Option<usize>) -> Pose {
    let Some(body) = body else { return (Matrix3::identity(), Vector3::zeros()) };
    let (attitude, place) = stepper.attitude(state, body);
    (*attitude.as_matrix(), place.translation())
}

/// The angle and the shift of a joint, see [`Joint::coordinates`].
fn coordinates(joint: &Between<Joint>, stepper: &MultibodyStepper, state: &[f64]) -> [f64; 2] {
    let [above, below] = joint.bodies.map(|body| pose(stepper, state, body));
    joint.of.coordinates([&above, &below])
}

/// The function that rises through zero where a joint passes one of its limits.
fn beyond(joint: &Between<Joint>, limits: Limits, stepper: &MultibodyStepper, state: &[f64]) -> f64 {
    let [from, to] = limits.ends;
    let (middle, half, [angle, shift]) = ((from + to) * 0.5, (to - from) * 0.5, coordinates(joint, stepper, state));
    // Both are smooth at the middle, and the cosine at a whole turn, unlike the angle.
    if joint.of.kind.turns_about_axis() {
        half.cos() - (angle - middle).cos()
    } else {
        (shift - middle).powi(2) - half * half
    }
}

/// The bodies at this moment, with the numbers of all columns; forces and torques of joints, for which a step is made, are
/// computed on request.
fn sample(system: &System, stepper: &MultibodyStepper, now: &Moment<'_, AnyStepper>, has_reactions: bool) -> Sample {
    let mut sample = bodies_at(stepper, now);
    let Sample { bodies, energy, momentum, angular_momentum, gap, .. } = &sample;
    let mut numbers: Vec<f64> = Vec::new();
    numbers.extend(bodies.iter().flat_map(|body| &body.position));
    let first = numbers.len();
    numbers.extend(bodies.iter().flat_map(|body| body.quaternion));
    numbers.extend(bodies.iter().flat_map(|body| &body.velocity));
    numbers.extend(bodies.iter().flat_map(|body| &body.moving));
    numbers.push(*energy);
    numbers.extend(momentum.iter().chain(angular_momentum));
    numbers.push(*gap);
    let coordinates: Vec<_> = system
        .joints
        .iter()
        .map(|joint| (joint.of.kind, joint.of.sign, coordinates(joint, stepper, now.numbers())))
        .collect();
    let turning = coordinates.iter().filter(|(kind, ..)| kind.turns_about_axis());
    numbers.extend(turning.map(|(_, sign, [angle, _])| sign * angle));
    let shifting = coordinates.iter().filter(|(kind, ..)| kind.shifts_along_axis());
    numbers.extend(shifting.map(|(_, sign, [_, shift])| sign * shift));
    if has_reactions {
        let none = || vec![[Vector3::repeat(f64::NAN); 2]; system.joints.len()];
        let forces = stepper.joint_forces(now.numbers()).unwrap_or_else(|_| none());
        numbers.extend(forces.iter().flat_map(|[force, _]| force));
        for (joint, [force, torque]) in system.joints.iter().zip(&forces) {
            // About the joint's point, which the bodies share in most kinds.
            let arm = pose(stepper, now.numbers(), joint.bodies[1]).0 * joint.of.at[1];
            numbers.extend(&(torque - arm.cross(force)));
        }
    }
    sample.quaternions = (first..first + 4 * sample.bodies.len()).step_by(4).collect();
    sample.numbers = numbers;
    sample
}

/// The state of the bodies at this moment.
fn bodies_at(stepper: &MultibodyStepper, now: &Moment<'_, AnyStepper>) -> Sample {
    let (momenta, velocities) = (now.momentum(), now.velocity());
    let (mut momentum, mut angular_momentum) = (Vector3::zeros(), Vector3::zeros());
    let body = |body: usize| {
        let (attitude, place) = stepper.attitude(now.numbers(), body);
        let three = |of: &[f64], first: usize| Vector3::from_column_slice(&of[6 * body + first..][..3]);
        let (position, turning, linear) = (place.translation(), three(momenta, 0), three(momenta, 3));
        momentum += linear;
        angular_momentum += attitude.as_matrix() * turning + position.cross(&linear);
        let body = BodySample::turning(attitude, three(&velocities, 0), turning);
        BodySample { position, moving: three(&velocities, 3), ..body }
    };
    let bodies = (0..stepper.bodies()).map(body).collect();
    let (energy, gap) = (now.energy(), stepper.widest_gap(now.numbers()));
    let (numbers, quaternions) = (Vec::new(), [].into());
    Sample { time: now.time(), bodies, numbers, quaternions, energy, momentum, angular_momentum, gap }
}

/// The note about functions of a joint that are left out.
fn left_out_of(one: &Redundancy) -> String {
    let Redundancy { functions, .. } = *one;
    let functions = if functions == 1 {
        "one function of this joint is".to_owned()
    } else {
        format!("{functions} functions of this joint are")
    };
    format!("{functions} implied by the other joints, and left out; the motion is the same")
}

impl System {
    /// Simulates the system.
    ///
    /// # Errors
    ///
    /// A [`Mistake`] of the kind [`Run`](crate::Kind::Run) where the system can't be started or a step fails.
    pub fn run(&self) -> Result<Run, Mistake> {
        self.run_with(&mut |_| (), None)
    }

    /// Simulates the system, see [`SceneFile::run_with`](crate::SceneFile::run_with).
    ///
    /// # Errors
    ///
    /// The errors of [`run`](Self::run), and one of the kind [`Table`](crate::Kind::Table) where a row can't be
    /// written.
    pub fn run_with<'a>(
        &self,
        progress: &'a mut dyn FnMut(f64),
        table: Option<&'a mut dyn Sink>,
    ) -> Result<Run, Mistake> {
        self.simulate(u64::from(self.steps), Listeners { progress, table }).map_err(|stop| self.mistake(stop))
    }

    /// Simulates the system up to a number of steps.
    ///
    /// # Errors
    ///
    /// The errors of [`run`](Self::run).
    pub fn first(&self, most: u32) -> Result<Run, Mistake> {
        let first = self.simulate(u64::from(most.min(self.steps)), Listeners { progress: &mut |_| (), table: None });
        first.map_err(|stop| self.mistake(stop))
    }

    /// The stepper of the system, with its initial state.
    ///
    /// # Errors
    ///
    /// A [`Mistake`] of the kind [`Run`](crate::Kind::Run) where the system can't be started.
    pub fn stepper(&self) -> Result<MemberStart, Mistake> {
        let start = || {
            let (stepper, _) = self.multibody().map_err(Stop::Setup)?;
            let state = self.start(&stepper).map_err(Stop::Start)?;
            let places: Vec<_> = (0..self.bodies.len()).map(|body| stepper.attitude(&state, body)).collect();
            self.check_springs(&places)?;
            let any = AnyStepper::new(stepper);
            let state = any.state_of(&state).ok_or_else(|| Stop::Other("a state of another system".to_owned()))?;
            Ok((any, state))
        };
        start().map_err(|stop| self.mistake(stop))
    }

    pub(crate) fn simulate(&self, steps: u64, listeners: Listeners<'_>) -> Result<Run, Stop> {
        let (stepper, left_out) = self.multibody().map_err(Stop::Setup)?;
        let state = self.start(&stepper).map_err(Stop::Start)?;
        let places: Vec<_> = (0..self.bodies.len()).map(|body| stepper.attitude(&state, body)).collect();
        let of_springs = self.check_springs(&places)?;
        let any = AnyStepper::new(stepper.clone());
        let state = any.state_of(&state).ok_or_else(|| Stop::Other("a state of another system".to_owned()))?;
        let (stride, columns) = (self.output.stride(steps), self.columns.as_slice());
        let course = Course { steps, end: f64::INFINITY, stride, columns, listed: self.columns() };
        let has_reactions = self.has_reactions();
        let sample = |now: &Moment<'_, AnyStepper>| sample(self, &stepper, now, has_reactions);
        let mut run = make(&any, state, course, sample, self.watches(&stepper), listeners)?;
        let of_springs = of_springs.map(|(spring, why)| (self.places.springs[spring], why));
        let left_out = left_out.into_iter().map(|one| (self.of_joint(one.joint), left_out_of(&one)));
        let notes = left_out.chain(of_springs).chain(self.fast_turns());
        run.notes = notes.map(|(place, why)| Mistake::of_run(&self.path, place, why)).collect();
        Ok(run)
    }

    /// The events that a run detects: those of the file, and each joint's passing of its limits.
    fn watches(&self, stepper: &MultibodyStepper) -> Vec<(recording::Event, EventFunction<AnyStepper>)> {
        let (system, has_reactions) = (Arc::new(self.clone()), self.has_reactions());
        let ended = |event: recording::Event, stops| if stops { event.terminal() } else { event };
        let of_file = self.event.iter().map(|event| -> (_, EventFunction<_>) {
            let (quantity, system, stepper) = (event.quantity, Arc::clone(&system), stepper.clone());
            let function = move |now: &Moment<'_, AnyStepper>| {
                of_any(quantity, now, || sample(&system, &stepper, now, has_reactions))
            };
            (ended(kind(event.direction), event.stops), Box::new(function))
        });
        let of_joints = self.limited().map(|(number, limits)| -> (_, EventFunction<_>) {
            let (joint, stepper) = (self.joints[number], stepper.clone());
            let function = move |now: &Moment<'_, AnyStepper>| beyond(&joint, limits, &stepper, now.numbers());
            (ended(recording::Event::rising(), limits.stops), Box::new(function))
        });
        of_file.chain(of_joints).collect()
    }

    /// Notes about bodies that turn too far in a step of (3.13).
    fn fast_turns(&self) -> impl Iterator<Item = Note> {
        let rigid = self.bodies.iter().zip(&self.places.bodies).filter(|(body, _)| body.kinetic == Kinetic::Rigid);
        rigid.filter_map(|(body, place)| Some((*place, fast_turn(self.step * body.start.velocity.norm())?)))
    }

    /// Differences between the nearest start and the file, a line for each body that has one.
    #[must_use]
    pub fn changes(&self, run: &Run) -> String {
        let Some(start) = run.samples().first().filter(|_| self.nearest) else { return String::new() };
        let line = |(given, now): (&SystemBody, &BodySample)| {
            let turned = SO3::from(given.start.attitude).as_matrix() - now.attitude.as_matrix();
            let turned = 2.0 * (turned.norm() / 8.0_f64.sqrt()).min(1.0).asin();
            let [moved, faster, quicker] =
                [given.position - now.position, given.moving - now.moving, given.start.velocity - now.velocity]
                    .map(|change| change.norm());
            // Smaller changes are rounding errors.
            let is_changed = moved.max(faster).max(quicker).max(turned) > 1e-9;
            let [moved, turned, faster, quicker] = [moved, turned, faster, quicker]
                .map(|change| if change > 1e-9 { round(change) } else { "0".to_owned() });
            let changes = format!(
                "moved by {moved} m, turned by {turned} rad, its velocity by {faster} m/s, its angular velocity by {quicker} rad/s"
            );
            is_changed.then(|| format!("  `{}` doesn't start as the file says: {changes}\n", given.name))
        };
        self.bodies.iter().zip(&start.bodies).filter_map(line).collect()
    }

    /// Lines about the start and the end of a run.
    #[must_use]
    pub fn summary(&self, run: &Run) -> String {
        let events = run.events_in_words(self.events());
        let ends = run.summary(&self.title, &self.sum(), "J", |_, _| {
            if self.joints.is_empty() {
                return events;
            }
            let widest = run.samples().iter().map(|sample| sample.gap).fold(0.0, f64::max);
            let unit = if self.has_cosines() { "(m and cosines)" } else { "m" };
            format!(", joints open by {widest:.1e} {unit} at most{events}")
        });
        ends + &self.changes(run)
    }

    /// The events of a run as comma-separated values, see [`SceneFile::event_table`](crate::SceneFile::event_table).
    ///
    /// # Errors
    ///
    /// None, as it is written to memory.
    pub fn event_table(&self, run: &Run) -> Result<String, Box<dyn Error + Send + Sync>> {
        run.event_table(&self.columns, self.events())
    }

    /// The place in the file of the joint with this number.
    fn of_joint(&self, joint: usize) -> (usize, usize) {
        self.places.joints.get(joint).copied().unwrap_or(self.places.pace)
    }

    /// The mistake for a failed run, with its place in the file.
    fn mistake(&self, stop: Stop) -> Mistake {
        let (place, message) = match stop {
            Stop::Table(message) => return Mistake::of_table(&self.path, message),
            Stop::Setup(error) | Stop::Start(error) => self.obstacle(error),
            Stop::Step { time, cause } => {
                let (place, why) = self.end_of_steps(&cause);
                (place, format!("stopped at t = {} s: {why}", short(time)))
            }
            Stop::Spring(spring, why) => (self.places.springs[spring], why),
            stop => (self.places.pace, stop.to_string()),
        };
        Mistake::of_run(&self.path, place, message)
    }

    /// The reason why the system can't be started, with the place of the body or the joint.
    fn obstacle(&self, error: SetupError) -> ((usize, usize), String) {
        match error {
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
        }
    }

    /// The reason why a step fails, with its place.
    fn end_of_steps(&self, cause: &StepError) -> ((usize, usize), String) {
        match *cause {
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
            _ => (self.places.pace, told(cause)),
        }
    }
}
