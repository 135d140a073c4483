//! What a scene is stepped by.

use liestep::groups::{Heisenberg, LieGroup, R1, R2, R3, SE2, SE3, SL2, SO2, SU2};
use liestep::mechanics::{Inertia, Scene};
use liestep::methods::{CompositionScheme, ExactBody, ProcessedScheme, SplittingScheme};
use liestep::motion::{AnyStepper, Plan};
use liestep::with::Compensable;
use liestep::{SO3, SetupError, Stepper};

use crate::failure::Failure;

/// A method by its name, and what is put around it.
#[derive(Clone, Copy)]
pub(crate) struct Method {
    kind: Kind,
    is_compensated: bool,
    /// One where a step that has no solution isn't divided.
    substeps: u32,
}

#[derive(Clone, Copy)]
enum Kind {
    Step,
    Composition(CompositionScheme),
    Splitting(SplittingScheme),
    Processed(ProcessedScheme),
    /// By its number of stages.
    Collocation(usize),
}

/// The names of all schemes.
pub(crate) fn schemes() -> [(&'static str, Vec<&'static str>); 3] {
    [
        ("composition", CompositionScheme::ALL.iter().map(CompositionScheme::name).collect()),
        ("splitting", SplittingScheme::ALL.iter().map(SplittingScheme::name).collect()),
        ("processed", ProcessedScheme::ALL.iter().map(ProcessedScheme::name).collect()),
    ]
}

impl Method {
    /// `step`, or what one of the schemes is called, or the stages of a collocation.
    pub(crate) fn new(kind: &str, scheme: &str, is_compensated: bool, substeps: u32) -> Result<Self, Failure> {
        let unknown = || {
            let known = schemes().into_iter().find(|(own, _)| *own == kind).map(|(_, names)| names.join("\", \""));
            let message = known.map_or_else(
                || {
                    "a method is \"step\", a composition, a splitting, a processed splitting or a collocation"
                        .to_owned()
                },
                |known| format!("there is no {kind} \"{scheme}\": take one of \"{known}\""),
            );
            Failure::Of("SetupError", message)
        };
        macro_rules! named {
            ($schemes:ident) => {
                $schemes::ALL.iter().find(|own| own.name().eq_ignore_ascii_case(scheme)).copied().ok_or_else(unknown)?
            };
        }
        let kind = match kind {
            "step" => Kind::Step,
            "composition" => Kind::Composition(named!(CompositionScheme)),
            "splitting" => Kind::Splitting(named!(SplittingScheme)),
            "processed" => Kind::Processed(named!(ProcessedScheme)),
            "collocation" => match scheme {
                "4" => Kind::Collocation(4),
                "8" => Kind::Collocation(8),
                _ => return Err(Failure::Of("SetupError", "a collocation has 4 or 8 stages".to_owned())),
            },
            _ => return Err(unknown()),
        };
        Ok(Self { kind, is_compensated, substeps: substeps.max(1) })
    }

    /// Of a scene with a force, which has its own step only.
    pub(crate) fn of_forced<S: Scene<Scalar = f64>>(self, scene: S, h: f64) -> Made<S> {
        match self {
            Self { kind: Kind::Step, is_compensated: false, substeps: 1 } => {
                Ok(Stepper::new(scene, h).map_err(|error| Failure::setup(&error))?.into_any())
            }
            _ => refused("a scene with a force is made by its own step alone: leave the method out"),
        }
    }

    /// What each group has; each type of stepper is some 200 kB of the wheel.
    pub(crate) fn of<S: Scene<Scalar = f64, Group: Methods<S>>>(self, scene: S, h: f64) -> Made<S> {
        let setup = |error: SetupError| Failure::setup(&error);
        match self {
            _ if has_a_pace(&scene) => S::Group::further(scene, h, self),
            Self { kind: Kind::Step, is_compensated: false, substeps: 1 } => {
                Ok(Stepper::new(scene, h).map_err(setup)?.into_any())
            }
            Self { kind: Kind::Composition(scheme), is_compensated: false, substeps: 1 } => {
                Ok(Stepper::composed(scene, h, scheme).map_err(setup)?.into_any())
            }
            _ => S::Group::further(scene, h, self),
        }
    }

    fn compensated<S, P>(self, stepper: Stepper<S, P>) -> Made<S>
    where
        S: Scene<Scalar = f64>,
        P: Plan<S, Kept: 'static> + Compensable + 'static,
    {
        if self.substeps > 1 {
            return refused("`substeps` go with the declared step of a Lagrangian alone, and not with `compensated`");
        }
        Ok(if self.is_compensated { stepper.compensated().into_any() } else { stepper.into_any() })
    }
}

fn has_a_pace<S: Scene<Scalar = f64>>(scene: &S) -> bool {
    scene.with_energy(&scene.advected(), 0.0).is_some()
}

fn refused<T>(message: &str) -> Result<T, Failure> {
    Err(Failure::Of("SetupError", message.to_owned()))
}

type Made<S> =
    Result<AnyStepper<<S as liestep::mechanics::Term>::Group, <S as liestep::mechanics::Term>::Advected>, Failure>;

/// A group with the methods that are its own.
pub(crate) trait Methods<S: Scene<Scalar = f64, Group = Self>>: LieGroup<Scalar = f64> {
    fn further(_: S, _: f64, _: Method) -> Made<S> {
        refused("splittings, collocation, substeps and compensated sums are on SO3: take a composition here")
    }
}

impl<S: Scene<Scalar = f64, Group = Self>> Methods<S> for SO3 {
    fn further(scene: S, h: f64, method: Method) -> Made<S> {
        let setup = |error: SetupError| Failure::setup(&error);
        if has_a_pace(&scene) {
            return match method {
                Method { kind: Kind::Step, is_compensated: false, substeps: 1 } => {
                    Ok(Stepper::new(scene, h).and_then(Stepper::paced).map_err(setup)?.into_any())
                }
                _ => refused("a pace is that of the declared step alone: leave the method out"),
            };
        }
        let flow = || Inertia::new(scene.inertia(&scene.advected())).map(|inertia| ExactBody::new(&inertia));
        let flow = flow().map_err(|error| Failure::setup(&error));
        match method.kind {
            Kind::Step if method.substeps > 1 && !method.is_compensated => {
                Ok(Stepper::new(scene, h).map_err(setup)?.or_substeps(method.substeps).into_any())
            }
            Kind::Step => method.compensated(Stepper::new(scene, h).map_err(setup)?),
            Kind::Composition(scheme) => method.compensated(Stepper::composed(scene, h, scheme).map_err(setup)?),
            Kind::Splitting(scheme) => method.compensated(Stepper::split(scene, h, flow?, scheme).map_err(setup)?),
            Kind::Processed(scheme) => method.compensated(Stepper::processed(scene, h, flow?, scheme).map_err(setup)?),
            _ if method.substeps > 1 => refused("`substeps` go with the declared step, and not with a collocation"),
            Kind::Collocation(4) => Ok(Stepper::collocated::<2>(scene, h).map_err(setup)?.into_any()),
            Kind::Collocation(_) => Ok(Stepper::collocated::<4>(scene, h).map_err(setup)?.into_any()),
        }
    }
}

macro_rules! without_more {
    ($($group:ty),+) => {
        $(impl<S: Scene<Scalar = f64, Group = Self>> Methods<S> for $group {})+
    };
}

without_more!(SO2, SE2, SE3, SU2, SL2, R1, R2, R3, Heisenberg, (SO3, SO3), (SO3, R3));
