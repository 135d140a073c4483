//! Driven scenes: parameters prescribed for each step, and forces on SE(3).
//!
//! ```text
//! cargo run --release -p liestep-declarations --example driven
//! cargo run --release -p liestep-declarations --example driven -- --out driven
//! ```
//!
//! 1. A satellite in a circular orbit. The direction of its planet rotates, and the gravity gradient makes the
//!    satellite librate. In the orbit's frame nothing depends on time, so the Jacobi integral is conserved.
//! 2. A thruster beside the axis of a body, in a fluid. It burns for a while, and the body draws a spiral and stops.
//! 3. Coils of a satellite, switched by the B-dot law: each generates a field against the change of the external field
//!    in the body frame. The satellite stops tumbling, down to a rotation with the field.

use std::process::ExitCode;

use declarations::{FluidDrag, Flyer, Thruster, Torquer};
use liestep::effects::GravityGradient;
use liestep::groups::{Given, SE3};
use liestep::mechanics::Effect as _;
use liestep::prelude::*;
use nalgebra::{Matrix4, Point3, Rotation3, Vector3, Vector4, Vector6};

use workbench::args::Failure;
use workbench::drawing::{self, drawing, path, stacked};
use workbench::output::Output;
use workbench::plot::{BLUE, Colour, GREEN, Line, ORANGE, Panel, PlotResult, Vertical};

const HELP: &str = "Drives a satellite in its orbit, a thruster on SE(3), and switched magnetic torquers

Options:
  --out <DIR>  Where the figures go [default: liestep-driven]
";

fn main() -> ExitCode {
    drawing(HELP, "liestep-driven", |output| {
        Ok(format!("{}{}{}", orbit(output)?, thruster(output)?, torquers(output)?))
    })
}

/// A line through points, or one over time.
fn line(colour: Colour, points: Vec<(f64, f64)>) -> Line {
    drawing::line(colour, 3, points)
}

fn figure(title: &str, about: &str, names: &[(&str, Colour)], panels: &[Panel<'_>; 2]) -> PlotResult<String> {
    stacked(((900, 700), 308), [title, about], names, panels)
}

/// The orbital rate, rad/s.
const RATE: f64 = 0.001;

/// The direction of the planet in space at a time in s, of length one.
fn planet(t: f64) -> Vector3<f64> {
    -Vector3::new((RATE * t).cos(), (RATE * t).sin(), 0.0)
}

fn orbit(output: &mut Output) -> Result<String, Failure> {
    let (h, steps) = (10.0, 6_300_u32);
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(120.0, 200.0, 240.0))?;
    let gradient = GravityGradient { GM: RATE * RATE, r: 1.0, J: J_d.to_inertia(), direction: planet(0.0) };
    let stepper = Stepper::new(RigidBody { J_d } + gradient, h)?;
    let tilted = Rotation3::from_scaled_axis(Vector3::new(0.05, -0.08, 0.3));
    let mut state = stepper.start(tilted, Vector3::new(0.0, 0.0, RATE))?;
    let (mut pitch, mut integral) = (Vec::new(), Vec::new());
    for step in 0..=steps {
        let t = f64::from(step) * h;
        let seen = state.attitude().as_matrix().transpose() * planet(t);
        let kinetic = 0.5 * stepper.velocity(&state).dot(&state.momentum());
        let jacobi = kinetic - stepper.scene().limit(None, &((), seen)).l - RATE * state.spatial_momentum().z;
        let turns = RATE * t / core::f64::consts::TAU;
        // The angle of the body's first axis from the vertical, in the plane of the orbit.
        pitch.push((turns, seen.y.atan2(-seen.x).to_degrees()));
        integral.push((turns, jacobi));
        stepper.step_with(&mut state, &((), planet(t + 0.5 * h)))?;
    }
    let first = integral[0].1;
    let off = integral.iter().map(|&(turns, jacobi)| (turns, (jacobi / first - 1.0).abs())).collect::<Vec<_>>();
    let worst = off.iter().map(|point| point.1).fold(0.0, f64::max);
    let swing = pitch.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
    let panels = [
        Panel {
            across: "orbits",
            ..Panel::over_time("Pitch against the vertical", "degrees", Vertical::Linear, vec![line(BLUE, pitch)])
        },
        Panel {
            across: "orbits",
            ..Panel::over_time(
                "Jacobi integral, off its start",
                "relative",
                Vertical::Logarithmic,
                vec![line(BLUE, off)],
            )
        },
    ];
    let about = "gravity gradient whose direction is given for each step, h = 10 s";
    output.write("orbit.svg", &figure("A satellite librates in its orbit", about, &[], &panels)?)?;
    Ok(format!(
        "Orbit: 10 turns in {steps} steps; the pitch swings up to {swing:.1}°, the Jacobi integral is kept to {worst:.1e}.\n"
    ))
}

fn thruster(output: &mut Output) -> Result<String, Failure> {
    let (h, steps, burns) = (0.02, 2_000_u32, 1_000_u32);
    // A body of two kilograms with J_z = 2 kg m², in a fluid that damps rotation and translation.
    let flyer = Flyer { J: Matrix4::from_diagonal(&Vector4::new(0.75, 1.25, 1.0, 2.0)) };
    let drag = FluidDrag { C: Matrix4::from_diagonal(&Vector4::new(0.1, 0.1, 0.1, 0.25)) };
    let nozzle = Thruster { at: Point3::new(-1.0, -0.05, 0.0), thrust: Vector4::zeros() };
    let stepper = Stepper::new(flyer + drag + nozzle, h)?;
    let mut state = stepper.start(SE3::identity(), Vector6::zeros())?;
    let (mut burning, mut gliding, mut energy) = (Vec::new(), Vec::new(), Vec::new());
    for step in 0..=steps {
        let place = state.attitude().matrix();
        let path = if step <= burns { &mut burning } else { &mut gliding };
        path.push((place[(0, 3)], place[(1, 3)]));
        energy.push((f64::from(step) * h, stepper.energy(&state)));
        let thrust = if step < burns { 1.5 } else { 0.0 };
        stepper.step_with(&mut state, &(((), ()), Given(Vector4::new(thrust, 0.0, 0.0, 0.0))))?;
    }
    let end = energy[energy.len() - 1].1;
    let panels = [
        path("The way, m", ["x", "y"], vec![line(ORANGE, burning), line(BLUE, gliding)]),
        Panel::over_time("Kinetic energy", "J", Vertical::Linear, vec![line(BLUE, energy)]),
    ];
    let names = [("burning", ORANGE), ("gliding", BLUE)];
    let about = "a follower force on SE(3), given for each step, and drag";
    output.write("thruster.svg", &figure("A thruster beside the axis", about, &names, &panels)?)?;
    Ok(format!("Thruster: burns for 20 s, then the energy falls to {end:.1e} J in 20 s.\n"))
}

fn torquers(output: &mut Output) -> Result<String, Failure> {
    let (h, steps, strength) = (0.5, 8_000_u32, 0.4);
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(0.05, 0.06, 0.08))?;
    // A dipole field over the poles rotates twice an orbit.
    let field = |t: f64| {
        let angle = 0.002 * t;
        Vector3::new(angle.sin(), 0.2, angle.cos()) * 3e-5
    };
    let torquer = Torquer { moment: Vector3::zeros(), field: field(0.0) };
    let stepper = Stepper::new(RigidBody { J_d } + torquer, h)?;
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.1, -0.15, 0.2))?;
    let mut rates = [Vec::new(), Vec::new(), Vec::new()];
    let mut size = Vec::new();
    let mut last = state.attitude().as_matrix().transpose() * field(0.0);
    for step in 0..=steps {
        let t = f64::from(step) * h;
        let rate = stepper.velocity(&state);
        (0..3).for_each(|axis| rates[axis].push((t, rate[axis])));
        size.push((t, rate.norm()));
        let seen = state.attitude().as_matrix().transpose() * field(t);
        let moment = (last - seen).map(f64::signum) * if step == 0 { 0.0 } else { strength };
        last = seen;
        stepper.step_with(&mut state, &((), (field(t + 0.5 * h), Given(moment))))?;
    }
    let (first, end) = (size[0].1, size[size.len() - 1].1);
    let colours = [ORANGE, BLUE, GREEN];
    let lines = rates.into_iter().zip(colours).map(|(points, colour)| line(colour, points)).collect();
    let panels = [
        Panel::over_time("Body rates", "rad/s", Vertical::Linear, lines),
        Panel::over_time("How fast it turns", "rad/s", Vertical::Logarithmic, vec![line(BLUE, size)]),
    ];
    let names = [("Ω_X", ORANGE), ("Ω_Y", BLUE), ("Ω_Z", GREEN)];
    let about = "each coil full on against the change of the field that it sees, h = 0.5 s";
    output.write("torquers.svg", &figure("Switched magnetic torquers stop a tumble", about, &names, &panels)?)?;
    Ok(format!("Torquers: from {first:.2} rad/s to {end:.1e} rad/s in {steps} steps.\n"))
}
