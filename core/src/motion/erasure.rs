//! A typed stepper as a propagator: its states are read from numbers, and written to them.

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;

use crate::error::{SetupError, StepError};
use crate::groups::LieGroup;
use crate::mechanics::{Effect, Group, Vector};
use crate::motion::any::{AnyStepper, length, numbers, read};
use crate::motion::integrator::Integrator;
use crate::motion::kept::Kept;
use crate::motion::plan::{Cost, Plan};
use crate::motion::propagator::{Layout, Propagator};
use crate::motion::report::StepReport;
use crate::motion::state::{ElapsedTime, State};
use crate::motion::stepper::{StateOf, Stepper};
use crate::motion::summation::{Motion, MotionOf};
use crate::numbers::Entries as _;

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
    fn write(motion: &MotionOf<S>, memory: Option<(&P::Kept, &ElapsedTime<f64>)>, state: &mut [f64]) {
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
        Self::write(&state.motion, Some((&state.kept, &state.elapsed)), &mut numbers);
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
            Self::write(&own.motion, Some((&own.kept, &own.elapsed)), state);
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

    fn step_forced(&self, state: &mut [f64], force: &[f64]) -> Result<StepReport, StepError> {
        if force.len() != self.layout.components() {
            return Err(StepError::NonFinite { what: "control force" });
        }
        // Some methods have the momentum in their memory.
        self.change(state, |own| self.stepper.forced(own, &read::<Vector<S>>(force)))
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
                Self::write(motion, None, &mut reached);
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
