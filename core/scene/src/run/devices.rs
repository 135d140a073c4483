//! Steps of a body with laws and wheels: torques that are sampled and held, and momenta that wheels exchange with the body.

use std::cell::{Ref, RefCell};

use liestep::mechanics::Inertia;
use liestep::motion::{Layout, Propagator, StepReport};
use liestep::{SetupError, StepError};
use nalgebra::{Matrix3, Vector3};

use crate::file::control::{Controller, Motor, Seen, Wheel, entries, fit, readings, stride};
use crate::file::law::{Value, within};
use crate::file::orbit::Time;
use crate::file::scene::SceneFile;
use crate::run::data::{LibraryBody, Whole, numbers, with_wheels};

/// A body with laws and wheels.
///
/// A wheel is the term `s·Ω` of a rotor, whose momentum `s` about its axis is the mean of its momentum over the step. A motor
/// changes `s` and nothing else, so that the momentum in space of body and wheels together is conserved as that of a rotor
/// is, whatever the motor does. The torque of a law is that of the effect `torque`, held from sample to sample.
pub(crate) struct Devices {
    file: RefCell<SceneFile>,
    /// The moments without those of the wheels about their axes.
    J: Inertia,
    /// The moments with wheels that are locked to the body.
    locked: Inertia,
    body: Option<LibraryBody>,
    /// The inner steppers of the stages, with the numbers of the last step, and their lengths as shares of it: one stage, or
    /// those of a composition.
    stages: Vec<(f64, RefCell<Whole>)>,
    layout: Layout,
    h: f64,
}

/// The memory of a state between its steps.
#[derive(Clone)]
struct Memory {
    /// Momenta of the wheels about their axes, kg m²/s.
    momenta: Vec<f64>,
    /// Held torques of the laws of wheels, N m.
    motors: Vec<f64>,
    /// Held torque of each law on the body, N m.
    torques: Vec<Vector3<f64>>,
    /// The readings of the last sample of each law.
    readings: Vec<Vector3<f64>>,
    /// Time behind the last whole step, s.
    part: f64,
}

/// Most rounds for the torque of a law at the end of a step.
const MOST_ROUNDS: u32 = 200;
const OF_A_LAW: StepError = StepError::NonFinite { what: "torque of a law" };

impl Memory {
    fn read(entries: &[f64], (wheels, controls): (usize, usize)) -> Self {
        let (momenta, rest) = entries.split_at(wheels);
        let (motors, rest) = rest.split_at(wheels);
        let (torques, rest) = rest.split_at(3 * controls);
        let (readings, part) = rest.split_at(rest.len() - 1);
        let [torques, readings] =
            [torques, readings].map(|entries| entries.chunks(3).map(Vector3::from_column_slice).collect());
        Self { momenta: momenta.to_vec(), motors: motors.to_vec(), torques, readings, part: part[0] }
    }

    fn entries(&self) -> impl Iterator<Item = f64> + '_ {
        let vectors = self.torques.iter().chain(&self.readings).flat_map(|vector| vector.iter().copied());
        self.momenta.iter().chain(&self.motors).copied().chain(vectors).chain([self.part])
    }
}

impl Devices {
    /// The stepper of a file with the terms that its devices need, whose parameters are those of `whole`; with stages of these
    /// shares of a step.
    pub(crate) fn new(
        file: SceneFile,
        J: Inertia,
        body: Option<LibraryBody>,
        (whole, shares): (Whole, &[f64]),
    ) -> Result<Self, SetupError> {
        let h = whole.step_size();
        if !fit(&file.control, &file.wheel, h) {
            return Err(SetupError::Method { cause: "samples the laws between its steps" });
        }
        if shares.len() > 1 && !whole.declaration().is_self_adjoint {
            return Err(SetupError::NotSelfAdjoint);
        }
        let (layout, locked) = (whole.layout().clone(), with_wheels(&file, &J));
        let stages = shares.iter().map(|&share| (share, RefCell::new(whole.clone()))).collect();
        let mut all = Self { file: RefCell::new(file), J, locked, body, layout, stages, h };
        all.layout.memory += all.length();
        Ok(all)
    }

    /// The number of entries of the memory.
    fn length(&self) -> usize {
        let file = self.file.borrow();
        entries(&file.control, &file.wheel)
    }

    fn counts(&self) -> (usize, usize) {
        let file = self.file.borrow();
        (file.wheel.len(), file.control.len())
    }

    /// The inner stepper of the first stage.
    fn whole(&self) -> Ref<'_, Whole> {
        self.stages[0].1.borrow()
    }

    fn memory(&self, state: &[f64]) -> Memory {
        let last = state.len() - 1;
        Memory::read(&state[last - self.length()..last], self.counts())
    }

    /// The state without the memory, as one of the inner stepper.
    fn inner(&self, state: &[f64]) -> Vec<f64> {
        let last = state.len() - 1;
        [&state[..last - self.length()], &state[last..]].concat()
    }

    fn with_memory(inner: &[f64], memory: &Memory) -> Box<[f64]> {
        let last = inner.len() - 1;
        inner[..last].iter().copied().chain(memory.entries()).chain([inner[last]]).collect()
    }

    /// The parameters of a step of this start and length with momenta of the wheels and the held torque; with the length zero
    /// those of a time.
    fn numbers(
        &self,
        [start, length]: [f64; 2],
        momenta: &[f64],
        torques: &[Vector3<f64>],
    ) -> Result<Vec<f64>, StepError> {
        let mut file = self.file.borrow_mut();
        let is_known = file.set_over([start, length]);
        let (rotor, own, spin) = (file.rotor, file.torque, spin(&file.wheel, momenta));
        let SceneFile { control: controls, rotor: of_wheels, torque: of_laws, .. } = &mut *file;
        if let Some(rotor) = of_wheels {
            rotor.spin.value += spin;
        }
        if let Some(own) = of_laws {
            let held = controls.iter().zip(torques).filter(|(control, _)| !control.controller.is_at_ends);
            own.torque.value += held.map(|(_, torque)| torque).sum::<Vector3<f64>>();
        }
        let all = numbers(&file, [&self.J, &self.locked], self.body.as_ref(), start + length * 0.5);
        (file.rotor, file.torque) = (rotor, own);
        let all = self.whole().declaration().described(&all).ok().filter(|_| is_known);
        all.filter(|numbers| numbers.iter().all(|number| number.is_finite())).ok_or(OF_A_LAW)
    }

    /// The angular velocity of a state, body frame; NaN if it isn't known.
    fn rate(&self, state: &[f64], memory: &Memory) -> Vector3<f64> {
        let numbers = self.numbers([self.time(state), 0.0], &memory.momenta, &memory.torques);
        let rate = numbers.map(|numbers| self.whole().velocity_with(&self.inner(state), &numbers));
        rate.map_or_else(|_| Vector3::repeat(f64::NAN), |rate| Vector3::from_column_slice(&rate))
    }

    /// Takes the samples of the step ahead of a state with this velocity.
    fn sample(&self, state: &[f64], memory: &mut Memory, velocity: Vector3<f64>) -> Result<(), StepError> {
        let steps = state[state.len() - 1];
        let before = memory.clone();
        let file = self.file.borrow();
        let now = Time { time: self.time(state), orbit: file.orbit.as_ref() };
        let seen = &Seen { now, attitude: Matrix3::from_row_slice(&state[..9]), velocity };
        let is_due =
            |law: &Controller| !law.is_at_ends && stride(law, self.h).is_some_and(|stride| steps % stride == 0.0);
        let mut place = 0;
        let mut taken = |law: &Controller, speed: Option<f64>| {
            let places = place..place + law.count_of_readings();
            place = places.end;
            is_due(law).then(|| {
                let now = law.readings(seen);
                let value = law.value(seen, (&now, &before.readings[places.clone()]), speed);
                memory.readings[places].copy_from_slice(&now);
                value
            })
        };
        for (number, control) in file.control.iter().enumerate() {
            if let Some(Value::Vector(value)) = taken(&control.controller, None) {
                memory.torques[number] = control.limited(value);
            }
        }
        for (number, wheel) in file.wheel.iter().enumerate() {
            let speed = before.momenta[number] / wheel.inertia - seen.velocity.dot(&wheel.axis);
            if let Some(Value::Number(value)) = wheel.controller().and_then(|law| taken(law, Some(speed))) {
                memory.motors[number] = value;
            }
        }
        let is_finite = memory.entries().all(f64::is_finite);
        if is_finite { Ok(()) } else { Err(OF_A_LAW) }
    }

    /// Writes the torques of the laws at both ends of steps into a memory, at a state of the inner stepper and at a time, s, with
    /// these momenta of the wheels; returns their sum, N m.
    fn at_ends(
        &self,
        (inner, time): (&[f64], f64),
        momenta: &[f64],
        memory: &mut Memory,
    ) -> Result<Vector3<f64>, StepError> {
        let numbers = self.numbers([time, 0.0], momenta, &memory.torques)?;
        let velocity = Vector3::from_column_slice(&self.whole().velocity_with(inner, &numbers));
        let file = self.file.borrow();
        let now = Time { time, orbit: file.orbit.as_ref() };
        let seen = &Seen { now, attitude: Matrix3::from_row_slice(&inner[..9]), velocity };
        let mut sum = Vector3::zeros();
        for (control, place) in file.control.iter().zip(&mut memory.torques) {
            if !control.controller.is_at_ends {
                continue;
            }
            let readings = control.controller.readings(seen);
            if let Value::Vector(value) = control.controller.value(seen, (&readings, &[]), None) {
                *place = control.limited(value);
                sum += *place;
            }
        }
        if sum.iter().all(|part| part.is_finite()) { Ok(sum) } else { Err(OF_A_LAW) }
    }

    /// Gives a state of the inner stepper half of the impulse of these laws, for a step of this length, s, that begins or ends
    /// there. The end takes the torque of the state behind it, so that a step of `−h` undoes one of `h`.
    fn push(
        &self,
        inner: &mut [f64],
        [time, length]: [f64; 2],
        momenta: &[f64],
        (memory, is_end): (&mut Memory, bool),
    ) -> Result<(), StepError> {
        if !self.file.borrow().control.iter().any(|control| control.controller.is_at_ends) {
            return Ok(());
        }
        let place = self.layout.momentum();
        let before = Vector3::from_column_slice(&inner[place.clone()]);
        let mut torque = self.at_ends((inner, time), momenta, memory)?;
        for _ in 0..MOST_ROUNDS {
            let pushed = before + torque * (length * 0.5);
            inner[place.clone()].copy_from_slice(pushed.as_slice());
            if !is_end {
                return Ok(());
            }
            let again = self.at_ends((inner, time), momenta, memory)?;
            let changed = (again - torque).norm() * length.abs() * 0.5;
            torque = again;
            if changed <= 4.0 * f64::EPSILON * pushed.norm().max(before.norm()) {
                return Ok(());
            }
        }
        Err(StepError::NonFinite { what: "torque of a law at the end of a step, which is too strong for its length" })
    }

    /// The torques of the motors in a step of this start and length from a state with this velocity, within their limits, N m.
    fn motors(&self, memory: &Memory, velocity: &Vector3<f64>, [start, length]: [f64; 2]) -> Vec<f64> {
        let of = |(number, wheel): (usize, &Wheel)| {
            let wanted = match &wheel.motor {
                Motor::Number(torque) => *torque,
                Motor::Law(_) => memory.motors[number],
                Motor::Signal(signal) => {
                    let mut mean = vec![0.0; signal.width()];
                    signal.mean([start, length], &mut mean);
                    mean.first().copied().unwrap_or(f64::NAN)
                }
            };
            let speed = memory.momenta[number] / wheel.inertia - velocity.dot(&wheel.axis);
            // A motor at its largest speed doesn't drive on; what else the body does to the speed isn't its business.
            let up = ((wheel.largest_speed - speed) * wheel.inertia / length.abs()).max(0.0);
            let down = ((wheel.largest_speed + speed) * wheel.inertia / length.abs()).max(0.0);
            let most = wheel.largest_torque;
            within(within(wanted, [-down, up]), [-most, most])
        };
        self.file.borrow().wheel.iter().enumerate().map(of).collect()
    }

    /// A step of this length, s, from a state; returns the inner state and the memory. Torques are held in all of its stages, and
    /// each has the means of the wheels' momenta over its own time.
    fn advance(&self, state: &[f64], length: f64) -> Result<(Vec<f64>, Memory, StepReport), StepError> {
        let mut memory = self.memory(state);
        let velocity = self.rate(state, &memory);
        if length > 0.0 && memory.part == 0.0 {
            self.sample(state, &mut memory, velocity)?;
        }
        let span = [self.time(state), length];
        let motors = self.motors(&memory, &velocity, span);
        if !motors.iter().all(|torque| torque.is_finite()) {
            return Err(OF_A_LAW);
        }
        let (mut next, mut begin, mut iterations) = (self.inner(state), 0.0, 0);
        for (share, whole) in &self.stages {
            let [start, length] = [span[0] + length * begin, length * share];
            let middle = start + length * 0.5 - span[0];
            let mean = memory.momenta.iter().zip(&motors).map(|(momentum, torque)| momentum + torque * middle);
            let numbers = self.numbers([start, length], &mean.collect::<Vec<_>>(), &memory.torques)?;
            let at = |offset: f64| -> Vec<f64> {
                memory.momenta.iter().zip(&motors).map(|(momentum, torque)| momentum + torque * offset).collect()
            };
            let [first, last] = [start - span[0], start + length - span[0]].map(at);
            self.push(&mut next, [start, length], &first, (&mut memory, false))?;
            {
                let mut whole = whole.borrow_mut();
                whole.take(&numbers, length).map_err(|_| OF_A_LAW)?;
                let mut stage = whole.adopt(&next);
                iterations += whole.step(&mut stage)?.iterations;
                next = stage.to_vec();
            }
            self.push(&mut next, [start + length, length], &last, (&mut memory, true))?;
            begin += share;
        }
        memory.momenta.iter_mut().zip(&motors).for_each(|(momentum, torque)| *momentum += torque * length);
        Ok((next, memory, StepReport::of(iterations)))
    }
}

/// The momentum of wheels, body frame.
fn spin(wheels: &[Wheel], momenta: &[f64]) -> Vector3<f64> {
    wheels.iter().zip(momenta).map(|(wheel, momentum)| wheel.axis * *momentum).sum()
}

impl Propagator for Devices {
    fn layout(&self) -> &Layout {
        &self.layout
    }

    fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError> {
        let rate = Vector3::from_column_slice(velocity.get(..3).unwrap_or(&[f64::NAN; 3]));
        let momentum = |wheel: &Wheel| wheel.inertia * (rate.dot(&wheel.axis) + wheel.speed);
        let momenta: Vec<f64> = self.file.borrow().wheel.iter().map(momentum).collect();
        let numbers = self.numbers([0.0, 0.0], &momenta, &[]);
        let numbers = numbers.map_err(|_| SetupError::NonFinite { what: "momentum of a wheel" })?;
        let whole = self.whole().with(&numbers, self.h)?;
        let inner = whole.start(attitude, velocity)?;
        // The sample before the first is that of the start.
        let file = self.file.borrow();
        let now = Time { time: 0.0, orbit: file.orbit.as_ref() };
        let seen = Seen { now, attitude: Matrix3::from_row_slice(&inner[..9]), velocity: rate };
        let readings = readings(&file.control, &file.wheel, &seen);
        let (motors, torques) = (vec![0.0; momenta.len()], vec![Vector3::zeros(); file.control.len()]);
        drop(file);
        let mut memory = Memory { momenta, motors, torques, readings, part: 0.0 };
        let momenta = memory.momenta.clone();
        let known = self.at_ends((&inner, 0.0), &momenta, &mut memory);
        known.map_err(|_| SetupError::NonFinite { what: "torque of a law" })?;
        Ok(Self::with_memory(&inner, &memory))
    }

    fn step(&self, state: &mut [f64]) -> Result<StepReport, StepError> {
        let (mut next, mut memory, report) = self.advance(self.layout.checked(state)?, self.h)?;
        let (steps, last) = (state[state.len() - 1], next.len() - 1);
        next[last] = steps + 1.0;
        memory.part = 0.0;
        state.copy_from_slice(&Self::with_memory(&next, &memory));
        Ok(report)
    }

    fn part(&self, state: &[f64], fraction: f64) -> Result<Box<[f64]>, StepError> {
        let length = self.h * fraction;
        // So small a change would be lost in rounding. NaN isn't tiny.
        if fraction.abs() < f64::EPSILON * f64::EPSILON {
            return Ok(self.layout.checked(state)?.into());
        }
        let (mut next, mut memory, _) = self.advance(self.layout.checked(state)?, length)?;
        let last = next.len() - 1;
        next[last] = state[state.len() - 1];
        memory.part += length;
        Ok(Self::with_memory(&next, &memory))
    }

    fn adopt(&self, state: &[f64]) -> Box<[f64]> {
        let nowhere = || vec![f64::NAN; self.layout.state()].into();
        let (Some(attitude), Some(momentum)) = (state.get(self.layout.attitude()), state.get(self.layout.momentum()))
        else {
            return nowhere();
        };
        // The momentum is affine in the velocity, with the wheels at their speeds relative to the body.
        let at = |velocity: Vector3<f64>| {
            let state = self.start(attitude, velocity.as_slice()).ok()?;
            Some(Vector3::from_column_slice(&state[self.layout.momentum()]))
        };
        let velocity = || {
            let rest = at(Vector3::zeros())?;
            let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| Some(at(axis)? - rest));
            let locked = Matrix3::from_columns(&[x?, y?, z?]).try_inverse()?;
            Some(locked * (Vector3::from_column_slice(momentum) - rest))
        };
        velocity().and_then(|velocity| self.start(attitude, velocity.as_slice()).ok()).unwrap_or_else(nowhere)
    }

    fn step_size(&self) -> f64 {
        self.h
    }

    fn time(&self, state: &[f64]) -> f64 {
        self.layout.checked(state).map_or(f64::NAN, |state| {
            let last = state.len() - 1;
            self.h * state[last] + state[last - 1]
        })
    }

    fn velocity(&self, state: &[f64], velocity: &mut [f64]) {
        let found = self.layout.checked(state).map(|state| self.rate(state, &self.memory(state)));
        let found = found.unwrap_or_else(|_| Vector3::repeat(f64::NAN));
        velocity.iter_mut().zip(found.iter()).for_each(|(place, part)| *place = *part);
    }

    fn energy(&self, state: &[f64]) -> f64 {
        let Ok(state) = self.layout.checked(state) else { return f64::NAN };
        let memory = self.memory(state);
        let numbers = self.numbers([self.time(state), 0.0], &memory.momenta, &memory.torques);
        let energy = |numbers: Vec<f64>| self.whole().energy_with(&self.inner(state), &numbers);
        let of_body = numbers.map_or(f64::NAN, energy);
        let file = self.file.borrow();
        let of_wheel = |(wheel, momentum): (&Wheel, &f64)| momentum * momentum / (2.0 * wheel.inertia);
        of_body + file.wheel.iter().zip(&memory.momenta).map(of_wheel).sum::<f64>()
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]) {
        match self.layout.checked(state) {
            Ok(state) => self.whole().spatial_momentum(&self.inner(state), momentum),
            Err(_) => momentum.fill(f64::NAN),
        }
    }

    fn defect(&self, state: &[f64]) -> f64 {
        self.layout.checked(state).map_or(f64::NAN, |state| self.whole().defect(&self.inner(state)))
    }
}
