//! The state of a motion that Python steps in a loop.

use std::cell::RefCell;
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

use liestep::motion::{AnyState, AnyStepper, Integrator as _};
use liestep::with::Method;
use liestep_scene::System;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyInt, PyList};

use crate::failure::Failure;
use crate::run::Signals;
use crate::scene::Scene;

/// The source of a state, from which each thread makes a stepper of its own.
pub(crate) enum Source {
    /// A scene with a method and a step.
    Declared(Scene, (Method, f64)),
    /// The scene of a file.
    File(liestep_scene::Scene),
}

/// The most steppers that a thread keeps.
const STEPPERS: usize = 64;

thread_local! {
    /// The steppers of this thread, that of the last step first.
    static KNOWN: RefCell<Vec<(Arc<Source>, AnyStepper)>> = const { RefCell::new(Vec::new()) };
}

impl Source {
    fn make(&self) -> Result<AnyStepper, Failure> {
        Ok(match self {
            Self::Declared(scene, method) => scene.stepper(*method)?,
            Self::File(scene) => scene.stepper()?.0,
        })
    }

    /// The system of several bodies, if it is one.
    fn system(&self) -> Option<&System> {
        if let Self::File(scene) = self { scene.system() } else { None }
    }

    /// The stepper of this thread.
    fn stepper(self: &Arc<Self>) -> Result<AnyStepper, Failure> {
        let known = KNOWN.with_borrow_mut(|known| {
            let place = known.iter().position(|(own, _)| Arc::ptr_eq(own, self))?;
            known.swap(0, place);
            Some(known[0].1.clone())
        });
        if let Some(known) = known {
            return Ok(known);
        }
        // A signal's function may step other states.
        let made = self.make()?;
        KNOWN.with_borrow_mut(|known| {
            known.truncate(STEPPERS - 1);
            known.insert(0, (Arc::clone(self), made.clone()));
        });
        Ok(made)
    }

    /// Forgets the cause of an earlier failure.
    fn forget(&self) {
        if let Self::Declared(scene, _) = self {
            scene.forget();
        }
    }

    /// A failure, by its cause where that is a signal without a value.
    fn caused(&self, failure: Failure) -> Failure {
        if let Self::Declared(scene, _) = self { scene.caused(failure) } else { failure }
    }
}

/// The state of a motion as its numbers, which are those of an [`AnyState`].
#[pyclass(frozen, module = "liestep._native")]
pub(crate) struct State {
    source: Arc<Source>,
    numbers: Mutex<Vec<f64>>,
}

/// Steps between two looks for signals.
const LOOK: u64 = 4096;

fn refused<T>(message: &str) -> Result<T, Failure> {
    Err(Failure::Of("SetupError", message.to_owned()))
}

impl State {
    /// The state of these numbers; they come from a state of the same source, maybe by way of a file.
    pub(crate) fn of(source: Arc<Source>, numbers: Vec<f64>) -> Result<Self, Failure> {
        let counts = |steps: &f64| *steps >= 0.0 && steps.fract() == 0.0 && *steps < 9e15;
        let is_whole = numbers.last().is_some_and(counts) && numbers.iter().all(|number| number.is_finite());
        if !is_whole || source.stepper()?.state_of(&numbers).is_none() {
            return refused("these numbers are no state of this stepper");
        }
        Ok(Self { source, numbers: Mutex::new(numbers) })
    }

    fn lock(&self) -> Result<MutexGuard<'_, Vec<f64>>, Failure> {
        match self.numbers.try_lock() {
            Ok(numbers) => Ok(numbers),
            Err(TryLockError::Poisoned(numbers)) => Ok(numbers.into_inner()),
            Err(TryLockError::WouldBlock) => {
                refused("this state is stepped by another thread: each thread takes a `copy()` of its own")
            }
        }
    }

    /// The stepper and the state.
    fn now(&self) -> Result<(AnyStepper, AnyState), Failure> {
        self.of_numbers(&self.lock()?)
    }

    fn of_numbers(&self, numbers: &[f64]) -> Result<(AnyStepper, AnyState), Failure> {
        let stepper = self.source.stepper()?;
        match stepper.state_of(numbers) {
            Some(state) => Ok((stepper, state)),
            None => refused("these numbers are no state of this stepper"),
        }
    }

    /// Makes all of the steps, or on an error none.
    fn make(&self, steps: u64, inputs: &Inputs) -> Result<(), Failure> {
        let mut numbers = self.lock()?;
        let (stepper, mut state) = if inputs.motors.is_empty() {
            self.of_numbers(&numbers)?
        } else {
            let mut driven = numbers.clone();
            self.drive_wheels(inputs.motors.iter().map(|(wheel, torque)| (wheel.as_str(), *torque)), &mut driven)?;
            self.of_numbers(&driven)?
        };
        if !inputs.are_none() && stepper.length(&state).is_some() {
            return refused("steps of a pace or a density have lengths of their own, and take no inputs");
        }
        if let Some(torque) = &inputs.torque {
            let (expected, found) = (stepper.layout().components(), torque.len());
            if found != expected {
                return refused(&format!("a torque has {expected} components here, not {found}"));
            }
            if !torque.iter().all(|part| part.is_finite()) {
                return refused("a torque is finite");
            }
        }
        if let Some(given) = &inputs.numbers {
            let Source::Declared(scene, method) = &*self.source else {
                return refused("parameters of a file's scene are those of the file");
            };
            if scene.has_changes() {
                return refused("terms with a signal have their values from it: leave `given` out");
            }
            let (driven, before) = (scene.with(given, *method)?, state.steps());
            let mut next = counted(&driven, &driven.adopt(&state), before)?;
            made(&driven, &mut next, steps, inputs)?;
            state = counted(&stepper, &stepper.adopt(&next), before + steps)?;
        } else {
            made(&stepper, &mut state, steps, inputs)?;
        }
        numbers.copy_from_slice(state.numbers());
        self.drive_wheels(inputs.motors.iter().map(|(wheel, _)| (wheel.as_str(), 0.0)), &mut numbers)
    }

    /// Sets the torques of wheels' motors, N m, in the numbers of a state.
    fn drive_wheels<'a>(
        &self,
        motors: impl Iterator<Item = (&'a str, f64)>,
        numbers: &mut [f64],
    ) -> Result<(), Failure> {
        let Source::File(scene) = &*self.source else { return Ok(()) };
        for (wheel, torque) in motors {
            let driven = scene.drive_wheel(wheel, torque, numbers);
            driven.or_else(|why| refused(&format!("the wheel `{wheel}` {why}")))?;
        }
        Ok(())
    }

    /// The names of the wheels of a file's scene.
    fn wheel_names(&self) -> Vec<&str> {
        let Source::File(scene) = &*self.source else { return Vec::new() };
        scene.wheels(&[], &[]).into_iter().map(|(name, _)| name).collect()
    }
}

/// The inputs of a step, which are constant in it.
struct Inputs {
    torque: Option<Vec<f64>>,
    /// The numbers of all terms, where some are others than those of the scene.
    numbers: Option<Vec<f64>>,
    /// The torques of wheels' motors, N m, by their names.
    motors: Vec<(String, f64)>,
}

impl Inputs {
    const fn are_none(&self) -> bool {
        self.torque.is_none() && self.numbers.is_none() && self.motors.is_empty()
    }
}

/// The state of these numbers after so many steps.
#[allow(clippy::cast_precision_loss)] // 2⁵³ steps take longer than a career
fn counted(stepper: &AnyStepper, state: &AnyState, steps: u64) -> Result<AnyState, Failure> {
    let mut numbers = state.numbers().to_vec();
    if let Some(last) = numbers.last_mut() {
        *last = steps as f64;
    }
    stepper.state_of(&numbers).map_or_else(|| refused("these numbers are no state of this stepper"), Ok)
}

/// Makes steps under a torque, if there is one.
fn made(stepper: &AnyStepper, state: &mut AnyState, steps: u64, inputs: &Inputs) -> Result<(), Failure> {
    match &inputs.torque {
        None if steps == 1 => stepper.step(state).map(drop).map_err(|error| Failure::step(&error)),
        None => in_stretches(steps, |stretch| stepper.run(state, stretch).map(drop)),
        Some(torque) => {
            in_stretches(steps, |stretch| (0..stretch).try_for_each(|_| stepper.step_forced(state, torque).map(drop)))
        }
    }
}

/// Makes steps in stretches, with a look for Ctrl-C behind each.
fn in_stretches(mut steps: u64, mut make: impl FnMut(u64) -> Result<(), liestep::StepError>) -> Result<(), Failure> {
    let signals = (steps > LOOK).then(Signals::new);
    while steps > 0 {
        let stretch = steps.min(LOOK);
        make(stretch).map_err(|error| Failure::step(&error))?;
        steps -= stretch;
        if let Some(signals) = &signals
            && signals.look().is_err()
        {
            break;
        }
    }
    signals.and_then(Signals::into_failure).map_or(Ok(()), Err)
}

/// Adds a vector to the force on a body, from this component on.
fn on_body(system: &System, name: &str, (numbers, first): (&[f64], usize), forces: &mut [f64]) -> Result<(), Failure> {
    let Some(body) = system.names().position(|own| own == name) else {
        let listed = |names: Vec<&str>| names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let (bodies, joints) = (listed(system.names().collect()), listed(system.joint_names().collect()));
        let joints =
            if joints.is_empty() { "none of its joints has a `name`".to_owned() } else { format!("joints {joints}") };
        return refused(&format!("there is no `{name}`: there are the bodies {bodies}, and {joints}"));
    };
    let &[x, y, z] = numbers else {
        return refused(&format!("what acts on the body `{name}` has three components, not {}", numbers.len()));
    };
    for (place, number) in forces.iter_mut().skip(6 * body + first).zip([x, y, z]) {
        *place += number;
    }
    Ok(())
}

/// The numbers of a vector: those of a list of floats at once, those of anything else as `liestep._arrays` reads it.
fn vector(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    if let Ok(list) = value.cast_exact::<PyList>() {
        let plain = |item: Bound<'_, PyAny>| {
            let is_plain = item.is_exact_instance_of::<PyFloat>() || item.is_exact_instance_of::<PyInt>();
            is_plain.then(|| item.extract().ok()).flatten()
        };
        if let Some(numbers) = list.iter().map(plain).collect() {
            return Ok(numbers);
        }
    }
    let py = value.py();
    py.import(intern!(py, "liestep._arrays"))?.getattr(intern!(py, "vector"))?.call1((name, value))?.extract()
}

#[pymethods]
impl State {
    /// Makes steps, each under this torque and with these numbers of all terms.
    fn step(
        &self,
        py: Python<'_>,
        steps: u64,
        torque: Option<Bound<'_, PyAny>>,
        numbers: Option<Vec<f64>>,
        motors: Vec<(String, f64)>,
    ) -> PyResult<()> {
        let inputs = Inputs { torque: torque.map(|torque| vector("torque", &torque)).transpose()?, numbers, motors };
        self.source.forget();
        let made = if steps == 1 { self.make(1, &inputs) } else { py.detach(|| self.make(steps, &inputs)) };
        Ok(made.map_err(|failure| self.source.caused(failure))?)
    }

    /// The forces on all bodies of efforts by the names of joints, and of torques and of forces by the names of bodies; and
    /// the torques of motors by the names of wheels.
    #[allow(clippy::type_complexity)] // two lists, as Python passes them on
    fn inputs(
        &self,
        torques: Vec<(String, Vec<f64>)>,
        forces: Vec<(String, Vec<f64>)>,
    ) -> PyResult<(Option<Vec<f64>>, Vec<(String, f64)>)> {
        let (system, wheels) = (self.source.system(), self.wheel_names());
        let is_wheel = |name: &str| {
            let is_body =
                system.is_some_and(|system| system.joint(name).is_some() || system.names().any(|own| own == name));
            !is_body && wheels.contains(&name)
        };
        let (of_wheels, torques): (Vec<_>, Vec<_>) = torques.into_iter().partition(|(name, _)| is_wheel(name));
        let motor = |(name, numbers): (String, Vec<f64>)| match numbers.as_slice() {
            &[torque] if torque.is_finite() => Ok((name, torque)),
            _ => refused(&format!("the torque of the wheel `{name}` is one number")),
        };
        let motors = of_wheels.into_iter().map(motor).collect::<Result<Vec<_>, _>>()?;
        if torques.is_empty() && forces.is_empty() && !motors.is_empty() {
            return Ok((None, motors));
        }
        let Some(system) = system else {
            let names: Vec<_> = wheels.iter().map(|name| format!("`{name}`")).collect();
            let message = if wheels.is_empty() {
                "inputs by names are those of several bodies and of wheels: give the components of one torque"
                    .to_owned()
            } else {
                format!("inputs by names are those of wheels here: {}", names.join(", "))
            };
            return Ok(refused(&message)?);
        };
        let mut all = vec![0.0; 6 * system.names().count()];
        for (name, numbers) in &torques {
            match (system.joint(name), &numbers[..]) {
                (Some(joint), &[effort]) => system
                    .drive(joint, effort, &mut all)
                    .or_else(|why| refused(&format!("the joint `{name}` {why}")))?,
                (Some(_), _) => refused(&format!("the torque in the joint `{name}` is one number"))?,
                (None, _) => on_body(system, name, (numbers, 0), &mut all)?,
            }
        }
        for (name, numbers) in &forces {
            on_body(system, name, (numbers, 3), &mut all)?;
        }
        Ok((Some(all), motors))
    }

    /// The wheels by their names, with their speeds relative to their bodies, rad/s.
    #[getter]
    fn wheels(&self) -> PyResult<Vec<(String, f64)>> {
        let Source::File(scene) = &*self.source else { return Ok(Vec::new()) };
        let (stepper, state) = self.now()?;
        let speeds = scene.wheels(state.numbers(), &stepper.velocity(&state));
        Ok(speeds.into_iter().map(|(name, speed)| (name.to_owned(), speed)).collect())
    }

    /// The names of the bodies; none of one body.
    #[getter]
    fn bodies(&self) -> Vec<String> {
        self.source.system().map_or_else(Vec::new, |system| system.names().map(str::to_owned).collect())
    }

    /// The joints that have a name and one coordinate, with the coordinate and its rate.
    #[getter]
    fn joints(&self) -> PyResult<Vec<(String, f64, f64)>> {
        let Some(system) = self.source.system() else { return Ok(Vec::new()) };
        let (stepper, state) = self.now()?;
        let velocity = stepper.velocity(&state);
        let coordinate = |name: &str| {
            let [now, rate] = system.coordinate(system.joint(name)?, &state, &velocity)?;
            Some((name.to_owned(), now, rate))
        };
        Ok(system.joint_names().filter_map(coordinate).collect())
    }

    fn copy(&self) -> PyResult<Self> {
        Ok(Self { source: Arc::clone(&self.source), numbers: Mutex::new(self.numbers()?) })
    }

    /// All numbers of the state.
    #[getter]
    fn numbers(&self) -> PyResult<Vec<f64>> {
        Ok(self.lock()?.clone())
    }

    /// The number of rows of the matrices of each factor.
    #[getter]
    fn factors(&self) -> PyResult<Vec<usize>> {
        Ok(self.source.stepper()?.layout().factors.iter().map(|factor| factor.kind.rows()).collect())
    }

    #[getter]
    fn steps(&self) -> PyResult<u64> {
        Ok(self.now()?.1.steps())
    }

    #[getter]
    fn time(&self) -> PyResult<f64> {
        let (stepper, state) = self.now()?;
        Ok(stepper.time(&state))
    }

    #[getter]
    fn energy(&self) -> PyResult<f64> {
        let (stepper, state) = self.now()?;
        Ok(stepper.energy(&state))
    }

    /// The entries of the matrices, row by row.
    #[getter]
    fn attitude(&self) -> PyResult<Vec<f64>> {
        Ok(self.now()?.1.attitude().to_vec())
    }

    /// The numbers of what is carried along, as the body sees them.
    #[getter]
    fn advected(&self) -> PyResult<Vec<f64>> {
        let Source::Declared(scene, _) = &*self.source else { return Ok(Vec::new()) };
        let (stepper, state) = self.now()?;
        Ok(scene.seen(state.numbers(), stepper.time(&state))?)
    }

    #[getter]
    fn velocity(&self) -> PyResult<Vec<f64>> {
        let (stepper, state) = self.now()?;
        Ok(stepper.velocity(&state))
    }

    #[getter]
    fn momentum(&self) -> PyResult<Vec<f64>> {
        Ok(self.now()?.1.momentum().to_vec())
    }

    #[getter]
    fn spatial_momentum(&self) -> PyResult<Vec<f64>> {
        let (stepper, state) = self.now()?;
        Ok(stepper.spatial_momentum(&state))
    }
}
