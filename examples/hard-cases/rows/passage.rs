//! T6: straight up and straight down, where Euler angles are undefined.

use declarations::HeavyTop;
use liestep::Stepper;
use liestep::mechanics::DiagonalNonstandardInertia;
use nalgebra::{UnitQuaternion, Vector3};
use workbench::measure::greater;

use crate::curves::Curves;
use crate::row::{Effort, Failure, Row};

/// How near to the vertical the axis comes, rad.
const MISS: f64 = 5e-7;
const VELOCITY: Vector3<f64> = Vector3::new(1.0, 0.3, 2.0);
const STEPS: u32 = 100;

pub(crate) fn t6(_: Effort, _: &mut Curves) -> Result<Row, Failure> {
    let mut row = Row::new(
        "T6",
        "passage within 1e-6 rad of straight up and straight down",
        "neither more iterations nor a jump of the energy there; invariants to round-off",
    );
    for (name, angle) in [("up", 0.0), ("down", std::f64::consts::PI)] {
        #[allow(non_snake_case)] // the letter of the field
        let J_d = DiagonalNonstandardInertia::new(Vector3::new(2.0, 2.0, 1.0))?;
        let top = HeavyTop { J_d, m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
        let forth = Stepper::new(top, 0.01)?;
        let back = forth.inverse()?;
        // The miss is across the motion.
        let across = VELOCITY.xy().normalize();
        let miss = UnitQuaternion::from_scaled_axis(Vector3::new(-across.y, across.x, 0.0) * MISS);
        let mut state = forth.start(UnitQuaternion::from_scaled_axis(Vector3::x() * angle) * miss, VELOCITY)?;
        for _ in 0..STEPS {
            back.step(&mut state)?;
        }
        let casimir = state.momentum().dot(&state.advected());
        // The first step starts from the guess of a step back.
        forth.step(&mut state)?;
        let (mut nearest, mut kept) = (f64::INFINITY, 0.0);
        // Elsewhere, and within three steps of the passage.
        let (mut iterations, mut jumps) = ([0, 0], [0.0, 0.0]);
        for step in 2..=2 * STEPS {
            let energy = forth.energy(&state);
            let place = usize::from(step.abs_diff(STEPS) < 3);
            iterations[place] = iterations[place].max(forth.step(&mut state)?.iterations);
            jumps[place] = greater(jumps[place], (forth.energy(&state) - energy).abs());
            nearest = nearest.min(state.advected().xy().norm());
            kept = greater(kept, (state.momentum().dot(&state.advected()) / casimir - 1.0).abs());
        }
        row = row
            .at_most(&format!("{name}: nearest, rad"), nearest, 1e-6)
            .holds(&format!("{name}: iterations there {}, elsewhere {}", iterations[1], iterations[0]), {
                iterations[1] <= iterations[0]
            })
            .holds(&format!("{name}: energy changes there {:.1e}, elsewhere {:.1e}", jumps[1], jumps[0]), {
                jumps[1] <= jumps[0]
            })
            .at_most(&format!("{name}: p·w"), kept, 1e-12);
    }
    Ok(row)
}
