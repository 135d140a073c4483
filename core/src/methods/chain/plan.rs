//! The plan of links on ball joints.

use nalgebra::{Matrix3, Vector3};

roots!();

use super::elimination::{LinkConstants, Update, Work, momenta_of_velocities, newton, outwards, simplified};
use super::link::Link;
use crate::error::{SetupError, StepError};
use crate::groups::{CayleyRetraction, Retraction, SO3};
use crate::mechanics::{Effect, Operations, SceneVisitor};
use crate::motion::{Cost, Motion, Plan, PlanFacts, Runs, Steerable, StepReport, Stepper, Summation, Variable};
use crate::numbers::{
    Bodies, Columns, Coordinates as _, OnRegisters, Plain, Register, Vectors, cross, filled, on_registers, padded,
    square, vector,
};
use crate::solving::{Curvature, LONGEST_DAMPED, MAX_DAMPED_ITERATIONS, MAX_ITERATIONS, WarmStart};

/// Operations of a link's matrix products in a step and in an iteration; those of potentials are counted apart.
const OF_A_LINK: Operations = Operations { step: 150, iteration: 600 };

type Components<const N: usize> = Bodies<Vector3<f64>, N>;

/// Links on ball joints, the first on a fixed pivot, in a scene of potentials: the plan of [`Stepper::linked`], in the
/// minimal form on SO(3)ᴺ. Its step is of second order, symmetric and symplectic, and takes time proportional to `N`.
///
/// # Contract
///
/// - Joints don't open: attitudes are the only unknowns.
/// - The momentum about the vertical is conserved to rounding if the only load is weight.
/// - A step satisfies its momentum equations to rounding, or is an error that leaves the state unchanged; it names the
///   link that caused it, if there is one.
/// - Nothing is allocated. A chain of `N` links takes about `2 N` kB of stack.
///
/// # Source
///
/// The equations are (2.7) and (2.9) of \[RDAE\] for the Lagrangian of a [`Chain`](super::Chain), relative attitudes being advected;
/// the minimal form is that of the authors of \[LML05\], the elimination that of Featherstone's articulated bodies.
#[derive(Clone, Debug)]
pub struct LinkedBodies<S: Effect, const N: usize> {
    h: f64,
    constants: S::Constants,
    pub(super) links: [LinkConstants; N],
}

/// # Make: links on ball joints
impl<S: Effect> Stepper<S> {
    /// Links on ball joints, the first on a fixed pivot. The scene contains the loads: potentials of the links'
    /// attitudes, at their [places](crate::mechanics::Each). [`Chain::stepper`](crate::methods::Chain::stepper) has
    /// gravity as its load, and an example.
    ///
    /// Momenta are conjugate to the turns of the links, so each includes the motion of the links beyond.
    ///
    /// # Errors
    ///
    /// [`SetupError::BodyParameter`] names a link with an invalid parameter; [`SetupError::Parameter`] an invalid
    /// parameter of the scene; [`SetupError::InvalidStep`] is for a step that isn't finite or whose inverse isn't.
    pub fn linked<const N: usize>(
        scene: S,
        links: [Link; N],
        h: f64,
    ) -> Result<Stepper<S, LinkedBodies<S, N>>, SetupError>
    where
        S: Effect<Scalar = f64, Group = [SO3; N]>,
    {
        for (body, link) in links.iter().enumerate() {
            link.validate(body)?;
        }
        let plan = LinkedBodies::new(&scene, links.each_ref().map(LinkConstants::from), h)?;
        Ok(Stepper { scene, plan })
    }
}

impl<S: Effect<Group = [SO3; N]>, const N: usize> Stepper<S, LinkedBodies<S, N>> {
    /// The position of each link's lower joint in space, m from the pivot.
    #[must_use]
    pub fn joints(&self, motion: &Motion<[SO3; N], S::Advected>) -> [Vector3<f64>; N] {
        let mut place = Vector3::zeros();
        filled!([place; N], |k| {
            let [x, y, z, _] = self.plan.links[k].rho;
            place += motion.attitude[k].as_matrix() * Vector3::new(x, y, z);
            place
        })
    }
}

#[hot]
impl<S, const N: usize> LinkedBodies<S, N>
where
    S: Effect<Scalar = f64, Group = [SO3; N]>,
{
    #[inline]
    fn new(scene: &S, links: [LinkConstants; N], h: f64) -> Result<Self, SetupError> {
        const {
            assert!(N > 0, "a chain has a link");
            assert!(
                !S::FACTS.parts.unknown,
                "links are moved by potentials of the ends of a step; their inertia is their own"
            );
        }
        scene.validate()?;
        if !h.is_finite() || (h != 0.0 && !(1.0 / h).is_finite()) {
            return Err(SetupError::InvalidStep { step: h });
        }
        Ok(Self { h, constants: scene.constants(h), links })
    }

    /// Sets the attitude of each link relative to the previous one.
    fn place<R: Register>(&self, zero: R, attitudes: &[SO3; N], work: &mut [Work<R>; N]) {
        for ((pair, work), link) in attitudes.windows(2).zip(work).zip(&self.links) {
            let (before, next) = (pair[0].as_matrix(), pair[1].as_matrix());
            work.place(link, Columns::of(zero, before).transposed() * Columns::of(zero, next));
        }
    }

    /// Sets the targets of the momentum equations; returns the scene's kick before the step.
    pub(super) fn prepare<R: Register>(
        &self,
        zero: R,
        now: &Motion<[SO3; N], S::Advected>,
        work: &mut [Work<R>; N],
    ) -> Components<N> {
        let kick =
            if S::FACTS.parts.kick_before { S::kick_before(&self.constants, &now.advected) } else { Bodies::zero() };
        self.place(zero, &now.attitude, work);
        for (k, work) in work.iter_mut().enumerate() {
            work.target = zero.of(padded(&((now.momentum.0[k] + kick.0[k]) * self.h)));
        }
        kick
    }

    /// Solves from the guess; if that fails from rest, and then with shortened updates. Returns the number of
    /// iterations, failed attempts included, and whether there is a solution.
    pub(super) fn solve<R: Register>(&self, zero: R, work: &mut [Work<R>; N], guess: &Components<N>) -> (u32, bool) {
        const ATTEMPTS: [(bool, u32, f64); 3] = [
            (true, MAX_ITERATIONS, f64::INFINITY),
            (false, MAX_ITERATIONS, f64::INFINITY),
            (false, MAX_DAMPED_ITERATIONS, LONGEST_DAMPED),
        ];
        let mut spent = 0;
        // A loop has one call of `iterate`, which is inlined and so compiled only once.
        for (is_guessed, most, longest) in ATTEMPTS {
            for (work, guess) in work.iter_mut().zip(&guess.0) {
                work.half = if is_guessed { zero.of(padded(guess)) } else { zero };
            }
            let (iterations, is_solved) = iterate(zero, &self.links, work, most, longest);
            spent += iterations;
            if is_solved {
                return (spent, true);
            }
        }
        (spent, false)
    }

    /// Completes the step with these increments; `kick` is the scene's kick before it.
    ///
    /// # Errors
    ///
    /// [`StepError::NonFinite`] if a momentum after the step isn't finite.
    pub(super) fn proceed<R: Register, M: Summation<[SO3; N], S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        work: &[Work<R>; N],
        kick: Components<N>,
    ) -> Result<(), StepError> {
        let (now, inverse_step) = (motion.now(), 1.0 / self.h);
        let increment = filled!([Matrix3::zeros(); N], |k| Matrix3::from_columns(&work[k].increment.0.map(vector)));
        let advected = motion.turned(&increment);
        let mut change = if S::FACTS.parts.kick_after {
            S::kick_after(&self.constants, &increment, &advected)
        } else {
            Bodies::zero()
        };
        let (zero, mut momentum) = (work[0].u.of([0.0; 4]), now.momentum);
        let (mut beyond, inverse_step) = (zero, zero.of([inverse_step; 4]));
        for (k, work) in work.iter().enumerate().rev() {
            beyond = work.next.map(beyond);
            // The diamond of the coupled inertia, added to the scene's kick.
            let of_joints = cross(work.of_mc, work.u) + cross(work.of_rho, beyond);
            let kick = zero.of(padded(&kick.0[k])) + of_joints * inverse_step;
            beyond = beyond + work.momentum(&self.links[k]);
            // The change of the momentum by μ⁺ = Fᵀ(μ + κ), (2.9).
            let pushed = zero.of(padded(&momentum.0[k])) + kick;
            change.0[k] += vector(kick + work.increment.transposed().map(pushed));
            momentum.0[k] += change.0[k];
        }
        if !momentum.is_finite() {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        motion.proceed(&increment, &change, (momentum, advected));
        motion.finish(|| scene.advected());
        Ok(())
    }

    /// The error of a failed step. It blames the link where the iteration ended; if the last iterate isn't finite, the
    /// link that would turn farthest at its velocity.
    #[cold]
    fn reason<R: Register>(
        &self,
        motion: &Motion<[SO3; N], S::Advected>,
        work: &[Work<R>; N],
        iterations: u32,
    ) -> StepError {
        let turn = self.velocities(motion).0.map(|velocity| (velocity * self.h).norm());
        let blamed =
            |body: usize| StepError::UnsolvedBody { body, turn: turn[body], determinant: work[body].determinant };
        if !work.iter().all(|work| square(work.half).is_finite()) {
            let farthest = (0..N).max_by(|&a, &b| turn[a].total_cmp(&turn[b]));
            return blamed(farthest.unwrap_or(0));
        }
        if let Some(body) = work.iter().position(|work| !work.is_wanted()) {
            return blamed(body);
        }
        let sum = |of: fn(&Work<R>) -> R| work.iter().map(|work| square(of(work))).sum::<f64>();
        let (update, size) = (sum(|work| work.update), sum(|work| work.half));
        StepError::NotConverged { iterations, residual: (update / size).sqrt() }
    }

    /// The velocities. Near rest, the momenta times `h` are linear in `y`, namely those of the velocities `2 y`, so one
    /// Newton iteration inverts them.
    #[inline(never)]
    fn velocities(&self, motion: &Motion<[SO3; N], S::Advected>) -> Components<N> {
        let zero = Plain::ZERO;
        let mut work = at_rest(zero);
        self.place(zero, &motion.attitude, &mut work);
        for (work, momentum) in work.iter_mut().zip(&motion.momentum.0) {
            work.target = zero.of(padded(momentum));
        }
        outwards(zero, &self.links, &mut work);
        newton(zero, &self.links, &mut work, f64::INFINITY);
        Bodies(work.map(|work| vector(work.half) * 2.0))
    }
}

/// At most `most` Newton iterations, and the simplified ones. Returns the number of both, and whether they have
/// converged near the identity with all determinants positive.
///
/// The determinants are those before the last updates. Near a fold that needs no guard: two updates suffice if
/// `2C²|u₁|³ ≤ ε|y|/16`, and the first is longer than `√ε|y|/8`, so `C|u₁| < 1e-4`. The Jacobian changes by twice that,
/// relative to itself; a change of sign would be a change by all of itself.
#[hot]
fn iterate<R: Register>(
    zero: R,
    links: &[LinkConstants],
    work: &mut [Work<R>],
    most: u32,
    longest: f64,
) -> (u32, bool) {
    outwards(zero, links, work);
    // `before` is the length of the last update if the next Newton update is quadratic in it. After a shortened update
    // the error is larger, and after a simplified one it depends on the reused Jacobian.
    let (mut made, mut before) = (0, None);
    for _ in 0..most {
        made += 1;
        let Update { length: update, size, is_whole } = newton(zero, links, work, longest);
        if !size.is_finite() {
            break;
        }
        let curvature = Curvature::told(before, update);
        if curvature.has_settled(update, size) {
            return (made, are_wanted(work));
        }
        before = is_whole.then_some(update);
        if is_whole && curvature.may_suffice(update, size) {
            let second = simplified(zero, links, work);
            made += 1;
            if curvature.has_sufficed(update, second.length, second.size) {
                return (made, are_wanted(work));
            }
            before = None;
        }
    }
    (made, false)
}

#[hot]
fn are_wanted<R: Register>(work: &[Work<R>]) -> bool {
    let mut wanted = true;
    for work in work {
        wanted &= work.is_wanted();
    }
    wanted
}

#[hot]
pub(super) fn at_rest<R: Register, const N: usize>(zero: R) -> [Work<R>; N] {
    core::array::from_fn(|_| Work::none(zero))
}

impl<S: Effect<Scalar = f64, Group = [SO3; N]>, const N: usize> Steerable<S> for LinkedBodies<S, N> {}
impl<S: Effect<Scalar = f64, Group = [SO3; N]>, const N: usize> Variable<S> for LinkedBodies<S, N> {}

impl<S, const N: usize> Plan<S> for LinkedBodies<S, N>
where
    S: Effect<Scalar = f64, Group = [SO3; N]>,
{
    type Kept = WarmStart<Components<N>>;

    /// Each step chooses its vector instructions itself.
    const FACTS: PlanFacts =
        PlanFacts { vectors: Vectors::AsCompiled, runs: Runs::BySteps, has_own_inertia: true, ..PlanFacts::of::<S>() };

    fn step_size(&self) -> f64 {
        self.h
    }

    fn refolded(&self, scene: &S, h: f64) -> Result<Self, SetupError> {
        Self::new(scene, self.links, h)
    }

    fn keep(&self, _: &S, motion: &Motion<[SO3; N], S::Advected>) -> Self::Kept {
        WarmStart::of(self.velocities(motion) * (0.5 * self.h))
    }

    #[hot]
    fn step<M: Summation<[SO3; N], S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
    ) -> Result<StepReport, StepError> {
        on_registers(Step(self, scene, motion, kept))
    }

    fn momentum(&self, _: &S, attitude: &[SO3; N], velocity: &Components<N>, _: &S::Advected) -> Components<N> {
        let zero = Plain::ZERO;
        let mut work = at_rest(zero);
        self.place(zero, attitude, &mut work);
        for (work, velocity) in work.iter_mut().zip(&velocity.0) {
            work.half = zero.of(padded(velocity));
        }
        momenta_of_velocities(zero, &self.links, &mut work);
        Bodies(work.map(|work| vector(work.target)))
    }

    fn velocity(&self, _: &S, motion: &Motion<[SO3; N], S::Advected>) -> Components<N> {
        self.velocities(motion)
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        visitor.term("its own step, of links on ball joints");
        for link in &self.links {
            let mut tell = |name, entries: &[f64]| entries.iter().for_each(|&entry| visitor.parameter(name, entry));
            link.nonstandard.iter().for_each(|column| tell("J_d", &column[..3]));
            tell("m", &[link.m]);
            tell("m c", &link.mc[..3]);
            tell("rho", &link.rho[..3]);
        }
    }

    #[allow(clippy::cast_possible_truncation)] // far fewer
    fn cost(&self) -> Cost {
        let links = N as u32;
        let (step, iteration) = (S::FACTS.operations.step + links * OF_A_LINK.step, links * OF_A_LINK.iteration);
        Cost::of_stages(Operations { step, iteration }, 1)
    }
}

/// A step, compiled for the machine's registers.
pub(super) struct Step<'a, S, P, M, K>(pub(super) &'a P, pub(super) &'a S, pub(super) &'a mut M, pub(super) &'a mut K);

impl<S, M, const N: usize> OnRegisters for Step<'_, S, LinkedBodies<S, N>, M, WarmStart<Components<N>>>
where
    S: Effect<Scalar = f64, Group = [SO3; N]>,
    M: Summation<[SO3; N], S::Advected>,
{
    type Output = Result<StepReport, StepError>;

    #[hot]
    fn run<R: Register>(self, zero: R) -> Self::Output {
        let Self(plan, scene, motion, kept) = self;
        if plan.h == 0.0 {
            motion.count();
            return Ok(StepReport::of(0));
        }
        let mut work = at_rest(zero);
        let kick = plan.prepare(zero, motion.now(), &mut work);
        let (iterations, is_solved) = plan.solve(zero, &mut work, &kept.guess.next);
        if !is_solved {
            return Err(plan.reason(motion.now(), &work, iterations));
        }
        let is_first = motion.now().steps == 0;
        plan.proceed(scene, motion, &work, kick)?;
        follow(kept, &work, is_first);
        Ok(StepReport::of(iterations))
    }
}

/// Updates the initial guess of the next step by these increments.
#[hot]
pub(super) fn follow<R: Register, const N: usize>(
    kept: &mut WarmStart<Components<N>>,
    work: &[Work<R>; N],
    is_first: bool,
) {
    let half = Bodies(filled!([Vector3::zeros(); N], |k| vector(work[k].half)));
    let far = !<CayleyRetraction as Retraction<[SO3; N]>>::is_half_well_near_identity(&half);
    kept.follow(half, far);
    if is_first {
        kept.forget_the_estimate();
    }
}
