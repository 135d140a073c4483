//! The seam between typed steppers and programs that choose scene, group and method at run time: states are slices of
//! numbers, and a layout names them.

use alloc::boxed::Box;
use alloc::string::String;
use alloc::vec::Vec;
use core::ops::Range;

use crate::error::{SetupError, StepError};
use crate::groups::layout::Factor;
use crate::motion::plan::Cost;
use crate::motion::report::StepReport;
use nalgebra::Vector3;

/// A scene, a method and a step `h` as one value, whose states are slices of numbers.
///
/// It is object safe: files, Python, ensembles and recorders hold a `dyn Propagator`, and know neither the group nor the
/// method. A [`Stepper`](crate::Stepper) of any type is one, and so is a declaration that is derived at run time.
///
/// # Contract
///
/// - A state has the entries that its [`layout`](Self::layout) names, and continues with the same bits wherever it is
///   copied to.
/// - An error leaves the state unchanged.
/// - A slice of another length is an error, [`StepError::NonFinite`] of the "state of this layout", and no panic.
pub trait Propagator {
    /// Names, units and places of a state's numbers.
    fn layout(&self) -> &Layout;

    /// The state at the start, from an attitude, as the matrices of its factors row by row, and a body velocity, on
    /// SO(3) in rad/s.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::start`](crate::Stepper::start).
    fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError>;

    /// Makes one step.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::step`](crate::Stepper::step).
    fn step(&self, state: &mut [f64]) -> Result<StepReport, StepError>;

    /// Makes one step under a constant force in the body frame, on SO(3) a torque about its axes, N m: half of its impulse
    /// `h f` before the step, and half after it. On an error the state is unchanged. Where the lengths of steps depend on the
    /// state, the force changes that of its own step: take equal ones.
    ///
    /// # Errors
    ///
    /// The errors of [`step`](Self::step); [`StepError::NonFinite`] for a force of another length, or one that isn't finite.
    ///
    /// # Source
    ///
    /// \[MW01\], section 3.2.
    fn step_forced(&self, state: &mut [f64], force: &[f64]) -> Result<StepReport, StepError> {
        let length = self.length(state).unwrap_or_else(|| self.step_size());
        forced(self.layout(), state, (force, length), |next| self.step(next))
    }

    /// Makes `steps` steps; returns the sum of their iterations.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::run`](crate::Stepper::run).
    fn run(&self, state: &mut [f64], steps: u64) -> Result<u64, StepError> {
        let (mut next, mut iterations) = (self.layout().checked(state)?.to_vec(), 0);
        for _ in 0..steps {
            iterations += u64::from(self.step(&mut next)?.iterations);
        }
        state.copy_from_slice(&next);
        Ok(iterations)
    }

    /// A run in stretches: `steps` steps first, then each time as many as `next` returns for the state reached and its time,
    /// s, until it returns 0; returns the number of all iterations. The memory in the states of `next` may be an older one.
    ///
    /// If a step fails, the run ends with the error, and the state is that before the failed step.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::step`](crate::Stepper::step), for the step that has no solution.
    fn run_stretches(
        &self,
        state: &mut [f64],
        mut steps: u64,
        next: &mut dyn FnMut(&[f64], f64) -> u64,
    ) -> Result<u64, StepError> {
        let mut iterations = 0;
        while steps > 0 {
            match self.run(state, steps) {
                Ok(spent) => iterations += spent,
                Err(_) => {
                    for _ in 0..steps {
                        iterations += u64::from(self.step(state)?.iterations);
                    }
                }
            }
            steps = next(state, self.time(state));
        }
        Ok(iterations)
    }

    /// The state a fraction of a step after this one, with the number of steps of this one; its memory is that of a new
    /// start.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::step`](crate::Stepper::step).
    fn part(&self, state: &[f64], fraction: f64) -> Result<Box<[f64]>, StepError>;

    /// A state at the attitude and momentum of another one, also of another method, whose time and memory begin here; NaN if
    /// that is too short.
    fn adopt(&self, state: &[f64]) -> Box<[f64]>;

    /// The approximate number of operations of a step; `None` if it isn't known.
    fn cost(&self) -> Option<Cost> {
        None
    }

    /// The step `h`, s; if steps vary, their unit.
    fn step_size(&self) -> f64;

    /// The time since the start, s.
    fn time(&self, state: &[f64]) -> f64 {
        self.step_size() * state.last().copied().unwrap_or_default()
    }

    /// The length of the next step, s; `None` if all have the length [`step_size`](Self::step_size).
    fn length(&self, _state: &[f64]) -> Option<f64> {
        None
    }

    /// Writes the body velocity, on SO(3) in rad/s; NaN if no velocity has this momentum.
    fn velocity(&self, state: &[f64], velocity: &mut [f64]);

    /// The energy, J; NaN if no velocity has this momentum.
    fn energy(&self, state: &[f64]) -> f64;

    /// Writes the momentum in space, `Ad*_{g⁻¹} μ`.
    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]);

    /// The distance of the attitude from the group, `‖RᵀR − I‖` on SO(3).
    fn defect(&self, state: &[f64]) -> f64;

    /// The widest gap of a joint, m, together with the cosines of its axes; zero without joints.
    fn gap(&self, _state: &[f64]) -> f64 {
        0.0
    }

    /// The forces of the joints on their second bodies in the step from this state, N, and their torques about the joints' points
    /// there, N m, both in space; none without joints.
    ///
    /// # Errors
    ///
    /// The errors of [`step`](Self::step).
    fn joint_forces(&self, _state: &[f64]) -> Result<Vec<[Vector3<f64>; 2]>, StepError> {
        Ok(Vec::new())
    }
}

/// Names, units and places of the numbers of a state: first the attitude, then the momentum, the advected parameters, the
/// memory of the method, and last the number of steps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// The factors of the group, in order.
    pub factors: Vec<Factor>,
    /// The names of the advected parameters' numbers; their order is that of the state.
    pub advected: Vec<String>,
    /// The number of entries of the memory of the method.
    pub memory: usize,
}

impl Layout {
    /// The number of entries of an attitude.
    #[must_use]
    pub fn entries(&self) -> usize {
        self.factors.iter().map(|factor| factor.kind.rows() * factor.kind.rows()).sum()
    }

    /// The number of components of a velocity or a momentum.
    #[must_use]
    pub fn components(&self) -> usize {
        self.factors.iter().map(|factor| factor.components.len()).sum()
    }

    /// The places of the attitude.
    #[must_use]
    pub fn attitude(&self) -> Range<usize> {
        0..self.entries()
    }

    /// The places of the momentum.
    #[must_use]
    pub fn momentum(&self) -> Range<usize> {
        let start = self.entries();
        start..start + self.components()
    }

    /// The places of the advected parameters.
    #[must_use]
    pub fn advected(&self) -> Range<usize> {
        let start = self.momentum().end;
        start..start + self.advected.len()
    }

    /// The places of the memory of the method.
    #[must_use]
    pub fn memory(&self) -> Range<usize> {
        let start = self.advected().end;
        start..start + self.memory
    }

    /// The number of entries of a state.
    #[must_use]
    pub fn state(&self) -> usize {
        self.memory().end + 1
    }

    /// The state, if it has this layout's number of entries.
    ///
    /// # Errors
    ///
    /// [`StepError::NonFinite`] of the "state of this layout".
    pub fn checked<'a>(&self, state: &'a [f64]) -> Result<&'a [f64], StepError> {
        if state.len() == self.state() { Ok(state) } else { Err(StepError::NonFinite { what: "state of this layout" }) }
    }
}

/// The result of a function on the state between both halves of a force's impulse over a step of this length. On an error
/// the state is unchanged.
///
/// # Errors
///
/// The errors of the function, and those of [`Propagator::step_forced`].
pub fn forced<R>(
    layout: &Layout,
    state: &mut [f64],
    (force, length): (&[f64], f64),
    run: impl FnOnce(&mut [f64]) -> Result<R, StepError>,
) -> Result<R, StepError> {
    layout.checked(state)?;
    if force.len() != layout.components() || !force.iter().all(|part| part.is_finite()) {
        return Err(StepError::NonFinite { what: "control force" });
    }
    let half = length * 0.5;
    let push = |state: &mut [f64]| {
        let momentum = &mut state[layout.momentum()];
        momentum.iter_mut().zip(force).for_each(|(momentum, force)| *momentum += force * half);
    };
    let mut next = state.to_vec();
    push(&mut next);
    let result = run(&mut next)?;
    push(&mut next);
    if !next[layout.momentum()].iter().all(|part| part.is_finite()) {
        return Err(StepError::NonFinite { what: "momentum after the step" });
    }
    state.copy_from_slice(&next);
    Ok(result)
}
