//! Checkpoints: a state as it is written to a file, with what is needed to go on with the same bits.
//!
//! Only with the feature `serde`. A [`Checkpoint`] holds numbers and nothing of this crate's types, so that any format
//! of serde takes it that keeps the bits of a float. [`State`] itself can't be read from a file: what is read counts as
//! a state once the stepper that is to go on has looked at it.

mod error;
mod fingerprint;

use core::fmt::Debug;

use nalgebra::{SimdComplexField as _, SimdRealField as _};
use serde::{Deserialize, Serialize};

pub use error::CheckpointError;

use crate::groups::{Advected as _, LieGroup};
use crate::mechanics::{Effect, Group, Matrix, Scalar, Vector};
use crate::motion::{State, Stepper};
use crate::numbers::{Entries, Real, real, reported};
use crate::solving::{DIFFERENCES, History};
use crate::with::compensated::{Carry, CompensatedState, CompensatedStepper};
use fingerprint::{Fingerprint, Parameters};

/// What the numbers below mean; another layout has another number.
const FORMAT: u32 = 2;

/// A scalar that is stored by its bits: `f64` or `f32`.
pub trait Stored: Real + PartialOrd + Serialize + for<'de> Deserialize<'de> {
    /// The bits, of `f32` in the lower half.
    fn bits(self) -> u64;
}

impl Stored for f64 {
    fn bits(self) -> u64 {
        self.to_bits()
    }
}

impl Stored for f32 {
    fn bits(self) -> u64 {
        u64::from(self.to_bits())
    }
}

/// A state in a file, by [`Stepper::checkpoint`]; [`Stepper::resume`] makes a state of it.
///
/// # Format
///
/// A map of names to numbers and lists of numbers, matrices row by row; units are those of the [`State`]. The lists
/// have the length that the scene calls for. A text format must read floats to the last bit, as `serde_json` does with
/// its feature `float_roundtrip`; one that doesn't is found out by the digest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint<T> {
    format: u32,
    /// Of the terms' derivations and the scalar.
    scene: Fingerprint,
    parameters: Vec<T>,
    step_size: T,
    steps: u64,
    attitude: Vec<T>,
    momentum: Vec<T>,
    advected: Vec<T>,
    coordinates: Vec<T>,
    guess: Vec<T>,
    /// How many increments the guess is made of, and their differences; where nothing is dear, none.
    increments: u64,
    differences: Vec<T>,
    /// What a compensated stepper carries for attitude, momentum and advected parameters; otherwise nothing.
    carry: Vec<T>,
    /// Of everything above.
    digest: Fingerprint,
}

/// The carries of attitude and momentum, and of the advected parameters.
type CarryParts<L> = ((Matrix<L>, Vector<L>), <L as Effect>::Advected);

impl<T: Stored> Checkpoint<T> {
    /// The number of steps made.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    fn digested(&self) -> Fingerprint {
        let mut digest = Fingerprint::default();
        digest.number(u64::from(self.format));
        digest.number(self.scene.value());
        digest.number(self.step_size.bits());
        digest.number(self.steps);
        digest.number(self.increments);
        for (_, numbers) in self.lists() {
            digest.number(numbers.len() as u64);
            for number in numbers {
                digest.number(number.bits());
            }
        }
        digest
    }

    fn lists(&self) -> [(&'static str, &Vec<T>); 8] {
        [
            ("parameters", &self.parameters),
            ("attitude", &self.attitude),
            ("momentum", &self.momentum),
            ("advected", &self.advected),
            ("coordinates", &self.coordinates),
            ("guess", &self.guess),
            ("differences", &self.differences),
            ("carry", &self.carry),
        ]
    }
}

impl<L: Effect<Scalar: Stored>> Stepper<L> {
    /// The state for a file.
    #[must_use]
    pub fn checkpoint(&self, state: &State<Group<L>, L::Advected>) -> Checkpoint<Scalar<L>> {
        written(self, state, Vec::new())
    }

    /// The state of a checkpoint, which goes on with the same bits as the one that was written.
    ///
    /// # Errors
    ///
    /// [`CheckpointError`] where the checkpoint is of another scene, has other parameters or another step, or was made
    /// by a compensated stepper; where it isn't a state of this scene; and where a digit of it has changed.
    pub fn resume(&self, checkpoint: &Checkpoint<Scalar<L>>) -> Result<State<Group<L>, L::Advected>, CheckpointError> {
        let state = read(self, checkpoint)?;
        if !checkpoint.carry.is_empty() {
            return Err(CheckpointError::AnotherSummation { compensated: true });
        }
        intact(checkpoint).map(|()| state)
    }
}

impl<L: Effect<Scalar: Stored>> CompensatedStepper<L> {
    /// The state for a file, with what its sums carry.
    #[must_use]
    pub fn checkpoint(&self, state: &CompensatedState<Group<L>, L::Advected>) -> Checkpoint<Scalar<L>> {
        let Carry { attitude, momentum, advected } = &state.carry;
        let carry = [list(attitude), list(momentum), list(advected)].concat();
        written(self.stepper(), &state.state, carry)
    }

    /// As [`Stepper::resume`].
    ///
    /// # Errors
    ///
    /// As [`Stepper::resume`], and where the checkpoint was made by a stepper without compensation, whose state
    /// [`CompensatedState::from`] takes.
    pub fn resume(
        &self,
        checkpoint: &Checkpoint<Scalar<L>>,
    ) -> Result<CompensatedState<Group<L>, L::Advected>, CheckpointError> {
        let state = read(self.stepper(), checkpoint)?;
        if checkpoint.carry.is_empty() {
            return Err(CheckpointError::AnotherSummation { compensated: false });
        }
        let ((attitude, momentum), advected) = unlisted::<Scalar<L>, CarryParts<L>>("carry", &checkpoint.carry)?;
        intact(checkpoint)?;
        Ok(CompensatedState { state, carry: Carry { attitude, momentum, advected } })
    }
}

fn written<L: Effect<Scalar: Stored>>(
    stepper: &Stepper<L>,
    state: &State<Group<L>, L::Advected>,
    carry: Vec<Scalar<L>>,
) -> Checkpoint<Scalar<L>> {
    let own = Parameters::of(stepper.lagrangian());
    let (increments, differences) = state.history.parts();
    let mut checkpoint = Checkpoint {
        format: FORMAT,
        scene: own.scene,
        parameters: own.values.iter().map(|(_, value)| *value).collect(),
        step_size: stepper.step_size(),
        steps: state.steps,
        attitude: list(&state.attitude.matrix()),
        momentum: list(&state.momentum),
        advected: list(&state.advected),
        coordinates: list(&(state.half + state.half)),
        guess: list(&(state.half_guess + state.half_guess)),
        increments: increments as u64,
        differences: differences.iter().flat_map(list).collect(),
        carry,
        digest: Fingerprint::default(),
    };
    checkpoint.digest = checkpoint.digested();
    checkpoint
}

fn read<L: Effect<Scalar: Stored>>(
    stepper: &Stepper<L>,
    checkpoint: &Checkpoint<Scalar<L>>,
) -> Result<State<Group<L>, L::Advected>, CheckpointError> {
    belongs(stepper, checkpoint)?;
    let attitude = Group::<L>::from_matrix_unchecked(unlisted("attitude", &checkpoint.attitude)?);
    let history = remembered::<L>(checkpoint)?;
    let state = State {
        attitude,
        momentum: unlisted("momentum", &checkpoint.momentum)?,
        advected: unlisted::<_, L::Advected>("advected", &checkpoint.advected)?,
        half: unlisted::<_, Vector<L>>("coordinates", &checkpoint.coordinates)? * real(0.5),
        half_guess: unlisted::<_, Vector<L>>("guess", &checkpoint.guess)? * real(0.5),
        history,
        steps: checkpoint.steps,
    };
    // Far more than rounding makes in any number of steps, far less than what isn't an attitude.
    let allowed = Scalar::<L>::simd_default_epsilon().simd_sqrt();
    let defect = attitude.defect();
    let is_in_group = defect < allowed;
    if !is_in_group {
        return Err(CheckpointError::NotInGroup { defect: reported(defect) });
    }
    let expected = stepper.lagrangian().advected().seen_from(&attitude);
    let (mut squared, mut size) = (real::<Scalar<L>>(0.0), real::<Scalar<L>>(0.0));
    for (stored, expected) in list(&state.advected).into_iter().zip(list(&expected)) {
        squared += (stored - expected) * (stored - expected);
        size += expected * expected;
    }
    let is_seen = squared <= size * allowed * allowed;
    if !is_seen {
        return Err(CheckpointError::NotAdvected { distance: reported(squared.simd_sqrt()) });
    }
    Ok(state)
}

/// What the guess is made of.
fn remembered<L: Effect<Scalar: Stored>>(
    checkpoint: &Checkpoint<Scalar<L>>,
) -> Result<History<Vector<L>>, CheckpointError> {
    let (what, found) = ("differences", checkpoint.differences.len());
    let size = <Group<L> as LieGroup>::DIMENSION;
    // Of more increments than these no more is remembered.
    let increments = usize::try_from(checkpoint.increments).unwrap_or(usize::MAX).min(DIFFERENCES + 1);
    let expected = size * increments.saturating_sub(1);
    if found != expected {
        return Err(CheckpointError::WrongSize { what, found, expected });
    }
    let differences: Result<Vec<Vector<L>>, _> =
        checkpoint.differences.chunks(size).map(|chunk| unlisted(what, chunk)).collect();
    Ok(History::of(increments, &differences?))
}

/// The checkpoint is of this scene, with these parameters and this step.
fn belongs<L: Effect<Scalar: Stored>>(
    stepper: &Stepper<L>,
    checkpoint: &Checkpoint<Scalar<L>>,
) -> Result<(), CheckpointError> {
    if checkpoint.format != FORMAT {
        return Err(CheckpointError::AnotherFormat { found: checkpoint.format, known: FORMAT });
    }
    let own = Parameters::of(stepper.lagrangian());
    if checkpoint.scene != own.scene || checkpoint.parameters.len() != own.values.len() {
        return Err(CheckpointError::AnotherScene);
    }
    for (&stored, &(field, value)) in checkpoint.parameters.iter().zip(&own.values) {
        if stored.bits() != value.bits() {
            let (stored, own) = (reported(stored), reported(value));
            return Err(CheckpointError::AnotherParameter { field, stored, own });
        }
    }
    if checkpoint.step_size.bits() != stepper.step_size().bits() {
        let (stored, own) = (reported(checkpoint.step_size), reported(stepper.step_size()));
        return Err(CheckpointError::AnotherStep { stored, own });
    }
    Ok(())
}

/// Last, as every other error says more.
fn intact<T: Stored>(checkpoint: &Checkpoint<T>) -> Result<(), CheckpointError> {
    if checkpoint.digest == checkpoint.digested() { Ok(()) } else { Err(CheckpointError::Altered) }
}

fn list<T: Real>(entries: &impl Entries<T>) -> Vec<T> {
    let mut list = Vec::new();
    entries.each(&mut |entry| list.push(entry));
    list
}

/// How many scalars there are.
fn count<T: Real, E: Entries<T>>() -> usize {
    let mut count = 0;
    E::from_entries(&mut || {
        count += 1;
        T::zero()
    });
    count
}

fn unlisted<T: Stored, E: Entries<T>>(what: &'static str, list: &[T]) -> Result<E, CheckpointError> {
    let expected = count::<T, E>();
    if list.len() != expected {
        return Err(CheckpointError::WrongSize { what, found: list.len(), expected });
    }
    if !list.iter().all(|&number| crate::numbers::is_finite(number)) {
        return Err(CheckpointError::NonFinite { what });
    }
    let mut numbers = list.iter();
    Ok(E::from_entries(&mut || numbers.next().copied().unwrap_or_else(T::zero)))
}
