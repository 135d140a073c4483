//! Constraints of any number of functions up to six, as values of any type.

use alloc::sync::Arc;
use alloc::vec::Vec;
use core::any::Any;

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::constraint::{Constraint, Place};
use super::joint::Joint;
use super::point_joint::PointJoint;
use crate::error::SetupError;

/// The functions of a joint. Vectors have zeros after them, and matrices unused columns.
pub(super) trait Functions: Send + Sync {
    fn validate(&self) -> Result<(), SetupError>;

    fn name(&self) -> &'static str;

    /// The number of functions.
    fn rows(&self) -> usize;

    fn gap(&self, above: &Place, below: &Place) -> Vector6<f64>;

    /// The point of the body below about which the torque counts, in its axes, m.
    fn point(&self) -> Vector3<f64>;

    /// The joint as one that holds points, if it is one.
    fn of_points(&self) -> Option<PointJoint> {
        None
    }

    /// The gap by all functions of a joint some of which aren't imposed, as the other joints imply them; `None` if all are.
    fn gap_of_all(&self, above: &Place, below: &Place) -> Option<Vector6<f64>> {
        let _ = (above, below);
        None
    }

    /// The derivatives of the functions, one a column, by the unknowns of the body above and of that below. The maps
    /// `turns` take an unknown to a rotation in the axes of space; an end without a map isn't set.
    fn slopes(&self, places: [&Place; 2], turns: [Option<&Matrix3<f64>>; 2], columns: [&mut Matrix6<f64>; 2]);

    fn describe(&self, visit: &mut dyn FnMut(&'static str, f64));
}

/// A constraint of `K` functions.
pub(super) struct ConstraintFunctions<C, const K: usize>(pub(super) C);

impl<C: Constraint<K>, const K: usize> Functions for ConstraintFunctions<C, K> {
    fn validate(&self) -> Result<(), SetupError> {
        self.0.validate()
    }

    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn rows(&self) -> usize {
        self.0.functions().min(K)
    }

    fn point(&self) -> Vector3<f64> {
        self.0.point()
    }

    fn of_points(&self) -> Option<PointJoint> {
        (&self.0 as &dyn Any).downcast_ref::<Joint>().and_then(Joint::of_points)
    }

    fn gap(&self, above: &Place, below: &Place) -> Vector6<f64> {
        let mut all = Vector6::zeros();
        all.rows_mut(0, K).copy_from(&self.0.gap(above, below));
        all
    }

    fn slopes(&self, [above, below]: [&Place; 2], turns: [Option<&Matrix3<f64>>; 2], columns: [&mut Matrix6<f64>; 2]) {
        let slopes = self.0.slope(above, below);
        for ((slope, turn), columns) in slopes.iter().zip(turns).zip(columns) {
            let Some(turn) = turn else { continue };
            for row in 0..self.rows() {
                let mut column = columns.column_mut(row);
                let turned = slope.turn.row(row) * turn;
                for k in 0..3 {
                    column[k] = turned[k];
                    column[3 + k] = slope.shift[(row, k)];
                }
            }
        }
    }

    fn describe(&self, visit: &mut dyn FnMut(&'static str, f64)) {
        self.0.describe(visit);
    }
}

/// A part of the functions of a joint.
pub(super) struct Part {
    pub(super) all: Arc<dyn Functions>,
    /// The numbers of the functions that are imposed, in their order.
    pub(super) rows: Vec<usize>,
}

impl Functions for Part {
    fn validate(&self) -> Result<(), SetupError> {
        self.all.validate()
    }

    fn name(&self) -> &'static str {
        self.all.name()
    }

    fn rows(&self) -> usize {
        self.rows.len()
    }

    fn point(&self) -> Vector3<f64> {
        self.all.point()
    }

    fn gap(&self, above: &Place, below: &Place) -> Vector6<f64> {
        let all = self.all.gap(above, below);
        Vector6::from_fn(|row, _| self.rows.get(row).map_or(0.0, |&row| all[row]))
    }

    fn gap_of_all(&self, above: &Place, below: &Place) -> Option<Vector6<f64>> {
        Some(self.all.gap(above, below))
    }

    fn slopes(&self, places: [&Place; 2], turns: [Option<&Matrix3<f64>>; 2], [above, below]: [&mut Matrix6<f64>; 2]) {
        self.all.slopes(places, turns, [&mut *above, &mut *below]);
        for columns in [above, below] {
            for (to, &from) in self.rows.iter().enumerate().filter(|(to, from)| to != *from) {
                let column = columns.column(from).into_owned();
                columns.set_column(to, &column);
            }
        }
    }

    fn describe(&self, visit: &mut dyn FnMut(&'static str, f64)) {
        self.all.describe(visit);
        #[allow(clippy::cast_precision_loss)] // a number below six
        self.rows.iter().for_each(|&row| visit("imposed", row as f64));
    }
}
