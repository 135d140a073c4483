//! The stepper of a declaration by any method, and by the cheapest one for an accuracy.

use std::rc::Rc;

use liestep::accuracy::{Accuracy, AccuracyError, Candidate, Choice, Measure, choose, displacement, of_any_group};
use liestep::motion::{AnyStepper, Layout};
use liestep::with::{Method, Scheme, Steppable as _};
use liestep::{SO3, SetupError};
use liestep_derivation::Role;
use liestep_derivation::whole::Form;

use super::codes::Codes;
use super::collocation::Collocation;
use super::compensated::CompensatedSums;
use super::course::Course;
use super::hamiltonian::Hamiltonian;
use super::rotating::RotatingScene;
use super::stepper::{Whole, WholeError};
use crate::code::Backend;
use crate::declaration::Declaration;
use crate::error::LateError;

/// Whether the group is SO(3), under any name.
fn is_of_rotations<B: Backend<f64>>(declaration: &'static Declaration) -> Result<bool, LateError> {
    let codes = Codes::<B>::of(declaration)?;
    Ok(matches!(&codes.factors[..], [only] if only.form == Form::Rotation))
}

/// Names, units and places of the states of a declaration's [`stepper`], whatever its numbers.
///
/// # Errors
///
/// The declaration has no step, or is too large.
pub fn layout<B: Backend<f64>>(declaration: &'static Declaration) -> Result<Layout, LateError> {
    match declaration.role {
        Role::Hamiltonian => Hamiltonian::<B>::layout_of(declaration),
        _ => Ok(Codes::<B>::of(declaration)?.layout.clone()),
    }
}

const fn refused<T>(cause: &'static str) -> Result<T, WholeError> {
    Err(WholeError::Setup(SetupError::Method { cause }))
}

/// The stepper of a declaration with the [numbers](Declaration::numbers) of all its parameters, the step `h`, s, and a method.
///
/// The declared step and its compositions are those of [`Whole`] on any group, also with compensated sums; those of a Hamiltonian
/// need a momentum at the start. Collocation takes the continuous limit of the
/// Lagrangian, on any group that linear and quadratic relations define. Splittings and the exact motion are
/// those of [`Method::stepper`], on SO(3) alone.
///
/// # Examples
///
/// A rigid body in space near rest, by collocation of order 8.
///
/// ```
/// use liestep::motion::Integrator as _;
/// use liestep_late::{Declaration, Interpreter, stepper};
///
/// let body = Declaration::parse(
///     "#[lagrangian(group = SE3, l_d = ((F - I) * J * (F - I).transpose()).trace() / (2 * h))]
///     struct Body { J: SMatrix<f64, 4, 4> }",
/// )?;
/// let J = [0.7, 0.0, 0.0, 0.0, 0.0, 0.6, 0.0, 0.0, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.0, 1.0];
/// let numbers = body.numbers(&[("J", &J)])?;
/// let stepper = stepper::<Interpreter>(body, &numbers, 0.1, "collocation 4".parse()?)?;
/// let identity = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
/// let mut state = stepper.start(&identity, &[0.1, 2.0, 0.2, 0.0, 0.0, 1.0])?;
/// let energy = stepper.energy(&state);
/// stepper.run(&mut state, 100)?;
/// assert!((stepper.energy(&state) - energy).abs() < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// The declaration has no kinetic part or is too large; [`SetupError::Method`] if its group, a force or a constraint on
/// velocities rule the method out;
/// the errors of [`Stepper::new`](liestep::Stepper::new) and of the library's other constructors.
pub fn stepper<B: Backend<f64>>(
    declaration: &'static Declaration,
    numbers: &[f64],
    h: f64,
    method: Method,
) -> Result<AnyStepper, WholeError> {
    // A step in one part isn't divided.
    let method = Method { substeps: if method.substeps == 1 { 0 } else { method.substeps }, ..method };
    if declaration.role == Role::Hamiltonian {
        return Ok(AnyStepper::new(Hamiltonian::<B>::of(declaration, numbers, h, method)?));
    }
    if declaration.energy.is_some() {
        if method.is_plain() {
            return Ok(AnyStepper::new(Whole::<B>::of(declaration, numbers, h, method)?.paced()?));
        }
        return refused("of a scene with a pace is its own step; take the step alone");
    }
    let has_own_steps = matches!(method.scheme, Scheme::Step | Scheme::Composition(_));
    match (method.scheme, method.floor) {
        (Scheme::Step, Some(_)) if method.compensated || method.substeps > 1 => {
            return refused("with a density is the declared step alone; take neither `compensated` nor `substeps`");
        }
        (Scheme::Step, Some(floor)) => {
            let whole = Whole::<B>::of(declaration, numbers, h, Method::default())?;
            return Ok(AnyStepper::new(whole.turning_evenly(floor)?));
        }
        (_, None) if has_own_steps && !method.compensated => {
            return Ok(AnyStepper::new(Whole::<B>::of(declaration, numbers, h, method)?));
        }
        _ if !declaration.constraints.each.is_empty() => {
            return refused(
                "is none of those for constraints on velocities; take the step or a composition, or leave the constraints out",
            );
        }
        _ if declaration.has_force && !has_own_steps => {
            return refused("needs a scene without a force; take the step, or leave the force out");
        }
        (Scheme::Composition(_), _) if !declaration.is_self_adjoint => {
            return Err(WholeError::Setup(SetupError::NotSelfAdjoint));
        }
        _ => {}
    }
    let on_rotations = is_of_rotations::<B>(declaration)?;
    let on_so3 = || Ok(method.stepper(RotatingScene::<B>::of(declaration, sized(declaration, numbers)?)?, h)?);
    match method.scheme {
        Scheme::Collocation(stages) if method == Method::from(method.scheme) => {
            // The equations in quaternions are several times cheaper, where there are some.
            match on_rotations.then(on_so3) {
                Some(Ok(stepper)) => Ok(stepper),
                None | Some(Err(WholeError::Setup(SetupError::NotSeparable { .. } | SetupError::VaryingInertia))) => {
                    Ok(AnyStepper::new(Collocation::<B>::of(declaration, numbers, h, stages)?))
                }
                Some(Err(error)) => Err(error),
            }
        }
        // Sums of the advected parameters themselves are those of the compiled step.
        _ if on_rotations && !(has_own_steps && method.floor.is_none() && method.substeps == 0) => on_so3(),
        Scheme::Step | Scheme::Composition(_) => {
            Ok(AnyStepper::new(CompensatedSums::<B>::of(declaration, numbers, h, method)?))
        }
        _ => {
            method.composition()?;
            refused("is for SO3, where the motion of a free body is known; take a composition here")
        }
    }
}

/// The numbers, if they are as many as the declaration has.
fn sized<'a>(declaration: &'static Declaration, numbers: &'a [f64]) -> Result<&'a [f64], LateError> {
    let (expected, found) = (declaration.count(), numbers.len());
    if expected == found {
        Ok(numbers)
    } else {
        Err(LateError::Size { name: declaration.name.clone(), expected, found })
    }
}

/// A motion whose end is wanted to an accuracy.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The accuracy.
    pub accuracy: Accuracy,
    /// The attitude at the start, as the matrices of its factors row by row.
    pub attitude: &'a [f64],
    /// The body velocity at the start, on SO(3) in rad/s.
    pub velocity: &'a [f64],
}

/// The reason why there is no stepper for an accuracy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum QuestionError {
    /// The declaration has no stepper by any method.
    #[error(transparent)]
    Whole(#[from] WholeError),
    /// No method has the accuracy.
    #[error(transparent)]
    Accuracy(#[from] AccuracyError),
}

/// The stepper that is the cheapest for an accuracy, as by [`Stepper::for_accuracy`](liestep::Stepper::for_accuracy), and the
/// choice. Beside a course of the numbers it is the declared step or a composition of it.
///
/// # Errors
///
/// As there, and those of [`stepper`].
pub fn for_accuracy<B: Backend<f64>>(
    declaration: &'static Declaration,
    numbers: &[f64],
    course: Option<&Rc<dyn Course>>,
    question: Question<'_>,
) -> Result<(AnyStepper, Choice), QuestionError> {
    if declaration.energy.is_some() {
        let cause = "has a time of its own, whose steps are those of `Stepper::new(…)?.paced()`";
        return Err(AccuracyError::from(SetupError::Parameter { field: "pace", cause }).into());
    }
    sized(declaration, numbers).map_err(WholeError::from)?;
    let mut schemes: Vec<Scheme> = of_any_group(declaration.is_self_adjoint).collect();
    let has_lagrangian = !declaration.has_force && declaration.constraints.each.is_empty();
    if course.is_none() && has_lagrangian && is_of_rotations::<B>(declaration).map_err(WholeError::from)? {
        let scene = RotatingScene::<B>::of(declaration, numbers).map_err(WholeError::from)?;
        schemes.extend(SO3::schemes(&scene));
    }
    let candidate = |scheme| {
        let (numbers, course, method) = (numbers.to_vec(), course.cloned(), Method::from(scheme));
        let make = move |h| {
            let made = match &course {
                None => stepper::<B>(declaration, &numbers, h, method),
                Some(course) => Whole::<B>::of(declaration, &numbers, h, method)
                    .and_then(|whole| Ok(AnyStepper::new(whole.varied().along(Rc::clone(course))?))),
            };
            made.map_err(|error| match error {
                WholeError::Setup(error) => error,
                WholeError::Declaration(_) => {
                    SetupError::Method { cause: "has no step of this declaration; take another" }
                }
            })
        };
        Candidate { scheme, make: Box::new(make) }
    };
    let candidates: Vec<Candidate> = schemes.into_iter().map(candidate).collect();
    let Question { accuracy, attitude, velocity } = question;
    let factors = layout::<B>(declaration).map_err(WholeError::from)?.factors;
    let beside = declaration.displaced(attitude, &displacement(velocity.len()));
    Ok(choose(&candidates, accuracy, [attitude, &beside], velocity, Measure::new(&factors, None))?)
}
