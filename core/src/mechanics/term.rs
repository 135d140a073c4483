//! What every term of a scene or of a sum has, whether it makes steps or says a continuous Lagrangian.

use crate::error::SetupError;
use crate::groups::{Advected, LieGroup};
use crate::numbers::Real;

/// A term on a group with its parameters, which adds with others by `+`: an [`Effect`](crate::mechanics::Effect), a
/// [`ContinuousLagrangian`](crate::mechanics::ContinuousLagrangian), or both.
///
/// Of two terms the [`Sum`](crate::mechanics::Sum) is what both of them are: an effect where both are effects, a continuous
/// Lagrangian where both are.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no term of a scene",
    label = "neither an effect nor a continuous Lagrangian",
    note = "terms are structs with `#[lagrangian(…)]` or `#[force(…)]`, those in `liestep::effects`, and their sums"
)]
pub trait Term {
    /// The scalar.
    type Scalar: Real;
    /// The group.
    type Group: LieGroup<Scalar = Self::Scalar>;
    /// The advected parameters: `()`, a vector, or a tuple.
    type Advected: Advected<Self::Group>;

    /// Checks the parameters.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] naming the first field whose value can't be used.
    fn validate(&self) -> Result<(), SetupError>;

    /// The spatial values `a_0` of the advected parameters.
    fn advected(&self) -> Self::Advected;
}
