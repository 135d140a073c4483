//! T8: the top without gravity.

use declarations::{FullTop, HeavyTop, Motion};
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::prelude::*;
use nalgebra::{Matrix3, Vector3};
use workbench::measure::{greater, relative};

use crate::row::{Effort, Failure, Row};

/// The attitude and momentum after a thousand steps, about twenty turns, and the change of `R p`.
fn moved<L>(lagrangian: L, motion: &Motion) -> Result<(Matrix3<f64>, Vector3<f64>, f64), Failure>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular,
{
    let stepper = Stepper::new(lagrangian, 0.01)?;
    let mut state = stepper.start(motion.attitude, motion.velocity)?;
    let (spatial, mut error) = (state.spatial_momentum(), 0.0);
    for _ in 0..1000 {
        stepper.step(&mut state)?;
        error = greater(error, relative(&state.spatial_momentum(), &spatial));
    }
    Ok((state.attitude().matrix(), state.momentum(), error))
}

pub(crate) fn t8(_: Effort) -> Result<Row, Failure> {
    let (mut apart, mut kept) = (0.0, 0.0);
    for motion in [Motion::looping(), Motion::chaotic()] {
        let top = motion.top.clone();
        let body = PrincipalBody { J_d: top.J_d };
        let free = moved(body, &motion)?;
        kept = greater(kept, free.2);
        let weightless = [
            HeavyTop { g: 0.0, ..top.clone() },
            HeavyTop { m: 0.0, ..top.clone() },
            HeavyTop { rho: Vector3::zeros(), ..top.clone() },
        ];
        for top in weightless {
            let full = FullTop::in_axes(&top, &Matrix3::identity());
            for (attitude, momentum, spatial) in [moved(top, &motion)?, moved(full, &motion)?] {
                kept = greater(kept, spatial);
                apart = greater(apart, relative(&attitude, &free.0).max(relative(&momentum, &free.1)));
            }
        }
        let scene = body + Gravity { m: 1.0, g: 0.0, rho: top.rho, up: top.up };
        let (attitude, momentum, _) = moved(scene, &motion)?;
        apart = greater(apart, relative(&attitude, &free.0).max(relative(&momentum, &free.1)));
    }
    // Sums of two effects may round differently from one; over a thousand steps the attitude amplifies this to
    // 1000^{3/2} ε.
    let row = Row::new("T8", "no gravity, 1000 steps", "the free body to round-off")
        .at_most("g, m or ρ zero, against the free body", apart, 7e-12)
        .at_most("spatial momentum", kept, 5e-14);
    Ok(row)
}
