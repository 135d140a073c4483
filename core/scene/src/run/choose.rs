//! The choice of a scene's types and method, made once per run.

use std::rc::Rc;

use liestep::accuracy::{Accuracy, Choice};
use liestep::effects::{CayleyBody, Dipole, FourthOrderBody, GeodesicBody, PrincipalBody, RigidBody, SixthOrderBody};
use liestep::groups::Advected;
use liestep::mechanics::{Effect, Inertia, KineticPart, OnlyKicks, Term as _, WithKinetic, WithoutKinetic};
use liestep::methods::SplittingScheme;
use liestep::motion::AnyStepper;
use liestep::with::{Method, Scheme, densities};
use liestep::{SO3, Stepper};
use liestep_late::{Declaration, Late, LateError, Slots};
use nalgebra::Vector3;

use crate::file::body::{Distribution, Kinetic};
use crate::file::lagrangian::Backend;
use crate::file::scene::SceneFile;
use crate::file::schedule::{Density, Pace};
use crate::run::course::{MemberStart, course, sample, watches};
use crate::run::make::{Listeners, Run, Stop, make};

/// The advected vectors of all terms of a scene in one tuple; unused ones are zero.
type Seen = (V, V, V, V, V, V);
type V = Vector3<f64>;
/// A program that sums several terms of a scene.
type Program<K, W = Seen> = Late<SO3, W, K, Backend>;
/// The program of a file's effects and its force.
type Rest<W = Seen> = Program<WithoutKinetic, W>;
/// The program of all terms of a scene.
type All = Program<WithKinetic, Seen>;
/// The step of all terms of a scene as data.
pub type Whole = liestep_late::Whole<Backend>;

/// The kinetic term: a Lagrangian of the file's own, or a library body by its text; with its parameters.
#[derive(Clone)]
struct Moving {
    own: Option<&'static Declaration>,
    text: &'static str,
    numbers: Vec<f64>,
}

impl Moving {
    fn of(file: &SceneFile, J: Inertia) -> Result<Self, Stop> {
        fn body<E: Effect<Scalar = f64>>(body: &E) -> Moving {
            Moving { own: None, text: E::DECLARATION, numbers: liestep_late::numbers(body) }
        }
        if let Some(own) = &file.lagrangian {
            return Ok(Self { own: Some(own.declaration), text: "", numbers: own.numbers.clone() });
        }
        let given = file.body.ok_or_else(nothing)?;
        Ok(match (given.kinetic, given.mass) {
            (Kinetic::Rigid, Distribution::Principal(J_d)) => body(&PrincipalBody { J_d }),
            (Kinetic::Rigid, Distribution::Full(J_d)) => body(&RigidBody { J_d }),
            (Kinetic::Cayley, _) => body(&CayleyBody { J }),
            (Kinetic::Geodesic, _) => body(&GeodesicBody { J }),
            (Kinetic::FourthOrder, _) => body(&FourthOrderBody { J }),
            (Kinetic::SixthOrder, _) => body(&SixthOrderBody { J }),
        })
    }

    fn declaration(&self) -> Result<&'static Declaration, LateError> {
        self.own.map_or_else(|| Declaration::parse(self.text), Ok)
    }
}

/// The sum of this body, if any, and of the file's effects and force. Each is derived once per process.
fn sum(file: &SceneFile, body: Option<&Moving>) -> Result<Option<&'static Declaration>, LateError> {
    let listed = file.effects().map(|(effect, _)| Declaration::parse(effect.derived.1));
    let (body_itself, own) = (body.map(Moving::declaration), file.force.iter().map(|own| Ok(own.declaration)));
    let terms = body_itself.into_iter().chain(listed).chain(own).collect::<Result<Vec<_>, _>>()?;
    if terms.is_empty() { Ok(None) } else { Declaration::sum(&terms).map(Some) }
}

/// The program of this sum.
fn program<K: KineticPart, W: Advected<SO3> + Slots>(
    file: &SceneFile,
    J: &Inertia,
    body: Option<&Moving>,
) -> Result<Option<Program<K, W>>, LateError> {
    let Some(sum) = sum(file, body)? else { return Ok(None) };
    Late::of(sum)?.with_all(&numbers(file, J, body, 0.0)).map(Some)
}

/// The step of a scene for members of an ensemble in lanes. `None` for another method, for varying steps, and for effects
/// along orbits.
pub(crate) fn whole(file: &SceneFile) -> Option<Whole> {
    let is_of_one_kind = matches!(file.run.method, Scheme::Step) && !file.has_steps_of_its_own();
    let J = inertia(file).ok().filter(|_| is_of_one_kind && file.turning().next().is_none())?;
    let (Pace::Step { step, .. }, body) = (file.run.pace, Moving::of(file, J).ok()?) else { return None };
    let sum = sum(file, Some(&body)).ok()??;
    Whole::of(sum, &sum.described(&numbers(file, &J, Some(&body), 0.0)).ok()?, step, Method::default()).ok()
}

/// The stepper of a scene's step with this file's numbers, and the initial state.
pub(crate) fn member(file: &SceneFile, whole: &Whole) -> Result<MemberStart, Stop> {
    let Pace::Step { step, .. } = file.run.pace else { return Err(nothing()) };
    file.check_kicks()?;
    let J = inertia(file)?;
    let numbers = whole.declaration().described(&numbers(file, &J, Some(&Moving::of(file, J)?), 0.0));
    let stepper = whole.with(&numbers.map_err(late_error)?, step).map_err(Stop::Setup)?.into_joinable();
    let state = stepper.start_at(SO3::from(file.start.attitude), file.start.velocity).map_err(Stop::Start)?;
    Ok((stepper, state))
}

/// The inertia. A Lagrangian has no effects that need it.
fn inertia(file: &SceneFile) -> Result<Inertia, Stop> {
    match file.body {
        Some(body) => Ok(body.J),
        None => Inertia::from_principal_moments(V::repeat(1.0)).map_err(|error| Stop::Other(error.to_string())),
    }
}

/// The parameters of all terms at a time, in order.
fn numbers(file: &SceneFile, J: &Inertia, body: Option<&Moving>, time: f64) -> Vec<f64> {
    let own = file.force.iter().flat_map(|own| own.numbers.iter().copied());
    let body = body.iter().flat_map(|body| body.numbers.iter().copied());
    body.chain(file.effects().flat_map(|(_, table)| table.numbers(J, time))).chain(own).collect()
}

fn rest<W: Advected<SO3> + Slots>(file: &SceneFile, J: &Inertia) -> Result<Option<Rest<W>>, Stop> {
    program(file, J, None).map_err(late_error)
}

fn late_error(error: LateError) -> Stop {
    match error {
        LateError::Advected { .. } => Stop::Other("the effects of a scene advect six vectors at most".to_owned()),
        other => Stop::Other(other.to_string()),
    }
}

/// Simulates a body and its effects. A body of (3.13) has a compiled step, and its effects are one program. All is one
/// program for other kinetic terms, for a Lagrangian of the file's own, and where an effect enters the step's equation.
///
/// Effects are summed before they are added to a compiled body.
pub(crate) fn run(file: &SceneFile, listeners: Listeners<'_>) -> Result<Run, Stop> {
    match file.run.pace {
        Pace::Accuracy(tolerance) => ask(file, tolerance, listeners),
        Pace::Step { step, steps } => by(&by_steps(file, step)?, file, steps, listeners),
    }
}

/// Runs this many steps of a stepper.
fn by(stepper: &AnyStepper, file: &SceneFile, steps: u32, listeners: Listeners<'_>) -> Result<Run, Stop> {
    let state = stepper.start_at(SO3::from(file.start.attitude), file.start.velocity).map_err(Stop::Start)?;
    make(stepper, state, course(file, u64::from(steps)), sample, watches(file), listeners)
}

/// The stepper with the file's `step`, and the initial state.
pub(crate) fn stepper(file: &SceneFile) -> Result<MemberStart, Stop> {
    let Pace::Step { step, .. } = file.run.pace else {
        return Err(Stop::Other("the step is chosen for an accuracy by trial runs".to_owned()));
    };
    file.check_kicks()?;
    let stepper = by_steps(file, step)?;
    let state = stepper.start_at(SO3::from(file.start.attitude), file.start.velocity).map_err(Stop::Start)?;
    Ok((stepper, state))
}

macro_rules! any {
    ($stepper:expr) => {
        $stepper.map(Stepper::into_any).map_err(Stop::Setup)
    };
}

/// The stepper by the file's `step`: the scene's own steps, a composition of them, or a method with an exact motion.
fn by_steps(file: &SceneFile, h: f64) -> Result<AnyStepper, Stop> {
    macro_rules! turning {
        ($scene:expr, $values:expr) => {
            match file.run.steps_per_orbit.and_then(|steps| file.turning().next()?.1.clock(steps).ok()) {
                None => any!(Stepper::new($scene, h).map(|stepper| stepper.driven($values))),
                Some((clock, _)) => {
                    any!(Stepper::new($scene, 1.0).map(|stepper| stepper.with_clock(clock).driven($values)))
                }
            }
        };
    }
    let J = inertia(file)?;
    let method = Method::from(file.run.method);
    if !matches!(method.scheme, Scheme::Step | Scheme::Composition(_)) {
        return with_exact_body(file, &J, h);
    }
    if let Some(Density::Turn(floor)) = file.run.density {
        let whole: Option<All> = program(file, &J, Some(&Moving::of(file, J)?)).map_err(late_error)?;
        let whole = whole.ok_or_else(nothing)?;
        let rate = densities::turn(whole.clone(), floor.value);
        return any!(Stepper::new(whole, h).map(|stepper| stepper.with_density(rate)));
    }
    if let Some(paced) = file.lagrangian.as_ref().filter(|own| own.has_a_pace) {
        return any!(Stepper::new(paced.paced().map_err(late_error)?, h).and_then(Stepper::paced));
    }
    let (turns, seen) = (file.turning().next().is_some(), Rc::new(file.clone()));
    if file.lagrangian.is_some() || file.kinetic() != Kinetic::Rigid {
        let body = Moving::of(file, J)?;
        let whole: Option<All> = program(file, &J, Some(&body)).map_err(late_error)?;
        let Some(whole) = whole else { return Err(nothing()) };
        if !turns {
            return method.on_any_group(whole, h).map_err(Stop::Setup);
        }
        let scene = whole.clone();
        let values = move |time| {
            let now = whole.clone().with_all(&numbers(&seen, &J, Some(&body), time));
            now.as_ref().unwrap_or(&whole).advected()
        };
        return turning!(scene, values);
    }
    // All effects along orbits share one type.
    if let Some(rest) = rest::<Seen>(file, &J)?.filter(|_| turns) {
        let scene = RigidBody { J_d: J.to_nonstandard() } + rest.clone();
        let values = move |time| {
            let now = rest.clone().with_all(&numbers(&seen, &J, None, time));
            (Default::default(), now.as_ref().unwrap_or(&rest).advected())
        };
        return turning!(scene, values);
    }
    match (file.run.method, file.body.ok_or_else(nothing)?.mass) {
        (Scheme::Step, Distribution::Principal(J_d)) => {
            let body = PrincipalBody { J_d };
            // The smallest type that fits makes the fastest steps.
            if let Ok(kicks) = program::<OnlyKicks, ()>(file, &J, None) {
                kicks.map_or_else(|| any!(Stepper::new(body, h)), |kicks| any!(Stepper::new(body + kicks, h)))
            } else if let Ok(Some(kicks)) = program::<OnlyKicks, V>(file, &J, None) {
                any!(Stepper::new(body + kicks, h))
            } else if let Ok(Some(whole)) = program::<WithKinetic, V>(file, &J, Some(&Moving::of(file, J)?)) {
                // One program evaluates the whole residual of the step.
                any!(Stepper::new(whole, h))
            } else {
                any!(Stepper::new(body + potential(file, &J)?, h))
            }
        }
        _ => match rest::<Seen>(file, &J)? {
            None => method.on_any_group(RigidBody { J_d: J.to_nonstandard() }, h).map_err(Stop::Setup),
            Some(rest) => method.on_any_group(RigidBody { J_d: J.to_nonstandard() } + rest, h).map_err(Stop::Setup),
        },
    }
}

/// A missing body: impossible in a file that was read.
fn nothing() -> Stop {
    Stop::Other("there is no body".to_owned())
}

/// The stepper of a method that uses only the inertia and the potential.
fn with_exact_body(file: &SceneFile, J: &Inertia, h: f64) -> Result<AnyStepper, Stop> {
    let scene = RigidBody { J_d: J.to_nonstandard() } + potential(file, J)?;
    let scheme = match file.run.method {
        // The potential is zero.
        Scheme::Exact if file.effects().next().is_none() => Scheme::Splitting(SplittingScheme::STRANG),
        scheme => scheme,
    };
    Method::from(scheme).stepper(scene, h).map_err(Stop::Setup)
}

/// The program of the effects, or of an effect that is zero: methods for a potential then need one type only.
fn potential(file: &SceneFile, J: &Inertia) -> Result<Rest, Stop> {
    let nothing = || Late::parse(Dipole::<f64>::DECLARATION).and_then(|late: Rest| late.with_all(&[0.0; 6]));
    rest(file, J)?.map_or_else(nothing, Ok).map_err(late_error)
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
    let J = file.body.ok_or_else(nothing)?.J;
    let scene = RigidBody { J_d: J.to_nonstandard() } + potential(file, &J)?;
    let stepper = Stepper::for_accuracy(scene, accuracy, file.start.attitude, file.start.velocity);
    let stepper = stepper.map_err(Stop::Accuracy)?;
    let choice = stepper.choice().clone();
    let mut run = if let Some((file, step)) = refined(file, &choice) {
        by(&by_steps(&file, step)?, &file, FEWEST, listeners)?
    } else {
        let any = stepper.any();
        let state = any.start_at(SO3::from(file.start.attitude), file.start.velocity).map_err(Stop::Start)?;
        make(any, state, course(file, choice.steps), sample, watches(file), listeners)?
    };
    run.choice = Some(choice);
    Ok(run)
}
