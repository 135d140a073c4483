//! Tangent maps, adjoints and what is made of them.

#![allow(non_snake_case)] // the letters of the field

mod declared;
mod dual;
mod exponents;
mod force_gradients;
mod free_body;
mod products;
mod random;
mod refused;
mod scenes;
mod structure;
