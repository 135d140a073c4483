//! S6: kinetic terms whose momentum equation has a solution at every step.

use declarations::{CayleyTop, LogTraceTop};
use liestep::Stepper;
use liestep::mechanics::Inertia;
use nalgebra::{UnitQuaternion, Vector3};
use workbench::measure::greater;

use crate::row::{Effort, Failure, Row};

pub(crate) fn s6(_: Effort) -> Result<Row, Failure> {
    let (h, velocity) = (0.1, Vector3::new(0.5, 1.0, 24.6));
    let (weight, rho, up) = (9.81, Vector3::z(), Vector3::z());
    let tilted = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
    let J = Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0))?;
    let cayley = Stepper::new(CayleyTop { J, weight, rho, up }, h)?;
    let mut state = cayley.start(tilted, velocity)?;
    let vertical = state.momentum_along(&up);
    let mut moved = 0.0;
    for _ in 0..1000 {
        cayley.step(&mut state)?;
        moved = greater(moved, (state.momentum_along(&up) / vertical - 1.0).abs());
    }

    let transverse = 3.0;
    let mut drift = 0.0;
    for (h, velocity) in [(h, velocity), (h, Vector3::new(0.5, 2.0, 12.0)), (0.01, Vector3::new(0.5, 2.0, 12.0))] {
        let log_trace = Stepper::new(LogTraceTop { I1: transverse, weight, rho, up }, h)?;
        // An integral of this discrete top, [Bobenko and Suris 1999].
        let energy = |p: Vector3<f64>, w: Vector3<f64>| {
            let mixed = 0.5 * h * weight / transverse * p.dot(&w.cross(&rho));
            p.norm_squared() / (2.0 * transverse) + weight * w.dot(&rho) + mixed
        };
        let mut state = log_trace.start(tilted, velocity)?;
        let start = energy(state.momentum(), state.advected());
        for _ in 0..10_000 {
            log_trace.step(&mut state)?;
            drift = greater(drift, (energy(state.momentum(), state.advected()) / start - 1.0).abs());
        }
    }
    let row =
        Row::new("S6", "Cayley and log-trace kinetic terms at h Ω = 2.46", "solved; E_h of the log-trace top to 1e-12")
            .at_most("Cayley, 1000 steps solved: vertical momentum", moved, 1e-12)
            .at_most("log-trace, 10⁴ steps solved: E_h", drift, 1e-12);
    Ok(row)
}
