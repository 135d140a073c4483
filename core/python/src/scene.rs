//! A declaration with numbers as something that can be run, whatever its group and what it carries.

use std::sync::Arc;

use liestep::SO3;
use liestep::Stepper;
use liestep::accuracy::{Accuracy, Choice};
use liestep::groups::{
    Advected, CayleyRetraction, Configuration, Heisenberg, LieGroup, R1, R2, R3, Retraction, SE2, SE3, SL2, SO2, SU2,
    SeenFrom,
};
use liestep::mechanics::{Scene as Stepped, WithKinetic};
use liestep::motion::AnyStepper;
use liestep_late::{Declaration, LateError, Role, Slots};
use nalgebra::{Matrix4, Point2, Point3};

use crate::ensemble::{Draws, Members, Outcome, run_members};
use crate::failure::Failure;
use crate::method::{Four, Method, Methods, V, WithEnergy};
use crate::run::{Course, Recorded, record};
use crate::start::{Start, started};

/// Programs are machine code where the feature asks for it, and else interpreted: the bits are the same.
#[cfg(feature = "machine")]
type Backend = liestep_machine::Machine;
#[cfg(not(feature = "machine"))]
type Backend = liestep_late::Interpreter;

pub(crate) type Late<G, W, K> = liestep_late::Late<G, W, K, Backend>;
type Sum<G, W> = Late<G, W, WithKinetic>;

/// What a program that is running has declared.
pub(crate) trait Scene: Send + Sync {
    /// Whether there is such a stepper.
    fn check(&self, method: (Method, f64)) -> Result<(), Failure>;

    fn run(&self, method: (Method, f64), start: &Start, course: &Course) -> Result<Recorded, Failure>;

    /// Whether a step of `−h` undoes one of `h`, as methods of a higher order ask for.
    fn is_self_adjoint(&self) -> bool;

    /// By the method and the step that are the cheapest for a tolerance.
    fn ask(&self, tolerance: f64, start: &Start, course: &Course) -> Result<(Recorded, Choice), Failure>;

    fn members(&self, method: (Method, f64), start: &Start, draws: Draws, plan: Members) -> Result<Outcome, Failure>;
}

/// The sum of all terms, in one program.
#[derive(Clone)]
struct Declared<G: LieGroup<Scalar = f64>, W> {
    sum: Sum<G, W>,
    /// All of them, term by term.
    numbers: Vec<f64>,
    has_force: bool,
}

impl<G: LieGroup<Scalar = f64>, W> Declared<G, W>
where
    (G, W): Methods<Sum<G, W>>,
    Sum<G, W>: Stepped<Scalar = f64, Group = G, Advected = W>,
{
    fn stepper(&self, (method, h): (Method, f64)) -> Result<AnyStepper<G, W>, Failure> {
        if self.has_force && !method.is_plain() {
            let message = "a scene with a force is made by its own step alone: leave the method out";
            return Err(Failure::Of("SetupError", message.to_owned()));
        }
        <(G, W)>::stepper(self.sum.clone(), h, method)
    }
}

impl<G, W> Scene for Declared<G, W>
where
    G: LieGroup<Scalar = f64> + liestep::accuracy::Steppable<Sum<G, W>>,
    W: Advected<G> + Slots + Send + Sync + 'static,
    (G, W): Methods<Sum<G, W>>,
    CayleyRetraction: Retraction<G>,
    Sum<G, W>: Stepped<Scalar = f64, Group = G, Advected = W> + Send + Sync,
{
    fn check(&self, method: (Method, f64)) -> Result<(), Failure> {
        self.stepper(method).map(drop)
    }

    fn run(&self, method: (Method, f64), start: &Start, course: &Course) -> Result<Recorded, Failure> {
        let stepper = self.stepper(method)?;
        record(&stepper, started(&stepper, start)?, course)
    }

    fn is_self_adjoint(&self) -> bool {
        self.sum.declaration().is_self_adjoint
    }

    fn ask(&self, tolerance: f64, start: &Start, course: &Course) -> Result<(Recorded, Choice), Failure> {
        let (attitude, velocity) = (start.attitude::<G>()?, start.velocity::<G>()?);
        let accuracy = Accuracy { tolerance, horizon: course.until };
        let stepper = Stepper::for_accuracy(self.sum.clone(), accuracy, attitude, velocity);
        let stepper = stepper.map_err(|error| Failure::setup(&error))?;
        let recorded = record(&*stepper, stepper.start(), course)?;
        Ok((recorded, stepper.choice().clone()))
    }

    fn members(&self, method: (Method, f64), start: &Start, draws: Draws, plan: Members) -> Result<Outcome, Failure> {
        let (own, (method, h)) = (self.clone(), method);
        if own.sum.declaration().energy.is_some() || method.varies() {
            let message =
                "members make the same number of steps, and those of a pace or a density end at different times";
            return Err(Failure::Of("SetupError", message.to_owned()));
        }
        // The first member says what is wrong with all of them.
        self.run((method, h), start, &Course { until: 0.0, every: 1, times: None, events: Vec::new() })?;
        let make = move |draw: &dyn Fn(&mut [f64])| {
            let mut numbers = own.numbers.clone();
            draw(&mut numbers);
            let sum = own.sum.clone().with_all(&numbers)?;
            Declared { sum, ..own.clone() }.stepper((method, h)).map(AnyStepper::hiding_advected)
        };
        run_members(plan, start, draws, make, h)
    }
}

/// The sum of these terms, if the types fit it.
fn declared<G, W>(sum: &'static Declaration, numbers: &[f64], has_force: bool) -> Result<Arc<dyn Scene>, LateError>
where
    G: LieGroup<Scalar = f64>,
    W: Advected<G> + Slots + 'static,
    Declared<G, W>: Scene + 'static,
{
    let sum = Sum::<G, W>::of(sum)?.with_all(numbers)?;
    Ok(Arc::new(Declared { sum, numbers: numbers.to_vec(), has_force }))
}

/// A vector as the first body sees it, and as the second.
type First = SeenFrom<0, V<3>>;
type Second = SeenFrom<1, V<3>>;
type PlaceOfSecond = Configuration<1, Matrix4<f64>>;

/// The scene of the sum of these terms, with the numbers of all.
pub(crate) fn scene(terms: &[&'static Declaration], numbers: &[f64]) -> Result<Arc<dyn Scene>, Failure> {
    if terms.len() > 1 && terms.iter().any(|term| term.energy.is_some()) {
        return Err(Failure::setup(&LateError::Pace));
    }
    let sum = Declaration::sum(terms)?;
    if !sum.has_kinetic {
        let message = "nothing moves by a potential alone: add a kinetic energy, as in `ls.body(J) + potential`";
        return Err(Failure::Of("DeclarationError", message.to_owned()));
    }
    let has_force = terms.iter().any(|term| term.role == Role::Force);
    macro_rules! first_that_fits {
        ($sum:expr; $($group:ty: $($carried:ty),+;)+) => {$($(
            match declared::<$group, $carried>($sum, numbers, has_force) {
                Err(LateError::Group { .. } | LateError::Advected { .. }) => {}
                other => return other.map_err(Failure::from),
            }
        )+)+};
    }
    // More vectors than the types carry are made of the directions of space.
    for in_frames in [false, true] {
        let sum = if in_frames && sum.energy.is_none() { Declaration::sum_in_frames(terms)? } else { sum };
        first_that_fits! {
            sum;
            SO3: V<3>, Four, WithEnergy;
            SO2: (V<2>, V<2>);
            SE2: (V<3>, V<3>, V<3>), Point2<f64>;
            SE3: (V<4>, V<4>, V<4>, V<4>), Point3<f64>;
            SU2: ();
            SL2: (V<2>, V<2>);
            R1: (V<2>, V<2>);
            R2: (V<3>, V<3>, V<3>);
            R3: (V<4>, V<4>, V<4>, V<4>);
            Heisenberg: ();
            (SO3, SO3): (First, Second, First, Second, First, Second);
            (SO3, R3): PlaceOfSecond, (First, PlaceOfSecond, First, First);
        }
    }
    let known = "on SO3, SO2, SL2, R1, R2 and R3 vectors are advected, on SE2 and SE3 vectors or one point, on (SO3, SO3) \
                 vectors seen from each, on (SO3, R3) vectors seen from the body and where the other is";
    let (group, carried) = (sum.group(), sum.carried.len());
    let message = format!("{group} with these {carried} advected parameters can't be stepped here: {known}");
    Err(Failure::Of("DeclarationError", message))
}
