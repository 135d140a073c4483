//! The trait of forces that `#[force]` implements.

use crate::mechanics::effect::{Effect, Matrix, Scalar, Vector};

/// A discrete force by its virtual work `f⁻(F, w)·η + f⁺(F, w)·η⁺`: the discrete Lagrange–d'Alembert principle.
///
/// With it a scene isn't conservative. Its share in a step is said in [`Effect`].
///
/// # Source
///
/// \[MW01\], section 3.2.
pub trait Force: Effect {
    /// The declared virtual work of a step, in J s, for displacements of the body at its beginning and its end, each in
    /// the body's axes then (on SO(3) in rad). On a product they are those of its factors, one after the other; of
    /// translations they are in the axes of space, in m.
    fn virtual_work(
        &self,
        f: &Matrix<Self>,
        w: &Self::Advected,
        h: Self::Scalar,
        eta: &Vector<Self>,
        eta_next: &Vector<Self>,
    ) -> Scalar<Self>;
}
