//! When a fixed-point iteration has settled.

/// What an iteration is to do after a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// The unknowns aren't known to rounding yet.
    Further,
    /// The next change is rounding, and is still made.
    Once,
    /// What changes is rounding.
    Nothing,
}

/// The changes of the last two iterations, relative to the unknowns and squared; NaN where there was none.
#[derive(Clone, Copy, Debug)]
pub(super) struct Changes {
    before: f64,
    earlier: f64,
}

/// Changes as small as these, relative to the unknowns, may be rounding.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Where each iteration takes at least a factor of two, which is at the edge of convergence, they are enough.
pub(super) const MOST_ITERATIONS: u32 = 60;

impl Changes {
    /// Near an equilibrium attitude and momentum change in alternation where some unknowns are known much better than
    /// others, so that it takes three changes to see how they fall.
    pub(super) const fn none() -> Self {
        Self { before: f64::NAN, earlier: f64::NAN }
    }

    /// After a change, and that of the attitude alone.
    ///
    /// Changes fall by nearly the same factor each time, so that two factors tell whether the next change is rounding.
    /// A change that doesn't fall any more is rounding where it is small. Near an equilibrium the momentum is smaller than
    /// the terms of the torque, whose rounding is a larger part of it: there it is rounding where the attitude's is.
    #[inline(always)]
    pub(super) fn judge(&mut self, change: f64, of_attitude: f64) -> Next {
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
