//! The stepper of a chain.

use core::array::from_fn;

use nalgebra::{Matrix3, Vector3};

// Roots and powers without a standard library.
#[cfg(not(feature = "std"))]
use nalgebra::ComplexField as _;

use super::elimination::{Updated, Work, momenta_of_velocities, newton, outwards, simplified};
use super::{Chain, Link, ROUNDED};
use crate::error::{SetupError, StepError};
use crate::groups::{LieGroup, SO3};
use crate::motion::{Integrator, Motion, State, StepReport, is_due};
use crate::numbers::{Bodies, Kernel, Vectors, dispatch};
use crate::solving::{Curvature, LONGEST_DAMPED, MAX_DAMPED_ITERATIONS, MAX_ITERATIONS};

/// The square of half the Cayley coordinates up to which a guess is continued from three steps, 67°: they grow without
/// bound towards 180°, and a wanted solution is below 90°, where the square is one.
const CONTINUED: f64 = 4.0 / 9.0;

/// The state of a chain: attitudes, body momenta, and the last increments.
type ChainState<const N: usize> = State<[SO3; N], (), ChainMemory<N>>;

/// What a [`ChainStepper`] keeps from step to step: of each link half the coordinates of the last increments, by which
/// the next are guessed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct ChainMemory<const N: usize> {
    last: [[Vector3<f64>; 3]; N],
    /// How many there are.
    known: usize,
}

/// An integrator of a [`Chain`] with a fixed step, in the minimal form on SO(3)ᴺ: of second order, symmetric and
/// symplectic. A step takes time proportional to `N`.
///
/// # Contract
///
/// - Joints don't open: attitudes are all there is.
/// - The momentum about the vertical is kept to rounding.
/// - A step satisfies its momentum equations to rounding, or is an error that leaves the state as it was; it names a link
///   where one is to blame.
/// - Nothing is allocated. A chain of `N` links takes about `2 N` kB of stack.
///
/// # Examples
///
/// ```
/// use liestep::methods::{Chain, ChainStepper, Link};
/// use liestep::numbers::Bodies;
/// use liestep::{NonstandardInertia, SO3};
/// use nalgebra::{Matrix3, Vector3};
///
/// // Rods of one metre, of one kilogram, that hang along their axis.
/// let J_d = NonstandardInertia::from_diagonal(Vector3::new(1e-3, 1e-3, 1.0 / 3.0))?;
/// let link = Link { J_d, m: 1.0, c: Vector3::new(0.0, 0.0, -0.5), rho: Vector3::new(0.0, 0.0, -1.0) };
/// let stepper = ChainStepper::new(Chain { links: [link; 5], g: 9.81, up: Vector3::z() }, 0.01)?;
/// let tilted = SO3::from_euler_angles(0.0, 1.0, 0.0);
/// let mut state = stepper.start([tilted; 5], Bodies([Vector3::new(0.0, 0.2, 0.0); 5]))?;
/// let (energy, vertical) = (stepper.energy(&state), stepper.vertical_momentum(&state));
/// stepper.run(&mut state, 1000)?;
/// assert!((stepper.energy(&state) - energy).abs() < 1e-2 * energy.abs());
/// assert!((stepper.vertical_momentum(&state) - vertical).abs() < 1e-11);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Source
///
/// The equations are (2.7) and (2.9) of \[RDAE\] for the Lagrangian of [`Chain`], relative attitudes being advected;
/// the minimal form is that of the authors of \[LML05\], the elimination that of Featherstone's articulated bodies.
#[derive(Clone, Debug)]
pub struct ChainStepper<const N: usize> {
    chain: Chain<N>,
    h: f64,
    weights: [Vector3<f64>; N],
}

impl<const N: usize> ChainStepper<N> {
    /// Checks the parameters and the step, s. A negative step is the inverse map; `h = 0` is the identity.
    ///
    /// # Errors
    ///
    /// [`SetupError::BodyParameter`] names the link whose parameters can't be used; [`SetupError::Parameter`] for those
    /// of the chain, [`SetupError::InvalidStep`] for a step that isn't finite or whose inverse isn't.
    pub fn new(chain: Chain<N>, h: f64) -> Result<Self, SetupError> {
        const { assert!(N > 0, "a chain has a link") };
        chain.validate()?;
        if !h.is_finite() || (h != 0.0 && !(1.0 / h).is_finite()) {
            return Err(SetupError::InvalidStep { step: h });
        }
        Ok(Self { chain, h, weights: chain.weights() })
    }

    /// The chain.
    #[must_use]
    pub const fn chain(&self) -> &Chain<N> {
        &self.chain
    }

    /// The step, s.
    #[must_use]
    pub const fn step_size(&self) -> f64 {
        self.h
    }

    /// A motion from the links' attitudes (to space) and body velocities, rad/s.
    ///
    /// # Errors
    ///
    /// [`SetupError`] where an attitude isn't a rotation or something isn't finite.
    pub fn start(&self, attitudes: [SO3; N], velocities: Bodies<Vector3<f64>, N>) -> Result<ChainState<N>, SetupError> {
        if !velocities.0.iter().flatten().copied().all(f64::is_finite) {
            return Err(SetupError::NonFinite { what: "velocity" });
        }
        let mut work = self.placed(&attitudes);
        for (work, velocity) in work.iter_mut().zip(&velocities.0) {
            work.half = *velocity;
        }
        momenta_of_velocities(&mut work);
        self.start_with_momentum(attitudes, Bodies(from_fn(|k| work[k].target)))
    }

    /// A motion from the links' attitudes and the conjugate momenta `μ_a`, kg m²/s in their axes: what each link has to do
    /// with it that those beyond it move, too.
    ///
    /// # Errors
    ///
    /// [`SetupError`] where an attitude isn't a rotation or something isn't finite.
    pub fn start_with_momentum(
        &self,
        attitudes: [SO3; N],
        momentum: Bodies<Vector3<f64>, N>,
    ) -> Result<ChainState<N>, SetupError> {
        // NaN isn't allowed either, whichever link has it.
        let is_allowed = |defect: &f64| *defect <= ROUNDED;
        if let Some(defect) = attitudes.iter().map(LieGroup::defect).find(|defect| !is_allowed(defect)) {
            return Err(SetupError::NotInGroup { defect });
        }
        if !momentum.0.iter().flatten().copied().all(f64::is_finite) {
            return Err(SetupError::NonFinite { what: "momentum" });
        }
        Ok(self.adopt(&Motion { attitude: attitudes, momentum, advected: (), steps: 0 }))
    }

    /// One step. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// [`StepError::UnsolvedBody`] names the link that has no increment, [`StepError::NotConverged`] where none stands out;
    /// [`StepError::NonFinite`] where a momentum after the step isn't finite.
    pub fn step(&self, state: &mut ChainState<N>) -> Result<StepReport, StepError> {
        let mut work = [Work::NONE; N];
        match dispatch(self.moving(state, &mut work)) {
            Ok(iterations) => Ok(StepReport::of(iterations)),
            Err(NoStep::Unsolved(iterations)) => {
                let mut slow = work;
                at_rest(&mut slow);
                first_of_newton(&mut slow);
                Err(reason(&work, &slow, iterations))
            }
            Err(NoStep::NotFinite) => Err(StepError::NonFinite { what: "momentum after the step" }),
        }
    }

    /// The chain and a state of it, of whatever length.
    pub(super) fn moving<'a>(&'a self, state: &'a mut ChainState<N>, work: &'a mut [Work; N]) -> Moving<'a> {
        Moving {
            links: &self.chain.links,
            weights: &self.weights,
            up: self.chain.up,
            h: self.h,
            attitudes: &mut state.motion.attitude,
            momenta: &mut state.motion.momentum.0,
            steps: &mut state.motion.steps,
            last: &mut state.kept.last,
            known: &mut state.kept.known,
            work,
        }
    }

    /// So many steps; returns all their iterations. On an error the state is unchanged.
    ///
    /// # Errors
    ///
    /// As [`step`](Self::step).
    pub fn run(&self, state: &mut ChainState<N>, steps: u64) -> Result<u64, StepError> {
        let (mut next, mut iterations) = (*state, 0);
        for _ in 0..steps {
            iterations += u64::from(self.step(&mut next)?.iterations);
        }
        *state = next;
        Ok(iterations)
    }

    /// The same motion, of which nothing is kept.
    #[must_use]
    pub fn adopt(&self, motion: &Motion<[SO3; N], ()>) -> ChainState<N> {
        State { motion: *motion, kept: ChainMemory { last: [[Vector3::zeros(); 3]; N], known: 0 } }
    }

    /// The links' body velocities, rad/s.
    #[must_use]
    pub fn velocity(&self, motion: &Motion<[SO3; N], ()>) -> Bodies<Vector3<f64>, N> {
        let mut work = self.placed(&motion.attitude);
        for (k, work) in work.iter_mut().enumerate() {
            work.target = motion.momentum.0[k];
        }
        // Near rest the momenta times `h` are linear in `y`: those of the velocities `2 y`, which one iteration solves for.
        first_of_newton(&mut work);
        Bodies(from_fn(|k| work[k].half * 2.0))
    }

    /// The energy, J; the potential is zero at the height of the pivot.
    #[must_use]
    pub fn energy(&self, motion: &Motion<[SO3; N], ()>) -> f64 {
        let velocity = self.velocity(motion);
        let kinetic: f64 = velocity.0.iter().zip(&motion.momentum.0).map(|(z, momentum)| z.dot(momentum)).sum();
        let height = |(attitude, weight): (&SO3, &Vector3<f64>)| self.chain.up.dot(&(attitude.as_matrix() * weight));
        0.5 * kinetic + motion.attitude.iter().zip(&self.weights).map(height).sum::<f64>()
    }

    /// The momentum of all links about the vertical through the pivot, kg m²/s; it is conserved.
    #[must_use]
    pub fn vertical_momentum(&self, motion: &Motion<[SO3; N], ()>) -> f64 {
        motion.spatial_momentum().0.iter().map(|momentum| momentum.dot(&self.chain.up)).sum()
    }

    /// Where each link's lower joint is in space, m from the pivot.
    #[must_use]
    pub fn joints(&self, motion: &Motion<[SO3; N], ()>) -> [Vector3<f64>; N] {
        let mut place = Vector3::zeros();
        from_fn(|k| {
            place += motion.attitude[k].as_matrix() * self.chain.links[k].rho;
            place
        })
    }

    /// The links at rest.
    fn placed(&self, attitudes: &[SO3; N]) -> [Work; N] {
        let mut work = [Work::NONE; N];
        place(&self.chain.links, attitudes, &mut work);
        work
    }
}

/// The links, with the attitude of each relative to that before.
#[hot]
fn place(links: &[Link], attitudes: &[SO3], work: &mut [Work]) {
    for (link, work) in links.iter().zip(&mut *work) {
        work.set(link);
    }
    for (pair, work) in attitudes.windows(2).zip(work) {
        work.next = pair[0].as_matrix().tr_mul(pair[1].as_matrix());
    }
}

/// A chain of any length, a state of it, and what is known of its next step.
pub(super) struct Moving<'a> {
    links: &'a [Link],
    weights: &'a [Vector3<f64>],
    up: Vector3<f64>,
    h: f64,
    attitudes: &'a mut [SO3],
    momenta: &'a mut [Vector3<f64>],
    steps: &'a mut u64,
    last: &'a mut [[Vector3<f64>; 3]],
    known: &'a mut usize,
    pub(super) work: &'a mut [Work],
}

/// Why there is no step.
pub(super) enum NoStep {
    /// After so many iterations.
    Unsolved(u32),
    /// The momentum after it.
    NotFinite,
}

/// Where an attempt starts.
#[derive(Clone, Copy)]
enum Start {
    Guess,
    Rest,
}

impl Kernel for Moving<'_> {
    type Output = Result<u32, NoStep>;

    const VECTORS: Vectors = Vectors::Four;

    #[hot]
    fn run(mut self) -> Result<u32, NoStep> {
        self.prepare();
        let iterations = if self.h == 0.0 { 0 } else { self.solve()? };
        self.proceed()?;
        Ok(iterations)
    }
}

impl Moving<'_> {
    /// What the increments are to satisfy.
    #[hot]
    pub(super) fn prepare(&mut self) {
        place(self.links, self.attitudes, self.work);
        let links = self.weights.iter().zip(&*self.attitudes).zip(&*self.momenta);
        for (((weight, attitude), momentum), work) in links.zip(&mut *self.work) {
            let w = attitude.as_matrix().tr_mul(&self.up);
            // (h/2) w × g s: the kick before the step.
            work.target = (momentum + w.cross(weight) * (0.5 * self.h)) * self.h;
        }
    }

    /// From the guess, if there is one; where that fails from rest, and then with shortened updates. Returns the
    /// iterations, those of abandoned attempts included.
    #[hot]
    pub(super) fn solve(&mut self) -> Result<u32, NoStep> {
        const ATTEMPTS: [(Start, u32, f64); 3] = [
            (Start::Guess, MAX_ITERATIONS, f64::INFINITY),
            (Start::Rest, MAX_ITERATIONS, f64::INFINITY),
            (Start::Rest, MAX_DAMPED_ITERATIONS, LONGEST_DAMPED),
        ];
        let mut spent = 0;
        // A loop, as `iterate` is inlined where it is called, and is to be compiled once.
        for (start, most, longest) in ATTEMPTS {
            match start {
                Start::Guess if *self.known == 0 => continue,
                Start::Guess => self.guess(),
                Start::Rest => at_rest(self.work),
            }
            let (iterations, is_solved) = iterate(self.work, most, longest);
            spent += iterations;
            if is_solved {
                return Ok(spent);
            }
        }
        Err(NoStep::Unsolved(spent))
    }

    /// The parabola through the last three increments, or as many as there are.
    #[hot]
    fn guess(&mut self) {
        for (work, &[a, b, c]) in self.work.iter_mut().zip(&*self.last) {
            let guess = match self.known {
                1 => a,
                2 => a + (a - b),
                _ => a + (a - b) + ((a - b) - (b - c)),
            };
            // Far from the identity coordinates change too fast to be continued.
            work.half = if guess.norm_squared() < CONTINUED { guess } else { a };
        }
    }

    /// The end of a step with these increments.
    #[hot]
    pub(super) fn proceed(&mut self) -> Result<(), NoStep> {
        let (h, inverse_step) = (self.h, if self.h == 0.0 { 0.0 } else { 1.0 / self.h });
        let (mut beyond, mut sum) = (Vector3::zeros(), 0.0);
        let links = self.weights.iter().zip(&*self.attitudes).zip(&*self.momenta);
        for (((weight, attitude), momentum), work) in links.zip(&mut *self.work).rev() {
            beyond = work.next * beyond;
            let w = attitude.as_matrix().tr_mul(&self.up);
            // The diamond: what moves the links and what weighs on them, turned.
            let kick = (work.of_mc.cross(&work.u) + work.of_rho.cross(&beyond)) * inverse_step
                + w.cross(&(weight + weight + work.increment * weight)) * (0.5 * h);
            beyond += work.momentum();
            // μ⁺ = Fᵀ(μ + κ), (2.9): the change, in the place of the update.
            work.update = kick + work.increment.tr_mul(&(momentum + kick));
            sum += (momentum + work.update).sum();
        }
        if !sum.is_finite() {
            return Err(NoStep::NotFinite);
        }
        *self.steps += 1;
        *self.known = (*self.known + 1).min(3);
        let links = self.attitudes.iter_mut().zip(&mut *self.momenta).zip(&mut *self.last);
        for (((attitude, momentum), last), work) in links.zip(&*self.work) {
            *momentum += work.update;
            *attitude = attitude.advance(&work.increment);
            if is_due(*self.steps) {
                *attitude = orthogonal(attitude);
            }
            *last = [work.half, last[0], last[1]];
        }
        Ok(())
    }
}

fn at_rest(work: &mut [Work]) {
    for work in work {
        work.half = Vector3::zeros();
    }
}

/// The first of Newton's iterations from rest, for links without a `half`: it finds half the velocities of which `target`
/// are the momenta.
#[inline(never)]
fn first_of_newton(work: &mut [Work]) {
    outwards(work);
    newton(work, f64::INFINITY);
}

/// At most so many of Newton's iterations, and what is made with their Jacobians: how many both are, and whether it has
/// settled near the identity with all determinants positive.
///
/// The determinants are those before the last updates. Near a fold that needs no guard: two updates suffice where
/// `2C²|u₁|³ ≤ ε|y|/16`, and the first is longer than `√ε|y|/8`, so `C|u₁| < 1e-4`. The Jacobian changes by twice that of
/// itself, and for another sign it would have to change by all.
#[hot]
fn iterate(work: &mut [Work], most: u32, longest: f64) -> (u32, bool) {
    outwards(work);
    // The last update, if Newton's next is of its second order: of one that was shortened too much is left, and after one
    // with a Jacobian used again what is left is that Jacobian's.
    let (mut made, mut before) = (0, None);
    for _ in 0..most {
        made += 1;
        let Updated { update, size, is_whole } = newton(work, longest);
        if !size.is_finite() {
            break;
        }
        let curvature = Curvature::told(before, update);
        if curvature.has_settled(update, size) {
            return (made, work.iter().all(Work::is_wanted));
        }
        before = is_whole.then_some(update);
        if is_whole && curvature.may_suffice(update, size) {
            let second = simplified(work);
            made += 1;
            if curvature.has_sufficed(update, second.update, second.size) {
                return (made, work.iter().all(Work::is_wanted));
            }
            before = None;
        }
    }
    (made, false)
}

/// Which link is to blame, by where the iteration has ended, and by how far each would turn at its velocity; where it has
/// no values, the one that turns farthest.
fn reason(work: &[Work], slow: &[Work], iterations: u32) -> StepError {
    let blamed = |body: usize| StepError::UnsolvedBody {
        body,
        turn: 2.0 * slow[body].half.norm(),
        determinant: work[body].determinant,
    };
    if !work.iter().all(|work| work.half.norm_squared().is_finite()) {
        let farthest =
            (0..slow.len()).max_by(|&a, &b| slow[a].half.norm_squared().total_cmp(&slow[b].half.norm_squared()));
        return blamed(farthest.unwrap_or(0));
    }
    if let Some(body) = work.iter().position(|work| !work.is_wanted()) {
        return blamed(body);
    }
    let sum = |of: fn(&Work) -> &Vector3<f64>| work.iter().map(|work| of(work).norm_squared()).sum::<f64>();
    let (update, size) = (sum(|work| &work.update), sum(|work| &work.half));
    StepError::NotConverged { iterations, residual: (update / size).sqrt() }
}

/// The rotation next to one that roundings have moved a little, `R (3 I − RᵀR)/2`. What links feel of each other cancels
/// as far as their attitudes are rotations.
fn orthogonal(attitude: &SO3) -> SO3 {
    let r = attitude.as_matrix();
    SO3::from_matrix_unchecked(r + r * (Matrix3::identity() - r.tr_mul(r)) * 0.5)
}

impl<const N: usize> Integrator for ChainStepper<N> {
    type Group = [SO3; N];
    type Advected = ();
    type State = ChainState<N>;

    fn step(&self, state: &mut ChainState<N>) -> Result<StepReport, StepError> {
        Self::step(self, state)
    }

    fn run(&self, state: &mut ChainState<N>, steps: u64) -> Result<u64, StepError> {
        Self::run(self, state, steps)
    }

    fn part(&self, state: &ChainState<N>, fraction: f64) -> Result<Motion<[SO3; N], ()>, StepError> {
        let part = Self { chain: self.chain, h: self.h * fraction, weights: self.weights };
        if !part.h.is_finite() || (part.h != 0.0 && !(1.0 / part.h).is_finite()) {
            return Err(StepError::NonFinite { what: "part of the step" });
        }
        let mut next = part.adopt(&state.motion);
        part.step(&mut next)?;
        next.motion.steps = state.motion.steps;
        Ok(next.motion)
    }

    fn adopt(&self, motion: &Motion<[SO3; N], ()>) -> ChainState<N> {
        Self::adopt(self, motion)
    }

    fn step_size(&self) -> f64 {
        self.h
    }

    fn velocity(&self, motion: &Motion<[SO3; N], ()>) -> Bodies<Vector3<f64>, N> {
        Self::velocity(self, motion)
    }

    fn energy(&self, motion: &Motion<[SO3; N], ()>) -> f64 {
        Self::energy(self, motion)
    }
}
