//! The stepper of one body, or of a Lagrangian of the file's own, by its method and step.

use std::rc::Rc;

use liestep::SetupError;
use liestep::accuracy::{Accuracy, Choice};
use liestep::mechanics::Inertia;
use liestep::motion::AnyStepper;
use liestep::with::{Clock, Method, Scheme};
use liestep_late::{Course, Question, QuestionError, for_accuracy};

use crate::file::effects::{RotorTable, TorqueTable};
use crate::file::lagrangian::Backend;
use crate::file::quantity::Triple;
use crate::file::scene_file::SceneFile;
use crate::file::schedule::{Density, Pace};
use crate::run::data::{Data, Whole, inertia, nothing, whole_error};
use crate::run::devices::Devices;
use crate::run::make::Stop;
use crate::run::parameters::{OneBody, Parameters};
use crate::run::simulate::MemberStart;

/// The step of a scene for members of an ensemble in lanes. `None` for another method, for varying steps, and for effects
/// along orbits.
pub(crate) fn whole(file: &SceneFile) -> Option<Whole> {
    let is_of_one_kind =
        matches!(file.run.method, Scheme::Step) && !file.has_steps_of_its_own() && file.system.is_none();
    let J = inertia(file).ok().filter(|_| is_of_one_kind && !file.is_driven())?;
    let Pace::Step { step, .. } = file.run.pace else { return None };
    let Data { sum, numbers } = Data::of(file, &J).ok()?;
    Whole::of(sum, &numbers, step, Method::default()).ok()
}

/// The stepper of a scene's step with this file's numbers, and the initial state.
pub(crate) fn member(file: &SceneFile, whole: &Whole) -> Result<MemberStart, Stop> {
    let Pace::Step { step, .. } = file.run.pace else { return Err(nothing()) };
    file.check_kicks()?;
    let J = inertia(file)?;
    let Data { numbers, .. } = Data::of(file, &J)?;
    let stepper = whole.with(&numbers, step).map_err(Stop::Setup)?.into_joinable();
    let state = file.start.state(&stepper).map_err(Stop::Start)?;
    Ok((stepper, state))
}

/// The stepper of a scene with terms that change with time, whose values are those of each step's middle.
fn over_time(file: &SceneFile, J: Inertia, h: f64, method: Method) -> Result<AnyStepper, Stop> {
    let Data { sum, numbers } = Data::of(file, &J)?;
    let course = Parameters::of(file.clone(), J, sum);
    let whole = |h| Whole::of(sum, &numbers, h, method).map_err(whole_error);
    let driven = match clock(file) {
        None => whole(h)?.driven(course),
        Some(clock) => whole(1.0)?.with_clock(clock).driven(course),
    };
    driven.map(AnyStepper::new).map_err(Stop::Setup)
}

/// The stepper of a body with laws and wheels, whose terms are a torque and a rotor.
fn with_devices(file: &SceneFile, J: Inertia, h: f64) -> Result<AnyStepper, Stop> {
    let mut file = file.clone();
    if !file.control.is_empty() {
        file.torque.get_or_insert(TorqueTable { torque: Triple::ZERO });
    }
    if !file.wheel.is_empty() {
        file.rotor.get_or_insert(RotorTable { spin: Triple::ZERO });
    }
    let Data { sum, numbers } = Data::of(&file, &J)?;
    let whole = Whole::of(sum, &numbers, h, Method::default()).map_err(whole_error)?;
    let shares = shares(file.run.method);
    if shares.len() > 1 && !sum.is_self_adjoint {
        return Err(Stop::Setup(SetupError::NotSelfAdjoint));
    }
    let body = OneBody::new(Parameters::of(file.clone(), J, sum), &whole, shares.len());
    Devices::new(file, (body, 1), (h, None, shares)).map(AnyStepper::new).map_err(Stop::Setup)
}

/// The lengths of steps that are so many per orbit, s.
pub(crate) fn clock(file: &SceneFile) -> Option<Clock> {
    file.run.steps_per_orbit.and_then(|steps| file.orbit?.clock(steps.get()).ok())
}

/// The lengths of the stages of a step, as shares of it.
pub(crate) fn shares(method: Scheme) -> Vec<f64> {
    match method {
        Scheme::Composition(scheme) => scheme.stages().collect(),
        _ => vec![1.0],
    }
}

/// The stepper by the file's `step`: the scene's own steps, a composition of them, or a method with an exact motion.
pub(crate) fn by_steps(file: &SceneFile, h: f64) -> Result<AnyStepper, Stop> {
    let J = inertia(file)?;
    if file.has_devices() {
        return with_devices(file, J, h);
    }
    let method = Method::from(file.run.method);
    let data = || Data::of(file, &J)?.stepper(method, h).map_err(whole_error);
    if !matches!(method.scheme, Scheme::Step | Scheme::Composition(_)) {
        return data();
    }
    if let Some(Density::Turn(floor)) = file.run.density {
        let Data { sum, numbers } = Data::of(file, &J)?;
        let whole = Whole::of(sum, &numbers, h, method).and_then(|whole| whole.turning_evenly(floor.value));
        return whole.map(AnyStepper::new).map_err(whole_error);
    }
    if file.paced().is_some() {
        let Data { sum, numbers } = Data::of(file, &J)?;
        let paced = Whole::of(sum, &numbers, h, method).and_then(|whole| Ok(whole.paced()?));
        return paced.map(AnyStepper::new).map_err(whole_error);
    }
    if file.changing().is_some() {
        return over_time(file, J, h, method);
    }
    data()
}

/// The cheapest choice of method and step for an accuracy.
pub(crate) fn searched(file: &SceneFile, accuracy: Accuracy) -> Result<Choice, Stop> {
    let J = inertia(file)?;
    let data = Data::of(file, &J)?;
    let stepper = data.stepper(Method::default(), accuracy.horizon).map_err(whole_error)?;
    let state = file.start.state(&stepper).map_err(Stop::Start)?;
    let velocity = if file.start.is_by_momentum { stepper.velocity(&state) } else { file.start.velocity.clone() };
    let question = Question { accuracy, attitude: &file.start.attitude, velocity: &velocity };
    let parameters = || Rc::new(Parameters::of(file.clone(), J, data.sum)) as Rc<dyn Course>;
    let course = file.changing().map(|_| parameters());
    match for_accuracy::<Backend>(data.sum, &data.numbers, course.as_ref(), question) {
        Ok((_, choice)) => Ok(choice),
        Err(QuestionError::Whole(error)) => Err(whole_error(error)),
        Err(QuestionError::Accuracy(error)) => Err(Stop::Accuracy(error)),
    }
}
