//! The derivatives of a joint's functions at one of its ends.

use nalgebra::{Matrix6, Vector6};

roots!();

/// The two derivative maps at one end of a joint, a column for each of its functions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ends {
    /// The matrix `Eᵀ` from multipliers to the body's momentum, torque in its axes first.
    pub(super) before: Matrix6<f64>,
    /// The matrix `Cᵀ`, the transpose of the map from the body's unknowns to the functions.
    pub(super) after: Matrix6<f64>,
}

impl Ends {
    pub(super) const ZERO: Self = Self {
        before: Matrix6::from_array_storage(nalgebra::ArrayStorage([[0.0; 6]; 6])),
        after: Matrix6::from_array_storage(nalgebra::ArrayStorage([[0.0; 6]; 6])),
    };

    /// The squared rates of a function per unit of the body's turn, and of its shift.
    fn rates(&self, row: usize) -> [f64; 2] {
        [0, 3].map(|first| self.before.fixed_view::<3, 1>(first, row).norm_squared())
    }

    /// The square of the longest lever arm of the first `rows` functions, m²; zero if they compare only directions.
    pub(super) fn squared_arm(&self, rows: usize) -> f64 {
        (0..rows).fold(0.0, |longest: f64, row| {
            let [turns, shifts] = self.rates(row);
            if shifts > 0.0 { longest.max(turns / shifts) } else { longest }
        })
    }

    /// The size of each function's terms for a `turn` in rad or rad/s and a `shift` in m or m/s; the shift counts at
    /// least as the lever arm times the turn.
    pub(super) fn sizes(&self, turn: f64, shift: f64) -> Vector6<f64> {
        let shift = shift.max(self.squared_arm(6).sqrt() * turn);
        Vector6::from_fn(|row, _| {
            let [turns, shifts] = self.rates(row).map(f64::sqrt);
            turns * turn + shifts * shift
        })
    }

    /// The momentum `Eᵀ p` of these multipliers.
    pub(super) fn momentum(&self, multipliers: &Vector6<f64>) -> Vector6<f64> {
        self.before * multipliers
    }
}
