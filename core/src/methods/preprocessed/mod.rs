//! The free asymmetric body to high order in one solve.

mod coefficients;
mod modified;

pub(crate) use modified::ModifiedBody;

use nalgebra::Vector3;

use crate::effects::PrincipalBody;
use crate::error::{SetupError, StepError};
use crate::groups::{LieGroup as _, SO3};
use crate::mechanics::{Effect, Operations, SceneVisitor};
use crate::motion::{Cost, Declared, Motion, Plan, StepReport, Stepper, Summation, beyond_solvable, half_coordinates};
use crate::numbers::{Coordinates, Real};
use crate::solving::Guess;

/// The order of a [`Preprocessed`].
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
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Four => "preprocessed, 4",
            Self::Six => "preprocessed, 6",
            Self::Eight => "preprocessed, 8",
            Self::Ten => "preprocessed, 10",
        }
    }

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

/// The plan of [`Stepper::preprocessed`](crate::Stepper::preprocessed), for the free rigid body: (3.13) with moments of inertia that make up for its error.
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
/// use liestep::effects::PrincipalBody;
/// use liestep::methods::PreprocessedOrder;
/// use liestep::{SO3, Stepper};
/// use liestep::mechanics::DiagonalNonstandardInertia;
/// use nalgebra::Vector3;
///
/// let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
/// let stepper = Stepper::preprocessed(PrincipalBody { J_d }, 0.1, PreprocessedOrder::Ten)?;
/// let mut state = stepper.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02))?;
/// let energy: f64 = stepper.energy(&state);
/// for _ in 0..1000 {
///     stepper.step(&mut state)?;
/// }
/// assert!((stepper.energy(&state) - energy).abs() < 1e-12 * energy);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Source
///
/// \[HV06\]; see [`conventions`](crate::conventions).
#[derive(Clone, Debug, Lanes, InLanes)]
pub struct Preprocessed<T: Real = f64> {
    modified: ModifiedBody<T>,
    #[shared]
    order: PreprocessedOrder,
    h: T,
}

impl<T: Real> Stepper<PrincipalBody<T>> {
    /// The free body to high order in one solve; see [`Preprocessed`].
    ///
    /// # Errors
    ///
    /// As [`Stepper::new`].
    pub fn preprocessed(
        body: PrincipalBody<T>,
        h: T,
        order: PreprocessedOrder,
    ) -> Result<Stepper<PrincipalBody<T>, Preprocessed<T>>, SetupError> {
        // For its checks of the body and the step.
        Declared::new(&body, h)?;
        let plan = Preprocessed::new(&body, h, order);
        Ok(Stepper { scene: body, plan })
    }
}

impl<T: Real> Preprocessed<T> {
    /// The series to order ten, 120, and their moments, which the solve waits for; a guess, and what becomes of the
    /// momentum.
    pub(crate) const OPERATIONS: Operations =
        Operations { step: 195, iteration: PrincipalBody::<T>::OPERATIONS.iteration };

    fn new(body: &PrincipalBody<T>, h: T, order: PreprocessedOrder) -> Self {
        Self { modified: ModifiedBody::new(&body.J_d, order.degree()), order, h }
    }
}

impl<T: Real> Plan<PrincipalBody<T>> for Preprocessed<T> {
    type Kept = Guess<Vector3<T>>;

    fn step_size(&self) -> T {
        self.h
    }

    fn refolded(&self, scene: &PrincipalBody<T>, h: T) -> Result<Self, SetupError> {
        Ok(Self::new(scene, h, self.order))
    }

    fn keep(&self, scene: &PrincipalBody<T>, motion: &Motion<SO3<T>, ()>) -> Self::Kept {
        Guess::of(half_coordinates(scene, motion, self.h))
    }

    #[hot]
    fn step<M: Summation<SO3<T>, ()>>(
        &self,
        _: &PrincipalBody<T>,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        if self.h == T::zero() {
            motion.count();
            return Ok(StepReport::of(0));
        }
        let momentum = motion.now().momentum;
        let root = self.modified.solve(self.h, &momentum, &kept.next)?;
        motion.turn(&root.increment);
        motion.push(&SO3::adjoint_transpose_increment(&root.increment, &momentum));
        // Of steps so long a parabola would stray farther than the line.
        let is_first = motion.now().steps == 0;
        kept.follow(root.half, root.far);
        if is_first {
            kept.next = kept.half;
        }
        motion.finish(|| ());
        Ok(StepReport::of(root.iterations))
    }

    const EXPLAINS: bool = true;

    #[cold]
    fn explained(
        &self,
        error: StepError,
        scene: &PrincipalBody<T>,
        motion: &Motion<SO3<T>, ()>,
        kept: &Self::Kept,
    ) -> StepError {
        if !Coordinates::is_finite(&motion.momentum) {
            return StepError::NonFinite { what: "momentum" };
        }
        let largest = self.max_step(scene, motion, kept);
        if largest == T::zero() {
            return error;
        }
        beyond_solvable(scene, self.h, &motion.momentum, &motion.advected, largest)
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<T>) {
        visitor.term(self.order.name());
    }

    fn cost(&self) -> Cost {
        Cost::of_stages(Self::OPERATIONS, 1)
    }
}
