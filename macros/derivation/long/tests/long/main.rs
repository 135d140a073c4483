//! Tests of the derivation that take longer than two seconds each.

#[allow(dead_code)] // other tests have the rest
#[path = "../../../tests/derivation/common/mod.rs"]
mod common;

mod determinism;
mod discretised;
mod fuzz;
mod generated;
mod mutations;
mod refused;
mod sizes;
mod time;
