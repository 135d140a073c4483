//! P2, the part about Casimirs: what moves on a coadjoint orbit of the semidirect product keeps its momentum along all
//! symmetries of the spatial parameters, and the parameters stay on the orbit of the group.
//!
//! `η` is a symmetry of the spatial value `a_0` where `η · a_0 = 0`. The momentum map of these, `⟨Ad*_{g⁻¹} μ, η⟩`, is
//! exact for every `l_d` (Noether). On SO(3) with one vector that is `μ·w`; where nothing is advected it is all of the
//! spatial momentum.

use liestep::groups::{Advected as _, LieGroup as _};
use liestep::laws::samples::derivative;
use liestep::motion::DiscreteLiePoisson;
use nalgebra::{DMatrix, DVector, SVector};

use super::numbers::Numbers;
use super::{System, step, turn};

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
    flow: &DiscreteLiePoisson<L>,
    (mut attitude, mut momentum): (L::Group, SVector<f64, D>),
    steps: u32,
) -> (f64, f64) {
    let lagrangian = flow.scene();
    let symmetries = symmetries::<L, N, D>(lagrangian);
    let mut w = lagrangian.advected().seen_from(&attitude);
    let in_space = |attitude: &L::Group, momentum: &SVector<f64, D>| attitude.inverse().adjoint_transpose(momentum);
    let start = in_space(&attitude, &momentum);
    let (mut change, mut missed) = (0.0_f64, 0.0_f64);
    for _ in 0..steps {
        let after = step(flow, &momentum, &w);
        (momentum, w) = (after.momentum, after.advected);
        attitude = attitude.advance(&after.increment);
        let size = momentum.norm() * attitude.matrix().norm() * attitude.inverse().matrix().norm();
        for symmetry in &symmetries {
            change = change.max((in_space(&attitude, &momentum) - start).dot(symmetry).abs() / size);
        }
        let seen = DVector::from_vec(lagrangian.advected().seen_from(&attitude).numbers());
        missed = missed.max((DVector::from_vec(w.numbers()) - &seen).norm() / (1.0 + seen.norm()));
    }
    (change, missed)
}
