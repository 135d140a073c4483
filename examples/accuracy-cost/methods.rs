//! The library's methods and others, with one interface to run them.

use declarations::motions::End;
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::methods::{CompositionScheme, ExactBody, KineticFlow, ProcessedScheme, SplittingScheme, SymmetricBody};
use liestep::motion::Plan;
use liestep::prelude::*;
use workbench::top_equations::rk4_step;

use crate::rivals::dop853::Dop853;
use crate::rivals::embedded::{self, EmbeddedMethod};
use crate::rivals::rates::Rates;
use crate::rivals::tsitouras::Tsitouras5;
use crate::rivals::verner::Verner9;
use crate::scenes::{Kind, Scene};

/// A prepared run, from its start to its end each time it is called; `None` if a step failed.
pub type PreparedRun = Box<dyn Fn() -> Option<End>>;

/// Prepares the run of a scene over a time with a step or a tolerance. Everything independent of the state is computed
/// here.
type Prepare = Box<dyn Fn(&Scene, f64, f64) -> Option<PreparedRun>>;

/// A method of integration.
pub struct Method {
    pub name: String,
    pub family: Family,
    control: Control,
    pub prepare: Prepare,
}

/// The family of a method, by the structure that it preserves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Methods that conserve the Poisson structure and the momentum maps.
    Poisson,
    /// No structure: an explicit Runge–Kutta method.
    Rival,
}

/// The parameter that is varied.
#[derive(Clone, Copy)]
enum Control {
    /// Steps of equal length, with this longest step, s.
    Step(f64),
    /// A tolerance, for an error that falls by this power of the step.
    Tolerance(i32),
}

impl Method {
    fn new(
        name: impl Into<String>,
        family: Family,
        control: Control,
        prepare: impl Fn(&Scene, f64, f64) -> Option<PreparedRun> + 'static,
    ) -> Self {
        Self { name: name.into(), family, control, prepare: Box::new(prepare) }
    }

    /// Whether the varied parameter is the length of equal steps.
    pub fn steps_are_equal(&self) -> bool {
        matches!(self.control, Control::Step(_))
    }

    /// Steps that divide the time, each shorter than the one before by the ratio; or tolerances.
    pub fn parameters(&self, t: f64, ratio: f64) -> impl Iterator<Item = f64> + use<> {
        let (first, next, last) = match self.control {
            Control::Step(longest) => (longest, 1.0 / ratio, 1e-5),
            // At a tolerance of one a diverged motion would be accepted, with ever shorter steps.
            Control::Tolerance(power) => (0.1, ratio.powi(-power), 1e-15),
        };
        let whole = self.steps_are_equal();
        core::iter::successors(Some(first), move |parameter| Some(parameter * next))
            .take_while(move |parameter| *parameter > last)
            .map(move |parameter| if whole { t / (t / parameter).ceil() } else { parameter })
    }
}

/// The number of steps in a time.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // the step divides the time
fn count(t: f64, h: f64) -> u64 {
    (t / h).round() as u64
}

/// All methods that apply to a scene.
pub fn all(scene: &Scene) -> Vec<Method> {
    let rivals = match scene.kind {
        Kind::Sprung => rivals(Scene::sprung_equations),
        Kind::Satellite => rivals(Scene::satellite_equations),
        _ => rivals(Scene::equations),
    };
    ours(scene).into_iter().chain(rivals).collect()
}

/// The methods of these that preserve the structure.
pub fn ours(scene: &Scene) -> Vec<Method> {
    let exact = |scene: &Scene| Some(ExactBody::new(&scene.inertia()));
    let tops = || {
        let of_orders = [declared("L4", Scene::fourth_order_top, 4), declared("L6", Scene::sixth_order_top, 6)];
        declared("(3.13)", Scene::top, 2).into_iter().chain(of_orders.into_iter().flatten()).collect()
    };
    let kinds = match scene.kind {
        Kind::SymmetricTop => {
            let symmetric = |scene: &Scene| SymmetricBody::new(&scene.inertia()).ok();
            vec![tops(), splittings("exact", Scene::top, symmetric), gauss(Scene::top)]
        }
        Kind::Top => {
            let declared = splittings("K6", Scene::top, |scene| Some(scene.sixth_order_body()));
            vec![tops(), splittings("exact", Scene::top, exact), declared, gauss(Scene::top)]
        }
        Kind::Free => vec![
            declared("(3.13)", Scene::free_body, 2),
            declared("K4", Scene::fourth_order_body, 4),
            declared("K6", Scene::sixth_order_body, 6),
            vec![exact_alone()],
            gauss(Scene::free_body),
        ],
        // These potentials are declared only with (3.13).
        Kind::Sprung => {
            vec![declared("(3.13)", Scene::sprung, 2), splittings("exact", Scene::sprung, exact), gauss(Scene::sprung)]
        }
        Kind::Satellite => vec![
            declared("(3.13)", Scene::satellite, 2),
            splittings("exact", Scene::satellite, exact),
            gauss(Scene::satellite),
        ],
    };
    kinds.into_iter().flatten().collect()
}

/// Gauss collocation with several numbers of stages.
fn gauss<L>(lagrangian: impl Fn(&Scene) -> L + Copy + 'static) -> Vec<Method>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular + 'static,
{
    vec![
        collocation::<L, 1>(lagrangian),
        collocation::<L, 2>(lagrangian),
        collocation::<L, 3>(lagrangian),
        collocation::<L, 4>(lagrangian),
    ]
}

fn collocation<L, const PAIRS: usize>(lagrangian: impl Fn(&Scene) -> L + 'static) -> Method
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular + 'static,
{
    let name = format!("Gauss, {} stages", 2 * PAIRS);
    stepped(name, 2.0, move |scene, h| Stepper::collocated::<PAIRS>(lagrangian(scene), h).ok())
}

/// The exact motion of the free body: it has no kicks, so every splitting with this flow is exact.
fn exact_alone() -> Method {
    stepped("exact", 100.0, |scene, h| {
        let flow = ExactBody::new(&scene.inertia());
        Stepper::split(scene.free_body(), h, flow, SplittingScheme::STRANG).ok()
    })
}

/// Splittings with a kinetic flow.
fn splittings<L, K>(
    name: &'static str,
    lagrangian: impl Fn(&Scene) -> L + Copy + 'static,
    kinetic: impl Fn(&Scene) -> Option<K> + Copy + 'static,
) -> Vec<Method>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular + 'static,
    K: KineticFlow<f64> + 'static,
{
    let method = |scheme: SplittingScheme| {
        stepped(format!("{name}, {}", scheme.name()), 5.0, move |scene, h| {
            Stepper::split(lagrangian(scene), h, kinetic(scene)?, scheme).ok()
        })
    };
    let processed = |scheme: ProcessedScheme| {
        stepped(format!("{name}, {}", scheme.name()), 5.0, move |scene, h| {
            Stepper::processed(lagrangian(scene), h, kinetic(scene)?, scheme).ok()
        })
    };
    SplittingScheme::ALL.map(method).into_iter().chain(ProcessedScheme::ALL.map(processed)).collect()
}

/// The step of a declared Lagrangian of this order, and its compositions.
fn declared<L>(name: &'static str, lagrangian: impl Fn(&Scene) -> L + Copy + 'static, order: u32) -> Vec<Method>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular + 'static,
{
    let alone = stepped(name, 1.0, move |scene, h| Stepper::new(lagrangian(scene), h).ok());
    let schemes = CompositionScheme::ALL.into_iter().filter(|scheme| scheme.base() == order);
    let composed = schemes.map(|scheme| {
        stepped(format!("{name}, {}", scheme.name()), 1.0, move |scene, h| {
            Stepper::composed(lagrangian(scene), h, scheme).ok()
        })
    });
    core::iter::once(alone).chain(composed).collect()
}

/// A stepper, with steps from the longest on, s.
fn stepped<S, P>(
    name: impl Into<String>,
    longest: f64,
    stepper: impl Fn(&Scene, f64) -> Option<Stepper<S, P>> + 'static,
) -> Method
where
    S: DiscreteLagrangian<Scalar = f64, Group = SO3> + 'static,
    P: Plan<S> + 'static,
{
    Method::new(name, Family::Poisson, Control::Step(longest), move |scene, t, h| {
        let (stepper, steps) = (stepper(scene, h)?, count(t, h));
        let start = stepper.start(scene.motion.attitude, scene.motion.velocity).ok()?;
        Some(Box::new(move || {
            let mut state = start;
            stepper.run(&mut state, steps).ok()?;
            Some((*state.attitude().as_matrix(), stepper.velocity(&state)))
        }))
    })
}

fn rivals<E: Rates>(equations: impl Fn(&Scene) -> E + Copy + 'static) -> Vec<Method> {
    let classical = Method::new("RK4", Family::Rival, Control::Step(0.5), move |scene, t, h| {
        let (equations, start, steps) = (equations(scene), scene.start(), count(t, h));
        Some(Box::new(move || {
            let mut y = start;
            for _ in 0..steps {
                y = rk4_step(|y| equations.rate(y), h, &y);
            }
            Some(equations.end(&y))
        }))
    });
    let mut rivals = vec![classical];
    rivals.extend(embedded::<Tsitouras5, E>(equations));
    rivals.extend(embedded::<Dop853, E>(equations));
    rivals.extend(embedded::<Verner9, E>(equations));
    rivals
}

/// An embedded method, with a fixed step and with its own step control.
fn embedded<M: EmbeddedMethod, E: Rates>(equations: impl Fn(&Scene) -> E + Copy + 'static) -> [Method; 2] {
    [
        Method::new(format!("{}, fixed step", M::NAME), Family::Rival, Control::Step(1.0), move |scene, t, h| {
            let (equations, start, steps) = (equations(scene), scene.start(), count(t, h));
            Some(Box::new(move || {
                let mut y = start;
                for _ in 0..steps {
                    y = embedded::step::<M>(&equations, h, &y);
                }
                Some(equations.end(&y))
            }))
        }),
        Method::new(M::NAME, Family::Rival, Control::Tolerance(M::POWER), move |scene, t, tolerance| {
            let (equations, start) = (equations(scene), scene.start());
            Some(Box::new(move || Some(equations.end(&embedded::integrate::<M>(&equations, t, tolerance, start)?))))
        }),
    ]
}
