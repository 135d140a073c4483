//! The trait of reduced discrete Lagrangians that `#[lagrangian]` implements, and that can be implemented by hand.

use crate::groups::SO3;
use crate::mechanics::effect::Regular;
use crate::mechanics::effect::{Effect, Matrix, Vector};
use crate::mechanics::term::Term;

/// A reduced discrete Lagrangian `l_d(F, w)` with everything that an integrator needs.
///
/// `F = g_i⁻¹ g_{i+1}` is the increment of a step, `w` are the advected parameters in the body frame, and `h` is the
/// step in seconds. Covectors are components `μ_k = ⟨μ, E_k⟩`; on SO(3) these are body-frame angular momenta in kg
/// m²/s. The derived terms use the relation of the group (`FᵀF = I`), so they are meaningless at a matrix off it; `l_d`
/// itself is the declared expression and accepts any matrix.
///
/// [`Effect`] describes its step. An effect that is a Lagrangian is conservative: its flow is Poisson, and its energy
/// doesn't drift.
///
/// # Source
///
/// \[RDAE\], sections 1.4 and 2.2; see [`conventions`](crate::conventions).
#[diagnostic::on_unimplemented(
    message = "`{Self}` isn't a Lagrangian, so a scene with it isn't conservative",
    label = "not a Lagrangian",
    note = "a force does work: the energy isn't kept, and a step back doesn't undo a step"
)]
pub trait DiscreteLagrangian: Effect {
    /// The declared `l_d(F, w)`, in J s.
    fn l_d(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Self::Scalar;

    /// The right momentum `(R_F)* δl_d/δF`: components `d/ds l_d(exp(s E_k) F, w)` at `s = 0`.
    fn right_momentum(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self>;

    /// The left momentum `(L_F)* δl_d/δF`: components `d/ds l_d(F exp(s E_k), w)` at `s = 0`.
    fn left_momentum(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self>;

    /// The diamond `δl_d/δw ⋄ w`: components `−d/ds l_d(F, exp(s E_k) · w)` at `s = 0`, \[RDAE, (2.1)\].
    fn diamond(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self>;

    /// The momentum component of `𝔽l_d⁻`: `μ = (R_F)* δl_d/δF − δl_d/δw ⋄ w`, \[RDAE, (2.7)\].
    fn legendre_minus(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self> {
        self.right_momentum(f, w, h) - self.diamond(f, w, h)
    }

    /// The momentum component of `𝔽l_d⁺`: `μ = (L_F)* δl_d/δF`, \[RDAE, (2.6)\].
    fn legendre_plus(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self> {
        self.left_momentum(f, w, h)
    }

    /// The discrete energy `−∂l_d/∂h`, in J.
    fn discrete_energy(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Self::Scalar;
}

/// A scene on SO(3) that can be stepped: a body with a fixed point, or a body's rotation about its centre of mass.
pub trait RigidScene: DiscreteLagrangian + Regular + Effect<Group = SO3<<Self as Term>::Scalar>> {}

impl<S> RigidScene for S where S: DiscreteLagrangian + Regular + Effect<Group = SO3<<S as Term>::Scalar>> {}

/// A scene that can be stepped, and that a search among methods may store and copy.
pub trait Scene: DiscreteLagrangian<Advected: 'static> + Regular + Clone + 'static {}

impl<S> Scene for S where S: DiscreteLagrangian<Advected: 'static> + Regular + Clone + 'static {}
