//! The free motion of any body, exactly: elliptic functions in rational form.
//!
//! Let the principal axes `a`, `b`, `c` be right-handed, `J_c` the middle moment, and
//!
//! ```text
//! A = J_c/J_a − 1     B = J_c/J_b − 1     AB ≤ 0     u = (h/2J_c) p, of components a, b, c
//! K_b = −AB c² + A(A − B) a²              K_a = −AB c² + B(B − A) b²              neither negative, and constant
//! ```
//!
//! and `℘` the elliptic function of Weierstrass whose roots are `0`, `K_b`, `K_a` up to their mean. In units of half
//! the drift, `n = ℘ − e_c` and `μ = −℘′`, where `μ² = 4 n (n − K_b)(n − K_a)`. With
//!
//! ```text
//! N = n² − K_a K_b      C = N − 2 K_b (n − K_a)      D = N − 2 K_a (n − K_b)      M = N² + AB μ² c²
//!
//! M a⁺ = a D N − B μ b c C      M b⁺ = b C N + A μ a c D      M c⁺ = c C D + (B − A) μ a b N
//! F_a = the rotation of the quaternion (μ (n M − AB c · M c⁺)/N, A (M a + M a⁺), B (M b + M b⁺), 0)
//! n M − AB c · M c⁺ = N (n N + AB c (c (C + D + N) − (B − A) μ a b))
//! ```
//!
//! Here `F_a p⁺ = p`, and the rest of the motion is a turn about the momentum,
//!
//! ```text
//! F = exp(2 (1 + I) û) F_a            I = AB (A a² + B b²) ∫₀¹ dz/(℘(z) − e_c + AB |u|²)
//! ```
//!
//! All expressions are even or polynomial in the quantities that may vanish: symmetric and spherical bodies, the
//! separatrix and spins about an axis are no special cases. As the middle moment is the third, `A a² + B b²` is the
//! only sum with terms of both signs.
//!
//! [`series`] has the functions for short drifts. Up to four times that length they are doubled as points of the curve
//! of `n` and `μ`, and [`doubling`] extends them to any length.

mod doubling;
mod frame;
mod linearised;
mod reverse;
mod series;

use nalgebra::{Matrix3, SimdBool as _, Vector3};

use self::frame::Frame;
use self::series::{Functions, Invariants, LONG, SHORT, long, short};
use super::axes::Axes;
use super::kinetic_flow::{KineticFlow, Turn};
use super::quaternion::{Quaternion, increment, product_across};
use crate::error::{SetupError, StepError};
use crate::groups::rotation_coefficients;
use crate::groups::{LieGroup as _, SO3};
use crate::mechanics::{Inertia, Operations, SceneVisitor};
use crate::numbers::{Kernel, Number, Numbers, Real, Vectors, dispatch, is_finite, reported};

/// The free motion of a body with any three moments, exact to rounding over any time.
///
/// No equation is solved. A drift of up to a radian takes no square root, and only one sine and cosine, for symmetric
/// and asymmetric bodies alike. Between kicks it leaves no error but that of the scheme. In a scene without potential a
/// step of any length is the exact motion, at a cost that grows only logarithmically with its length.
///
/// # Rounding
///
/// Over an angle `θ` of up to a radian, `F − I` and the momentum are within `8 (1 + θ)` units in the last place of
/// their largest entry. Beyond, the motion itself amplifies a change of the momentum, and the units by the same factor:
/// some `θ`, and exponentially more near the separatrix, where a motion stays at the middle axis for a time.
///
/// # Frame and units
///
/// Body axes, which may differ from the principal ones; the inertia in kg m², momenta in kg m²/s.
///
/// # Derivatives
///
/// There are six [parameters](crate::gradients::Linearisation::parameters). The six entries of the inertia don't serve:
/// if two moments are equal, the axes have no derivative with respect to an off-diagonal entry.
///
/// - Three with the name `moment`, kg m². If the body's axes are the principal ones, they are in the order of these;
///   otherwise the largest is the first and the middle one the last.
/// - Three with the name `turn`, rad: a small turn `t` of the principal axes about the body's three, `δJ = t̂ J − J t̂`.
///   Their values are zero.
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
/// The equations stand at the head of this type's source file; the coefficients of `℘` are in \[AS64, 18.5\]. See
/// [`conventions`](crate::conventions).
#[derive(Clone, Copy, Debug, PartialEq, Lanes, InLanes)]
pub struct ExactBody<T = f64> {
    inertia: Matrix3<T>,
    /// The moments about the three principal axes, the middle moment last.
    moments: Numbers<T, 3>,
    frame: Frame<T>,
}

impl<T: Real> ExactBody<T> {
    /// The body with this inertia about the pivot.
    #[must_use]
    pub fn new(inertia: &Inertia<T>) -> Self {
        let inertia = *inertia.as_matrix();
        let (moments, frame) = Frame::of(&inertia);
        Self { inertia, moments: Numbers(moments), frame }
    }
}

/// The flow over one share of the step.
#[derive(Clone, Copy, Debug, Lanes)]
pub struct ExactDrift<T> {
    frame: Frame<T>,
    form: Form<T>,
}

/// The constants of a drift in the principal axes.
#[derive(Clone, Copy, Debug, Lanes)]
struct Form<T> {
    /// The factor `h/(2 J_c)` from the momentum to `u`.
    scale: T,
    a: T,
    b: T,
    b_less_a: T,
    /// The products `−AB`, `A (A − B)` and `B (B − A)`; none is negative.
    c_squared: T,
    a_squared: T,
    b_squared: T,
}

impl<T: Real> KineticFlow<T> for ExactBody<T> {
    type Drift = ExactDrift<T>;

    const EXACT: bool = true;

    // The count is for the shorter polynomials.
    const OPERATIONS: Operations = Operations { step: 232, iteration: 0 };

    fn describe(flow: &Self, visitor: &mut dyn SceneVisitor<T>) {
        visitor.term("exact flow of a body");
        for (row, column) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
            visitor.parameter("inertia", flow.inertia[(row, column)]);
        }
    }

    fn inertia(flow: &Self) -> Matrix3<T> {
        flow.inertia
    }

    #[hot]
    fn has_principal_axes(flow: &Self) -> bool {
        matches!(flow.frame, Frame::Along(_))
    }

    fn drift(&self, h: T) -> Result<Self::Drift, SetupError> {
        let form = Form::of(self.moments.0, h);
        if !is_finite(form.scale + form.a_squared + form.b_squared) {
            return Err(SetupError::InvalidStep { step: reported(h) });
        }
        Ok(ExactDrift { frame: self.frame, form })
    }

    /// The order of the axes is selected once: code without branches for each order is faster than code that branches
    /// twice.
    #[hot]
    fn advance(drift: &Self::Drift, momentum: &Vector3<T>) -> Result<Turn<T>, StepError> {
        use Axes::{Xyz, Yzx, Zxy};
        Ok(match &drift.frame {
            Frame::Along(Xyz) => drift.turn(&Frame::Along(Xyz), momentum),
            Frame::Along(Yzx) => drift.turn(&Frame::Along(Yzx), momentum),
            Frame::Along(Zxy) => drift.turn(&Frame::Along(Zxy), momentum),
            other => drift.turn(other, momentum),
        })
    }
}

/// The functions at half a drift.
#[derive(Clone, Copy, Debug)]
struct Half<T> {
    n: T,
    mu: T,
    /// The turn about the momentum over the whole drift.
    about: About<T>,
}

impl<T: Number> Half<T> {
    #[hot]
    fn select(&self, mask: T::Mask, other: &Self) -> Self {
        let about = self.about.select(mask, &other.about);
        Self { n: self.n.select(mask, other.n), mu: self.mu.select(mask, other.mu), about }
    }
}

/// A quaternion `(w, f u)` along the momentum, of any length.
#[derive(Clone, Copy, Debug)]
struct About<T> {
    w: T,
    f: T,
}

#[hot]
impl<T: Number> About<T> {
    /// The turn `exp(2û)`, for `|u|² = q`.
    fn turn(q: T) -> Self {
        let (sinc, versine) = rotation_coefficients(q);
        Self { w: T::one() - q * versine, f: sinc }
    }

    /// The composition of both turns.
    fn and(&self, other: &Self, q: T) -> Self {
        Self { w: self.w * other.w - self.f * other.f * q, f: self.w * other.f + self.f * other.w }
    }

    /// The quaternion of this turn applied after `across`, a quaternion of any length without a part along the middle
    /// axis.
    fn by(&self, [a, b, c]: [T; 3], across: [T; 3]) -> Quaternion<T> {
        product_across([self.w, self.f * a, self.f * b, self.f * c], across)
    }

    fn select(&self, mask: T::Mask, other: &Self) -> Self {
        Self { w: self.w.select(mask, other.w), f: self.f.select(mask, other.f) }
    }
}

impl<T: Real> ExactDrift<T> {
    #[hot]
    fn turn(&self, frame: &Frame<T>, momentum: &Vector3<T>) -> Turn<T> {
        let increment = increment(frame.back(self.form.turned(frame.within(&(momentum * self.form.scale)))));
        let change = SO3::adjoint_transpose_increment(&increment, momentum);
        Turn { increment, change, iterations: 0 }
    }
}

#[hot]
impl<T: Number> Form<T> {
    /// The form for the moments about the three axes, the middle one last, and the duration, s.
    #[inline]
    fn of([of_a, of_b, of_c]: [T; 3], h: T) -> Self {
        // The differences come first, without cancellation.
        let (a, b) = ((of_c - of_a) / of_a, (of_c - of_b) / of_b);
        let (scale, b_less_a) = (h * T::number(0.5) / of_c, b - a);
        let (a_squared, b_squared) = (-(a * b_less_a), b * b_less_a);
        Self { scale, a, b, b_less_a, c_squared: -(a * b), a_squared, b_squared }
    }

    fn invariants(&self, [a, b, c]: [T; 3]) -> Invariants<T> {
        let (aa, bb, cc) = (a * a, b * b, c * c);
        let of_c = self.c_squared * cc;
        let (of_a, of_b) = (self.a_squared * aa, self.b_squared * bb);
        Invariants { kb: of_c + of_a, ka: of_c + of_b, apart: of_a - of_b, pole: self.c_squared * (cc + (aa + bb)) }
    }

    /// The sum `A a² + B b²`: zero on the separatrix and for spherical bodies.
    fn difference(&self, [a, b, _]: [T; 3]) -> T {
        self.a * (a * a) + self.b * (b * b)
    }

    /// The quaternion of the drift, of any length, for `u`.
    fn turned(&self, u: [T; 3]) -> Quaternion<T> {
        let invariants = self.invariants(u);
        let size = invariants.size();
        let (is_short, is_long) = (size.simd_le(T::number(SHORT)), size.simd_le(T::number(LONG)));
        if is_short.all() {
            self.whole(u, &invariants, &self.near::<true>(u, &invariants))
        } else if !is_short.any() && is_long.all() {
            self.whole(u, &invariants, &self.near::<false>(u, &invariants))
        } else {
            // Arguments and result are passed by value, so that the other branches can stay in registers.
            let [a, b, c] = u;
            let [w, x, y, z] = self.beyond(a, b, c);
            [w, x, y, z]
        }
    }

    /// Half the drift by the polynomials, for durations in their range.
    fn near<const IS_SHORT: bool>(&self, u: [T; 3], invariants: &Invariants<T>) -> Half<T> {
        let start = invariants.start();
        let Functions { n, mu, integral } = if IS_SHORT { short(&start) } else { long(&start) };
        let less = (self.c_squared * self.difference(u)) * integral;
        Half { n, mu, about: turn_and_less::<IS_SHORT, T>(dot(u), less) }
    }

    /// The whole drift from the functions at half of it.
    ///
    /// The duration is that of the chain of operations from the momentum to the increment. So there is no division
    /// before its end, and sums begin with the terms that are known first.
    fn whole(&self, u: [T; 3], invariants: &Invariants<T>, half: &Half<T>) -> Quaternion<T> {
        let ([a, b, c], Invariants { kb, ka, .. }, Half { n, mu, about }) = (u, *invariants, *half);
        let (nn, kk, twice) = (n * n, kb * ka, n + n);
        let (base, sum) = (nn - kk, nn + kk);
        let (of_b, of_a) = (sum - kb * twice, sum - ka * twice);
        let mu_c = (self.c_squared * c) * mu;
        let den = base * base - (mu_c * c) * mu;
        let real_part = (n * base) * mu - mu_c * (c * ((of_a + of_b) + base) - (self.b_less_a * (a * b)) * mu);
        let along_a = (self.a * a) * (den + of_a * base) + mu_c * (b * of_b);
        let along_b = (self.b * b) * (den + of_b * base) - mu_c * (a * of_a);
        about.by(u, [real_part, along_a, along_b])
    }

    /// Half a drift that is `2^DOUBLINGS` times as long as the range of the polynomials.
    ///
    /// The points of the curve `μ² = 4 n (n − K_a)(n − K_b)` have rational doubling formulas. The turn about the
    /// momentum is twice that at half the time, followed by one from the tangent to the curve at the point; see
    /// [`doubling`].
    fn farther<const DOUBLINGS: usize>(&self, u: [T; 3], invariants: &Invariants<T>) -> Half<T> {
        let k = T::number;
        let (difference, q) = (self.difference(u), dot(u));
        let bend = self.c_squared * difference;
        let mut root = k([1.0, 0.5, 0.25][DOUBLINGS]);
        let mut part = root * root;
        let Functions { mut n, mut mu, integral } = long(&invariants.scaled(part).start());
        let less = bend * part * integral;
        let mut about = About { w: T::one(), f: T::zero() };
        for doubled in 0..DOUBLINGS {
            let Invariants { kb, ka, pole, .. } = invariants.scaled(part);
            let (past_b, past_a) = (n - kb, n - ka);
            let towards = (self.b * past_b + self.a * past_a) * (difference * part);
            let tangent = (past_b * past_a) * (n - pole) + n * towards;
            let tangent = About { w: tangent, f: -((bend * part * root) * mu) };
            about = if doubled == 0 { tangent } else { about.and(&about, q).and(&tangent, q) };
            let over = T::one() / mu;
            let (nn, kk) = (n * n, kb * ka);
            let (base, sum) = (nn - kk, nn + kk);
            let (of_b, of_a) = (sum - (kb + kb) * n, sum - (ka + ka) * n);
            mu = (k(16.0) * base) * (of_a * of_b) * (over * (over * over));
            n = k(4.0) * ((base * over) * (base * over));
            (root, part) = (root + root, part * k(4.0));
        }
        Half { n, mu, about: turn_and_less::<false, T>(q, less).and(&about, q) }
    }

    #[inline(never)]
    fn beyond(&self, a: T, b: T, c: T) -> Quaternion<T> {
        dispatch(Beyond { form: self, u: [a, b, c] })
    }
}

/// A drift of lanes beyond the polynomials' range, or in different ranges. It isn't inlined, so it dispatches to the
/// machine's vector instructions itself; the longest drifts, which are a single loop, do without.
struct Beyond<'a, T> {
    form: &'a Form<T>,
    u: [T; 3],
}

impl<T: Number> Kernel for Beyond<'_, T> {
    type Output = Quaternion<T>;
    const VECTORS: Vectors = Vectors::Four;
    const IS_IN_LANES: bool = true;

    #[hot]
    fn run(self) -> Quaternion<T> {
        let Self { form, u } = self;
        let invariants = &form.invariants(u);
        let size = invariants.size();
        let [is_short, is_long, is_far, is_farther] =
            [SHORT, LONG, FAR, FARTHER].map(|limit| size.simd_le(T::number(limit)));
        let mut half = Half { n: T::one(), mu: T::one(), about: About { w: T::one(), f: T::one() } };
        if (is_farther & !is_far).any() {
            half = form.farther::<2>(u, invariants);
        }
        if (is_far & !is_long).any() {
            half = form.farther::<1>(u, invariants).select(is_far, &half);
        }
        if (is_long & !is_short).any() {
            half = form.near::<false>(u, invariants).select(is_long, &half);
        }
        if is_short.any() {
            half = form.near::<true>(u, invariants).select(is_short, &half);
        }
        let turned = form.whole(u, invariants, &half);
        if is_farther.all() {
            return turned;
        }
        let doubled = form.doubled(u, invariants);
        core::array::from_fn(|k| turned[k].select(is_farther, doubled[k]))
    }
}

/// Limits up to which one and two doublings of the polynomials suffice.
const FAR: f64 = 4.0 * LONG;
const FARTHER: f64 = 16.0 * LONG;

/// A multiple of `exp(2 (1 + I) û)`, for `|u|² = q` and a small `less = −I`. The turn by `u` needn't wait for `I`, and
/// the turn by `I u` is computed from its tangent. `I |u|` is less than 0.006, in a short drift less than 10⁻⁴, so few
/// terms suffice.
#[hot]
fn turn_and_less<const IS_SHORT: bool, T: Number>(q: T, less: T) -> About<T> {
    let About { w, f } = About::turn(q);
    let square = (less * less) * q;
    let of_tangent = T::number(1.0 / 3.0);
    let of_tangent = if IS_SHORT { of_tangent } else { of_tangent + square * T::number(2.0 / 15.0) };
    let tangent = less + (less * square) * of_tangent;
    About { w: w + (f * q) * tangent, f: f - w * tangent }
}

/// The square `|u|²`.
#[hot]
fn dot<T: Number>([a, b, c]: [T; 3]) -> T {
    (a * a + b * b) + c * c
}
