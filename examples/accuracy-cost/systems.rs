//! The declared Lagrangians.

// The letters of the field.
#![allow(non_snake_case)]
// Files that are shared with the tests and with the other examples.
#![allow(dead_code, unreachable_pub)]

#[path = "../declarations/fourth_order_top.rs"]
mod fourth_order_top;
#[path = "../declarations/free_body.rs"]
mod free_body;
#[path = "../declarations/heavy_top.rs"]
mod heavy_top;
#[path = "../declarations/sixth_order_top.rs"]
mod sixth_order_top;

pub(crate) use fourth_order_top::FourthOrderTop;
pub(crate) use free_body::FreeBody;
pub(crate) use heavy_top::HeavyTop;
pub(crate) use sixth_order_top::SixthOrderTop;

pub(crate) use liestep::effects::{FourthOrderBody, SixthOrderBody};
