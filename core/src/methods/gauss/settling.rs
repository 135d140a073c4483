//! Convergence test of a fixed-point iteration.

/// The decision after an iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// The iteration goes on: the unknowns aren't known to rounding yet.
    Further,
    /// One more iteration follows, whose change is rounding.
    Once,
    /// The iteration ends: the last change was rounding.
    Nothing,
}

/// The squared relative changes of the last two iterations; NaN before there are any.
#[derive(Clone, Copy, Debug)]
pub struct Changes {
    before: f64,
    earlier: f64,
}

/// Relative changes up to this size may be rounding.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// This limit suffices if each iteration gains at least a factor of two, as it does up to the edge of convergence.
pub(super) const MOST_ITERATIONS: u32 = 60;

impl Changes {
    /// The most iterations of a step.
    pub const MOST: u32 = MOST_ITERATIONS;

    /// Near an equilibrium, attitude and momentum change alternately if some unknowns are known much better than
    /// others, so three changes are needed for an estimate of the rate of convergence.
    #[must_use]
    pub const fn none() -> Self {
        Self { before: f64::NAN, earlier: f64::NAN }
    }

    /// Judges the latest change of all unknowns, and that of the attitude alone.
    ///
    /// Convergence is nearly linear, so the ratios of two successive pairs predict whether the next change is rounding.
    /// A small change that is no smaller than the one before is rounding. Near an equilibrium the momentum is smaller
    /// than the terms of the torque, whose rounding then is a large part of the momentum. There the change counts as
    /// rounding if the attitude's change does.
    #[inline(always)]
    pub fn judge(&mut self, change: f64, of_attitude: f64) -> Next {
        let Self { before, earlier } = *self;
        (self.before, self.earlier) = (change, before);
        let (rounding, epsilon) = (ROUNDING * ROUNDING, f64::EPSILON * f64::EPSILON);
        if change <= rounding && change >= before || change >= earlier && of_attitude <= rounding {
            Next::Nothing
        } else if change * change <= epsilon * before && change * before <= epsilon * earlier {
            Next::Once
        } else {
            Next::Further
        }
    }
}
