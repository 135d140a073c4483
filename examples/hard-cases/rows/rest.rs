//! S4: rest in equilibria.

use declarations::{FreeBody, HeavyTop, Motion};
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::{SO3, Stepper};
use nalgebra::{UnitQuaternion, Vector3};
use workbench::heavy_top::rk4::{Body, OnQuaternion};
use workbench::run::Method as _;

use crate::row::{Effort, Failure, Row};

const STEPS: u64 = 1000;

/// Whether attitude, momentum and parameters are the same after each of many steps from rest.
fn stays<L>(lagrangian: L, attitude: UnitQuaternion<f64>) -> Result<bool, Failure>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular,
{
    let stepper = Stepper::new(lagrangian, 0.01)?;
    let mut state = stepper.start(attitude, Vector3::zeros())?;
    let (before, energy) = ((state.attitude(), state.momentum(), state.advected()), stepper.energy(&state));
    for _ in 0..STEPS {
        stepper.step(&mut state)?;
        if (state.attitude(), state.momentum(), state.advected()) != before {
            return Ok(false);
        }
    }
    Ok(stepper.energy(&state).to_bits() == energy.to_bits())
}

pub(crate) fn s4(_: Effort) -> Result<Row, Failure> {
    let tilted = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, -0.3, 0.1));
    let (level, top) = (UnitQuaternion::identity(), Motion::chaotic().top);
    let rho = Vector3::new(0.3, 0.2, 0.4);
    let scenes = [
        ("g = 0", HeavyTop { g: 0.0, ..top.clone() }, tilted),
        ("m = 0", HeavyTop { m: 0.0, ..top.clone() }, tilted),
        ("ρ = 0", HeavyTop { rho: Vector3::zeros(), ..top.clone() }, tilted),
        ("w = 0", HeavyTop { up: Vector3::zeros(), ..top.clone() }, tilted),
        // Both vectors have proportional digits, so that the torque is zero to the bit.
        ("inverted, ρ = e₃", HeavyTop { rho: Vector3::z(), up: Vector3::z() * 2.0, ..top.clone() }, level),
        ("hanging, ρ = e₃", HeavyTop { rho: Vector3::z(), up: Vector3::z() * -2.0, ..top.clone() }, level),
        ("inverted", HeavyTop { rho, up: rho * 2.0, ..top.clone() }, level),
        ("hanging", HeavyTop { rho, up: rho * -2.0, ..top.clone() }, level),
    ];
    let mut row = Row::new("S4", "at rest: no momentum, no torque", "exact");
    let mut still = 0;
    for (name, scene, attitude) in scenes {
        // The Runge–Kutta program has e₃ as its vertical.
        if scene.up == Vector3::z() {
            let mut rk4 = OnQuaternion::new(Body::of(&scene), 0.01, &attitude, Vector3::zeros());
            let before = rk4.sample();
            rk4.advance(STEPS)?;
            still += u32::from((rk4.sample().attitude - before.attitude).amax() < 1e-15);
        }
        row = row.holds(name, stays(scene, attitude)?);
    }
    for (moments, attitude) in [([3.0, 3.0, 4.0], tilted), ([1.0, 2.0, 3.0], tilted), ([1.0, 2.0, 3.0], level)] {
        row = row.holds(&format!("free body {moments:?}"), stays(FreeBody::with_moments(moments), attitude)?);
    }
    Ok(row.other(format!("RK4 (quaternion) stays, too: {still} of 3 scenes to 1e-15")))
}
