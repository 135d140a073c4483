//! Joints that hold a point of one body at a point of another: balls, and with functions of attitudes pins and others.

use nalgebra::{Vector3, Vector6};

use super::constraint::Place;

/// The parameters of a joint whose first three functions are `x_b + R_b ρ_b − x_a − R_a ρ_a`, and the others, if there are any,
/// cosines `R_a e · R_b n`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PointJoint {
    /// The points `ρ_a` and `ρ_b`, m.
    pub(super) points: [Vector3<f64>; 2],
    /// The directions `e` and `n` of each cosine.
    pub(super) cosines: [[Vector3<f64>; 2]; 3],
    /// The number of cosines.
    pub(super) count: usize,
}

impl PointJoint {
    /// The functions at these places.
    pub(super) fn gap(&self, above: &Place, below: &Place) -> Vector6<f64> {
        let mut gap = self.cosines(above, below);
        gap.fixed_rows_mut::<3>(0).copy_from(&(below.of(&self.points[1]) - above.of(&self.points[0])));
        gap
    }

    /// The functions of attitudes at these places, after zeros.
    pub(super) fn cosines(&self, above: &Place, below: &Place) -> Vector6<f64> {
        let mut gap = Vector6::zeros();
        for (value, [e, n]) in gap.as_mut_slice()[3..].iter_mut().zip(&self.cosines[..self.count]) {
            *value = (above.attitude * e).dot(&(below.attitude * n));
        }
        gap
    }
}
