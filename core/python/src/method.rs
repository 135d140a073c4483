//! What a scene is stepped by.

use liestep::groups::{Given, Heisenberg, R1, R2, R3, SE2, SE3, SL2, SO2, SU2};
use liestep::mechanics::{Inertia, Scene, Term};
use liestep::methods::{CompositionScheme, ExactBody, ProcessedScheme, SplittingScheme};
use liestep::motion::{AnyStepper, Plan};
use liestep::with::{Compensable, densities};
use liestep::{SO3, SetupError, Stepper};

use crate::failure::Failure;

pub(crate) type V<const N: usize> = nalgebra::SVector<f64, N>;
/// What is advected on SO(3), where it is more than one vector, and with the energy of a pace.
pub(crate) type Four = (V<3>, V<3>, V<3>, V<3>);
pub(crate) type WithEnergy = (Given<f64>, V<3>, V<3>, V<3>);

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
    /// Of steps in which a body turns by about as much, from this velocity on, rad/s.
    Density(f64),
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
    /// Whether steps have lengths of their own.
    pub(crate) const fn varies(self) -> bool {
        matches!(self.kind, Kind::Density(_))
    }

    /// Whether it is the declared step, without more around it.
    pub(crate) const fn is_plain(self) -> bool {
        matches!(self, Self { kind: Kind::Step, is_compensated: false, substeps: 1 })
    }

    /// That of the errors; of a declared step the one that all have.
    pub(crate) fn order(self) -> u32 {
        match self.kind {
            Kind::Step | Kind::Density(_) => 2,
            Kind::Composition(scheme) => scheme.order(),
            Kind::Splitting(scheme) => scheme.order(),
            Kind::Processed(scheme) => scheme.order(),
            Kind::Collocation(stages) => u32::try_from(2 * stages).unwrap_or(2),
        }
    }

    /// `step`, or what one of the schemes is called, or the stages of a collocation.
    pub(crate) fn new(kind: &str, scheme: &str, is_compensated: bool, substeps: u32) -> Result<Self, Failure> {
        let unknown = || {
            let known = schemes().into_iter().find(|(own, _)| *own == kind).map(|(_, names)| names.join("\", \""));
            let message = known.map_or_else(
                || {
                    "a method is \"step\", a density, a composition, a splitting, a processed splitting or a collocation"
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
            "density" => Kind::Density(scheme.parse().map_err(|_| unknown())?),
            _ => return Err(unknown()),
        };
        Ok(Self { kind, is_compensated, substeps: substeps.max(1) })
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

fn refused<T>(message: &str) -> Result<T, Failure> {
    Err(Failure::Of("SetupError", message.to_owned()))
}

type Made<S> =
    Result<AnyStepper<<S as liestep::mechanics::Term>::Group, <S as liestep::mechanics::Term>::Advected>, Failure>;

/// What is advected on a group, with the methods that are its own: each type of stepper is some 200 kB of the wheel.
pub(crate) trait Methods<S: Scene<Scalar = f64>> {
    fn stepper(scene: S, h: f64, method: Method) -> Made<S> {
        let setup = |error: SetupError| Failure::setup(&error);
        match method {
            Method { kind: Kind::Step, is_compensated: false, substeps: 1 } => {
                Ok(Stepper::new(scene, h).map_err(setup)?.into_any())
            }
            Method { kind: Kind::Composition(scheme), is_compensated: false, substeps: 1 } => {
                Ok(Stepper::composed(scene, h, scheme).map_err(setup)?.into_any())
            }
            _ => refused(
                "splittings, collocation, densities, substeps and compensated sums are on SO3: take a composition here",
            ),
        }
    }
}

fn on_so3<S: Scene<Scalar = f64, Group = SO3>>(scene: S, h: f64, method: Method) -> Made<S> {
    let setup = |error: SetupError| Failure::setup(&error);
    let flow = || Inertia::new(scene.inertia(&scene.advected())).map(|inertia| ExactBody::new(&inertia));
    let flow = flow().map_err(|error| Failure::setup(&error));
    match method.kind {
        Kind::Density(_) if method.is_compensated || method.substeps > 1 => {
            refused("a density is around the declared step alone: leave `compensated` and `substeps` out")
        }
        Kind::Density(floor) => {
            let rate = densities::turn(scene.clone(), floor);
            Ok(Stepper::new(scene, h).map_err(setup)?.with_density(rate).into_any())
        }
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

impl<S: Scene<Scalar = f64, Group = SO3, Advected = V<3>>> Methods<S> for (SO3, V<3>) {
    fn stepper(scene: S, h: f64, method: Method) -> Made<S> {
        on_so3(scene, h, method)
    }
}

impl<S: Scene<Scalar = f64, Group = SO3, Advected = Four>> Methods<S> for (SO3, Four) {
    fn stepper(scene: S, h: f64, method: Method) -> Made<S> {
        on_so3(scene, h, method)
    }
}

impl<S: Scene<Scalar = f64, Group = SO3, Advected = WithEnergy>> Methods<S> for (SO3, WithEnergy) {
    fn stepper(scene: S, h: f64, method: Method) -> Made<S> {
        match method {
            Method { kind: Kind::Step, is_compensated: false, substeps: 1 } => {
                let stepper = Stepper::new(scene, h).and_then(Stepper::paced);
                Ok(stepper.map_err(|error| Failure::setup(&error))?.into_any())
            }
            _ => refused("a pace is that of the declared step alone: leave the method out"),
        }
    }
}

macro_rules! without_more {
    ($($group:ty),+) => {
        $(impl<S: Scene<Scalar = f64, Group = $group>> Methods<S> for ($group, <S as Term>::Advected) {})+
    };
}

without_more!(SO2, SE2, SE3, SU2, SL2, R1, R2, R3, Heisenberg, (SO3, SO3), (SO3, R3));
