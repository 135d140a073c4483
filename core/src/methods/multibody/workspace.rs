//! The memory of a step's intermediate values.
//!
//! Each thread has one, of the size of the largest system that it has stepped: a stepper is shared by threads, and a
//! state has only what continues it. So nothing is allocated after a thread's first step.

use alloc::boxed::Box;
use alloc::vec::Vec;

use nalgebra::{Matrix3, Vector6};

use super::constraint::Place;
use super::couplings::Coefficients;
use super::equations::Equations;
use super::graph::Tree;
use super::{Body, Increment};

/// The intermediate values of a step, of each body.
#[derive(Default)]
pub(super) struct Workspace {
    pub(super) now: Vec<Body>,
    pub(super) next: Vec<Body>,
    pub(super) increments: Vec<Increment>,
    pub(super) places: Vec<Place>,
    pub(super) next_places: Vec<Place>,
    pub(super) momenta: Vec<Vector6<f64>>,
    pub(super) kicks: Vec<Vector6<f64>>,
    /// The sums of the kicks between bodies.
    pub(super) between: Vec<Vector6<f64>>,
    /// The right-hand sides `a`.
    pub(super) a: Vec<Vector6<f64>>,
    pub(super) half: Vec<Vector6<f64>>,
    /// The guess of the half increments.
    pub(super) guess: Vec<Vector6<f64>>,
    pub(super) slow: Vec<Vector6<f64>>,
    pub(super) reactions: Vec<Vector6<f64>>,
    /// Momenta after all changes but the projection.
    pub(super) changed: Vec<Vector6<f64>>,
    pub(super) coefficients: Coefficients,
    pub(super) turns: Vec<Matrix3<f64>>,
    pub(super) equations: Equations,
    /// A state before a run.
    pub(super) before: Vec<f64>,
    /// A state during the stages of a step, and that of one stage.
    pub(super) whole: Vec<f64>,
    pub(super) of_stage: Vec<f64>,
}

impl Workspace {
    /// Makes room for a number of bodies and of coupled pairs.
    pub(super) fn fit(&mut self, bodies: usize, pairs: usize) {
        let space = super::terms::space();
        self.now.resize(bodies, space);
        self.next.resize(bodies, space);
        self.increments.resize(bodies, crate::groups::LieGroup::increment(&space));
        self.places.resize(bodies, Place::SPACE);
        self.next_places.resize(bodies, Place::SPACE);
        for vectors in [
            &mut self.momenta,
            &mut self.kicks,
            &mut self.between,
            &mut self.a,
            &mut self.half,
            &mut self.guess,
            &mut self.slow,
            &mut self.reactions,
            &mut self.changed,
        ] {
            vectors.resize(bodies, Vector6::zeros());
        }
        self.coefficients.fit(bodies, pairs);
        self.turns.resize(bodies, Matrix3::zeros());
    }

    /// Sets the places after the half increments.
    pub(super) fn set_next(&mut self, tree: &Tree) {
        let Self { places, half, next_places, turns, equations, .. } = self;
        equations.set_next(tree, places, half, (next_places, turns));
    }
}

#[cfg(feature = "std")]
std::thread_local! {
    static OF_THREAD: core::cell::Cell<Option<Box<Workspace>>> = const { core::cell::Cell::new(None) };
}

/// Calls a function with the thread's workspace; a call within a call has another one.
pub(super) fn with_workspace<T>(function: impl FnOnce(&mut Workspace) -> T) -> T {
    #[cfg(feature = "std")]
    {
        let mut workspace = OF_THREAD.take().unwrap_or_default();
        let result = function(&mut workspace);
        OF_THREAD.set(Some(workspace));
        result
    }
    #[cfg(not(feature = "std"))]
    function(&mut Box::<Workspace>::default())
}
