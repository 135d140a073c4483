//! Checkpoints: states for a file, with all that a stepper needs to continue with the same bits.
//!
//! They need the feature `serde`. A [`Checkpoint`] holds numbers and none of this crate's types, so that it suits any
//! format of serde that preserves the bits of a float. [`State`] itself isn't deserialised: a checkpoint becomes a
//! state once the stepper that is to continue has checked it.

mod error;
mod fingerprint;

use alloc::string::String;
use alloc::vec::Vec;

use nalgebra::{SimdComplexField as _, SimdRealField as _};
use serde::{Deserialize, Serialize};

pub use error::CheckpointError;
pub use fingerprint::Storable;

use crate::groups::{Advected as _, LieGroup};
use crate::mechanics::{Effect, Group, Scalar};
use crate::motion::{ElapsedTime, Kept, Motion, Plan, State, StateOf, Stepper};
use crate::numbers::{Digest, Entries, Real, real, reported};
use fingerprint::Parameters;

/// The number of this layout; another layout has another number.
const FORMAT: u32 = 4;

/// A state for a file, by [`Stepper::checkpoint`]; [`Stepper::resume`] converts it back.
///
/// # Format
///
/// A map of names to numbers and lists of numbers, matrices row by row; units are those of the [`State`]. The lists
/// have the length that the scene and the method require. A text format must read floats to the last bit, as
/// `serde_json` does with its feature `float_roundtrip`; the digest detects one that doesn't.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint<T> {
    format: u32,
    /// The fingerprint of the terms' derivations and the scalar.
    scene: Digest,
    parameters: Vec<T>,
    /// The method's name, and the fingerprint of its constants.
    method: String,
    coefficients: Digest,
    step_size: T,
    steps: u64,
    attitude: Vec<T>,
    momentum: Vec<T>,
    advected: Vec<T>,
    /// The method's memory, and the time of steps of other lengths.
    kept: Vec<T>,
    /// The digest of all other fields.
    digest: Digest,
}

impl<T: Storable> Checkpoint<T> {
    /// The number of steps made.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    fn digested(&self) -> Digest {
        let mut digest = Digest::default();
        digest.number(u64::from(self.format));
        digest.number(self.scene.value());
        digest.text(&self.method);
        digest.number(self.coefficients.value());
        digest.number(self.step_size.bits());
        digest.number(self.steps);
        for (_, numbers) in self.lists() {
            digest.number(numbers.len() as u64);
            for number in numbers {
                digest.number(number.bits());
            }
        }
        digest
    }

    fn lists(&self) -> [(&'static str, &Vec<T>); 5] {
        [
            ("parameters", &self.parameters),
            ("attitude", &self.attitude),
            ("momentum", &self.momentum),
            ("advected", &self.advected),
            ("kept", &self.kept),
        ]
    }
}

/// # Wrap: checkpoints
impl<S: Effect<Scalar: Storable>, P: Plan<S>> Stepper<S, P> {
    /// The state for a file, with the whole memory of its method.
    #[must_use]
    pub fn checkpoint(&self, state: &StateOf<S, P>) -> Checkpoint<Scalar<S>> {
        let State { motion, kept, elapsed } = state;
        let (own, method) = (Parameters::of_scene(&self.scene), Parameters::of_plan(&self.plan));
        let mut numbers = Vec::new();
        (*kept, *elapsed).each(&mut |number| numbers.push(number));
        let mut checkpoint = Checkpoint {
            format: FORMAT,
            scene: own.fingerprint,
            parameters: own.values.iter().map(|(_, value)| *value).collect(),
            method: method.name(),
            coefficients: method.of_all(),
            step_size: self.step_size(),
            steps: motion.steps,
            attitude: list(&motion.attitude.matrix()),
            momentum: list(&motion.momentum),
            advected: list(&motion.advected),
            kept: numbers,
            digest: Digest::default(),
        };
        checkpoint.digest = checkpoint.digested();
        checkpoint
    }

    /// The state of a checkpoint, which continues with the same bits as the written one. An inertia that depends on
    /// advected parameters isn't checked again, as the digest implies that a stepper like this one wrote it.
    ///
    /// # Errors
    ///
    /// [`CheckpointError`] if the checkpoint belongs to another scene or method, or has other parameters or another
    /// step; if it isn't a state of this scene; and if a digit of it has changed.
    pub fn resume(&self, checkpoint: &Checkpoint<Scalar<S>>) -> Result<StateOf<S, P>, CheckpointError> {
        self.belongs(checkpoint)?;
        let attitude = Group::<S>::from_matrix_unchecked(unlisted("attitude", &checkpoint.attitude)?);
        let motion = Motion {
            attitude,
            momentum: unlisted("momentum", &checkpoint.momentum)?,
            advected: unlisted::<_, S::Advected>("advected", &checkpoint.advected)?,
            steps: checkpoint.steps,
        };
        let kept = remembered(&checkpoint.kept, &(self.plan.keep(&self.scene, &motion), ElapsedTime::nothing()))?;
        // Tolerance far above the rounding of any run, and far below the defect of other matrices.
        let allowed = Scalar::<S>::simd_default_epsilon().simd_sqrt();
        let defect = attitude.defect();
        let is_in_group = defect < allowed;
        if !is_in_group {
            return Err(CheckpointError::NotInGroup { defect: reported(defect) });
        }
        // The energy of a start belongs to the motion, not to the scene.
        let without = |w: S::Advected| self.scene.with_energy(&w, real(0.0)).map_or(w, |(w, _)| w);
        let [found, expected] = [motion.advected, self.scene.advected().seen_from(&attitude)].map(without);
        let (mut squared, mut size) = (real::<Scalar<S>>(0.0), real::<Scalar<S>>(0.0));
        for (stored, expected) in list(&found).into_iter().zip(list(&expected)) {
            squared += (stored - expected) * (stored - expected);
            size += expected * expected;
        }
        let is_seen = squared <= size * allowed * allowed;
        if !is_seen {
            return Err(CheckpointError::NotAdvected { distance: reported(squared.simd_sqrt()) });
        }
        // The digest is last, as every other error is more specific.
        if checkpoint.digest != checkpoint.digested() {
            return Err(CheckpointError::Altered);
        }
        let (kept, elapsed) = kept.ok_or(CheckpointError::NotKept)?;
        Ok(State { motion, kept, elapsed })
    }

    /// Checks that the checkpoint has this scene, these parameters, this method and this step.
    fn belongs(&self, checkpoint: &Checkpoint<Scalar<S>>) -> Result<(), CheckpointError> {
        if checkpoint.format != FORMAT {
            return Err(CheckpointError::AnotherFormat { found: checkpoint.format, known: FORMAT });
        }
        let own = Parameters::of_scene(&self.scene);
        if checkpoint.scene != own.fingerprint || checkpoint.parameters.len() != own.values.len() {
            return Err(CheckpointError::AnotherScene);
        }
        for (&stored, &(field, value)) in checkpoint.parameters.iter().zip(&own.values) {
            if stored.bits() != value.bits() {
                let (stored, own) = (reported(stored), reported(value));
                return Err(CheckpointError::AnotherParameter { field, stored, own });
            }
        }
        let method = Parameters::of_plan(&self.plan);
        if checkpoint.method != method.name() || checkpoint.coefficients != method.of_all() {
            return Err(CheckpointError::AnotherMethod { stored: checkpoint.method.clone(), own: method.name() });
        }
        if checkpoint.step_size.bits() != self.step_size().bits() {
            let (stored, own) = (reported(checkpoint.step_size), reported(self.step_size()));
            return Err(CheckpointError::AnotherStep { stored, own });
        }
        Ok(())
    }
}

/// A memory with the numbers of a checkpoint; `None` if no such memory can have them. `like` is any memory of the same
/// method, which fixes the count of numbers.
fn remembered<T: Storable, K: Kept<T>>(list: &[T], like: &K) -> Result<Option<K>, CheckpointError> {
    let mut expected = 0;
    like.each(&mut |_| expected += 1);
    readable("kept", list, expected)?;
    let mut numbers = list.iter();
    Ok(like.with_numbers(&mut |_| numbers.next().copied().unwrap_or_else(T::zero)))
}

fn list<T: Real>(entries: &impl Entries<T>) -> Vec<T> {
    let mut list = Vec::new();
    entries.each(&mut |entry| list.push(entry));
    list
}

fn unlisted<T: Storable, E: Entries<T>>(what: &'static str, list: &[T]) -> Result<E, CheckpointError> {
    let mut expected = 0;
    E::from_entries(&mut || {
        expected += 1;
        T::zero()
    });
    readable(what, list, expected)?;
    let mut numbers = list.iter();
    Ok(E::from_entries(&mut || numbers.next().copied().unwrap_or_else(T::zero)))
}

fn readable<T: Storable>(what: &'static str, list: &[T], expected: usize) -> Result<(), CheckpointError> {
    if list.len() != expected {
        return Err(CheckpointError::WrongSize { what, found: list.len(), expected });
    }
    if !list.iter().all(|&number| crate::numbers::is_finite(number)) {
        return Err(CheckpointError::NonFinite { what });
    }
    Ok(())
}
