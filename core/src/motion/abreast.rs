//! Bodies of steppers whose states are numbers, in lanes.

use alloc::boxed::Box;
use alloc::rc::Rc;
use alloc::vec::Vec;
use core::any::Any;

use crate::error::StepError;

/// Several bodies that are stepped together, each with the bits that it has alone and its own end.
pub trait Abreast {
    /// Steps every running body `steps` times, as its own [`run_stretches`](crate::motion::Propagator::run_stretches) would.
    fn run(&mut self, steps: u64);

    /// The numbers of a body's state; if it has stopped, those before the step that failed.
    fn state(&self, body: usize) -> Box<[f64]>;

    /// The error that stopped a body, if it has stopped.
    fn error(&self, body: usize) -> Option<&StepError>;
}

/// The bodies of these propagators in these states; `None` if they can't be stepped together.
pub type Together<P> = fn(&[(&P, &[f64])]) -> Option<Box<dyn Abreast>>;

/// The bodies of an [`AnyStepper`](crate::motion::AnyStepper), which are stepped together if their propagators are of one type.
#[derive(Clone)]
pub(super) struct Joint {
    propagator: Rc<dyn Any>,
    pub(super) most: usize,
    join: Rc<Join>,
}

/// The bodies of propagators in their states, if these are of the type of the first.
type Join = dyn Fn(&[(&dyn Any, &[f64])]) -> Option<Box<dyn Abreast>>;

impl Joint {
    pub(super) fn of<P: 'static>(propagator: &Rc<P>, most: usize, together: Together<P>) -> Self {
        let join = move |bodies: &[(&dyn Any, &[f64])]| {
            let typed = bodies.iter().map(|(propagator, state)| Some((propagator.downcast_ref()?, *state)));
            together(&typed.collect::<Option<Vec<_>>>()?)
        };
        Self { propagator: Rc::clone(propagator) as Rc<dyn Any>, most, join: Rc::new(join) }
    }

    pub(super) fn together<'a>(
        bodies: impl Iterator<Item = (&'a Self, &'a [f64])> + Clone,
    ) -> Option<Box<dyn Abreast>> {
        let (first, _) = bodies.clone().next()?;
        (first.join)(&bodies.map(|(joint, state)| (&*joint.propagator, state)).collect::<Vec<_>>())
    }
}
