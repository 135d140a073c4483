//! B3 to B5: slender, flat and round bodies, and a body in rotated axes.

use declarations::FreeBody;
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::prelude::*;
use nalgebra::{Matrix3, Rotation3, Vector3};
use workbench::measure::{greater, relative};

use super::boxes::{box_of_engines, kept};
use crate::rivals::{Spin, Trace};
use crate::row::{Effort, Failure, Row, short};

/// A cylinder of 1 kg and 1 m length about its centre.
fn rod(slenderness: f64) -> Result<DiagonalNonstandardInertia, Failure> {
    let diameter = 1.0 / slenderness;
    let across = diameter * diameter / 16.0;
    Ok(DiagonalNonstandardInertia::from_diagonal(Vector3::new(across, across, 1.0 / 12.0))?)
}

fn errors(traces: &[Trace]) -> String {
    let errors: Vec<_> = traces.iter().map(|trace| format!("{} {}", trace.name, short(trace.energy_error()))).collect();
    errors.join(", ")
}

pub(crate) fn b3(_: Effort) -> Result<Row, Failure> {
    let moments = |moments: [f64; 3]| DiagonalNonstandardInertia::from_principal_moments(moments.into());
    let bodies = [
        ("rod 100:1", rod(1e2)?, [1.0, 0.5, 3.0]),
        ("rod 10⁴:1", rod(1e4)?, [1.0, 0.5, 3.0]),
        ("plate J = (1, 2, 3)", moments([1.0, 2.0, 3.0])?, [1.0, 0.5, 0.3]),
        ("J = (1e-6, 1, 1.000001)", moments([1e-6, 1.0, 1.000_001])?, [1.0, 0.5, 0.3]),
    ];
    let mut row = Row::new("B3", "rods, a flat plate, an extreme ratio, at 60 Hz, 10⁴ steps", "energy to 1e-13");
    for (name, inertia, velocity) in bodies {
        let spin = Spin { inertia, velocity: velocity.into(), h: 1.0 / 60.0 };
        let traces = spin.traces(10_000)?;
        row = kept(row, &format!("{name}: "), &traces[0], 1e-13);
        row = kept(row, &format!("{name}, full tensor: "), &spin.full(10_000)?, 1e-13);
        row = row.other(format!("{name}: energy error {}", errors(&traces[1..])));
    }
    let needle = rod(1e9).map_or_else(|error| error.to_string(), |_| "accepted".to_owned());
    Ok(row.shows(format!("rod 10⁹:1: {needle}")))
}

/// The most iterations in ten thousand steps, and the largest relative error of the energy.
fn turned<L>(body: L, spin: &Spin) -> Result<(u32, f64), Failure>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular,
{
    let stepper = Stepper::new(body, spin.h)?;
    let mut state = stepper.start(SO3::identity(), spin.velocity)?;
    let energy = stepper.energy(&state);
    // The first step has no previous increment as its guess.
    stepper.step(&mut state)?;
    let (mut iterations, mut error) = (0, 0.0);
    for _ in 0..10_000 {
        iterations = stepper.step(&mut state)?.iterations.max(iterations);
        error = greater(error, (stepper.energy(&state) / energy - 1.0).abs());
    }
    Ok((iterations, error))
}

pub(crate) fn b4(_: Effort) -> Result<Row, Failure> {
    let inertia = DiagonalNonstandardInertia::from_principal_moments(Vector3::repeat(0.4))?;
    let spin = Spin { inertia, velocity: Vector3::new(1.0, 2.0, 3.0), h: 0.01 };
    let mut row = Row::new("B4", "sphere, 10⁴ steps", "one Newton iteration, energy exact");
    for (name, (iterations, error)) in
        [("", turned(spin.body(), &spin)?), ("full tensor: ", turned(FreeBody { J_d: inertia.into() }, &spin)?)]
    {
        row = row.at_most(&format!("{name}iterations"), f64::from(iterations), 1.0);
        row = row.at_most(&format!("{name}energy"), error, 0.0);
    }
    Ok(row.other(format!("energy error {}", errors(&spin.traces(10_000)?[1..]))))
}

pub(crate) fn b5(_: Effort) -> Result<Row, Failure> {
    const STEPS: u32 = 500;
    let spin = box_of_engines([1.0, 2.0, 3.0], 0.01)?;
    // The attitude and momentum at the end, transformed to the axes of the box.
    let moved = |axes: &Matrix3<f64>| -> Result<(Matrix3<f64>, Vector3<f64>, f64), Failure> {
        let inertia = NonstandardInertia::new(axes * spin.inertia.to_matrix() * axes.transpose())?;
        let stepper = Stepper::new(FreeBody { J_d: inertia }, spin.h)?;
        // A reflection reverses rotations.
        let mut state = stepper.start(SO3::identity(), axes * spin.velocity * axes.determinant())?;
        let (energy, mut error) = (stepper.energy(&state), 0.0);
        for _ in 0..STEPS {
            stepper.step(&mut state)?;
            error = greater(error, (stepper.energy(&state) / energy - 1.0).abs());
        }
        let momentum = axes.transpose() * state.momentum() * axes.determinant();
        Ok((axes.transpose() * state.attitude().matrix() * axes, momentum, error))
    };
    let expected = moved(&Matrix3::identity())?;
    let mut signed = Vec::new();
    for [x, y, z] in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
        for signs in 0..8 {
            let sign = |bit: usize| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
            let column = |axis: usize, bit: usize| Vector3::ith(axis, sign(bit));
            signed.push(Matrix3::from_columns(&[column(x, 0), column(y, 1), column(z, 2)]));
        }
    }
    let mut errors = [0.0; 2];
    for axes in &signed {
        let (attitude, momentum, _) = moved(axes)?;
        let error = relative(&attitude, &expected.0).max(relative(&momentum, &expected.1));
        errors[0] = greater(errors[0], error);
    }
    let mut energy = 0.0;
    for angles in [(0.3, -0.7, 1.1), (1.0, 0.2, -2.0), (-0.4, 1.3, 0.6)] {
        let axes = Rotation3::from_euler_angles(angles.0, angles.1, angles.2).into_inner();
        let (attitude, momentum, error) = moved(&axes)?;
        errors[1] = greater(errors[1], relative(&attitude, &expected.0).max(relative(&momentum, &expected.1)));
        energy = greater(energy, error);
    }
    let row = Row::new("B5", "the box in other axes, 500 steps", "the same motion to 1e-13")
        .at_most(&format!("{} permutations and signs", signed.len()), errors[0], 1e-13)
        .at_most("full tensors", errors[1], 1e-13)
        .at_most("energy with full tensors", energy, 1e-14);
    Ok(row)
}
