//! The state of a motion, and what can be read off it.

use nalgebra::{SimdBool as _, Vector3};

use crate::advected::Advected;
use crate::coordinates::Coordinates as _;
use crate::groups::{LieGroup, SO3};
use crate::retraction::Retraction;
use crate::scalar::{Real, real};

/// Attitude, momentum and advected parameters at one time.
///
/// The coordinates of the last increment and a guess of the next ones are kept for the next solve. They are part of the
/// state, so that a copy continues with the same bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<G: LieGroup, A: Advected<G>> {
    pub(crate) attitude: G,
    pub(crate) momentum: G::Vector,
    pub(crate) advected: A,
    pub(crate) coordinates: G::Vector,
    pub(crate) guess: G::Vector,
    pub(crate) steps: u64,
}

/// So rarely that it costs nothing, so often that the defect stays at some roundings.
pub(crate) const CORRECTED_EVERY: u32 = 256;

impl<G: LieGroup, A: Advected<G>> State<G, A> {
    pub(crate) fn new(attitude: G, momentum: G::Vector, advected: A, coordinates: G::Vector) -> Self {
        Self { attitude, momentum, advected, coordinates, guess: coordinates, steps: 0 }
    }

    /// Counts the step of these coordinates, and guesses those of the next.
    #[inline(always)]
    pub(crate) fn proceed<R: Retraction<G>>(&mut self, coordinates: G::Vector) {
        // Increments change by O(h²) from step to step, and their changes by O(h³): for (3.13) at common steps this
        // guess saves one iteration of three.
        self.guess = coordinates + (coordinates - self.coordinates);
        // Near the fold they change too fast for that; a factor of 3/2 keeps well away from it. Before the first step
        // there was no increment but an estimate. A selection without the branch would lie on the way to the next
        // iteration, and cost a tenth of a step.
        let far = !R::is_near_identity(&(coordinates * real(1.5)));
        if self.steps == 0 {
            self.guess = coordinates;
        } else if far.any() {
            self.guess = coordinates.select(far, self.guess);
        }
        self.coordinates = coordinates;
        self.count(1);
    }

    /// Counts steps, of which the attitude has been made, and now and then corrects it.
    ///
    /// The rounding of an increment is the same wherever the increment is: in a motion that repeats itself the attitude
    /// would leave the group in proportion to the number of steps.
    #[inline(always)]
    pub(crate) fn count(&mut self, steps: u64) {
        let (before, every) = (self.steps, u64::from(CORRECTED_EVERY));
        self.steps += steps;
        if before / every != self.steps / every {
            self.correct();
        }
    }

    /// Apart, so that the steps themselves stay short.
    #[cold]
    #[inline(never)]
    fn correct(&mut self) {
        self.attitude = self.attitude.corrected();
    }

    /// The attitude `g_i`, body to space.
    #[must_use]
    pub fn attitude(&self) -> G {
        self.attitude
    }

    /// The momentum `μ_i`, body frame; on SO(3) the physical angular momentum, kg m²/s.
    #[must_use]
    pub fn momentum(&self) -> G::Vector {
        self.momentum
    }

    /// The advected parameters `w_i = g_i⁻¹ · a_0`.
    #[must_use]
    pub fn advected(&self) -> A {
        self.advected
    }

    /// The number of steps made.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The momentum in space, `Ad*_{g⁻¹} μ` (`R Π` on SO(3)); constant where nothing is advected.
    #[must_use]
    pub fn spatial_momentum(&self) -> G::Vector {
        self.attitude.inverse().adjoint_transpose(&self.momentum)
    }

    /// How far the attitude has left the group, `‖RᵀR − I‖` on SO(3).
    #[must_use]
    pub fn orthogonality_defect(&self) -> G::Scalar {
        self.attitude.defect()
    }
}

impl<T: Real, A: Advected<SO3<T>>> State<SO3<T>, A> {
    /// The spatial momentum's component along a direction given in space, `e₃ · R Π` for the vertical, (3.20).
    #[must_use]
    pub fn momentum_along(&self, direction: &Vector3<T>) -> T {
        self.spatial_momentum().dot(direction)
    }
}
