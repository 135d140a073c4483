//! Initial states of jointed bodies: closed joints, and velocities that satisfy the constraints.

use alloc::boxed::Box;
use alloc::vec::Vec;

use nalgebra::Vector6;

use super::constraint::Place;
use super::equations::{Equations, Widest, gap};
use super::stepper::MultibodyStepper;
use super::{Body, parts, place};
use crate::error::SetupError;
use crate::groups::{CayleyRetraction, LieGroup as _, Retraction};
use crate::motion::check_attitude;
use crate::solving::{LONGEST_DAMPED, MAX_DAMPED_ITERATIONS};

/// The tolerance for gaps at the start, relative to the terms of the functions, and for velocities that open a joint,
/// relative to theirs: twelve printed digits pass.
const PRINTED: f64 = f64::EPSILON * 1e5;
/// The tolerance for gaps in the search for a start: rounding, as after steps.
const CLOSED: f64 = 2.0 * f64::EPSILON;
/// The turn in a step, rad, below which velocities at rest count as rounding: attitudes are a few roundings off, and the search for
/// an accuracy begins a run some roundings beside the start.
const AT_REST: f64 = 256.0 * f64::EPSILON;
/// The longest turn in one update of the search for a start, rad; half coordinates have half of it.
const LONGEST: f64 = 2.0 * LONGEST_DAMPED;
impl MultibodyStepper {
    /// A state from the configurations of all bodies and their velocities, rad/s in the axes of the body and m/s in
    /// those of space.
    ///
    /// # Errors
    ///
    /// [`SetupError::OffConstraint`] for a joint that is open, [`SetupError::OffVelocity`] for velocities that would
    /// open it, and [`SetupError::RedundantJoint`] for a joint that is redundant beside the others, even if only in this
    /// configuration; [`start_nearest`](Self::start_nearest) closes joints. [`SetupError::NotInGroup`] for an attitude
    /// that is no rotation, [`SetupError::Length`] unless there is one of each body, and [`SetupError::NonFinite`] for
    /// numbers that aren't finite.
    pub fn start(&self, attitudes: &[Body], velocities: &[Vector6<f64>]) -> Result<Box<[f64]>, SetupError> {
        check_velocities(velocities, self.bodies())?;
        self.check_attitudes(attitudes)?;
        self.start_with_momentum(attitudes, &self.momenta_of(attitudes, velocities))
    }

    /// A state from the configurations of all bodies and their momenta, kg m²/s in the axes of the body and kg m/s in
    /// those of space.
    ///
    /// # Errors
    ///
    /// The errors of [`start`](Self::start).
    pub fn start_with_momentum(&self, attitudes: &[Body], momenta: &[Vector6<f64>]) -> Result<Box<[f64]>, SetupError> {
        self.check_attitudes(attitudes)?;
        SetupError::check_length("momentum", 6 * momenta.len(), 6 * self.bodies())?;
        if !is_finite(momenta) {
            return Err(SetupError::NonFinite { what: "momentum" });
        }
        self.check_inertias(attitudes)?;
        self.check_coupled_inertia(attitudes)?;
        let mut state = self.offsets.zeros();
        self.offsets.write(&mut state, attitudes, momenta);
        self.begin(&mut state);
        if !state.iter().all(|number| number.is_finite()) {
            return Err(SetupError::NonFinite { what: "velocity of the momentum" });
        }
        self.check_start(attitudes, momenta)?;
        self.check_symmetry(&state)?;
        Ok(state.into())
    }

    /// A state from a configuration near this one with closed joints, by corrections that are least in the metric of the
    /// inertia; its velocities are the nearest in that metric that satisfy the constraints.
    ///
    /// # Errors
    ///
    /// [`SetupError::OffConstraint`] if no such configuration is found, with the least gap of the search;
    /// [`SetupError::RedundantJoint`] if a joint is redundant here or there; otherwise the errors of
    /// [`start`](Self::start).
    pub fn start_nearest(&self, attitudes: &[Body], velocities: &[Vector6<f64>]) -> Result<Box<[f64]>, SetupError> {
        check_velocities(velocities, self.bodies())?;
        self.check_attitudes(attitudes)?;
        let attitudes = self.closed(attitudes)?;
        let mut momenta = self.momenta_of(&attitudes, velocities);
        let places: Vec<_> = attitudes.iter().map(place).collect();
        let mut equations = self.equations();
        let mut coefficients = self.limit(&attitudes);
        let mut reactions = momenta.clone();
        // The second projection removes the rounding errors of the first, for bodies of very different masses.
        for _ in 0..2 {
            self.set_impulses(&mut equations, &attitudes, &places, (&momenta, &mut coefficients))
                .map_err(|(joint, pivot)| SetupError::RedundantJoint { joint, pivot })?;
            equations.reactions(&self.tree, &mut reactions);
            momenta.iter_mut().zip(&reactions).for_each(|(momentum, taken)| *momentum -= taken);
        }
        self.start_with_momentum(&attitudes, &momenta)
    }

    pub(super) fn check_attitudes(&self, attitudes: &[Body]) -> Result<(), SetupError> {
        let all = self.offsets.attitudes();
        SetupError::check_length("attitude", all / self.bodies() * attitudes.len(), all)?;
        attitudes.iter().try_for_each(check_attitude)
    }

    /// Equations whose slopes and matrices aren't set yet.
    fn equations(&self) -> Equations {
        let mut equations = Equations::default();
        equations.fit(self.joints(), &self.tree);
        equations
    }

    /// The equations of velocities at these places.
    pub(super) fn of_velocities(&self, bodies: &[Body], places: &[Place]) -> Equations {
        let mut equations = self.equations();
        equations.set_velocities(self.joints(), &self.tree, places, &self.limit(bodies));
        equations
    }

    /// Checks that joints are closed, that velocities satisfy the constraints, and that no joint is redundant.
    fn check_start(&self, bodies: &[Body], momenta: &[Vector6<f64>]) -> Result<(), SetupError> {
        let places: Vec<_> = bodies.iter().map(place).collect();
        let equations = self.of_velocities(bodies, &places);
        let Widest { joint, by, relative } = Equations::widest_gap(self.joints(), &places, &self.lengths);
        // A NaN fails this test.
        let is_closed = relative <= PRINTED;
        if !is_closed {
            return Err(SetupError::OffConstraint { joint, by });
        }
        self.check_redundance(&equations)?;
        let velocities = self.velocities_of(bodies, momenta);
        let least = if self.h == 0.0 { 0.0 } else { AT_REST / (PRINTED * self.h.abs()) };
        let Widest { joint, by, relative } =
            Equations::widest_parting((self.joints(), &places), &velocities, &self.lengths, least);
        if relative <= PRINTED { Ok(()) } else { Err(SetupError::OffVelocity { joint, by }) }
    }

    /// A configuration with closed joints near this one, by corrections that are least in the metric of the inertia.
    fn closed(&self, attitudes: &[Body]) -> Result<Vec<Body>, SetupError> {
        let (mut bodies, mut last) = (attitudes.to_vec(), f64::INFINITY);
        let still = alloc::vec![Vector6::zeros(); self.bodies()];
        // The joint with the least widest gap so far. An iteration towards an unreachable configuration ends near a
        // singular one.
        let mut nearest = (0, f64::INFINITY);
        for iteration in 0..MAX_DAMPED_ITERATIONS {
            let places: Vec<_> = bodies.iter().map(place).collect();
            let mut equations = self.of_velocities(&bodies, &places);
            let Widest { relative, .. } = Equations::widest_gap(self.joints(), &places, &self.lengths);
            match self.check_redundance(&equations) {
                Err(_) if iteration > 0 && relative > PRINTED => break,
                checked => checked?,
            }
            if relative <= CLOSED || relative <= PRINTED && relative >= last {
                return Ok(bodies);
            }
            let widest = self.largest_gap(&places);
            nearest = if widest.1 < nearest.1 { widest } else { nearest };
            last = relative;
            equations.solve(&self.tree, &still, |joint, _| gap(&self.joints()[joint], &places));
            let updates = &equations.unknowns.bodies;
            let largest = updates.iter().fold(0.0_f64, |most, update| most.max(parts(update).0.norm()));
            let part = if largest > LONGEST { LONGEST / largest } else { 1.0 };
            for (body, update) in bodies.iter_mut().zip(updates) {
                *body = body.advance(&<CayleyRetraction as Retraction<Body>>::increment(&(update * part)));
            }
        }
        let (joint, by) = nearest;
        Err(SetupError::OffConstraint { joint, by })
    }

    fn check_redundance(&self, equations: &Equations) -> Result<(), SetupError> {
        match equations.redundant(&self.tree) {
            Some((joint, pivot)) => Err(SetupError::RedundantJoint { joint, pivot }),
            None => Ok(()),
        }
    }
}

fn is_finite(vectors: &[Vector6<f64>]) -> bool {
    vectors.iter().flat_map(|vector| vector.iter()).all(|part| part.is_finite())
}

/// Checks that these are finite velocities of all bodies.
fn check_velocities(velocities: &[Vector6<f64>], bodies: usize) -> Result<(), SetupError> {
    SetupError::check_length("velocity", 6 * velocities.len(), 6 * bodies)?;
    if is_finite(velocities) { Ok(()) } else { Err(SetupError::NonFinite { what: "velocity" }) }
}
