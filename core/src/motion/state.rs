//! The state of a motion, and what can be read off it.

use nalgebra::{SimdBool as _, SimdValue as _, Vector3};

use crate::groups::{Advected, LieGroup, SO3};
use crate::numbers::{Coordinates as _, Entries as _, Mask, Real};
use crate::solving::{Continued, History};

/// How many steps go by between two looks at what roundings have done. Of the worst of them, the same in every step, a
/// thousand make no more than is let pass.
pub(crate) const LOOKS: u32 = 1024;

/// Attitude, momentum and advected parameters at one time.
///
/// The coordinates of the last increment, halved, and a guess of the next ones are kept for the next solve, with what
/// the guess is made of. They are part of the state, so that a copy continues with the same bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<G: LieGroup, A: Advected<G>> {
    pub(crate) attitude: G,
    pub(crate) momentum: G::Vector,
    pub(crate) advected: A,
    /// Half the coordinates of the last increment.
    pub(crate) half: G::Vector,
    /// A guess of half the next ones.
    pub(crate) half_guess: G::Vector,
    /// Of increments of one step: of many where the Jacobian is dear, elsewhere of the last three.
    pub(crate) history: History<G::Vector>,
    pub(crate) steps: u64,
}

impl<G: LieGroup, A: Advected<G>> State<G, A> {
    pub(crate) fn new(attitude: G, momentum: G::Vector, advected: A, half: G::Vector) -> Self {
        Self { attitude, momentum, advected, half, half_guess: half, history: History::new(), steps: 0 }
    }

    /// Counts the step with half these coordinates, and guesses those of the next by continuing the last ones; `far`
    /// are the lanes in which they are no longer near the identity at 3/2 of their length. Now and then it looks how
    /// far roundings have gone, and returns what [`restore`](Self::restore) does.
    #[inline(always)]
    pub(crate) fn proceed(
        &mut self,
        half: G::Vector,
        far: Mask<G::Scalar>,
        continued: Continued,
        spatial: impl FnOnce() -> A,
    ) -> Option<Mask<G::Scalar>> {
        let last = core::mem::replace(&mut self.half, half);
        self.half_guess = match continued {
            Continued::Line => half + (half - last),
            Continued::Parabola => self.history.parabola(last, half),
            Continued::Polynomial => self.history.next(last, half),
        };
        // Near the fold they change too fast for that; a factor of 3/2 keeps well away from it. A selection without the
        // branch would lie on the way to the next iteration, and cost a tenth of a step.
        if far.any() {
            self.half_guess = half.select(far, self.half_guess);
        }
        let restored = if self.is_due() { self.look(&spatial(), continued) } else { None };
        self.steps += 1;
        restored
    }

    /// The guess for the next solve, as a solve had better read it.
    ///
    /// A processor hands on what has just been stored to a load of the same place, but a load of two components that
    /// were stored apart waits until both stores are done. The compiler stores them and loads them in pairs, and in
    /// different ones if it may. With the last component loaded for itself they are the same; it was a tenth of a step
    /// of (3.13).
    #[inline(always)]
    pub(crate) fn guess(&self) -> G::Vector {
        if G::Scalar::LANES > 1 {
            return self.half_guess;
        }
        let mut left = G::DIMENSION;
        self.half_guess.zip(&self.half_guess, &mut |component, _| {
            left -= 1;
            if left == 0 { core::hint::black_box(component) } else { component }
        })
    }

    /// What is done after the first step, and after many more.
    #[cold]
    #[inline(never)]
    fn look(&mut self, spatial: &A, continued: Continued) -> Option<Mask<G::Scalar>> {
        // Before the first step there was no increment but an estimate, which a parabola would go through.
        if self.steps == 0 {
            self.half_guess = self.half;
            if continued == Continued::Parabola {
                self.history = History::new();
            }
        }
        self.restore(spatial)
    }

    /// Whether it is time to look how far roundings have gone.
    #[inline(always)]
    pub(crate) fn is_due(&self) -> bool {
        self.steps.is_multiple_of(u64::from(LOOKS))
    }

    /// Puts the attitude back into the group, and what is advected to what it sees, where roundings have taken it far;
    /// `spatial` is the value `a_0` of what is advected. Returns the lanes in which that was so, if there is one.
    #[cold]
    pub(crate) fn restore(&mut self, spatial: &A) -> Option<Mask<G::Scalar>> {
        let (attitude, far) = self.attitude.restored()?;
        self.attitude = attitude;
        self.advected = spatial.seen_from(&attitude).zip(&self.advected, &mut |seen, w| seen.select(far, w));
        Some(far)
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
