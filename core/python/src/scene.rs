//! A declaration with numbers as something that can be run, whatever its group and what it carries.

use std::sync::Arc;

use liestep::SO3;
use liestep::accuracy::{Accuracy, Choice};
use liestep::groups::{
    Advected, CayleyRetraction, Configuration, Heisenberg, LieGroup, R1, R2, R3, Retraction, SE2, SE3, SL2, SO2, SU2,
    SeenFrom,
};
use liestep::mechanics::{KineticPart, Scene as Stepped, Sum, WithEitherKinetic, WithoutKinetic};
use liestep::motion::{AnyState, AnyStepper};
use liestep::numbers::Entries;
use liestep::{SetupError, Stepper};
use liestep_late::{Declaration, LateError, Slots};
use nalgebra::{Matrix4, Point2, Point3, Quaternion, UnitQuaternion};

use crate::ensemble::{Draws, Members, Outcome, run_members};
use crate::failure::Failure;
use crate::method::{Four, Method, Methods, V, WithEnergy};
use crate::run::{Course, Recorded, Start, record};

/// Values of parameters, by their names.
pub(crate) type Numbers = Vec<(String, Vec<f64>)>;

/// Programs are machine code where the feature asks for it, and else interpreted: the bits are the same.
#[cfg(feature = "machine")]
type Backend = liestep_machine::Machine;
#[cfg(not(feature = "machine"))]
type Backend = liestep_late::Interpreter;

pub(crate) type Late<G, W, K> = liestep_late::Late<G, W, K, Backend>;
type Lagrangian<G, W> = Late<G, W, WithEitherKinetic>;
type Force<G, W> = Late<G, W, WithoutKinetic>;

/// What a program that is running has declared.
pub(crate) trait Scene: Send + Sync {
    /// Whether there is such a stepper.
    fn check(&self, method: (Method, f64)) -> Result<(), Failure>;

    fn run(&self, method: (Method, f64), start: &Start, course: &Course) -> Result<Recorded, Failure>;

    /// By the method and the step that are the cheapest for a tolerance.
    fn ask(&self, tolerance: f64, start: &Start, course: &Course) -> Result<(Recorded, Choice), Failure>;

    fn members(&self, method: (Method, f64), start: &Start, draws: Draws, plan: Members) -> Result<Outcome, Failure>;
}

/// A Lagrangian, and the sum of forces if there is one.
struct Declared<G: LieGroup<Scalar = f64>, W> {
    lagrangian: Lagrangian<G, W>,
    /// Of the Lagrangian, as they were given.
    numbers: Numbers,
    force: Option<Force<G, W>>,
}

impl<G: LieGroup<Scalar = f64>, W> Clone for Declared<G, W> {
    fn clone(&self) -> Self {
        Self { lagrangian: self.lagrangian.clone(), numbers: self.numbers.clone(), force: self.force.clone() }
    }
}

/// Calls the same for the stepper with the force and for that without, which are of two types.
macro_rules! with_stepper {
    ($own:expr, ($method:expr, $h:expr), |$stepper:ident| $body:expr) => {
        match $own.force.clone() {
            None => {
                let $stepper = <(G, W)>::stepper($own.lagrangian.clone(), $h, $method)?;
                $body
            }
            Some(force) => {
                // Without what is advected in its type: one code for all forces on a group.
                let $stepper = $method.of_forced(Sum::new($own.lagrangian.clone(), force), $h)?.hiding_advected();
                $body
            }
        }
    };
}

impl<G, W> Scene for Declared<G, W>
where
    G: LieGroup<Scalar = f64> + liestep::accuracy::Steppable<Lagrangian<G, W>>,
    W: Advected<G> + Slots + Send + Sync + 'static,
    (G, W): Methods<Lagrangian<G, W>>,
    CayleyRetraction: Retraction<G>,
    Lagrangian<G, W>: Stepped<Scalar = f64, Group = G, Advected = W> + Send + Sync,
    Sum<Lagrangian<G, W>, Force<G, W>>: Stepped<Scalar = f64, Group = G, Advected = (W, W)>,
    Force<G, W>: Send + Sync,
{
    fn check(&self, method: (Method, f64)) -> Result<(), Failure> {
        with_stepper!(self, (method.0, method.1), |stepper| {
            drop(stepper);
            Ok(())
        })
    }

    fn run(&self, method: (Method, f64), start: &Start, course: &Course) -> Result<Recorded, Failure> {
        with_stepper!(self, (method.0, method.1), |stepper| record(&stepper, started(&stepper, start)?, course))
    }

    fn ask(&self, tolerance: f64, start: &Start, course: &Course) -> Result<(Recorded, Choice), Failure> {
        if self.force.is_some() {
            let message = "an accuracy is asked of a Lagrangian alone: give a step where there is a force";
            return Err(Failure::Of("SetupError", message.to_owned()));
        }
        let (attitude, velocity) = (start.attitude::<G>()?, start.velocity::<G>()?);
        let accuracy = Accuracy { tolerance, horizon: course.until };
        let stepper = Stepper::for_accuracy(self.lagrangian.clone(), accuracy, attitude, velocity);
        let stepper = stepper.map_err(|error| Failure::setup(&error))?;
        let recorded = record(&*stepper, stepper.start(), course)?;
        Ok((recorded, stepper.choice().clone()))
    }

    fn members(&self, method: (Method, f64), start: &Start, draws: Draws, plan: Members) -> Result<Outcome, Failure> {
        let (mut own, (method, h)) = (self.clone(), method);
        own.numbers.retain(|(name, _)| draws.iter().any(|draw| draw.of == *name));
        if own.lagrangian.declaration().energy.is_some() || method.varies() {
            let message =
                "members make the same number of steps, and those of a pace or a density end at different times";
            return Err(Failure::Of("SetupError", message.to_owned()));
        }
        // The first member says what is wrong with all of them.
        self.run((method, h), start, &Course { until: 0.0, every: 1, times: None, events: Vec::new() })?;
        let drawn = move |own: &Self, draws: &mut dyn FnMut(&str, &mut [f64])| {
            let mut lagrangian = own.lagrangian.clone();
            for (name, numbers) in &own.numbers {
                let mut value = numbers.clone();
                draws(name, &mut value);
                if value != *numbers {
                    lagrangian = lagrangian.with(name, &value)?;
                }
            }
            Ok::<_, Failure>(lagrangian)
        };
        let Some(force) = self.force.clone() else {
            let make = move |draw: &mut dyn FnMut(&str, &mut [f64])| {
                <(G, W)>::stepper(drawn(&own, draw)?, h, method).map(AnyStepper::hiding_advected)
            };
            return run_members(plan, start, draws, make, h);
        };
        let make = move |draw: &mut dyn FnMut(&str, &mut [f64])| {
            method.of_forced(Sum::new(drawn(&own, draw)?, force.clone()), h).map(AnyStepper::hiding_advected)
        };
        run_members(plan, start, draws, make, h)
    }
}

/// The state at a start.
pub(crate) fn started<G: LieGroup<Scalar = f64>, W>(
    stepper: &AnyStepper<G, W>,
    start: &Start,
) -> Result<AnyState<G, W>, Failure> {
    let setup = |error: SetupError| Failure::setup(&error);
    stepper.start(start.attitude::<G>()?, start.velocity::<G>()?).map_err(setup)
}

/// More is no rounding of an element of a group.
const DEFECT: f64 = 1e-6;

impl Start {
    pub(crate) fn velocity<G: LieGroup<Scalar = f64>>(&self) -> Result<G::Vector, Failure> {
        if self.velocity.len() != G::DIMENSION {
            let (expected, found) = (G::DIMENSION, self.velocity.len());
            return Err(Failure::Of("SetupError", format!("a velocity has {expected} components here, not {found}")));
        }
        let mut numbers = self.velocity.iter().copied();
        Ok(G::Vector::from_entries(&mut || numbers.next().unwrap_or(f64::NAN)))
    }

    pub(crate) fn attitude<G: LieGroup<Scalar = f64>>(&self) -> Result<G, Failure> {
        let wrong = |message: String| Err(Failure::Of("SetupError", message));
        if self.attitude.is_empty() {
            return Ok(G::identity());
        }
        if self.is_quaternion {
            let [w, x, y, z] = self.attitude[..] else {
                return wrong(format!("a quaternion has four components, not {}", self.attitude.len()));
            };
            let unit = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-300);
            let Some(unit) = unit.filter(|unit| unit.coords.iter().all(|part| part.is_finite())) else {
                return wrong("a quaternion isn't zero, and is finite".to_owned());
            };
            let rotation = G::from_rotation(unit.to_rotation_matrix().into_inner());
            return rotation
                .map_or_else(|| wrong("a quaternion is an attitude on SO3: give a matrix here".to_owned()), Ok);
        }
        let mut entries = 0;
        G::identity().matrix().each(&mut |_| entries += 1);
        if self.attitude.len() != entries {
            let found = self.attitude.len();
            return wrong(format!("an attitude has {entries} entries here, and {found} were given"));
        }
        let mut numbers = self.attitude.iter().copied();
        let matrix = G::Matrix::from_entries(&mut || numbers.next().unwrap_or(f64::NAN));
        let element = G::from_matrix_unchecked(matrix);
        let defect = element.defect();
        // A reflection satisfies the relation, too. Rotations stand first in a product.
        let rotations = G::named_numbers().iter().filter(|(name, _)| name.starts_with("q_w")).count();
        let turns = |entries: &[f64]| nalgebra::Matrix3::from_row_slice(entries).determinant() > 0.0;
        if defect < DEFECT && self.attitude.chunks_exact(9).take(rotations).all(turns) {
            return Ok(element);
        }
        wrong(format!("the attitude isn't in the group: its relation is violated by {defect:e}, or it is a reflection"))
    }
}

/// What is asked of a type before there is a value: that the declarations fit it.
struct Fits<'a> {
    lagrangian: (&'static Declaration, &'a Numbers),
    force: Option<(&'static Declaration, &'a Numbers)>,
}

fn numbered<G, W, K>((declaration, numbers): (&'static Declaration, &Numbers)) -> Result<Late<G, W, K>, LateError>
where
    G: LieGroup<Scalar = f64>,
    W: Advected<G> + Slots,
    K: KineticPart,
{
    numbers.iter().try_fold(Late::of(declaration)?, |late, (name, value)| late.with(name, value))
}

impl Fits<'_> {
    fn to<G, W>(&self) -> Result<Arc<dyn Scene>, LateError>
    where
        G: LieGroup<Scalar = f64>,
        W: Advected<G> + Slots + 'static,
        Declared<G, W>: Scene + 'static,
    {
        let force = self.force.map(numbered).transpose()?;
        Ok(Arc::new(Declared::<G, W> {
            lagrangian: numbered(self.lagrangian)?,
            numbers: self.lagrangian.1.clone(),
            force,
        }))
    }
}

/// The scene of a Lagrangian, with the sum of forces if there is one.
pub(crate) fn scene(
    lagrangian: (&'static Declaration, &Numbers),
    force: Option<(&'static Declaration, &Numbers)>,
) -> Result<Arc<dyn Scene>, Failure> {
    let fits = Fits { lagrangian, force };
    if !lagrangian.0.has_kinetic {
        let message = "nothing moves by a potential alone: add a kinetic energy, as in `ls.body(J) + potential`";
        return Err(Failure::Of("DeclarationError", message.to_owned()));
    }
    if lagrangian.0.energy.is_some() && force.is_some() {
        let message = "a pace is that of a Lagrangian alone, and a force has none: leave one of them out";
        return Err(Failure::Of("SetupError", message.to_owned()));
    }
    macro_rules! first_that_fits {
        ($($group:ty: $($carried:ty),+;)+) => {$($(
            match fits.to::<$group, $carried>() {
                Err(LateError::Group { .. } | LateError::Advected { .. }) => {}
                other => return other.map_err(Failure::from),
            }
        )+)+};
    }
    first_that_fits! {
        SO3: V<3>, Four, WithEnergy;
        SO2: V<2>;
        SE2: V<3>, Point2<f64>;
        SE3: V<4>, Point3<f64>;
        SU2: ();
        SL2: V<2>;
        R1: V<2>;
        R2: V<3>;
        R3: V<4>;
        Heisenberg: ();
        (SO3, SO3): (SeenFrom<0, V<3>>, SeenFrom<1, V<3>>);
        (SO3, R3): Configuration<1, Matrix4<f64>>, (SeenFrom<0, V<3>>, Configuration<1, Matrix4<f64>>);
    }
    let known = "on SO3 up to four vectors in space are advected, on SO2, SL2, R1, R2 and R3 one vector, on SE2 and SE3 one vector or point, on \
                 (SO3, SO3) one vector seen from each, on (SO3, R3) one vector seen from the body and where the other is";
    let (declared, carried) = (lagrangian.0.group(), lagrangian.0.carried.len());
    let message = format!("{declared} with these {carried} advected parameters isn't in this build: {known}");
    Err(Failure::Of("DeclarationError", message))
}
