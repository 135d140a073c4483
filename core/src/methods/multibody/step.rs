//! The step of a system of bodies.

use nalgebra::Vector6;

use super::constraint::Place;
use super::couplings::Coefficients;
use super::equations::Equations;
use super::forces::JointForces;
use super::newton::Problem;
use super::state::body_at;
use super::stepper::MultibodyStepper;
use super::terms::space;
use super::workspace::{Workspace, with_workspace};
use super::{Body, body_at_place, place};
use crate::error::StepError;
use crate::groups::{CayleyRetraction, LieGroup as _, Retraction};
use crate::motion::StepReport;
use crate::numbers::Coordinates;

/// The number of steps between two projections of attitudes onto the rotations. Internal forces cancel only as far as
/// attitudes are rotations; otherwise the total momentum drifts in proportion to the steps.
const STEPS_BETWEEN_CHECKS: f64 = 64.0;

/// Whether all entries are finite.
fn is_finite(vectors: &[Vector6<f64>]) -> bool {
    vectors.iter().all(Coordinates::is_finite)
}

impl MultibodyStepper {
    /// Makes one step of a slice that is a state; on an error it is unchanged. Adds the joints' forces.
    pub(super) fn step_in(
        &self,
        state: &mut [f64],
        work: &mut Workspace,
        forces: Option<&mut JointForces>,
    ) -> Result<StepReport, StepError> {
        self.step_of_run(state, work, forces, [true; 2])
    }

    /// Makes one step of a run. Between the first and the last the bodies and their momenta are those of the workspace, and only the
    /// memory for the guess is in the slice, which is a state after the last. On an error it isn't.
    pub(super) fn step_of_run(
        &self,
        state: &mut [f64],
        work: &mut Workspace,
        forces: Option<&mut JointForces>,
        [is_first, is_last]: [bool; 2],
    ) -> Result<StepReport, StepError> {
        let (offsets, steps) = (self.offsets, self.offsets.steps(state));
        if self.h == 0.0 {
            offsets.set_steps(state, steps + 1.0);
            return Ok(StepReport::of(0));
        }
        if let Some(stages) = &self.stages {
            return self.composed_step(stages, state, work, forces);
        }
        if is_first {
            work.fit(self.bodies(), self.tree.couplings.len());
            work.equations.fit(self.joints(), &self.tree);
        }
        let is_due = steps % STEPS_BETWEEN_CHECKS == 0.0;
        self.load(state, work, is_first, is_due)?;
        self.kick_before(work);
        if is_first || is_due || self.is_open {
            work.equations.set_before(self.joints(), &self.tree, &work.places);
        }
        let mut problem = Problem::new(self, work);
        let iterations = problem.solve()?;
        let impulse = -2.0 / self.h;
        let mut forces = forces;
        if let Some(forces) = &mut forces {
            self.add_forces(work, false, impulse / self.h, forces);
        }
        self.push_forward(work, impulse);
        if self.is_open {
            // The multipliers of the next step take up what a projection would change.
            for (momentum, change) in work.momenta.iter_mut().zip(&mut work.a) {
                *momentum += core::mem::replace(change, Vector6::zeros());
            }
        }
        if is_last || !self.is_open {
            // The Jacobian was checked along the iteration, but not at its end; the projection checks it there.
            self.project(work).map_err(|(joint, pivot)| StepError::SingularJoint { joint, pivot })?;
        }
        self.check_left_out(&work.next_places)?;
        if let Some(forces) = &mut forces {
            self.add_forces(work, true, -1.0 / self.h, forces);
        }
        if !is_finite(&work.momenta) || !is_finite(&work.half) {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        if is_last {
            offsets.write(state, &work.next, &work.momenta);
            if self.is_open {
                offsets.write_unprojected(state, &work.changed);
            }
        }
        let is_near = |half: &Vector6<f64>| <CayleyRetraction as Retraction<Body>>::is_half_well_near_identity(half);
        offsets.follow(state, &work.half, !work.half.iter().all(is_near));
        offsets.set_steps(state, steps + 1.0);
        Ok(StepReport::of(iterations))
    }

    /// Reads a state, or takes that at the end of the last step of a run. Attitudes are projected onto the rotations if that is due:
    /// before the step, so that joints are closed after it.
    fn load(&self, state: &[f64], work: &mut Workspace, is_first: bool, is_due: bool) -> Result<(), StepError> {
        if is_first {
            for body in 0..self.bodies() {
                work.now[body] = body_at(state, body);
                work.places[body] = place(&work.now[body]);
            }
            for (momentum, entries) in work.momenta.iter_mut().zip(self.offsets.starting(state).chunks_exact(6)) {
                momentum.copy_from_slice(entries);
            }
        } else {
            core::mem::swap(&mut work.now, &mut work.next);
            core::mem::swap(&mut work.places, &mut work.next_places);
        }
        for body in 0..self.bodies() {
            if is_due && let Some((restored, _)) = work.now[body].restored(0.0) {
                work.now[body] = restored;
                work.places[body] = place(&restored);
            }
            work.half[body] = self.offsets.guess(state, body);
        }
        if is_finite(&work.momenta) { Ok(()) } else { Err(StepError::NonFinite { what: "momentum" }) }
    }

    /// The kicks before the step, and the right-hand sides.
    fn kick_before(&self, work: &mut Workspace) {
        let Workspace { now, kicks, between, momenta, a, .. } = work;
        let space = space();
        self.kick(
            kicks,
            between,
            |term, body| term.kick_before([&now[body]]),
            |pair| self.system.pairs[pair].1.kick_before(self.ends(pair, now, &space)),
        );
        for ((a, momentum), kick) in a.iter_mut().zip(&*momenta).zip(&*kicks) {
            *a = momentum + kick;
        }
    }

    /// Moves the bodies by the solution, and their momenta, but for the projection.
    fn push_forward(&self, work: &mut Workspace, impulse: f64) {
        work.set_next(&self.tree);
        work.equations.reactions(&self.tree, &mut work.reactions);
        for body in 0..self.bodies() {
            work.increments[body] = <CayleyRetraction as Retraction<Body>>::increment_of_half(&work.half[body]);
            work.next[body] = body_at_place(&work.next_places[body]);
            work.reactions[body] *= impulse;
        }
        // The changes of the momenta are in the place of the right-hand sides.
        for body in 0..self.bodies() {
            let (kick, of_joints) = (work.kicks[body], work.reactions[body]);
            let turned = Body::adjoint_transpose_increment(&work.increments[body], &(work.a[body] + of_joints));
            work.a[body] = turned + (kick + of_joints);
        }
        let Workspace { next, increments, kicks, between, a, .. } = work;
        let space = space();
        let rest = space.increment();
        self.kick(
            kicks,
            between,
            |term, body| term.kick_after([&increments[body]], [&next[body]]),
            |pair| {
                let (bodies, term) = &self.system.pairs[pair];
                let increments = bodies.map(|body| body.map_or(&rest, |body| &increments[body]));
                term.kick_after(increments, self.ends(pair, next, &space))
            },
        );
        for (change, kick) in a.iter_mut().zip(&*kicks) {
            *change += kick;
        }
    }

    /// Projects the momenta after the changes in `a` onto those whose velocities satisfy the constraints at the next
    /// configuration. If the impulses aren't unique, the joint that is redundant, and its pivot.
    fn project(&self, work: &mut Workspace) -> Result<(), (usize, f64)> {
        let Workspace { next, next_places, momenta, a, coefficients, reactions, equations, changed, .. } = work;
        for body in 0..self.bodies() {
            changed[body] = momenta[body] + a[body];
        }
        self.set_impulses(equations, next, next_places, (changed, coefficients))?;
        equations.reactions(&self.tree, reactions);
        for body in 0..self.bodies() {
            a[body] -= reactions[body];
            momenta[body] += a[body];
        }
        Ok(())
    }

    /// Solves for the impulses of the joints that project these momenta onto those whose velocities satisfy the
    /// constraints, at the least distance in the metric of the inertia.
    pub(super) fn set_impulses(
        &self,
        equations: &mut Equations,
        bodies: &[Body],
        places: &[Place],
        (momenta, coefficients): (&[Vector6<f64>], &mut Coefficients),
    ) -> Result<(), (usize, f64)> {
        self.set_limit(bodies, coefficients);
        for (bias, momentum) in coefficients.vectors.iter_mut().zip(momenta) {
            *bias -= momentum;
        }
        equations.set_velocities(self.joints(), &self.tree, places, coefficients);
        if let Some(redundant) = equations.redundant(&self.tree) {
            return Err(redundant);
        }
        equations.solve(&self.tree, &coefficients.vectors, |_, _| Vector6::zeros());
        Ok(())
    }

    /// Makes one step under a force on each body, `(N m, N)`, in its own axes and in those of space: half of its impulse
    /// at either end of the step. Joints take up the part that would open them; on an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// [`StepError::NonFinite`] for a force that isn't finite or isn't that of all bodies; otherwise the errors of
    /// [`step`](Self::step).
    pub fn step_forced(&self, state: &mut [f64], force: &[Vector6<f64>]) -> Result<StepReport, StepError> {
        self.check(state)?;
        if force.len() != self.bodies() || !force.iter().flat_map(|part| part.iter()).all(|part| part.is_finite()) {
            return Err(StepError::NonFinite { what: "control force" });
        }
        with_workspace(|work| {
            let mut next = core::mem::take(&mut work.before);
            next.clear();
            next.extend_from_slice(state);
            let impulses = || force.iter().map(|force| force * (self.h * 0.5));
            let made = self
                .push_in(&mut next, work, impulses())
                .and_then(|()| self.step_in(&mut next, work, None))
                .and_then(|report| self.push_in(&mut next, work, impulses()).map(|()| report));
            if made.is_ok() {
                state.copy_from_slice(&next);
            }
            work.before = next;
            made
        })
    }

    /// Adds an impulse to the momentum of each body, `(N m s, N s)`, in its own axes and in those of space. Joints take up the part
    /// that would open them; on an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// [`StepError::NonFinite`] for impulses that aren't finite or aren't those of all bodies; [`StepError::SingularJoint`].
    pub fn push(&self, state: &mut [f64], impulses: &[Vector6<f64>]) -> Result<(), StepError> {
        self.check(state)?;
        if impulses.len() != self.bodies() {
            return Err(StepError::NonFinite { what: "impulse" });
        }
        with_workspace(|work| self.push_in(state, work, impulses.iter().copied()))
    }

    /// Adds an impulse to the momentum of each body, but for the part that the joints take up.
    fn push_in(
        &self,
        state: &mut [f64],
        work: &mut Workspace,
        impulses: impl Iterator<Item = Vector6<f64>>,
    ) -> Result<(), StepError> {
        work.fit(self.bodies(), self.tree.couplings.len());
        work.equations.fit(self.joints(), &self.tree);
        for (body, impulse) in impulses.enumerate() {
            work.next[body] = body_at(state, body);
            work.next_places[body] = place(&work.next[body]);
            work.momenta[body] = self.offsets.momentum(state, body);
            work.a[body] = impulse;
        }
        self.project(work).map_err(|(joint, pivot)| StepError::SingularJoint { joint, pivot })?;
        if !is_finite(&work.momenta) {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        self.offsets.write_momenta(state, &work.momenta);
        Ok(())
    }
}
