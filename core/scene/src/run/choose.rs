//! The choice of a scene's type and method, once a run.

use std::rc::Rc;

use liestep::accuracy::Accuracy;
use liestep::effects::{PrincipalBody, RigidBody};
use liestep::groups::Advected;
use liestep::mechanics::Term as _;
use liestep::methods::ExactBody;
use liestep::motion::AnyStepper;
use liestep::{SO3, SetupError, Stepper};

use crate::file::body::Distribution;
use crate::file::effects::{Share, Table as _, effects};
use crate::file::lagrangian::Lagrangian;
use crate::file::method::{Method, Stages};
use crate::file::scene::SceneFile;
use crate::file::schedule::Pace;
use crate::run::course::{MemberStart, course, sample, watches};
use crate::run::kinetic::ChosenBody;
use crate::run::make::{Listeners, Run, Stop, make};
use crate::run::switched::Switched;

/// The sums of a body and what is switched, each of one type; a file's scene is the shortest that has all that it names.
///
/// An effect with an unknown part makes each iteration longer, and that of magnetic damping raises the degree of the
/// equation. Which effects there are beside is asked at run time: all subsets would be 512 types of each kinetic term.
macro_rules! sums {
    ($file:expr, $J:expr, $body:expr) => { sums!($file, $J, $body, at 0.0) };
    ($file:expr, $J:expr, $body:expr, at $time:expr) => {{
        let (file, body, J, time) = ($file, $body, $J, $time);
        effects!(sums_of file J body time)
    }};
}

/// Those of the list.
macro_rules! sums_of {
    (
        { $file:ident $J:ident $body:ident $time:ident }
        potentials { $($potential:ident: $potential_table:ident $potential_keys:tt => |$($a:tt),+| -> $A:ty $b:block)+ }
        shifts { $($shift:ident: $shift_table:ident $shift_keys:tt => |$($c:tt),+| -> $C:ty $d:block)+ }
        forces { $($force:ident: $force_table:ident $force_keys:tt => |$($e:tt),+| -> $E:ty $f:block)+ }
        steep_forces { $($steep:ident: $steep_table:ident $steep_keys:tt => |$($g:tt),+| -> $G:ty $h:block)+ }
    ) => {{
        let potentials = $body $(+ Switched($file.$potential.as_ref().map(|table| table.effect(&$J, $time))))+;
        let with_rotor = potentials $(+ Switched($file.$shift.as_ref().map(|table| table.effect(&$J, $time))))+;
        let driven = with_rotor $(+ Switched($file.$force.as_ref().map(|table| table.effect(&$J, $time))))+;
        let damped = driven $(+ Switched($file.$steep.as_ref().map(|table| table.effect(&$J, $time))))+;
        (potentials, with_rotor, driven, damped)
    }};
}

/// Simulates the sum of the body and those effects that the file has.
///
/// Every run by (3.13) has the bits of the sum of just those. By other kinetic terms it is the same to rounding: beside an
/// unknown part that is switched off, their equation is solved with its Jacobian from the first iteration on.
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
    let Some(body) = file.body else {
        return match &file.lagrangian {
            Some(Lagrangian::Usual(late)) => step!(late.clone()),
            Some(Lagrangian::Expensive(late)) => step!(late.clone()),
            Some(Lagrangian::Paced(late)) => {
                let stepper = Stepper::new(late.clone(), h).and_then(Stepper::paced);
                simulate(file, stepper.map(Stepper::into_any), purpose)
            }
            None => Err(nothing()),
        };
    };
    let J = body.inertia();
    macro_rules! with_effects {
        ($body:expr) => {{
            if file.turning().next().is_some() {
                let (body, seen) = ($body, Rc::new(file.clone()));
                let scene = sums!(file, J, body).3;
                let values = move |time| sums!(&*seen, J, body, at time).3.advected();
                let stepper = match file.run.steps_per_orbit.and_then(|steps| file.orbit()?.clock(steps).ok()) {
                    None => Stepper::new(scene, h).map(|stepper| stepper.driven(values).into_any()),
                    Some((clock, _)) => {
                        Stepper::new(scene, 1.0).map(|stepper| stepper.with_clock(clock).driven(values).into_any())
                    }
                };
                return simulate(file, stepper, purpose);
            }
            let (_, with_rotor, _, damped) = sums!(file, J, $body);
            if file.last_share() < Share::Force { step!(with_rotor) } else { step!(only damped) }
        }};
    }
    match (ChosenBody::of(body.kinetic, J), body.mass) {
        (Some(body), _) => with_effects!(body),
        // The kinetic term that most files have is there in four sums, not two.
        (None, Distribution::Principal(J_d)) if file.turning().next().is_none() => {
            let (potentials, with_rotor, driven, damped) = sums!(file, J, PrincipalBody { J_d });
            match file.last_share() {
                Share::Potential => step!(potentials),
                Share::Shift => step!(with_rotor),
                Share::Force => step!(only driven),
                Share::SteepForce => step!(only damped),
            }
        }
        // What turns is given to the steps of one sum, the longest.
        (None, mass) => {
            let J_d = match mass {
                Distribution::Principal(J_d) => J_d.into(),
                Distribution::Full(J_d) => J_d,
            };
            with_effects!(RigidBody { J_d })
        }
    }
}

/// By methods that look at inertia and potential only.
fn with_exact_body(file: &SceneFile, h: f64, purpose: Purpose<'_, '_>) -> Result<(), Stop> {
    let J = file.body.ok_or_else(nothing)?.inertia();
    let (_, scene, _, _) = sums!(file, J, RigidBody { J_d: J.to_nonstandard() });
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
    match body.mass {
        Distribution::Principal(J_d) => {
            let (potentials, with_rotor, _, _) = sums!(file, J, PrincipalBody { J_d });
            if file.last_share() < Share::Shift { ask!(potentials) } else { ask!(with_rotor) }
        }
        Distribution::Full(J_d) => {
            let (_, with_rotor, _, _) = sums!(file, J, RigidBody { J_d });
            ask!(with_rotor)
        }
    }
}
