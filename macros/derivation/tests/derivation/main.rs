//! Tests of the derivation: texts of declarations with what is derived or refused, and each room by itself.

#[allow(dead_code)] // long tests have the rest
mod common;

mod continuous;
mod determinism;
mod group;
mod higher_order;
mod mistakes;
mod names;
mod not_quadratic;
mod own_group;
mod program;
mod rooms;
mod staged;
mod symbolic;
mod texts;
mod verify;
mod whole;
