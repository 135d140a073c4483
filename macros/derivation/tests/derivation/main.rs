//! Tests of the derivation: texts of declarations with what is derived or refused, and each room by itself.

#[allow(dead_code)] // long tests have the rest
mod common;

mod continuous;
mod determinism;
mod discretised_bodies;
mod group;
mod higher_order;
mod mistakes;
mod names;
mod not_quadratic;
mod own_group;
mod printed;
mod program;
mod right;
mod rooms;
mod several_bodies;
mod staged;
mod symbolic;
mod tour;
mod verify;
mod whole;
