//! Constraints of any number of functions up to six, as values of any type.

use nalgebra::{Matrix3, Matrix6, Vector6};

use super::constraint::{Constraint, Place};
use crate::error::SetupError;

/// The functions of a joint. Vectors have zeros after them, and matrices unused columns.
pub(super) trait Functions: Send + Sync {
    fn validate(&self) -> Result<(), SetupError>;

    fn name(&self) -> &'static str;

    /// The number of functions.
    fn rows(&self) -> usize;

    fn gap(&self, above: &Place, below: &Place) -> Vector6<f64>;

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
        K
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
            let turned = slope.turn * turn;
            for row in 0..K {
                let mut column = columns.column_mut(row);
                for k in 0..3 {
                    column[k] = turned[(row, k)];
                    column[3 + k] = slope.shift[(row, k)];
                }
            }
        }
    }

    fn describe(&self, visit: &mut dyn FnMut(&'static str, f64)) {
        self.0.describe(visit);
    }
}
