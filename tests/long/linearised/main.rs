//! Tangent maps, adjoints, and their applications.

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
