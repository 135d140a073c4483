//! Bodies of steppers whose states are numbers, in lanes.

use alloc::boxed::Box;
use alloc::rc::Rc;
use alloc::vec::Vec;
use core::any::Any;

use crate::error::StepError;
use crate::motion::propagator::Propagator;

/// Several bodies that are stepped together, each with the bits that it has alone and its own end.
pub trait Abreast {
    /// Steps every running body `steps` times, as its own [`run_stretches`](Propagator::run_stretches) would.
    fn run(&mut self, steps: u64);

    /// The numbers of a body's state; if it has stopped, those before the step that failed.
    fn state(&self, body: usize) -> Box<[f64]>;

    /// The error that stopped a body, if it has stopped.
    fn error(&self, body: usize) -> Option<&StepError>;
}

/// A propagator whose bodies can be stepped together.
pub trait Joinable: Propagator + Sized + 'static {
    /// The limit of the bodies that are stepped together.
    const MOST: usize;

    /// The bodies of these propagators in these states, at most [`MOST`](Self::MOST); `None` if they can't be stepped together.
    fn join(bodies: &[(&Self, &[f64])]) -> Option<Box<dyn Abreast>>;
}

/// A propagator with a state.
type Body<'a> = (&'a dyn Any, &'a [f64]);

/// The bodies of an [`AnyStepper`](crate::motion::AnyStepper), which are stepped together if their propagators are of one type.
#[derive(Clone)]
pub(super) struct Joint {
    propagator: Rc<dyn Any>,
    pub(super) most: usize,
    join: fn(&[Body<'_>]) -> Option<Box<dyn Abreast>>,
}

impl Joint {
    pub(super) fn of<P: Joinable>(propagator: &Rc<P>) -> Self {
        let join = |bodies: &[Body<'_>]| {
            let typed = bodies.iter().map(|(propagator, state)| Some((propagator.downcast_ref::<P>()?, *state)));
            P::join(&typed.collect::<Option<Vec<_>>>()?)
        };
        Self { propagator: Rc::clone(propagator) as Rc<dyn Any>, most: P::MOST, join }
    }

    pub(super) fn together<'a>(
        bodies: impl Iterator<Item = (&'a Self, &'a [f64])> + Clone,
    ) -> Option<Box<dyn Abreast>> {
        let (first, _) = bodies.clone().next()?;
        (first.join)(&bodies.map(|(joint, state)| (&*joint.propagator, state)).collect::<Vec<_>>())
    }
}
