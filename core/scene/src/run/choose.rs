//! The choice of a scene's types and method, made once per run.

use std::cell::RefCell;

use liestep::accuracy::{Accuracy, Choice};
use liestep::effects::{CayleyBody, FourthOrderBody, GeodesicBody, PrincipalBody, RigidBody, SixthOrderBody};
use liestep::mechanics::{Effect, Inertia};
use liestep::motion::{AnyStepper, Integrator as _};
use liestep::with::{Method, Scheme};
use liestep_late::{Course, Declaration, LateError, Question, QuestionError, WholeError, for_accuracy};
use nalgebra::Vector3;

use crate::file::body::{Distribution, Kinetic};
use crate::file::lagrangian::Backend;
use crate::file::scene::SceneFile;
use crate::file::schedule::{Density, Pace};
use crate::file::words::in_files;
use crate::run::course::{MemberStart, course, sample, watches};
use crate::run::make::{Listeners, Run, Stop, make};

/// The step of all terms of a scene as data.
pub type Whole = liestep_late::Whole<Backend>;

/// A library body by its text, with its parameters.
#[derive(Clone)]
struct LibraryBody {
    text: &'static str,
    numbers: Vec<f64>,
}

impl LibraryBody {
    /// The body of a file; none with a kinetic energy of the file's own.
    fn of(file: &SceneFile, J: Inertia) -> Option<Self> {
        fn body<E: Effect<Scalar = f64>>(body: &E) -> LibraryBody {
            LibraryBody { text: E::DECLARATION, numbers: liestep_late::numbers(body) }
        }
        let given = file.body?;
        Some(match (given.kinetic, given.mass) {
            (Kinetic::Rigid, Distribution::Principal(J_d)) => body(&PrincipalBody { J_d }),
            (Kinetic::Rigid, Distribution::Full(J_d)) => body(&RigidBody { J_d }),
            (Kinetic::Cayley, _) => body(&CayleyBody { J }),
            (Kinetic::Geodesic, _) => body(&GeodesicBody { J }),
            (Kinetic::FourthOrder, _) => body(&FourthOrderBody { J }),
            (Kinetic::SixthOrder, _) => body(&SixthOrderBody { J }),
        })
    }
}

/// The sum of this body, if any, and of the file's Lagrangians, effects and forces, which is derived once per process.
fn sum(file: &SceneFile, body: Option<&LibraryBody>) -> Result<Option<&'static Declaration>, LateError> {
    let body = body.map(|body| Declaration::parse(body.text)).into_iter();
    let [lagrangians, forces] = [&file.lagrangian, &file.force].map(|own| own.iter().map(|own| Ok(own.declaration)));
    let listed = file.effects().map(|(effect, _)| Declaration::parse(effect.derived.1));
    let terms = body.chain(lagrangians).chain(listed).chain(forces).collect::<Result<Vec<_>, _>>()?;
    if terms.is_empty() { Ok(None) } else { Declaration::sum(&terms).map(Some) }
}

/// A scene whose step is data: the sum of all terms, on any group.
#[derive(Clone)]
struct Data {
    sum: &'static Declaration,
    numbers: Vec<f64>,
}

impl Data {
    fn of(file: &SceneFile, J: &Inertia) -> Result<Self, Stop> {
        let body = LibraryBody::of(file, *J);
        let sum = sum(file, body.as_ref()).map_err(|error| late_error(&error))?.ok_or_else(nothing)?;
        let numbers = sum.described(&numbers(file, J, body.as_ref(), 0.0)).map_err(|error| late_error(&error))?;
        Ok(Self { sum, numbers })
    }

    fn stepper(&self, method: Method, h: f64) -> Result<AnyStepper, WholeError> {
        liestep_late::stepper::<Backend>(self.sum, &self.numbers, h, method)
    }
}

/// The step of a scene for members of an ensemble in lanes. `None` for another method, for varying steps, and for effects
/// along orbits.
pub(crate) fn whole(file: &SceneFile) -> Option<Whole> {
    let is_of_one_kind = matches!(file.run.method, Scheme::Step) && !file.has_steps_of_its_own();
    let J = inertia(file).ok().filter(|_| is_of_one_kind && file.changing().is_none())?;
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

/// The inertia of the body, or of the kinetic energy of the file's own, for effects that need it.
fn inertia(file: &SceneFile) -> Result<Inertia, Stop> {
    let own = match (file.body, file.effects().next()) {
        (Some(body), _) => return Ok(body.J),
        (None, None) => Inertia::from_principal_moments(Vector3::repeat(1.0)),
        (None, Some(_)) => Inertia::new(file.inertia().ok_or_else(nothing)?),
    };
    own.map_err(|error| Stop::Other(error.to_string()))
}

/// The parameters of all terms at a time, in order.
fn numbers(file: &SceneFile, J: &Inertia, body: Option<&LibraryBody>, time: f64) -> Vec<f64> {
    let [lagrangians, forces] =
        [&file.lagrangian, &file.force].map(|own| own.iter().flat_map(|own| own.numbers.iter().copied()));
    let body = body.iter().flat_map(|body| body.numbers.iter().copied());
    let listed = file.effects().flat_map(|(_, table)| table.numbers(J, file.at(time)));
    body.chain(lagrangians).chain(listed).chain(forces).collect()
}

fn late_error(error: &LateError) -> Stop {
    Stop::Other(in_files(&error.to_string()))
}

fn whole_error(error: WholeError) -> Stop {
    match error {
        WholeError::Declaration(error) => late_error(&error),
        WholeError::Setup(error) => Stop::Setup(error),
    }
}

/// Simulates a scene, whose step is data: one program of all terms.
pub(crate) fn run(file: &SceneFile, listeners: Listeners<'_>) -> Result<Run, Stop> {
    match file.run.pace {
        Pace::Accuracy(tolerance) => ask(file, tolerance, listeners),
        Pace::Step { step, steps } => by(&by_steps(file, step)?, file, steps, listeners),
    }
}

/// Runs this many steps of a stepper.
fn by(stepper: &AnyStepper, file: &SceneFile, steps: u32, listeners: Listeners<'_>) -> Result<Run, Stop> {
    let (state, view) = (file.start.state(stepper).map_err(Stop::Start)?, file.view());
    make(stepper, state, course(file, u64::from(steps)), |now| sample(&view, now), watches(file), listeners)
}

/// The stepper with the file's `step`, and the initial state.
pub(crate) fn stepper(file: &SceneFile) -> Result<MemberStart, Stop> {
    let Pace::Step { step, .. } = file.run.pace else {
        return Err(Stop::Other("the step is chosen for an accuracy by trial runs".to_owned()));
    };
    file.check_kicks()?;
    let stepper = by_steps(file, step)?;
    let state = file.start.state(&stepper).map_err(Stop::Start)?;
    Ok((stepper, state))
}

/// The numbers of a scene's terms, as functions of time.
struct SceneCourse {
    file: RefCell<SceneFile>,
    J: Inertia,
    body: Option<LibraryBody>,
    sum: &'static Declaration,
}

impl Course for SceneCourse {
    fn at(&self, time: f64, places: &mut [f64]) {
        self.over([time, 0.0], places);
    }

    fn over(&self, [start, length]: [f64; 2], places: &mut [f64]) {
        let mut file = self.file.borrow_mut();
        let has_all = file.set_over([start, length]);
        let now = self.sum.described(&numbers(&file, &self.J, self.body.as_ref(), start + length * 0.5));
        match now {
            Ok(now) if has_all => places.copy_from_slice(&now),
            _ => places.fill(f64::NAN),
        }
    }
}

/// The stepper of a scene with terms that change with time, whose values are those of each step's middle.
fn over_time(file: &SceneFile, J: Inertia, h: f64, method: Method) -> Result<AnyStepper, Stop> {
    let Data { sum, numbers } = Data::of(file, &J)?;
    let course = SceneCourse { file: RefCell::new(file.clone()), J, body: LibraryBody::of(file, J), sum };
    let whole = |h| Whole::of(sum, &numbers, h, method).map_err(whole_error);
    let clock = file.run.steps_per_orbit.and_then(|steps| file.orbit?.clock(steps).ok());
    let driven = match clock {
        None => whole(h)?.driven(course),
        Some((clock, _)) => whole(1.0)?.with_clock(clock).driven(course),
    };
    driven.map(AnyStepper::new).map_err(Stop::Setup)
}

/// The stepper by the file's `step`: the scene's own steps, a composition of them, or a method with an exact motion.
fn by_steps(file: &SceneFile, h: f64) -> Result<AnyStepper, Stop> {
    let J = inertia(file)?;
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

/// A missing body: impossible in a file that was read.
fn nothing() -> Stop {
    Stop::Other("there is no body".to_owned())
}

/// Fewest steps of a run whose number of steps is left open. With fewer, curves would look like polygons.
const FEWEST: u32 = 1000;

/// The scene with the chosen method and the fewest steps, if the number of steps is left open and the choice has fewer.
fn refined(file: &SceneFile, choice: &Choice) -> Option<(SceneFile, f64)> {
    let is_coarse = file.run.is_left_open && choice.steps < u64::from(FEWEST);
    let step = file.run.duration / f64::from(FEWEST);
    let mut refined = file.clone();
    (refined.run.method, refined.run.pace) = (choice.chosen().scheme, Pace::Step { step, steps: FEWEST });
    is_coarse.then_some((refined, step))
}

/// Runs the steps that an accuracy requires.
fn ask(file: &SceneFile, tolerance: f64, listeners: Listeners<'_>) -> Result<Run, Stop> {
    let accuracy = Accuracy { tolerance, horizon: file.run.duration };
    let J = inertia(file)?;
    let (any, choice) = searched(file, &Data::of(file, &J)?, accuracy)?;
    let mut run = if let Some((file, step)) = refined(file, &choice) {
        by(&by_steps(&file, step)?, &file, FEWEST, listeners)?
    } else {
        let (state, view) = (file.start.state(&any).map_err(Stop::Start)?, file.view());
        make(&any, state, course(file, choice.steps), |now| sample(&view, now), watches(file), listeners)?
    };
    run.choice = Some(choice);
    Ok(run)
}

/// The stepper that is the cheapest for an accuracy.
fn searched(file: &SceneFile, data: &Data, accuracy: Accuracy) -> Result<(AnyStepper, Choice), Stop> {
    let stepper = data.stepper(Method::default(), accuracy.horizon).map_err(whole_error)?;
    let state = file.start.state(&stepper).map_err(Stop::Start)?;
    let velocity = if file.start.is_by_momentum { stepper.velocity(&state) } else { file.start.velocity.clone() };
    let question = Question { accuracy, attitude: &file.start.attitude, velocity: &velocity };
    for_accuracy::<Backend>(data.sum, &data.numbers, question).map_err(|error| match error {
        QuestionError::Whole(error) => whole_error(error),
        QuestionError::Accuracy(error) => Stop::Accuracy(error),
    })
}
