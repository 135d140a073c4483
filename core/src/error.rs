//! What can go wrong, each with the sentence that a user sees.

use core::fmt;

/// Why a stepper couldn't be built, or a motion not be started.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SetupError {
    /// A parameter has a value that can't be used.
    Parameter {
        /// The field of the Lagrangian.
        field: &'static str,
        /// What is wrong with it.
        cause: &'static str,
    },
    /// A parameter of one of several bodies has a value that can't be used.
    BodyParameter {
        /// The body, from zero.
        body: usize,
        /// The field of it.
        field: &'static str,
        /// What is wrong with it.
        cause: &'static str,
    },
    /// A joint can't be where it was put.
    Joint {
        /// The joint, from zero: those of trees first, then those that close loops.
        joint: usize,
        /// What is wrong with it.
        cause: &'static str,
    },
    /// A parameter of a joint has a value that can't be used.
    JointParameter {
        /// The joint, from zero.
        joint: usize,
        /// The field of it.
        field: &'static str,
        /// What is wrong with it.
        cause: &'static str,
    },
    /// A joint is open where the motion is to start, and of all it is open farthest.
    OffConstraint {
        /// The joint, from zero.
        joint: usize,
        /// By how much, in the units of its functions: m, of axes the cosine.
        by: f64,
    },
    /// The initial velocities would open a joint, and this one the fastest.
    OffVelocity {
        /// The joint, from zero.
        joint: usize,
        /// How fast, in the units of its functions per second: m/s, of axes the cosine per second.
        by: f64,
    },
    /// A joint has nothing to do that the others, or its own functions, don't, at least along one direction, and at least where the motion is to
    /// start: its force isn't determined.
    RedundantJoint {
        /// The joint, from zero.
        joint: usize,
        /// What the others leave it to do, relative to what it would have to between free bodies.
        pivot: f64,
    },
    /// The step is NaN or infinite, or so small or large that the constants of the step leave the scalar's range.
    InvalidStep {
        /// The step, s.
        step: f64,
    },
    /// The kinetic part is degenerate at rest: a momentum doesn't determine a velocity.
    SingularKinetic {
        /// The determinant of the inertia of the continuous limit.
        determinant: f64,
        /// The body of a system, or the factor of a product, from zero, along which it is once those before are eliminated.
        /// None where there is but one, or where no pivot is zero and their product is out of range.
        body: Option<usize>,
    },
    /// The kinetic energy is negative along a direction.
    NegativeKinetic {
        /// The smallest pivot of the inertia of the continuous limit, relative to its entry of the diagonal.
        pivot: f64,
        /// The body of a system, or the factor of a product, from zero, that it is of. None where there is but one.
        body: Option<usize>,
    },
    /// A constant of the scene isn't finite, whatever the step.
    NonFiniteConstant,
    /// A part of the initial state isn't finite.
    NonFinite {
        /// Which part.
        what: &'static str,
    },
    /// No velocity has the initial momentum, or none on whose side of the singularities of `∂²l/∂ξ²` rest is.
    NoVelocity,
    /// The momentum of the initial velocity is that of another, which the motion would start with.
    AmbiguousVelocity {
        /// By how much the two differ, relative to the one that was given, both measured by the momentum that they would
        /// have with the inertia at rest. NaN where the velocity has no momentum, or its momentum no velocity.
        difference: f64,
    },
    /// A vector that is to be of length one isn't.
    NotUnit {
        /// Which one.
        what: &'static str,
        /// Its length.
        length: f64,
    },
    /// A body that is to move as a direction isn't symmetric about its axis.
    NotAxisymmetric {
        /// How far an entry of its nonstandard inertia is from that of a symmetric one at most, kg m².
        difference: f64,
    },
    /// A body that is to move as a direction has a velocity about its axis.
    Spin {
        /// That part of the velocity, rad/s.
        spin: f64,
    },
    /// The initial attitude isn't in the group.
    NotInGroup {
        /// How far the matrix is from the relation of the group.
        defect: f64,
    },
    /// A splitting needs a Lagrangian `K(F) − (h/2) (V(w) + V(F⁻¹·w))`.
    NotSeparable {
        /// How much the rest depends on `w` when the half kicks are taken away, relative to its size.
        defect: f64,
    },
    /// The kinetic flow of a splitting is that of another body than the Lagrangian's.
    InertiaMismatch {
        /// The largest difference of two entries, kg m².
        difference: f64,
    },
    /// The method has the motion of one free body in it, and the inertia depends on what is advected or given, or on the
    /// velocity.
    VaryingInertia,
    /// The kinetic flow of a splitting has other rotors than the Lagrangian, or none.
    BiasMismatch,
    /// A splitting with force gradients needs the derivative of the torque: a term has no `kick_derivative`.
    NoForceGradient,
    /// A splitting with force gradients can't be linearised: a term has no `kick_gradient`.
    NoSecondDerivatives,
    /// The scene has another step of `−h` than the inverse of its step of `h`.
    NotSelfAdjoint,
    /// A stepper or a state can't be in a lane beside the others: lanes share the scheme of a method and the number of
    /// steps made, for example.
    Unlike {
        /// The first such lane.
        lane: usize,
    },
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parameter { field, cause } => write!(f, "parameter `{field}` {cause}; give it another value"),
            Self::BodyParameter { body, field, cause } => {
                write!(f, "parameter `{field}` of the body {body} (from zero) {cause}; give it another value")
            }
            Self::Joint { joint, cause } => {
                write!(f, "the joint {joint} (from zero) {cause}; check the bodies that it joins")
            }
            Self::JointParameter { joint, field, cause } => {
                write!(f, "parameter `{field}` of the joint {joint} (from zero) {cause}; give it another value")
            }
            Self::OffConstraint { joint, by } => write!(
                f,
                "the joint {joint} (from zero) is open by {by:e} (in the units of its functions: m, of axes the cosine); give other places, or let `start_nearest` close the joints"
            ),
            Self::OffVelocity { joint, by } => write!(
                f,
                "the initial velocities open the joint {joint} (from zero) by {by:e} (in the units of its functions per second: m/s, of axes the cosine per second); give others, or let `start_nearest` find those next to them"
            ),
            Self::RedundantJoint { joint, pivot } => write!(
                f,
                "the others, or its own functions, do a part of what the joint {joint} (from zero) is to do (pivot {pivot:e}), at least where the motion starts; take one with fewer functions, or start elsewhere"
            ),
            Self::InvalidStep { step } => write!(
                f,
                "the step {step:e} s can't be used; choose a finite one of the order of the motion's time scale"
            ),
            Self::SingularKinetic { determinant, body } => write!(
                f,
                "the kinetic part{} is singular at rest (determinant {determinant:e}): a momentum doesn't determine a velocity; give every direction an inertia",
                OfBody(*body)
            ),
            Self::NegativeKinetic { pivot, body } => write!(
                f,
                "the kinetic part{} is negative along a direction (pivot {pivot:e}, relative to the inertia there); check its sign, the `.transpose()` in it, and the signs of its parameters",
                OfBody(*body)
            ),
            Self::NonFiniteConstant => f.write_str(
                "a constant of the scene is not finite: a divisor is zero, a root or a logarithm has no value, or a product is out of range; give the parameters other values",
            ),
            Self::NonFinite { what } => write!(f, "the initial {what} is not finite; give finite numbers, far from the ends of the scalar's range"),
            Self::NoVelocity => f.write_str(
                "no velocity that rest can be continued to has the initial momentum; choose a momentum nearer to that at rest",
            ),
            Self::AmbiguousVelocity { difference } if difference.is_nan() => write!(
                f,
                "the initial velocity has no momentum, or none that determines a velocity: it is out of the range in which the Lagrangian is defined and regular; choose a velocity nearer to rest"
            ),
            Self::AmbiguousVelocity { difference } => write!(
                f,
                "the momentum of the initial velocity is that of another velocity, too (relative difference {difference:e}): the kinetic part is singular between rest and it; choose a velocity nearer to rest"
            ),
            Self::NotUnit { what, length } => {
                write!(f, "the {what} has the length {length:e}; give one of length one")
            }
            Self::NotAxisymmetric { difference } => write!(
                f,
                "the body isn't symmetric about the axis: an entry of its nonstandard inertia is {difference:e} kg m² from that of one that is; give its axis of symmetry, or start it by an attitude"
            ),
            Self::Spin { spin } => write!(
                f,
                "the velocity has the part {spin:e} rad/s about the direction, which doesn't move that; give one at right angles to it, or start the body by an attitude"
            ),
            Self::NotInGroup { defect } => {
                write!(
                    f,
                    "the initial attitude is not in the group (defect {defect:e}, more than rounding); normalise it first"
                )
            }
            Self::NotSeparable { .. }
            | Self::InertiaMismatch { .. }
            | Self::VaryingInertia
            | Self::BiasMismatch
            | Self::NoForceGradient
            | Self::NoSecondDerivatives
            | Self::NotSelfAdjoint
            | Self::Unlike { .. } => self.fmt_method(f),
        }
    }
}

impl SetupError {
    /// What a method asks of a scene.
    fn fmt_method(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotSeparable { defect } => write!(
                f,
                "the Lagrangian is not K(F) − (h/2) (V(w) + V(F⁻¹·w)) (defect {defect:e}, more than rounding), so it can't be split; compose it instead"
            ),
            Self::InertiaMismatch { difference } => write!(
                f,
                "the kinetic flow is that of another body: two entries of the inertias differ by {difference:e}; build both from one"
            ),
            Self::VaryingInertia => f.write_str(
                "the inertia depends on what is advected or given, or on the velocity, and this method needs one that is the same everywhere; compose the scene's own step instead",
            ),
            Self::BiasMismatch => f.write_str(
                "the kinetic flow hasn't the momentum at rest that the Lagrangian has, or has another: rotors differ; compose the scene instead, or choose a flow that has them",
            ),
            Self::NoForceGradient => f.write_str(
                "a term of the scene has no `kick_derivative` and so no force gradient: it was written without, or declared with a torque behind a `let` that stays closed; choose a scheme without them, or write the torque without the `let`",
            ),
            Self::NoSecondDerivatives => f.write_str(
                "the derivatives of a term of the scene were written without `kick_gradient`, so those of its force gradient aren't known; choose a scheme without them, or write it",
            ),
            Self::NotSelfAdjoint => f.write_str(
                "the step of −h doesn't undo that of h, which a composition and an inverse need: l_d(F, w, h) isn't −l_d(F⁻¹, F⁻¹·w, −h); take the mean of both, as the trapezoid does",
            ),
            Self::Unlike { lane } => write!(
                f,
                "the body of lane {lane} can't be stepped beside those before it: they have another method, or have made another number of steps; build a batch of like ones"
            ),
            _ => Ok(()),
        }
    }
}

impl core::error::Error for SetupError {}

/// Whose a kinetic part is, if there are several.
struct OfBody(Option<usize>);

impl fmt::Display for OfBody {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(Some(body)) = self else { return Ok(()) };
        write!(f, " of the body or factor {body} (from zero)")
    }
}

/// Why a step couldn't be made. The state is then what it was before.
///
/// Of several lanes one was enough; a number in which the lanes differ is NaN.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum StepError {
    /// A part of the state isn't finite, before the step or after it; or the momentum equation (2.7) isn't, where a force or
    /// a potential has no value.
    NonFinite {
        /// Which part, or `"momentum equation"`.
        what: &'static str,
    },
    /// The momentum equation (2.7) has no solution that continues the identity at this step, but has one at a smaller.
    BeyondSolvable {
        /// The step that was asked for, s.
        step: f64,
        /// The largest step that this state allows, s.
        largest: f64,
        /// How far the body would turn at the velocity that it has after the first kick, rad; of several lanes the largest.
        /// A potential of the middle of a step isn't in that kick. Zero where nothing is known to turn, as in a translation.
        turn: f64,
        /// The body of a system that this is said of, from zero: the one that would turn farthest, of several lanes in that of
        /// the largest. None where there is but one, where none turns, or where bodies are declared as one product, of which
        /// `turn` is that of all.
        body: Option<usize>,
    },
    /// The body would turn by an angle of which the scalar has no digit left.
    AngleWithoutDigits {
        /// The angle, rad.
        turn: f64,
    },
    /// The iteration didn't settle: Newton's, or the fixed-point iteration of [`Gauss`](crate::methods::Gauss).
    NotConverged {
        /// How many iterations were made.
        iterations: u32,
        /// The size of the last update relative to the unknown.
        residual: f64,
    },
    /// The iteration settled on a solution that doesn't continue the identity.
    WrongBranch {
        /// The determinant of the Jacobian there, or NaN. Its sign differs from that at the identity, or else the
        /// trace's does. Of joined bodies it is that of the whole system, relative to its diagonal.
        determinant: f64,
    },
    /// The Jacobian is singular at an iterate.
    Singular,
    /// A joint that closes a loop is at a singular position, or the step meets one: the others leave the joint nothing to do
    /// along one direction, and its force isn't determined.
    SingularJoint {
        /// The joint, from zero: those of trees first, then those that close loops.
        joint: usize,
        /// What the others leave it to do, relative to what it would have to between free bodies.
        pivot: f64,
    },
    /// One of several bodies that move each other has no increment that continues the identity at this step.
    UnsolvedBody {
        /// The body, from zero: the first that turns too far where the iteration has ended, or whose part of the Jacobian
        /// has the wrong sign there. Where it has ended in no numbers, the one that would turn farthest.
        body: usize,
        /// How far it would turn at the velocity that it has after the first kick, rad.
        turn: f64,
        /// The determinant of its part of the Jacobian, once the bodies behind it are eliminated, where the iteration has
        /// ended; NaN where that is nowhere.
        determinant: f64,
    },
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NonFinite { what: "momentum equation" } => f.write_str(
                "the momentum equation is not finite: a force or a potential has no value here, or one out of range; check its parameters, or start elsewhere",
            ),
            Self::NonFinite { what } => {
                write!(f, "the {what} is not finite; choose units in which the numbers are nearer to one")
            }
            Self::BeyondSolvable { step, largest, turn, body } => {
                write!(f, "no solution at the step {step:e} s")?;
                // In lanes that differ the largest step isn't one number.
                let is_known = !largest.is_nan();
                if *turn > 0.0 {
                    f.write_str(": the body ")?;
                    if let Some(body) = body {
                        write!(f, "{body} (from zero) ")?;
                    }
                    write!(f, "would turn by about {turn:.2e} rad, ")?;
                    if is_known {
                        write!(f, "and {:.2e} rad is the most from this state", turn * (largest / step))?;
                    } else {
                        f.write_str("which is too far")?;
                    }
                }
                if is_known {
                    write!(f, "; take steps of at most {largest:e} s")?;
                } else {
                    f.write_str("; take smaller steps")?;
                }
                f.write_str(", or let `or_substeps` divide such steps")?;
                if is_known && *turn > 0.0 {
                    f.write_str(". On SO(3) the kinetic part of `CayleyBody` has no such limit")?;
                }
                Ok(())
            }
            Self::AngleWithoutDigits { turn } => {
                write!(f, "the body would turn by {turn:.2e} rad, of which no digit is left; take a smaller step")
            }
            Self::NotConverged { residual, .. } if !residual.is_finite() => {
                f.write_str("the iteration runs out of all bounds; try a smaller step")
            }
            Self::NotConverged { iterations, residual } => write!(
                f,
                "the iteration did not settle in {iterations} iterations (last relative update {residual:e}); try a smaller step"
            ),
            Self::WrongBranch { determinant } => write!(
                f,
                "the solution found doesn't continue the identity (Jacobian determinant {determinant:e}: its sign or that of the trace is wrong); try a smaller step"
            ),
            Self::Singular => write!(f, "the Newton Jacobian is singular; try a smaller step"),
            Self::SingularJoint { joint, pivot } => write!(
                f,
                "the joint {joint} (from zero) comes to a singular position (pivot {pivot:e}), where its force isn't determined; take a joint with fewer functions, smaller steps, or another way"
            ),
            Self::UnsolvedBody { body, turn, determinant } => write!(
                f,
                "no increment of the body {body} (from zero) that continues the identity: it would turn by {turn:.2e} rad, and its part of the Jacobian has the determinant {determinant:e}; take smaller steps"
            ),
        }
    }
}

impl core::error::Error for StepError {}

#[cfg(test)]
mod tests;
