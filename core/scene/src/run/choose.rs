//! The choice of a scene's types and method, made once per run.

use std::rc::Rc;

use liestep::accuracy::{Accuracy, Candidate, Choice, choose, displacement, of_any_group};
use liestep::effects::{CayleyBody, Dipole, FourthOrderBody, GeodesicBody, PrincipalBody, RigidBody, SixthOrderBody};
use liestep::groups::Advected;
use liestep::mechanics::{Effect, Inertia, KineticPart, OnlyKicks, Term as _, WithKinetic, WithoutKinetic};
use liestep::methods::SplittingScheme;
use liestep::motion::{AnyStepper, Integrator as _};
use liestep::with::{Method, Scheme, densities};
use liestep::{SO3, SetupError, Stepper};
use liestep_late::{Declaration, Late, LateError, Slots, WholeError};
use nalgebra::Vector3;

use crate::file::body::{Distribution, Kinetic};
use crate::file::lagrangian::Backend;
use crate::file::scene::SceneFile;
use crate::file::schedule::{Density, Pace};
use crate::file::words::in_files;
use crate::run::course::{MemberStart, course, sample, watches};
use crate::run::make::{Listeners, Run, Stop, make};

/// The advected vectors of all terms of a scene in one tuple; unused ones are zero.
type AdvectedVectors = (V, V, V, V, V, V);
type V = Vector3<f64>;
/// A program that sums several terms of a scene.
type Program<K, W = AdvectedVectors> = Late<SO3, W, K, Backend>;
/// The program of a file's effects and its force.
type Rest<W = AdvectedVectors> = Program<WithoutKinetic, W>;
/// The program of all terms of a scene.
type All = Program<WithKinetic, AdvectedVectors>;
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

/// The program of the sum.
fn program<K: KineticPart, W: Advected<SO3> + Slots>(
    file: &SceneFile,
    J: &Inertia,
    body: Option<&LibraryBody>,
) -> Result<Option<Program<K, W>>, LateError> {
    let Some(sum) = sum(file, body)? else { return Ok(None) };
    Late::of(sum)?.with_all(&numbers(file, J, body, 0.0)).map(Some)
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
        let sum = sum(file, body.as_ref()).map_err(late_error)?.ok_or_else(nothing)?;
        let numbers = sum.described(&numbers(file, J, body.as_ref(), 0.0)).map_err(late_error)?;
        Ok(Self { sum, numbers })
    }

    fn stepper(&self, method: Method, h: f64) -> Result<AnyStepper, WholeError> {
        Whole::of(self.sum, &self.numbers, h, method).map(AnyStepper::new)
    }
}

/// The step of a scene for members of an ensemble in lanes. `None` for another method, for varying steps, and for effects
/// along orbits.
pub(crate) fn whole(file: &SceneFile) -> Option<Whole> {
    let is_of_one_kind = matches!(file.run.method, Scheme::Step) && !file.has_steps_of_its_own();
    let J = inertia(file).ok().filter(|_| is_of_one_kind && file.turning().next().is_none())?;
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
        (None, None) => Inertia::from_principal_moments(V::repeat(1.0)),
        (None, Some(_)) => Inertia::new(file.inertia().ok_or_else(nothing)?),
    };
    own.map_err(|error| Stop::Other(error.to_string()))
}

/// The parameters of all terms at a time, in order.
fn numbers(file: &SceneFile, J: &Inertia, body: Option<&LibraryBody>, time: f64) -> Vec<f64> {
    let [lagrangians, forces] =
        [&file.lagrangian, &file.force].map(|own| own.iter().flat_map(|own| own.numbers.iter().copied()));
    let body = body.iter().flat_map(|body| body.numbers.iter().copied());
    let listed = file.effects().flat_map(|(_, table)| table.numbers(J, time));
    body.chain(lagrangians).chain(listed).chain(forces).collect()
}

fn late_error(error: LateError) -> Stop {
    Stop::Other(match error {
        LateError::Advected { .. } => {
            "beside an `orbit`, a `density` or a method with an exact motion a scene advects six vectors at most, and \
             nothing else"
                .to_owned()
        }
        other => in_files(&other.to_string()),
    })
}

fn whole_error(error: WholeError) -> Stop {
    match error {
        WholeError::Declaration(error) => late_error(error),
        WholeError::Setup(error) => Stop::Setup(error),
    }
}

/// Simulates a scene. A body of (3.13) has a compiled step, and the rest is one program. The step of all else is data: of
/// other kinetic terms, of those of the file's own, and where an effect enters the step's equation.
pub(crate) fn run(file: &SceneFile, listeners: Listeners<'_>) -> Result<Run, Stop> {
    match file.run.pace {
        Pace::Accuracy(tolerance) => ask(file, tolerance, listeners),
        Pace::Step { step, steps } => by(&by_steps(file, step)?, file, steps, listeners),
    }
}

/// Runs this many steps of a stepper.
fn by(stepper: &AnyStepper, file: &SceneFile, steps: u32, listeners: Listeners<'_>) -> Result<Run, Stop> {
    let state = file.start.state(stepper).map_err(Stop::Start)?;
    make(stepper, state, course(file, u64::from(steps)), |now| sample(&file.group, now), watches(file), listeners)
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

macro_rules! any {
    ($stepper:expr) => {
        $stepper.map(Stepper::into_any).map_err(Stop::Setup)
    };
}

/// The stepper of a scene with effects along an orbit, whose values are those of each step's middle.
fn along_orbit(file: &SceneFile, J: Inertia, h: f64) -> Result<AnyStepper, Stop> {
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
    // A compiled body is no part of the program.
    let body = LibraryBody::of(file, J).filter(|_| !file.has_compiled_body());
    let seen = Rc::new(file.clone());
    macro_rules! scene_and_values {
        ($rest:ident: $type:ty => $scene:expr, |$advected:ident| $values:expr) => {{
            let $rest: $type = program(file, &J, body.as_ref()).map_err(late_error)?.ok_or_else(nothing)?;
            let (scene, whole) = ($scene, $rest);
            let values = move |time| {
                let now = whole.clone().with_all(&numbers(&seen, &J, body.as_ref(), time));
                let $advected = now.as_ref().unwrap_or(&whole).advected();
                $values
            };
            turning!(scene, values)
        }};
    }
    if file.has_compiled_body() {
        let J_d = J.to_nonstandard();
        scene_and_values!(rest: Rest => RigidBody { J_d } + rest.clone(), |advected| (Default::default(), advected))
    } else {
        scene_and_values!(whole: All => whole.clone(), |advected| advected)
    }
}

/// The stepper by the file's `step`: the scene's own steps, a composition of them, or a method with an exact motion.
fn by_steps(file: &SceneFile, h: f64) -> Result<AnyStepper, Stop> {
    let J = inertia(file)?;
    let method = Method::from(file.run.method);
    if !matches!(method.scheme, Scheme::Step | Scheme::Composition(_)) {
        return with_exact_body(file, &J, h);
    }
    if let Some(Density::Turn(floor)) = file.run.density {
        let whole: Option<All> = program(file, &J, LibraryBody::of(file, J).as_ref()).map_err(late_error)?;
        let whole = whole.ok_or_else(nothing)?;
        let rate = densities::turn(whole.clone(), floor.value);
        return any!(Stepper::new(whole, h).map(|stepper| stepper.with_density(rate)));
    }
    if let Some(paced) = file.paced() {
        return any!(Stepper::new(paced.paced().map_err(late_error)?, h).and_then(Stepper::paced));
    }
    if file.turning().next().is_some() {
        return along_orbit(file, J, h);
    }
    let is_compiled = file.has_compiled_body();
    let data = || Data::of(file, &J)?.stepper(method, h).map_err(whole_error);
    let Some(body) = file.body.filter(|_| is_compiled) else { return data() };
    // The smallest type that fits makes the fastest steps.
    if let (Scheme::Step, Distribution::Principal(J_d)) = (file.run.method, body.mass) {
        let body = PrincipalBody { J_d };
        if let Ok(kicks) = program::<OnlyKicks, ()>(file, &J, None) {
            return kicks.map_or_else(|| any!(Stepper::new(body, h)), |kicks| any!(Stepper::new(body + kicks, h)));
        }
        if let Ok(Some(kicks)) = program::<OnlyKicks, V>(file, &J, None) {
            return any!(Stepper::new(body + kicks, h));
        }
        // A force or a potential that enters the step's equation is evaluated with it, unless much is carried.
        let whole = sum(file, LibraryBody::of(file, J).as_ref()).map_err(late_error)?;
        return match program::<WithoutKinetic, AdvectedVectors>(file, &J, None) {
            Ok(Some(rest)) if whole.is_some_and(|sum| sum.carried.len() > 1) => any!(Stepper::new(body + rest, h)),
            _ => data(),
        };
    }
    let body = RigidBody { J_d: J.to_nonstandard() };
    match program::<WithoutKinetic, AdvectedVectors>(file, &J, None) {
        Ok(None) => method.on_any_group(body, h).map_err(Stop::Setup),
        Ok(Some(rest)) => method.on_any_group(body + rest, h).map_err(Stop::Setup),
        Err(_) => data(),
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
        Scheme::Exact if file.effects().next().is_none() && file.lagrangian.is_empty() => {
            Scheme::Splitting(SplittingScheme::STRANG)
        }
        scheme => scheme,
    };
    Method::from(scheme).stepper(scene, h).map_err(Stop::Setup)
}

/// The program of the effects, or of an effect that is zero: methods for a potential then need one type only.
fn potential(file: &SceneFile, J: &Inertia) -> Result<Rest, Stop> {
    let nothing = || Late::parse(Dipole::<f64>::DECLARATION).and_then(|late: Rest| late.with_all(&[0.0; 6]));
    let rest = program(file, J, None).map_err(late_error)?;
    rest.map_or_else(nothing, Ok).map_err(late_error)
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
    let (any, choice) = if file.sum.is_some() {
        searched(file, &Data::of(file, &J)?, accuracy)?
    } else {
        let scene = RigidBody { J_d: J.to_nonstandard() } + potential(file, &J)?;
        let moving = || V::from_column_slice(&file.start.velocity);
        // (3.13) has the momentum of Euler's equations.
        let velocity = file.start.rate().or_else(|| Some(J.as_matrix().try_inverse()? * moving()));
        let velocity = velocity.ok_or_else(nothing)?;
        let stepper = Stepper::for_accuracy(scene, accuracy, file.start.rotation(), velocity);
        let stepper = stepper.map_err(Stop::Accuracy)?;
        (stepper.any().clone(), stepper.choice().clone())
    };
    let mut run = if let Some((file, step)) = refined(file, &choice) {
        by(&by_steps(&file, step)?, &file, FEWEST, listeners)?
    } else {
        let state = file.start.state(&any).map_err(Stop::Start)?;
        make(&any, state, course(file, choice.steps), |now| sample(&file.group, now), watches(file), listeners)?
    };
    run.choice = Some(choice);
    Ok(run)
}

/// The stepper that is the cheapest for an accuracy, of a scene whose step is data.
fn searched(file: &SceneFile, data: &Data, accuracy: Accuracy) -> Result<(AnyStepper, Choice), Stop> {
    let stepper = data.stepper(Method::default(), accuracy.horizon).map_err(whole_error)?;
    let state = file.start.state(&stepper).map_err(Stop::Start)?;
    let velocity = if file.start.is_by_momentum { stepper.velocity(&state) } else { file.start.velocity.clone() };
    let candidate = |scheme| {
        let own = data.clone();
        let make = move |h| match own.stepper(Method::from(scheme), h) {
            Ok(stepper) => Ok(stepper),
            Err(WholeError::Setup(error)) => Err(error),
            Err(_) => Err(SetupError::Method { cause: "has no step of this declaration; take another" }),
        };
        Candidate { scheme, make: Box::new(make) }
    };
    let candidates: Vec<_> = of_any_group(data.sum.is_self_adjoint).map(candidate).collect();
    let attitude = &file.start.attitude;
    let beside = data.sum.displaced(attitude, &displacement(velocity.len()));
    choose(&candidates, accuracy, [attitude, &beside], &velocity).map_err(Stop::Accuracy)
}
