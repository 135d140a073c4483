//! Derivatives of motions: the tangent map of a step, its transpose, and what is made of them.
//!
//! PAGE

mod adjoint;
mod exponents;
mod recorded;
mod stage;
mod tangent;

pub use adjoint::{Backwards, Gradient, Tape};
pub use recorded::Event;
pub use stage::{Cotangent, Pass, Stage};
pub use tangent::{Tangent, TangentOf};

use core::cell::RefCell;
use core::ops::Range;

use crate::error::{SetupError, StepError};
use crate::mechanics::{Effect, Group, Scalar, SceneVisitor, SecondDerivatives};
use crate::motion::declared::Declared;
use crate::motion::plan::Plan;
use crate::motion::report::StepReport;
use crate::motion::stepper::{StateOf, Stepper};
use recorded::Recorded;

/// A plan whose steps can be differentiated.
#[diagnostic::on_unimplemented(
    message = "the derivatives of a step of `{Self}` aren't known",
    label = "not with this method",
    note = "known are those of a scene's own step, of compositions, and of splittings whose flow is declared with `gradients`"
)]
pub trait Linearisable<S: SecondDerivatives>: Plan<S> {
    /// How many scalars the parameters have: those of the scene, and behind them those of what else the plan moves by.
    fn parameters(&self) -> usize {
        S::PARAMETERS
    }

    /// Shows them.
    fn describe_parameters(&self, scene: &S, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        scene.describe(visitor);
    }

    /// Whether all stages have known derivatives.
    ///
    /// # Errors
    ///
    /// [`SetupError::NoSecondDerivatives`] where one hasn't.
    fn check_stages(&self) -> Result<(), SetupError> {
        Ok(())
    }

    /// How many changes a step makes.
    fn stages(&self) -> usize;

    /// Shows the stage that has made the change of this number to a pass.
    fn visit(&self, scene: &S, index: usize, event: &Event<Group<S>, S::Advected>, pass: &mut impl Pass<Group<S>>);
}

impl<S: SecondDerivatives> Linearisable<S> for Declared<S> {
    fn stages(&self) -> usize {
        1
    }

    #[inline(always)]
    fn visit(&self, scene: &S, _: usize, event: &Event<Group<S>, S::Advected>, pass: &mut impl Pass<Group<S>>) {
        pass.stage(&Stage::step(scene, self.step_size(), event, event.before.advected));
    }
}

/// A stepper with the derivatives of its steps, by [`Stepper::linearised`].
#[derive(Clone, Copy, Debug)]
pub struct Linearised<'a, S: Effect, P> {
    stepper: &'a Stepper<S, P>,
}

/// One scalar of the parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter<T> {
    /// The number of the term in the sum, from the left.
    pub term: usize,
    /// The field that it belongs to.
    pub field: &'static str,
    /// Its value.
    pub value: T,
}

impl<S: SecondDerivatives, P: Linearisable<S>> Stepper<S, P> {
    /// The derivatives of the steps, by the start and by every parameter.
    ///
    /// A scene is asked for them by the word `gradients` in its declaration; the effects of the library have it.
    ///
    /// # Errors
    ///
    /// [`SetupError::NoSecondDerivatives`] for a splitting with force gradients.
    pub fn linearised(&self) -> Result<Linearised<'_, S, P>, SetupError> {
        self.plan.check_stages()?;
        Ok(Linearised { stepper: self })
    }
}

impl<'a, S: SecondDerivatives, P: Linearisable<S>> Linearised<'a, S, P> {
    /// The stepper.
    #[must_use]
    pub fn stepper(&self) -> &'a Stepper<S, P> {
        self.stepper
    }

    /// The parameters, scalar by scalar: term after term, field after field, matrices row by row. A diagonal or symmetric
    /// matrix has all of its entries.
    #[must_use]
    pub fn parameters(&self) -> Vec<Parameter<Scalar<S>>> {
        struct All<T>(usize, Vec<Parameter<T>>);
        impl<T> SceneVisitor<T> for All<T> {
            fn term(&mut self, _: &'static str) {
                self.0 += 1;
            }

            fn parameter(&mut self, field: &'static str, value: T) {
                self.1.push(Parameter { term: self.0.saturating_sub(1), field, value });
            }
        }
        let mut all = All(0, Vec::new());
        self.stepper.plan.describe_parameters(&self.stepper.scene, &mut all);
        all.1
    }

    /// The numbers of a field's scalars among the parameters; `None` where that term has no such field.
    #[must_use]
    pub fn numbers(&self, term: usize, field: &str) -> Option<Range<usize>> {
        let parameters = self.parameters();
        let is_its = |parameter: &Parameter<Scalar<S>>| parameter.term == term && parameter.field == field;
        let start = parameters.iter().position(is_its)?;
        let end = parameters.iter().rposition(is_its)?;
        Some(start..end + 1)
    }

    /// The identity, to be carried along by [`step`](Self::step); with columns for these parameters, by their numbers.
    ///
    /// # Panics
    ///
    /// Where there is no parameter of a number.
    #[must_use]
    pub fn tangent(&self, parameters: &[usize]) -> TangentOf<S> {
        let count = self.stepper.plan.parameters();
        assert!(parameters.iter().all(|&number| number < count), "there are {count} parameters, numbered from 0");
        Tangent::new(count, parameters)
    }

    /// One step, and the derivatives carried over it. On an error both are unchanged.
    ///
    /// # Errors
    ///
    /// As [`Stepper::step`], and [`StepError::NonFinite`] where a derivative overflows, as it does in chaos.
    pub fn step(&self, state: &mut StateOf<S, P>, tangent: &mut TangentOf<S>) -> Result<StepReport, StepError> {
        let Stepper { scene, plan } = self.stepper;
        let mut next = *state;
        tangent.events.get_mut().clear();
        let report = self.recorded(&mut next, &tangent.events)?;
        let events = tangent.events.take();
        tangent.keep();
        for (index, event) in events.iter().enumerate() {
            plan.visit(scene, index, event, tangent);
        }
        tangent.events.replace(events);
        if !tangent.is_finite() {
            tangent.go_back();
            return Err(StepError::NonFinite { what: "derivative after the step" });
        }
        *state = next;
        Ok(report)
    }

    /// One step, whose stages are written down.
    #[inline(always)]
    fn recorded(
        &self,
        state: &mut StateOf<S, P>,
        events: &RefCell<Vec<Event<Group<S>, S::Advected>>>,
    ) -> Result<StepReport, StepError> {
        let Stepper { scene, plan } = self.stepper;
        let mut recorded = Recorded { motion: state.motion, events };
        match plan.step(scene, &mut recorded, &mut state.kept) {
            Ok(report) => {
                state.motion = recorded.motion;
                Ok(report)
            }
            Err(error) if P::EXPLAINS => Err(plan.explained(error, scene, &state.motion, &state.kept)),
            Err(error) => Err(error),
        }
    }
}
