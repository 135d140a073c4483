//! Two bodies whose terms are placed one by one, in either order, have the stages of one declaration for both.

use liestep::groups::{LieGroup, Retraction};
use liestep::laws::samples::Random;
use liestep::mechanics::{Effect, On, Sum, Term};
use liestep::numbers::Bodies;
use nalgebra::DVector;

use super::numbers::numbers;
use super::{System, Vector};

/// Residual, Jacobian times `y` and the kick before the step, at half the coordinates `y` and a right side.
fn stages<E: Effect<Scalar = f64>>(effect: &E, right_side: &Vector<E>, half: &Vector<E>) -> [DVector<f64>; 3] {
    let (constants, w) = (effect.constants(0.05), effect.advected());
    let terms = E::step_terms(&constants, right_side, &w);
    let (residual, jacobian) = E::newton_system(&constants, &terms, half);
    [residual, jacobian * *half, E::kick_before(&constants, &w)].map(|of| numbers(&of))
}

/// The stages of a sum of two bodies are those of the bodies, each with the right side of its own momentum equation.
pub fn assert_placed<L: System + Clone>(l: &L, seed: u64)
where
    L::Retraction: Retraction<[<L as Term>::Group; 2]>,
{
    let mut random = Random::new(seed);
    let right_side = [(); 2].map(|()| random.sample::<Vector<L>>());
    let half = [(); 2].map(|()| random.sample::<Vector<L>>() * 0.25);
    let alone = [0, 1].map(|body| stages(l, &right_side[body], &half[body]));
    let (first, second) = (On::<0, 2>::of([l.clone()]), On::<1, 2>::of([l.clone()]));
    let (right_side, half) = (Bodies(right_side), Bodies(half));
    for placed in [
        stages(&Sum::new(first.clone(), second.clone()), &right_side, &half),
        stages(&Sum::new(second, first), &right_side, &half),
    ] {
        for (stage, found) in placed.iter().enumerate() {
            let (top, bottom) =
                (found.rows(0, L::Group::DIMENSION), found.rows(L::Group::DIMENSION, L::Group::DIMENSION));
            let [upper, lower] = [&alone[0][stage], &alone[1][stage]];
            let off = (top - upper).amax().max((bottom - lower).amax());
            assert!(off <= 1e-14 * (upper.amax() + lower.amax()), "stage {stage} of two bodies is off by {off:e}");
        }
    }
}
