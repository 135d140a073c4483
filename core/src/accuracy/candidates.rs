//! The methods to choose from.

use alloc::borrow::ToOwned as _;
use alloc::boxed::Box;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::ops::Deref;

use super::error::AccuracyError;
use super::search::search;
use super::trials::{Start, Tried};
use super::{Accuracy, AccurateStepper, Choice};
use crate::error::SetupError;
use crate::groups::{Advected, LieGroup, Retraction as _, SO3};
use crate::mechanics::{Effect, Group, Inertia, Scalar, Scene, Vector};
use crate::methods::{
    CompositionScheme, ExactBody, KineticFlow, ProcessedScheme, SplittingScheme, SymmetricBody, has_force_gradient,
};
use crate::motion::{AnyStepper, Cost, Plan, Stepper};

/// A method, to be made for a step.
pub(super) struct Method<G: LieGroup, A> {
    pub(super) name: String,
    pub(super) order: u32,
    /// Solves or flows in a step.
    pub(super) stages: u32,
    /// Whether it has no error but rounding.
    pub(super) is_exact: bool,
    pub(super) make: Make<G, A>,
}

/// The iterations of a long step, as a multiple of the fewest. Of the trials with up to four steps that the tests make,
/// nine in ten take no more, and all together 2.3 times the fewest.
const OF_A_LONG_STEP: f64 = 4.0;

/// A method of a question, with the operations that its runs make.
pub(super) struct Candidate<'a, G: LieGroup, A> {
    pub(super) method: &'a Method<G, A>,
    cost: Cost,
}

impl<G: LieGroup, A> Candidate<'_, G, A> {
    /// Operations that a step makes at least.
    pub(super) fn a_step(&self) -> f64 {
        self.cost.least()
    }

    /// Those that a long one is thought to make, before one is tried.
    pub(super) fn a_long_step(&self) -> f64 {
        let Cost { step, iteration, fewest, .. } = self.cost;
        step + iteration * OF_A_LONG_STEP * f64::from(fewest)
    }

    /// Those of a run besides its steps.
    pub(super) fn once(&self) -> f64 {
        self.cost.once
    }

    /// What a run of so many steps makes at least.
    pub(super) fn least(&self, steps: f64) -> f64 {
        self.once() + steps * self.a_step()
    }

    /// What a run of so many long steps is thought to make.
    pub(super) fn untried(&self, steps: f64) -> f64 {
        self.once() + steps * self.a_long_step()
    }
}

impl<G: LieGroup, A> Deref for Candidate<'_, G, A> {
    type Target = Method<G, A>;

    fn deref(&self) -> &Method<G, A> {
        self.method
    }
}

type Make<G, A> = Box<dyn Fn(f64) -> Result<AnyStepper<G, A>, SetupError>>;

/// The methods that [`Stepper::for_accuracy`] chooses from, with more than a scene alone can tell.
///
/// Every self-adjoint scene has its own step and its symmetric compositions. Added to them are splittings, where the
/// potential can be split off and the free body's motion is known; Gauss collocation, where it can be split off; and other
/// declarations of the same scene, of higher order.
///
/// # Examples
///
/// ```
/// use liestep::effects::{Gravity, PrincipalBody};
/// use liestep::{NonstandardInertia, SO3};
/// use liestep::accuracy::{Accuracy, Candidates};
/// use liestep::groups::LieGroup;
/// use liestep::mechanics::DiagonalNonstandardInertia;
/// use liestep::methods::SymmetricBody;
/// use nalgebra::Vector3;
///
/// let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0))?;
/// let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::x() };
/// let free = SymmetricBody::new(&NonstandardInertia::from(J_d).to_inertia())?;
/// let scene = PrincipalBody { J_d } + gravity;
/// let candidates = Candidates::of(scene, 2).and_splittings("exact", scene, free);
/// let accuracy = Accuracy { tolerance: 1e-8, horizon: 10.0 };
/// let stepper = candidates.for_accuracy(accuracy, SO3::identity(), Vector3::new(0.1, 0.0, 9.0))?;
/// assert!(stepper.choice().chosen().name.starts_with("exact"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Candidates<G: LieGroup, A: Advected<G>> {
    methods: Vec<Method<G, A>>,
    /// Of the first scene: what others must agree with.
    inertia: Vec<f64>,
    seen: Vec<Seen>,
    mistake: Option<SetupError>,
}

impl<G: LieGroup<Scalar = f64>, A: Advected<G> + 'static> Candidates<G, A> {
    /// The step of a scene that is a method of this order (2, if its terms are those of [`effects`](crate::effects)),
    /// and its symmetric compositions.
    ///
    /// A scene that isn't self-adjoint is refused when the user's crate is built, as by [`Stepper::composed`].
    #[must_use]
    #[allow(clippy::needless_pass_by_value)] // as `Stepper::new`
    pub fn of<S>(scene: S, order: u32) -> Self
    where
        S: Scene<Scalar = f64, Group = G, Advected = A>,
    {
        let empty = Self { methods: Vec::new(), inertia: inertia(&scene), seen: seen(&scene), mistake: None };
        empty.and_steps_of("", &scene, order)
    }

    /// The step of another declaration of the same scene, of this order, and its symmetric compositions.
    #[must_use]
    #[allow(clippy::needless_pass_by_value)] // as `of`
    pub fn and_declared<S>(mut self, name: &str, scene: S, order: u32) -> Self
    where
        S: Scene<Scalar = f64, Group = G, Advected = A>,
    {
        self.compare(&scene);
        self.and_steps_of(&format!("{name}, "), &scene, order)
    }

    fn and_steps_of<S>(mut self, prefix: &str, scene: &S, order: u32) -> Self
    where
        S: Scene<Scalar = f64, Group = G, Advected = A>,
    {
        let alone = scene.clone();
        let make = move |h| Stepper::new(alone.clone(), h);
        self.add(format!("{prefix}its own step"), (order, 1), make);
        for scheme in CompositionScheme::ALL.into_iter().filter(|scheme| scheme.base() == order) {
            let (scene, stages) = (scene.clone(), count(scheme.stages().count()));
            let make = move |h| Stepper::composed(scene.clone(), h, scheme);
            self.add(format!("{prefix}{}", scheme.name()), (scheme.order(), stages), make);
        }
        self
    }

    /// A method of this order and so many stages.
    fn add<S, P>(
        &mut self,
        name: String,
        (order, stages): (u32, u32),
        make: impl Fn(f64) -> Result<Stepper<S, P>, SetupError> + 'static,
    ) where
        S: Scene<Scalar = f64, Group = G, Advected = A>,
        P: Plan<S, Kept: 'static> + 'static,
    {
        let make = Box::new(move |h| make(h).map(Stepper::into_any));
        self.methods.push(Method { name, order, stages, is_exact: false, make });
    }

    fn compare<L>(&mut self, scene: &L)
    where
        L: Effect<Scalar = f64, Group = G, Advected = A>,
    {
        let size = self.inertia.iter().map(|entry| entry.abs()).sum::<f64>();
        let difference = apart(&self.inertia, &inertia(scene));
        if difference > SAME * size {
            self.mistake.get_or_insert(SetupError::InertiaMismatch { difference });
        }
        let seen = seen(scene);
        // A potential is given but for a constant.
        let potentials = |places: &[Seen]| places.iter().map(|place| place.potential - places[0].potential).collect();
        let (own, other): (Vec<_>, Vec<_>) = (potentials(&self.seen), potentials(&seen));
        let largest = self.seen.iter().chain(&seen).map(|place| place.potential.abs()).fold(0.0, f64::max);
        if apart(&own, &other) > SAME * largest {
            self.mistake.get_or_insert(SetupError::PotentialMismatch);
        }
        for (own, other) in self.seen.iter().zip(&seen) {
            let largest = own.bias.iter().chain(&other.bias).map(|entry| entry.abs()).fold(0.0, f64::max);
            if apart(&own.bias, &other.bias) > SAME * largest {
                self.mistake.get_or_insert(SetupError::BiasMismatch);
            }
        }
    }

    /// The cheapest of these methods that comes within the accuracy, with its step, for the motion from an attitude
    /// (body to space) and a body velocity; see [`Stepper::for_accuracy`].
    ///
    /// # Errors
    ///
    /// [`AccuracyError`].
    pub fn for_accuracy(
        &self,
        accuracy: Accuracy,
        attitude: impl Into<G>,
        velocity: G::Vector,
    ) -> Result<AccurateStepper<G, A>, AccuracyError> {
        accuracy.validate()?;
        if let Some(mistake) = &self.mistake {
            return Err(mistake.clone().into());
        }
        let start = Start { attitude: attitude.into(), velocity, horizon: accuracy.horizon };
        // What is wrong with the scene or with the start is wrong with any step.
        let mut candidates = Vec::with_capacity(self.methods.len());
        for method in &self.methods {
            let stepper = (method.make)(accuracy.horizon / 1024.0)?;
            stepper.start(start.attitude, start.velocity)?;
            candidates.push(Candidate { method, cost: stepper.cost() });
        }
        let tried = Tried::new(&start);
        let found = search(&candidates, accuracy, tried)?;
        let stepper = (self.methods[found.index].make)(accuracy.horizon / found.steps)?;
        let state = stepper.start(start.attitude, start.velocity)?;
        let choice = Choice::new(&candidates, accuracy, &found);
        Ok(AccurateStepper { stepper, start: state, choice })
    }
}

impl<A: Advected<SO3> + 'static> Candidates<SO3, A> {
    /// The step of a scene that is a method of this order, its symmetric compositions, and what else a body can be
    /// stepped by: where its potential can be split off, splittings, processed ones among them, with the exact motion of
    /// the free body, and Gauss collocation.
    ///
    /// A scene that isn't self-adjoint is refused as by [`of`](Self::of).
    #[must_use]
    pub fn of_body<S>(scene: S, order: u32) -> Self
    where
        S: Scene<Scalar = f64, Group = SO3, Advected = A>,
    {
        let candidates = Self::of(scene.clone(), order);
        // What these methods ask of a scene.
        let Ok(inertia) = Inertia::new(scene.inertia(&scene.advected())) else { return candidates };
        let body = ExactBody::new(&inertia);
        if Stepper::split(scene.clone(), 1.0, body, SplittingScheme::STRANG).is_err() {
            return candidates;
        }
        match SymmetricBody::new(&inertia) {
            Ok(symmetric) => candidates.and_splittings("exact", scene.clone(), symmetric),
            Err(_) => candidates.and_splittings("exact", scene.clone(), body),
        }
        .and_gauss(scene)
    }

    /// The kinetic-potential splittings of a declaration of the same scene, processed ones among them, with this flow of
    /// its body; of a free body that flow alone.
    #[must_use]
    #[allow(clippy::needless_pass_by_value)] // as `Stepper::split`
    pub fn and_splittings<S, K>(mut self, name: &str, scene: S, kinetic: K) -> Self
    where
        S: Scene<Scalar = f64, Group = SO3, Advected = A>,
        K: KineticFlow<f64> + 'static,
    {
        self.compare(&scene);
        // Nothing is kicked: any splitting is the flow, which this one makes once a step.
        if !S::PARTS.kick_before {
            let make = move |h| Stepper::split(scene.clone(), h, kinetic.clone(), SplittingScheme::STRANG);
            self.add(name.to_owned(), (SplittingScheme::STRANG.order(), 1), make);
            if let Some(method) = self.methods.last_mut() {
                method.is_exact = K::EXACT;
            }
            return self;
        }
        let has_gradient = has_force_gradient(&scene);
        for scheme in SplittingScheme::ALL.into_iter().filter(|scheme| has_gradient || !scheme.has_gradients()) {
            let (scene, kinetic, stages) = (scene.clone(), kinetic.clone(), count(scheme.drifts()));
            let make = move |h| Stepper::split(scene.clone(), h, kinetic.clone(), scheme);
            self.add(format!("{name}, {}", scheme.name()), (scheme.order(), stages), make);
        }
        for scheme in ProcessedScheme::ALL.into_iter().filter(|_| has_gradient) {
            let (scene, kinetic, stages) = (scene.clone(), kinetic.clone(), count(scheme.kernel().drifts()));
            let make = move |h| Stepper::processed(scene.clone(), h, kinetic.clone(), scheme);
            self.add(format!("{name}, {}", scheme.name()), (scheme.order(), stages), make);
        }
        self
    }

    /// [`Gauss`](crate::methods::Gauss) collocation with 4 and 8 stages of a declaration of the same scene; any will do,
    /// as only inertia and potential matter. Six stages don't fill the machine's vectors, and take longer than eight.
    #[must_use]
    #[allow(clippy::needless_pass_by_value)] // as `Stepper::collocated`
    pub fn and_gauss<S>(mut self, scene: S) -> Self
    where
        S: Scene<Scalar = f64, Group = SO3, Advected = A>,
    {
        self.compare(&scene);
        self.add_gauss::<S, 2>(&scene);
        self.add_gauss::<S, 4>(&scene);
        self
    }

    fn add_gauss<S, const PAIRS: usize>(&mut self, scene: &S)
    where
        S: Scene<Scalar = f64, Group = SO3, Advected = A>,
    {
        let (scene, stages) = (scene.clone(), count(2 * PAIRS));
        let make = move |h| Stepper::collocated::<PAIRS>(scene.clone(), h);
        self.add(format!("Gauss, {stages} stages"), (2 * stages, stages * ITERATIONS), make);
    }
}

/// How often a step of collocation computes each of its stages, about.
const ITERATIONS: u32 = 14;

fn count(stages: usize) -> u32 {
    u32::try_from(stages).unwrap_or(u32::MAX)
}

/// The inertia's columns at several places.
fn inertia<L: Effect<Scalar = f64>>(scene: &L) -> Vec<f64> {
    let mut entries = Vec::new();
    for place in places::<L>() {
        let inertia = scene.inertia(&scene.advected().seen_from(&place));
        for k in 0..<Group<L> as LieGroup>::DIMENSION {
            let column: Vector<L> = inertia * <Vector<L> as crate::numbers::Coordinates<Scalar<L>>>::axis(k);
            crate::numbers::Entries::each(&column, &mut |entry| entries.push(entry));
        }
    }
    entries
}

/// Up to this part scenes are one scene.
const SAME: f64 = 1e-9;

/// What a scene is at one place, by its own parameters.
struct Seen {
    /// J
    potential: f64,
    /// The momentum at rest.
    bias: Vec<f64>,
}

/// Enough to tell the potentials of a body apart.
fn places<L: Effect<Scalar = f64>>() -> impl Iterator<Item = Group<L>> {
    use crate::numbers::Coordinates as _;
    let dimension = <Group<L> as LieGroup>::DIMENSION;
    let turned = (0..dimension).map(|k| L::Retraction::retract(&(Vector::<L>::axis(k) * 0.7)));
    core::iter::once(Group::<L>::identity()).chain(turned)
}

fn seen<L: Effect<Scalar = f64>>(scene: &L) -> Vec<Seen> {
    let look = |place| {
        let w = scene.advected().seen_from(&place);
        let mut bias = Vec::new();
        crate::numbers::Entries::each(&scene.momentum_bias(&w), &mut |entry| bias.push(entry));
        Seen { potential: scene.potential(&w), bias }
    };
    places::<L>().map(look).collect()
}

/// The largest difference.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
