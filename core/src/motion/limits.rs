//! The right side of the momentum equation, and the error of a step without a solution: the largest solvable step, and the turn.

use alloc::vec::Vec;

use crate::error::StepError;
use crate::groups::LieGroup;
use crate::mechanics::{Effect, Group, Scalar, Vector, estimated_velocity};
use crate::numbers::{Entries as _, largest_lane, real, reported};
use crate::solving::six_digits;
use nalgebra::SimdComplexField as _;

/// The right-hand side `a = μ + kick_before(w)`.
#[hot]
pub(super) fn kicked<S: Effect>(constants: &S::Constants, momentum: &Vector<S>, w: &S::Advected) -> Vector<S> {
    if const { S::FACTS.parts.kick_before } { *momentum + S::kick_before(constants, w) } else { *momentum }
}

/// The error that names the largest step, and the turn that the whole step would take.
pub(crate) fn beyond_solvable<S: Effect>(
    scene: &S,
    h: Scalar<S>,
    momentum: &Vector<S>,
    advected: &S::Advected,
    largest: Scalar<S>,
) -> StepError {
    // The turn is estimated with the kick at the beginning of the step.
    let kicked = kicked::<S>(&scene.constants(h), momentum, advected);
    let (turn, body) = farthest::<Group<S>>(&(estimated_velocity(scene, &kicked, advected) * h));
    StepError::BeyondSolvable { step: reported(h), largest: six_digits(reported(largest)), turn, body }
}

/// The largest turn of a body, over all lanes, and for a system the number of that body. Translations are ignored: a
/// metre isn't a radian.
fn farthest<G: LieGroup>(change: &G::Vector) -> (f64, Option<usize>) {
    let mut squares = Vec::new();
    change.each(&mut |component| squares.push(component * component));
    let turns = G::turning_components();
    let of_each = G::DIMENSION / G::BODIES.max(1);
    let mut farthest = (0.0, None);
    for body in 0..G::BODIES {
        let components = (body * of_each..(body + 1) * of_each).filter(|&component| turns[component]);
        let square = components.fold(real::<G::Scalar>(0.0), |sum, component| sum + squares[component]);
        let turn = largest_lane(square.simd_sqrt());
        if turn > farthest.0 {
            farthest = (turn, (G::BODIES > 1).then_some(body));
        }
    }
    farthest
}
