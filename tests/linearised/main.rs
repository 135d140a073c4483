//! Tangent maps, adjoints and what is made of them.

mod declared;
mod dual;
mod exponents;
mod force_gradients;
mod free_body;
mod inputs;
mod products;
mod random;
mod refused;
mod scenes;
mod structure;
