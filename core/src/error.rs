//! Errors of a stepper's setup and of a step.

use alloc::borrow::ToOwned as _;
#[cfg(all(feature = "serde", feature = "std"))]
use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::String;

use thiserror::Error;

/// A text with a static lifetime: deserialising a `&str` would borrow from the input.
pub(crate) type Text = &'static str;

/// Deserialises a static text; each distinct one is leaked once.
#[cfg(all(feature = "serde", feature = "std"))]
pub(crate) fn kept<'de, D: serde::Deserializer<'de>>(source: D) -> Result<Text, D::Error> {
    static KNOWN: std::sync::Mutex<BTreeSet<Text>> = std::sync::Mutex::new(BTreeSet::new());
    let text: String = serde::Deserialize::deserialize(source)?;
    let mut known = KNOWN.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let text = known.get(text.as_str()).copied().unwrap_or_else(|| String::leak(text));
    known.insert(text);
    Ok(text)
}

/// An error of building a stepper, or of starting a motion.
#[derive(Clone, Debug, PartialEq, Error)]
#[cfg_attr(all(feature = "serde", feature = "std"), derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum SetupError {
    /// A parameter has a value that can't be used.
    #[error("parameter `{field}` {cause}; give it another value")]
    Parameter {
        /// The field of the Lagrangian.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        field: Text,
        /// The fault, as a predicate.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        cause: Text,
    },
    /// A method that the scene, or its group, doesn't have.
    #[error("the method {cause}")]
    Method {
        /// The reason, as a predicate, and the method to take instead.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        cause: Text,
    },
    /// A list of numbers has another length than the group's.
    #[error(
        "the {what} has {found} numbers and not {expected}; give the entries of matrices row by row, and all components"
    )]
    Length {
        /// Name of the list.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        what: Text,
        /// Length of the list.
        found: usize,
        /// Length of the group's list.
        expected: usize,
    },
    /// A parameter of one of several bodies has a value that can't be used.
    #[error("parameter `{field}` of the body {body} (from zero) {cause}; give it another value")]
    BodyParameter {
        /// The body, from zero.
        body: usize,
        /// The field of the body.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        field: Text,
        /// The fault, as a predicate.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        cause: Text,
    },
    /// A term of a system is at no body.
    #[error("{cause}; give the number of a body that was added before, from zero")]
    Place {
        /// The fault, as a sentence.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        cause: Text,
    },
    /// A joint doesn't fit the bodies that it joins.
    #[error("the joint {joint} (from zero) {cause}; check the bodies that it joins")]
    Joint {
        /// The joint, from zero.
        joint: usize,
        /// The fault, as a predicate.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        cause: Text,
    },
    /// A parameter of a joint has a value that can't be used.
    #[error("parameter `{field}` of the joint {joint} (from zero) {cause}; give it another value")]
    JointParameter {
        /// The joint, from zero.
        joint: usize,
        /// The field of the joint.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        field: Text,
        /// The fault, as a predicate.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        cause: Text,
    },
    /// Joints are open at the initial positions; this one is open the farthest.
    #[error(
        "the joint {joint} (from zero) is open by {by:e} (in the units of its functions: m, of axes the cosine); give other places, or let `start_nearest` close the joints"
    )]
    OffConstraint {
        /// The joint, from zero.
        joint: usize,
        /// Size of the gap, in the units of the joint's functions: m, for axes the cosine.
        by: f64,
    },
    /// The initial velocities would open joints; this one opens the fastest.
    #[error(
        "the initial velocities open the joint {joint} (from zero) by {by:e} (in the units of its functions per second: m/s, of axes the cosine per second); give others, or let `start_nearest` find those next to them"
    )]
    OffVelocity {
        /// The joint, from zero.
        joint: usize,
        /// Rate of opening, in the units of the joint's functions per second: m/s, for axes the cosine per second.
        by: f64,
    },
    /// A joint is redundant along at least one direction, at least where the motion starts: other joints, or its own
    /// functions, constrain the same motion, and its force isn't determined.
    #[error(
        "the others, or its own functions, do a part of what the joint {joint} (from zero) is to do (pivot {pivot:e}), at least where the motion starts; take the system that `Multibody::independent` makes, or one with fewer functions, or start elsewhere"
    )]
    RedundantJoint {
        /// The joint, from zero.
        joint: usize,
        /// Pivot of the joint, relative to its value between free bodies.
        pivot: f64,
    },
    /// The initial velocity violates a constraint on velocities.
    #[error(
        "the initial velocity violates the constraint {constraint} (from zero) on velocities, by {by:e} of its size; give one that satisfies it"
    )]
    ViolatedConstraint {
        /// The constraint, from zero.
        constraint: usize,
        /// The cosine of the angle between the constraint's covector and the velocity, in components.
        by: f64,
    },
    /// A constraint on velocities demands nothing that those before it don't, at least where the motion starts.
    #[error(
        "the constraint {constraint} (from zero) on velocities demands nothing that those before it don't, at least where the motion starts; give independent ones, or another start"
    )]
    RedundantConstraint {
        /// The constraint, from zero.
        constraint: usize,
    },
    /// Constraints on velocities, as many as the group has dimensions or more, leave no motion.
    #[error("{constraints} constraints on velocities leave no motion on a group of dimension {dimension}; give fewer")]
    NoMotion {
        /// The number of constraints.
        constraints: usize,
        /// The dimension of the group.
        dimension: usize,
    },
    /// The step is NaN or infinite, or so small or large that the constants of the step leave the scalar's range.
    #[error("the step {step:e} s can't be used; choose a finite one of the order of the motion's time scale")]
    InvalidStep {
        /// The step, s.
        step: f64,
    },
    /// The kinetic part is degenerate at rest: a momentum doesn't determine a velocity.
    #[error("the kinetic part{} is singular at rest (determinant {determinant:e}): a momentum doesn't determine a velocity; give every direction an inertia", of_body(*.body))]
    SingularKinetic {
        /// The determinant of the inertia of the continuous limit.
        determinant: f64,
        /// The body of a system, or the factor of a product, from zero, whose inertia is singular once those before are
        /// eliminated. None if there is only one, or if no pivot is zero and their product is out of range.
        body: Option<usize>,
    },
    /// The kinetic energy is negative along a direction.
    #[error("the kinetic part{} is negative along a direction (pivot {pivot:e}, relative to the inertia there); check its sign, the `.transpose()` in it, and the signs of its parameters", of_body(*.body))]
    NegativeKinetic {
        /// The smallest pivot of the inertia of the continuous limit, relative to its entry of the diagonal.
        pivot: f64,
        /// The body of a system, or the factor of a product, from zero. None if there is only one.
        body: Option<usize>,
    },
    /// A constant of the scene isn't finite for any step.
    #[error(
        "a constant of the scene is not finite: a divisor is zero, a root or a logarithm has no value, or a product is out of range; give the parameters other values"
    )]
    NonFiniteConstant,
    /// A part of the initial state isn't finite.
    #[error("the initial {what} is not finite; give finite numbers, far from the ends of the scalar's range")]
    NonFinite {
        /// Name of the part.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        what: Text,
    },
    /// No velocity has the initial momentum, or only velocities that a singularity of `∂²l/∂ξ²` separates from rest.
    #[error(
        "no velocity that rest can be continued to has the initial momentum; choose a momentum nearer to that at rest"
    )]
    NoVelocity,
    /// The momentum of the initial velocity belongs to a second velocity, with which the motion would start.
    #[error("{}; choose a velocity nearer to rest", ambiguity(*.difference))]
    AmbiguousVelocity {
        /// Difference of the two velocities relative to the initial one, both measured by the momentum that they would
        /// have with the inertia at rest. NaN if the velocity has no momentum, or its momentum no velocity.
        difference: f64,
    },
    /// A unit vector doesn't have the length one.
    #[error("the {what} has the length {length:e}; give one of length one")]
    NotUnit {
        /// Name of the vector.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        what: Text,
        /// Length of the vector.
        length: f64,
    },
    /// A body that is simulated by the direction of its axis isn't symmetric about that axis.
    #[error(
        "the body isn't symmetric about the axis: an entry of its nonstandard inertia is {difference:e} kg m² from that of one that is; give its axis of symmetry, or start it by an attitude"
    )]
    NotAxisymmetric {
        /// Largest difference of an entry of the nonstandard inertia to that of a symmetric body, kg m².
        difference: f64,
    },
    /// A body that is simulated by the direction of its axis has a velocity about that axis.
    #[error(
        "the velocity has the part {spin:e} rad/s about the direction, which doesn't move that; give one at right angles to it, or start the body by an attitude"
    )]
    Spin {
        /// Component of the velocity about the axis, rad/s.
        spin: f64,
    },
    /// The initial attitude isn't in the group.
    #[error("the initial attitude is not in the group (defect {defect:e}, more than rounding); normalise it first")]
    NotInGroup {
        /// Residual of the relation of the group for this matrix.
        defect: f64,
    },
    /// A splitting needs a Lagrangian `K(F) − (h/2) (V(w) + V(F⁻¹·w))`.
    #[error(
        "the Lagrangian is not K(F) − (h/2) (V(w) + V(F⁻¹·w)) (defect {defect:e}, more than rounding), so it can't be split; compose it instead"
    )]
    NotSeparable {
        /// Dependence of the rest on `w` once the half kicks are subtracted, relative to its size.
        defect: f64,
    },
    /// The kinetic flow of a splitting has another inertia than the Lagrangian.
    #[error(
        "the kinetic flow is that of another body: two entries of the inertias differ by {difference:e}; build both from one"
    )]
    InertiaMismatch {
        /// The largest difference of two entries, kg m².
        difference: f64,
    },
    /// The inertia depends on an advected or prescribed parameter, or on the velocity, and the method contains the
    /// motion of one free body.
    #[error(
        "the inertia depends on what is advected or given, or on the velocity, and this method needs one that is the same everywhere; compose the scene's own step instead"
    )]
    VaryingInertia,
    /// The kinetic flow of a splitting has other rotors than the Lagrangian, or lacks them.
    #[error(
        "the kinetic flow hasn't the momentum at rest that the Lagrangian has, or has another: rotors differ; compose the scene instead, or choose a flow that has them"
    )]
    BiasMismatch,
    /// A splitting with force gradients needs the derivative of the torque: a term has no `kick_derivative`.
    #[error(
        "a term of the scene has no `kick_derivative` and so no force gradient: it was written without, or declared with a torque behind a `let` that stays closed; choose a scheme without them, or write the torque without the `let`"
    )]
    NoForceGradient,
    /// A splitting with force gradients can't be linearised: a term has no `kick_gradient`.
    #[error(
        "the derivatives of a term of the scene aren't known: they were written without `kick_gradient`, which a force gradient asks for, or read from a text without `gradients`; choose another scheme, or write it"
    )]
    NoSecondDerivatives,
    /// The step of `−h` isn't the inverse of the step of `h`.
    #[error(
        "the step of −h doesn't undo that of h, which a composition and an inverse need: l_d(F, w, h) isn't −l_d(F⁻¹, F⁻¹·w, −h); take the mean of both, as the trapezoid does"
    )]
    NotSelfAdjoint,
    /// A stepper or a state can't share a batch with those in the lanes before it. Lanes share the scheme of a method
    /// and the number of steps made, for example.
    #[error(
        "the body of lane {lane} can't be stepped beside those before it: they have another method, or have made another number of steps; build a batch of like ones"
    )]
    Unlike {
        /// The first lane that differs.
        lane: usize,
    },
}

impl SetupError {
    /// Checks the number of a list's numbers.
    ///
    /// # Errors
    ///
    /// [`SetupError::Length`] if it is another than expected.
    pub const fn check_length(what: &'static str, found: usize, expected: usize) -> Result<(), Self> {
        if found == expected { Ok(()) } else { Err(Self::Length { what, found, expected }) }
    }
}

/// The body that the kinetic part belongs to, if there are several.
fn of_body(body: Option<usize>) -> String {
    body.map_or_else(String::new, |body| format!(" of the body or factor {body} (from zero)"))
}

/// The message for an ambiguous initial velocity, from its difference to the velocity with the same momentum.
fn ambiguity(difference: f64) -> String {
    if difference.is_nan() {
        return "the initial velocity has no momentum, or none that determines a velocity: it is out of the range in which the Lagrangian is defined and regular".to_owned();
    }
    format!(
        "the momentum of the initial velocity is that of another velocity, too (relative difference {difference:e}): the kinetic part is singular between rest and it"
    )
}

/// An error of a step. The state is unchanged.
///
/// In a batch one failing lane is enough; a number in which the lanes differ is NaN.
#[derive(Clone, Debug, PartialEq, Error)]
#[cfg_attr(all(feature = "serde", feature = "std"), derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum StepError {
    /// A part of the state isn't finite, before the step or after it; or the momentum equation (2.7) isn't finite,
    /// because a force or a potential has no value.
    #[error(
        "the {what} is not finite{}",
        if *.what == "momentum equation" {
            ": a force or a potential has no value here, or one out of range; check its parameters, or start elsewhere"
        } else {
            "; choose units in which the numbers are nearer to one"
        }
    )]
    NonFinite {
        /// Name of the part, or `"momentum equation"`.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        what: Text,
    },
    /// The momentum equation (2.7) has no solution on the branch of the identity at this step, but has one at a smaller
    /// step. Near the largest step the phase of (3.13) is off by half a turn in each; [`effects`](crate::effects) has kinetic parts that bear more.
    #[error("no solution at the step {step:e} s{}", beyond_solvable([*.step, *.largest, *.turn], *.body))]
    BeyondSolvable {
        /// The attempted step, s.
        step: f64,
        /// The largest step that this state allows, s.
        largest: f64,
        /// Angle by which the body would turn with the velocity after the first kick, rad; the largest of several
        /// lanes. A potential in the middle of a step isn't in that kick. Zero if no rotation is known, as in a
        /// translation.
        turn: f64,
        /// The body of a system that would turn farthest, from zero, in the lane with the largest angle. None if there
        /// is only one body, if none turns, or if bodies are declared as one product: then `turn` is that of all.
        body: Option<usize>,
    },
    /// The body would turn by an angle too large for the scalar to resolve a turn.
    #[error("the body would turn by {turn:.2e} rad, of which no digit is left; take a smaller step")]
    AngleWithoutDigits {
        /// The angle, rad.
        turn: f64,
    },
    /// The iteration didn't converge: Newton's, or the fixed-point iteration of [`Gauss`](crate::methods::Gauss).
    #[error("the iteration {}; try a smaller step", unsettled(*iterations, *residual))]
    NotConverged {
        /// Number of iterations made.
        iterations: u32,
        /// Size of the last update relative to the unknown.
        residual: f64,
    },
    /// The iteration converged to a solution on another branch than that of the identity.
    #[error(
        "the solution found doesn't continue the identity (Jacobian determinant {determinant:e}: its sign or that of the trace is wrong); try a smaller step"
    )]
    WrongBranch {
        /// Determinant of the Jacobian at the solution, or NaN. Its sign differs from that at the identity, or else the
        /// trace's does. For joined bodies it is the determinant of the whole system, relative to its diagonal.
        determinant: f64,
    },
    /// The next step has no length: the clock has ended, the density isn't positive or has no value, or the length is
    /// below the rounding of the time.
    #[error(
        "the next step has no length ({length:e} s): a clock is at its end, or a density isn't positive; give a longer clock, or a density with a smaller unit of the steps"
    )]
    NoLength {
        /// The computed length, s; NaN at the end of a clock.
        length: f64,
    },
    /// The requested time lies before the state's, and steps of varying length aren't retraced.
    #[error(
        "the time {time} s is before the state's, {now} s, and steps that vary aren't retraced; give a later time, or an earlier state"
    )]
    Past {
        /// The requested time, s.
        time: f64,
        /// The time of the state, s.
        now: f64,
    },
    /// The Jacobian is singular at an iterate.
    #[error("the Newton Jacobian is singular; try a smaller step")]
    Singular,
    /// A joint that closes a loop is at a singular position, or the step meets one: along one direction the other
    /// joints constrain the motion already, and its force isn't determined.
    #[error(
        "the joint {joint} (from zero) comes to a singular position (pivot {pivot:e}), where its force isn't determined; take a joint with fewer functions, smaller steps, or another way"
    )]
    SingularJoint {
        /// The joint, from zero.
        joint: usize,
        /// Pivot of the joint, relative to its value between free bodies.
        pivot: f64,
    },
    /// One of several coupled bodies has no increment on the branch of the identity at this step.
    #[error(
        "no increment of the body {body} (from zero) that continues the identity: it would turn by {turn:.2e} rad, and its part of the Jacobian has the determinant {determinant:e}; take smaller steps"
    )]
    UnsolvedBody {
        /// The body, from zero: the first that turns too far at the last iterate, or whose part of the Jacobian has the
        /// wrong sign there. If the last iterate isn't finite, the body that would turn farthest.
        body: usize,
        /// Angle by which the body would turn with the velocity after the first kick, rad.
        turn: f64,
        /// Determinant of the body's part of the Jacobian at the last iterate, once the bodies behind it are
        /// eliminated; NaN if the last iterate isn't finite.
        determinant: f64,
    },
}

/// The words for an iteration that didn't converge.
fn unsettled(iterations: u32, residual: f64) -> String {
    if residual.is_finite() {
        format!("did not settle in {iterations} iterations (last relative update {residual:e})")
    } else {
        "runs out of all bounds".to_owned()
    }
}

/// The words for a turn that is too large, and the way out.
fn beyond_solvable([step, largest, turn]: [f64; 3], body: Option<usize>) -> String {
    // The largest step is NaN if the lanes have different ones, and zero for an infinite velocity.
    let is_known = largest.abs() > 0.0;
    let body = body.map_or_else(String::new, |body| format!(" {body} (from zero)"));
    let advice =
        if is_known { format!("take steps of at most {largest:e} s") } else { "take smaller steps".to_owned() };
    let advice = format!("; {advice}, or let `or_substeps` divide such steps");
    if turn > 0.0 {
        let most = turn * (largest / step);
        let most = if is_known {
            format!("and {most:.2e} rad is the most from this state")
        } else {
            "which is too far".to_owned()
        };
        let without = if is_known {
            ". On SO(3) the kinetic part of `GeodesicBody` turns a spin exactly, up to 2.5 rad, and that of `CayleyBody` has no such limit"
        } else {
            ""
        };
        format!(": the body{body} would turn by about {turn:.2e} rad, {most}{advice}{without}")
    } else {
        advice
    }
}

#[cfg(test)]
mod tests;
