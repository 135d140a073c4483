//! The nonlinear equations of a step.

use core::f64::consts::FRAC_PI_2;

use nalgebra::{Vector2, Vector6};

roots!();

use super::equations::held_gap;
use super::parts;
use super::stepper::MultibodyStepper;
use super::workspace::Workspace;
use crate::error::StepError;
use crate::solving::{Curvature, LONGEST_DAMPED, MAX_DAMPED_ITERATIONS, MAX_ITERATIONS};

/// The relative rounding error of an update, by places and by opposed forces.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// The longest update, relative to the unknowns, that is rounding if it isn't a quarter of the one before; both as
/// squares.
///
/// The updates of bodies whose masses differ by `r` have rounding errors of `r ε`. An update of Newton's iteration is
/// `C` times the square of the one before. At this length one that isn't rounding is a quarter of it only for `C`
/// above two millions, where chains in a close pass have some thousand.
const ROUNDING: (f64, f64) = (1e-14, 1.0 / 16.0);

/// The longest update of Newton's iteration, relative to the unknowns and as a square, after which its Jacobian is used again: two
/// further updates by it are shorter by some hundred-thousandths each.
const NEAR: f64 = 1e-9;

/// The longest distance of a solution from the guess, relative to the unknowns, at which it continues the motion whatever
/// the sign of the determinant; as a square.
///
/// The sign changes where a linkage passes its change point, along which increments are smooth in time: the guess, by up to
/// eight of them, is off by some millionth. A strut's solution on its other side is farther from the guess than the unknowns
/// are long.
const CONTINUED: f64 = 1e-6;

/// The squared lengths of the turn and of the shift.
fn squares(of: &Vector6<f64>) -> Vector2<f64> {
    let (turn, shift) = parts(of);
    Vector2::new(turn.norm_squared(), shift.norm_squared())
}

/// The momentum equations of a step from the workspace's `now` with its `a`, and the constraints at its end.
pub(super) struct Problem<'a> {
    pub(super) stepper: &'a MultibodyStepper,
    pub(super) work: &'a mut Workspace,
    /// The weight `1/length²`, 1/m², of squared shifts against squared turns, with the shortest of the bodies' lengths.
    weight: f64,
    /// The squared scale of the rounding errors of places, in rad².
    extent: f64,
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

impl<'a> Problem<'a> {
    /// The equations; the slopes before the step are set in the workspace.
    pub(super) fn new(stepper: &'a MultibodyStepper, work: &'a mut Workspace) -> Self {
        let length = stepper.lengths.iter().copied().fold(f64::INFINITY, f64::min);
        let extent = work.equations.extent(&work.places) / length;
        // Attitudes have entries of size one and their rounding errors.
        Self { stepper, work, weight: 1.0 / (length * length), extent: 1.0 + extent * extent, met: None }
    }

    /// One Newton iteration.
    fn newton(&mut self, longest: f64) -> Update {
        let (stepper, work) = (self.stepper, &mut *self.work);
        work.set_next(&stepper.tree);
        stepper.set_newton(&work.now, &work.a, &work.half, &mut work.coefficients);
        // Gaps are halved: the unknowns are half the coordinates, so a shift is twice its unknown.
        work.equations.set_after(stepper.joints(), &stepper.tree, &work.next_places, &work.turns);
        work.equations.factorise(&stepper.tree, &work.coefficients);
        self.met = work.equations.redundant(&stepper.tree);
        self.update(longest)
    }

    /// One simplified iteration, with the last Jacobian.
    fn simplified(&mut self) -> Update {
        let (stepper, work) = (self.stepper, &mut *self.work);
        work.set_next(&stepper.tree);
        stepper.set_residuals(&work.now, &work.a, &work.half, &mut work.coefficients.vectors);
        self.update(f64::INFINITY)
    }

    /// Solves for the update and applies it. If a body would turn by more than `longest`, all updates are scaled down.
    fn update(&mut self, longest: f64) -> Update {
        let (stepper, weights) = (self.stepper, self.weights());
        let Workspace { equations, coefficients, next_places, half, .. } = &mut *self.work;
        let joints = stepper.joints();
        let half_gap = |joint: usize, is_held: bool| held_gap(&joints[joint], next_places, is_held) * 0.5;
        let opposed = equations.solve(&stepper.tree, &coefficients.vectors, half_gap);
        let (mut update, mut largest, mut size) = (0.0, 0.0_f64, 0.0);
        for part in &equations.unknowns.bodies {
            update += squares(part).dot(&weights);
            largest = largest.max(parts(part).0.norm_squared());
        }
        let part = if largest > longest * longest { longest / largest.sqrt() } else { 1.0 };
        for (half, update) in half.iter_mut().zip(&equations.unknowns.bodies) {
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
        // The length of the last update, if it wasn't shortened, and if it was one of Newton's iteration.
        let (mut made, mut before, mut told) = (0, f64::INFINITY, None);
        for _ in 0..most {
            made += 1;
            let Update { length: update, size, largest, rounded } = self.newton(longest);
            if !size.is_finite() {
                return (made, false);
            }
            let is_rounding = before.max(update) <= size * ROUNDING.0 && update >= before * ROUNDING.1;
            let curvature = Curvature::told(told, update);
            if curvature.has_settled(update, size) || update <= rounded || is_rounding {
                return (made, self.is_wanted());
            }
            let is_whole = largest <= longest * longest;
            before = if is_whole { update } else { f64::INFINITY };
            told = is_whole.then_some(update);
            // An update by the last Jacobian takes half the time of one by its own, and shortens the next by a constant factor.
            let (mut last, mut is_near) = (update, is_whole && update <= size * NEAR);
            while is_near && made < most {
                let Update { length, size, rounded, .. } = self.simplified();
                made += 1;
                if length <= rounded || curvature.has_sufficed(last, length, size) {
                    return (made, self.is_wanted());
                }
                let factor = length / last;
                is_near = curvature.has_sufficed(length, length * factor, size);
                (last, told) = (length, None);
            }
        }
        (made, false)
    }

    fn is_wanted(&self) -> bool {
        let equations = &self.work.equations;
        let is_regular = || equations.reversed().is_none() && equations.redundant(&self.stepper.tree).is_none();
        self.turned_too_far().is_none() && equations.wrong_body().is_none() && (is_regular() || self.is_continued())
    }

    /// Whether the solution is next to the guess. The functions of joints are independent at the start of each step, and the
    /// projection finds out whether they are at its end.
    fn is_continued(&self) -> bool {
        let Workspace { guess, half, .. } = &*self.work;
        let length = |of: Vector6<f64>| squares(&of).dot(&self.weights());
        let (distance, size) = guess.iter().zip(half).fold((0.0, 0.0), |(distance, size), (guess, half)| {
            (distance + length(half - guess), size + length(*half))
        });
        distance <= size * CONTINUED
    }

    fn turned_too_far(&self) -> Option<usize> {
        let is_near = |half: &Vector6<f64>| parts(half).0.norm_squared() < 1.0;
        self.work.half.iter().position(|half| !is_near(half))
    }

    /// Solves from the guess in `half`; if that fails from the velocity, and then from rest with shortened updates.
    pub(super) fn solve(&mut self) -> Result<u32, StepError> {
        self.work.guess.copy_from_slice(&self.work.half);
        let (mut spent, is_solved) = self.attempt(MAX_ITERATIONS, f64::INFINITY);
        if is_solved {
            return Ok(spent);
        }
        let Workspace { now, momenta, slow, half, .. } = &mut *self.work;
        self.stepper.estimate(now, momenta, slow);
        half.copy_from_slice(slow);
        for (most, longest) in [(MAX_ITERATIONS, f64::INFINITY), (MAX_DAMPED_ITERATIONS, LONGEST_DAMPED)] {
            let (made, is_solved) = self.attempt(most, longest);
            spent += made;
            if is_solved {
                return Ok(spent);
            }
            if longest.is_infinite() {
                self.work.half.fill(Vector6::zeros());
            }
        }
        Err(self.reason(spent))
    }

    /// The error of a failed step. It blames a body that is too fast, a joint with a singular position at the last
    /// iterate, or the body where the iteration ended.
    #[cold]
    fn reason(&self, iterations: u32) -> StepError {
        let Workspace { equations, half, slow, .. } = &*self.work;
        let turn = |body: usize| 2.0 * parts(&slow[body]).0.norm();
        let blamed =
            |body: usize| StepError::UnsolvedBody { body, turn: turn(body), determinant: equations.determinant(body) };
        let fastest = (0..half.len()).max_by(|&a, &b| turn(a).total_cmp(&turn(b))).unwrap_or(0);
        if turn(fastest) > FRAC_PI_2 {
            return blamed(fastest);
        }
        if let Some((joint, pivot)) = self.met {
            return StepError::SingularJoint { joint, pivot };
        }
        if !half.iter().all(|half| half.iter().copied().all(crate::numbers::is_finite)) {
            return blamed(fastest);
        }
        if let Some(body) = self.turned_too_far().or(equations.wrong_body()) {
            return blamed(body);
        }
        if let Some(determinant) = equations.reversed() {
            return StepError::WrongBranch { determinant };
        }
        let square = |of: &[Vector6<f64>]| of.iter().map(|part| squares(part).dot(&self.weights())).sum::<f64>();
        let (update, size) = (square(&equations.unknowns.bodies), square(half));
        // At rest there is no size that an update is relative to.
        StepError::NotConverged { iterations, residual: (update / if size > 0.0 { size } else { 1.0 }).sqrt() }
    }
}
