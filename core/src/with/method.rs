//! A method as a value: its scheme and the wrappers around it, by names, and the stepper of a scene by it.

use alloc::borrow::ToOwned as _;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;
use core::str::FromStr;

use thiserror::Error;

use super::compensated::Compensable;
use super::densities;
use crate::error::SetupError;
use crate::groups::{LieGroup, MatrixGroup, SO3};
use crate::mechanics::{Inertia, Scene, inertia};
use crate::methods::{
    CompositionScheme, ExactBody, KineticFlow, ProcessedScheme, SplittingScheme, SymmetricBody, has_force_gradient,
};
use crate::motion::{AnyStepper, Plan, Stepper};

/// The scheme of a method's steps; as text `step`, `composition Suzuki 4`, `splitting Strang`, `processed 3-6 a`,
/// `collocation 4` or `exact`.
///
/// # Examples
///
/// ```
/// use liestep::with::Scheme;
///
/// let scheme: Scheme = "composition suzuki 4".parse()?;
/// assert_eq!((scheme.order(), scheme.to_string().as_str()), (4, "composition Suzuki 4"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Scheme {
    /// The scene's own step, of order 2 unless a Lagrangian of higher order is declared.
    #[default]
    Step,
    /// A symmetric composition of the own step.
    Composition(CompositionScheme),
    /// A splitting into the exact motion of the free body and kicks of the potential.
    Splitting(SplittingScheme),
    /// A splitting with a processor.
    Processed(ProcessedScheme),
    /// Gauss collocation.
    Collocation(Stages),
    /// The exact motion of a free body.
    Exact,
}

/// The number of a collocation's stages, which fill the vector registers of a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stages {
    /// Four stages, of order 8.
    Four,
    /// Eight stages, of order 16.
    Eight,
}

impl Scheme {
    /// The order of the method in its step, if that of the own step is 2.
    #[must_use]
    pub fn order(&self) -> u32 {
        match self {
            Self::Step | Self::Exact => 2,
            Self::Composition(scheme) => scheme.order(),
            Self::Splitting(scheme) => scheme.order(),
            Self::Processed(scheme) => scheme.order(),
            Self::Collocation(Stages::Four) => 8,
            Self::Collocation(Stages::Eight) => 16,
        }
    }

    /// The kind and the name within it; the name is empty for the own step and the exact motion.
    #[must_use]
    pub fn parts(&self) -> (&'static str, &'static str) {
        match self {
            Self::Step => ("step", ""),
            Self::Exact => ("exact", ""),
            Self::Composition(scheme) => ("composition", scheme.name()),
            Self::Splitting(scheme) => ("splitting", scheme.name()),
            Self::Processed(scheme) => ("processed", scheme.name()),
            Self::Collocation(Stages::Four) => ("collocation", "4"),
            Self::Collocation(Stages::Eight) => ("collocation", "8"),
        }
    }

    /// The kinds that have several schemes, with their names.
    #[must_use]
    pub fn names() -> [(&'static str, Vec<&'static str>); 4] {
        [
            ("composition", CompositionScheme::ALL.iter().map(CompositionScheme::name).collect()),
            ("splitting", SplittingScheme::ALL.iter().map(SplittingScheme::name).collect()),
            ("processed", ProcessedScheme::ALL.iter().map(ProcessedScheme::name).collect()),
            ("collocation", ["4", "8"].into()),
        ]
    }

    /// The scheme of a kind by its name, whatever the case of its letters.
    ///
    /// # Errors
    ///
    /// [`UnknownMethod`] lists the names.
    pub fn named(kind: &str, name: &str) -> Result<Self, UnknownMethod> {
        let all = Self::names();
        let place = |kind: &str| {
            let (_, names) = all.iter().find(|(own, _)| *own == kind)?;
            names.iter().position(|own| own.eq_ignore_ascii_case(name) || is_short_for(own, kind, name))
        };
        let found = match kind {
            "step" if name.is_empty() => Some(Self::Step),
            "exact" if name.is_empty() => Some(Self::Exact),
            "composition" => place(kind).map(|place| Self::Composition(CompositionScheme::ALL[place])),
            "splitting" => place(kind).map(|place| Self::Splitting(SplittingScheme::ALL[place])),
            "processed" => place(kind).map(|place| Self::Processed(ProcessedScheme::ALL[place])),
            "collocation" => place(kind).map(|place| Self::Collocation([Stages::Four, Stages::Eight][place])),
            _ => None,
        };
        found.ok_or_else(|| match all.into_iter().find(|(own, _)| *own == kind) {
            Some(("collocation", _)) => UnknownMethod::Stages,
            Some((_, known)) => UnknownMethod::Scheme { kind: kind.to_owned(), name: name.to_owned(), known },
            None => UnknownMethod::Kind { kind: kind.to_owned() },
        })
    }
}

/// Whether a name leaves the kind out that a scheme's own name begins with, as `3-6 a` of `processed 3-6 a`.
fn is_short_for(own: &str, kind: &str, name: &str) -> bool {
    own.strip_prefix(kind).is_some_and(|rest| rest.trim_start().eq_ignore_ascii_case(name))
}

impl fmt::Display for Scheme {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (kind, name) = self.parts();
        // The name of a processed scheme begins with its kind.
        let name = name.strip_prefix(kind).map_or(name, str::trim_start);
        f.write_str(kind)?;
        if name.is_empty() { Ok(()) } else { write!(f, " {name}") }
    }
}

impl FromStr for Scheme {
    type Err = UnknownMethod;

    fn from_str(text: &str) -> Result<Self, UnknownMethod> {
        let (kind, name) = text.trim().split_once(' ').unwrap_or((text.trim(), ""));
        Self::named(kind, name.trim())
    }
}

/// A text that names no method.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum UnknownMethod {
    /// The kind is unknown.
    #[error(
        "there is no method \"{kind}\": take \"step\", \"exact\", a \"composition\", \"splitting\", \"processed\" one or a \"collocation\""
    )]
    Kind {
        /// The kind.
        kind: String,
    },
    /// The kind has no such scheme.
    #[error("unknown scheme `{name}`, expected one of `{}`", known.join("`, `"))]
    Scheme {
        /// The kind.
        kind: String,
        /// The unknown name.
        name: String,
        /// The names of the kind.
        known: Vec<&'static str>,
    },
    /// A collocation has no such number of stages.
    #[error("a collocation has 4 or 8 stages")]
    Stages,
    /// A wrapper is unknown.
    #[error("there is no \"{text}\" around a method: take \"compensated\", \"substeps 8\" or \"density 0.5\"")]
    Wrapper {
        /// The text.
        text: String,
    },
}

/// A method as a value: a scheme, and the wrappers around it; as text the scheme and a list, `step, substeps 8`.
///
/// # Examples
///
/// A free body by the fourth-order composition of its step, chosen by a text.
///
/// ```
/// use liestep::effects::RigidBody;
/// use liestep::with::Method;
/// use liestep::{NonstandardInertia, SO3};
/// use nalgebra::Vector3;
///
/// let body = RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))? };
/// let method: Method = "composition Suzuki 4, compensated".parse()?;
/// let stepper = method.stepper(body, 0.1)?;
/// let mut state = stepper.start_at(SO3::identity(), Vector3::new(0.1, 2.0, 0.2))?;
/// stepper.run(&mut state, 100)?;
/// assert_eq!(method.to_string(), "composition Suzuki 4, compensated");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Method {
    /// The scheme of the steps.
    pub scheme: Scheme,
    /// Whether the sums of a state are [compensated](Stepper::compensated).
    pub compensated: bool,
    /// The largest number of parts of a [step without a solution](Stepper::or_substeps); 0 or 1 divides none.
    pub substeps: u32,
    /// The floor ω of the velocity, rad/s, in steps of [about equal turns](densities::turn).
    pub floor: Option<f64>,
}

impl From<Scheme> for Method {
    fn from(scheme: Scheme) -> Self {
        Self { scheme, ..Self::default() }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.scheme)?;
        if self.compensated {
            f.write_str(", compensated")?;
        }
        if self.substeps > 1 {
            write!(f, ", substeps {}", self.substeps)?;
        }
        self.floor.map_or(Ok(()), |floor| write!(f, ", density {floor}"))
    }
}

impl FromStr for Method {
    type Err = UnknownMethod;

    fn from_str(text: &str) -> Result<Self, UnknownMethod> {
        // A name of a scheme may have commas, as `near-integrable (8, 6, 4)`.
        let end = text.find(", compensated").into_iter().chain(text.find(", substeps")).chain(text.find(", density"));
        let (scheme, wrappers) = text.split_at(end.min().unwrap_or(text.len()));
        let mut method = Self::from(scheme.parse::<Scheme>()?);
        for wrapper in wrappers.split(',').map(str::trim).filter(|wrapper| !wrapper.is_empty()) {
            let unknown = || UnknownMethod::Wrapper { text: wrapper.to_owned() };
            match wrapper.split_once(' ').unwrap_or((wrapper, "")) {
                ("compensated", "") => method.compensated = true,
                ("substeps", most) => method.substeps = most.trim().parse().map_err(|_| unknown())?,
                ("density", floor) => method.floor = Some(floor.trim().parse().map_err(|_| unknown())?),
                _ => return Err(unknown()),
            }
        }
        Ok(method)
    }
}

/// A requirement of a method that a scene or a group doesn't meet.
const fn refused<T>(cause: &'static str) -> Result<T, SetupError> {
    Err(SetupError::Method { cause })
}

impl Method {
    /// Whether the method is the scene's own step without wrappers.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        *self == Self { substeps: self.substeps.min(1), ..Self::default() }
    }

    /// Whether the steps have different lengths.
    #[must_use]
    pub const fn varies(&self) -> bool {
        self.floor.is_some()
    }

    /// The stepper of a scene by this method.
    ///
    /// # Errors
    ///
    /// [`SetupError::Method`] if the group, the scene or the scheme doesn't have it; the errors of [`Stepper::new`] and of
    /// the other constructors.
    pub fn stepper<S>(self, scene: S, h: f64) -> Result<AnyStepper, SetupError>
    where
        S: Scene<Scalar = f64, Group: Steppable<S>>,
    {
        <S::Group as Steppable<S>>::stepper(self, scene, h)
    }

    /// The scheme's composition, for groups other than SO(3); none where the scheme is the Lagrangian's own step.
    ///
    /// # Errors
    ///
    /// [`SetupError::Method`] if the method needs SO(3).
    pub fn composition(&self) -> Result<Option<CompositionScheme>, SetupError> {
        match self.scheme {
            _ if self.compensated || self.substeps > 1 || self.varies() => {
                refused("needs SO3 where it is compensated, or has substeps or a density; take a composition here")
            }
            Scheme::Step => Ok(None),
            Scheme::Composition(scheme) => Ok(Some(scheme)),
            _ => refused("is for SO3, where the motion of a free body is known; take a composition here"),
        }
    }

    /// The stepper by a scheme of any group: the own step, or a composition of it.
    ///
    /// # Errors
    ///
    /// As [`stepper`](Self::stepper).
    pub fn on_any_group<S: Scene<Scalar = f64>>(self, scene: S, h: f64) -> Result<AnyStepper, SetupError> {
        match self.composition()? {
            None => Stepper::new(scene, h).map(Stepper::into_any),
            Some(scheme) => Stepper::composed_if_symmetric(scene, h, scheme).map(Stepper::into_any),
        }
    }

    /// A wrapped stepper.
    fn wrapped<S, P>(self, stepper: Stepper<S, P>) -> Result<AnyStepper, SetupError>
    where
        S: Scene<Scalar = f64>,
        P: Plan<S, Kept: 'static> + Compensable + 'static,
    {
        if self.substeps > 1 {
            return refused("has substeps with the declared step alone and without compensated sums; take one of both");
        }
        if self.varies() {
            return refused("has a density around the declared step alone; take `step`");
        }
        Ok(if self.compensated { stepper.compensated().into_any() } else { stepper.into_any() })
    }

    fn on_so3<S: Scene<Scalar = f64, Group = SO3>>(self, scene: S, h: f64) -> Result<AnyStepper, SetupError> {
        if scene.with_energy(&scene.advected(), 0.0).is_some() {
            if self.is_plain() {
                return Stepper::new(scene, h).and_then(Stepper::paced).map(Stepper::into_any);
            }
            return refused("of a scene with a pace is its own step; take the step alone");
        }
        match (self.scheme, self.floor) {
            (Scheme::Step, Some(_)) if self.compensated || self.substeps > 1 => {
                refused("with a density is the declared step alone; take neither `compensated` nor `substeps`")
            }
            (Scheme::Step, Some(floor)) => {
                let rate = densities::turn(scene.clone(), floor);
                Stepper::new(scene, h).map(|stepper| stepper.with_density(rate).into_any())
            }
            (Scheme::Step, None) if self.substeps > 1 && !self.compensated => {
                Stepper::new(scene, h).map(|stepper| stepper.or_substeps(self.substeps).into_any())
            }
            (Scheme::Step, None) => self.wrapped(Stepper::new(scene, h)?),
            (Scheme::Composition(scheme), _) => self.wrapped(Stepper::composed_if_symmetric(scene, h, scheme)?),
            (Scheme::Collocation(_), _) if self.compensated || self.substeps > 1 || self.varies() => refused(
                "of collocation compensates its sums by itself, and has neither substeps nor a density; take it alone",
            ),
            (Scheme::Collocation(Stages::Four), _) => Stepper::collocated::<2>(scene, h).map(Stepper::into_any),
            (Scheme::Collocation(Stages::Eight), _) => Stepper::collocated::<4>(scene, h).map(Stepper::into_any),
            _ => {
                let Ok(inertia) = Inertia::new(inertia(&scene, &scene.advected())) else {
                    return refused(
                        "is for the inertia of a body; give a positive one, no moment of which is above the sum of the others",
                    );
                };
                match SymmetricBody::new(&inertia) {
                    Ok(flow) => self.split(scene, h, flow),
                    Err(_) => self.split(scene, h, ExactBody::new(&inertia)),
                }
            }
        }
    }

    /// The stepper by the motion of the free body.
    fn split<S, K>(self, scene: S, h: f64, flow: K) -> Result<AnyStepper, SetupError>
    where
        S: Scene<Scalar = f64, Group = SO3>,
        K: KineticFlow<f64> + 'static,
    {
        match self.scheme {
            Scheme::Splitting(scheme) => self.wrapped(Stepper::split(scene, h, flow, scheme)?),
            Scheme::Processed(scheme) => self.wrapped(Stepper::processed(scene, h, flow, scheme)?),
            _ if scene.facts().parts.kick_before => refused("is for a body without a potential; take a splitting"),
            _ => self.wrapped(Stepper::split(scene, h, flow, SplittingScheme::STRANG)?),
        }
    }
}

/// A group whose scenes can be stepped by a [`Method`] that is a value, and have a choice by accuracy.
///
/// All have their own step and its compositions; SO(3) has splittings, processed ones, collocation and the exact motion
/// besides, as far as a scene admits them. A group of another crate needs a line:
/// `impl<S: Scene<Scalar = f64, Group = Self>> Steppable<S> for MyGroup {}`.
#[diagnostic::on_unimplemented(
    message = "scenes on `{Self}` can't be stepped by a method that is a value",
    note = "`impl<S: Scene<Scalar = f64, Group = Self>> Steppable<S> for` the group lets them be"
)]
pub trait Steppable<S: Scene<Scalar = f64, Group = Self>>: LieGroup<Scalar = f64> {
    /// The schemes of the scene besides its own step and the compositions.
    #[must_use]
    fn schemes(_scene: &S) -> Vec<Scheme> {
        Vec::new()
    }

    /// The stepper by a method, [`Method::on_any_group`] by default.
    ///
    /// # Errors
    ///
    /// As [`Method::stepper`].
    fn stepper(method: Method, scene: S, h: f64) -> Result<AnyStepper, SetupError> {
        method.on_any_group(scene, h)
    }
}

impl<S, K, const N: usize, const D: usize> Steppable<S> for MatrixGroup<K, f64, N, D>
where
    S: Scene<Scalar = f64, Group = Self>,
    Self: LieGroup<Scalar = f64>,
{
}

impl<S, G, const N: usize> Steppable<S> for [G; N]
where
    S: Scene<Scalar = f64, Group = Self>,
    Self: LieGroup<Scalar = f64>,
{
}

impl<S, A, B> Steppable<S> for (A, B)
where
    S: Scene<Scalar = f64, Group = Self>,
    Self: LieGroup<Scalar = f64>,
{
}

impl<S: Scene<Scalar = f64, Group = Self>> Steppable<S> for SO3 {
    fn schemes(scene: &S) -> Vec<Scheme> {
        // The schemes of one body on SO(3) need a physical, constant inertia and a separable Lagrangian.
        let Ok(inertia) = Inertia::new(inertia(scene, &scene.advected())) else { return Vec::new() };
        let body = ExactBody::new(&inertia);
        if Stepper::split(scene.clone(), 1.0, body, SplittingScheme::STRANG).is_err() {
            return Vec::new();
        }
        // Six stages don't fill the machine's vectors, and take longer than eight.
        let collocations = [Stages::Four, Stages::Eight].map(Scheme::Collocation);
        if !scene.facts().parts.kick_before {
            return [Scheme::Exact].into_iter().chain(collocations).collect();
        }
        let has_gradient = has_force_gradient(scene);
        let splittings = SplittingScheme::ALL.into_iter().filter(|scheme| has_gradient || !scheme.has_gradients());
        // `SIX_B` has the kernel of `SIX_A`; as each further method costs trials, it is the one that is left out.
        let is_tried = |scheme: &ProcessedScheme| has_gradient && *scheme != ProcessedScheme::SIX_B;
        let processed = ProcessedScheme::ALL.into_iter().filter(is_tried);
        let splittings = splittings.map(Scheme::Splitting).chain(processed.map(Scheme::Processed));
        splittings.chain(collocations).collect()
    }

    fn stepper(method: Method, scene: S, h: f64) -> Result<AnyStepper, SetupError> {
        method.on_so3(scene, h)
    }
}
