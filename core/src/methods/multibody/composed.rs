//! Compositions of a system's step: several steps of other lengths, one after the other.
//!
//! Each stage is a stepper of its own, and the memory for the guess of the next increments is that of its own past: the
//! increments of a stage are smooth in time.

use alloc::sync::Arc;
use alloc::vec::Vec;

use super::forces::JointForces;
use super::state::{Offsets, layout};
use super::stepper::{MultibodyStepper, Stages};
use super::workspace::Workspace;
use crate::error::{SetupError, StepError};
use crate::methods::CompositionScheme;
use crate::motion::StepReport;

/// The largest change of a state by a step and one back, relative to the state. Rounding makes some `1e-13` of it; a step that is
/// of first order at one of its ends makes `h²`.
const UNDONE: f64 = 1e-9;

impl MultibodyStepper {
    /// The composition of this step by a scheme of base two: with joints it has the scheme's order as without. Of states with the
    /// same attitudes and momenta it makes steps of another method, as it has another memory.
    ///
    /// Steps of negative length turn friction into its opposite, so that a composition is for systems with weak friction or none:
    /// by stages `γ h` that are longest, those of stiff friction grow. The step has to be symmetric, as those of the kinetic
    /// terms, springs and joints here are; each [`start`](Self::start) checks it by a step there and back.
    ///
    /// # Errors
    ///
    /// [`SetupError::NotSelfAdjoint`] for a scheme of another base; [`SetupError::InvalidStep`] for a step whose stages are
    /// impossible.
    ///
    /// # Examples
    ///
    /// ```
    /// use liestep::groups::{LieGroup as _, R3};
    /// use liestep::methods::{CompositionScheme, Joint, Multibody};
    /// use liestep::{NonstandardInertia, SO3, lagrangian};
    /// use nalgebra::{Vector3, Vector6};
    ///
    /// #[lagrangian(
    ///     group(F = SO3, d = R3),
    ///     advected(x = d.seen_from(space)),
    ///     l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
    ///         - 0.5 * h * m * g * (x + x + d)[2],
    /// )]
    /// struct Heavy {
    ///     J_d: NonstandardInertia,
    ///     m: f64,
    ///     g: f64,
    /// }
    ///
    /// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(0.1, 0.2, 0.25))?;
    /// let off = |h: f64, steps: u64| -> Result<f64, Box<dyn std::error::Error>> {
    ///     let mut system = Multibody::new();
    ///     let body = system.body(Heavy { J_d, m: 1.0, g: 9.81 });
    ///     system.join(Joint::ball([Vector3::zeros(), Vector3::z() * 0.4]), None, body);
    ///     let stepper = system.stepper(h)?.composed(CompositionScheme::SUZUKI_4)?;
    ///     let start = [(SO3::identity(), R3::from(Vector3::z() * -0.4))];
    ///     let mut state = stepper.start(&start, &[Vector6::new(1.0, 2.0, 0.5, -0.8, 0.4, 0.0)])?;
    ///     let before = stepper.energy(&state);
    ///     stepper.run(&mut state, steps)?;
    ///     Ok((stepper.energy(&state) - before).abs())
    /// };
    /// // Of fourth order: at half the step the energy is off by a sixteenth.
    /// let ratio = off(0.02, 100)? / off(0.01, 200)?;
    /// assert!((14.0..18.0).contains(&ratio), "{ratio}");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn composed(mut self, scheme: CompositionScheme) -> Result<Self, SetupError> {
        if scheme.base() != 2 || !self.system.is_self_adjoint() {
            return Err(SetupError::NotSelfAdjoint);
        }
        self.stages = None;
        let stage = |gamma: f64| Ok((gamma, self.with_step(self.h * gamma)?));
        let steppers: Vec<_> = scheme.stages().map(stage).collect::<Result<_, SetupError>>()?;
        self.layout = layout(self.bodies(), steppers.len());
        self.offsets = Offsets::of(self.bodies(), steppers.len());
        self.stages = Some(Arc::new(Stages { scheme, steppers }));
        Ok(self)
    }

    /// Makes one step of a composition; on an error the state is unchanged.
    pub(super) fn composed_step(
        &self,
        Stages { steppers, .. }: &Stages,
        state: &mut [f64],
        work: &mut Workspace,
        mut forces: Option<&mut JointForces>,
    ) -> Result<StepReport, StepError> {
        let (steps, head) = (self.offsets.steps(state), self.offsets.attitudes() + 6 * self.bodies());
        let (mut whole, mut of_stage) = (core::mem::take(&mut work.whole), core::mem::take(&mut work.of_stage));
        whole.clear();
        whole.extend_from_slice(state);
        let mut of_step = forces.as_ref().map(|forces| JointForces::zeros(forces.joints()));
        let mut stage = |(number, (gamma, stepper)): (usize, &(f64, Self))| {
            let memory = self.offsets.memory_of(number);
            of_stage.clear();
            of_stage.extend_from_slice(&whole[..head]);
            of_stage.extend_from_slice(&whole[memory.clone()]);
            of_stage.push(steps);
            stepper.offsets.start_from_momenta(&mut of_stage, 0);
            let report = stepper.step_in(&mut of_stage, work, of_step.as_mut())?;
            if let (Some(all), Some(of_step)) = (&mut forces, &mut of_step) {
                all.take_up(of_step, *gamma);
            }
            whole[..head].copy_from_slice(&of_stage[..head]);
            whole[memory].copy_from_slice(&of_stage[head..of_stage.len() - 1]);
            Ok(report.iterations)
        };
        let mut all = steppers.iter().enumerate();
        let made = all.try_fold(0, |iterations, one| stage(one).map(|made| iterations + made));
        if made.is_ok() {
            state.copy_from_slice(&whole);
            self.offsets.set_steps(state, steps + 1.0);
        }
        (work.whole, work.of_stage) = (whole, of_stage);
        made.map(StepReport::of)
    }

    /// Checks that a step back undoes a step from this state, as far as both can be made.
    pub(super) fn check_symmetry(&self, state: &[f64]) -> Result<(), SetupError> {
        let Some(stages) = &self.stages else { return Ok(()) };
        let Some((_, first)) = stages.steppers.first() else { return Ok(()) };
        let head = self.offsets.attitudes() + 6 * self.bodies();
        let back = first.with_step(-first.h)?;
        let mut there = first.offsets.zeros();
        there[..head].copy_from_slice(&state[..head]);
        first.begin(&mut there);
        if first.step(&mut there).is_err() {
            return Ok(());
        }
        let middle = there.clone();
        back.begin(&mut there);
        if back.step(&mut there).is_err() {
            return Ok(());
        }
        let size = |numbers: &[f64]| numbers.iter().fold(0.0_f64, |most, number| most.max(number.abs()));
        let is_undone = |numbers: core::ops::Range<usize>| {
            let apart = state[numbers.clone()].iter().zip(&there[numbers.clone()]).map(|(one, other)| one - other);
            let apart: Vec<f64> = apart.collect();
            size(&apart) <= UNDONE * size(&state[numbers.clone()]).max(size(&middle[numbers]))
        };
        let of_attitudes = self.offsets.attitudes();
        if is_undone(0..of_attitudes) && is_undone(of_attitudes..head) {
            Ok(())
        } else {
            Err(SetupError::NotSelfAdjoint)
        }
    }
}
