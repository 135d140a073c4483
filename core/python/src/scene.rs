//! A declaration with numbers as a scene to run, for any group and any advected parameters.

use std::rc::Rc;
use std::sync::Arc;

use liestep::accuracy::{Accuracy, Choice, Measure};
use liestep::motion::{AnyStepper, Propagator as _};
use liestep::with::{Method, Scheme};
use liestep_late::{
    Course as _, Declaration, LateError, Question, QuestionError, Role, Sums, Whole, WholeError, for_accuracy, layout,
    stepper,
};

use crate::ensemble::{Draws, Members, Outcome, run_members};
use crate::failure::Failure;
use crate::run::{Course, RunRecord, record};
use crate::signal::{Change, Changes, SceneCourse, SignalSlopes};
use crate::start::{Start, started};

/// The back end of programs: machine code if that feature is on, otherwise the interpreter, with the same bits.
#[cfg(feature = "machine")]
pub(crate) type Backend = liestep_machine::Machine;
#[cfg(not(feature = "machine"))]
pub(crate) type Backend = liestep_late::Interpreter;

/// A scene: the sum of all terms in one program, with the numbers of all, term by term.
#[derive(Clone)]
pub(crate) struct Scene {
    declaration: &'static Declaration,
    numbers: Vec<f64>,
    has_force: bool,
    changes: Arc<Changes>,
}

impl Scene {
    /// The stepper by a method and a step.
    pub(crate) fn stepper(&self, (method, h): (Method, f64)) -> Result<AnyStepper, Failure> {
        self.with(&self.numbers, (method, h))
    }

    /// The stepper with other numbers of all terms.
    pub(crate) fn with(&self, numbers: &[f64], (method, h): (Method, f64)) -> Result<AnyStepper, Failure> {
        let is_own = matches!(method.scheme, Scheme::Step | Scheme::Composition(_));
        let is_declared = is_own && !method.compensated && !method.varies();
        if self.has_force && !is_declared {
            let message = "a scene with a force is made by its own step or a `composition` of it: take one, or leave the method out";
            return Err(Failure::Of("SetupError", message.to_owned()));
        }
        if self.changes.are_none() {
            return Ok(stepper::<Backend>(self.declaration, numbers, h, method)?);
        }
        if !is_declared || self.declaration.energy.is_some() {
            let message = "a signal is beside the declared step or a `composition` of it, with `substeps` or without";
            return Err(Failure::Of("SetupError", message.to_owned()));
        }
        let whole = Whole::<Backend>::of(self.declaration, numbers, h, method)?;
        let driven = whole.driven(self.course());
        Ok(AnyStepper::new(driven.map_err(|error| self.caused(Failure::setup(&error)))?))
    }

    /// The numbers of what is carried along, as the body sees them at the attitude of a state and at this time, s.
    pub(crate) fn seen(&self, state: &[f64], time: f64) -> Result<Vec<f64>, Failure> {
        let mut numbers = self.numbers.clone();
        self.course().at(time, &mut numbers);
        let whole = Whole::<Backend>::of(self.declaration, &numbers, 1.0, Method::default())?;
        Ok(whole.adopt(state)[whole.layout().advected()].to_vec())
    }

    /// The stepper of the declared step, or of a composition of it, with the numbers of the start.
    pub(crate) fn whole(&self, (method, h): (Method, f64)) -> Result<Whole<Backend>, Failure> {
        Ok(Whole::of(self.declaration, &self.numbers, h, method)?)
    }

    /// The numbers of the terms as functions of time.
    pub(crate) fn course(&self) -> SceneCourse {
        SceneCourse(Arc::clone(&self.changes))
    }

    /// No derivatives by the parameters that change with time, for so many steps.
    pub(crate) fn slopes(&self, steps: u64, h: f64) -> SignalSlopes {
        SignalSlopes::none(Arc::clone(&self.changes), steps, h)
    }

    /// Whether it is stepped in a time of its own.
    pub(crate) fn has_pace(&self) -> bool {
        self.declaration.energy.is_some()
    }

    /// Whether there are parameters that change with time.
    pub(crate) fn has_changes(&self) -> bool {
        !self.changes.are_none()
    }

    /// Forgets the cause of an earlier failure.
    pub(crate) fn forget(&self) {
        self.changes.cause();
    }

    /// A failure, by its cause where that is a signal without a value.
    pub(crate) fn caused(&self, failure: Failure) -> Failure {
        self.changes.cause().unwrap_or(failure)
    }

    /// Whether a step of `−h` undoes one of `h`, as methods of a higher order require.
    pub(crate) fn is_self_adjoint(&self) -> bool {
        self.declaration.is_self_adjoint
    }

    /// A step in C99.
    pub(crate) fn c(&self, sums: Sums) -> Result<String, Failure> {
        Ok(liestep_late::c(self.declaration, sums)?)
    }

    /// The step as data, with the claims that are to be checked.
    pub(crate) fn certificate(&self) -> Result<String, Failure> {
        Ok(liestep_late::certificate(self.declaration)?)
    }

    /// The run by a method and a step.
    pub(crate) fn run(&self, method: (Method, f64), start: &Start, course: &Course) -> Result<RunRecord, Failure> {
        let stepper = self.stepper(method)?;
        self.forget();
        let mut recorded = record(&stepper, started(&stepper, start)?, course)?;
        recorded.failure = recorded.failure.map(|failure| self.caused(failure));
        Ok(recorded)
    }

    /// The run by the method and the step that are the cheapest for a tolerance.
    pub(crate) fn accurate(
        &self,
        tolerance: f64,
        start: &Start,
        course: &Course,
    ) -> Result<(RunRecord, Choice), Failure> {
        let accuracy = Accuracy { tolerance, horizon: course.until };
        let layout = layout::<Backend>(self.declaration)?;
        let (attitude, velocity) = (start.attitude(&layout.factors)?, start.velocity(&layout.factors)?);
        let question = Question { accuracy, attitude: &attitude, velocity };
        let own: Option<Rc<dyn liestep_late::Course>> = self.has_changes().then(|| Rc::new(self.course()) as Rc<_>);
        let found = for_accuracy::<Backend>(self.declaration, &self.numbers, own.as_ref(), question);
        // A trial by longer steps may have left the values of a signal.
        let cause = self.changes.cause();
        let (stepper, choice) = found.map_err(|error| match error {
            QuestionError::Whole(error) => error.into(),
            QuestionError::Accuracy(error) => cause.unwrap_or_else(|| Failure::setup(&error)),
        })?;
        Ok((record(&stepper, started(&stepper, start)?, course)?, choice))
    }

    /// The error of an end by the last of the states of the exact motion, from its start. Each has the columns of the attitude, and the
    /// velocity.
    pub(crate) fn error(&self, end: &[Vec<f64>; 2], exact: &[[Vec<f64>; 2]], time: f64) -> Result<f64, Failure> {
        fn slices([attitude, velocity]: &[Vec<f64>; 2]) -> [&[f64]; 2] {
            [attitude, velocity]
        }
        let factors = layout::<Backend>(self.declaration)?.factors;
        let state = |[columns, velocity]: &[Vec<f64>; 2]| {
            let (mut entries, mut rest) = (Vec::new(), &columns[..]);
            for factor in &factors {
                let (own, behind) = rest.split_at(factor.kind.columns().min(rest.len()));
                entries.extend(factor.kind.entries(own));
                rest = behind;
            }
            [entries, velocity.clone()]
        };
        let (end, states) = (state(end), exact.iter().map(state).collect::<Vec<_>>());
        let (Some(start), Some(last)) = (states.first(), states.last()) else { return Ok(f64::NAN) };
        let mut measure = Measure::new(&factors, None);
        states.iter().for_each(|state| measure.see(slices(start), slices(state)));
        Ok(measure.error(slices(&end), slices(last), slices(start), time))
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

impl From<WholeError> for Failure {
    fn from(error: WholeError) -> Self {
        match error {
            WholeError::Declaration(error) => error.into(),
            WholeError::Setup(error) => Self::setup(&error),
        }
    }
}

/// The scene of the sum of these terms, with the numbers of all.
pub(crate) fn scene(terms: &[&'static Declaration], numbers: &[f64], changes: Vec<Change>) -> Result<Scene, Failure> {
    if terms.len() > 1 && terms.iter().any(|term| term.energy.is_some()) {
        return Err(Failure::setup(&LateError::Pace));
    }
    let sum = Declaration::sum(terms)?;
    if !sum.has_kinetic {
        let message = "nothing moves by a potential alone: add a kinetic energy, as in `ls.body(J) + potential`";
        return Err(Failure::Of("DeclarationError", message.to_owned()));
    }
    let has_force = terms.iter().any(|term| term.role == Role::Force);
    Ok(Scene { declaration: sum, numbers: numbers.to_vec(), has_force, changes: Arc::new(Changes::of(changes)) })
}
