//! The equal steps of a scene as numbers, for programs that have no file: pages, and units of other simulations.

use liestep::motion::Propagator as _;
use liestep::with::{Method, Scheme};
use liestep_derivation::{ParameterKind, Role};
use liestep_late::{Declaration, Sums, Whole, numbered};

use crate::file::effects::EFFECTS;
use crate::file::scene_file::SceneFile;
use crate::file::schedule::Pace;
use crate::run::data::{Data, inertia};

/// The step of a scene with its numbers, and the start.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    whole: Whole,
    pub(crate) declaration: &'static Declaration,
    /// The numbers of all parameters.
    pub(crate) numbers: Vec<f64>,
    /// s.
    pub(crate) step: f64,
    pub(crate) steps: u32,
    /// The stages of a step, as fractions of it.
    pub(crate) gammas: Vec<f64>,
    /// The matrices of the factors, row by row.
    pub(crate) attitude: Vec<f64>,
    /// Body frame.
    pub(crate) momentum: Vec<f64>,
    /// The velocity of the file, or that of its momentum; body frame.
    pub(crate) velocity: Vec<f64>,
    pub(crate) is_by_momentum: bool,
    pub(crate) parameters: Vec<ModelParameter>,
}

/// A parameter of a step.
#[derive(Clone, Debug)]
pub(crate) struct ModelParameter {
    /// Table and key, as in the file: `gravity.m`.
    pub(crate) name: String,
    pub(crate) kind: ParameterKind,
    /// The place of its first number among all.
    pub(crate) first: usize,
    /// The SI unit; empty where it isn't known, and none of a direction.
    pub(crate) unit: Option<&'static str>,
}

const BODIES: [&str; 6] =
    ["PrincipalBody", "RigidBody", "CayleyBody", "GeodesicBody", "FourthOrderBody", "SixthOrderBody"];

impl ModelParameter {
    /// The numbers' places.
    pub(crate) fn places(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.kind.len()
    }

    /// Whether the parameter is an inertia, kg m².
    pub(crate) const fn is_inertia(&self) -> bool {
        matches!(self.kind, ParameterKind::Inertia | ParameterKind::DiagonalInertia)
    }

    fn of(declaration: &Declaration) -> Vec<Self> {
        let mut first = 0;
        let parameter = |parameter: &liestep_derivation::Parameter| {
            // A sum names the term.
            let (term, key) = parameter.name.split_once('.').unwrap_or((&declaration.name, &parameter.name));
            let small = term.to_lowercase();
            let effect = EFFECTS.iter().find(|effect| effect.key.replace('_', "") == small);
            let table = effect.map_or(&*small, |effect| effect.key);
            let table = if BODIES.contains(&term) { "body" } else { table };
            let unit = effect.and_then(|effect| effect.units.iter().find(|(known, _)| *known == key));
            let mut own = Self { name: format!("{table}.{key}"), kind: parameter.kind, first, unit: Some("") };
            own.unit = if own.is_inertia() { Some("kg m²") } else { unit.map_or(Some(""), |(_, unit)| *unit) };
            first += parameter.kind.len();
            own
        };
        declaration.parameters.iter().map(parameter).collect()
    }
}

impl Model {
    /// The texts of the step's numbers in C; none where its bounds need the solve with care.
    pub(crate) fn numbered(&self, sums: Sums) -> Option<[String; 2]> {
        let mut velocity = self.velocity.clone();
        let state = self.whole.start_with_momentum(&self.attitude, &self.momentum).ok()?;
        self.whole.velocity(&state, &mut velocity);
        numbered(&self.whole, [&self.attitude, &self.momentum, &velocity], sums).ok()
    }

    /// The model of a scene, or the reason why it has none.
    pub(crate) fn of(file: &SceneFile) -> Result<Self, String> {
        if file.system.is_some() {
            return Err("it has several bodies, and a unit has one so far".to_owned());
        }
        let Pace::Step { step, steps } = file.run.pace else {
            return Err("the step is chosen by trial runs: give the run a `step`".to_owned());
        };
        let gammas = match file.run.method {
            Scheme::Step => vec![1.0],
            Scheme::Composition(scheme) => scheme.stages().collect(),
            _ => return Err("its method isn't one of steps: take `method = \"step\"` or a composition".to_owned()),
        };
        if file.has_steps_of_its_own() {
            return Err("its steps have several lengths: leave the density or the pace out".to_owned());
        }
        if file.has_devices() {
            return Err("it has a `control` or a `wheel`: leave them out, and take a `torque`".to_owned());
        }
        if let Some(changing) = file.changing() {
            return Err(format!("its {changing} changes with time: give a value"));
        }
        let said = |error: &dyn std::fmt::Display| error.to_string();
        let J = inertia(file).map_err(|error| said(&error))?;
        let Data { sum, numbers } = Data::of(file, &J).map_err(|error| said(&error))?;
        if sum.role == Role::Hamiltonian {
            return Err("it has a Hamiltonian, whose steps are made by the library alone".to_owned());
        }
        if !sum.is_quadratic {
            return Err("its Lagrangian isn't quadratic in the velocity".to_owned());
        }
        let method = Method::from(file.run.method);
        let whole = Whole::of(sum, &numbers, step, method).map_err(|error| said(&error))?;
        let (attitude, given) = (&file.start.attitude, &file.start.velocity);
        let is_by_momentum = file.start.is_by_momentum;
        let state =
            if is_by_momentum { whole.start_with_momentum(attitude, given) } else { whole.start(attitude, given) };
        let state = state.map_err(|error| said(&error))?;
        let mut velocity = given.clone();
        if is_by_momentum {
            whole.velocity(&state, &mut velocity);
        }
        let momentum = state[whole.layout().momentum()].to_vec();
        let (attitude, parameters) = (attitude.clone(), ModelParameter::of(sum));
        Ok(Self {
            whole,
            declaration: sum,
            numbers,
            step,
            steps,
            gammas,
            attitude,
            momentum,
            velocity,
            is_by_momentum,
            parameters,
        })
    }
}
