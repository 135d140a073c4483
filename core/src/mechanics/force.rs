//! The trait of forces that `#[force]` implements.

use crate::mechanics::effect::{Effect, Matrix, Scalar, Vector};

/// A discrete force by its virtual work `f⁻(F, w)·η + f⁺(F, w)·η⁺`: the discrete Lagrange–d'Alembert principle.
///
/// A scene with a force isn't conservative. [`Effect`] describes the force's part in a step.
///
/// # Source
///
/// \[MW01\], section 3.2.
pub trait Force: Effect {
    /// The declared virtual work of a step, in J s, for displacements of the body at the beginning and at the end of
    /// the step, each in the body's axes at that time (on SO(3) in rad). On a product they are those of its factors,
    /// one after the other; for translations they are in the axes of space, in m.
    fn virtual_work(
        &self,
        f: &Matrix<Self>,
        w: &Self::Advected,
        h: Self::Scalar,
        eta: &Vector<Self>,
        eta_next: &Vector<Self>,
    ) -> Scalar<Self>;
}
