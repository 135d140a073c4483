//! The trait of all terms of scenes and sums, effects and continuous Lagrangians alike.

use crate::error::SetupError;
use crate::groups::{Advected, LieGroup};
use crate::numbers::Real;

/// A term on a group with its parameters, which adds with others by `+`: an [`Effect`](crate::mechanics::Effect), a
/// [`ContinuousLagrangian`](crate::mechanics::ContinuousLagrangian), or both.
///
/// The [`Sum`](crate::mechanics::Sum) of two effects is an effect, that of two continuous Lagrangians a continuous
/// Lagrangian, and that of two terms which are both is both.
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
    /// [`SetupError::Parameter`] names the first field with an invalid value.
    fn validate(&self) -> Result<(), SetupError>;

    /// The spatial values `a_0` of the advected parameters.
    fn advected(&self) -> Self::Advected;
}
