//! The tops and free bodies that the tests integrate.

pub use declarations::{FreeBody, FullTop, HeavyTop};
