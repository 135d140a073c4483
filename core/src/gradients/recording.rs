//! Recorded changes of a motion by the stages of a step.

use alloc::vec::Vec;
use core::cell::RefCell;

use crate::groups::{Advected, LieGroup};
use crate::mechanics::{Group, Term};
use crate::motion::{Motion, Summation};
use crate::numbers::zero;

/// One change by a stage of one of the library's plans: a turn, a push, or both.
#[derive(Clone, Copy, Debug)]
#[doc(hidden)]
pub struct Change<G: LieGroup, A> {
    /// The motion before the change.
    pub(crate) before: Motion<G, A>,
    /// The increment `F − I`; zero for a push.
    pub(crate) increment: G::Matrix,
}

/// The type of a scene's changes.
#[doc(hidden)]
pub type ChangeOf<S> = Change<Group<S>, <S as Term>::Advected>;

/// A motion that records each change; its bits are those of [`Motion`] alone.
#[derive(Clone, Copy)]
pub(super) struct Recording<'a, G: LieGroup, A> {
    pub(super) motion: Motion<G, A>,
    pub(super) events: &'a RefCell<Vec<Change<G, A>>>,
}

impl<G: LieGroup, A: Advected<G>> Recording<'_, G, A> {
    #[hot]
    fn note(&self, increment: G::Matrix) {
        self.events.borrow_mut().push(Change { before: self.motion, increment });
    }
}

#[hot]
impl<G: LieGroup, A: Advected<G>> Summation<G, A> for Recording<'_, G, A> {
    const CARRIES: bool = false;

    fn now(&self) -> &Motion<G, A> {
        &self.motion
    }

    fn turn(&mut self, increment: &G::Matrix) {
        self.note(*increment);
        self.motion.turn(increment);
    }

    fn turned(&self, increment: &G::Matrix) -> A {
        self.motion.turned(increment)
    }

    fn push(&mut self, change: &G::Vector) {
        self.note(zero());
        Summation::push(&mut self.motion, change);
    }

    fn turn_and_push(&mut self, increment: &G::Matrix, change: &G::Vector) {
        self.note(*increment);
        self.motion.turn_and_push(increment, change);
    }

    fn proceed(&mut self, increment: &G::Matrix, change: &G::Vector, end: (G::Vector, A)) {
        self.note(*increment);
        self.motion.proceed(increment, change, end);
    }

    fn recount(&mut self, steps: u64) {
        self.motion.recount(steps);
    }

    #[cold]
    fn restore(&mut self, spatial: &A) {
        self.motion.restore(spatial);
    }

    fn replace(&mut self, motion: Motion<G, A>) {
        self.motion = motion;
    }

    fn show(&mut self, motion: Motion<G, A>) {
        self.motion = motion;
    }
}
