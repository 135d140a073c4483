//! Tops that differ only in their kinetic term or order, with a common constructor.

use liestep::mechanics::Inertia;
use nalgebra::Vector3;
use workbench::heavy_top::declaration::HeavyTop;

use super::{CayleyTop, FourthOrderTop, LogTop, SixthOrderTop};

/// A top declared by its inertia about the pivot (kg m²), its weight (N), its centre of mass in the body's frame (m)
/// and the vertical.
pub trait Top: Sized {
    /// The top with these parameters.
    fn new(J: Inertia, weight: f64, rho: Vector3<f64>, up: Vector3<f64>) -> Self;

    /// The body of the declared top, under the same gravity.
    fn of(top: &HeavyTop) -> Self {
        Self::new(top.ordinary_inertia(), top.m * top.g, top.rho, top.up)
    }
}

macro_rules! tops {
    ($($top:ident)+) => {$(
        impl Top for $top {
            fn new(J: Inertia, weight: f64, rho: Vector3<f64>, up: Vector3<f64>) -> Self {
                Self { J, weight, rho, up }
            }
        }
    )+};
}

tops!(CayleyTop LogTop FourthOrderTop SixthOrderTop);
