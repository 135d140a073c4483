//! A stepper without its scene and method in the type, whose states are numbers.

use alloc::boxed::Box;
use alloc::rc::Rc;
use alloc::vec;
use alloc::vec::Vec;
use core::fmt::{self, Debug};
use core::ops::Deref;

use crate::error::{SetupError, StepError};
use crate::groups::layout::{Factor, FactorKind};
use crate::groups::{LieGroup, SO3};
use crate::motion::abreast::{Abreast, Joint, Together};
use crate::motion::integrator::Integrator;
use crate::motion::plan::Cost;
use crate::motion::propagator::{Layout, Propagator};
use crate::motion::report::StepReport;
use crate::numbers::Entries;
use nalgebra::{Matrix3, Vector3};

/// A [`Propagator`] of any scene, group and method, by [`Stepper::into_any`](crate::Stepper::into_any): for programs that choose them at run time.
///
/// The stepper steps, runs and is recorded as an [`Integrator`], by states that are numbers. A clone is the same stepper, and
/// costs nothing.
///
/// # Examples
///
/// ```
/// use liestep::effects::RigidBody;
/// use liestep::{NonstandardInertia, SO3, Stepper};
/// use nalgebra::Vector3;
///
/// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
/// let stepper = Stepper::new(RigidBody { J_d }, 0.01)?.into_any();
/// let mut state = stepper.start_at(SO3::identity(), Vector3::new(0.1, 2.0, 0.2))?;
/// stepper.run(&mut state, 1000)?;
/// assert_eq!((state.attitude().len(), state.momentum().len(), state.steps()), (9, 3, 1000));
/// assert!((stepper.spatial_momentum(&state)[1] - 4.0).abs() < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct AnyStepper {
    propagator: Rc<dyn Propagator>,
    layout: Rc<Layout>,
    /// The bodies that are stepped together with this one's.
    joint: Option<Joint>,
}

impl AnyStepper {
    inherent_steps!();

    /// A stepper around this propagator.
    pub fn new(propagator: impl Propagator + 'static) -> Self {
        let layout = Rc::new(propagator.layout().clone());
        Self { propagator: Rc::new(propagator), layout, joint: None }
    }

    /// A stepper of this propagator, of whose bodies at most so many can be stepped [together](Self::abreast).
    pub fn joinable<P: Propagator + 'static>(propagator: P, most: usize, together: Together<P>) -> Self {
        let (layout, propagator) = (Rc::new(propagator.layout().clone()), Rc::new(propagator));
        Self { joint: Some(Joint::of(&propagator, most, together)), propagator, layout }
    }

    /// The longest leading part of these bodies that is stepped together, and its number of bodies; `None` if the first one is
    /// stepped alone.
    #[must_use]
    pub fn abreast(bodies: &[(Self, AnyState)]) -> Option<(Box<dyn Abreast>, usize)> {
        let joints = bodies.iter().map_while(|(stepper, state)| Some((stepper.joint.as_ref()?, &*state.0.numbers)));
        let most = bodies.first()?.0.joint.as_ref()?.most;
        let count = joints.clone().count().min(most);
        (1..=count).rev().find_map(|count| Some((Joint::together(joints.clone().take(count))?, count)))
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
    /// The errors of [`Stepper::start`](crate::Stepper::start).
    pub fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<AnyState, SetupError> {
        self.propagator.start(attitude, velocity).map(|numbers| self.state(numbers))
    }

    /// A state from an attitude, the entries of the matrices of its factors row by row, body to space, and the components of a
    /// momentum, body frame; on SO(3) kg m²/s.
    ///
    /// # Errors
    ///
    /// The errors of [`start`](Self::start), and [`SetupError::Length`] or [`SetupError::NonFinite`] for a momentum that isn't one, or
    /// whose velocity isn't finite.
    pub fn start_with_momentum(&self, attitude: &[f64], momentum: &[f64]) -> Result<AnyState, SetupError> {
        if momentum.len() != self.layout.components() {
            let (found, expected) = (momentum.len(), self.layout.components());
            return Err(SetupError::Length { what: "momentum", found, expected });
        }
        let rest = self.start(attitude, &vec![0.0; momentum.len()])?;
        let mut numbers = rest.numbers().to_vec();
        numbers[self.layout.momentum()].copy_from_slice(momentum);
        let state = self.state_of(&numbers).map_or(rest, |moved| self.adopt(&moved));
        let is_known = self.velocity(&state).iter().all(|component| component.is_finite());
        if is_known { Ok(state) } else { Err(SetupError::NonFinite { what: "velocity of the momentum" }) }
    }

    /// A state from an attitude and a velocity of the group, as by [`Stepper::start`](crate::Stepper::start).
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::start`](crate::Stepper::start), and [`SetupError::Length`] for another group.
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

    /// The widest gap of a joint, as by [`Propagator::gap`].
    #[must_use]
    pub fn gap(&self, motion: &AnyMotion) -> f64 {
        self.propagator.gap(&motion.numbers)
    }

    /// The forces and torques of the joints, as by [`Propagator::joint_forces`].
    ///
    /// # Errors
    ///
    /// The errors of [`Integrator::step`].
    pub fn joint_forces(&self, motion: &AnyMotion) -> Result<Vec<[Vector3<f64>; 2]>, StepError> {
        self.propagator.joint_forces(&motion.numbers)
    }

    /// Makes one step under a constant force in the body frame, as by [`Propagator::step_forced`].
    ///
    /// # Errors
    ///
    /// The errors of [`Propagator::step_forced`].
    pub fn step_forced(&self, state: &mut AnyState, force: &[f64]) -> Result<StepReport, StepError> {
        self.propagator.step_forced(&mut state.0.numbers, force)
    }

    /// The motion of these numbers after this many steps.
    #[allow(clippy::cast_precision_loss)] // 2⁵³ steps take longer than a career
    pub(super) fn motion_of(&self, mut numbers: Box<[f64]>, steps: u64) -> AnyMotion {
        if let Some(last) = numbers.last_mut() {
            *last = steps as f64;
        }
        AnyMotion { numbers, layout: Rc::clone(&self.layout) }
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
pub(super) fn numbers<E: Entries<f64>>(value: &E) -> Vec<f64> {
    let mut numbers = Vec::new();
    value.each(&mut |number| numbers.push(number));
    numbers
}

/// The number of a type's entries.
pub(super) fn length<E: Entries<f64>>() -> usize {
    let mut length = 0;
    E::from_entries(&mut || {
        length += 1;
        0.0
    });
    length
}

/// The value of these numbers; those that are missing are zero.
pub(super) fn read<E: Entries<f64>>(numbers: &[f64]) -> E {
    let mut numbers = numbers.iter();
    E::from_entries(&mut || numbers.next().copied().unwrap_or_default())
}
