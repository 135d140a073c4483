//! The three precessions of \[RDAE, figures 3.8 to 3.10\], and the two readings of its inertia.

use std::fmt;

use liestep::mechanics::{DiagonalNonstandardInertia, InertiaError};
use nalgebra::{UnitQuaternion, Vector3};

use super::declaration::HeavyTop;

/// An initial condition, named as in the thesis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Case {
    /// Figure 3.8: φ' = 3, θ' = 0.5, ψ' = 10 rad/s.
    Looping,
    /// Figure 3.9: φ' = 0, θ' = 0, ψ' = 10 rad/s.
    Cuspidal,
    /// Figure 3.10: φ' = 1, θ' = 0.01, ψ' = 10 rad/s.
    Unidirectional,
}

/// The meaning of `diag(2, 2, 1)` in the thesis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reading {
    /// The nonstandard inertia `J_d`, as in (3.13).
    A,
    /// The ordinary inertia `J`, which reproduces the figures of the thesis.
    B,
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Self::NAMED.iter().filter(|(_, case)| case == self).try_for_each(|(name, _)| f.write_str(name))
    }
}

impl fmt::Display for Reading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::A => "J_d = diag(2, 2, 1)",
            Self::B => "J = diag(2, 2, 1)",
        })
    }
}

impl Case {
    /// The cases with their names on the command line.
    pub const NAMED: [(&str, Self); 3] =
        [("looping", Self::Looping), ("cuspidal", Self::Cuspidal), ("unidirectional", Self::Unidirectional)];

    /// The figure of the thesis that displays the case.
    pub fn figure(self) -> &'static str {
        match self {
            Self::Looping => "3.8",
            Self::Cuspidal => "3.9",
            Self::Unidirectional => "3.10",
        }
    }

    /// The attitude at `φ = ψ = 0`, and the body velocity in rad/s.
    pub fn start(self) -> (UnitQuaternion<f64>, Vector3<f64>) {
        let (precession, nutation, spin) = match self {
            Self::Looping => (3.0, 0.5, 10.0),
            Self::Cuspidal => (0.0, 0.0, 10.0),
            Self::Unidirectional => (1.0, 0.01, 10.0),
        };
        let tilt = 0.8_f64;
        let velocity = Vector3::new(nutation, precession * tilt.sin(), spin + precession * tilt.cos());
        (UnitQuaternion::from_axis_angle(&Vector3::x_axis(), tilt), velocity)
    }

    /// A note on the case whose motion differs from its name in the thesis.
    pub fn caveat(self, reading: Reading) -> Option<&'static str> {
        (self == Self::Unidirectional && reading == Reading::A).then_some(
            "Note: with J_d = diag(2, 2, 1) in (3.13) this third case of the thesis is looping: φ' runs from −0.60 to\n\
             1.00 rad/s. It is unidirectional with diag(2, 2, 1) as the ordinary inertia: --reading b.",
        )
    }
}

impl Reading {
    /// The readings with their names on the command line.
    pub const NAMED: [(&str, Self); 2] = [("a", Self::A), ("b", Self::B)];

    /// The top of the thesis, m = 1 kg, ρ = e₃, g = 9.81 m/s².
    pub fn top(self) -> Result<HeavyTop, InertiaError> {
        let printed = Vector3::new(2.0, 2.0, 1.0);
        let inertia = match self {
            Self::A => DiagonalNonstandardInertia::from_diagonal(printed)?,
            Self::B => DiagonalNonstandardInertia::from_principal_moments(printed)?,
        };
        Ok(HeavyTop { J_d: inertia, m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() })
    }
}
