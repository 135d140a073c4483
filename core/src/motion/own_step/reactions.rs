//! The end of a step with constraints on velocities: its reactions.

use alloc::vec::Vec;

use super::OwnStep;
use crate::groups::LieGroup;
use crate::mechanics::{Effect, Group, Limit, Vector, normals, pattern};
use crate::motion::increment::Increment;
use crate::motion::limits::kicked;
use crate::motion::summation::{Motion, Summation};
use crate::numbers::{Coordinates as _, real};
use crate::solving::{Root, newton_residual, step_terms};
use nalgebra::SimdComplexField as _;

impl<S: Effect> OwnStep<S> {
    /// The increment for a solution of the momentum equation with its constraints.
    ///
    /// The reactions before the step are the part of `U − a` along the constraints' covectors. Those after it take the
    /// momentum to a velocity that satisfies the constraints; the next step's would do it otherwise, so they change no
    /// position.
    pub(super) fn moved_with_reactions<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &M,
        root: &Root<Group<S>>,
    ) -> Increment<S> {
        let Root { half, increment, iterations, far } = *root;
        let Motion { momentum, advected, .. } = motion.now();
        let mut a = kicked::<S>(&self.constants, momentum, advected);
        let terms = step_terms::<S>(&self.constants, &a, advected);
        let free = newton_residual::<S>(&self.constants, &terms, &half);
        let raised = (half.dot(&half) + real(1.0)).simd_powi(S::FACTS.denominators.cast_signed());
        let factor = real::<S::Scalar>(2.0) / self.h / raised;
        for normal in normals(scene, advected) {
            a = a + normal.across * (factor * (normal.across.dot(&free) / normal.square));
        }
        let next = motion.turned(&increment);
        let mut change = Group::<S>::adjoint_transpose_increment(&increment, &a) + (a - *momentum);
        if const { S::FACTS.parts.kick_after } {
            change = change + S::kick_after(&self.constants, &increment, &next);
        }
        change = change + reactions(scene, &(*momentum + change), &next);
        let momentum = *momentum + change;
        Increment { coordinates: half + half, increment, momentum, advected: next, iterations, change, half, far }
    }
}

/// The impulses that take a momentum to a velocity which satisfies the constraints.
fn reactions<S: Effect>(scene: &S, momentum: &Vector<S>, w: &S::Advected) -> Vector<S> {
    let Limit { hessian, momentum: bias, .. } = scene.limit(None, w);
    let (factors, det) = Vector::<S>::factorise_with(&hessian, pattern::<S>());
    let solve = |right: &Vector<S>| Vector::<S>::solve_again_with(&factors, det, pattern::<S>(), right);
    let (mut velocity, mut sum) = (solve(&(*momentum - bias)), Vector::<S>::zero());
    // The covectors are made conjugate with respect to the inverse inertia, so that each impulse leaves the others.
    let mut conjugate: Vec<[Vector<S>; 2]> = Vec::new();
    for normal in normals(scene, w) {
        let (mut covector, mut along) = (*normal.covector(), solve(normal.covector()));
        for [before, of_before] in &conjugate {
            let share = -(covector.dot(of_before) / before.dot(of_before));
            covector = covector + *before * share;
            along = along + *of_before * share;
        }
        let impulse = -(covector.dot(&velocity) / covector.dot(&along));
        sum = sum + covector * impulse;
        velocity = velocity + along * impulse;
        conjugate.push([covector, along]);
    }
    sum
}
