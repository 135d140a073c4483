//! The plan of a system of joined bodies.

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

/// The update that roundings of places and of opposed forces leave, in them.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// The squared lengths of the turn and of the shift.
fn squares(of: &Vector6<f64>) -> Vector2<f64> {
    let (turn, shift) = parts(of);
    Vector2::new(turn.norm_squared(), shift.norm_squared())
}

/// What is solved for a step.
struct Problem<'a, 'b, S: Effect, C, const K: usize, const N: usize, const T: usize, const L: usize> {
    plan: &'a JointedBodies<S, C, K, N, T, L>,
    terms: S::StepTerms,
    attitude: &'a [Body; N],
    places: Places<N>,
    equations: &'a mut Equations<'b, C, K, N, T, L>,
    /// A turn of 1 rad is compared with a shift by the shortest of the bodies' lengths: `1/length²`, 1/m².
    weight: f64,
    /// The square of what roundings of places are units in the last place of, in turns.
    extent: f64,
    half: Components<N>,
    /// The joint that the last iterate leaves nothing to do, and its pivot.
    met: Option<(usize, f64)>,
}

/// The squares of the lengths of an update and of the unknowns after it, that of the largest turn in it, and that of
/// what rounding leaves of it. All are in rad, with shifts over the shortest of the bodies' lengths.
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
    /// Where the increments lead, to the bit.
    fn next(&self) -> Places<N> {
        Places(filled!([Place::SPACE; N], |k| {
            let (turn, shift) = parts(&self.half.0[k]);
            let increment = <CayleyRetraction as Retraction<SO3>>::increment_of_half(&turn);
            let attitude = *self.attitude[k].0.advance(&increment).as_matrix();
            Place { attitude, position: self.places.0[k].position + shift * 2.0 }
        }))
    }

    /// One of Newton's iterations.
    fn newton(&mut self, longest: f64) -> Update {
        let (residuals, matrices) = &newton_system::<S>(&self.plan.constants, &self.terms, &self.half);
        let next = self.next();
        // With half of each gap, as with half the coordinates a shift is twice its unknown.
        let turns = filled!([Matrix3::zeros(); N], |k| {
            let tangent = <CayleyRetraction as Retraction<SO3>>::tangent_of_half(&parts(&self.half.0[k]).0);
            self.places.0[k].attitude * tangent * 0.5
        });
        self.equations.set_after(&next, &turns);
        self.equations.factorise(&matrices.0);
        self.met = self.equations.redundant();
        self.update(residuals, &next, longest)
    }

    /// Another with the matrix of the last.
    fn simplified(&mut self) -> Update {
        let residuals = S::newton_residual(&self.plan.constants, &self.terms, &self.half).momentum_defect;
        let next = self.next();
        self.update(&residuals, &next, f64::INFINITY)
    }

    /// Where a body would turn by more than `longest`, all updates are shortened.
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

    /// How many iterations were made, and whether they have settled near the identity, with all determinants positive.
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

    /// From the guess; where that fails from the velocity, and then from rest with shortened updates.
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

    /// Which joint or which body is to blame: a body that is too fast, a joint whose singular position the iteration
    /// has met, or a body by where it has ended.
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
        // At rest there is nothing that an update is relative to.
        StepError::NotConverged { iterations, residual: (update / if size > 0.0 { size } else { 1.0 }).sqrt() }
    }
}

/// Puts attitudes back among the rotations where that is due; whether it was necessary. It is done before a step, so that
/// joints are closed behind it. What the step has been given stays until then.
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

    // Most of a step is called, so that it is compiled once.
    const VECTORS: Vectors = Vectors::AsCompiled;
    const RUNS_BY_STEPS: bool = true;

    fn step_size(&self) -> f64 {
        self.h
    }

    fn refolded(&self, scene: &S, h: f64) -> Result<Self, SetupError> {
        Self::new(scene, self.joints, h)
    }

    fn keep(&self, scene: &S, motion: &Motion<[Body; N], S::Advected>) -> Self::Kept {
        WarmStart::of(half_coordinates(scene, motion, self.h), false)
    }

    fn admits(&self, scene: &S, motion: &Motion<[Body; N], S::Advected>) -> Result<(), SetupError> {
        self.check_start(scene, motion)
    }

    fn step<M: SumsOf<S>>(&self, scene: &S, motion: &mut M, kept: &mut Self::Kept) -> Result<StepReport, StepError> {
        // A copy: after an error the motion has to be where it was.
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
            // Attitudes are rounded as numbers of the size of one.
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
        // The iteration has seen the matrix on its way, and not at the end of it.
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

    /// Joints take their part of the impulse, so that velocities keep to them.
    fn push<M: Summation<[Body; N], S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        _kept: &mut Self::Kept,
        impulse: &Components<N>,
    ) -> Result<(), StepError> {
        // A copy: after an error the motion has to be where it was.
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

/// Operations of a body and its joint with `k` functions, beside those of the scene: in a step, which ends with a
/// projection, and in an iteration. Those of loops aren't counted, nor is what a constraint computes.
const fn of_a_body(k: u32) -> (u32, u32) {
    const fn product(rows: u32, inner: u32, columns: u32) -> u32 {
        rows * columns * (2 * inner - 1)
    }
    // Factors of `A`: of its six rows the inverse pivots, the fifteen entries below, and what these change. A column by them
    // costs as much as by an inverse.
    let (factors, column) = (6 + 15 + 2 * (25 + 16 + 9 + 4 + 1), product(6, 6, 1));
    let (x, s, inverse) = (k * column, product(k, 6, k), 2 * k * k * k);
    let (p, added) = (product(k, k, 6), product(6, k, 6) + 36);
    // `w`, `s`, what the parent gets, `p` and `y`.
    let solution =
        column + (product(k, 6, 1) + k) + product(k, k, 1) + 2 * (product(6, k, 1) + 6) + product(k, 6, 1) + k;
    // Turns of both ends' slopes; of the place the increment and the tangent, and both times the attitude.
    let (slopes, place) = (2 * product(k, 3, 3), 2 * 25 + 2 * product(3, 3, 3));
    let once = slopes + factors + x + s + inverse + p + added + solution;
    (slopes + once, once + place)
}
