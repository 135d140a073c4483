//! The methods to choose from.

use super::error::AccuracyError;
use super::ladder::Start;
use super::method::Method;
use super::search::search;
use super::{Accuracy, AccurateStepper, Choice};
use crate::error::SetupError;
use crate::groups::{Advected, LieGroup, Retraction as _, SO3};
use crate::mechanics::{DiagonalNonstandardInertia, DiscreteLagrangian, Effect, Group, Regular, Scalar, Vector};
use crate::methods::{
    Composition, CompositionScheme, Gauss, KineticFlow, PreprocessedBody, PreprocessedOrder, Splitting,
    SplittingScheme, has_force_gradient,
};
use crate::motion::Stepper;

/// A method, to be made for a step.
pub(super) struct Candidate<G: LieGroup, A: Advected<G>> {
    pub(super) name: String,
    pub(super) order: u32,
    /// Solves or flows in a step.
    pub(super) stages: u32,
    /// Operations that a step makes at least.
    pub(super) least: f64,
    pub(super) make: Make<G, A>,
}

type Make<G, A> = Box<dyn Fn(f64) -> Result<Box<dyn Method<G, A>>, SetupError>>;

/// The methods that [`Stepper::for_accuracy`] chooses from, with more than a scene alone can tell.
///
/// Every self-adjoint scene has its own step and its symmetric compositions. Added to them are splittings, where the
/// potential can be split off and the free body's motion is known; Gauss collocation, where it can be split off; other
/// declarations of the same scene, of higher order; and for a free body the preprocessed step.
///
/// # Examples
///
/// ```
/// use liestep::effects::{Gravity, PrincipalBody};
/// use liestep::{Accuracy, Candidates, DiagonalNonstandardInertia, LieGroup, NonstandardInertia, SO3, SymmetricBody};
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
    methods: Vec<Candidate<G, A>>,
    /// Of the first scene: what others must agree with.
    inertia: Vec<f64>,
    seen: Vec<Seen>,
    mistake: Option<SetupError>,
}

impl<G: LieGroup<Scalar = f64>, A: Advected<G> + 'static> Candidates<G, A> {
    /// The step of a scene that is a method of this order (2, if its terms are those of [`effects`](crate::effects)),
    /// and its symmetric compositions.
    ///
    /// A scene that isn't self-adjoint is refused when the user's crate is built, as by [`Composition::new`].
    #[must_use]
    #[allow(clippy::needless_pass_by_value)] // as `Stepper::new`
    pub fn of<L>(scene: L, order: u32) -> Self
    where
        L: DiscreteLagrangian<Scalar = f64, Group = G, Advected = A> + Regular + Clone + 'static,
    {
        let empty = Self { methods: Vec::new(), inertia: inertia(&scene), seen: seen(&scene), mistake: None };
        empty.and_steps_of("", &scene, order)
    }

    /// The step of another declaration of the same scene, of this order, and its symmetric compositions.
    #[must_use]
    #[allow(clippy::needless_pass_by_value)] // as `of`
    pub fn and_declared<L>(mut self, name: &str, scene: L, order: u32) -> Self
    where
        L: DiscreteLagrangian<Scalar = f64, Group = G, Advected = A> + Regular + Clone + 'static,
    {
        self.compare(&scene);
        self.and_steps_of(&format!("{name}, "), &scene, order)
    }

    fn and_steps_of<L>(mut self, prefix: &str, scene: &L, order: u32) -> Self
    where
        L: DiscreteLagrangian<Scalar = f64, Group = G, Advected = A> + Regular + Clone + 'static,
    {
        let solve = super::method::least(L::OPERATIONS);
        let alone = scene.clone();
        self.methods.push(Candidate {
            name: format!("{prefix}its own step"),
            order,
            stages: 1,
            least: solve,
            make: Box::new(move |h| Ok(Box::new(Stepper::new(alone.clone(), h)?))),
        });
        for scheme in CompositionScheme::ALL.into_iter().filter(|scheme| scheme.base() == order) {
            let (scene, stages) = (scene.clone(), count(scheme.stages().count()));
            self.methods.push(Candidate {
                name: format!("{prefix}{}", scheme.name()),
                order: scheme.order(),
                stages,
                least: f64::from(stages) * solve,
                make: Box::new(move |h| Ok(Box::new(Composition::new(scene.clone(), h, scheme)?))),
            });
        }
        self
    }

    fn compare<L>(&mut self, scene: &L)
    where
        L: Effect<Scalar = f64, Group = G, Advected = A>,
    {
        let size = self.inertia.iter().map(|entry| entry.abs()).sum::<f64>();
        let difference = apart(&self.inertia, &inertia(scene));
        if difference > SAME * size {
            self.mistake.get_or_insert(SetupError::AnotherInertia { difference });
        }
        let seen = seen(scene);
        // A potential is given but for a constant.
        let potentials = |places: &[Seen]| places.iter().map(|place| place.potential - places[0].potential).collect();
        let (own, other): (Vec<_>, Vec<_>) = (potentials(&self.seen), potentials(&seen));
        let largest = self.seen.iter().chain(&seen).map(|place| place.potential.abs()).fold(0.0, f64::max);
        if apart(&own, &other) > SAME * largest {
            self.mistake.get_or_insert(SetupError::AnotherPotential);
        }
        for (own, other) in self.seen.iter().zip(&seen) {
            let largest = own.bias.iter().chain(&other.bias).map(|entry| entry.abs()).fold(0.0, f64::max);
            if apart(&own.bias, &other.bias) > SAME * largest {
                self.mistake.get_or_insert(SetupError::AnotherBias);
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
        for candidate in &self.methods {
            let method = (candidate.make)(accuracy.horizon / 1024.0)?;
            method.start(start.attitude, start.velocity)?;
        }
        let found = search(&self.methods, accuracy, &start)?;
        let method = (self.methods[found.run.index].make)(accuracy.horizon / found.run.steps)?;
        let state = method.start(start.attitude, start.velocity)?;
        let choice = Choice::new(&self.methods, accuracy, &found);
        Ok(AccurateStepper { method, start: state, choice })
    }
}

impl<A: Advected<SO3> + 'static> Candidates<SO3, A> {
    /// The kinetic-potential splittings of a declaration of the same scene, with this flow of its body.
    #[must_use]
    #[allow(clippy::needless_pass_by_value)] // as `Splitting::new`
    pub fn and_splittings<L, K>(mut self, name: &str, scene: L, kinetic: K) -> Self
    where
        L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = A> + Regular + Clone + 'static,
        K: KineticFlow<f64> + Clone + 'static,
    {
        self.compare(&scene);
        let has_gradient = has_force_gradient(&scene);
        for scheme in SplittingScheme::ALL.into_iter().filter(|scheme| has_gradient || !scheme.has_gradients()) {
            let (scene, kinetic, stages) = (scene.clone(), kinetic.clone(), count(scheme.drifts()));
            self.methods.push(Candidate {
                name: format!("{name}, {}", scheme.name()),
                order: scheme.order(),
                stages,
                least: f64::from(stages) * super::method::least_of_a_drift::<K>(),
                make: Box::new(move |h| Ok(Box::new(Splitting::new(scene.clone(), kinetic.clone(), h, scheme)?))),
            });
        }
        self
    }

    /// [`Gauss`] collocation with 4 and 8 stages of a declaration of the same scene; any will do, as only inertia and
    /// potential matter. Six stages don't fill the machine's vectors, and take longer than eight.
    #[must_use]
    #[allow(clippy::needless_pass_by_value)] // as `Gauss::new`
    pub fn and_gauss<L>(mut self, scene: L) -> Self
    where
        L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = A> + Regular + Clone + 'static,
    {
        self.compare(&scene);
        self.methods.extend([collocation::<L, 2>(&scene), collocation::<L, 4>(&scene)]);
        self
    }
}

fn collocation<L, const PAIRS: usize>(scene: &L) -> Candidate<SO3, L::Advected>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected: 'static> + Regular + Clone + 'static,
{
    let (scene, stages) = (scene.clone(), count(2 * PAIRS));
    Candidate {
        name: format!("Gauss, {stages} stages"),
        order: 2 * stages,
        stages,
        least: super::method::least_of_collocation::<L, PAIRS>(),
        make: Box::new(move |h| Ok(Box::new(Gauss::<L, PAIRS>::new(scene.clone(), h)?))),
    }
}

impl Candidates<SO3, ()> {
    /// The [`PreprocessedBody`] with this inertia, to all its orders.
    #[must_use]
    pub fn and_preprocessed(mut self, body: DiagonalNonstandardInertia) -> Self {
        use PreprocessedOrder::{Eight, Four, Six, Ten};
        self.compare(&crate::effects::PrincipalBody { J_d: body });
        for (order, number) in [(Four, 4), (Six, 6), (Eight, 8), (Ten, 10)] {
            self.methods.push(Candidate {
                name: format!("preprocessed, {number}"),
                order: number,
                stages: 1,
                least: super::method::least(<crate::methods::PreprocessedFlow as KineticFlow<f64>>::OPERATIONS),
                make: Box::new(move |h| Ok(Box::new(PreprocessedBody::new(body, h, order)?))),
            });
        }
        self
    }
}

fn count(stages: usize) -> u32 {
    u32::try_from(stages).unwrap_or(u32::MAX)
}

fn inertia<L: Effect<Scalar = f64>>(scene: &L) -> Vec<f64> {
    let mut entries = Vec::new();
    for k in 0..<Group<L> as LieGroup>::DIMENSION {
        let column: Vector<L> = scene.inertia() * <Vector<L> as crate::numbers::Coordinates<Scalar<L>>>::axis(k);
        crate::numbers::Entries::each(&column, &mut |entry| entries.push(entry));
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

/// At places enough to tell the potentials of a body apart.
fn seen<L: Effect<Scalar = f64>>(scene: &L) -> Vec<Seen> {
    use crate::numbers::Coordinates as _;
    let dimension = <Group<L> as LieGroup>::DIMENSION;
    let turned = (0..dimension).map(|k| L::Retraction::retract(&(Vector::<L>::axis(k) * 0.7)));
    let places = core::iter::once(Group::<L>::identity()).chain(turned);
    let look = |place| {
        let w = scene.advected().seen_from(&place);
        let mut bias = Vec::new();
        crate::numbers::Entries::each(&scene.momentum_bias(&w), &mut |entry| bias.push(entry));
        Seen { potential: scene.potential(&w), bias }
    };
    places.map(look).collect()
}

/// The largest difference.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
