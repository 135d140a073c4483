//! The methods among which an accuracy chooses.

use alloc::borrow::ToOwned as _;
use alloc::boxed::Box;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::error::SetupError;
use crate::groups::{Advected, LieGroup, MatrixGroup, SO3};
use crate::mechanics::{Inertia, Scene};
use crate::methods::{
    CompositionScheme, ExactBody, KineticFlow, ProcessedScheme, SplittingScheme, SymmetricBody, has_force_gradient,
};
use crate::motion::{AnyStepper, Plan, Stepper};

/// A method as a constructor from a step.
pub(super) struct Method<G: LieGroup, A> {
    pub(super) name: String,
    pub(super) order: u32,
    /// Whether the method has no error but rounding.
    pub(super) is_exact: bool,
    pub(super) make: Make<G, A>,
}

type Make<G, A> = Box<dyn Fn(f64) -> Result<AnyStepper<G, A>, SetupError>>;

/// The methods for a scene.
pub struct Methods<G: LieGroup, A>(pub(super) Vec<Method<G, A>>);

/// A group whose scenes have a choice by accuracy. It names methods besides their own step and its compositions.
///
/// On SO(3) these are splittings, processed ones, collocation and the exact motion, as far as a scene admits them. A
/// group of another crate needs a line: `impl<S: Scene<Scalar = f64, Group = Self>> Steppable<S> for MyGroup {}`.
#[diagnostic::on_unimplemented(
    message = "scenes on `{Self}` can't be asked for an accuracy",
    note = "`impl<S: Scene<Scalar = f64, Group = Self>> Steppable<S> for` the group lets its scenes be asked"
)]
pub trait Steppable<S: Scene<Scalar = f64, Group = Self>>: LieGroup<Scalar = f64> {
    /// Adds the methods for the scene.
    fn add_methods(_scene: &S, _methods: &mut Methods<Self, S::Advected>) {}
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
    fn add_methods(scene: &S, methods: &mut Methods<Self, S::Advected>) {
        // These methods need a physical, constant inertia and a separable Lagrangian.
        let Ok(inertia) = Inertia::new(scene.inertia(&scene.advected())) else { return };
        let body = ExactBody::new(&inertia);
        if Stepper::split(scene.clone(), 1.0, body, SplittingScheme::STRANG).is_err() {
            return;
        }
        match SymmetricBody::new(&inertia) {
            Ok(symmetric) => methods.add_splittings(scene, &symmetric),
            Err(_) => methods.add_splittings(scene, &body),
        }
        // Six stages don't fill the machine's vectors, and take longer than eight.
        methods.add("Gauss, 4 stages".to_owned(), 8, scene, Stepper::collocated::<2>);
        methods.add("Gauss, 8 stages".to_owned(), 16, scene, Stepper::collocated::<4>);
    }
}

impl<G: LieGroup<Scalar = f64>, A: Advected<G> + 'static> Methods<G, A> {
    /// The scene's own step, which is assumed to be of order 2, its symmetric compositions, and the methods of its
    /// group.
    pub(super) fn of<S>(scene: &S) -> Self
    where
        S: Scene<Scalar = f64, Group = G, Advected = A>,
        G: Steppable<S>,
    {
        let mut methods = Self(Vec::new());
        methods.add("its own step".to_owned(), 2, scene, Stepper::new);
        for scheme in CompositionScheme::ALL.into_iter().filter(|scheme| scheme.base() == 2) {
            let make = move |scene, h| Stepper::composed(scene, h, scheme);
            methods.add(scheme.name().to_owned(), scheme.order(), scene, make);
        }
        G::add_methods(scene, &mut methods);
        methods
    }

    fn add<S, P>(
        &mut self,
        name: String,
        order: u32,
        scene: &S,
        make: impl Fn(S, f64) -> Result<Stepper<S, P>, SetupError> + 'static,
    ) where
        S: Scene<Scalar = f64, Group = G, Advected = A>,
        P: Plan<S, Kept: 'static> + 'static,
    {
        let scene = scene.clone();
        let make = Box::new(move |h| make(scene.clone(), h).map(Stepper::into_any));
        self.0.push(Method { name, order, is_exact: false, make });
    }
}

impl<A: Advected<SO3> + 'static> Methods<SO3, A> {
    /// Adds splittings, processed ones among them, with this flow of the body; for a free body that flow alone.
    fn add_splittings<S, K>(&mut self, scene: &S, flow: &K)
    where
        S: Scene<Scalar = f64, Group = SO3, Advected = A>,
        K: KineticFlow<f64> + 'static,
    {
        let split = |scheme: SplittingScheme| {
            let flow = flow.clone();
            move |scene, h| Stepper::split(scene, h, flow.clone(), scheme)
        };
        // There are no kicks: any splitting is the flow, and this one makes it once a step.
        if !S::parts(&scene.constants(1.0)).kick_before {
            self.add("exact".to_owned(), SplittingScheme::STRANG.order(), scene, split(SplittingScheme::STRANG));
            if let Some(method) = self.0.last_mut() {
                method.is_exact = true;
            }
            return;
        }
        let has_gradient = has_force_gradient(scene);
        for scheme in SplittingScheme::ALL.into_iter().filter(|scheme| has_gradient || !scheme.has_gradients()) {
            self.add(format!("exact, {}", scheme.name()), scheme.order(), scene, split(scheme));
        }
        for scheme in ProcessedScheme::ALL.into_iter().filter(|_| has_gradient) {
            let flow = flow.clone();
            let make = move |scene, h| Stepper::processed(scene, h, flow.clone(), scheme);
            self.add(format!("exact, {}", scheme.name()), scheme.order(), scene, make);
        }
    }
}
