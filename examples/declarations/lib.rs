//! Declared systems, one per file, for examples of the derivation and for the tests.

// Public items need no full documentation, as only this repository uses them.
#![allow(missing_docs, clippy::missing_errors_doc, clippy::missing_panics_doc)]
#![allow(clippy::must_use_candidate, clippy::return_self_not_must_use)]

mod alike;
mod cayley_top;
mod continuous_top;
mod disk;
mod double_pendulum;
mod elastic_flow;
mod flyer;
mod fourth_order_top;
mod free_body;
mod full_top;
mod gyrostat;
mod log_top;
mod log_trace_top;
mod magnet;
pub mod motions;
mod needle;
mod orbiting_body;
mod relativistic_particle;
mod rods;
mod satellite;
mod sixth_order_top;
mod sleigh;
mod sliding_top;
mod spring;
mod strut;
mod suslov;
mod suspended_load;
mod tethered_plate;
mod top_on_cart;
mod tops;
mod torquer;
mod two_bodies;
mod underwater_body;

pub use alike::Alike;
pub use cayley_top::CayleyTop;
pub use continuous_top::ContinuousTop;
pub use disk::{FallingDisk, Rolling};
pub use double_pendulum::DoublePendulum;
pub use elastic_flow::ElasticFlow;
pub use flyer::{FluidDrag, Flyer, Thruster};
pub use fourth_order_top::FourthOrderTop;
pub use free_body::FreeBody;
pub use full_top::FullTop;
pub use gyrostat::Gyrostat;
pub use log_top::LogTop;
pub use log_trace_top::LogTraceTop;
pub use magnet::Magnet;
pub use motions::Motion;
pub use needle::{EqualNeedle, Needle};
pub use orbiting_body::OrbitingBody;
pub use relativistic_particle::RelativisticParticle;
pub use rods::{FallingBody, FloatingBody, PointSpring, RodElement};
pub use satellite::Satellite;
pub use sixth_order_top::SixthOrderTop;
pub use sleigh::{Blade, Plate};
pub use sliding_top::SlidingTop;
pub use spring::Spring;
pub use strut::Strut;
pub use suslov::Suslov;
pub use suspended_load::SuspendedLoad;
pub use tethered_plate::TetheredPlate;
pub use top_on_cart::TopOnCart;
pub use tops::Top;
pub use torquer::Torquer;
pub use two_bodies::TwoBodies;
pub use underwater_body::UnderwaterBody;

// The first example declares this top.
pub use workbench::heavy_top::declaration::HeavyTop;

// The library itself declares these bodies.
pub use liestep::effects::{FourthOrderBody, SixthOrderBody};
