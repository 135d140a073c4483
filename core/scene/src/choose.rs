//! The choice of a scene's type and method, once a run.

// The letters of the field.
#![allow(non_snake_case)]

use liestep::accuracy::{Accuracy, Choice};
use liestep::effects::{CayleyBody, FourthOrderBody, GeodesicBody, PrincipalBody, RigidBody, SixthOrderBody};
use liestep::groups::Advected;
use liestep::methods::ExactBody;
use liestep::motion::AnyStepper;
use liestep::{SO3, SetupError, Stepper};

use crate::body::{Distribution, Kinetic};
use crate::effects::Table as _;
use crate::file::{Pace, SceneFile};
use crate::method::{Method, Stages};
use crate::run::{Run, Stopped, Told, make};
use crate::switched::Switched;

/// The sums of a body and what is switched, each of one type; a file's scene is the shortest that has all that it names.
///
/// An effect with an unknown part makes each iteration longer, and that of magnetic damping raises the degree of the
/// equation. Which effects there are beside is asked at run time: all subsets would be 512 types of each kinetic term.
macro_rules! sums {
    ($file:expr, $body:expr) => {{
        let (file, body, J) = ($file, $body, $file.body.inertia());
        macro_rules! switched {
            ($effect:ident) => {
                Switched(file.$effect.as_ref().map(|table| table.effect(&J)))
            };
        }
        let potentials =
            body + switched!(gravity) + switched!(gravity_gradient) + switched!(dipole) + switched!(spring);
        let with_rotor = potentials + switched!(rotor);
        let dragged = with_rotor + switched!(drag);
        let driven = dragged + switched!(torque) + switched!(thrust);
        let damped = dragged + switched!(magnetic_damping) + switched!(torque) + switched!(thrust);
        (potentials, with_rotor, driven, damped)
    }};
}

/// Simulates the sum of the body and those effects that the file has.
///
/// Every run by (3.13) has the bits of the sum of just those. By other kinetic terms it is the same to rounding: beside an
/// unknown part that is switched off, their equation is solved with its Jacobian from the first iteration on.
pub(crate) fn run(file: &SceneFile, told: Told<'_>) -> Result<Run, Stopped> {
    match (file.run.pace, file.run.method) {
        (Pace::Accuracy(tolerance), _) => ask(file, tolerance, told),
        (Pace::Step { step, steps }, Method::Step | Method::Composition(_)) => stepped(file, (step, steps), told),
        (Pace::Step { step, steps }, _) => with_exact_body(file, (step, steps), told),
    }
}

/// By the declared steps of one of the kinetic terms, or a composition of them.
fn stepped(file: &SceneFile, (h, steps): (f64, u32), told: Told<'_>) -> Result<Run, Stopped> {
    macro_rules! step {
        ($scene:expr) => {
            match file.run.method {
                Method::Composition(scheme) => {
                    simulate(file, Stepper::composed($scene, h, scheme.0).map(Stepper::into_any), steps, told)
                }
                _ => step!(only $scene),
            }
        };
        (only $scene:expr) => {
            simulate(file, Stepper::new($scene, h).map(Stepper::into_any), steps, told)
        };
    }
    macro_rules! with_effects {
        ($body:expr) => {{
            let (_, with_rotor, _, damped) = sums!(file, $body);
            if file.force().is_some() { step!(only damped) } else { step!(with_rotor) }
        }};
    }
    let J = file.body.inertia();
    match (file.body.kinetic, file.body.mass) {
        // The kinetic term that most files have is there in four sums, not two.
        (Kinetic::Rigid, Distribution::Principal(J_d)) => {
            let (potentials, with_rotor, driven, damped) = sums!(file, PrincipalBody { J_d });
            if file.magnetic_damping.is_some() {
                step!(only damped)
            } else if file.force().is_some() {
                step!(only driven)
            } else if file.rotor.is_some() {
                step!(with_rotor)
            } else {
                step!(potentials)
            }
        }
        (Kinetic::Rigid, Distribution::Full(J_d)) => with_effects!(RigidBody { J_d }),
        (Kinetic::Cayley, _) => with_effects!(CayleyBody { J }),
        (Kinetic::Geodesic, _) => with_effects!(GeodesicBody { J }),
        (Kinetic::FourthOrder, _) => with_effects!(FourthOrderBody { J }),
        (Kinetic::SixthOrder, _) => with_effects!(SixthOrderBody { J }),
    }
}

/// By methods that look at inertia and potential only.
fn with_exact_body(file: &SceneFile, (h, steps): (f64, u32), told: Told<'_>) -> Result<Run, Stopped> {
    let J = file.body.inertia();
    let (_, scene, _, _) = sums!(file, RigidBody { J_d: J.to_nonstandard() });
    let stepper = match file.run.method {
        Method::Step | Method::Composition(_) => Stepper::new(scene, h).map(Stepper::into_any),
        Method::Splitting(scheme) => Stepper::split(scene, h, ExactBody::new(&J), scheme.0).map(Stepper::into_any),
        Method::Processed(scheme) => Stepper::processed(scene, h, ExactBody::new(&J), scheme.0).map(Stepper::into_any),
        Method::Collocation(Stages::Four) => Stepper::collocated::<2>(scene, h).map(Stepper::into_any),
        Method::Collocation(Stages::Eight) => Stepper::collocated::<4>(scene, h).map(Stepper::into_any),
    };
    simulate(file, stepper, steps, told)
}

/// Makes the steps of a scene.
fn simulate<A: Advected<SO3>>(
    file: &SceneFile,
    stepper: Result<AnyStepper<SO3, A>, SetupError>,
    steps: u32,
    told: Told<'_>,
) -> Result<Run, Stopped> {
    let stepper = stepper.map_err(Stopped::Setup)?;
    let state = stepper.start(file.start.attitude, file.start.velocity).map_err(Stopped::Start)?;
    make(file, &stepper, state, (u64::from(steps), None), told)
}

/// Makes the steps that an accuracy takes.
fn ask(file: &SceneFile, tolerance: f64, told: Told<'_>) -> Result<Run, Stopped> {
    let accuracy = Accuracy { tolerance, horizon: file.run.duration };
    macro_rules! ask {
        ($scene:expr) => {{
            let stepper = Stepper::for_accuracy($scene, accuracy, file.start.attitude, file.start.velocity)
                .map_err(Stopped::Asked)?;
            let choice: Choice = stepper.choice().clone();
            make(file, &stepper, stepper.start(), (choice.steps, Some(choice)), told)
        }};
    }
    match file.body.mass {
        Distribution::Principal(J_d) => {
            let (potentials, with_rotor, _, _) = sums!(file, PrincipalBody { J_d });
            if file.rotor.is_some() { ask!(with_rotor) } else { ask!(potentials) }
        }
        Distribution::Full(J_d) => {
            let (_, with_rotor, _, _) = sums!(file, RigidBody { J_d });
            ask!(with_rotor)
        }
    }
}
