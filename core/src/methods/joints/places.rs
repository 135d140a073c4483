//! The places of bodies, and the constraints' values and derivatives at them.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

roots!();

use super::graph::PlacedJoint;
use super::{Constraint, Place, Slope};
use crate::groups::{R3, SO3};

/// The two derivative maps at one end of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ends<const K: usize> {
    /// The matrix `Eᵀ` from multipliers to the body's momentum, torque in its axes first.
    pub(super) before: SMatrix<f64, 6, K>,
    /// The matrix `C` from the body's unknowns to the functions.
    pub(super) after: SMatrix<f64, K, 6>,
}

impl<const K: usize> Ends<K> {
    /// The squared rates of a function per unit of the body's turn, and of its shift.
    fn rates(&self, row: usize) -> [f64; 2] {
        [0, 3].map(|first| self.before.fixed_view::<3, 1>(first, row).norm_squared())
    }

    /// The square of the longest lever arm of the functions, m²; zero if they compare only directions.
    pub(super) fn squared_arm(&self) -> f64 {
        (0..K).fold(0.0, |longest: f64, row| {
            let [turns, shifts] = self.rates(row);
            if shifts > 0.0 { longest.max(turns / shifts) } else { longest }
        })
    }

    /// The size of each function's terms for a `turn` in rad or rad/s and a `shift` in m or m/s; the shift counts at
    /// least as the lever arm times the turn.
    pub(super) fn sizes(&self, turn: f64, shift: f64) -> SVector<f64, K> {
        let shift = shift.max(self.squared_arm().sqrt() * turn);
        SVector::from_fn(|row, _| {
            let [turns, shifts] = self.rates(row).map(f64::sqrt);
            turns * turn + shifts * shift
        })
    }
}

/// The slopes at both ends. For a tree's joint: the body, then its parent. For one that closes a loop: the body below,
/// then the body above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slopes<const K: usize>(pub(super) [Ends<K>; 2]);

impl<const K: usize> Slopes<K> {
    pub(super) fn new() -> Self {
        Self([Ends { before: SMatrix::zeros(), after: SMatrix::zeros() }; 2])
    }
}

/// The places of all bodies.
pub(super) struct Places<const N: usize>(pub(super) [Place; N]);

impl<const N: usize> Places<N> {
    pub(super) fn of(bodies: &[(SO3, R3); N]) -> Self {
        Self(bodies.map(|(attitude, place)| Place { attitude: *attitude.as_matrix(), position: place.translation() }))
    }

    #[hot]
    fn get(&self, body: Option<usize>) -> &Place {
        body.map_or(&Place::SPACE, |body| &self.0[body])
    }

    /// The functions of a joint.
    pub(super) fn gap<C: Constraint<K>, const K: usize>(&self, joined: &PlacedJoint<C>) -> SVector<f64, K> {
        joined.joint.gap(self.get(joined.above), &self.0[joined.below])
    }

    /// The derivatives of the functions, by the body below first.
    #[hot]
    pub(super) fn slope<C: Constraint<K>, const K: usize>(&self, joined: &PlacedJoint<C>) -> [Slope<K>; 2] {
        let [above, below] = joined.joint.slope(self.get(joined.above), &self.0[joined.below]);
        [below, above]
    }
}

/// The matrix `Eᵀ` of a body with this attitude.
#[hot]
pub(super) fn before<const K: usize>(slope: &Slope<K>, attitude: &Matrix3<f64>) -> SMatrix<f64, 6, K> {
    let mut before = SMatrix::<f64, 6, K>::zeros();
    before.fixed_rows_mut::<3>(0).copy_from(&(slope.turn * attitude).transpose());
    before.fixed_rows_mut::<3>(3).copy_from(&slope.shift.transpose());
    before
}

/// The matrix `C` of a body; `turn` maps its unknowns to a rotation in the axes of space, and the shift is unchanged.
#[hot]
pub(super) fn after<const K: usize>(slope: &Slope<K>, turn: &Matrix3<f64>) -> SMatrix<f64, K, 6> {
    let mut after = SMatrix::<f64, K, 6>::zeros();
    after.fixed_columns_mut::<3>(0).copy_from(&(slope.turn * turn));
    after.fixed_columns_mut::<3>(3).copy_from(&slope.shift);
    after
}

/// The turn and the shift in the components of a body.
#[hot]
pub(super) fn parts(components: &nalgebra::Vector6<f64>) -> (Vector3<f64>, Vector3<f64>) {
    (components.fixed_rows::<3>(0).into_owned(), components.fixed_rows::<3>(3).into_owned())
}
