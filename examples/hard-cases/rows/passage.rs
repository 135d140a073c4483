//! T6: straight up and straight down, where Euler angles are undefined.

use declarations::HeavyTop;
use liestep::{SO3, State, Stepper};
use nalgebra::{UnitQuaternion, Vector3};
use workbench::heavy_top::continuous::{phase, solution};
use workbench::measure::{four_halvings, greater, order, relative, steps_in};

use crate::row::{Effort, Failure, Row};

/// The least distance of the axis from the vertical, rad.
pub(super) const MISS: f64 = 5e-7;
const VELOCITY: Vector3<f64> = Vector3::new(1.0, 0.3, 2.0);

/// The errors of a passage at `t = 0`, from `t = −1` to `t = 1`.
struct Passage {
    /// The distance from the vertical, rad.
    nearest: f64,
    /// The most iterations, and the largest change of the energy in a step: elsewhere, and within three steps of the
    /// passage.
    iterations: [u32; 2],
    jumps: [f64; 2],
    /// The errors of `|w|`, of `p·w` and of `RᵀR − I`.
    defects: [f64; 3],
    /// The error of momentum and vertical at the end.
    error: f64,
}

/// The state at the nearest approach: turned from straight up by `down`, and off by `miss` across the motion, rad.
fn nearest(stepper: &Stepper<HeavyTop>, down: f64, miss: f64) -> Result<State<SO3, Vector3<f64>>, Failure> {
    let across = VELOCITY.xy().normalize();
    let miss = UnitQuaternion::from_scaled_axis(Vector3::new(-across.y, across.x, 0.0) * miss);
    Ok(stepper.start(UnitQuaternion::from_scaled_axis(Vector3::x() * down) * miss, VELOCITY)?)
}

/// The state a second before the nearest approach.
pub(super) fn before(stepper: &Stepper<HeavyTop>, down: f64, miss: f64) -> Result<State<SO3, Vector3<f64>>, Failure> {
    let mut state = nearest(stepper, down, miss)?;
    stepper.inverse()?.run(&mut state, steps_in(1.0, stepper.step_size()))?;
    Ok(state)
}

/// A passage by steps of `h`, past straight up or straight down.
fn pass(down: f64, h: f64) -> Result<Passage, Failure> {
    let top = HeavyTop::thesis();
    let forth = Stepper::new(top.clone(), h)?;
    let back = forth.inverse()?;
    let mut state = nearest(&forth, down, MISS)?;
    let exact = solution(&top, phase(&state.momentum(), &state.advected()), 1.0, 4000);
    let steps = steps_in(1.0, h);
    for _ in 0..steps {
        back.step(&mut state)?;
    }
    let casimir = state.momentum().dot(&state.advected());
    // The first step has the guess of a step back.
    forth.step(&mut state)?;
    let mut passage =
        Passage { nearest: f64::INFINITY, iterations: [0; 2], jumps: [0.0; 2], defects: [0.0; 3], error: 0.0 };
    for step in 2..=2 * steps {
        let energy = forth.energy(&state);
        let place = usize::from(step.abs_diff(steps) < 3);
        passage.iterations[place] = passage.iterations[place].max(forth.step(&mut state)?.iterations);
        passage.jumps[place] = greater(passage.jumps[place], (forth.energy(&state) - energy).abs());
        passage.nearest = passage.nearest.min(state.advected().xy().norm());
        let vertical = state.momentum().dot(&state.advected()) - casimir;
        let defects = [state.advected().norm() - 1.0, vertical, state.orthogonality_defect()];
        passage.defects = [0, 1, 2].map(|k| greater(passage.defects[k], defects[k].abs()));
    }
    passage.error = relative(&phase(&state.momentum(), &state.advected()), &exact);
    Ok(passage)
}

pub(crate) fn t6(_: Effort) -> Result<Row, Failure> {
    let mut row = Row::new(
        "T6",
        "passage within 1e-6 rad of straight up and straight down, four halvings from h = 0.01",
        "neither more iterations nor a jump of the energy there; invariants to round-off, order 2",
    );
    for (name, down) in [("up", 0.0), ("down", std::f64::consts::PI)] {
        let mut errors = Vec::new();
        for h in four_halvings(0.01) {
            let Passage { nearest, iterations, jumps, defects: [length, vertical, orthogonality], error } =
                pass(down, h)?;
            errors.push((h, error));
            let name = format!("{name}, h = {h}");
            // The way back and forth loses some roundings, far less than a thousandth of the miss.
            row = row
                .near(&format!("{name}: nearest over the miss"), nearest / MISS, 1.0, 1e-9 / MISS)
                .holds(&format!("{name}: iterations there {}, elsewhere {}", iterations[1], iterations[0]), {
                    iterations[1] <= iterations[0] && iterations[0] <= 4
                })
                .holds(&format!("{name}: energy changes there {:.1e}, elsewhere {:.1e}", jumps[1], jumps[0]), {
                    jumps[1] <= jumps[0]
                })
                .at_most(&format!("{name}: |w|"), length, 1e-13)
                .at_most(&format!("{name}: p·w"), vertical, 1e-12)
                .at_most(&format!("{name}: ‖RᵀR − I‖"), orthogonality, 1e-13);
        }
        row = row.near(&format!("{name}: order"), order(&errors, 1e-11), 2.0, 0.05);
    }
    Ok(row)
}
