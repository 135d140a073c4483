//! P1: the step is a Poisson map.

use declarations::{
    CayleyTop, FourthOrderTop, FullTop, HeavyTop, LogTop, LogTraceTop, Motion, SixthOrderTop, Top as _,
};
use liestep::SO3;
use liestep::laws::samples::Random;
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::motion::DiscreteLiePoisson;
use nalgebra::Vector3;
use workbench::heavy_top::rk4::{Body, OnQuaternion};
use workbench::measure::greater;
use workbench::run::Method as _;

use crate::poisson::{Phase, defect};
use crate::row::{Effort, Failure, Row, short};

const H: f64 = 0.1;

/// Momenta of velocities of about 3 rad/s, and verticals of length one.
fn phases(moments: &Vector3<f64>) -> Vec<Phase> {
    let mut random = Random::new(11);
    let phase = |_| {
        let (velocity, w): (Vector3<f64>, Vector3<f64>) = (random.sample(), random.sample());
        (moments.component_mul(&velocity) * 3.0, w.normalize())
    };
    (0..5).map(phase).collect()
}

fn worst<L>(lagrangian: L, phases: &[Phase]) -> Result<f64, Failure>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Regular,
{
    let flow = DiscreteLiePoisson::new(lagrangian, H)?;
    let map = |(momentum, w): &Phase| {
        let step = flow.step(momentum, w, &Vector3::zeros()).ok()?;
        Some((step.momentum, step.advected))
    };
    Ok(phases.iter().map(|z| defect(map, z)).fold(0.0, greater))
}

pub(crate) fn p1(_: Effort) -> Result<Row, Failure> {
    let top = Motion::chaotic().top;
    let phases = phases(&top.moments());
    let axes = nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1).into_inner();
    let log_trace = LogTraceTop { I1: 3.0, weight: top.m * top.g, rho: top.rho, up: top.up };
    let row =
        Row::new("P1", "Poisson structure, h = 0.1, asymmetric top", "defect below 1e-10 (six-point differences)")
            .at_most("(3.13)", worst(top.clone(), &phases)?, 1e-10)
            .at_most("full tensor", worst(FullTop::in_axes(&top, &axes), &phases)?, 1e-10)
            .at_most("Cayley", worst(CayleyTop::of(&top), &phases)?, 1e-10)
            .at_most("geodesic", worst(LogTop::of(&top), &phases)?, 1e-10)
            .at_most("log-trace", worst(log_trace, &phases)?, 1e-10)
            .at_most("L4", worst(FourthOrderTop::of(&top), &phases)?, 1e-10)
            .at_most("L6", worst(SixthOrderTop::of(&top), &phases)?, 1e-10)
            .shows("all other declared systems: tests/systems/structure.rs");

    let mut theirs = 0.0;
    for z in &phases {
        // Runge–Kutta integrates the attitude; a nearby `w` is reached by rotating `R`, and its length by scaling.
        let map = |(momentum, w): &Phase| {
            let length = w.norm();
            let body = Body::of(&HeavyTop { m: top.m * length, ..top.clone() });
            let attitude = nalgebra::UnitQuaternion::rotation_between(w, &Vector3::z())?;
            let mut method = OnQuaternion::new(body, H, &attitude, *momentum);
            method.advance(1).ok()?;
            let end = method.sample();
            Some((end.momentum, end.attitude.row(2).transpose() * length))
        };
        theirs = greater(theirs, defect(map, z));
    }
    Ok(row.other(format!("RK4 (quaternion): {}", short(theirs))))
}
