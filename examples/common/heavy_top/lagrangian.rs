//! The declaration that the integrator is made from.

use liestep::{DiagonalNonstandardInertia, State, Stepper};
use nalgebra::Vector3;

use crate::common::run::{Method, Sample, Stopped};

/// A heavy top: the reduced discrete Lagrangian \[RDAE, (3.13)\].
// #[liestep::lagrangian(
//     group = SO3,
//     advected(w = up),
//     l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
//         - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
// )]
#[allow(non_snake_case)] // the paper's name
#[derive(Clone, Debug)]
pub(crate) struct HeavyTop {
    /// Nonstandard inertia about the pivot, kg m².
    pub(crate) J_d: DiagonalNonstandardInertia,
    /// Mass, kg.
    pub(crate) m: f64,
    /// Gravitational acceleration, m/s².
    pub(crate) g: f64,
    /// Centre of mass from the pivot, body frame, m.
    pub(crate) rho: Vector3<f64>,
    /// The vertical, in the inertial frame; `w` is the same vector seen from the body.
    pub(crate) up: Vector3<f64>,
}

/// A motion of the top with the derived integrator.
#[derive(Clone)]
pub(crate) struct Variational<'a> {
    pub(crate) stepper: &'a Stepper<HeavyTop>,
    pub(crate) state: State<liestep::SO3, Vector3<f64>>,
}

impl Method for Variational<'_> {
    fn advance(&mut self, steps: u64) -> Result<u64, Stopped> {
        let mut iterations = 0;
        for _ in 0..steps {
            match self.stepper.step(&mut self.state) {
                Ok(report) => iterations += u64::from(report.iterations),
                Err(cause) => return Err(Stopped { time: self.stepper.time(&self.state), cause }),
            }
        }
        Ok(iterations)
    }

    fn sample(&self) -> Sample {
        Sample { attitude: *self.state.attitude().as_matrix(), momentum: self.state.momentum() }
    }
}
