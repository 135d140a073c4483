//! The step of jointed bodies.

use core::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix3, Vector2, Vector6};

roots!();

use super::equations::Equations;
use super::jointed::{Body, JointedBodies};
use super::places::{Places, parts};
use super::{Constraint, Place};
use crate::error::{SetupError, StepError};
use crate::groups::{Advected as _, CayleyRetraction, LieGroup, Retraction, SO3};
use crate::mechanics::{Effect, Operations, SceneVisitor};
use crate::motion::{Cost, Motion, Plan, Steerable, StepReport, Summation, SumsOf, Variable, half_coordinates, is_due};
use crate::numbers::{Bodies, Coordinates as _, Polynomial, Vectors, filled};
use crate::solving::{
    LONGEST_DAMPED, MAX_DAMPED_ITERATIONS, MAX_ITERATIONS, SETTLED, WarmStart, has_sufficed, may_suffice,
    newton_system, step_terms,
};

type Components<const N: usize> = Bodies<Vector6<f64>, N>;

/// The relative rounding error of an update, by places and by opposed forces.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// The squared lengths of the turn and of the shift.
fn squares(of: &Vector6<f64>) -> Vector2<f64> {
    let (turn, shift) = parts(of);
    Vector2::new(turn.norm_squared(), shift.norm_squared())
}

/// The nonlinear equations of a step.
struct Problem<'a, 'b, S: Effect, C, const K: usize, const N: usize, const T: usize, const L: usize> {
    plan: &'a JointedBodies<S, C, K, N, T, L>,
    terms: S::StepTerms,
    attitude: &'a [Body; N],
    places: Places<N>,
    equations: &'a mut Equations<'b, C, K, N, T, L>,
    /// The weight `1/length²`, 1/m², of squared shifts against squared turns, with the shortest of the bodies' lengths.
    weight: f64,
    /// The squared scale of the rounding errors of places, in rad².
    extent: f64,
    half: Components<N>,
    /// A joint that was redundant at the last iterate, and its pivot.
    met: Option<(usize, f64)>,
}

/// The squared lengths of an update and of the unknowns after it, of its largest turn, and of its rounding error. All
/// are in rad, with shifts divided by the shortest of the bodies' lengths.
struct Update {
    length: f64,
    size: f64,
    largest: f64,
    rounded: f64,
}

impl<S, C, const K: usize, const N: usize, const T: usize, const L: usize> Problem<'_, '_, S, C, K, N, T, L>
where
    S: Effect<Scalar = f64, Group = [Body; N], Retraction = CayleyRetraction>,
    C: Constraint<K>,
{
    /// The places after these increments, to the bit.
    fn next(&self) -> Places<N> {
        Places(filled!([Place::SPACE; N], |k| {
            let (turn, shift) = parts(&self.half.0[k]);
            let increment = <CayleyRetraction as Retraction<SO3>>::increment_of_half(&turn);
            let attitude = *self.attitude[k].0.advance(&increment).as_matrix();
            Place { attitude, position: self.places.0[k].position + shift * 2.0 }
        }))
    }

    /// One Newton iteration.
    fn newton(&mut self, longest: f64) -> Update {
        let (residuals, matrices) = &newton_system::<S>(&self.plan.constants, &self.terms, &self.half);
        let next = self.next();
        // Gaps are halved: the unknowns are half the coordinates, so a shift is twice its unknown.
        let turns = filled!([Matrix3::zeros(); N], |k| {
            let tangent = <CayleyRetraction as Retraction<SO3>>::tangent_of_half(&parts(&self.half.0[k]).0);
            self.places.0[k].attitude * tangent * 0.5
        });
        self.equations.set_after(&next, &turns);
        self.equations.factorise(&matrices.0);
        self.met = self.equations.redundant();
        self.update(residuals, &next, longest)
    }

    /// One simplified iteration, with the last Jacobian.
    fn simplified(&mut self) -> Update {
        let residuals = S::newton_residual(&self.plan.constants, &self.terms, &self.half);
        let next = self.next();
        self.update(&residuals, &next, f64::INFINITY)
    }

    /// Solves for the update and applies it. If a body would turn by more than `longest`, all updates are scaled down.
    fn update(&mut self, residuals: &Components<N>, next: &Places<N>, longest: f64) -> Update {
        let opposed = self.equations.solve(&residuals.0, |joined| next.gap(joined) * 0.5);
        let (mut update, mut largest, mut size) = (0.0, 0.0_f64, 0.0);
        let weights = self.weights();
        for part in &self.equations.unknowns.bodies {
            update += squares(part).dot(&weights);
            largest = largest.max(parts(part).0.norm_squared());
        }
        let part = if largest > longest * longest { longest / largest.sqrt() } else { 1.0 };
        for (half, update) in self.half.0.iter_mut().zip(&self.equations.unknowns.bodies) {
            *half += update * part;
            size += squares(half).dot(&weights);
        }
        Update { length: update, size, largest, rounded: (opposed.dot(&weights) + self.extent) * (ROUNDED * ROUNDED) }
    }

    /// The weights of the two [`squares`].
    fn weights(&self) -> Vector2<f64> {
        Vector2::new(1.0, self.weight)
    }

    /// The number of iterations, and whether they converged near the identity with all determinants positive.
    fn attempt(&mut self, most: u32, longest: f64) -> (u32, bool) {
        let mut made = 0;
        for _ in 0..most {
            made += 1;
            let Update { length: update, size, largest, rounded } = self.newton(longest);
            if !size.is_finite() {
                return (made, false);
            }
            if update <= (size * (f64::EPSILON * SETTLED)).max(rounded) {
                return (made, self.is_wanted());
            }
            if largest <= longest * longest && may_suffice(update, size) {
                let second = self.simplified();
                made += 1;
                if second.length <= second.rounded || has_sufficed(update, second.length, second.size) {
                    return (made, self.is_wanted());
                }
            }
        }
        (made, false)
    }

    fn is_wanted(&self) -> bool {
        self.turned_too_far().is_none()
            && self.equations.wrong_body().is_none()
            && self.equations.reversed().is_none()
            && self.equations.redundant().is_none()
    }

    fn turned_too_far(&self) -> Option<usize> {
        let is_near = |half: &Vector6<f64>| parts(half).0.norm_squared() < 1.0;
        self.half.0.iter().position(|half| !is_near(half))
    }

    /// Solves from the guess; if that fails from the velocity, and then from rest with shortened updates.
    fn solve(&mut self, guess: Components<N>, slow: impl Fn() -> Components<N>) -> Result<u32, StepError> {
        self.half = guess;
        let (mut spent, is_solved) = self.attempt(MAX_ITERATIONS, f64::INFINITY);
        if is_solved {
            return Ok(spent);
        }
        let slow = slow();
        let at_rest = (Bodies::zero(), MAX_DAMPED_ITERATIONS, LONGEST_DAMPED);
        for (start, most, longest) in [(slow, MAX_ITERATIONS, f64::INFINITY), at_rest] {
            self.half = start;
            let (made, is_solved) = self.attempt(most, longest);
            spent += made;
            if is_solved {
                return Ok(spent);
            }
        }
        Err(self.reason(&slow, spent))
    }

    /// The error of a failed step. It blames a body that is too fast, a joint with a singular position at the last
    /// iterate, or the body where the iteration ended.
    #[cold]
    fn reason(&self, slow: &Components<N>, iterations: u32) -> StepError {
        let turn = |body: usize| 2.0 * parts(&slow.0[body]).0.norm();
        let blamed = |body: usize| StepError::UnsolvedBody {
            body,
            turn: turn(body),
            determinant: self.equations.determinant(body),
        };
        let fastest = (0..N).max_by(|&a, &b| turn(a).total_cmp(&turn(b))).unwrap_or(0);
        if turn(fastest) > FRAC_PI_2 {
            return blamed(fastest);
        }
        if let Some((joint, pivot)) = self.met {
            return StepError::SingularJoint { joint, pivot };
        }
        if !self.half.is_finite() {
            return blamed(fastest);
        }
        if let Some(body) = self.turned_too_far().or(self.equations.wrong_body().map(|(body, _)| body)) {
            return blamed(body);
        }
        if let Some(determinant) = self.equations.reversed() {
            return StepError::WrongBranch { determinant };
        }
        let square = |of: &[Vector6<f64>; N]| of.iter().map(|part| squares(part).dot(&self.weights())).sum::<f64>();
        let (update, size) = (square(&self.equations.unknowns.bodies), square(&self.half.0));
        // At rest there is no size that an update is relative to.
        StepError::NotConverged { iterations, residual: (update / if size > 0.0 { size } else { 1.0 }).sqrt() }
    }
}

/// Projects attitudes onto the rotations if that is due; returns whether they changed. A projection before the step
/// leaves the joints closed after it. Advected parameters stay unchanged until the step's end.
fn restore<S, M, const N: usize>(scene: &S, motion: &mut M) -> bool
where
    S: Effect<Group = [Body; N]>,
    M: Summation<[Body; N], S::Advected>,
{
    if !is_due::<[Body; N]>(motion.now().steps) {
        return false;
    }
    let given = *motion.now();
    motion.restore(&scene.advected());
    motion.show(Motion { advected: given.advected, ..*motion.now() });
    motion.now().attitude != given.attitude
}

impl<S, C, const K: usize, const N: usize, const T: usize, const L: usize> Steerable for JointedBodies<S, C, K, N, T, L> where
    S: Effect
{
}
impl<S, C, const K: usize, const N: usize, const T: usize, const L: usize> Variable for JointedBodies<S, C, K, N, T, L> where
    S: Effect
{
}

impl<S, C, const K: usize, const N: usize, const T: usize, const L: usize> Plan<S> for JointedBodies<S, C, K, N, T, L>
where
    S: Effect<Scalar = f64, Group = [Body; N], Retraction = CayleyRetraction>,
    C: Constraint<K>,
{
    type Kept = WarmStart<Components<N>, Polynomial<Components<N>>>;

    // Most of a step is in functions that aren't inlined, so that it is compiled once.
    const VECTORS: Vectors = Vectors::AsCompiled;
    const RUNS_BY_STEPS: bool = true;

    fn step_size(&self) -> f64 {
        self.h
    }

    fn refolded(&self, scene: &S, h: f64) -> Result<Self, SetupError> {
        Self::new(scene, self.joints, h)
    }

    fn keep(&self, scene: &S, motion: &Motion<[Body; N], S::Advected>) -> Self::Kept {
        WarmStart::of(half_coordinates(scene, motion, self.h))
    }

    fn admits(&self, scene: &S, motion: &Motion<[Body; N], S::Advected>) -> Result<(), SetupError> {
        self.check_start(scene, motion)
    }

    fn step<M: SumsOf<S>>(&self, scene: &S, motion: &mut M, kept: &mut Self::Kept) -> Result<StepReport, StepError> {
        // A copy, because an error must leave the motion unchanged.
        let mut next = *motion;
        if self.h == 0.0 {
            motion.count();
            return Ok(StepReport::of(0));
        }
        let is_restored = restore(scene, &mut next);
        let restored;
        let now = if is_restored {
            restored = *next.now();
            &restored
        } else {
            motion.now()
        };
        if !now.momentum.is_finite() {
            return Err(StepError::NonFinite { what: "momentum" });
        }
        let kick = if S::PARTS.kick_before { S::kick_before(&self.constants, &now.advected) } else { Bodies::zero() };
        let a = now.momentum + kick;
        let places = Places::of(&now.attitude);
        let mut equations = self.equations();
        equations.set_before(&places);
        let length = self.lengths.iter().copied().fold(f64::INFINITY, f64::min);
        let extent = equations.extent(&places) / length;
        let mut problem = Problem {
            plan: self,
            terms: step_terms::<S>(&self.constants, &a, &now.advected),
            attitude: &now.attitude,
            equations: &mut equations,
            weight: 1.0 / (length * length),
            // Attitudes have entries of size one and their rounding errors.
            extent: 1.0 + extent * extent,
            places,
            half: Bodies::zero(),
            met: None,
        };
        let slow = || half_coordinates(scene, now, self.h);
        let iterations = problem.solve(kept.guess(<[Body; N]>::DIMENSION), slow)?;
        let increment = <CayleyRetraction as Retraction<[Body; N]>>::increment_of_half(&problem.half);
        let places = problem.next();
        let half = problem.half;
        let impulse = Bodies(equations.reactions()) * (-2.0 / self.h);
        let advected = next.turned(&increment);
        let mut change = <[Body; N]>::adjoint_transpose_increment(&increment, &(a + impulse)) + (kick + impulse);
        if S::PARTS.kick_after {
            change = change + S::kick_after(&self.constants, &increment, &advected);
        }
        // The Jacobian was checked along the iteration, but not at its end; the projection checks it there.
        let taken = Self::projection(&mut equations, scene, &places, &advected, &(now.momentum + change));
        change = change - taken.map_err(|(joint, pivot)| StepError::SingularJoint { joint, pivot })?;
        let momentum = now.momentum + change;
        if !momentum.is_finite() || !half.is_finite() {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        next.proceed(&increment, &change, (momentum, advected));
        if is_restored {
            let seen = Motion { advected: scene.advected().seen_from(&next.now().attitude), ..*next.now() };
            next.show(seen);
        }
        let far = !<CayleyRetraction as Retraction<[Body; N]>>::is_half_well_near_identity(&half);
        kept.follow(half, far);
        if next.now().steps == 0 {
            kept.forget_the_estimate();
        }
        next.count();
        *motion = next;
        Ok(StepReport::of(iterations))
    }

    /// Joints take up part of the impulse, so that velocities satisfy the constraints.
    fn push<M: Summation<[Body; N], S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        _kept: &mut Self::Kept,
        impulse: &Components<N>,
    ) -> Result<(), StepError> {
        // A copy, because an error must leave the motion unchanged.
        let mut pushed = *motion;
        pushed.push(impulse);
        let now = *pushed.now();
        let places = Places::of(&now.attitude);
        let taken = Self::projection(&mut self.equations(), scene, &places, &now.advected, &now.momentum);
        let taken = taken.map_err(|(joint, pivot)| StepError::SingularJoint { joint, pivot })?;
        pushed.push(&(Bodies::zero() - taken));
        *motion = pushed;
        Ok(())
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        visitor.term("its own step, with joints");
        for (_, joined) in self.joints.all() {
            visitor.term(joined.joint.name());
            #[allow(clippy::cast_precision_loss)] // far fewer than a float counts
            let number = |body: Option<usize>| body.map_or(-1.0, |body| body as f64);
            visitor.parameter("body above", number(joined.above));
            visitor.parameter("body below", number(Some(joined.below)));
            joined.joint.describe(&mut |name, value| visitor.parameter(name, value));
        }
    }

    #[allow(clippy::cast_possible_truncation)] // far fewer
    fn cost(&self) -> Cost {
        let (of_step, of_iteration) = const { of_a_body(K as u32) };
        let bodies = N as u32;
        let Operations { step, iteration } = S::OPERATIONS;
        let all = Operations { step: step + bodies * of_step, iteration: iteration + bodies * of_iteration };
        Cost::of_stages(all, 1)
    }
}

/// Operations of a body and its joint with `k` functions, in a step, which ends with a projection, and in an iteration.
/// The scene's are counted apart; those of loops and of a constraint's functions aren't counted.
const fn of_a_body(k: u32) -> (u32, u32) {
    const fn product(rows: u32, inner: u32, columns: u32) -> u32 {
        rows * columns * (2 * inner - 1)
    }
    // The factors of `A`: six inverse pivots, fifteen entries below, and the updates of the remaining rows. Solving for
    // a column costs as much as a product with an inverse.
    let (factors, column) = (6 + 15 + 2 * (25 + 16 + 9 + 4 + 1), product(6, 6, 1));
    let (x, s, inverse) = (k * column, product(k, 6, k), 2 * k * k * k);
    let (p, added) = (product(k, k, 6), product(6, k, 6) + 36);
    // The operations for `w`, `s`, the parent's part, `p` and `y`.
    let solution =
        column + (product(k, 6, 1) + k) + product(k, k, 1) + 2 * (product(6, k, 1) + 6) + product(k, 6, 1) + k;
    // The turns of both ends' slopes; for the place, increment and tangent, each multiplied by the attitude.
    let (slopes, place) = (2 * product(k, 3, 3), 2 * 25 + 2 * product(3, 3, 3));
    let once = slopes + factors + x + s + inverse + p + added + solution;
    (slopes + once, once + place)
}
