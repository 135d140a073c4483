//! Scalars that a checkpoint stores.

use serde::{Deserialize, Serialize};

use crate::numbers::Real;

/// A scalar that is stored by its bits: `f64` or `f32`.
pub trait Storable: Real + PartialOrd + Serialize + for<'de> Deserialize<'de> {
    /// The bits, of `f32` in the lower half.
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
