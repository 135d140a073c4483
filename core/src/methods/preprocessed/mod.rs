//! The free asymmetric body to high order in one solve.

mod coefficients;
mod modified;

pub(crate) use modified::{FreeBody, ModifiedBody};

use nalgebra::Vector3;

use crate::error::{SetupError, StepError};
use crate::groups::{LieGroup as _, SO3};
use crate::mechanics::DiagonalNonstandardInertia;
use crate::motion::{State, StepReport, Stepper};
use crate::numbers::{Coordinates, Real, real, reported};
use crate::solving::Continued;
use crate::solving::{largest_fraction, six_digits};

/// The order of a [`PreprocessedBody`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PreprocessedOrder {
    /// Order 4.
    Four,
    /// Order 6.
    Six,
    /// Order 8.
    Eight,
    /// Order 10.
    Ten,
}

impl PreprocessedOrder {
    /// The degree in `h² H` and `h² C` that the series are taken to.
    pub(crate) fn degree(self) -> usize {
        match self {
            Self::Four => 1,
            Self::Six => 2,
            Self::Eight => 3,
            Self::Ten => 4,
        }
    }
}

/// An integrator for the free rigid body: (3.13) with moments of inertia that make up for its error.
///
/// To all orders in the step, the discrete free body of (3.13) goes through the points of the exact motion at other
/// times and of another body: with
///
/// ```text
/// 1/Ĩ_j = s/I_j + d        s = 1 + h² s_3 + h⁴ s_5 + …        d = h² d_3 + h⁴ d_5 + …
/// ```
///
/// in its place, `s_k` and `d_k` polynomials in the energy `H = ½ Σ y_j²/I_j` and in `C = ½ |y|²`, its order is as high
/// as the series are taken. Energy, `C` and `R y` are kept exactly, a step of `−h` undoes one of `h`, and the map of
/// `y` is Poisson. That of `(y, R)` together isn't symplectic, so that kicks of a potential between such steps make the
/// energy drift: this is for bodies that nothing acts on.
///
/// # Examples
///
/// ```
/// use liestep::{DiagonalNonstandardInertia, LieGroup, PreprocessedBody, PreprocessedOrder, SO3};
/// use nalgebra::Vector3;
///
/// let inertia = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
/// let body = PreprocessedBody::new(inertia, 0.1, PreprocessedOrder::Ten)?;
/// let mut state = body.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02))?;
/// let energy: f64 = body.energy(&state);
/// for _ in 0..1000 {
///     body.step(&mut state)?;
/// }
/// assert!((body.energy(&state) - energy).abs() < 1e-12 * energy);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Source
///
/// \[HV06\]; see [`conventions`](crate::conventions).
#[derive(Clone, Debug)]
pub struct PreprocessedBody<T: Real = f64> {
    stepper: Stepper<FreeBody<T>>,
    modified: ModifiedBody<T>,
    h: T,
}

impl<T: Real> PreprocessedBody<T> {
    /// Checks the step, in seconds, and computes the coefficients of the series.
    ///
    /// # Errors
    ///
    /// As [`DiscreteLiePoisson::new`](crate::motion::DiscreteLiePoisson::new).
    pub fn new(inertia: DiagonalNonstandardInertia<T>, h: T, order: PreprocessedOrder) -> Result<Self, SetupError> {
        let stepper = Stepper::new(FreeBody { J_d: inertia }, h)?;
        Ok(Self { stepper, modified: ModifiedBody::new(&inertia, order.degree()), h })
    }

    /// One step. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// [`StepError`] where the momentum equation has no solution on the branch of the identity, or a value isn't
    /// finite.
    #[inline]
    pub fn step(&self, state: &mut State<SO3<T>, ()>) -> Result<StepReport, StepError> {
        if self.h == T::zero() {
            state.steps += 1;
            return Ok(StepReport { iterations: 0, remedy: None });
        }
        let root = match self.modified.solve(self.h, &state.momentum, &state.half_guess) {
            Ok(root) => root,
            Err(error) => return Err(self.explain(error, state)),
        };
        state.attitude = state.attitude.advance(&root.increment);
        state.momentum += SO3::adjoint_transpose_increment(&root.increment, &state.momentum);
        state.proceed(root.half, root.far, Continued::Line, || ());
        Ok(StepReport { iterations: root.iterations, remedy: None })
    }

    /// The largest step from this state up to the body's own, s, to six digits.
    #[must_use]
    pub fn max_step(&self, state: &State<SO3<T>, ()>) -> T {
        let solvable = |fraction: f64| {
            let h = self.h * real(fraction);
            self.modified.solve(h, &state.momentum, &(state.half_guess * real::<T>(fraction))).is_ok()
        };
        largest_fraction(solvable).map_or(T::zero(), |fraction| self.h * real(fraction))
    }

    #[cold]
    fn explain(&self, error: StepError, state: &State<SO3<T>, ()>) -> StepError {
        if !Coordinates::is_finite(&state.momentum) {
            return StepError::NonFinite { what: "momentum" };
        }
        let largest = self.max_step(state);
        if largest == T::zero() {
            return error;
        }
        StepError::BeyondSolvable { step: reported(self.h), largest: six_digits(reported(largest)) }
    }

    /// A motion from an attitude (body to space) and a body velocity, rad/s.
    ///
    /// # Errors
    ///
    /// [`SetupError`] where the attitude isn't a rotation or something isn't finite.
    pub fn start(&self, attitude: impl Into<SO3<T>>, velocity: Vector3<T>) -> Result<State<SO3<T>, ()>, SetupError> {
        self.stepper.start(attitude, velocity)
    }

    /// A motion from an attitude (body to space) and a body momentum, kg m²/s.
    ///
    /// # Errors
    ///
    /// [`SetupError`] where the attitude isn't a rotation or something isn't finite.
    pub fn start_with_momentum(
        &self,
        attitude: impl Into<SO3<T>>,
        momentum: Vector3<T>,
    ) -> Result<State<SO3<T>, ()>, SetupError> {
        self.stepper.start_with_momentum(attitude, momentum)
    }

    /// The step `h`, s.
    #[must_use]
    pub fn step_size(&self) -> T {
        self.h
    }

    /// The body velocity, rad/s.
    #[must_use]
    pub fn velocity(&self, state: &State<SO3<T>, ()>) -> Vector3<T> {
        state.momentum.component_mul(&self.modified.inverse_moments)
    }

    /// The energy `½ Ω·JΩ`, J, constant to rounding.
    #[must_use]
    pub fn energy(&self, state: &State<SO3<T>, ()>) -> T {
        self.stepper.energy(state)
    }
}
