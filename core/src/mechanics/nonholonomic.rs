//! The trait of constraints on velocities that `#[nonholonomic]` implements, and their checks at a start.

use alloc::vec::Vec;

use crate::error::SetupError;
use crate::mechanics::effect::{Effect, Matrix, Scalar, Vector};
use crate::numbers::{Coordinates, Real, reported};
use nalgebra::SimdRealField as _;

roots!();

/// A constraint that is linear in the velocity, `c(ξ, w) = A(w)·ξ = 0`: the discrete Lagrange–d'Alembert principle.
///
/// A step solves `U(F, w) = μ + kick_before(w) + λ A(w)` together with the constraint at the increment, so that the
/// reaction does no work on displacements that satisfy the constraint. After it a reaction at the end takes the momentum to a
/// velocity with `A(w⁺)·ξ = 0`. A sum with several constraints has a multiplier for each.
///
/// A scene with a constraint isn't symplectic, and no Lagrangian. Its energy has no drift in the problems that the guide
/// shows, which no theorem promises. The momentum along a symmetry is conserved if the symmetry's displacements satisfy the
/// constraint.
///
/// # Source
///
/// Cortés and Martínez, *Nonholonomic integrators*, Nonlinearity 14 (2001); \[MW01\], section 3.2, for the principle.
pub trait Nonholonomic: Effect {
    /// The declared constraint at a velocity, in units of its own.
    fn zero(&self, velocity: &Vector<Self>, w: &Self::Advected) -> Scalar<Self>;

    /// The constraint at an increment, `h c`: the rule of the declaration, `(h/2) (c(ξ, w) + c(ξ, F⁻¹·w))` with
    /// `hξ = cay⁻¹(F)` if none was named.
    fn at_increment(&self, f: &Matrix<Self>, w: &Self::Advected, h: Scalar<Self>) -> Scalar<Self>;

    /// The derivative of [`at_increment`](Self::at_increment): components `d/ds` of it at `exp(s E_k) F`, `s = 0`.
    fn slope(&self, f: &Matrix<Self>, w: &Self::Advected, h: Scalar<Self>) -> Vector<Self>;

    /// The covector `A(w)` of the reaction, in the body frame.
    fn reaction(&self, w: &Self::Advected) -> Vector<Self>;
}

/// The check of a start: squares and products of a constraint's covector and of the initial velocity.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct NonholonomicCheck {
    /// The constraint, from zero.
    pub constraint: usize,
    /// The square of the covector.
    pub size: f64,
    /// The square of its part across the covectors before.
    pub across: f64,
    /// The covector's value at the velocity.
    pub rate: f64,
    /// The square of the velocity.
    pub speed: f64,
    /// The rounding of a number.
    pub epsilon: f64,
}

impl NonholonomicCheck {
    /// The check itself.
    ///
    /// # Errors
    ///
    /// [`SetupError::RedundantConstraint`], [`SetupError::ViolatedConstraint`].
    pub fn passed(self) -> Result<(), SetupError> {
        let Self { constraint, size, across, rate, speed, epsilon } = self;
        // Twelve printed digits of a velocity pass, as they do in an attitude; NaN fails.
        let allowed = epsilon * 1e4;
        let is_independent = across > size * (allowed * allowed);
        if !is_independent {
            return Err(SetupError::RedundantConstraint { constraint });
        }
        if rate * rate <= size * speed * (allowed * allowed) {
            return Ok(());
        }
        Err(SetupError::ViolatedConstraint { constraint, by: rate.abs() / (size * speed).sqrt() })
    }
}

/// Checks that a velocity satisfies the constraints of a scene, and that none repeats others.
pub(crate) fn check_constraints<E: Effect>(scene: &E, velocity: &Vector<E>, w: &E::Advected) -> Result<(), SetupError> {
    for (constraint, normal) in normals(scene, w).iter().enumerate() {
        let Normal { own, square, .. } = normal;
        let (size, across) = (reported(own.dot(own)), reported(*square));
        let (rate, speed) = (reported(own.dot(velocity)), reported(velocity.dot(velocity)));
        let epsilon = reported(Scalar::<E>::simd_default_epsilon());
        NonholonomicCheck { constraint, size, across, rate, speed, epsilon }.passed()?;
    }
    Ok(())
}

/// A covector of a reaction, and its part across those before.
#[derive(Clone, Debug)]
pub(crate) struct Normal<V, T> {
    own: V,
    pub(crate) across: V,
    /// The square of the part across.
    pub(crate) square: T,
    /// The shares, negated, of the parts before in the covector.
    shares: Vec<T>,
}

impl<V: Coordinates<T>, T: Real> Normal<V, T> {
    /// The covector of the reaction.
    pub(crate) fn covector(&self) -> &V {
        &self.own
    }

    /// The constraint's value and slope combined with those before, as the part across is.
    pub(crate) fn combined(&self, (mut value, mut slope): (T, V), before: &[(T, V)]) -> (T, V) {
        for (share, before) in self.shares.iter().zip(before) {
            value += before.0 * *share;
            slope = slope + before.1 * *share;
        }
        (value, slope)
    }
}

/// The covectors of a scene's reactions, each with its part across those before.
pub(crate) fn normals<E: Effect>(scene: &E, w: &E::Advected) -> Vec<Normal<Vector<E>, Scalar<E>>> {
    let mut all: Vec<Normal<Vector<E>, Scalar<E>>> = Vec::new();
    scene.constrained(None, w, &mut |_, own| {
        let (mut across, mut shares) = (own, Vec::new());
        for before in &all {
            let share = -(across.dot(&before.across) / before.square);
            across = across + before.across * share;
            shares.push(share);
        }
        let square = across.dot(&across);
        all.push(Normal { own, across, square, shares });
    });
    all
}
