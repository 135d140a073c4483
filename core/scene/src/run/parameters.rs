//! The numbers of one body's terms as functions of time, of its wheels and of its laws.

use std::cell::RefCell;

use liestep::mechanics::Inertia;
use liestep::motion::{Layout, Propagator as _, StepReport};
use liestep::{SetupError, StepError};
use liestep_late::{Course, Declaration};

use crate::file::control::locked;
use crate::file::scene_file::SceneFile;
use crate::run::data::{LibraryBody, Whole, inertia, numbers};
use crate::run::mechanism::{BodyInput, Mechanism};

/// The terms of a file, whose numbers are found at any time.
pub(crate) struct Parameters {
    file: RefCell<SceneFile>,
    /// The body, where its inertia doesn't change.
    constant: Option<Inertial>,
    sum: &'static Declaration,
}

/// A body's inertia without that of the wheels about their axes, and with wheels that are locked to the body; and the body.
struct Inertial {
    inertias: [Inertia; 2],
    body: Option<LibraryBody>,
}

impl Inertial {
    fn of(file: &SceneFile, J: Inertia) -> Self {
        Self { inertias: [J, locked(&J, &file.wheel, 0)], body: LibraryBody::of(file, J) }
    }
}

impl Parameters {
    pub(crate) fn of(file: SceneFile, J: Inertia, sum: &'static Declaration) -> Self {
        let has_kinetic = |table: &str| ["body", "lagrangian"].contains(&table);
        let is_constant = !file.over_time.iter().any(|one| has_kinetic(&one.table));
        let constant = is_constant.then(|| Inertial::of(&file, J));
        Self { file: RefCell::new(file), constant, sum }
    }

    /// The numbers of a step of this start and length, s, or with the length zero of a time, with further spin and torque where
    /// the file has a rotor and a torque.
    fn numbers(&self, [start, length]: [f64; 2], held: &BodyInput) -> Option<Vec<f64>> {
        let mut file = self.file.borrow_mut();
        let is_known = file.set_over([start, length]);
        let varied = match self.constant {
            Some(_) => None,
            None => Some(Inertial::of(&file, inertia(&file).ok()?)),
        };
        let (rotor, torque) = (file.rotor, file.torque);
        file.rotor.iter_mut().for_each(|rotor| rotor.spin.value += held.spin);
        file.torque.iter_mut().for_each(|torque| torque.torque.value += held.torque);
        let Inertial { inertias: [J, locked], body } = varied.as_ref().or(self.constant.as_ref())?;
        let all = numbers(&file, [J, locked], body.as_ref(), start + length * 0.5);
        (file.rotor, file.torque) = (rotor, torque);
        self.sum.described(&all).ok().filter(|_| is_known)
    }
}

impl Course for Parameters {
    fn at(&self, time: f64, places: &mut [f64]) {
        self.over([time, 0.0], places);
    }

    fn over(&self, span: [f64; 2], places: &mut [f64]) {
        match self.numbers(span, &BodyInput::default()) {
            Some(now) => places.copy_from_slice(&now),
            None => places.fill(f64::NAN),
        }
    }
}

/// One body, or a Lagrangian of the file's own on SO(3).
pub(crate) struct OneBody {
    parameters: Parameters,
    layout: Layout,
    /// The steppers of the stages, with the numbers of the last step.
    stages: Vec<RefCell<Whole>>,
}

impl OneBody {
    /// The body of these parameters, with steps of this many stages.
    pub(crate) fn new(parameters: Parameters, whole: &Whole, stages: usize) -> Self {
        let layout = whole.layout().clone();
        Self { parameters, layout, stages: vec![RefCell::new(whole.clone()); stages] }
    }
}

impl OneBody {
    /// Reads a state whose advected vectors are those of these numbers: a step has left those of its middle.
    fn seen<T>(&self, numbers: &[f64], state: &[f64], read: impl FnOnce(&Whole, &[f64]) -> T) -> Option<T> {
        let mut whole = self.stages[0].borrow_mut();
        if self.layout.advected.is_empty() {
            return Some(read(&whole, state));
        }
        let h = whole.step_size();
        whole.take(numbers, h).ok()?;
        Some(read(&whole, &whole.adopt(state)))
    }
}

impl Mechanism for OneBody {
    type Numbers = Vec<f64>;

    fn layout(&self) -> &Layout {
        &self.layout
    }

    fn numbers(&self, span: [f64; 2], held: &[BodyInput]) -> Option<Vec<f64>> {
        let numbers = self.parameters.numbers(span, held.first()?)?;
        numbers.iter().all(|number| number.is_finite()).then_some(numbers)
    }

    fn start(&self, numbers: &Vec<f64>, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError> {
        let whole = self.stages[0].borrow();
        whole.with(numbers, whole.step_size())?.start(attitude, velocity)
    }

    fn step(
        &self,
        stage: usize,
        numbers: &Vec<f64>,
        length: f64,
        state: &mut Vec<f64>,
    ) -> Result<StepReport, StepError> {
        let mut whole = self.stages[stage].borrow_mut();
        whole.take(numbers, length).map_err(|_| StepError::NonFinite { what: "torque of a law" })?;
        let mut next = whole.adopt(state);
        let report = whole.step(&mut next)?;
        *state = next.into();
        Ok(report)
    }

    fn velocity(&self, numbers: &Vec<f64>, state: &[f64]) -> Vec<f64> {
        let read = |whole: &Whole, state: &[f64]| whole.velocity_with(state, numbers);
        self.seen(numbers, state, read).unwrap_or_else(|| vec![f64::NAN; self.layout.components()])
    }

    fn energy(&self, numbers: &Vec<f64>, state: &[f64]) -> f64 {
        self.seen(numbers, state, |whole, state| whole.energy_with(state, numbers)).unwrap_or(f64::NAN)
    }

    fn push(&self, _: &Vec<f64>, state: &mut [f64], impulses: &[f64]) -> Result<(), StepError> {
        let momentum = state[self.layout.momentum()].iter_mut();
        momentum.zip(impulses).for_each(|(momentum, impulse)| *momentum += impulse);
        Ok(())
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]) {
        self.stages[0].borrow().spatial_momentum(state, momentum);
    }

    fn defect(&self, state: &[f64]) -> f64 {
        self.stages[0].borrow().defect(state)
    }
}
