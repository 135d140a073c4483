//! B1, B2: a box, as in the tests of a physics engine.

use liestep::mechanics::DiagonalNonstandardInertia;
use nalgebra::Vector3;

use crate::rivals::{Spin, Trace};
use crate::row::{Effort, Failure, Row, short};

/// A box of 1 kg with half-extents 0.1, 0.2, 0.3: `J_d = m/3 diag(a², b², c²)`.
pub(crate) fn box_of_engines(velocity: [f64; 3], h: f64) -> Result<Spin, Failure> {
    let inertia = DiagonalNonstandardInertia::from_diagonal(Vector3::new(0.01, 0.04, 0.09) / 3.0)?;
    Ok(Spin { inertia, velocity: velocity.into(), h })
}

/// Judges energy and spatial momentum by the bound.
pub(crate) fn kept(row: Row, name: &str, trace: &Trace, bound: f64) -> Row {
    row.at_most(&format!("{name}energy"), trace.energy_error(), bound).at_most(
        &format!("{name}spatial momentum"),
        trace.momentum_error(),
        bound,
    )
}

/// Judges our method by the bound, and lists the others.
fn judged(mut row: Row, name: &str, traces: &[Trace], full: &Trace, bound: f64) -> Row {
    let [ours, others @ ..] = traces else { return row };
    row = kept(row, name, ours, bound);
    row = kept(row, &format!("{name}full tensor: "), full, bound);
    for other in others {
        let momentum = short(other.momentum_error());
        row = row.other(format!("{name}{} E/E(0) {:.6}, momentum {momentum}", other.name, other.final_energy()));
    }
    row
}

pub(crate) fn b1(_: Effort) -> Result<Row, Failure> {
    let spin = box_of_engines([1.0, 2.0, 3.0], 0.01)?;
    let traces = spin.traces(500)?;
    let row = Row::new("B1", "box, ω = (1, 2, 3), h = 0.01, 500 steps", "energy to 1e-14");
    Ok(judged(row, "", &traces, &spin.full(500)?, 1e-14))
}

pub(crate) fn b2(_: Effort) -> Result<Row, Failure> {
    let (steps, h) = (20_000, 0.005);
    let spins = [box_of_engines([0.05, 5.0, 0.05], h)?, box_of_engines([20.0, 0.05, 0.05], h)?];
    let (middle, fast) = (spins[0].traces(steps)?, spins[1].traces(steps)?);
    let full = [spins[0].full(steps)?, spins[1].full(steps)?];
    let mut row = Row::new(
        "B2",
        "the box about its middle axis, and spun fast about its major one, h = 0.005, 20 000 steps",
        "energy to 1e-13, the stable spin stays",
    );
    row = judged(row, "middle axis: ", &middle, &full[0], 1e-13);
    row = judged(row, "fast spin: ", &fast, &full[1], 1e-13);
    // The first axis has the largest moment: the spin is stable, and the angle to the axis doesn't grow.
    for trace in [&fast[0], &full[1]] {
        let slowest = -trace.worst(|kept| 20.0 - kept.velocity.x) + 20.0;
        row = row.holds(&format!("fast spin: {} turns by {slowest:.3} rad/s at least", trace.name), slowest > 19.99);
    }
    for (place, trace) in fast.iter().enumerate() {
        let tilt = trace.worst(|kept| kept.velocity.yz().norm().atan2(kept.velocity.x).to_degrees());
        let what = format!("fast spin: {} leaves its axis by {tilt:.1}°", trace.name);
        row = if place == 0 { row.holds(&what, tilt < 1.0) } else { row.other(what) };
    }
    Ok(row)
}
