//! The run of a system of several bodies.

use std::sync::Arc;

use liestep::accuracy::{Accuracy, Candidate, Choice, Measure, choose, displacement, of_any_group};
use liestep::methods::Redundancy;
use liestep::motion::{AnyStepper, Moment, Propagator};
use liestep::recording;
use liestep::with::Scheme;
use liestep::{SO3, SetupError, StepError};
use nalgebra::{Matrix3, Vector3};

use crate::file::body::Kinetic;
use crate::file::joint::{Joint, Limits};
use crate::file::part::{Between, SystemBody};
use crate::file::quantity::{round, short};
use crate::file::sample::{BodySample, Sample};
use crate::file::scene_file::SceneFile;
use crate::file::system::System;
use crate::run::bodies::Bodies;
use crate::run::choose::{clock, shares};
use crate::run::devices::Devices;
use crate::run::make::{Note, Place, Run, Stop, Watch, fast_turn, told};
use crate::run::motors::{ENTRIES, pose};
use crate::run::simulate::Begun;

/// The quantity that violates a constraint, for messages.
const GAP: &str = "lengths in m and cosines of axes together";

/// The message about a joint in whose equations no digit is left.
const FAR: &str =
    "numbers of this joint, or of its bodies, are so large or so different that no digit is left; give nearer ones";

/// The angle and the shift of a joint, see [`Joint::coordinates`].
fn coordinates(joint: &Between<Joint>, state: &[f64]) -> [f64; 2] {
    let [above, below] = joint.bodies.map(|body| pose(body, state));
    joint.of.coordinates([&above, &below])
}

/// The function that rises through zero where a joint passes one of its limits.
fn beyond(joint: &Between<Joint>, limits: Limits, state: &[f64]) -> f64 {
    let [from, to] = limits.ends;
    let (middle, half, [angle, shift]) = ((from + to) * 0.5, (to - from) * 0.5, coordinates(joint, state));
    // Both are smooth at the middle, and the cosine at a whole turn, unlike the angle.
    if joint.of.kind.turns_about_axis() {
        half.cos() - (angle - middle).cos()
    } else {
        (shift - middle).powi(2) - half * half
    }
}

/// The bodies at this moment, with the numbers of all columns; forces and torques of joints, for which a step is made, only
/// where they are asked for.
pub(crate) fn of_bodies(system: &System, file: &SceneFile, now: &Moment<'_, AnyStepper>) -> Sample {
    let mut sample = bodies_at(system.bodies.len(), now);
    let Sample { bodies, energy, momentum, angular_momentum, gap, .. } = &sample;
    let mut numbers: Vec<f64> = Vec::new();
    numbers.extend(bodies.iter().flat_map(|body| &body.position));
    numbers.extend(bodies.iter().flat_map(|body| body.quaternion));
    numbers.extend(bodies.iter().flat_map(|body| &body.velocity));
    numbers.extend(bodies.iter().flat_map(|body| &body.moving));
    numbers.push(*energy);
    numbers.extend(momentum.iter().chain(angular_momentum));
    numbers.push(*gap);
    let coordinates: Vec<_> =
        system.joints.iter().map(|joint| (joint.of.kind, joint.of.sign, coordinates(joint, now.numbers()))).collect();
    let turning = coordinates.iter().filter(|(kind, ..)| kind.turns_about_axis());
    numbers.extend(turning.map(|(_, sign, [angle, _])| sign * angle));
    let shifting = coordinates.iter().filter(|(kind, ..)| kind.shifts_along_axis());
    numbers.extend(shifting.map(|(_, sign, [_, shift])| sign * shift));
    numbers.extend(file.numbers(bodies, (now.time(), now.numbers())));
    if system.has_reactions {
        let none = || vec![[Vector3::repeat(f64::NAN); 2]; system.joints.len()];
        let forces = now.integrator().joint_forces(now).unwrap_or_else(|_| none());
        numbers.extend(forces.iter().flat_map(|[force, _]| force));
        numbers.extend(forces.iter().flat_map(|[_, torque]| torque));
    }
    sample.quaternions = Arc::clone(&file.group.quaternions);
    sample.numbers = numbers;
    sample
}

/// The state of the bodies at this moment.
fn bodies_at(bodies: usize, now: &Moment<'_, AnyStepper>) -> Sample {
    let (momenta, velocities) = (now.momentum(), now.velocity());
    let (mut momentum, mut angular_momentum) = (Vector3::zeros(), Vector3::zeros());
    let body = |body: usize| {
        let (attitude, position) = pose(Some(body), now.numbers());
        let attitude = SO3::from_matrix_unchecked(attitude);
        let three = |of: &[f64], first: usize| Vector3::from_column_slice(&of[6 * body + first..][..3]);
        let (turning, linear) = (three(momenta, 0), three(momenta, 3));
        momentum += linear;
        angular_momentum += attitude.as_matrix() * turning + position.cross(&linear);
        let body = BodySample::turning(attitude, three(&velocities, 0), turning);
        BodySample { position, moving: three(&velocities, 3), ..body }
    };
    let bodies = (0..bodies).map(body).collect();
    let (energy, gap) = (now.energy(), now.integrator().gap(now));
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
    /// The stepper of a file by its method and a step, s, at the start.
    pub(crate) fn begun(self: &Arc<Self>, file: &SceneFile, step: f64) -> Result<Begun, Stop> {
        let method = if file.is_driven() { Scheme::Step } else { file.run.method };
        let (stepper, left_out) = self.multibody(file, method, step).map_err(Stop::Setup)?;
        let state = self.start(&stepper, file.run.nearest).map_err(Stop::Start)?;
        let places: Vec<_> = (0..self.bodies.len()).map(|body| stepper.attitude(&state, body)).collect();
        let of_springs = self.stiffest(file).check_springs(&places, file.run.given_step().map(|_| step))?;
        let start = if file.is_driven() {
            let (layout, mut velocity) = (stepper.layout(), vec![0.0; stepper.layout().components()]);
            Propagator::velocity(&stepper, &state, &mut velocity);
            let any = self.any(file, file.run.method, step).map_err(Stop::Setup)?;
            let state = any.start(&state[layout.attitude()], &velocity).map_err(Stop::Start)?;
            (any, state)
        } else {
            let any = AnyStepper::new(stepper);
            let state = any.state_of(&state).ok_or_else(|| Stop::Other("a state of another system".to_owned()))?;
            (any, state)
        };
        let of_springs = of_springs.map(|(spring, why)| (self.places.springs[spring], why));
        let left_out = left_out.into_iter().filter_map(|one| Some((self.of_joint(one.joint)?, left_out_of(&one))));
        let fast = self.fast_turns(file.run.step().unwrap_or_default());
        Ok(Begun { start, notes: left_out.chain(of_springs).chain(fast).collect() })
    }

    /// The stepper of a file by a method and a step, s.
    fn any(self: &Arc<Self>, file: &SceneFile, method: Scheme, step: f64) -> Result<AnyStepper, SetupError> {
        if !file.is_driven() {
            return self.multibody(file, method, step).map(|(stepper, _)| AnyStepper::new(stepper));
        }
        let bodies = (Bodies::new(file, self, step)?, self.bodies.len());
        Devices::new(file.clone(), bodies, (step, clock(file), shares(method))).map(AnyStepper::new)
    }

    /// The cheapest choice of method and step for an accuracy.
    pub(crate) fn searched(self: &Arc<Self>, file: &SceneFile, accuracy: Accuracy) -> Result<Choice, Stop> {
        // Attitudes and velocities at the start don't depend on the step.
        let (stepper, _) = self.multibody(file, Scheme::Step, accuracy.horizon / 1024.0).map_err(Stop::Setup)?;
        let state = self.start(&stepper, file.run.nearest).map_err(Stop::Start)?;
        let (layout, attitude) = (stepper.layout(), &state[stepper.layout().attitude()]);
        let mut velocity = vec![0.0; layout.components()];
        Propagator::velocity(&stepper, &state, &mut velocity);
        let candidate = |scheme| {
            let (system, file) = (Arc::clone(self), file.clone());
            Candidate { scheme, make: Box::new(move |h| system.any(&file, scheme, h)) }
        };
        let has_steps_back = self.one_way().is_none();
        let candidates: Vec<_> = of_any_group(has_steps_back).map(candidate).collect();
        let beside = displaced(attitude);
        let measure = Measure::new(&layout.factors, self.length());
        let chosen = choose(&candidates, accuracy, [attitude, &beside], &velocity, measure);
        chosen.map(|(_, choice)| choice).map_err(Stop::Accuracy)
    }

    /// The events of joints with limits.
    pub(crate) fn watches(&self) -> impl Iterator<Item = Watch> {
        self.limited().map(|(number, limits)| {
            let joint = self.joints[number];
            let function = move |now: &Moment<'_, AnyStepper>| beyond(&joint, limits, now.numbers());
            Watch { event: recording::Event::rising(), function: Box::new(function), stops: limits.stops }
        })
    }

    /// The place and the message of a failed run, where they are those of a body, a joint or a spring; `is_nearest` says whether
    /// joints were to be closed.
    pub(crate) fn mistake(&self, stop: &Stop, is_nearest: bool) -> (Option<Place>, String) {
        match stop {
            Stop::Setup(error) | Stop::Start(error) => self.obstacle(error, is_nearest),
            Stop::Step { time, cause } => {
                let (place, why) = self.end_of_steps(cause);
                (place, format!("stopped at t = {} s: {why}", short(*time)))
            }
            Stop::Spring(spring, why) => (self.places.springs.get(*spring).copied(), why.clone()),
            stop => (None, stop.to_string()),
        }
    }

    /// The failure of a run that came to its end.
    pub(crate) fn fault(run: &Run) -> Option<Stop> {
        let sample = run.samples().iter().find(|sample| !sample.energy.is_finite())?;
        let time = short(sample.time);
        Some(Stop::Other(format!("the energy is beyond all numbers at t = {time} s; give smaller ones")))
    }

    /// How far joints were open in a run.
    pub(crate) fn gaps(&self, run: &Run) -> String {
        if self.joints.is_empty() {
            return String::new();
        }
        let widest = run.samples().iter().map(|sample| sample.gap).fold(0.0, f64::max);
        let unit = if self.has_cosines() { "(m and cosines)" } else { "m" };
        format!(", joints open by {widest:.1e} {unit} at most")
    }

    /// Differences between the start of a run and that of the file.
    pub(crate) fn changes(&self, run: &Run) -> String {
        let Some(start) = run.samples().first() else { return String::new() };
        let size = self.size();
        let line = |(given, now): (&SystemBody, &BodySample)| {
            let turned = SO3::from(given.start.attitude).as_matrix() - now.attitude.as_matrix();
            let turned = 2.0 * (turned.norm() / 8.0_f64.sqrt()).min(1.0).asin();
            let [moved, faster, quicker] =
                [given.position - now.position, given.moving - now.moving, given.start.velocity - now.velocity]
                    .map(|change| change.norm());
            // Smaller changes are rounding errors.
            let least = [1e-9 * size, 1e-9];
            let is_changed = moved.max(faster) > least[0] || quicker.max(turned) > least[1];
            let [moved, turned, faster, quicker] =
                [(moved, least[0]), (turned, least[1]), (faster, least[0]), (quicker, least[1])]
                    .map(|(change, least)| if change > least { round(change) } else { "0".to_owned() });
            let changes = format!(
                "moved by {moved} m, turned by {turned} rad, its velocity by {faster} m/s, its angular velocity by {quicker} rad/s"
            );
            is_changed.then(|| format!("  `{}` doesn't start as the file says: {changes}\n", given.name))
        };
        self.bodies.iter().zip(&start.bodies).filter_map(line).collect()
    }
}

/// The place of a coordinate among the numbers of a body's attitude.
fn coordinate(row: usize) -> usize {
    9 + 4 * row + 3
}

/// An attitude beside another, by some roundings of turns and of the largest coordinate.
fn displaced(attitude: &[f64]) -> Vec<f64> {
    let mut beside = attitude.to_vec();
    let bodies = || attitude.chunks(ENTRIES);
    let size = bodies().flat_map(|body| (0..3).map(|row| body[coordinate(row)].abs())).fold(0.0, f64::max);
    let by = displacement(6);
    for body in beside.chunks_mut(ENTRIES) {
        let turn = SO3::exp(Vector3::from_column_slice(&by[..3]));
        let turned = Matrix3::from_row_slice(&body[..9]) * turn.as_matrix();
        body[..9].copy_from_slice(turned.transpose().as_slice());
        (0..3).for_each(|row| body[coordinate(row)] += by[3 + row] * size);
    }
    beside
}

/// Times of a run at which springs are looked at.
const LOOKS: u32 = 200;

impl System {
    /// The system with the largest stiffness that each spring has in a run.
    fn stiffest(self: &Arc<Self>, file: &SceneFile) -> Arc<Self> {
        let mut stiffest = Arc::clone(self);
        for one in file.over_time.iter().filter(|one| one.table == "spring" && one.key == "k") {
            let at = |look: u32| one.numbers([file.run.duration * f64::from(look) / f64::from(LOOKS), 0.0]);
            let largest = (0..=LOOKS).flat_map(at).fold(0.0, f64::max);
            Arc::make_mut(&mut stiffest).put(("spring", one.number, "k"), &[largest]);
        }
        stiffest
    }

    /// Notes about bodies that turn too far in a step of (3.13).
    fn fast_turns(&self, step: f64) -> impl Iterator<Item = Note> {
        let rigid = self.bodies.iter().zip(&self.places.bodies).filter(|(body, _)| body.kinetic == Kinetic::Rigid);
        rigid.filter_map(move |(body, place)| Some((*place, fast_turn(step * body.start.velocity.norm())?)))
    }

    /// The place in the file of the joint with this number.
    fn of_joint(&self, joint: usize) -> Option<Place> {
        self.places.joints.get(joint).copied()
    }

    /// The reason why the system can't be started, with the place of the body or the joint.
    fn obstacle(&self, error: &SetupError, is_nearest: bool) -> (Option<Place>, String) {
        match *error {
            SetupError::OffConstraint { joint, by } => {
                let message = if is_nearest {
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
                let message = if is_nearest {
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
            SetupError::RedundantJoint { joint, pivot } if pivot.is_nan() => (self.of_joint(joint), FAR.to_owned()),
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
                (self.places.bodies.get(body).copied(), message)
            }
            SetupError::SingularKinetic { determinant, body } => {
                // A single body has no number.
                let body = body.or_else(|| (self.bodies.len() == 1).then_some(0));
                let known = body.and_then(|body| self.without_velocity(body, determinant));
                known.unwrap_or_else(|| (None, error.to_string()))
            }
            _ => (None, error.to_string()),
        }
    }

    /// The reason why the velocity of a body doesn't follow from its momentum, with its place.
    fn without_velocity(&self, body: usize, determinant: f64) -> Option<(Option<Place>, String)> {
        let SystemBody { name, J, .. } = self.bodies.get(body)?;
        if J.is_none() {
            let message = format!(
                "the joints of `{name}` let this point mass turn on the spot, and nothing determines how fast: give it `moments`, or a joint that holds its attitude, as a `weld` or a `pin` beside it"
            );
            return Some((self.places.bodies.get(body).copied(), message));
        }
        let joint = self.joints.iter().position(|joint| joint.bodies.contains(&Some(body)))?;
        determinant.is_nan().then(|| (self.of_joint(joint), FAR.to_owned()))
    }

    /// The reason why a step fails, with its place.
    fn end_of_steps(&self, cause: &StepError) -> (Option<Place>, String) {
        match *cause {
            StepError::SingularJoint { joint, pivot } if pivot.is_nan() => (self.of_joint(joint), FAR.to_owned()),
            StepError::SingularJoint { joint, pivot } => {
                let why = format!(
                    "this joint comes to a singular position (pivot {pivot:e}), where its force isn't determined; make a `pin` a `ball`, take a smaller `step`, or another start"
                );
                (self.of_joint(joint), why)
            }
            StepError::UnsolvedBody { body, turn, determinant } if body < self.bodies.len() => {
                let name = &self.bodies[body].name;
                let part = if determinant.is_nan() {
                    "the iteration runs out of all bounds".to_owned()
                } else {
                    format!("its part of the Jacobian has the determinant {determinant:e}")
                };
                let why = format!(
                    "no increment of the body `{name}` that continues the identity: it would turn by {turn:.2e} rad, and {part}; take a smaller `step`"
                );
                (self.places.bodies.get(body).copied(), why)
            }
            _ => (None, told(cause)),
        }
    }
}
