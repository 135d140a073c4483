//! Eight heavy tops (3.13), one after another or in SIMD lanes.
//!
//! Their bodies, tilts and spins vary about the looping case of \[RDAE, figure 3.8\].

use liestep::numbers::{Lanes, Real};
use liestep::prelude::*;
use nalgebra::{RealField, UnitQuaternion, Vector3};

pub(crate) const TOPS: usize = 8;

/// (3.13) in principal axes.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * weight * w.dot(&(rho + F * rho)),
)]
#[derive(Clone)]
pub(crate) struct Top<T: Real> {
    pub(crate) J_d: DiagonalNonstandardInertia<T>,
    weight: T,
    rho: Vector3<T>,
    up: Vector3<T>,
}

/// The top with the given number, and its attitude and velocity.
#[allow(clippy::cast_precision_loss)] // a top's number, below eight
pub(crate) fn top<E: Real + RealField>(number: usize) -> (Top<E>, SO3<E>, Vector3<E>) {
    let vector = |x: f64, y: f64, z: f64| Vector3::new(x, y, z).map(nalgebra::convert::<f64, E>);
    let t = number as f64 / TOPS as f64;
    let moments = vector(3.0 + 0.2 * t, 3.0 - 0.3 * t, 4.0);
    let top = Top {
        J_d: DiagonalNonstandardInertia::from_principal_moments(moments).expect("a body"),
        weight: nalgebra::convert(9.81),
        rho: vector(0.0, 0.1 * t, 1.0),
        up: Vector3::z(),
    };
    let (tilt, precession, nutation, spin) = (0.8 + 0.1 * t, 3.0, 0.5, 10.0 - t);
    let attitude = UnitQuaternion::from_scaled_axis(vector(tilt, 0.0, 0.0)).into();
    (top, attitude, vector(nutation, precession * tilt.sin(), spin + precession * tilt.cos()))
}

/// The tops from `first` on, one in each lane, with their attitudes and velocities.
pub(crate) fn lanes<T: Real<Element: Real + RealField>>(first: usize) -> (Top<T>, SO3<T>, Vector3<T>) {
    let all: Vec<_> = (first..first + T::LANES).map(top::<T::Element>).collect();
    Lanes::gathered(&all).expect("they share nothing")
}
