//! The step of a scene as data: the sum of its terms, and their numbers.

use liestep::effects::{CayleyBody, FourthOrderBody, GeodesicBody, PrincipalBody, RigidBody, SixthOrderBody};
use liestep::mechanics::{Effect, Inertia};
use liestep::motion::AnyStepper;
use liestep::with::Method;
use liestep_late::{Declaration, LateError, WholeError};
use nalgebra::Vector3;

use crate::file::body::{Distribution, Kinetic};
use crate::file::control::locked;
use crate::file::lagrangian::Backend;
use crate::file::scene_file::SceneFile;
use crate::file::words::in_files;
use crate::run::make::Stop;

/// The step of all terms of a scene as data.
pub type Whole = liestep_late::Whole<Backend>;

/// A library body by its text, with its parameters.
#[derive(Clone)]
pub(crate) struct LibraryBody {
    pub(crate) text: &'static str,
    numbers: Vec<f64>,
}

impl LibraryBody {
    /// The body of a file; none with a kinetic energy of the file's own.
    pub(crate) fn of(file: &SceneFile, J: Inertia) -> Option<Self> {
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

/// A scene whose step is data: the sum of all terms, on any group.
#[derive(Clone)]
pub(crate) struct Data {
    pub(crate) sum: &'static Declaration,
    pub(crate) numbers: Vec<f64>,
}

impl Data {
    pub(crate) fn of(file: &SceneFile, J: &Inertia) -> Result<Self, Stop> {
        let body = LibraryBody::of(file, *J);
        let sum = file.declared(body.as_ref().map(|body| body.text));
        let sum = sum.map_err(|error| late_error(&error))?.ok_or_else(nothing)?;
        let numbers = sum
            .described(&numbers(file, [J, &locked(J, &file.wheel, 0)], body.as_ref(), 0.0))
            .map_err(|error| late_error(&error))?;
        Ok(Self { sum, numbers })
    }

    pub(crate) fn stepper(&self, method: Method, h: f64) -> Result<AnyStepper, WholeError> {
        liestep_late::stepper::<Backend>(self.sum, &self.numbers, h, method)
    }
}

/// The inertia of the body, or of the kinetic energy of the file's own, for effects that need it.
pub(crate) fn inertia(file: &SceneFile) -> Result<Inertia, Stop> {
    let own = match (file.body, file.effects().next()) {
        (Some(body), _) => return Ok(body.J),
        (None, None) => Inertia::from_principal_moments(Vector3::repeat(1.0)),
        (None, Some(_)) => Inertia::new(file.inertia().ok_or_else(nothing)?),
    };
    own.map_err(|error| Stop::Other(error.to_string()))
}

/// The parameters of all terms at a time, in order; the second inertia is that with the wheels.
pub(crate) fn numbers(file: &SceneFile, [J, whole]: [&Inertia; 2], body: Option<&LibraryBody>, time: f64) -> Vec<f64> {
    let [before, behind] = file.around().map(|own| own.flat_map(|own| own.numbers.iter().copied()));
    let body = body.iter().flat_map(|body| body.numbers.iter().copied());
    let of = |key: &str| if key == "gravity_gradient" { whole } else { J };
    let listed = file.effects().flat_map(|(effect, table)| table.numbers(of(effect.key), file.at(time)));
    body.chain(before).chain(listed).chain(behind).collect()
}

pub(crate) fn late_error(error: &LateError) -> Stop {
    Stop::Other(in_files(&error.to_string()))
}

pub(crate) fn whole_error(error: WholeError) -> Stop {
    match error {
        WholeError::Declaration(error) => late_error(&error),
        WholeError::Setup(error) => Stop::Setup(error),
    }
}

/// A missing body: impossible in a file that was read.
pub(crate) fn nothing() -> Stop {
    Stop::Other("there is no body".to_owned())
}
