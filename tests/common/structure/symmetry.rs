//! P2, the part about Casimirs: what moves on a coadjoint orbit of the semidirect product keeps its momentum along all
//! symmetries of the spatial parameters, and the parameters stay on the orbit of the group.
//!
//! `η` is a symmetry of the spatial value `a_0` where `η · a_0 = 0`. The momentum map of these, `⟨Ad*_{g⁻¹} μ, η⟩`, is
//! exact for every `l_d` (Noether). On SO(3) with one vector that is `μ·w`; where nothing is advected it is all of the
//! spatial momentum.

use liestep::{Advected as _, LieGroup as _, State, Stepper};
use nalgebra::{DMatrix, DVector, SVector};

use super::numbers::Numbers;
use super::{System, turn};
use crate::common::measure::derivative;

/// What the six-point differences leave of numbers near one.
const DIFFERENCES: f64 = 1e-11;

/// An orthonormal basis of the algebra elements that leave the spatial parameters as they are.
pub fn symmetries<L: System<N, D>, const N: usize, const D: usize>(lagrangian: &L) -> Vec<SVector<f64, D>> {
    let spatial = lagrangian.advected();
    let count = spatial.numbers().len();
    // Rows of zeros, so that the decomposition has all directions of the algebra.
    let mut action = DMatrix::zeros(count.max(D), D);
    for k in 0..D {
        let moved = derivative(|s| DVector::from_vec(spatial.seen_from(&turn::<L, N, D>(k, -s)).numbers()));
        action.view_mut((0, k), (count, 1)).copy_from(&moved);
    }
    let allowed = DIFFERENCES * (1.0 + action.norm());
    let decomposition = action.svd(false, true);
    let directions = decomposition.v_t.expect("asked for");
    let values = decomposition.singular_values.iter().zip(directions.row_iter());
    values.filter(|(value, _)| **value < allowed).map(|(_, row)| SVector::from_fn(|k, _| row[k])).collect()
}

/// The largest change of a momentum along a symmetry, and of a parameter from what the attitude sees, over a motion.
///
/// Both are relative to the sizes that rounding is relative to.
pub fn drift<L: System<N, D>, const N: usize, const D: usize>(
    stepper: &Stepper<L>,
    mut state: State<L::Group, L::Advected>,
    steps: u32,
) -> (f64, f64) {
    let symmetries = symmetries::<L, N, D>(stepper.lagrangian());
    let spatial = state.spatial_momentum();
    let (mut momentum, mut parameters) = (0.0_f64, 0.0_f64);
    for _ in 0..steps {
        stepper.step(&mut state).unwrap();
        let inverse = state.attitude().inverse().matrix();
        let size = state.momentum().norm() * state.attitude().matrix().norm() * inverse.norm();
        for symmetry in &symmetries {
            momentum = momentum.max((state.spatial_momentum() - spatial).dot(symmetry).abs() / size);
        }
        let seen = stepper.lagrangian().advected().seen_from(&state.attitude());
        let (seen, carried) = (DVector::from_vec(seen.numbers()), DVector::from_vec(state.advected().numbers()));
        parameters = parameters.max((&carried - &seen).norm() / (1.0 + seen.norm()));
    }
    (momentum, parameters)
}
