//! The trait that `#[lagrangian]` implements, and that can be implemented by hand.

use core::fmt::Debug;

use crate::advected::Advected;
use crate::coordinates::Coordinates;
use crate::error::SetupError;
use crate::groups::LieGroup;
use crate::retraction::Retraction;
use crate::scalar::Real;

/// The scalar of a Lagrangian.
pub type Scalar<L> = <L as DiscreteLagrangian>::Scalar;
/// The group of a Lagrangian.
pub type Group<L> = <L as DiscreteLagrangian>::Group;
/// The matrices of its group.
pub type Matrix<L> = <Group<L> as LieGroup>::Matrix;
/// Components of covectors and algebra elements.
pub type Vector<L> = <Group<L> as LieGroup>::Vector;
/// Linear maps of components.
pub type Square<L> = <Vector<L> as Coordinates<Scalar<L>>>::Square;

/// A reduced discrete Lagrangian `l_d(F, w)` with all that an integrator needs of it.
///
/// `F = g_i⁻¹ g_{i+1}` is the increment of a step, `w` the advected parameters as the body sees them, `h` the step in
/// seconds. Covectors are components `μ_k = ⟨μ, E_k⟩`; on SO(3) these are body-frame angular momenta in kg m²/s.
/// The derived terms use the relation of the group (`FᵀF = I`), so they mean nothing at a matrix off it; `l_d` itself
/// is the declared expression and accepts any matrix.
///
/// The first half is mathematics, the second the same equations in stages: what depends on the parameters and `h` is
/// computed once ([`constants`](Self::constants)), what depends on the state once a step, and
/// only what depends on the unknown once a Newton iteration. A step is
///
/// ```text
/// a  = μ + kick_before(w)                      the part of (2.7) without F moves to the other side
/// solve   U(F, w) = a     for F = τ(ξ)         newton_system, up to a positive factor
/// w⁺ = F⁻¹ · w                                 (2.9)
/// μ⁺ = Ad*_F a + kick_after(F, w⁺)             (2.9), in the transport form μ⁺ = Ad*_F (μ + δl_d/δw ⋄ w)
/// g⁺ = g F                                     (2.10)
/// ```
///
/// # Source
///
/// \[RDAE\], sections 1.4 and 2.2; see [`conventions`](crate::conventions).
pub trait DiscreteLagrangian {
    /// The scalar.
    type Scalar: Real;
    /// The group that `F` belongs to.
    type Group: LieGroup<Scalar = Self::Scalar>;
    /// The coordinates of the Newton unknown.
    type Retraction: Retraction<Self::Group>;
    /// The advected parameters: `()`, a vector, or a tuple.
    type Advected: Advected<Self::Group>;
    /// What the parameters and `h` determine.
    type Constants: Copy + Debug + PartialEq;
    /// What `a` and `w` determine.
    type StepTerms: Copy;

    /// The declared Lagrangian and everything derived from it, as text.
    const DERIVATION: &'static str;

    /// Whether `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)` for all values of the parameters.
    ///
    /// Then a step of `−h` is the exact inverse of a step of `h`, the order is even (2 at least), and symmetric
    /// compositions raise it; otherwise it is 1 in general. The macro finds it out and says in
    /// [`DERIVATION`](Self::DERIVATION) how, and if it holds for points in homogeneous coordinates only; who implements
    /// the trait by hand states it.
    const SELF_ADJOINT: bool;

    /// Whether the Jacobian of [`newton_system`](Self::newton_system) costs more than several residuals.
    ///
    /// Then a solve starts with the [residual](Self::newton_residual) alone and the Jacobian of the free body with the
    /// same [`inertia`](Self::inertia), [`Retraction::free_momentum_tangent`], with which the system must have the
    /// factor one. The macro decides it by counting operations.
    const JACOBIAN_IS_DEAR: bool = false;

    /// Checks the parameters.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] naming the first field whose value can't be used.
    fn validate(&self) -> Result<(), SetupError>;

    /// The spatial values `a_0` of the advected parameters.
    fn advected(&self) -> Self::Advected;

    /// The declared `l_d(F, w)`, in J s.
    fn l_d(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Self::Scalar;

    /// `(R_F)* δl_d/δF`: components `d/ds l_d(exp(s E_k) F, w)` at `s = 0`.
    fn right_momentum(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self>;

    /// `(L_F)* δl_d/δF`: components `d/ds l_d(F exp(s E_k), w)` at `s = 0`.
    fn left_momentum(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self>;

    /// `δl_d/δw ⋄ w`: components `−d/ds l_d(F, exp(s E_k) · w)` at `s = 0`, \[RDAE, (2.1)\].
    fn diamond(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self>;

    /// The momentum component of `𝔽l_d⁻`: `μ = (R_F)* δl_d/δF − δl_d/δw ⋄ w`, \[RDAE, (2.7)\].
    fn legendre_minus(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self> {
        self.right_momentum(f, w, h) - self.diamond(f, w, h)
    }

    /// The momentum component of `𝔽l_d⁺`: `μ = (L_F)* δl_d/δF`, \[RDAE, (2.6)\].
    fn legendre_plus(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Vector<Self> {
        self.left_momentum(f, w, h)
    }

    /// The exact right-trivialised Newton Jacobian: entry `(k, j)` is the derivative of component `k` of
    /// [`legendre_minus`](Self::legendre_minus) along `F ↦ exp(t E_j) F`.
    fn momentum_jacobian(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Square<Self>;

    /// The discrete energy `−∂l_d/∂h`, in J.
    fn discrete_energy(&self, f: &Matrix<Self>, w: &Self::Advected, h: Self::Scalar) -> Self::Scalar;

    /// The matrix `J` of the continuous limit `l(ξ, w) = ½ ξ·Jξ + s·ξ − V`, `l_d(exp hξ, w) = h l(ξ, w) + O(h²)`.
    fn inertia(&self) -> Square<Self>;

    /// The covector `s` of the continuous limit: what is linear in the velocity.
    fn momentum_bias(&self, w: &Self::Advected) -> Vector<Self>;

    /// The potential `V(w)` of the continuous limit, in J.
    fn potential(&self, w: &Self::Advected) -> Self::Scalar;

    /// Folds the parameters and the step into the constants of the stages below.
    fn constants(&self, h: Self::Scalar) -> Self::Constants;

    /// The part of the diamond that doesn't depend on `F`.
    fn kick_before(constants: &Self::Constants, w: &Self::Advected) -> Vector<Self>;

    /// What one solve needs of `a = μ + kick_before(w)` and `w`.
    fn step_terms(constants: &Self::Constants, a: &Vector<Self>, w: &Self::Advected) -> Self::StepTerms;

    /// A positive multiple of `U(τ(ξ), w) − a`, and its derivative with respect to `ξ`. Where the [Jacobian is
    /// dear](Self::JACOBIAN_IS_DEAR) it is `U − a` itself.
    fn newton_system(
        constants: &Self::Constants,
        terms: &Self::StepTerms,
        xi: &Vector<Self>,
    ) -> (Vector<Self>, Square<Self>);

    /// The residual of [`newton_system`](Self::newton_system) alone.
    #[inline(always)]
    fn newton_residual(constants: &Self::Constants, terms: &Self::StepTerms, xi: &Vector<Self>) -> Vector<Self> {
        Self::newton_system(constants, terms, xi).0
    }

    /// `Ad*_F` of the part of the diamond that depends on `F`, written in the new `w⁺`; `increment` is `F − I`.
    fn kick_after(constants: &Self::Constants, increment: &Matrix<Self>, next: &Self::Advected) -> Vector<Self>;
}

/// `μ = Jξ + s(w)`: the momentum of the body velocity `ξ`.
pub(crate) fn momentum_of_velocity<L: DiscreteLagrangian>(
    lagrangian: &L,
    velocity: &Vector<L>,
    w: &L::Advected,
) -> Vector<L> {
    lagrangian.inertia() * *velocity + lagrangian.momentum_bias(w)
}

/// `ξ = J⁻¹(μ − s(w))`: the body velocity of the momentum `μ`.
pub(crate) fn velocity_of_momentum<L: DiscreteLagrangian>(
    lagrangian: &L,
    momentum: &Vector<L>,
    w: &L::Advected,
) -> Vector<L> {
    Vector::<L>::solve(&lagrangian.inertia(), &(*momentum - lagrangian.momentum_bias(w))).0
}

/// `½ ξ·Jξ + V(w)`, the energy of the continuous limit.
pub(crate) fn energy<L: DiscreteLagrangian>(lagrangian: &L, momentum: &Vector<L>, w: &L::Advected) -> Scalar<L> {
    let velocity = velocity_of_momentum(lagrangian, momentum, w);
    let kinetic = velocity.dot(&(lagrangian.inertia() * velocity)) * crate::scalar::real(0.5);
    kinetic + lagrangian.potential(w)
}
