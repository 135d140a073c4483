//! The trait of reduced continuous Lagrangians `l(ξ, w)`, by the first two chapters of the thesis.

use crate::error::StepError;
use crate::groups::{Advected as _, LieGroup};
use crate::mechanics::sum::{Sum, added};
use crate::mechanics::term::Term;
use crate::numbers::{Coordinates, NewtonEnd, Real, newton_halving, reported, sum};
use nalgebra::SimdBool as _;

type Velocity<L> = <<L as Term>::Group as LieGroup>::Vector;
type Covector<L> = Velocity<L>;
type Matrix<L> = <<L as Term>::Group as LieGroup>::Matrix;
type Hessian<L> = <Velocity<L> as Coordinates<<L as Term>::Scalar>>::Square;

/// The form of the Legendre transform `ξ ↦ μ = ∂l/∂ξ`, which determines the computation of its inverse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Legendre {
    /// `l` is quadratic in `ξ`, and its second derivative is the same for all `w`: `ξ = M⁻¹ (μ − s(w))`.
    Constant,
    /// `l` is quadratic in `ξ`: `ξ = M(w)⁻¹ (μ − s(w))`.
    Varying,
    /// `l` isn't quadratic in `ξ`: Newton's iteration solves `∂l/∂ξ = μ`.
    Nonlinear,
}

impl Legendre {
    /// The form of the transform of a sum of two Lagrangians.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        match (self, other) {
            (Self::Nonlinear, _) | (_, Self::Nonlinear) => Self::Nonlinear,
            (Self::Varying, _) | (_, Self::Varying) => Self::Varying,
            _ => Self::Constant,
        }
    }
}

/// A reduced Lagrangian `l(ξ, w)` with its momentum, its diamond term and its equations of motion.
///
/// `ξ = g⁻¹ġ` is the body velocity, in components of the declared basis `E_k` (on SO(3) in rad/s), and `w = g⁻¹·a_0`
/// are the advected parameters in the body frame. Covectors are components `μ_k = ⟨μ, E_k⟩`; on SO(3) these are
/// body-frame angular momenta in kg m²/s. For several bodies, on a product of groups, velocities and covectors have the
/// components of all, one body after the other: for translations in the axes of space, in m/s and kg m/s, for rotations
/// about a fixed axis, by `R1`, in rad/s and kg m²/s.
///
/// [`lagrangian`](crate::lagrangian) implements it: for a declared `l` with derived terms, and for a declared `l_d`
/// with those of its limit `h → 0`, `l = ½ ξ·Jξ + s(w)·ξ − V(w)`. They add by `+`, with each other and with effects.
/// [`RightHandSide`](crate::motion::RightHandSide) prepares it for an ODE solver.
///
/// # Source
///
/// \[RDAE\], sections 1.1 to 1.3 and 2.1; see [`conventions`](crate::conventions).
///
/// # Examples
///
/// ```
/// use liestep::mechanics::{ContinuousLagrangian, Inertia};
/// use liestep::{SO3, lagrangian};
/// use nalgebra::Vector3;
///
/// /// A heavy top, as in (2.3).
/// #[lagrangian(
///     group = SO3,
///     velocity = Omega,
///     advected(w = up),
///     l = 0.5 * Omega.dot(&(J * Omega)) - m * g * w.dot(&rho),
/// )]
/// struct Top {
///     J: Inertia,
///     m: f64,
///     g: f64,
///     rho: Vector3<f64>,
///     up: Vector3<f64>,
/// }
///
/// let J = Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0))?;
/// let top = Top { J, m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
/// let (Omega, w) = (Vector3::new(0.5, 2.0, 12.0), Vector3::new(0.0, 0.6, 0.8));
/// let momentum = top.momentum(&Omega, &w);
/// assert_eq!(momentum, Vector3::new(1.5, 6.0, 48.0));
/// let (torque, turn) = top.lie_poisson(&momentum, &w)?;
/// assert!((torque - (momentum.cross(&Omega) + w.cross(&Vector3::z()) * 9.81)).norm() < 1e-12);
/// assert!((turn - w.cross(&Omega)).norm() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` isn't a Lagrangian with a continuous limit",
    label = "no `l(ξ, w)` is known of it",
    note = "declare it by `#[lagrangian(… l = …)]` or `#[lagrangian(… l_d = …)]`; a force has none, nor has a system of many bodies, which `Each`, `On`, `Along`, `Between` and `Pairs` put together"
)]
pub trait ContinuousLagrangian: Term {
    /// The form of the Legendre transform.
    const LEGENDRE: Legendre;

    /// The declaration, and the continuous equations derived from it, as text.
    const CONTINUOUS_DERIVATION: &'static str;

    /// The Lagrangian `l(ξ, w)`, in J; for a declared `l` the expression itself.
    fn l(&self, velocity: &Velocity<Self>, w: &Self::Advected) -> Self::Scalar;

    /// The momentum `μ = ∂l/∂ξ`, \[RDAE, (1.14)\].
    fn momentum(&self, velocity: &Velocity<Self>, w: &Self::Advected) -> Covector<Self>;

    /// The second derivative `M = ∂²l/∂ξ²`.
    fn velocity_hessian(&self, velocity: &Velocity<Self>, w: &Self::Advected) -> Hessian<Self>;

    /// The diamond `∂l/∂w ⋄ w`: components `−⟨∂l/∂w, E_k·w⟩`, \[RDAE, (2.1)\].
    fn diamond_rate(&self, velocity: &Velocity<Self>, w: &Self::Advected) -> Covector<Self>;

    /// The diamond along all matrices: entries `−⟨∂l/∂w, e_ij·w⟩`, where the matrix `e_ij` has a one at `(i, j)`;
    /// paired with `E_k`, entry by entry, it is [`diamond_rate`](Self::diamond_rate). On a product each factor has its
    /// own matrix; for a translation only the last column counts. If attitudes are advected, the derivation may use
    /// `RᵀR = I`, and only the pairing is meaningful.
    fn diamond_matrix(&self, velocity: &Velocity<Self>, w: &Self::Advected) -> Matrix<Self>;

    /// The momentum's change by advection, `(∂²l/∂w∂ξ)(ξ·w)`: the rate at which the momentum of a constant velocity
    /// decreases while `w` is advected. Zero if `l` is a kinetic energy of `ξ` alone and a potential of `w`.
    fn momentum_advection(&self, velocity: &Velocity<Self>, w: &Self::Advected) -> Covector<Self>;

    /// The rate of the momentum, `μ̇ = ad*_ξ μ + ∂l/∂w ⋄ w`, \[RDAE, (1.4) and (2.2)\].
    fn momentum_rate(&self, velocity: &Velocity<Self>, w: &Self::Advected) -> Covector<Self> {
        let momentum = self.momentum(velocity, w);
        Self::Group::lie_bracket_transpose(velocity, &momentum) + self.diamond_rate(velocity, w)
    }

    /// The rate of the advected parameters, `ẇ = −ξ·w`, \[RDAE, (2.2)\].
    fn advected_rate(&self, velocity: &Velocity<Self>, w: &Self::Advected) -> Self::Advected {
        w.rate(&Self::Group::hat(velocity))
    }

    /// The inverse Legendre transform: the velocity `ξ` with `∂l/∂ξ = μ`.
    ///
    /// # Errors
    ///
    /// [`StepError::Singular`] if `M` is singular. If `l` isn't quadratic in the velocity, also if `M` has a sign other
    /// than at rest, and [`StepError::NotConverged`] if Newton's iteration finds no velocity.
    fn velocity(&self, momentum: &Covector<Self>, w: &Self::Advected) -> Result<Velocity<Self>, StepError> {
        let rest = Velocity::<Self>::zero();
        let defect = *momentum - self.momentum(&rest, w);
        let velocity = Velocity::<Self>::solve(&self.velocity_hessian(&rest, w), &defect).0;
        match Self::LEGENDRE {
            Legendre::Constant | Legendre::Varying => finite(velocity),
            Legendre::Nonlinear => {
                let (of, hessian) = (|xi: &_| self.momentum(xi, w), |xi: &_| self.velocity_hessian(xi, w));
                self::velocity(&newton_halving(momentum, velocity, of, hessian))
            }
        }
    }

    /// The reduced Hamiltonian `h(μ, w) = ⟨μ, ξ⟩ − l(ξ, w)`, in J, \[RDAE, (1.16)\].
    ///
    /// # Errors
    ///
    /// The errors of [`velocity`](Self::velocity).
    fn hamiltonian(&self, momentum: &Covector<Self>, w: &Self::Advected) -> Result<Self::Scalar, StepError> {
        let velocity = self.velocity(momentum, w)?;
        Ok(momentum.dot(&velocity) - self.l(&velocity, w))
    }

    /// The Euler–Poincaré equations with advection, \[RDAE, (1.4) and (2.2)\], solved for the rates of velocity and
    /// advected parameters: `M ξ̇ = ad*_ξ μ + ∂l/∂w ⋄ w + (∂²l/∂w∂ξ)(ξ·w)` and `ẇ = −ξ·w`.
    ///
    /// # Errors
    ///
    /// [`StepError::Singular`] if `M` is singular.
    fn euler_poincare(
        &self,
        velocity: &Velocity<Self>,
        w: &Self::Advected,
    ) -> Result<(Velocity<Self>, Self::Advected), StepError> {
        let force = self.momentum_rate(velocity, w) + self.momentum_advection(velocity, w);
        let rate = Velocity::<Self>::solve(&self.velocity_hessian(velocity, w), &force).0;
        Ok((finite(rate)?, self.advected_rate(velocity, w)))
    }

    /// The Lie–Poisson equations on the dual of the semidirect product, \[RDAE, (1.12)\]: with `ξ = ∂h/∂μ` the rates
    /// `μ̇ = ad*_ξ μ − ∂h/∂w ⋄ w` and `ẇ = −ξ·w`.
    ///
    /// # Errors
    ///
    /// The errors of [`velocity`](Self::velocity).
    fn lie_poisson(
        &self,
        momentum: &Covector<Self>,
        w: &Self::Advected,
    ) -> Result<(Covector<Self>, Self::Advected), StepError> {
        let velocity = self.velocity(momentum, w)?;
        // The derivative ∂h/∂w = −∂l/∂w, at the velocity of this momentum.
        let rate = Self::Group::lie_bracket_transpose(&velocity, momentum) + self.diamond_rate(&velocity, w);
        Ok((rate, self.advected_rate(&velocity, w)))
    }
}

/// The value, if it is finite.
fn finite<T: Real, V: Coordinates<T>>(value: V) -> Result<V, StepError> {
    if value.is_finite() { Ok(value) } else { Err(StepError::Singular) }
}

/// The velocity at the end of Newton's iteration, if the iteration converged in all lanes.
fn velocity<T: Real, V: Coordinates<T>>(end: &NewtonEnd<T, V>) -> Result<V, StepError> {
    let NewtonEnd { solution, is_settled, is_regular, iterations, residual } = *end;
    if !is_settled.all() {
        return Err(StepError::NotConverged { iterations, residual: reported(residual) });
    }
    if is_regular.all() { finite(solution) } else { Err(StepError::Singular) }
}

impl<A, B> ContinuousLagrangian for Sum<A, B>
where
    A: ContinuousLagrangian,
    B: ContinuousLagrangian<Scalar = A::Scalar, Group = A::Group>,
{
    const LEGENDRE: Legendre = A::LEGENDRE.or(B::LEGENDRE);
    const CONTINUOUS_DERIVATION: &'static str =
        "the sum of two Lagrangians: l, its momenta and diamonds, each added; see CONTINUOUS_DERIVATION of either\n";

    added! {
        fn l(velocity: &Velocity<Self>, w) -> Self::Scalar;
        fn momentum(velocity: &Velocity<Self>, w) -> Covector<Self>;
        fn velocity_hessian(velocity: &Velocity<Self>, w) -> Hessian<Self>;
        fn diamond_rate(velocity: &Velocity<Self>, w) -> Covector<Self>;
        fn momentum_advection(velocity: &Velocity<Self>, w) -> Covector<Self>;
    }

    fn diamond_matrix(&self, velocity: &Velocity<Self>, w: &Self::Advected) -> Matrix<Self> {
        sum(&self.first.diamond_matrix(velocity, &w.0), &self.second.diamond_matrix(velocity, &w.1))
    }
}
