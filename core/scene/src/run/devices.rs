//! Steps of bodies with laws and wheels, and of several bodies along an orbit: torques that are sampled and held, momenta that
//! wheels exchange with their bodies, and parameters over time.

use liestep::motion::{Cost, Layout, Propagator, StepReport};
use liestep::with::Clock;
use liestep::{SetupError, StepError};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use crate::file::control::{Control, Controller, Motor, Seen, Wheel, entries, fit, readings, stride};
use crate::file::law::{Value, within};
use crate::file::orbit::Time;
use crate::file::scene_file::SceneFile;
use crate::run::mechanism::{BodyInput, Mechanism};
use crate::run::memory::Memory;

/// Bodies with laws and wheels.
///
/// A wheel is the term `s·Ω` of a rotor, whose momentum `s` about its axis is the mean of its momentum over the step. A motor
/// changes `s` and nothing else, so that the momentum in space of body and wheels together is conserved as that of a rotor
/// is, whatever the motor does. The torque of a law is that of the effect `torque`, held from sample to sample.
pub(crate) struct Devices<M> {
    file: SceneFile,
    mechanism: M,
    /// The number of bodies.
    bodies: usize,
    /// The lengths of the stages as shares of a step: one stage, or those of a composition.
    shares: Vec<f64>,
    layout: Layout,
    /// The length of a step, s; a mean where a clock has the lengths.
    h: f64,
    clock: Option<Clock>,
}

/// Most rounds for the torque of a law at the end of a step.
const MOST_ROUNDS: u32 = 200;
const OF_A_LAW: StepError = StepError::NonFinite { what: "torque of a law" };
const OF_A_SIGNAL: StepError = StepError::NonFinite { what: "value over time" };

/// The number of steps of a state.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a whole number
fn steps(state: &[f64]) -> u64 {
    state.last().map_or(0, |steps| *steps as u64)
}

impl<M: Mechanism> Devices<M> {
    /// The stepper of a file with a mechanism of this many bodies, with stages of these shares of a step of `h`, s, or of the
    /// lengths of a clock.
    pub(crate) fn new(
        file: SceneFile,
        (mechanism, bodies): (M, usize),
        (h, clock, shares): (f64, Option<Clock>, Vec<f64>),
    ) -> Result<Self, SetupError> {
        if !fit(&file.control, &file.wheel, h) {
            return Err(SetupError::Method { cause: "samples the laws between its steps" });
        }
        let mut layout = mechanism.layout().clone();
        layout.memory += entries(&file.control, &file.wheel);
        Ok(Self { file, mechanism, bodies, shares, layout, h, clock })
    }

    /// The length of the step ahead of a state, or of that behind it, s; NaN for a slice that is no state.
    fn step_at(&self, state: &[f64], is_ahead: bool) -> f64 {
        let Some(clock) = &self.clock else { return self.h };
        let steps = steps(state);
        let length = if is_ahead { clock.length(steps) } else { clock.length_before(steps) };
        length.unwrap_or(f64::NAN)
    }

    /// The state of the mechanism, with the memory of laws and wheels.
    fn parts(&self, state: &[f64]) -> (Vec<f64>, Memory) {
        let (last, length) = (state.len() - 1, entries(&self.file.control, &self.file.wheel));
        let (inner, rest) = state.split_at(last - length);
        let memory = Memory::read(&rest[..length], (self.file.wheel.len(), self.file.control.len()));
        ([inner, &rest[length..]].concat(), memory)
    }

    fn with_memory(inner: &[f64], memory: &Memory) -> Box<[f64]> {
        let last = inner.len() - 1;
        inner[..last].iter().copied().chain(memory.entries()).chain([inner[last]]).collect()
    }

    /// The attitude of a body, body to space, and its angular velocity, body frame, in numbers of all bodies.
    fn seen(&self, time: f64, body: usize, (state, velocity): (&[f64], &[f64])) -> Seen<'_> {
        let [entries, components] = [self.layout.entries(), self.layout.components()].map(|all| all / self.bodies);
        Seen {
            now: Time { time, orbit: self.file.orbit.as_ref() },
            attitude: Matrix3::from_row_slice(&state[body * entries..][..9]),
            velocity: Vector3::from_column_slice(&velocity[body * components..][..3]),
        }
    }

    /// The speed of a wheel's body about its axis, rad/s.
    fn turning(&self, wheel: &Wheel, velocity: &[f64]) -> f64 {
        let of_body = &velocity[wheel.body * self.layout.components() / self.bodies..][..3];
        Vector3::from_column_slice(of_body).dot(&wheel.axis)
    }

    /// Inputs of each body: the momenta of its wheels and the torques of these laws.
    fn inputs<'t>(
        &self,
        momenta: &[f64],
        torques: impl Iterator<Item = (&'t Control, &'t Vector3<f64>)>,
    ) -> Vec<BodyInput> {
        let mut inputs = vec![BodyInput::default(); self.bodies];
        for (wheel, momentum) in self.file.wheel.iter().zip(momenta) {
            inputs[wheel.body].spin += wheel.axis * *momentum;
        }
        torques.for_each(|(control, torque)| inputs[control.body].torque += torque);
        inputs
    }

    /// The numbers of a step of this start and length with momenta of the wheels and held torques; with the length zero
    /// those of a time.
    fn numbers(&self, span: [f64; 2], momenta: &[f64], torques: &[Vector3<f64>]) -> Result<M::Numbers, StepError> {
        let held = self.file.control.iter().zip(torques).filter(|(control, _)| !control.controller.is_at_ends);
        let cause = if self.file.over_time.is_empty() { OF_A_LAW } else { OF_A_SIGNAL };
        self.mechanism.numbers(span, &self.inputs(momenta, held)).ok_or(cause)
    }

    /// The numbers of a state's time.
    fn now(&self, state: &[f64], memory: &Memory) -> Result<M::Numbers, StepError> {
        self.numbers([self.time(state), 0.0], &memory.momenta, &memory.torques)
    }

    /// The velocity of a state; NaN if it isn't known.
    fn rates(&self, state: &[f64], (inner, memory): (&[f64], &Memory)) -> Vec<f64> {
        let rates = self.now(state, memory).map(|numbers| self.mechanism.velocity(&numbers, inner));
        rates.unwrap_or_else(|_| vec![f64::NAN; self.layout.components()])
    }

    /// Takes the samples of the step ahead of a state with this velocity.
    fn sample(&self, state: &[f64], memory: &mut Memory, velocity: &[f64]) -> Result<(), StepError> {
        let (steps, time) = (state[state.len() - 1], self.time(state));
        let before = memory.clone();
        let is_due =
            |law: &Controller| !law.is_at_ends && stride(law, self.h).is_some_and(|stride| steps % stride == 0.0);
        let mut place = 0;
        let mut taken = |law: &Controller, body: usize, speed: Option<f64>| {
            let places = place..place + law.count_of_readings();
            place = places.end;
            is_due(law).then(|| {
                let seen = &self.seen(time, body, (state, velocity));
                let now = law.readings(seen);
                let value = law.value(seen, (&now, &before.readings[places.clone()]), speed);
                memory.readings[places].copy_from_slice(&now);
                value
            })
        };
        for (number, control) in self.file.control.iter().enumerate() {
            if let Some(Value::Vector(value)) = taken(&control.controller, control.body, None) {
                memory.torques[number] = control.limited(value);
            }
        }
        for (number, wheel) in self.file.wheel.iter().enumerate() {
            let speed = before.momenta[number] / wheel.inertia - self.turning(wheel, velocity);
            if let Some(Value::Number(value)) = wheel.controller().and_then(|law| taken(law, wheel.body, Some(speed))) {
                memory.motors[number] = value;
            }
        }
        let is_finite = memory.entries().all(f64::is_finite);
        if is_finite { Ok(()) } else { Err(OF_A_LAW) }
    }

    /// Writes the torques of the laws at both ends of steps into a memory, at a state of the mechanism with these numbers and at a
    /// time, s; returns their sum on each body, N m.
    fn at_ends(
        &self,
        (inner, time): (&[f64], f64),
        numbers: &M::Numbers,
        memory: &mut Memory,
    ) -> Result<Vec<Vector3<f64>>, StepError> {
        let velocity = self.mechanism.velocity(numbers, inner);
        let mut sums = vec![Vector3::zeros(); self.bodies];
        for (control, place) in self.file.control.iter().zip(&mut memory.torques) {
            if !control.controller.is_at_ends {
                continue;
            }
            let seen = &self.seen(time, control.body, (inner, &velocity));
            let readings = control.controller.readings(seen);
            if let Value::Vector(value) = control.controller.value(seen, (&readings, &[]), None) {
                *place = control.limited(value);
                sums[control.body] += *place;
            }
        }
        let is_finite = sums.iter().flat_map(|sum| sum.iter()).all(|part| part.is_finite());
        if is_finite { Ok(sums) } else { Err(OF_A_LAW) }
    }

    /// Gives a state of the mechanism half of the impulse of these laws, for a step of this length, s, that begins or ends
    /// there. The end takes the torque of the state behind it, so that a step of `−h` undoes one of `h`.
    fn push(
        &self,
        inner: &mut Vec<f64>,
        [time, length]: [f64; 2],
        momenta: &[f64],
        (memory, is_end): (&mut Memory, bool),
    ) -> Result<(), StepError> {
        if !self.file.control.iter().any(|control| control.controller.is_at_ends) {
            return Ok(());
        }
        let numbers = self.numbers([time, 0.0], momenta, &memory.torques)?;
        let size = |vectors: &[Vector3<f64>]| vectors.iter().map(Vector3::norm_squared).sum::<f64>().sqrt();
        let of_state = |state: &[f64]| state[self.layout.momentum()].iter().map(|part| part * part).sum::<f64>().sqrt();
        let before = inner.clone();
        let mut torques = self.at_ends((inner, time), &numbers, memory)?;
        for _ in 0..MOST_ROUNDS {
            let mut impulses = vec![0.0; self.layout.components()];
            for (impulse, torque) in impulses.chunks_mut(self.layout.components() / self.bodies).zip(&torques) {
                impulse[..3].copy_from_slice((torque * (length * 0.5)).as_slice());
            }
            inner.clone_from(&before);
            self.mechanism.push(&numbers, inner, &impulses)?;
            if !is_end {
                return Ok(());
            }
            let again = self.at_ends((inner, time), &numbers, memory)?;
            let changes: Vec<_> = again.iter().zip(&torques).map(|(again, torque)| again - torque).collect();
            torques = again;
            if size(&changes) * length.abs() * 0.5 <= 4.0 * f64::EPSILON * of_state(inner).max(of_state(&before)) {
                return Ok(());
            }
        }
        Err(StepError::NonFinite { what: "torque of a law at the end of a step, which is too strong for its length" })
    }

    /// The torques of the motors that are numbers or signals, N m: their means over a time of this start and length, s; NaN where a
    /// signal has none.
    fn given(&self, span: [f64; 2]) -> Vec<f64> {
        let of = |wheel: &Wheel| match &wheel.motor {
            Motor::Number(torque) => *torque,
            Motor::Law(_) => 0.0,
            Motor::Signal(signal) => {
                let mut mean = vec![f64::NAN; signal.width()];
                signal.mean(span, &mut mean);
                mean.first().copied().unwrap_or(f64::NAN)
            }
        };
        self.file.wheel.iter().map(of).collect()
    }

    /// The torques of the motors in a step of this length, s, from a state with this velocity, within their limits, N m, where
    /// numbers and signals have these.
    fn motors(&self, memory: &Memory, velocity: &[f64], length: f64, given: &[f64]) -> Vec<f64> {
        let of = |(number, wheel): (usize, &Wheel)| {
            let wanted = given[number] + memory.motors[number];
            let speed = memory.momenta[number] / wheel.inertia - self.turning(wheel, velocity);
            // A motor at its largest speed doesn't drive on; what else the body does to the speed isn't its business.
            let up = ((wheel.largest_speed - speed) * wheel.inertia / length.abs()).max(0.0);
            let down = ((wheel.largest_speed + speed) * wheel.inertia / length.abs()).max(0.0);
            let most = wheel.largest_torque;
            within(within(wanted, [-down, up]), [-most, most])
        };
        self.file.wheel.iter().enumerate().map(of).collect()
    }

    /// The memory of a state with the samples of a step of this length, s, and the torques of the motors in it, where numbers and
    /// signals have these.
    fn sampled(&self, state: &[f64], length: f64, given: &[f64]) -> Result<(Vec<f64>, Memory, Vec<f64>), StepError> {
        let (inner, mut memory) = self.parts(state);
        if !self.file.has_devices() {
            return Ok((inner, memory, Vec::new()));
        }
        let velocity = self.rates(state, (&inner, &memory));
        if length > 0.0 && memory.part == 0.0 {
            self.sample(state, &mut memory, &velocity)?;
        }
        let motors = self.motors(&memory, &velocity, length, given);
        if motors.iter().all(|torque| torque.is_finite()) { Ok((inner, memory, motors)) } else { Err(OF_A_LAW) }
    }

    /// A step of this length, s, from a state; returns the inner state and the memory. Torques of laws are held in all of its stages,
    /// and each has the means of signals and of the wheels' momenta over its own time.
    fn advance(&self, state: &[f64], length: f64) -> Result<(Vec<f64>, Memory, StepReport), StepError> {
        let now = self.time(state);
        let of_step = self.given([now, length]);
        let (mut next, mut memory, motors) = self.sampled(state, length, &of_step)?;
        let (mut begin, mut iterations) = (0.0, 0);
        for (stage, share) in self.shares.iter().enumerate() {
            let [start, length] = [now + length * begin, length * share];
            // A limit takes as much from each stage as from the whole step.
            let of_stage = self.given([start, length]).into_iter().zip(&of_step);
            let motors: Vec<_> = motors.iter().zip(of_stage).map(|(all, (own, mean))| all + (own - mean)).collect();
            let [first, middle, last] = [0.0, 0.5, 1.0].map(|part| memory.after(&motors, length * part));
            let numbers = self.numbers([start, length], &middle, &memory.torques)?;
            self.push(&mut next, [start, length], &first, (&mut memory, false))?;
            iterations += self.mechanism.step(stage, &numbers, length, &mut next)?.iterations;
            self.push(&mut next, [start + length, length], &last, (&mut memory, true))?;
            memory.momenta = last;
            begin += share;
        }
        if !motors.is_empty() {
            let end = self.numbers([now + length, 0.0], &memory.momenta, &memory.torques)?;
            self.mechanism.project(&end, &mut next)?;
        }
        Ok((next, memory, StepReport::of(iterations)))
    }
}

impl<M: Mechanism> Propagator for Devices<M> {
    fn layout(&self) -> &Layout {
        &self.layout
    }

    fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError> {
        let (found, expected) = (velocity.len(), self.layout.components());
        if found != expected {
            return Err(SetupError::Length { what: "velocity", found, expected });
        }
        let momentum = |wheel: &Wheel| wheel.inertia * (self.turning(wheel, velocity) + wheel.speed);
        let momenta: Vec<f64> = self.file.wheel.iter().map(momentum).collect();
        let numbers = self.numbers([0.0, 0.0], &momenta, &[]);
        let numbers = numbers.map_err(|_| SetupError::NonFinite { what: "momentum of a wheel" })?;
        let inner = self.mechanism.start(&numbers, attitude, velocity)?;
        // The sample before the first is that of the start.
        let readings = readings(&self.file.control, &self.file.wheel, &|body| self.seen(0.0, body, (&inner, velocity)));
        let (motors, torques) = (vec![0.0; momenta.len()], vec![Vector3::zeros(); self.file.control.len()]);
        let mut memory = Memory { momenta, motors, torques, readings, part: 0.0 };
        let known = self.at_ends((&inner, 0.0), &numbers, &mut memory);
        known.map_err(|_| SetupError::NonFinite { what: "torque of a law" })?;
        Ok(Self::with_memory(&inner, &memory))
    }

    fn step(&self, state: &mut [f64]) -> Result<StepReport, StepError> {
        let length = self.step_at(state, true);
        let (mut next, mut memory, report) = self.advance(self.layout.checked(state)?, length)?;
        let (steps, last) = (state[state.len() - 1], next.len() - 1);
        next[last] = steps + 1.0;
        memory.part = 0.0;
        state.copy_from_slice(&Self::with_memory(&next, &memory));
        Ok(report)
    }

    fn step_forced(&self, state: &mut [f64], force: &[f64]) -> Result<StepReport, StepError> {
        let mut next = self.layout.checked(state)?.to_vec();
        if force.len() != self.layout.components() || !force.iter().all(|part| part.is_finite()) {
            return Err(StepError::NonFinite { what: "control force" });
        }
        let half = self.step_at(state, true) * 0.5;
        let impulses: Vec<f64> = force.iter().map(|part| part * half).collect();
        let push = |state: &mut [f64]| {
            let (mut inner, memory) = self.parts(state);
            self.mechanism.push(&self.now(state, &memory)?, &mut inner, &impulses)?;
            state.copy_from_slice(&Self::with_memory(&inner, &memory));
            Ok(())
        };
        push(&mut next)?;
        let report = self.step(&mut next)?;
        push(&mut next)?;
        state.copy_from_slice(&next);
        Ok(report)
    }

    fn part(&self, state: &[f64], fraction: f64) -> Result<Box<[f64]>, StepError> {
        let length = self.step_at(state, fraction > 0.0) * fraction;
        // So small a change would be lost in rounding. NaN isn't tiny.
        if fraction.abs() < f64::EPSILON * f64::EPSILON {
            return Ok(self.layout.checked(state)?.into());
        }
        let (mut next, mut memory, _) = self.advance(self.layout.checked(state)?, length)?;
        self.mechanism.forget(&mut next);
        let last = next.len() - 1;
        next[last] = state[state.len() - 1];
        memory.part += length;
        Ok(Self::with_memory(&next, &memory))
    }

    fn adopt(&self, state: &[f64]) -> Box<[f64]> {
        let nowhere = || vec![f64::NAN; self.layout.state()].into();
        let known = self.layout.momentum().end;
        let (Some(known), Some(attitude)) = (state.get(..known), state.get(self.layout.attitude())) else {
            return nowhere();
        };
        let wheels = &self.file.wheel;
        let inner: Vec<f64> = known.iter().copied().chain(vec![0.0; self.mechanism.layout().memory + 1]).collect();
        // The velocity is affine in those of bodies about their wheels' axes, with the wheels at their speeds relative to them.
        let velocity = |turning: &DVector<f64>| {
            let momenta =
                wheels.iter().zip(turning.iter()).map(|(wheel, turning)| wheel.inertia * (turning + wheel.speed));
            let numbers = self.numbers([0.0, 0.0], &momenta.collect::<Vec<_>>(), &[]).ok()?;
            Some(self.mechanism.velocity(&numbers, &inner))
        };
        let about = |turning: &DVector<f64>| {
            let velocity = velocity(turning)?;
            Some(DVector::from_iterator(wheels.len(), wheels.iter().map(|wheel| self.turning(wheel, &velocity))))
        };
        let found = || {
            let rest = about(&DVector::zeros(wheels.len()))?;
            let mut matrix = DMatrix::identity(wheels.len(), wheels.len());
            for wheel in 0..wheels.len() {
                let mut turning = DVector::zeros(wheels.len());
                turning[wheel] = 1.0;
                matrix.set_column(wheel, &(&turning - (about(&turning)? - &rest)));
            }
            self.start(attitude, &velocity(&matrix.lu().solve(&rest)?)?).ok()
        };
        found().unwrap_or_else(nowhere)
    }

    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)] // a count of stages
    fn cost(&self) -> Option<Cost> {
        let (stages, Cost { step, fewest, .. }) = (self.shares.len(), self.mechanism.cost()?);
        Some(Cost { step: step * stages as f64, fewest: fewest * stages as u32, ..self.mechanism.cost()? })
    }

    fn step_size(&self) -> f64 {
        self.h
    }

    fn time(&self, state: &[f64]) -> f64 {
        self.layout.checked(state).map_or(f64::NAN, |state| {
            let last = state.len() - 1;
            let begin = match &self.clock {
                None => self.h * state[last],
                Some(clock) => clock.time(steps(state)),
            };
            begin + state[last - 1]
        })
    }

    fn length(&self, state: &[f64]) -> Option<f64> {
        self.clock.as_ref().map(|_| self.step_at(state, true))
    }

    fn velocity(&self, state: &[f64], velocity: &mut [f64]) {
        let found = self.layout.checked(state).map(|state| {
            let (inner, memory) = self.parts(state);
            self.rates(state, (&inner, &memory))
        });
        let found = found.unwrap_or_else(|_| vec![f64::NAN; velocity.len()]);
        velocity.iter_mut().zip(found).for_each(|(place, part)| *place = part);
    }

    fn energy(&self, state: &[f64]) -> f64 {
        let Ok(state) = self.layout.checked(state) else { return f64::NAN };
        let (inner, memory) = self.parts(state);
        let of_bodies = self.now(state, &memory).map_or(f64::NAN, |numbers| self.mechanism.energy(&numbers, &inner));
        let of_wheel = |(wheel, momentum): (&Wheel, &f64)| momentum * momentum / (2.0 * wheel.inertia);
        of_bodies + self.file.wheel.iter().zip(&memory.momenta).map(of_wheel).sum::<f64>()
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]) {
        match self.layout.checked(state) {
            Ok(state) => self.mechanism.spatial_momentum(&self.parts(state).0, momentum),
            Err(_) => momentum.fill(f64::NAN),
        }
    }

    fn defect(&self, state: &[f64]) -> f64 {
        self.layout.checked(state).map_or(f64::NAN, |state| self.mechanism.defect(&self.parts(state).0))
    }

    fn gap(&self, state: &[f64]) -> f64 {
        self.layout.checked(state).map_or(f64::NAN, |state| self.mechanism.gap(&self.parts(state).0))
    }

    fn joint_forces(&self, state: &[f64]) -> Result<Vec<[Vector3<f64>; 2]>, StepError> {
        let (state, h) = (self.layout.checked(state)?, self.step_at(state, true));
        // At the end of a signal the values there stand for those of a step.
        self.joint_forces_with(state, [h; 2]).or_else(|_| self.joint_forces_with(state, [h, 0.0]))
    }
}

impl<M: Mechanism> Devices<M> {
    /// The forces of joints in a step of the first length, s, by the means of signals over the second.
    fn joint_forces_with(&self, state: &[f64], [h, reach]: [f64; 2]) -> Result<Vec<[Vector3<f64>; 2]>, StepError> {
        let (inner, memory, motors) = self.sampled(state, h, &self.given([self.time(state), reach]))?;
        // Changes of momenta at the ends of the step act in it here: laws there as at its beginning, and the half of a motor's impulse
        // by which the mean momentum of its wheel differs from that at the end.
        let all = self.file.control.iter().zip(&memory.torques);
        let mut inputs = self.inputs(&memory.after(&motors, h * 0.5), all);
        for (wheel, torque) in self.file.wheel.iter().zip(&motors) {
            inputs[wheel.body].torque -= wheel.axis * (torque * 0.5);
        }
        let numbers = self.mechanism.numbers([self.time(state), reach], &inputs).ok_or(OF_A_LAW)?;
        self.mechanism.joint_forces(&numbers, &inner)
    }
}
