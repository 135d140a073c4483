//! Which engine when.
