//! Clocks: lengths of steps that are prescribed beforehand.

use alloc::vec::Vec;
use core::f64::consts::TAU;

use super::orbit::orbit;
use super::varied::{Lengths, VariedSteps};
use crate::error::SetupError;
use crate::mechanics::{Effect, SceneVisitor, Vector};
use crate::motion::{ElapsedTime, MotionOf, Plan, Steerable, Stepper, Variable};

/// Prescribed lengths of steps, `h_k = h c_k`: the `c_k`, one after the other or in rounds.
///
/// Each step is variational with its own length, so that momentum maps and the Poisson structure are conserved. The
/// time of a step follows from its number.
///
/// # Source
///
/// E. Hairer, C. Lubich and G. Wanner, *Geometric Numerical Integration*, 2nd edition, VIII.1 and VIII.2.
#[derive(Clone, Debug, PartialEq)]
pub struct Clock {
    lengths: Vec<f64>,
    /// The partial sums of the lengths, from zero to the sum of all.
    times: Vec<f64>,
    is_repeated: bool,
}

impl Clock {
    /// A clock of lengths in units of the stepper's `h`, which ends after the last.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] if there is no length, or one isn't positive and finite.
    pub fn of_lengths(lengths: impl IntoIterator<Item = f64>) -> Result<Self, SetupError> {
        let lengths: Vec<f64> = lengths.into_iter().collect();
        let (mut sum, mut times) = (ElapsedTime::nothing(), [0.0].to_vec());
        times.extend(lengths.iter().map(|&length| {
            sum.add(length);
            sum.sum
        }));
        let is_usable = !lengths.is_empty() && lengths.iter().all(|&length| length > 0.0) && sum.sum.is_finite();
        if !is_usable {
            let cause = "has no length, or one that isn't positive and finite";
            return Err(SetupError::Parameter { field: "clock", cause });
        }
        Ok(Self { lengths, times, is_repeated: false })
    }

    /// The clock with its lengths repeated round after round.
    #[must_use]
    pub fn repeated(self) -> Self {
        Self { is_repeated: true, ..self }
    }

    /// A clock for a Kepler orbit, `dt ∝ r^{3/2}`, from pericentre on and round after round: for a stepper with
    /// `h = 1`, in the unit of the period. Its steps are symmetric about both apsides.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] if the eccentricity isn't at least 0 and below 1, the period isn't positive and
    /// finite, or there is no step.
    pub fn orbit(eccentricity: f64, period: f64, steps: u32) -> Result<Self, SetupError> {
        Self::orbit_from(0.0, eccentricity, period, steps)
    }

    /// A clock like [`orbit`](Self::orbit) that begins at a mean anomaly, rad.
    ///
    /// # Errors
    ///
    /// The errors of [`orbit`](Self::orbit), and [`SetupError::Parameter`] if the anomaly isn't finite.
    pub fn orbit_from(anomaly: f64, eccentricity: f64, period: f64, steps: u32) -> Result<Self, SetupError> {
        let refused = |field, cause| Err(SetupError::Parameter { field, cause });
        if !anomaly.is_finite() {
            return refused("anomaly", "isn't finite");
        }
        if !(0.0..1.0).contains(&eccentricity) {
            return refused("eccentricity", "isn't that of an ellipse");
        }
        if !(period > 0.0 && period.is_finite()) {
            return refused("period", "isn't positive and finite");
        }
        if steps == 0 {
            return refused("steps", "is zero");
        }
        Self::of_lengths(orbit(anomaly % TAU, eccentricity, period, steps)).map(Self::repeated)
    }

    /// A clock with the lengths back from this step to the first, which retrace a motion: `None` if the clock ends
    /// before this step.
    #[must_use]
    pub fn reversed(&self, step: u64) -> Option<Self> {
        let round = self.lengths.len() as u64;
        if !self.is_repeated {
            let steps = usize::try_from(step).ok().filter(|&steps| steps <= self.lengths.len())?;
            return Self::of_lengths(self.lengths[..steps].iter().rev().copied()).ok();
        }
        let mut lengths: Vec<f64> = self.lengths.iter().rev().copied().collect();
        lengths.rotate_left(usize::try_from((round - step % round) % round).ok()?);
        Self::of_lengths(lengths).map(Self::repeated).ok()
    }

    /// The length of a step, numbered from zero, in units of the stepper's `h`; none after the last.
    #[must_use]
    pub fn length(&self, step: u64) -> Option<f64> {
        self.lengths.get(self.place(step).1).copied()
    }

    /// The length of the step before one of this number; before the first, of a clock of rounds, that of the last.
    #[must_use]
    pub fn length_before(&self, step: u64) -> Option<f64> {
        match step.checked_sub(1) {
            None => self.lengths.last().copied().filter(|_| self.is_repeated),
            Some(before) => self.length(before),
        }
    }

    /// The time after this number of steps, in units of the stepper's `h`; NaN after the last.
    #[must_use]
    #[allow(clippy::cast_precision_loss)] // a number of rounds
    pub fn time(&self, steps: u64) -> f64 {
        let (rounds, place) = self.place(steps);
        let [within, round] = [self.times.get(place), self.times.last()].map(|time| time.copied().unwrap_or(f64::NAN));
        round * rounds as f64 + within
    }

    /// The number of a step's round, and its place in the round.
    fn place(&self, step: u64) -> (u64, usize) {
        let round = self.lengths.len() as u64;
        let rounds = if self.is_repeated { step / round } else { 0 };
        (rounds, usize::try_from(step - rounds * round).unwrap_or(usize::MAX))
    }
}

/// # Wrap: prescribed lengths
impl<S: Effect<Scalar = f64>, P: Plan<S>> Stepper<S, P> {
    /// Steps with the lengths of a clock, in units of the method's `h`.
    ///
    /// A clock that is adapted to the motion, as `dt ∝ r^{3/2}` along an orbit, saves many steps; [the
    /// chapter](crate::guide::varying) has measurements, and cases in which it saves none. The energy isn't nearly
    /// conserved if a clock resonates with the motion. After the last length of a clock that isn't repeated a step is
    /// [`StepError::NoLength`](crate::StepError::NoLength).
    ///
    /// Recordings, events, checkpoints and [prescribed values](Self::driven) work with it. A body in lanes and
    /// derivatives of a motion need equal steps, and are refused; so are [`inverse`](Self::inverse), which a
    /// [reversed](Clock::reversed) clock replaces, and a time before a state's.
    ///
    /// A processed splitting doesn't compile with it:
    ///
    /// ```compile_fail,E0277
    /// use liestep::effects::RigidBody;
    /// use liestep::methods::{ExactBody, ProcessedScheme};
    /// use liestep::prelude::*;
    /// use liestep::with::Clock;
    ///
    /// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5)).unwrap();
    /// let flow = ExactBody::new(&J_d.to_inertia());
    /// let stepper = Stepper::processed(RigidBody { J_d }, 1.0, flow, ProcessedScheme::FOUR_A).unwrap();
    /// let _ = stepper.with_clock(Clock::orbit(0.7, 6000.0, 400).unwrap());
    /// ```
    #[must_use]
    pub fn with_clock(self, clock: Clock) -> Stepper<S, VariedSteps<P, Clock>>
    where
        P: Variable<S>,
    {
        self.varied(clock)
    }
}

impl<S: Effect<Scalar = f64>, P: Steerable<S> + Variable<S>> Steerable<S> for VariedSteps<P, Clock> {
    delegate_plan!(plan, |kept| kept.0; see);
}

impl<S: Effect<Scalar = f64>> Lengths<S> for Clock {
    type Memory = ();
    const COUNTED: bool = true;

    fn begin(&self) {}

    fn length(
        &self,
        unit: f64,
        motion: &MotionOf<S>,
        _velocity: impl FnOnce() -> Vector<S>,
        ((), is_ahead): (&(), bool),
    ) -> f64 {
        let length = if is_ahead { self.length(motion.steps) } else { self.length_before(motion.steps) };
        length.map_or(f64::NAN, |length| unit * length)
    }

    fn after(&self, _: [f64; 2], _: &MotionOf<S>, _: impl FnOnce() -> Vector<S>, (): &()) {}

    fn time(&self, steps: u64, unit: f64, (): &()) -> f64 {
        unit * Self::time(self, steps)
    }

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        visitor.term(if self.is_repeated { "with a clock of rounds" } else { "with a clock" });
        self.lengths.iter().for_each(|&length| visitor.parameter("length", length));
    }
}
