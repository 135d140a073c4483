//! Derivatives of motions: the tangent map of a step, its transpose, and applications of both.
//!
//! | derivative | item |
//! |---|---|
//! | the derivatives of the end of a motion by its start and by some parameters | [`Linearisation::step`] with a [`Tangent`] |
//! | the state transition matrix | [`Tangent::transition`] |
//! | the derivatives of the end of a step by its beginning and by a control force, or by prescribed values | [`Linearisation::transition`] |
//! | the gradient of a scalar by the start and by all parameters | [`Linearisation::adjoint`], [`Linearisation::backwards`] |
//! | the same with inputs of the steps, and the derivatives by them | [`Linearisation::adjoint_given`] |
//! | Lyapunov exponents | [`Linearisation::lyapunov_exponents`] |
//!
//! The word `gradients` in a declaration adds them; the effects of the library have it, except for the bodies of fourth
//! and sixth order. A scene without it has no code for derivatives. They work with a scene's own step, on any group and
//! with forces, with compositions, and with splittings, processed ones too, whose flow is declared or exact.
//! `cargo bench -p liestep-benches -- gradients` has the costs. In a splitting whose symmetric body turns about its
//! axis once a step, a step with derivatives makes its drifts twice. One of a processed splitting makes both ends of
//! the processor, as the derivatives are those of the processed state; the adjoint makes an end for the cost of a state, unless the cost
//! is zero.
//!
//! A [`Multibody`](crate::methods::Multibody) system with joints and a [`Chain`](crate::methods::Chain) have no
//! derivatives of their steps: take differences of two motions, or declare the bodies together on a product of groups,
//! with springs in the place of joints. [The chapter](crate::guide::gradients) has how.
//!
//! # Coordinates
//!
//! A state is `(g, μ)`; in the body frame the advected parameters are `w = g⁻¹·a_0`. A change of the state is
//! `(ζ, δμ)`, with `g ← g exp ζ̂` and the components of the momentum, so that
//!
//! ```text
//! δw = −ζ·w + g⁻¹·δa_0
//! ```
//!
//! On SO(3) `ζ` is a small turn in the body's axes, in rad. The derivative of a scalar is a [`Cotangent`]: a covector,
//! and an element of the algebra.
//!
//! # The tangent map of a step
//!
//! A step solves (2.7), `μ = μ(F, w; θ)`, and ends with (2.6), `μ⁺ = μ⁺(F, w; θ)`, and (2.10), `g⁺ = g F`. With the
//! turn `ε` of the increment, `δF = ε̂ F`,
//!
//! ```text
//! A ε = δμ − ∂_ζμ ζ − ∂_θμ δθ            A = ∂_εμ, the exact Newton Jacobian
//! ζ⁺  = Ad_{F⁻¹}(ζ + ε)
//! δμ⁺ = ∂_εμ⁺ ε + ∂_ζμ⁺ ζ + ∂_θμ⁺ δθ
//! ```
//!
//! where `∂_ζ` is along `δw = −ζ·w` at fixed `F`. The blocks are [second derivatives](SecondDerivatives) of `l_d`,
//! which the macro derives from the momenta. They add in a sum. No division by `h` is cancelled later: for (3.13)
//! `A = (tr(F J_d) I − F J_d)/h`, and the potential is in `∂_ζ` alone.
//!
//! For an exact flow, whose turn is a known function of the momentum, the first line is `ε = ∂_με δμ + ∂_θε δθ`: for a
//! symmetric body in closed form, for any other by dual numbers through its closed form. The adjoint differentiates
//! that form in reverse.
//!
//! A kick in the time `t`, with the share `s` of the force gradient, is `δμ⁺ = δμ + t D_ζ τ + s δf`, where `f` is the torque
//! of `−½ τ·J⁻¹τ`. With the derivative `D_v τ` of the torque along a velocity,
//!
//! ```text
//! ⟨v, f⟩ = ⟨u, D_v τ⟩             J u = τ
//! δ⟨v, f⟩ = ⟨u, δD_v τ⟩ + ⟨r, δτ − δJ u⟩             J r = D_v τ
//! ```
//!
//! at fixed `u`, `v` and `r`: by the attitude, by the parameters and by those of the inertia.
//! [`kick_gradient`](SecondDerivatives::kick_gradient) returns that, and it adds in a sum though `f` doesn't. The
//! columns of the tangent map need it for each axis `v`, the adjoint once.
//!
//! # The adjoint
//!
//! If a scalar has the derivative `(z, p)` at the end of a step, it has `(ζ*, u)` at the beginning:
//!
//! ```text
//! Aᵀ u = Ad*_{F⁻¹} z + ∂_εμ⁺ᵀ p
//! ζ*   = Ad*_{F⁻¹} z + ∂_ζμ⁺ᵀ p − ∂_ζμᵀ u
//! θ*   = p·∂_θμ⁺ − u·∂_θμ                  added up over the steps
//! ```
//!
//! One solve gives the derivatives by all parameters at once. It needs `F`, `w` and `g` of each step, from the last to
//! the first: a [`Tape`] stores them, all or by checkpoints, and a self-adjoint scene recomputes them by steps of `−h`.
//!
//! # Symplecticity
//!
//! The transition matrix `Φ` of a scene without forces is symplectic, `ω(Φx, Φy) = ω(x, y)` for the form
//!
//! ```text
//! ω((ζ, δμ), (ζ', δμ')) = ⟨δμ', ζ⟩ − ⟨δμ, ζ'⟩ + ⟨μ, [ζ, ζ']⟩
//! ```
//!
//! at the momentum of each end, to rounding at any step: it is the derivative of a symplectic map. So exponents come in
//! pairs `±λ`.
//!
//! # Traps
//!
//! - In chaos derivatives grow like the deviations: after `10/λ` they say nothing about a motion that isn't known to
//!   `e⁻¹⁰`.
//! - Gradients are at a fixed initial momentum. If that is `JΩ_0`, it depends on `J` and `Ω_0`, and the caller has to
//!   add that derivative: `⟨p_0, δJ Ω_0⟩` of the gradient's `p_0`.
//! - A number in several terms, for example the inertia of two, is a parameter of each; the derivatives add.

mod adjoint;
mod exponents;
mod input;
mod plant;
mod recording;
mod stage;
mod tangent;

pub use adjoint::{Backwards, Gradient, Tape};
pub use input::{Input, InputOf, Transition};
pub use plant::{Both, Plant};
pub use recording::{Change, ChangeOf};
pub use stage::{Cotangent, FlowDerivatives, Pass, Stage};
pub(crate) use stage::{ForceGradient, add_shares};
pub use tangent::{Tangent, TangentOf};

use alloc::vec::Vec;
use core::cell::RefCell;
use core::ops::Range;

use crate::error::{SetupError, StepError};
use crate::mechanics::{Effect, Group, Scalar, SceneVisitor, SecondDerivatives};
use crate::motion::{MotionOf, OwnStep, Plan, StateOf, Steerable, StepReport, Stepper, Summation, explained};
use crate::numbers::{Kernel, Vectors, dispatch};
use recording::Recording;

/// A plan whose steps can be differentiated: some of the library's own plans.
///
/// Other crates can't implement it, as only the library makes a [`Stage`].
#[diagnostic::on_unimplemented(
    message = "the derivatives of a step of `{Self}` aren't known",
    label = "not with this method",
    note = "known are those of a scene's own step, of compositions, and of splittings, processed ones too, whose flow is exact or declared with `gradients`; those of bodies in joints and of chains are differences of two motions"
)]
pub trait Linearisable<S: SecondDerivatives>: Steerable<S> {
    /// Constants of the stages, computed once for each [`Linearisation`]: the lengths of a splitting's stages, and the
    /// common parts of the derivatives of an exact motion.
    type Table: Clone + core::fmt::Debug;

    /// Computes these constants.
    fn table(&self) -> Self::Table;

    /// The constants of the stages that a step of `−h` undoes, by the same numbers.
    ///
    /// The lengths of most plans are odd in `h`: stage `i` of a step of `−h` has minus the length of stage `i` of one
    /// of `h`, and undoes it. A plan with other lengths, as a processed splitting, overrides this.
    fn table_undone(&self) -> Self::Table {
        self.table()
    }

    /// Number of the scalars in the parameters: those of the scene, followed by those of the plan's other flows.
    fn parameters(&self) -> usize {
        S::PARAMETERS
    }

    /// Passes the parameters to the visitor.
    fn describe_parameters(&self, scene: &S, visitor: &mut dyn SceneVisitor<Scalar<S>>) {
        scene.describe(visitor);
    }

    /// Checks that all stages have known derivatives.
    ///
    /// # Errors
    ///
    /// [`SetupError::NoSecondDerivatives`] if a stage has none.
    fn check_stages(&self, _scene: &S) -> Result<(), SetupError> {
        Ok(())
    }

    /// Number of changes in a step, including those of a processor at both of its ends.
    fn stages(&self) -> usize;

    /// Number of the processor's changes at the beginning of a step; as many are at its end, which the beginning of the
    /// next step undoes.
    fn ends(&self) -> usize {
        0
    }

    /// Makes a step whose changes are recorded: those that [`stages`](Self::stages) counts, in this order; those of a
    /// processor only at the ends that `ends` requests. The first step of a run has to request its beginning.
    ///
    /// # Errors
    ///
    /// The errors of [`Plan::step`].
    #[hot]
    fn record<M: Summation<Group<S>, S::Advected>>(
        &self,
        scene: &S,
        motion: &mut M,
        kept: &mut Self::Kept,
        _ends: [bool; 2],
    ) -> Result<StepReport, StepError> {
        self.step(scene, motion, kept)
    }

    /// The motion at which the processor's end of the last step began, inside of the processor.
    fn before_end(&self, read: &MotionOf<S>, _kept: &Self::Kept) -> MotionOf<S> {
        *read
    }

    /// Makes the processor's changes at the end of a step, from that motion.
    ///
    /// # Errors
    ///
    /// The errors of [`Plan::step`].
    fn make_end<M: Summation<Group<S>, S::Advected>>(&self, _motion: &mut M) -> Result<(), StepError> {
        Ok(())
    }

    /// Passes the stage that has made the change of this number to a pass.
    fn visit(&self, stages: (&S, &Self::Table), event: (usize, &ChangeOf<S>), pass: &mut impl Pass<Group<S>>);
}

impl<S: SecondDerivatives> Linearisable<S> for OwnStep<S> {
    type Table = ();

    fn table(&self) {}

    fn stages(&self) -> usize {
        1
    }

    #[hot]
    fn visit(&self, (scene, ()): (&S, &()), (_, event): (usize, &ChangeOf<S>), pass: &mut impl Pass<Group<S>>) {
        pass.stage(&Stage::step(scene, self.step_size(), event, event.before.advected));
    }
}

/// A stepper with the derivatives of its steps, by [`Stepper::linearised`].
#[derive(Clone, Debug)]
pub struct Linearisation<'a, S: SecondDerivatives, P: Linearisable<S>> {
    stepper: &'a Stepper<S, P>,
    table: P::Table,
}

/// One scalar of the parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter<T> {
    /// The number of the term in the sum, from the left.
    pub term: usize,
    /// The field with this scalar.
    pub field: &'static str,
    /// The value of the scalar.
    pub value: T,
}

/// # Wrap: derivatives
impl<S: Effect, P: Plan<S>> Stepper<S, P> {
    /// The derivatives of the steps by the start and by every parameter.
    ///
    /// The word `gradients` in a scene's declaration adds them; the effects of the library have it.
    ///
    /// # Errors
    ///
    /// [`SetupError::NoSecondDerivatives`] for a splitting with force gradients, if a term's derivatives were written
    /// by hand without [`kick_gradient`](SecondDerivatives::kick_gradient).
    pub fn linearised(&self) -> Result<Linearisation<'_, S, P>, SetupError>
    where
        S: SecondDerivatives,
        P: Linearisable<S>,
    {
        self.plan.check_stages(&self.scene)?;
        Ok(Linearisation { stepper: self, table: self.plan.table() })
    }
}

impl<'a, S: SecondDerivatives, P: Linearisable<S>> Linearisation<'a, S, P> {
    /// The stepper.
    #[must_use]
    pub fn stepper(&self) -> &'a Stepper<S, P> {
        self.stepper
    }

    /// The parameters, scalar by scalar: term after term, field after field, matrices row by row. A diagonal or symmetric
    /// matrix has all of its entries.
    #[must_use]
    pub fn parameters(&self) -> Vec<Parameter<Scalar<S>>> {
        struct All<T>(usize, Vec<Parameter<T>>);
        impl<T> SceneVisitor<T> for All<T> {
            fn term(&mut self, _: &'static str) {
                self.0 += 1;
            }

            fn parameter(&mut self, field: &'static str, value: T) {
                self.1.push(Parameter { term: self.0.saturating_sub(1), field, value });
            }
        }
        let mut all = All(0, Vec::new());
        self.stepper.plan.describe_parameters(&self.stepper.scene, &mut all);
        all.1
    }

    /// The numbers of a field's scalars among the parameters; `None` if the term has no such field.
    #[must_use]
    pub fn numbers(&self, term: usize, field: &str) -> Option<Range<usize>> {
        let parameters = self.parameters();
        let is_its = |parameter: &Parameter<Scalar<S>>| parameter.term == term && parameter.field == field;
        let start = parameters.iter().position(is_its)?;
        let end = parameters.iter().rposition(is_its)?;
        Some(start..end + 1)
    }

    /// The identity as the tangent map before the first [`step`](Self::step), with columns for the numbered parameters.
    ///
    /// # Panics
    ///
    /// If there is no parameter of a number.
    #[must_use]
    pub fn tangent(&self, parameters: &[usize]) -> TangentOf<S> {
        let count = self.stepper.plan.parameters();
        assert!(parameters.iter().all(|&number| number < count), "there are {count} parameters, numbered from 0");
        Tangent::new([count, 0], parameters)
    }

    /// One step, and its tangent map applied to the derivatives. On an error both are unchanged.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::step`], and [`StepError::NonFinite`] if a derivative overflows, as it does in chaos.
    ///
    /// # Panics
    ///
    /// If the tangent has columns for the parameters of another plan, which has more of them or fewer.
    pub fn step(&self, state: &mut StateOf<S, P>, tangent: &mut TangentOf<S>) -> Result<StepReport, StepError> {
        self.step_given(state, &Input::Free, tangent)
    }
}

impl<S: SecondDerivatives, P: Linearisable<S>> Stepper<S, P> {
    /// One step, whose stages are recorded.
    fn recorded(
        &self,
        state: &mut StateOf<S, P>,
        events: &RefCell<Vec<ChangeOf<S>>>,
        ends: [bool; 2],
    ) -> Result<StepReport, StepError> {
        dispatch(StepRecord { stepper: self, state, events, ends })
    }
}

/// A step whose stages are recorded, compiled once for all derivatives and inputs, as it is inlined where it is called.
struct StepRecord<'a, S: SecondDerivatives, P: Linearisable<S>> {
    stepper: &'a Stepper<S, P>,
    state: &'a mut StateOf<S, P>,
    events: &'a RefCell<Vec<ChangeOf<S>>>,
    ends: [bool; 2],
}

impl<S: SecondDerivatives, P: Linearisable<S>> Kernel for StepRecord<'_, S, P> {
    type Output = Result<StepReport, StepError>;

    /// The registers of a step without a record.
    const VECTORS: Vectors = P::FACTS.vectors;
    const IS_IN_LANES: bool = <Scalar<S> as nalgebra::SimdValue>::LANES > 1;

    #[hot]
    fn run(self) -> Self::Output {
        let Self { stepper: Stepper { scene, plan }, state, events, ends } = self;
        let mut recorded = Recording { motion: state.motion, events };
        match plan.record(scene, &mut recorded, &mut state.kept, ends) {
            Ok(report) => {
                state.motion = recorded.motion;
                Ok(report)
            }
            Err(error) if P::FACTS.explains => Err(explained(plan, error, (scene, &state.motion, &state.kept))),
            Err(error) => Err(error),
        }
    }
}

/// A tangent that the stages of a step transform.
struct Carry<'a, 'l, S: SecondDerivatives, P: Linearisable<S>> {
    linearised: &'a Linearisation<'l, S, P>,
    tangent: &'a mut TangentOf<S>,
}

impl<S: SecondDerivatives, P: Linearisable<S>> Kernel for Carry<'_, '_, S, P> {
    type Output = ();

    /// The columns fill registers of four.
    const VECTORS: Vectors = Vectors::Four;
    const IS_IN_LANES: bool = <Scalar<S> as nalgebra::SimdValue>::LANES > 1;

    #[hot]
    fn run(self) {
        let Self { linearised: Linearisation { stepper: Stepper { scene, plan }, table }, tangent } = self;
        let events = tangent.events.take();
        for (index, event) in events.iter().enumerate() {
            plan.visit((scene, table), (index, event), tangent);
        }
        tangent.events.replace(events);
    }
}
