//! The methods among which an accuracy chooses.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::fmt;

use crate::error::SetupError;
use crate::mechanics::{Group, Scene};
use crate::methods::CompositionScheme;
use crate::motion::AnyStepper;
use crate::with::{Method, Scheme, Steppable};

/// A scheme as a constructor from a step.
pub struct Candidate {
    /// The scheme.
    pub scheme: Scheme,
    /// The stepper by a step, s.
    pub make: Box<dyn Fn(f64) -> Result<AnyStepper, SetupError>>,
}

impl fmt::Debug for Candidate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Candidate").field(&self.scheme).finish()
    }
}

impl Candidate {
    /// Whether the method has no error but rounding.
    pub(super) fn is_exact(&self) -> bool {
        self.scheme == Scheme::Exact
    }
}

/// The schemes for a scene: its own step, which is assumed to be of order 2, its symmetric compositions if it is
/// self-adjoint, and those of its group.
pub(super) fn candidates<S>(scene: &S) -> Vec<Candidate>
where
    S: Scene<Scalar = f64>,
    Group<S>: Steppable<S>,
{
    let compositions =
        CompositionScheme::ALL.into_iter().filter(|scheme| scheme.base() == 2 && S::FACTS.is_self_adjoint);
    let schemes = [Scheme::Step].into_iter().chain(compositions.map(Scheme::Composition));
    let all = schemes.chain(<Group<S> as Steppable<S>>::schemes(scene));
    let candidate = |scheme: Scheme| {
        let scene = scene.clone();
        Candidate { scheme, make: Box::new(move |h| Method::from(scheme).stepper(scene.clone(), h)) }
    };
    all.map(candidate).collect()
}

/// The schemes of every group: the own step, which is assumed to be of order 2, and its compositions if it is self-adjoint.
pub fn of_any_group(is_self_adjoint: bool) -> impl Iterator<Item = Scheme> {
    let compositions = CompositionScheme::ALL.into_iter().filter(move |scheme| scheme.base() == 2 && is_self_adjoint);
    [Scheme::Step].into_iter().chain(compositions.map(Scheme::Composition))
}
