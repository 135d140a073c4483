//! The step of (3.13) with the moments of inertia that the momentum asks for.

use nalgebra::{SimdBool as _, Vector3};

use super::coefficients::{TERMS, series, sum};
use crate::effects::PrincipalBody;
use crate::error::StepError;
use crate::groups::SO3;
use crate::mechanics::{DiagonalNonstandardInertia, Effect as _};
use crate::numbers::{Numbers, Real, real};
use crate::solving::{Problem, Root, safe};

/// A body and the series for its modified moments.
#[derive(Clone, Copy, Debug, Lanes)]
pub(crate) struct ModifiedBody<T> {
    pub(crate) inverse_moments: Vector3<T>,
    /// In `h² H` and `h² C`, to which the series are taken.
    #[shared]
    degree: usize,
    s: Numbers<T, TERMS>,
    d: Numbers<T, TERMS>,
}

impl<T: Real> ModifiedBody<T> {
    pub(crate) fn new(inertia: &DiagonalNonstandardInertia<T>, degree: usize) -> Self {
        let d = inertia.diagonal();
        let moments = Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y);
        let inverse_moments = moments.map(|moment| T::one() / moment);
        let (s, d) = series(&moments);
        Self { inverse_moments, degree, s: Numbers(s), d: Numbers(d) }
    }

    /// The increment over the time `h`, s, from the body momentum `y`; the guess is of half the coordinates.
    #[hot]
    pub(crate) fn solve(&self, h: T, y: &Vector3<T>, half_guess: &Vector3<T>) -> Result<Root<SO3<T>>, StepError> {
        let (yy, half_squared) = (y.component_mul(y), h * h * real(0.5));
        let energy = yy.dot(&self.inverse_moments) * half_squared;
        let casimir = (yy.x + yy.y + yy.z) * half_squared;
        let s = T::one() + sum(&self.s.0, self.degree, casimir, energy);
        let d = sum(&self.d.0, self.degree, casimir, energy);
        let inverse = self.inverse_moments.map(|inverse| inverse * s + d);
        if !inverse.iter().all(|inverse| inverse.simd_gt(T::zero()).all()) {
            return Err(StepError::Singular);
        }
        let moments = inverse.map(|inverse| T::one() / inverse);
        let scene = PrincipalBody { J_d: DiagonalNonstandardInertia::of_moments_unchecked(&moments) };
        let constants = scene.constants(h);
        let safe = safe(moments.x * moments.y * moments.z);
        let problem = Problem { scene: &scene, constants: &constants, a: *y, w: &(), h, trusted: real(0.0), safe };
        // With a momentum so large that the determinant is doubtful, the moments above aren't positive.
        match problem.solve_directly::<false>(half_guess, real(f64::MAX)) {
            Some(root) => Ok(root),
            None => problem.solve(half_guess),
        }
    }
}
