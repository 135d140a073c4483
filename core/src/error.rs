//! What can go wrong, each with the sentence that a user sees.

use alloc::borrow::ToOwned as _;
#[cfg(all(feature = "serde", feature = "std"))]
use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::String;

use thiserror::Error;

/// A text that lasts as long as the program. Of a `&str` serde would borrow from what is read.
pub(crate) type Text = &'static str;

/// Of the texts that are read one copy each is kept.
#[cfg(all(feature = "serde", feature = "std"))]
pub(crate) fn kept<'de, D: serde::Deserializer<'de>>(source: D) -> Result<Text, D::Error> {
    static KNOWN: std::sync::Mutex<BTreeSet<Text>> = std::sync::Mutex::new(BTreeSet::new());
    let text: String = serde::Deserialize::deserialize(source)?;
    let mut known = KNOWN.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let text = known.get(text.as_str()).copied().unwrap_or_else(|| String::leak(text));
    known.insert(text);
    Ok(text)
}

/// Why a stepper couldn't be built, or a motion not be started.
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
        /// What is wrong with it.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        cause: Text,
    },
    /// A parameter of one of several bodies has a value that can't be used.
    #[error("parameter `{field}` of the body {body} (from zero) {cause}; give it another value")]
    BodyParameter {
        /// The body, from zero.
        body: usize,
        /// The field of it.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        field: Text,
        /// What is wrong with it.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        cause: Text,
    },
    /// A joint can't be where it was put.
    #[error("the joint {joint} (from zero) {cause}; check the bodies that it joins")]
    Joint {
        /// The joint, from zero: those of trees first, then those that close loops.
        joint: usize,
        /// What is wrong with it.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        cause: Text,
    },
    /// A parameter of a joint has a value that can't be used.
    #[error("parameter `{field}` of the joint {joint} (from zero) {cause}; give it another value")]
    JointParameter {
        /// The joint, from zero.
        joint: usize,
        /// The field of it.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        field: Text,
        /// What is wrong with it.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        cause: Text,
    },
    /// A joint is open where the motion is to start, and of all it is open farthest.
    #[error(
        "the joint {joint} (from zero) is open by {by:e} (in the units of its functions: m, of axes the cosine); give other places, or let `start_nearest` close the joints"
    )]
    OffConstraint {
        /// The joint, from zero.
        joint: usize,
        /// By how much, in the units of its functions: m, of axes the cosine.
        by: f64,
    },
    /// The initial velocities would open a joint, and this one the fastest.
    #[error(
        "the initial velocities open the joint {joint} (from zero) by {by:e} (in the units of its functions per second: m/s, of axes the cosine per second); give others, or let `start_nearest` find those next to them"
    )]
    OffVelocity {
        /// The joint, from zero.
        joint: usize,
        /// How fast, in the units of its functions per second: m/s, of axes the cosine per second.
        by: f64,
    },
    /// A joint has nothing to do that the others, or its own functions, don't, at least along one direction, and at least where the motion is to
    /// start: its force isn't determined.
    #[error(
        "the others, or its own functions, do a part of what the joint {joint} (from zero) is to do (pivot {pivot:e}), at least where the motion starts; take one with fewer functions, or start elsewhere"
    )]
    RedundantJoint {
        /// The joint, from zero.
        joint: usize,
        /// What the others leave it to do, relative to what it would have to between free bodies.
        pivot: f64,
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
        /// The body of a system, or the factor of a product, from zero, along which it is once those before are eliminated.
        /// None where there is but one, or where no pivot is zero and their product is out of range.
        body: Option<usize>,
    },
    /// The kinetic energy is negative along a direction.
    #[error("the kinetic part{} is negative along a direction (pivot {pivot:e}, relative to the inertia there); check its sign, the `.transpose()` in it, and the signs of its parameters", of_body(*.body))]
    NegativeKinetic {
        /// The smallest pivot of the inertia of the continuous limit, relative to its entry of the diagonal.
        pivot: f64,
        /// The body of a system, or the factor of a product, from zero, that it is of. None where there is but one.
        body: Option<usize>,
    },
    /// A constant of the scene isn't finite, whatever the step.
    #[error(
        "a constant of the scene is not finite: a divisor is zero, a root or a logarithm has no value, or a product is out of range; give the parameters other values"
    )]
    NonFiniteConstant,
    /// A part of the initial state isn't finite.
    #[error("the initial {what} is not finite; give finite numbers, far from the ends of the scalar's range")]
    NonFinite {
        /// Which part.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        what: Text,
    },
    /// No velocity has the initial momentum, or none on whose side of the singularities of `∂²l/∂ξ²` rest is.
    #[error(
        "no velocity that rest can be continued to has the initial momentum; choose a momentum nearer to that at rest"
    )]
    NoVelocity,
    /// The momentum of the initial velocity is that of another, which the motion would start with.
    #[error("{}; choose a velocity nearer to rest", ambiguity(*.difference))]
    AmbiguousVelocity {
        /// By how much the two differ, relative to the one that was given, both measured by the momentum that they would
        /// have with the inertia at rest. NaN where the velocity has no momentum, or its momentum no velocity.
        difference: f64,
    },
    /// A vector that is to be of length one isn't.
    #[error("the {what} has the length {length:e}; give one of length one")]
    NotUnit {
        /// Which one.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        what: Text,
        /// Its length.
        length: f64,
    },
    /// A body that is to move as a direction isn't symmetric about its axis.
    #[error(
        "the body isn't symmetric about the axis: an entry of its nonstandard inertia is {difference:e} kg m² from that of one that is; give its axis of symmetry, or start it by an attitude"
    )]
    NotAxisymmetric {
        /// How far an entry of its nonstandard inertia is from that of a symmetric one at most, kg m².
        difference: f64,
    },
    /// A body that is to move as a direction has a velocity about its axis.
    #[error(
        "the velocity has the part {spin:e} rad/s about the direction, which doesn't move that; give one at right angles to it, or start the body by an attitude"
    )]
    Spin {
        /// That part of the velocity, rad/s.
        spin: f64,
    },
    /// The initial attitude isn't in the group.
    #[error("the initial attitude is not in the group (defect {defect:e}, more than rounding); normalise it first")]
    NotInGroup {
        /// How far the matrix is from the relation of the group.
        defect: f64,
    },
    /// A splitting needs a Lagrangian `K(F) − (h/2) (V(w) + V(F⁻¹·w))`.
    #[error(
        "the Lagrangian is not K(F) − (h/2) (V(w) + V(F⁻¹·w)) (defect {defect:e}, more than rounding), so it can't be split; compose it instead"
    )]
    NotSeparable {
        /// How much the rest depends on `w` when the half kicks are taken away, relative to its size.
        defect: f64,
    },
    /// The kinetic flow of a splitting is that of another body than the Lagrangian's.
    #[error(
        "the kinetic flow is that of another body: two entries of the inertias differ by {difference:e}; build both from one"
    )]
    InertiaMismatch {
        /// The largest difference of two entries, kg m².
        difference: f64,
    },
    /// The method has the motion of one free body in it, and the inertia depends on what is advected or given, or on the
    /// velocity.
    #[error(
        "the inertia depends on what is advected or given, or on the velocity, and this method needs one that is the same everywhere; compose the scene's own step instead"
    )]
    VaryingInertia,
    /// The kinetic flow of a splitting has other rotors than the Lagrangian, or none.
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
    /// The scene has another step of `−h` than the inverse of its step of `h`.
    #[error(
        "the step of −h doesn't undo that of h, which a composition and an inverse need: l_d(F, w, h) isn't −l_d(F⁻¹, F⁻¹·w, −h); take the mean of both, as the trapezoid does"
    )]
    NotSelfAdjoint,
    /// A stepper or a state can't be in a lane beside the others: lanes share the scheme of a method and the number of
    /// steps made, for example.
    #[error(
        "the body of lane {lane} can't be stepped beside those before it: they have another method, or have made another number of steps; build a batch of like ones"
    )]
    Unlike {
        /// The first such lane.
        lane: usize,
    },
}

/// The body that the kinetic part belongs to, if there are several.
fn of_body(body: Option<usize>) -> String {
    body.map_or_else(String::new, |body| format!(" of the body or factor {body} (from zero)"))
}

/// What is wrong with an initial velocity, of which this is the difference to that of its momentum.
fn ambiguity(difference: f64) -> String {
    if difference.is_nan() {
        return "the initial velocity has no momentum, or none that determines a velocity: it is out of the range in which the Lagrangian is defined and regular".to_owned();
    }
    format!(
        "the momentum of the initial velocity is that of another velocity, too (relative difference {difference:e}): the kinetic part is singular between rest and it"
    )
}

/// Why a step couldn't be made. The state is then what it was before.
///
/// Of several lanes one was enough; a number in which the lanes differ is NaN.
#[derive(Clone, Debug, PartialEq, Error)]
#[cfg_attr(all(feature = "serde", feature = "std"), derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum StepError {
    /// A part of the state isn't finite, before the step or after it; or the momentum equation (2.7) isn't, where a force or
    /// a potential has no value.
    #[error(
        "the {what} is not finite{}",
        if *.what == "momentum equation" {
            ": a force or a potential has no value here, or one out of range; check its parameters, or start elsewhere"
        } else {
            "; choose units in which the numbers are nearer to one"
        }
    )]
    NonFinite {
        /// Which part, or `"momentum equation"`.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "kept"))]
        what: Text,
    },
    /// The momentum equation (2.7) has no solution that continues the identity at this step, but has one at a smaller. Near the
    /// largest step the phase of (3.13) is off by half a turn in each; [`effects`](crate::effects) has kinetic parts that bear more.
    #[error("no solution at the step {step:e} s{}", beyond_solvable([*.step, *.largest, *.turn], *.body))]
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
    #[error("the body would turn by {turn:.2e} rad, of which no digit is left; take a smaller step")]
    AngleWithoutDigits {
        /// The angle, rad.
        turn: f64,
    },
    /// The iteration didn't settle: Newton's, or the fixed-point iteration of [`Gauss`](crate::methods::Gauss).
    #[error("the iteration {}; try a smaller step", unsettled(*iterations, *residual))]
    NotConverged {
        /// How many iterations were made.
        iterations: u32,
        /// The size of the last update relative to the unknown.
        residual: f64,
    },
    /// The iteration settled on a solution that doesn't continue the identity.
    #[error(
        "the solution found doesn't continue the identity (Jacobian determinant {determinant:e}: its sign or that of the trace is wrong); try a smaller step"
    )]
    WrongBranch {
        /// The determinant of the Jacobian there, or NaN. Its sign differs from that at the identity, or else the
        /// trace's does. Of joined bodies it is that of the whole system, relative to its diagonal.
        determinant: f64,
    },
    /// A clock or a density gives the next step no length: the clock has no more, a density isn't positive or has no value,
    /// or time wouldn't go on.
    #[error(
        "the next step has no length ({length:e} s): a clock is at its end, or a density isn't positive; give a longer clock, or a density with a smaller unit of the steps"
    )]
    NoLength {
        /// What was found, s; NaN at the end of a clock.
        length: f64,
    },
    /// A time before the state was asked for, where steps vary and aren't retraced.
    #[error(
        "the time {time} s is before the state's, {now} s, and steps that vary aren't retraced; give a later time, or an earlier state"
    )]
    Past {
        /// The time, s.
        time: f64,
        /// That of the state, s.
        now: f64,
    },
    /// The Jacobian is singular at an iterate.
    #[error("the Newton Jacobian is singular; try a smaller step")]
    Singular,
    /// A joint that closes a loop is at a singular position, or the step meets one: the others leave the joint nothing to do
    /// along one direction, and its force isn't determined.
    #[error(
        "the joint {joint} (from zero) comes to a singular position (pivot {pivot:e}), where its force isn't determined; take a joint with fewer functions, smaller steps, or another way"
    )]
    SingularJoint {
        /// The joint, from zero: those of trees first, then those that close loops.
        joint: usize,
        /// What the others leave it to do, relative to what it would have to between free bodies.
        pivot: f64,
    },
    /// One of several bodies that move each other has no increment that continues the identity at this step.
    #[error(
        "no increment of the body {body} (from zero) that continues the identity: it would turn by {turn:.2e} rad, and its part of the Jacobian has the determinant {determinant:e}; take smaller steps"
    )]
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

/// What became of an iteration.
fn unsettled(iterations: u32, residual: f64) -> String {
    if residual.is_finite() {
        format!("did not settle in {iterations} iterations (last relative update {residual:e})")
    } else {
        "runs out of all bounds".to_owned()
    }
}

/// How far a body would turn, and the way out.
fn beyond_solvable([step, largest, turn]: [f64; 3], body: Option<usize>) -> String {
    // In lanes that differ the largest step isn't one number.
    let is_known = !largest.is_nan();
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
