//! A declaration with numbers as a scene to run, for any group and any advected parameters.

use std::sync::Arc;

use liestep::accuracy::{Accuracy, Candidate, Choice, choose, displacement, of_any_group};
use liestep::groups::{Advected, CayleyRetraction, Given, LieGroup, Retraction};
use liestep::mechanics::{Scene as Stepped, WithKinetic};
use liestep::motion::AnyStepper;
use liestep::numbers::Entries as _;
use liestep::with::{Method, Steppable};
use liestep::{SO3, SetupError, Stepper};
use liestep_late::{Declaration, LateError, Role, Slots, Whole, WholeError};
use nalgebra::SVector;

use crate::ensemble::{Draws, Members, Outcome, run_members};
use crate::failure::Failure;
use crate::run::{Course, RunRecord, record};
use crate::start::{Start, started};

type V<const N: usize> = SVector<f64, N>;
/// The advected vectors on SO(3) where there are several, and those beside the energy of a pace.
type Four = (V<3>, V<3>, V<3>, V<3>);
type WithEnergy = (Given<f64>, V<3>, V<3>, V<3>);

/// The back end of programs: machine code if that feature is on, otherwise the interpreter, with the same bits.
#[cfg(feature = "machine")]
pub(crate) type Backend = liestep_machine::Machine;
#[cfg(not(feature = "machine"))]
pub(crate) type Backend = liestep_late::Interpreter;

type Late<G, W, K> = liestep_late::Late<G, W, K, Backend>;
type Sum<G, W> = Late<G, W, WithKinetic>;

/// A declaration whose group and advected parameters are types inside, and numbers outside.
pub(crate) trait Steps: Send + Sync {
    /// The stepper of the declaration with other numbers, by a method.
    fn stepper(&self, numbers: &[f64], method: (Method, f64)) -> Result<AnyStepper, Failure>;

    /// The stepper by the method and the step that are the cheapest for an accuracy.
    fn accurate(&self, numbers: &[f64], accuracy: Accuracy, start: &Start) -> Result<(AnyStepper, Choice), Failure>;
}

impl<G, W> Steps for Sum<G, W>
where
    G: LieGroup<Scalar = f64> + Steppable<Self>,
    W: Advected<G> + Slots + Send + Sync + 'static,
    CayleyRetraction: Retraction<G>,
    Self: Stepped<Scalar = f64, Group = G, Advected = W> + Send + Sync,
{
    fn stepper(&self, numbers: &[f64], (method, h): (Method, f64)) -> Result<AnyStepper, Failure> {
        let sum = self.clone().with_all(numbers)?;
        method.stepper(sum, h).map_err(|error| Failure::setup(&error))
    }

    fn accurate(&self, numbers: &[f64], accuracy: Accuracy, start: &Start) -> Result<(AnyStepper, Choice), Failure> {
        let layout = G::factors();
        let (attitude, velocity) = (start.attitude(&layout)?, start.velocity(&layout)?);
        let read = |numbers: &[f64]| numbers.to_vec().into_iter();
        let (mut entries, mut components) = (read(&attitude), read(velocity));
        let attitude = G::from_matrix_unchecked(G::Matrix::from_entries(&mut || entries.next().unwrap_or(f64::NAN)));
        let velocity = G::Vector::from_entries(&mut || components.next().unwrap_or(f64::NAN));
        let sum = self.clone().with_all(numbers)?;
        let stepper =
            Stepper::for_accuracy(sum, accuracy, attitude, velocity).map_err(|error| Failure::setup(&error))?;
        Ok((stepper.any().clone(), stepper.choice().clone()))
    }
}

/// A scene: the sum of all terms in one program, with the numbers of all, term by term.
#[derive(Clone)]
pub(crate) struct Scene {
    steps: Arc<dyn Steps>,
    declaration: &'static Declaration,
    numbers: Vec<f64>,
    has_force: bool,
}

impl Scene {
    /// The stepper by a method and a step.
    pub(crate) fn stepper(&self, (method, h): (Method, f64)) -> Result<AnyStepper, Failure> {
        self.with(&self.numbers, (method, h))
    }

    fn with(&self, numbers: &[f64], (method, h): (Method, f64)) -> Result<AnyStepper, Failure> {
        if self.has_force && !method.is_plain() {
            let message = "a scene with a force is made by its own step alone: leave the method out";
            return Err(Failure::Of("SetupError", message.to_owned()));
        }
        self.steps.stepper(numbers, (method, h))
    }

    /// Whether a step of `−h` undoes one of `h`, as methods of a higher order require.
    pub(crate) fn is_self_adjoint(&self) -> bool {
        self.declaration.is_self_adjoint
    }

    /// The run by a method and a step.
    pub(crate) fn run(&self, method: (Method, f64), start: &Start, course: &Course) -> Result<RunRecord, Failure> {
        let stepper = self.stepper(method)?;
        record(&stepper, started(&stepper, start)?, course)
    }

    /// The run by the method and the step that are the cheapest for a tolerance.
    pub(crate) fn accurate(
        &self,
        tolerance: f64,
        start: &Start,
        course: &Course,
    ) -> Result<(RunRecord, Choice), Failure> {
        let accuracy = Accuracy { tolerance, horizon: course.until };
        let (stepper, choice) = self.steps.accurate(&self.numbers, accuracy, start)?;
        Ok((record(&stepper, started(&stepper, start)?, course)?, choice))
    }

    /// The members of an ensemble.
    pub(crate) fn members(
        &self,
        (method, h): (Method, f64),
        start: &Start,
        draws: Draws,
        plan: Members,
    ) -> Result<Outcome, Failure> {
        if self.declaration.energy.is_some() || method.varies() {
            let message =
                "members make the same number of steps, and those of a pace or a density end at different times";
            return Err(Failure::Of("SetupError", message.to_owned()));
        }
        // The first member reports a mistake of all.
        let stepper = self.stepper((method, h))?;
        started(&stepper, start)?;
        let own = self.clone();
        let make = move |draw: &dyn Fn(&mut [f64])| {
            let mut numbers = own.numbers.clone();
            draw(&mut numbers);
            own.with(&numbers, (method, h))
        };
        run_members(plan, start, draws, (stepper.layout().factors.clone(), make), h)
    }
}

/// A declaration on any group, whose step is data: its first stepper has the code that all others share.
struct Data(&'static Declaration);

impl Data {
    fn whole(&self, numbers: &[f64], method: Method, h: f64) -> Result<AnyStepper, WholeError> {
        Whole::<Backend>::of(self.0, numbers, h, method).map(AnyStepper::new)
    }
}

impl Steps for Data {
    fn stepper(&self, numbers: &[f64], (method, h): (Method, f64)) -> Result<AnyStepper, Failure> {
        Ok(self.whole(numbers, method, h)?)
    }

    fn accurate(&self, numbers: &[f64], accuracy: Accuracy, start: &Start) -> Result<(AnyStepper, Choice), Failure> {
        let stepper = self.stepper(numbers, (Method::default(), accuracy.horizon))?;
        let factors = &stepper.layout().factors;
        let (attitude, velocity) = (start.attitude(factors)?, start.velocity(factors)?);
        let candidate = |scheme| {
            let (own, numbers) = (Self(self.0), numbers.to_vec());
            let make = move |h| match own.whole(&numbers, Method::from(scheme), h) {
                Ok(stepper) => Ok(stepper),
                Err(WholeError::Setup(error)) => Err(error),
                Err(_) => Err(SetupError::Method { cause: "has no step of this declaration; take another" }),
            };
            Candidate { scheme, make: Box::new(make) }
        };
        let candidates: Vec<_> = of_any_group(self.0.is_self_adjoint).map(candidate).collect();
        let beside = self.0.displaced(&attitude, &displacement(velocity.len()));
        choose(&candidates, accuracy, [&attitude, &beside], velocity).map_err(|error| Failure::setup(&error))
    }
}

impl From<WholeError> for Failure {
    fn from(error: WholeError) -> Self {
        match error {
            WholeError::Declaration(error) => error.into(),
            WholeError::Setup(error) => Self::setup(&error),
        }
    }
}

/// The steps of a declaration, if its group and its advected parameters are these types.
fn typed<G, W>(sum: &'static Declaration, numbers: &[f64]) -> Result<Arc<dyn Steps>, LateError>
where
    G: LieGroup<Scalar = f64>,
    W: Advected<G> + Slots + 'static,
    Sum<G, W>: Steps + 'static,
{
    Ok(Arc::new(Sum::<G, W>::of(sum)?.with_all(numbers)?))
}

/// The scene of the sum of these terms, with the numbers of all.
pub(crate) fn scene(terms: &[&'static Declaration], numbers: &[f64]) -> Result<Scene, Failure> {
    if terms.len() > 1 && terms.iter().any(|term| term.energy.is_some()) {
        return Err(Failure::setup(&LateError::Pace));
    }
    let sum = Declaration::sum(terms)?;
    if !sum.has_kinetic {
        let message = "nothing moves by a potential alone: add a kinetic energy, as in `ls.body(J) + potential`";
        return Err(Failure::Of("DeclarationError", message.to_owned()));
    }
    let has_force = terms.iter().any(|term| term.role == Role::Force);
    macro_rules! first_that_fits {
        ($sum:expr; $($group:ty: $($carried:ty),+;)+) => {$($(
            match typed::<$group, $carried>($sum, numbers) {
                Err(LateError::Group { .. } | LateError::Advected { .. }) => {}
                steps => {
                    return Ok(Scene { steps: steps?, declaration: $sum, numbers: numbers.to_vec(), has_force });
                }
            }
        )+)+};
    }
    // A sum with more vectors than the types have advects the directions of space instead.
    for in_frames in [false, true] {
        let sum = if in_frames && sum.energy.is_none() { Declaration::sum_in_frames(terms)? } else { sum };
        first_that_fits! {
            sum;
            SO3: V<3>, Four, WithEnergy;
        }
    }
    Ok(Scene { steps: Arc::new(Data(sum)), declaration: sum, numbers: numbers.to_vec(), has_force })
}
