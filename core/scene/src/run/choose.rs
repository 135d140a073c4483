//! The choice of a scene's type and method, once a run.

use std::rc::Rc;

use liestep::accuracy::Accuracy;
use liestep::effects::{CayleyBody, Dipole, FourthOrderBody, GeodesicBody, PrincipalBody, RigidBody, SixthOrderBody};
use liestep::groups::Advected;
use liestep::mechanics::{Effect as _, Inertia, SceneVisitor, Term as _, WithEitherKinetic, WithoutKinetic};
use liestep::methods::ExactBody;
use liestep::motion::AnyStepper;
use liestep::numbers::Entries as _;
use liestep::{SO3, SetupError, Stepper};
use liestep_late::{Declaration, Late, LateError};
use nalgebra::Vector3;

use crate::file::body::{Distribution, Kinetic};
use crate::file::lagrangian::Declared;
use crate::file::method::{Method, Stages};
use crate::file::scene::SceneFile;
use crate::file::schedule::Pace;
use crate::run::course::{MemberStart, course, sample, watches};
use crate::run::make::{Listeners, Run, Stop, make};

/// What acts on a body: of all vectors that its terms advect, one after the other, with zeros behind them.
type Seen = (V, V, V, V, V, V);
type V = Vector3<f64>;
/// The effects of a file and its force, in one program.
type Rest = Late<SO3, Seen, WithoutKinetic>;

/// The numbers of effects.
struct Numbers(Vec<f64>);

impl SceneVisitor<f64> for Numbers {
    fn term(&mut self, _: &str) {}

    fn parameter(&mut self, _: &str, value: f64) {
        self.0.push(value);
    }
}

/// The texts of what the file names beside the body are derived once a program; here they get their numbers.
fn rest(file: &SceneFile, J: Option<&Inertia>) -> Result<Option<Rest>, Stop> {
    let other = |error: LateError| match error {
        LateError::Advected { .. } => Stop::Other("the effects of a scene advect six vectors at most".to_owned()),
        other => Stop::Other(other.to_string()),
    };
    let (mut terms, mut numbers) = (Vec::new(), Numbers(Vec::new()));
    for (J, (effect, table)) in J.into_iter().flat_map(|J| file.effects().map(move |effect| (J, effect))) {
        terms.push(Declaration::parse(effect.derived.1).map_err(other)?);
        table.describe(J, 0.0, &mut numbers);
    }
    if let Some(Declared { declaration, numbers: own }) = &file.force {
        terms.push(declaration);
        numbers.0.extend(own);
    }
    if terms.is_empty() {
        return Ok(None);
    }
    let late = Declaration::sum(&terms).and_then(Late::of).and_then(|late: Rest| late.with_all(&numbers.0));
    late.map(Some).map_err(other)
}

/// What the effects advect at a time, in place of the first vectors of those.
fn seen_at(file: &SceneFile, J: &Inertia, time: f64, fixed: &Seen) -> Seen {
    let mut numbers = Vec::with_capacity(18);
    file.effects().for_each(|(_, table)| table.advected(J, time, &mut |number| numbers.push(number)));
    let (turning, mut all) = (numbers.len(), 0);
    fixed.each(&mut |number| {
        if all >= turning {
            numbers.push(number);
        }
        all += 1;
    });
    let mut numbers = numbers.into_iter();
    Seen::from_entries(&mut || numbers.next().unwrap_or(0.0))
}

/// Simulates the sum of the body, which is compiled, and what acts on it, a program.
///
/// With one effect it has the bits of their compiled sum; several are added before they are added to the body.
pub(crate) fn run(file: &SceneFile, listeners: Listeners<'_>) -> Result<Run, Stop> {
    let mut run = None;
    match file.run.pace {
        Pace::Accuracy(tolerance) => return ask(file, tolerance, listeners),
        Pace::Step { step, steps } => by_steps(file, step, Purpose::Run { steps, listeners, run: &mut run })?,
    }
    run.ok_or_else(nothing)
}

/// What steps the scene by its `step`, and its start.
pub(crate) fn stepper(file: &SceneFile) -> Result<MemberStart, Stop> {
    let mut stepper = None;
    match file.run.pace {
        Pace::Accuracy(_) => return Err(Stop::Other("the step is chosen for an accuracy by trial runs".to_owned())),
        Pace::Step { step, .. } => by_steps(file, step, Purpose::Stepper(&mut stepper))?,
    }
    let stepper = stepper.ok_or_else(nothing)?;
    let state = stepper.start(file.start.attitude, file.start.velocity).map_err(Stop::Start)?;
    Ok((stepper, state))
}

/// What is done with the stepper of a scene: asked for in its type, each would be compiled for every scene's.
enum Purpose<'a, 'b> {
    Run { steps: u32, listeners: Listeners<'b>, run: &'a mut Option<Run> },
    Stepper(&'a mut Option<AnyStepper<SO3, ()>>),
}

/// A stepper that is made is used.
fn nothing() -> Stop {
    Stop::Other("there is no such scene".to_owned())
}

fn by_steps(file: &SceneFile, h: f64, purpose: Purpose<'_, '_>) -> Result<(), Stop> {
    match file.run.method {
        Method::Step | Method::Composition(_) => stepped(file, h, purpose),
        _ => with_exact_body(file, h, purpose),
    }
}

/// By the declared steps of one of the kinetic terms, or a composition of them.
fn stepped(file: &SceneFile, h: f64, purpose: Purpose<'_, '_>) -> Result<(), Stop> {
    macro_rules! step {
        ($scene:expr) => {
            match file.run.method {
                Method::Composition(scheme) => {
                    simulate(file, Stepper::composed($scene, h, scheme.0).map(Stepper::into_any), purpose)
                }
                _ => step!(only $scene),
            }
        };
        (only $scene:expr) => {
            simulate(file, Stepper::new($scene, h).map(Stepper::into_any), purpose)
        };
    }
    macro_rules! with_rest {
        ($body:expr, $J:expr) => {{
            let (body, J) = ($body, $J);
            match rest(file, Some(&J))? {
                None => step!(body),
                Some(rest) if file.turning().next().is_some() => {
                    let (fixed, seen) = (rest.advected(), Rc::new(file.clone()));
                    let values = move |time| (Default::default(), seen_at(&seen, &J, time, &fixed));
                    let stepper = Stepper::new(body + rest, h).map(|stepper| stepper.driven(values).into_any());
                    simulate(file, stepper, purpose)
                }
                Some(rest) => step!(body + rest),
            }
        }};
    }
    let Some(body) = file.body else {
        let late = file.lagrangian.as_ref().ok_or_else(nothing)?.late::<WithEitherKinetic>();
        let late = late.map_err(|error| Stop::Other(error.to_string()))?;
        // Effects have their inertia of the body.
        return match rest(file, None)? {
            None => step!(late),
            Some(rest) => step!(late + rest),
        };
    };
    let J = body.inertia();
    match (body.kinetic, body.mass) {
        (Kinetic::Rigid, Distribution::Principal(J_d)) => with_rest!(PrincipalBody { J_d }, J),
        (Kinetic::Rigid, Distribution::Full(J_d)) => with_rest!(RigidBody { J_d }, J),
        (Kinetic::Cayley, _) => with_rest!(CayleyBody { J }, J),
        (Kinetic::Geodesic, _) => with_rest!(GeodesicBody { J }, J),
        (Kinetic::FourthOrder, _) => with_rest!(FourthOrderBody { J }, J),
        (Kinetic::SixthOrder, _) => with_rest!(SixthOrderBody { J }, J),
    }
}

/// What acts on a body, or what is like nothing: one type for methods that look for a potential.
fn potential(file: &SceneFile, J: &Inertia) -> Result<Rest, Stop> {
    if let Some(rest) = rest(file, Some(J))? {
        return Ok(rest);
    }
    let nothing = Late::parse(Dipole::<f64>::DECLARATION).and_then(|late: Rest| late.with_all(&[0.0; 6]));
    nothing.map_err(|error| Stop::Other(error.to_string()))
}

/// By methods that look at inertia and potential only.
fn with_exact_body(file: &SceneFile, h: f64, purpose: Purpose<'_, '_>) -> Result<(), Stop> {
    let J = file.body.ok_or_else(nothing)?.inertia();
    let scene = RigidBody { J_d: J.to_nonstandard() } + potential(file, &J)?;
    let stepper = match file.run.method {
        Method::Step | Method::Composition(_) => Stepper::new(scene, h).map(Stepper::into_any),
        Method::Splitting(scheme) => Stepper::split(scene, h, ExactBody::new(&J), scheme.0).map(Stepper::into_any),
        Method::Processed(scheme) => Stepper::processed(scene, h, ExactBody::new(&J), scheme.0).map(Stepper::into_any),
        Method::Collocation(Stages::Four) => Stepper::collocated::<2>(scene, h).map(Stepper::into_any),
        Method::Collocation(Stages::Eight) => Stepper::collocated::<4>(scene, h).map(Stepper::into_any),
    };
    simulate(file, stepper, purpose)
}

/// Makes the steps of a scene, or hands over what makes them.
fn simulate<A: Advected<SO3> + 'static>(
    file: &SceneFile,
    stepper: Result<AnyStepper<SO3, A>, SetupError>,
    purpose: Purpose<'_, '_>,
) -> Result<(), Stop> {
    let stepper = stepper.map_err(Stop::Setup)?;
    match purpose {
        Purpose::Run { steps, listeners, run } => {
            let state = stepper.start(file.start.attitude, file.start.velocity).map_err(Stop::Start)?;
            let course = course(file, u64::from(steps));
            *run = Some(make(&stepper, state, course, sample, watches(file), listeners)?);
        }
        Purpose::Stepper(place) => *place = Some(stepper.hiding_advected()),
    }
    Ok(())
}

/// Makes the steps that an accuracy takes.
fn ask(file: &SceneFile, tolerance: f64, listeners: Listeners<'_>) -> Result<Run, Stop> {
    let accuracy = Accuracy { tolerance, horizon: file.run.duration };
    macro_rules! ask {
        ($scene:expr) => {{
            let stepper = Stepper::for_accuracy($scene, accuracy, file.start.attitude, file.start.velocity)
                .map_err(Stop::Accuracy)?;
            let choice = stepper.choice().clone();
            let course = course(file, choice.steps);
            let mut run = make(&*stepper, stepper.start(), course, sample, watches(file), listeners)?;
            run.choice = Some(choice);
            Ok(run)
        }};
    }
    let body = file.body.ok_or_else(nothing)?;
    let J = body.inertia();
    let potential = potential(file, &J)?;
    match body.mass {
        Distribution::Principal(J_d) => ask!(PrincipalBody { J_d } + potential),
        Distribution::Full(J_d) => ask!(RigidBody { J_d } + potential),
    }
}
