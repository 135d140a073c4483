//! The free motion of any body, exactly: elliptic functions in rational form.
//!
//! With the principal axes `a`, `b`, `c` right-handed and `J_c` the middle moment, let
//!
//! ```text
//! A = J_c/J_a − 1     B = J_c/J_b − 1     AB ≤ 0     u = (h/2J_c) p, of components a, b, c
//! K_b = −AB c² + A(A − B) a²              K_a = −AB c² + B(B − A) b²              neither negative, and constant
//! ```
//!
//! and `℘` the elliptic function of Weierstrass whose roots are `0`, `K_b`, `K_a` but for their mean. In units of half
//! the drift, `n = ℘ − e_c` and `μ = −℘′`, where `μ² = 4 n (n − K_b)(n − K_a)`. With
//!
//! ```text
//! N = n² − K_a K_b      C = N − 2 K_b (n − K_a)      D = N − 2 K_a (n − K_b)      M = N² + AB μ² c²
//!
//! M a⁺ = a D N − B μ b c C      M b⁺ = b C N + A μ a c D      M c⁺ = c C D + (B − A) μ a b N
//! F_a = the rotation of the quaternion (μ (n M − AB c · M c⁺), N A (M a + M a⁺), N B (M b + M b⁺), 0)
//! ```
//!
//! `F_a p⁺ = p`, and what is left of the motion is a turn about the momentum,
//!
//! ```text
//! F = exp(2 (1 + I) û) F_a            I = AB (A a² + B b²) ∫₀¹ dz/(℘(z) − e_c + AB |u|²)
//! ```
//!
//! All of it is even or polynomial in what may vanish: symmetric and spherical bodies, the separatrix and spins about an
//! axis are no cases of their own, and with the middle moment third no sum but `A a² + B b²` has terms of two signs.
//!
//! [`series`] has the functions where the drift is short, [`doubling`] takes them to any length.

mod doubling;
mod frame;
mod series;

use nalgebra::{Matrix3, SimdBool as _, Vector3};

use self::frame::Frame;
use self::series::{Functions, Invariants, LONG, SHORT, long, short};
use super::kinetic_flow::{KineticFlow, Turn};
use super::quaternion::{Quaternion, product_across, scaled_increment};
use crate::error::{SetupError, StepError};
use crate::groups::rotation_coefficients;
use crate::groups::{LieGroup as _, SO3};
use crate::mechanics::{Inertia, Operations, SceneVisitor};
use crate::numbers::{Mask, Real, is_finite, lanes_of_fields, real, reported};

/// The free motion of a body with any three moments, exactly: to rounding, over any time.
///
/// There is nothing to solve. Up to a radian it takes no square root, and the sine and cosine of one rotation, the same
/// for symmetric and asymmetric bodies. Between kicks it leaves no error but that of the scheme; with a scene that has no potential a step of any
/// length is the motion itself, and a longer one costs no more than the logarithm of its length.
///
/// # Rounding
///
/// Over an angle `θ` of up to a radian `F − I` and the momentum are within `8 (1 + θ)` units in the last place of their
/// largest entry. Beyond, the units are multiplied by what the motion itself makes of a change of the momentum: some `θ`,
/// and near the separatrix, where a motion stays at the middle axis for a time, exponentially more.
///
/// # Frame and units
///
/// Body axes, which needn't be the principal ones; the inertia in kg m², momenta in kg m²/s.
///
/// # Examples
///
/// A free body in one step of a minute, and back.
///
/// ```
/// use liestep::effects::PrincipalBody;
/// use liestep::mechanics::{DiagonalNonstandardInertia, Inertia};
/// use liestep::methods::{ExactBody, SplittingScheme};
/// use liestep::{SO3, Stepper};
/// use nalgebra::Vector3;
///
/// let moments = Vector3::new(1.0, 2.0, 2.5);
/// let body = PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(moments)? };
/// let flow = ExactBody::new(&Inertia::from_principal_moments(moments)?);
/// let stepper = Stepper::split(body, 60.0, flow, SplittingScheme::STRANG)?;
/// let mut state = stepper.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02))?;
/// let (energy, momentum): (f64, _) = (stepper.energy(&state), stepper.spatial_momentum(&state));
/// stepper.step(&mut state)?;
/// assert!((stepper.energy(&state) / energy - 1.0).abs() < 1e-14);
/// assert!((stepper.spatial_momentum(&state) - momentum).norm() < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Source
///
/// The equations are those of the page of this flow in the sources; the coefficients of `℘` are in \[AS64, 18.5\]. See
/// [`conventions`](crate::conventions).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactBody<T = f64> {
    inertia: Matrix3<T>,
    /// About the three axes, the last the middle one.
    moments: [T; 3],
    frame: Frame<T>,
}

impl<T: Real> ExactBody<T> {
    /// The body with this inertia about the pivot.
    #[must_use]
    pub fn new(inertia: &Inertia<T>) -> Self {
        let inertia = *inertia.as_matrix();
        let (moments, frame) = Frame::of(&inertia);
        Self { inertia, moments, frame }
    }
}

/// The flow over one share of the step.
#[derive(Clone, Copy, Debug)]
pub struct ExactDrift<T> {
    frame: Frame<T>,
    /// `h/(2 J_c)`, which makes `u` of the momentum.
    scale: T,
    a: T,
    b: T,
    b_less_a: T,
    /// `−AB`, `A (A − B)` and `B (B − A)`, none negative.
    c_squared: T,
    a_squared: T,
    b_squared: T,
}

lanes_of_fields!(
    impl[T: Real<Element: Real>] ExactBody<T> => ExactBody<T::Element>, as ExactBody
    { lanes: [inertia, moments, frame], scalars: [], shared: [] }
);

lanes_of_fields!(
    impl[T: Real<Element: Real>] ExactDrift<T> => ExactDrift<T::Element>, as ExactDrift
    { lanes: [frame], scalars: [scale, a, b, b_less_a, c_squared, a_squared, b_squared], shared: [] }
);

impl<T: Real> KineticFlow<T> for ExactBody<T> {
    type Drift = ExactDrift<T>;

    const EXACT: bool = true;

    // With the shorter polynomials.
    const OPERATIONS: Operations = Operations { step: 270, iteration: 0 };

    fn describe(flow: &Self, visitor: &mut dyn SceneVisitor<T>) {
        visitor.term("exact flow of a body");
        for (row, column) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
            visitor.parameter("inertia", flow.inertia[(row, column)]);
        }
    }

    fn inertia(flow: &Self) -> Matrix3<T> {
        flow.inertia
    }

    fn drift(&self, h: T) -> Result<Self::Drift, SetupError> {
        let [of_a, of_b, of_c] = self.moments;
        // Without cancellation.
        let (a, b) = ((of_c - of_a) / of_a, (of_c - of_b) / of_b);
        let (scale, b_less_a) = (h * real(0.5) / of_c, b - a);
        let (a_squared, b_squared) = (-(a * b_less_a), b * b_less_a);
        if !is_finite(scale + a_squared + b_squared) {
            return Err(SetupError::InvalidStep { step: reported(h) });
        }
        Ok(ExactDrift { frame: self.frame, scale, a, b, b_less_a, c_squared: -(a * b), a_squared, b_squared })
    }

    #[inline(always)]
    fn advance(drift: &Self::Drift, momentum: &Vector3<T>) -> Result<Turn<T>, StepError> {
        let u = drift.frame.within(&(momentum * drift.scale));
        let invariants = drift.invariants(u);
        let size = invariants.size();
        let is_short = size.simd_le(real(SHORT));
        let turned = if is_short.all() {
            drift.near(u, &invariants, &short(&invariants))
        } else if !is_short.any() && size.simd_le(real(LONG)).all() {
            drift.near(u, &invariants, &long(&invariants))
        } else {
            drift.beyond(u, &invariants)
        };
        let increment = scaled_increment(drift.frame.back(turned.quaternion)) * turned.inverse_square;
        let change = SO3::adjoint_transpose_increment(&increment, momentum);
        Ok(Turn { increment, change, iterations: 0 })
    }
}

impl<T: Real> ExactDrift<T> {
    #[inline(always)]
    fn invariants(&self, [a, b, c]: [T; 3]) -> Invariants<T> {
        let (aa, bb, cc) = (a * a, b * b, c * c);
        let of_c = self.c_squared * cc;
        let (kb, ka) = (of_c + self.a_squared * aa, of_c + self.b_squared * bb);
        Invariants { kb, ka, pole: self.c_squared * (cc + (aa + bb)) }
    }

    /// `A a² + B b²`: zero on the separatrix and for spherical bodies.
    #[inline(always)]
    fn difference(&self, [a, b, _]: [T; 3]) -> T {
        self.a * (a * a) + self.b * (b * b)
    }

    /// Where the functions are those of half the drift.
    ///
    /// What takes the time is the chain from the momentum to the increment, so nothing is divided before the end of it.
    #[inline(always)]
    fn near(&self, u: [T; 3], invariants: &Invariants<T>, functions: &Functions<T>) -> Turned<T> {
        let [a, b, c] = u;
        let Invariants { kb, ka, .. } = *invariants;
        let Functions { n, mu, integral } = *functions;
        let base = n * n - kb * ka;
        let of_b = base - (kb + kb) * (n - ka);
        let of_a = base - (ka + ka) * (n - kb);
        let den = base * base - (self.c_squared * (c * c)) * (mu * mu);
        let a_end = (a * of_a) * base - (self.b * (b * c)) * (mu * of_b);
        let b_end = (b * of_b) * base + (self.a * (a * c)) * (mu * of_a);
        let c_end = c * (of_a * of_b) + (self.b_less_a * (a * b)) * (mu * base);
        let real_part = mu * (n * den + (self.c_squared * c) * c_end);
        let along_a = (self.a * base) * (a * den + a_end);
        let along_b = (self.b * base) * (b * den + b_end);
        let more = -(self.c_squared * self.difference(u)) * integral;
        Turned::of(rotor_and_more(u, more), [real_part, along_a, along_b])
    }

    /// Where a lane is beyond the polynomials, or some need the longer ones and some don't.
    #[cold]
    #[inline(never)]
    fn beyond(&self, u: [T; 3], invariants: &Invariants<T>) -> Turned<T> {
        let size = invariants.size();
        let (is_short, is_long) = (size.simd_le(real(SHORT)), size.simd_le(real(LONG)));
        let mut chosen = if is_long.all() { Turned::none() } else { self.doubled(u, invariants) };
        if is_long.any() {
            chosen = self.near(u, invariants, &long(invariants)).select(is_long, &chosen);
        }
        if is_short.any() {
            chosen = self.near(u, invariants, &short(invariants)).select(is_short, &chosen);
        }
        chosen
    }
}

/// `exp(2 (1 + I) û)` as a quaternion, where `I` is small: `I |u|` is less than a third of the invariants' size to the
/// power of 3/2, so that few terms of its sine and cosine do, and those of `|u|` needn't wait for it.
#[inline(always)]
fn rotor_and_more<T: Real>([a, b, c]: [T; 3], more: T) -> Quaternion<T> {
    let q = (a * a + b * b) + c * c;
    let (sinc, versine) = rotation_coefficients(q);
    let cosine = T::one() - q * versine;
    let (sinc_q, square) = (sinc * q, (more * more) * q);
    let less = square * (real::<T>(0.5) - square * real(1.0 / 24.0));
    let more = more - (more * square) * real(1.0 / 6.0);
    let f = sinc + (cosine * more - sinc * less);
    [cosine - (cosine * less + sinc_q * more), f * a, f * b, f * c]
}

/// `exp(2v̂)` as a quaternion.
#[inline(always)]
fn rotor<T: Real>([x, y, z]: [T; 3]) -> Quaternion<T> {
    let q = (x * x + y * y) + z * z;
    let (sinc, versine) = rotation_coefficients(q);
    [T::one() - q * versine, sinc * x, sinc * y, sinc * z]
}

/// A rotation by a quaternion of any length.
#[derive(Clone, Copy, Debug)]
struct Turned<T> {
    quaternion: Quaternion<T>,
    /// One over the square of its length.
    inverse_square: T,
}

impl<T: Real> Turned<T> {
    fn none() -> Self {
        Self { quaternion: [T::one(), T::zero(), T::zero(), T::zero()], inverse_square: T::one() }
    }

    /// A rotation about the momentum, of length one to some roundings, after one across the middle axis, of any.
    #[inline(always)]
    fn of(about: Quaternion<T>, across: [T; 3]) -> Self {
        let ([w, x, y, z], [real_part, along_a, along_b]) = (about, across);
        // What roundings do to the one is divided out, too: the rotation may be the same in each step.
        let excess = ((w * w - T::one()) + x * x) + (y * y + z * z);
        let square = (along_a * along_a + along_b * along_b) + real_part * real_part;
        // The division needn't wait for the excess.
        let inverse = T::one() / square;
        Self { quaternion: product_across(about, across), inverse_square: inverse - inverse * excess }
    }

    fn select(&self, mask: Mask<T>, other: &Self) -> Self {
        let quaternion = core::array::from_fn(|k| self.quaternion[k].select(mask, other.quaternion[k]));
        Self { quaternion, inverse_square: self.inverse_square.select(mask, other.inverse_square) }
    }
}
