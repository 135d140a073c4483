//! The adjoint: the gradient of a scalar by the start and all parameters, from the last step to the first.

use alloc::vec;
use alloc::vec::Vec;
use core::cell::RefCell;
use core::ops::Range;

use crate::error::{SetupError, StepError};
use crate::gradients::input::{Input, InputOf};
use crate::gradients::recording::{Change, ChangeOf, Recording};
use crate::gradients::stage::{Cotangent, FlowDerivatives, Pass, Stage, WayBack};
use crate::gradients::{Linearisable, Linearisation};
use crate::groups::LieGroup;
use crate::mechanics::{DiscreteLagrangian, Effect, Group, Scalar, SecondDerivatives, Vector};
use crate::motion::{MotionOf, StateOf, Stepper};
use crate::numbers::{Coordinates as _, Entries as _, Kernel, Vectors, dispatch, is_finite, real};

/// The storage of the forward run for an adjoint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tape {
    /// Every stage is stored: on SO(3) 200 bytes each.
    All,
    /// Checkpoints: the state at every `√N`th of `N` steps is stored, and the stages between two of them. All steps but
    /// those after the last checkpoint are made twice. The gradient is the same to the bit.
    SquareRoot,
}

/// The gradient of a scalar by a motion's start, and by the parameters at a fixed start.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient<V, T> {
    /// The derivatives by attitude and momentum at the start.
    pub start: Cotangent<V>,
    /// The derivatives by the parameters, in the order of [`Linearisation::parameters`].
    pub parameters: Vec<T>,
}

type GradientOf<S> = Gradient<Vector<S>, Scalar<S>>;

/// The state of the reverse pass.
struct Back<'a, G: LieGroup> {
    cotangent: Cotangent<G::Vector>,
    /// The sums of the derivatives by the parameters.
    gradient: &'a mut [G::Scalar],
    /// The sums of the derivatives by the step's prescribed values; empty for a step without them.
    values: Vec<G::Scalar>,
}

#[hot]
impl<G: LieGroup> Pass<G> for Back<'_, G> {
    fn asks_for_parameters(&self) -> bool {
        true
    }

    fn on_the_way_back(&mut self) -> Option<WayBack<'_, G>> {
        Some((&mut self.cotangent, self.gradient))
    }

    fn stage<E: SecondDerivatives<Scalar = G::Scalar, Group = G>>(&mut self, stage: &Stage<'_, E>) {
        self.cotangent = stage.pull(&self.cotangent, self.gradient, &mut self.values);
    }

    fn flown(&mut self, flown: &FlowDerivatives<'_, G>) {
        self.cotangent = flown.pull(&self.cotangent, self.gradient);
    }
}

impl<G: LieGroup> Back<'_, G> {
    #[hot]
    fn add(&mut self, cotangent: &Cotangent<G::Vector>) {
        let Cotangent { attitude, momentum } = self.cotangent;
        self.cotangent = Cotangent { attitude: attitude + cotangent.attitude, momentum: momentum + cotangent.momentum };
    }
}

/// Data of a run besides the changes by its steps.
struct RunData<'i, S: Effect> {
    steps: u64,
    /// The inputs of the steps; empty if no step has one.
    inputs: &'i [InputOf<S>],
    /// Motions that aren't among the changes: those before the steps of a stretch, if steps have inputs or a processor,
    /// and the last of the run.
    motions: Vec<MotionOf<S>>,
    /// The motion at the beginning of the last step's end.
    before_end: Option<MotionOf<S>>,
    /// Number of a processor's changes at each end of the run; zero for a run with inputs, whose steps include them.
    ends: usize,
}

impl<S: Effect> RunData<'_, S> {
    fn input(&self, n: u64) -> &InputOf<S> {
        usize::try_from(n).ok().and_then(|n| self.inputs.get(n)).unwrap_or(&Input::Free)
    }
}

/// Makes several steps, and records their changes, and the motions that aren't among these.
struct Record<'a, 'i, S: SecondDerivatives, P: Linearisable<S>> {
    linearised: &'a Linearisation<'a, S, P>,
    state: &'a mut StateOf<S, P>,
    steps: Range<u64>,
    given: &'a mut RunData<'i, S>,
    events: &'a RefCell<Vec<ChangeOf<S>>>,
}

impl<S: SecondDerivatives, P: Linearisable<S>> Record<'_, '_, S, P> {
    fn run(self) -> Result<(), StepError> {
        let Self { linearised, state, steps, given, events } = self;
        given.motions.clear();
        for n in steps.clone() {
            if !given.inputs.is_empty() || given.ends > 0 {
                given.motions.push(state.motion);
            }
            let ends = if given.ends > 0 { [n == 0, false] } else { [true; 2] };
            linearised.recorded_given(state, given.input(n), events, ends)?;
        }
        if steps.end == given.steps {
            given.motions.push(state.motion);
            given.before_end = Some(linearised.stepper.plan.before_end(&state.motion, &state.kept));
        }
        Ok(())
    }
}

/// The reverse pass over several steps, with the costs of the states before them, and that of the run's last state.
struct Stretch<'a, 'b, S: SecondDerivatives, P: Linearisable<S>> {
    linearised: &'a Linearisation<'a, S, P>,
    steps: Range<u64>,
    events: &'a [ChangeOf<S>],
    given: &'a RunData<'a, S>,
    /// The derivatives by the inputs, from the last to the first.
    by_inputs: &'a mut Vec<InputOf<S>>,
    back: &'a mut Back<'b, Group<S>>,
    cost: &'a mut CostOf<'b, S>,
}

/// The derivatives of a state's cost, without a type of their own: a pass is compiled once for all costs.
type CostOf<'a, S> = dyn FnMut(u64, &MotionOf<S>) -> Cotangent<Vector<S>> + 'a;

impl<S: SecondDerivatives, P: Linearisable<S>> Stretch<'_, '_, S, P> {
    /// Adds the derivatives by the input of a step, for the half of its length and the momentum's part at its end.
    fn add_inputs(&mut self, n: u64, at_end: Vector<S>, half: Scalar<S>) {
        let (input, mut shares) = (self.given.input(n), self.back.values.iter());
        match input {
            Input::Free if n == self.steps.end || self.given.inputs.is_empty() => {}
            Input::Free => self.by_inputs.push(Input::Free),
            // Half of the impulse comes before the step, and half after it.
            Input::Force(_) => self.by_inputs.push(Input::Force((self.back.cotangent.momentum + at_end) * half)),
            Input::Values(_) => {
                self.by_inputs.push(input.of_scalars(&mut || shares.next().copied().unwrap_or(real(0.0))));
            }
        }
    }
}

impl<S: SecondDerivatives, P: Linearisable<S>> Kernel for Stretch<'_, '_, S, P> {
    type Output = Result<(), StepError>;

    /// AVX is used for its instructions with three operands; no computation acts on four numbers at a time.
    const VECTORS: Vectors = Vectors::Four;
    const IS_IN_LANES: bool = <Scalar<S> as nalgebra::SimdValue>::LANES > 1;

    #[hot]
    fn run(mut self) -> Self::Output {
        let Linearisation { stepper, table } = self.linearised;
        let Stepper { scene, plan } = stepper;
        let (Range { start, end }, ends) = (self.steps.clone(), self.given.ends);
        let (half, stages) = (self.linearised.half_step(), plan.stages() - 2 * ends);
        let mut motions = self.given.motions.iter().rev();
        let (begin, changes) = self.events.split_at(if start == 0 && end > 0 { ends } else { 0 });
        let mut changes = changes.chunks(stages);
        let out = RefCell::new(Vec::new());
        for n in (start..=end).rev() {
            if n == end && n < self.given.steps {
                continue;
            }
            let step = if n < end { changes.next_back().unwrap_or_default() } else { &[] };
            let (input, at_end) = (self.given.input(n), self.back.cotangent.momentum);
            self.back.values.clear();
            if let Input::Values(values) = input {
                values.each(&mut |_| self.back.values.push(real(0.0)));
            }
            let first = step.first().map(|event| &event.before);
            let mut of_cost = Cotangent::zero();
            // The stages of a step, and then those of a processor. A visit is inlined, and so both are visited in one place.
            for is_processor in [false, true] {
                out.borrow_mut().clear();
                let mut number = ends;
                if is_processor {
                    let Some(read) = motions.next().or(first) else { break };
                    of_cost = (self.cost)(n, read);
                    // The processor's ends aren't traversed between steps, except for the cost of a state.
                    if ends == 0 || n > 0 && of_cost == Cotangent::zero() {
                        break;
                    }
                    number = if n == 0 { 0 } else { ends + stages };
                    if n == 0 {
                        out.borrow_mut().extend_from_slice(begin);
                    } else if let Some(before) = first.or(self.given.before_end.as_ref()) {
                        plan.make_end(&mut Recording { motion: *before, events: &out })?;
                        core::mem::swap(&mut self.back.cotangent, &mut of_cost);
                    }
                }
                let made = out.borrow();
                let changes = if is_processor { &**made } else { step };
                for (index, event) in changes.iter().enumerate().rev() {
                    plan.visit((scene, table), (number + index, event), self.back);
                }
                if !is_processor {
                    self.add_inputs(n, at_end, half);
                }
            }
            self.back.add(&of_cost);
        }
        Ok(())
    }
}

impl<S: SecondDerivatives, P: Linearisable<S>> Linearisation<'_, S, P> {
    /// Makes `steps` steps, and returns the gradient of `Σ_n c_n(state_n)` by the state before them and by all
    /// parameters; on an error the state is unchanged.
    ///
    /// `cost` returns the derivatives of `c_n` by each state, and is called from `n = steps` to `n = 0`. If a cost
    /// depends on the parameters directly, the caller has to add that derivative. A further parameter takes a few
    /// operations more: for a heavy top the whole gradient takes two plain steps for each step
    /// (`cargo bench -p liestep-benches -- gradients`). [The chapter](crate::guide::gradients) has an example.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::step`], and [`StepError::NonFinite`] if the gradient overflows, as it does in chaos.
    pub fn adjoint(
        &self,
        state: &mut StateOf<S, P>,
        steps: u64,
        tape: Tape,
        mut cost: impl FnMut(u64, &MotionOf<S>) -> Cotangent<Vector<S>>,
    ) -> Result<GradientOf<S>, StepError> {
        self.adjoint_of(state, (steps, &[]), tape, &mut cost).map(|(gradient, _)| gradient)
    }

    /// Makes a step with each of these inputs, and returns the gradient by the start and the parameters, as
    /// [`adjoint`](Self::adjoint), and the derivatives by the inputs, each of the kind of its input.
    ///
    /// The derivative by a control force is `h/2 (u + p)`, where `u` pairs with the momentum before the step and `p`
    /// with that after it. The derivative by values is that by their components in the body frame, transformed to space
    /// and summed over the stages; advected parameters have no derivative in a step with other values.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::step_given`], and [`StepError::NonFinite`] if the gradient overflows.
    ///
    /// # Examples
    ///
    /// The derivatives of a body's last momentum by the torques of all steps:
    ///
    /// ```
    /// use liestep::effects::RigidBody;
    /// use liestep::gradients::{Cotangent, Input, Tape};
    /// use liestep::groups::LieGroup as _;
    /// use liestep::{NonstandardInertia, SO3, Stepper};
    /// use nalgebra::Vector3;
    ///
    /// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.0))?;
    /// let stepper = Stepper::new(RigidBody { J_d }, 0.1)?;
    /// let mut state = stepper.start(SO3::identity(), Vector3::zeros())?;
    /// let torques = [Input::Force(Vector3::new(0.1, 0.0, 0.2)); 10];
    /// let last = Cotangent { momentum: Vector3::z(), ..Cotangent::zero() };
    /// let cost = |n, _: &_| if n == 10 { last } else { Cotangent::zero() };
    /// let (_, by_torques) = stepper.linearised()?.adjoint_given(&mut state, &torques, Tape::All, cost)?;
    /// let Input::Force(by_last) = by_torques[9] else { unreachable!() };
    /// assert!((by_last.z - 0.1_f64).abs() < 1e-3); // h
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn adjoint_given(
        &self,
        state: &mut StateOf<S, P>,
        inputs: &[InputOf<S>],
        tape: Tape,
        mut cost: impl FnMut(u64, &MotionOf<S>) -> Cotangent<Vector<S>>,
    ) -> Result<(GradientOf<S>, Vec<InputOf<S>>), StepError> {
        self.adjoint_of(state, (inputs.len() as u64, inputs), tape, &mut cost)
    }

    fn adjoint_of(
        &self,
        state: &mut StateOf<S, P>,
        (steps, inputs): (u64, &[InputOf<S>]),
        tape: Tape,
        cost: &mut CostOf<'_, S>,
    ) -> Result<(GradientOf<S>, Vec<InputOf<S>>), StepError> {
        let ends = if inputs.is_empty() { self.stepper.plan.ends() } else { 0 };
        let mut given = RunData { steps, inputs, motions: Vec::new(), before_end: None, ends };
        let mut by_inputs = Vec::with_capacity(inputs.len());
        let length = match tape {
            Tape::All => steps,
            Tape::SquareRoot => steps.isqrt(),
        };
        let length = length.max(1);
        let (mut end, mut starts) = (*state, Vec::new());
        let mut events = Vec::new();
        // A reservation that fails isn't an error: storing the stages below is, if there is no memory for them.
        let _ = events
            .try_reserve(usize::try_from(length).unwrap_or(usize::MAX).saturating_mul(self.stepper.plan.stages()));
        let events = RefCell::new(events);
        let mut made = 0;
        // All stretches but the last are stepped through first.
        while steps - made > length {
            starts.push((made, end));
            for _ in 0..length {
                // The record is dropped, as steps without one would be compiled for all inputs again.
                self.recorded_given(&mut end, given.input(made), &events, [false; 2])?;
                events.borrow_mut().clear();
                made += 1;
            }
        }
        starts.push((made, end));
        Record { linearised: self, state: &mut end, steps: made..steps, given: &mut given, events: &events }.run()?;
        let mut gradient = vec![real(0.0); self.stepper.plan.parameters()];
        let mut back = Back { cotangent: Cotangent::zero(), gradient: &mut gradient, values: Vec::new() };
        let mut last = steps;
        while let Some((first, mut start)) = starts.pop() {
            if last < steps {
                events.borrow_mut().clear();
                let (state, steps) = (&mut start, first..last);
                Record { linearised: self, state, steps, given: &mut given, events: &events }.run()?;
            }
            let events = events.borrow();
            dispatch(Stretch {
                linearised: self,
                steps: first..last,
                events: &events,
                given: &given,
                by_inputs: &mut by_inputs,
                back: &mut back,
                cost: &mut *cost,
            })?;
            last = first;
        }
        let start = back.cotangent;
        let gradient = finite::<S>(start, gradient)?;
        by_inputs.reverse();
        if by_inputs.iter().flat_map(Input::scalars).any(|share| !is_finite(share)) {
            return Err(StepError::NonFinite { what: "gradient" });
        }
        *state = end;
        Ok((gradient, by_inputs))
    }

    /// Adjoints with a reverse pass by steps of `−h`, which stores no state of the forward run.
    ///
    /// Such a step is the inverse of one of `h` except for rounding, which the motion magnifies like any other
    /// deviation.
    ///
    /// For that `l_d` has to be self-adjoint; another doesn't compile, and neither does a scene with a force.
    ///
    /// # Errors
    ///
    /// [`SetupError`] if the scene has no step of `−h`.
    pub fn backwards(&self) -> Result<Backwards<'_, S, P>, SetupError>
    where
        S: DiscreteLagrangian + Clone,
    {
        let Self { stepper, .. } = self;
        Ok(Backwards { linearised: self, inverse: stepper.inverse()?, undone: stepper.plan.table_undone() })
    }
}

/// Adjoints without a tape, by [`Linearisation::backwards`].
#[derive(Clone, Debug)]
pub struct Backwards<'a, S: SecondDerivatives, P: Linearisable<S>> {
    linearised: &'a Linearisation<'a, S, P>,
    inverse: Stepper<S, P>,
    /// The table of the forward stages, as backward steps undo them.
    undone: P::Table,
}

impl<S: SecondDerivatives, P: Linearisable<S>> Backwards<'_, S, P> {
    /// The gradient of [`Linearisation::adjoint`]; `cost` takes the states of the backward steps.
    ///
    /// # Errors
    ///
    /// The errors of [`Linearisation::adjoint`].
    pub fn adjoint(
        &self,
        state: &mut StateOf<S, P>,
        steps: u64,
        mut cost: impl FnMut(u64, &MotionOf<S>) -> Cotangent<Vector<S>>,
    ) -> Result<GradientOf<S>, StepError> {
        let forwards = self.linearised;
        let mut end = *state;
        for _ in 0..steps {
            forwards.stepper.step(&mut end)?;
        }
        let mut now = self.inverse.adopt(&end);
        let events = RefCell::new(Vec::new());
        let mut gradient = vec![real(0.0); forwards.stepper.plan.parameters()];
        let mut back = Back { cotangent: cost(steps, &end.motion), gradient: &mut gradient, values: Vec::new() };
        for n in (0..steps).rev() {
            self.inverse.recorded(&mut now, &events, [true; 2])?;
            let mut made = events.borrow_mut();
            // A backward step undoes the stages from the last to the first.
            let after = made.iter().skip(1).map(|event| event.before).chain([now.motion]).collect::<Vec<_>>();
            for (index, (event, after)) in made.drain(..).zip(after).enumerate() {
                let increment = Group::<S>::from_increment(&event.increment).inverse().increment();
                let undone = Change { before: after, increment };
                forwards.stepper.plan.visit((&forwards.stepper.scene, &self.undone), (index, &undone), &mut back);
            }
            back.add(&cost(n, &now.motion));
        }
        let start = back.cotangent;
        let gradient = finite::<S>(start, gradient)?;
        *state = end;
        Ok(gradient)
    }
}

fn finite<S: Effect>(start: Cotangent<Vector<S>>, parameters: Vec<Scalar<S>>) -> Result<GradientOf<S>, StepError> {
    let is_start_finite = start.attitude.is_finite() && start.momentum.is_finite();
    if is_start_finite && parameters.iter().all(|&entry| is_finite(entry)) {
        Ok(Gradient { start, parameters })
    } else {
        Err(StepError::NonFinite { what: "gradient" })
    }
}
