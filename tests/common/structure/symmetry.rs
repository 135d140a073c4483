//! P2, the part about Casimirs: a motion on a coadjoint orbit of the semidirect product conserves its momentum along
//! all symmetries of the spatial parameters, and the parameters stay on the orbit of the group.
//!
//! `η` is a symmetry of the spatial value `a_0` if `η · a_0 = 0`. The momentum map of these, `⟨Ad*_{g⁻¹} μ, η⟩`, is
//! exact for every `l_d` (Noether). On SO(3) with one vector it is `μ·w`; without advected parameters it is the whole
//! spatial momentum.

use liestep::groups::{Advected as _, LieGroup as _};
use liestep::laws::samples::derivative;
use liestep::motion::DiscreteLiePoisson;
use liestep::numbers::Coordinates as _;
use nalgebra::DMatrix;

use super::numbers::{from_numbers, numbers};
use super::{Group as _, System, Vector, norm, step};

/// The error of six-point differences of numbers near one.
const DIFFERENCES: f64 = 1e-11;

/// An orthonormal basis of the symmetries of the spatial parameters.
pub fn symmetries<L: System>(lagrangian: &L) -> Vec<Vector<L>> {
    let spatial = lagrangian.advected();
    let (count, dimension) = (numbers(&spatial).len(), L::Group::DIMENSION);
    // Rows of zeros are appended, so that the decomposition contains all directions of the algebra.
    let mut action = DMatrix::zeros(count.max(dimension), dimension);
    for k in 0..dimension {
        let moved = derivative(|s| numbers(&spatial.seen_from(&L::Group::turn(k, -s))));
        action.view_mut((0, k), (count, 1)).copy_from(&moved);
    }
    let allowed = DIFFERENCES * (1.0 + action.norm());
    let decomposition = action.svd(false, true);
    let directions = decomposition.v_t.expect("asked for");
    let values = decomposition.singular_values.iter().zip(directions.row_iter());
    values.filter(|(value, _)| **value < allowed).map(|(_, row)| from_numbers(row.iter().copied())).collect()
}

/// The largest change over a motion of a momentum along a symmetry, and of a parameter from its value by the attitude.
///
/// Both are relative to the scale of their rounding errors.
pub fn drift<L: System>(
    flow: &DiscreteLiePoisson<L>,
    (mut attitude, mut momentum): (L::Group, Vector<L>),
    steps: u32,
) -> (f64, f64) {
    let lagrangian = flow.scene();
    let symmetries = symmetries(lagrangian);
    let mut w = lagrangian.advected().seen_from(&attitude);
    let in_space = |attitude: &L::Group, momentum: &Vector<L>| attitude.inverse().adjoint_transpose(momentum);
    let start = in_space(&attitude, &momentum);
    let (mut change, mut missed) = (0.0_f64, 0.0_f64);
    for _ in 0..steps {
        let after = step(flow, &momentum, &w);
        (momentum, w) = (after.momentum, after.advected);
        attitude = attitude.advance(&after.increment);
        let size = norm(&momentum) * numbers(&attitude.matrix()).norm() * numbers(&attitude.inverse().matrix()).norm();
        for symmetry in &symmetries {
            change = change.max((in_space(&attitude, &momentum) - start).dot(symmetry).abs() / size);
        }
        let seen = numbers(&lagrangian.advected().seen_from(&attitude));
        missed = missed.max((numbers(&w) - &seen).norm() / (1.0 + seen.norm()));
    }
    (change, missed)
}
