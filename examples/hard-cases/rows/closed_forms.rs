//! B8: on the separatrix, and symmetric bodies, against closed forms.

use liestep::prelude::*;
use nalgebra::Vector3;
use workbench::heavy_top::rk4::{Body, OnQuaternion};
use workbench::measure::{four_halvings, greater, order, relative, steps_in};
use workbench::run::Method as _;

use crate::closed::{on_separatrix, symmetric_body};
use crate::row::{Effort, Failure, Row, short};

/// The errors of the invariants, and the error at the end.
struct End {
    error: f64,
    energy: f64,
    momentum: f64,
}

/// Steps a body from a velocity, and compares attitude and velocity at the time `t`; without an expected attitude, only
/// the velocity.
fn end(
    moments: &Vector3<f64>,
    velocity: &Vector3<f64>,
    (t, h): (f64, f64),
    exact: &(Option<nalgebra::Matrix3<f64>>, Vector3<f64>),
) -> Result<End, Failure> {
    let inertia = liestep::mechanics::DiagonalNonstandardInertia::from_principal_moments(*moments)?;
    let stepper = Stepper::new(PrincipalBody { J_d: inertia }, h)?;
    let mut state = stepper.start(SO3::identity(), *velocity)?;
    let (energy, spatial) = (stepper.energy(&state), state.spatial_momentum());
    let mut left = End { error: 0.0, energy: 0.0, momentum: 0.0 };
    for _ in 0..steps_in(t, h) {
        stepper.step(&mut state)?;
        left.energy = greater(left.energy, (stepper.energy(&state) / energy - 1.0).abs());
        left.momentum = greater(left.momentum, relative(&state.spatial_momentum(), &spatial));
    }
    left.error = relative(&stepper.velocity(&state), &exact.1);
    if let Some(attitude) = &exact.0 {
        left.error = left.error.hypot(relative(&state.attitude().matrix(), attitude));
    }
    Ok(left)
}

pub(crate) fn b8(_: Effort) -> Result<Row, Failure> {
    let mut row = Row::new(
        "B8",
        "on the separatrix, and symmetric bodies, against closed forms",
        "order 2, invariants to round-off (1e-13)",
    );
    let moments = Vector3::new(1.0, 2.0, 3.0);
    let start = on_separatrix(&moments, 2.0, 0.0);
    let far = (None, on_separatrix(&moments, 2.0, 5.0));
    let body = Vector3::new(3.0, 3.0, 4.0);
    let momentum = body.component_mul(&Vector3::new(1.0, 0.5, 2.0));
    let turned = symmetric_body(&body, &momentum, 10.0);
    let turned = (Some(turned.0), turned.1.component_div(&body));
    let long = Vector3::new(2.0, 2.0, 0.5);
    let tumbling = symmetric_body(&long, &long.component_mul(&Vector3::new(1.0, 0.5, 2.0)), 10.0);
    let tumbling = (Some(tumbling.0), tumbling.1.component_div(&long));
    let cases = [
        ("separatrix, t = 5", moments, start, 5.0, far),
        ("J = (3, 3, 4), t = 10", body, Vector3::new(1.0, 0.5, 2.0), 10.0, turned),
        ("J = (2, 2, 0.5), t = 10", long, Vector3::new(1.0, 0.5, 2.0), 10.0, tumbling),
    ];
    for (name, moments, velocity, t, exact) in cases {
        let (mut errors, mut energy, mut kept) = (Vec::new(), 0.0, 0.0);
        for h in four_halvings(0.02) {
            let end = end(&moments, &velocity, (t, h), &exact)?;
            errors.push((h, end.error));
            (energy, kept) = (greater(energy, end.energy), greater(kept, end.momentum));
        }
        row = row
            .near(&format!("{name}: order"), order(&errors, 1e-11), 2.0, 0.05)
            .at_most(&format!("{name}: energy"), energy, 1e-13)
            .at_most(&format!("{name}: momentum"), kept, 1e-13);
        let rk4 = Body { inverse_moments: moments.map(f64::recip), lever: Vector3::zeros() };
        let momentum = moments.component_mul(&velocity);
        let mut method = OnQuaternion::new(rk4, 0.02, &nalgebra::UnitQuaternion::identity(), momentum);
        method.advance(steps_in(t, 0.02))?;
        let error = relative(&method.sample().momentum.component_div(&moments), &exact.1);
        row =
            row.other(format!("{name}: RK4 at h = 0.02 has the error {} (ours {})", short(error), short(errors[0].1)));
    }
    Ok(row)
}
