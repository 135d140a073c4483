//! A stepper without its scene and method in the type, whose states are numbers.

use alloc::boxed::Box;
use alloc::rc::Rc;
use alloc::vec;
use alloc::vec::Vec;
use core::fmt::{self, Debug};
use core::ops::Deref;

use crate::error::{SetupError, StepError};
use crate::groups::layout::{Factor, FactorKind};
use crate::groups::{Advected, LieGroup, SO3};
use crate::mechanics::{Effect, Group, Vector};
use crate::motion::integrator::Integrator;
use crate::motion::kept::Kept;
use crate::motion::plan::{Cost, Plan};
use crate::motion::propagator::{Layout, Propagator};
use crate::motion::report::StepReport;
use crate::motion::state::{ElapsedTime, State};
use crate::motion::stepper::{StateOf, Stepper};
use crate::motion::summation::{Motion, MotionOf};
use crate::numbers::Entries;
use nalgebra::Matrix3;

/// A [`Propagator`] of any scene, group and method, by [`Stepper::into_any`]: for programs that choose them at run time.
///
/// The stepper steps, runs and is recorded as an [`Integrator`], by states that are numbers. A clone is the same stepper, and
/// costs nothing.
///
/// # Examples
///
/// ```
/// use liestep::effects::RigidBody;
/// use liestep::motion::Integrator as _;
/// use liestep::{NonstandardInertia, SO3, Stepper};
/// use nalgebra::Vector3;
///
/// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
/// let stepper = Stepper::new(RigidBody { J_d }, 0.01)?.into_any();
/// let mut state = stepper.start_at(SO3::identity(), Vector3::new(0.1, 2.0, 0.2))?;
/// stepper.run(&mut state, 1000)?;
/// assert_eq!((state.attitude().len(), state.momentum().len(), state.steps()), (9, 3, 1000));
/// let motion = state.typed::<SO3, ()>().ok_or("a state on SO(3)")?;
/// assert!((motion.spatial_momentum() - Vector3::new(0.1, 4.0, 0.5)).norm() < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct AnyStepper {
    propagator: Rc<dyn Propagator>,
    layout: Rc<Layout>,
}

impl AnyStepper {
    /// A stepper of this propagator.
    pub fn new(propagator: impl Propagator + 'static) -> Self {
        let layout = Rc::new(propagator.layout().clone());
        Self { propagator: Rc::new(propagator), layout }
    }

    /// Names, units and places of a state's numbers.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// A state from the numbers of an attitude and of a velocity, as by [`Propagator::start`].
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::start`].
    pub fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<AnyState, SetupError> {
        self.propagator.start(attitude, velocity).map(|numbers| self.state(numbers))
    }

    /// A state from an attitude and a velocity of the group, as by [`Stepper::start`].
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::start`], and [`SetupError::Length`] for another group.
    pub fn start_at<G: LieGroup<Scalar = f64>>(
        &self,
        attitude: G,
        velocity: G::Vector,
    ) -> Result<AnyState, SetupError> {
        self.start(&numbers(&attitude.matrix()), &numbers(&velocity))
    }

    /// A state of these numbers; none if they are of another layout.
    #[must_use]
    pub fn state_of(&self, numbers: &[f64]) -> Option<AnyState> {
        (numbers.len() == self.layout.state()).then(|| self.state(numbers.into()))
    }

    /// The momentum in space, `Ad*_{g⁻¹} μ`.
    #[must_use]
    pub fn spatial_momentum(&self, motion: &AnyMotion) -> Vec<f64> {
        let mut momentum = vec![0.0; self.layout.components()];
        self.propagator.spatial_momentum(&motion.numbers, &mut momentum);
        momentum
    }

    fn state(&self, numbers: Box<[f64]>) -> AnyState {
        AnyState(AnyMotion { numbers, layout: Rc::clone(&self.layout) })
    }
}

impl Debug for AnyStepper {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("AnyStepper").field("layout", &self.layout).finish_non_exhaustive()
    }
}

/// The state of an [`AnyStepper`].
#[derive(Clone, Debug, PartialEq)]
pub struct AnyState(AnyMotion);

impl Deref for AnyState {
    type Target = AnyMotion;

    fn deref(&self) -> &AnyMotion {
        &self.0
    }
}

/// The motion of an [`AnyStepper`] at one time, as numbers that its layout names.
#[derive(Clone, PartialEq)]
pub struct AnyMotion {
    numbers: Box<[f64]>,
    layout: Rc<Layout>,
}

impl AnyMotion {
    /// The entries of the attitude, as the matrices of its factors row by row.
    #[must_use]
    pub fn attitude(&self) -> &[f64] {
        &self.numbers[self.layout.attitude()]
    }

    /// The components of the momentum in the body frame.
    #[must_use]
    pub fn momentum(&self) -> &[f64] {
        &self.numbers[self.layout.momentum()]
    }

    /// The numbers of the advected parameters.
    #[must_use]
    pub fn advected(&self) -> &[f64] {
        &self.numbers[self.layout.advected()]
    }

    /// The number of steps since the start.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
    pub fn steps(&self) -> u64 {
        self.numbers.last().map_or(0, |steps| *steps as u64)
    }

    /// All numbers of the state.
    #[must_use]
    pub fn numbers(&self) -> &[f64] {
        &self.numbers
    }

    /// The motion on this group with these advected parameters; none if the numbers are those of another group.
    #[must_use]
    pub fn typed<G: LieGroup<Scalar = f64>, A: Advected<G>>(&self) -> Option<Motion<G, A>> {
        let factors = G::factors();
        if factors != self.layout.factors || length::<A>() > self.advected().len() {
            return None;
        }
        Some(Motion {
            attitude: G::from_matrix_unchecked(read(self.attitude())),
            momentum: read(self.momentum()),
            advected: read(self.advected()),
            steps: self.steps(),
        })
    }
}

impl Debug for AnyMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("AnyMotion").field(&self.numbers).finish()
    }
}

impl Integrator for AnyStepper {
    type Scalar = f64;
    type Motion = AnyMotion;
    type Velocity = Vec<f64>;
    type Inertia = ();
    type State = AnyState;

    fn step(&self, state: &mut AnyState) -> Result<StepReport, StepError> {
        self.propagator.step(&mut state.0.numbers)
    }

    fn run(&self, state: &mut AnyState, steps: u64) -> Result<u64, StepError> {
        self.propagator.run(&mut state.0.numbers, steps)
    }

    fn run_stretches(
        &self,
        state: &mut AnyState,
        steps: u64,
        next: &mut dyn FnMut(&AnyMotion, f64) -> u64,
    ) -> Result<u64, StepError> {
        let mut motion = state.0.clone();
        self.propagator.run_stretches(&mut state.0.numbers, steps, &mut |numbers, time| {
            motion.numbers.copy_from_slice(numbers);
            next(&motion, time)
        })
    }

    fn part(&self, state: &AnyState, fraction: f64) -> Result<AnyMotion, StepError> {
        self.propagator.part(&state.numbers, fraction).map(|numbers| self.state(numbers).0)
    }

    fn adopt(&self, motion: &AnyMotion) -> AnyState {
        self.state(self.propagator.adopt(&motion.numbers))
    }

    fn steps(motion: &AnyMotion) -> u64 {
        motion.steps()
    }

    fn cost(&self) -> Option<Cost> {
        self.propagator.cost()
    }

    fn step_size(&self) -> f64 {
        self.propagator.step_size()
    }

    fn time(&self, state: &AnyState) -> f64 {
        self.propagator.time(&state.numbers)
    }

    fn length(&self, state: &AnyState) -> Option<f64> {
        self.propagator.length(&state.numbers)
    }

    fn velocity(&self, motion: &AnyMotion) -> Vec<f64> {
        let mut velocity = vec![0.0; self.layout.components()];
        self.propagator.velocity(&motion.numbers, &mut velocity);
        velocity
    }

    fn energy(&self, motion: &AnyMotion) -> f64 {
        self.propagator.energy(&motion.numbers)
    }

    fn factors(&self) -> Vec<Factor> {
        self.layout.factors.clone()
    }

    fn inertia(&self) {}

    fn write(&self, motion: &AnyMotion, (): &(), attitude: &mut [f64], row: &mut [f64]) {
        let (mut entries, mut columns, mut places) = (motion.attitude(), &mut *attitude, &mut *row);
        for Factor { kind, .. } in &self.layout.factors {
            let (own, other) = entries.split_at(kind.rows() * kind.rows());
            let (written, behind) = columns.split_at_mut(kind.columns());
            write_element(*kind, own, written);
            let (here, rest) = places.split_at_mut(kind.columns());
            here.copy_from_slice(written);
            (entries, columns, places) = (other, behind, rest);
        }
        let components = self.layout.components();
        let (velocity, behind) = places.split_at_mut(components);
        self.propagator.velocity(&motion.numbers, velocity);
        let (momentum, behind) = behind.split_at_mut(components);
        momentum.copy_from_slice(motion.momentum());
        behind[0] = self.propagator.energy(&motion.numbers);
        behind[1] = self.propagator.defect(&motion.numbers);
    }
}

/// Writes the columns of an element from the entries of its matrix.
fn write_element(kind: FactorKind, entries: &[f64], columns: &mut [f64]) {
    match kind {
        FactorKind::Rotation => {
            let _ = SO3::from_matrix_unchecked(Matrix3::from_row_slice(entries)).write_numbers(columns);
        }
        FactorKind::Translation(rows) => {
            columns.iter_mut().enumerate().for_each(|(row, column)| *column = entries[row * rows + rows - 1]);
        }
        FactorKind::Matrix(_) => columns.copy_from_slice(entries),
    }
}

/// The numbers of a value, in order.
fn numbers<E: Entries<f64>>(value: &E) -> Vec<f64> {
    let mut numbers = Vec::new();
    value.each(&mut |number| numbers.push(number));
    numbers
}

/// The number of a type's entries.
fn length<E: Entries<f64>>() -> usize {
    let mut length = 0;
    E::from_entries(&mut || {
        length += 1;
        0.0
    });
    length
}

/// The value of these numbers; those that are missing are zero.
fn read<E: Entries<f64>>(numbers: &[f64]) -> E {
    let mut numbers = numbers.iter();
    E::from_entries(&mut || numbers.next().copied().unwrap_or_default())
}

/// A typed stepper as a propagator.
struct Erasure<S: Effect, P: Plan<S>> {
    stepper: Stepper<S, P>,
    layout: Layout,
    /// A memory with the length of all others.
    memory: P::Kept,
}

/// # Wrap: a stepper of any type
impl<S, P> Stepper<S, P>
where
    S: Effect<Scalar = f64> + 'static,
    P: Plan<S, Kept: 'static> + 'static,
{
    /// Erases scene, group and method from the type.
    #[must_use]
    pub fn into_any(self) -> AnyStepper {
        let memory =
            self.adopt(&Motion { attitude: Group::<S>::identity(), momentum: read(&[]), advected: (), steps: 0 });
        let memory = memory.kept;
        let mut entries = 2;
        memory.each(&mut |_| entries += 1);
        let advected = (1..=length::<S::Advected>()).map(|number| alloc::format!("advected_{number}")).collect();
        let layout = Layout { factors: Group::<S>::factors(), advected, memory: entries };
        AnyStepper::new(Erasure { stepper: self, layout, memory })
    }
}

/// A state of another layout.
const OF_THIS_LAYOUT: StepError = StepError::NonFinite { what: "state of this layout" };

impl<S: Effect<Scalar = f64>, P: Plan<S>> Erasure<S, P> {
    /// The motion of a state.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
    fn motion(&self, state: &[f64]) -> Option<MotionOf<S>> {
        let layout = &self.layout;
        (state.len() == layout.state()).then(|| Motion {
            attitude: Group::<S>::from_matrix_unchecked(read(&state[layout.attitude()])),
            momentum: read(&state[layout.momentum()]),
            advected: read(&state[layout.advected()]),
            steps: state[state.len() - 1] as u64,
        })
    }

    /// The typed state.
    fn typed(&self, state: &[f64]) -> Option<StateOf<S, P>> {
        let motion = self.motion(state)?;
        let mut numbers = state[self.layout.memory()].iter().copied();
        let mut next = || numbers.next().unwrap_or_default();
        let kept = self.memory.with_numbers(&mut |_| next())?;
        Some(State { motion, kept, elapsed: ElapsedTime { sum: next(), carry: next() } })
    }

    /// Writes a motion, and a memory if there is one.
    #[allow(clippy::cast_precision_loss)] // 2⁵³ steps take longer than a career
    fn write(&self, motion: &MotionOf<S>, memory: Option<(&P::Kept, &ElapsedTime<f64>)>, state: &mut [f64]) {
        let mut places = state.iter_mut();
        let mut write = |number: f64| places.next().map_or((), |place| *place = number);
        motion.attitude.matrix().each(&mut write);
        motion.momentum.each(&mut write);
        motion.advected.each(&mut write);
        if let Some((kept, elapsed)) = memory {
            kept.each(&mut write);
            write(elapsed.sum);
            write(elapsed.carry);
        }
        if let Some(last) = state.last_mut() {
            *last = motion.steps as f64;
        }
    }

    fn boxed(&self, state: &StateOf<S, P>) -> Box<[f64]> {
        let mut numbers = vec![0.0; self.layout.state()].into_boxed_slice();
        self.write(&state.motion, Some((&state.kept, &state.elapsed)), &mut numbers);
        numbers
    }

    /// Applies `steps` to the typed state. The state is updated if steps were made, before an error too.
    fn change<R>(
        &self,
        state: &mut [f64],
        steps: impl FnOnce(&mut StateOf<S, P>) -> Result<R, StepError>,
    ) -> Result<R, StepError> {
        let mut own = self.typed(state).ok_or(OF_THIS_LAYOUT)?;
        let before = own.motion.steps;
        let result = steps(&mut own);
        if result.is_ok() || own.motion.steps != before {
            self.write(&own.motion, Some((&own.kept, &own.elapsed)), state);
        }
        result
    }
}

impl<S: Effect<Scalar = f64>, P: Plan<S>> Propagator for Erasure<S, P> {
    fn layout(&self) -> &Layout {
        &self.layout
    }

    fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError> {
        let lengths = [("attitude", attitude.len(), self.layout.entries())];
        for (what, found, expected) in
            lengths.into_iter().chain([("velocity", velocity.len(), self.layout.components())])
        {
            if found != expected {
                return Err(SetupError::Length { what, found, expected });
            }
        }
        let (attitude, velocity) = (Group::<S>::from_matrix_unchecked(read(attitude)), read::<Vector<S>>(velocity));
        self.stepper.start(attitude, velocity).map(|state| self.boxed(&state))
    }

    fn step(&self, state: &mut [f64]) -> Result<StepReport, StepError> {
        self.change(state, |own| Integrator::step(&self.stepper, own))
    }

    fn run(&self, state: &mut [f64], steps: u64) -> Result<u64, StepError> {
        self.change(state, |own| Integrator::run(&self.stepper, own, steps))
    }

    fn run_stretches(
        &self,
        state: &mut [f64],
        steps: u64,
        next: &mut dyn FnMut(&[f64], f64) -> u64,
    ) -> Result<u64, StepError> {
        let mut reached: Box<[f64]> = (&*state).into();
        self.change(state, |own| {
            Integrator::run_stretches(&self.stepper, own, steps, &mut |motion, time| {
                self.write(motion, None, &mut reached);
                next(&reached, time)
            })
        })
    }

    fn part(&self, state: &[f64], fraction: f64) -> Result<Box<[f64]>, StepError> {
        let own = self.typed(state).ok_or(OF_THIS_LAYOUT)?;
        let motion = Integrator::part(&self.stepper, &own, fraction)?;
        let kept = self.stepper.plan().keep(self.stepper.scene(), &motion);
        Ok(self.boxed(&State { motion, kept, elapsed: own.elapsed }))
    }

    fn adopt(&self, state: &[f64]) -> Box<[f64]> {
        let (attitude, momentum) = (state.get(self.layout.attitude()), state.get(self.layout.momentum()));
        let (Some(attitude), Some(momentum)) = (attitude, momentum) else {
            return vec![f64::NAN; self.layout.state()].into();
        };
        let attitude = Group::<S>::from_matrix_unchecked(read(attitude));
        self.boxed(&self.stepper.adopt(&Motion { attitude, momentum: read(momentum), advected: (), steps: 0 }))
    }

    fn cost(&self) -> Option<Cost> {
        Some(self.stepper.plan().cost())
    }

    fn step_size(&self) -> f64 {
        self.stepper.step_size()
    }

    fn time(&self, state: &[f64]) -> f64 {
        self.typed(state).map_or(f64::NAN, |own| self.stepper.time(&own))
    }

    fn length(&self, state: &[f64]) -> Option<f64> {
        self.typed(state).and_then(|own| self.stepper.length(&own))
    }

    fn velocity(&self, state: &[f64], velocity: &mut [f64]) {
        let found = self.motion(state).map(|motion| numbers(&self.stepper.velocity(&motion)));
        write_or_nan(found, velocity);
    }

    fn energy(&self, state: &[f64]) -> f64 {
        self.motion(state).map_or(f64::NAN, |motion| self.stepper.energy(&motion))
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]) {
        write_or_nan(self.motion(state).map(|motion| numbers(&motion.spatial_momentum())), momentum);
    }

    fn defect(&self, state: &[f64]) -> f64 {
        self.motion(state).map_or(f64::NAN, |motion| motion.attitude.defect())
    }
}

/// Writes these numbers; NaN where there are none.
fn write_or_nan(found: Option<Vec<f64>>, places: &mut [f64]) {
    let mut found = found.into_iter().flatten();
    places.fill_with(|| found.next().unwrap_or(f64::NAN));
}
