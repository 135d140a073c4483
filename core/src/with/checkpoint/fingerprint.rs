//! Fingerprints by which a checkpoint is compared with a stepper.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use serde::de::{Error as _, Unexpected};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::mechanics::{Effect, SceneVisitor};
use crate::motion::Plan;
use crate::numbers::{Digest, Real};

// A digest is stored as text, as not every format has numbers of 64 bits.
impl Serialize for Digest {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&format_args!("{self:?}"))
    }
}

impl<'de> Deserialize<'de> for Digest {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let value = u64::from_str_radix(&text, 16).ok().map(Self::from);
        value
            .filter(|value| format!("{value:?}") == text)
            .ok_or_else(|| D::Error::invalid_value(Unexpected::Str(&text), &"sixteen hexadecimal digits in lower case"))
    }
}

/// A scalar that is stored by its bits: `f64` or `f32`.
pub trait Storable: Real + PartialOrd + Serialize + for<'de> Deserialize<'de> {
    /// The bits; those of `f32` are in the lower half.
    fn bits(self) -> u64;
}

impl Storable for f64 {
    fn bits(self) -> u64 {
        self.to_bits()
    }
}

impl Storable for f32 {
    fn bits(self) -> u64 {
        u64::from(self.to_bits())
    }
}

/// The terms and parameters of a scene or a method.
pub(super) struct Parameters<T> {
    /// The fingerprint of the terms and the names of the parameters.
    pub(super) fingerprint: Digest,
    pub(super) values: Vec<(&'static str, T)>,
    names: Vec<&'static str>,
}

impl<T: Storable> Parameters<T> {
    fn nothing() -> Self {
        Self { fingerprint: Digest::default(), values: Vec::new(), names: Vec::new() }
    }

    pub(super) fn of_scene<S: Effect<Scalar = T>>(scene: &S) -> Self {
        let mut parameters = Self::nothing();
        parameters.fingerprint.number(size_of::<T>() as u64);
        scene.describe(&mut parameters);
        parameters
    }

    pub(super) fn of_plan<S: Effect<Scalar = T>, P: Plan<S>>(plan: &P) -> Self {
        let mut parameters = Self::nothing();
        plan.describe(&mut parameters);
        parameters
    }

    /// The terms without a line break, which are names; the term of a declared kinetic flow is its derivation.
    pub(super) fn name(&self) -> String {
        let names: Vec<_> = self.names.iter().copied().filter(|name| !name.contains('\n')).collect();
        names.join(", ")
    }

    /// The fingerprint of terms, names and values.
    pub(super) fn of_all(&self) -> Digest {
        let mut fingerprint = self.fingerprint;
        self.values.iter().for_each(|(_, value)| fingerprint.number(value.bits()));
        fingerprint
    }
}

impl<T> SceneVisitor<T> for Parameters<T> {
    fn term(&mut self, derivation: &'static str) {
        self.fingerprint.text(derivation);
        self.names.push(derivation);
    }

    fn parameter(&mut self, field: &'static str, value: T) {
        self.fingerprint.text(field);
        self.values.push((field, value));
    }
}
