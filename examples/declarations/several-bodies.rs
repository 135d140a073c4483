//! Several bodies that are declared together, or placed.
//!
//! ```text
//! cargo run --release -p liestep-declarations --example several-bodies
//! cargo run --release -p liestep-declarations --example several-bodies -- --out several-bodies
//! ```
//!
//! 1. Two double pendulums whose lower rods start a nanoradian apart: they separate exponentially, by chaos.
//! 2. Two asteroids that attract each other, with torques by their shapes: the full two-body problem.
//! 3. A quadrotor that moves a load on a cable. A controller prescribes the rotors' forces for each step.
//!
//! A chain of twenty rods is drawn by `hanging-chain`.

use std::process::ExitCode;

use declarations::{DoublePendulum, SuspendedLoad, TwoBodies};
use liestep::groups::R3;
use liestep::mechanics::Inertia;
use liestep::prelude::*;
use nalgebra::{Matrix3, SVector, UnitQuaternion, Vector3, Vector6};

use workbench::args::Failure;
use workbench::drawing::{self, drawing, path, stacked};
use workbench::output::Output;
use workbench::plot::{BLUE, Colour, GREEN, Line, ORANGE, Panel, PlotResult, Vertical};

const HELP: &str = "Draws a double pendulum, two asteroids, and a load under a quadrotor

Options:
  --out <DIR>  Where the figures go [default: liestep-several-bodies]
";

fn main() -> ExitCode {
    drawing(HELP, "liestep-several-bodies", |output| {
        Ok(format!("{}{}{}", pendulums(output)?, asteroids(output)?, load(output)?))
    })
}

/// Checks that a number is below its bound; NaN is an error, too.
fn check(what: &str, found: f64, bound: f64) -> Result<(), Failure> {
    if found < bound { Ok(()) } else { Err(format!("{what}: {found:.1e}, at most {bound:.0e} is expected").into()) }
}

fn line(colour: Colour, points: Vec<(f64, f64)>) -> Line {
    drawing::line(colour, 2, points)
}

fn figure(title: &str, about: &str, names: &[(&str, Colour)], panels: &[Panel<'_>; 2]) -> PlotResult<String> {
    stacked(((700, 900), 520), [title, about], names, panels)
}

/// Rods of a metre and a kilogram that hang along their axes.
fn double_pendulum() -> Result<DoublePendulum, Failure> {
    let (e, up) = (Vector3::z(), Vector3::z());
    let about_joint = Matrix3::from_diagonal(&Vector3::new(0.005, 0.005, 1.0 / 12.0)) + e * e.transpose() * 0.25;
    let (J_1, J_2) = (NonstandardInertia::new(about_joint + e * e.transpose())?, NonstandardInertia::new(about_joint)?);
    Ok(DoublePendulum { J_1, J_2, rho: -e, s_1: e * -1.5, s_2: e * -0.5, g: 9.81, up })
}

fn pendulums(output: &mut Output) -> Result<String, Failure> {
    let (h, steps) = (0.002, 12_000_u32);
    let stepper = Stepper::new(double_pendulum()?, h)?;
    let tilted = |angle: f64| SO3::from(UnitQuaternion::from_scaled_axis(Vector3::new(0.0, angle, 0.0)));
    let start = |off: f64| {
        let velocity = Vector6::new(0.3, 0.0, 0.0, 0.0, 0.0, 0.0);
        stepper.start((tilted(2.0), tilted(2.6 + off)), velocity)
    };
    let (mut first, mut second) = (start(0.0)?, start(1e-9)?);
    let end = |(upper, lower): (SO3, SO3)| -(upper.as_matrix() + lower.as_matrix()) * Vector3::z();
    let (energy, mut worst) = (stepper.energy(&first), 0.0_f64);
    let (mut ways, mut parting) = ([Vec::new(), Vec::new()], Vec::new());
    for step in 0..=steps {
        let ends = [end(first.attitude()), end(second.attitude())];
        if step % 10 == 0 {
            ways.iter_mut().zip(&ends).for_each(|(way, end)| way.push((end.x, end.z)));
            parting.push((f64::from(step) * h, (ends[0] - ends[1]).norm().max(1e-12)));
        }
        worst = worst.max((stepper.energy(&first) - energy).abs());
        stepper.step(&mut first)?;
        stepper.step(&mut second)?;
    }
    let apart = parting.iter().map(|point| point.1).fold(0.0, f64::max);
    // The error is of second order, `(hω)²` with rods that turn at some 10 rad/s, relative to the 39 J between hanging
    // and standing.
    check("energy of a double pendulum, J", worst, 2e-2)?;
    let [one, other] = ways;
    let panels = [
        path("The lower ends, m", ["x", "z"], vec![line(ORANGE, other), line(BLUE, one)]),
        Panel::over_time("How far they are apart", "m", Vertical::Logarithmic, vec![line(BLUE, parting)]),
    ];
    let names = [("one", BLUE), ("the other", ORANGE)];
    let about = "a nanoradian apart at the start, h = 2 ms";
    output.write("double-pendulum.svg", &figure("Two double pendulums in space", about, &names, &panels)?)?;
    Ok(format!(
        "Double pendulums: up to {apart:.1} m apart in 24 s; the energy is off by at most {worst:.1e} J of {energy:.1} J.\n"
    ))
}

fn asteroids(output: &mut Output) -> Result<String, Failure> {
    let (h, steps) = (0.01, 4_000_u32);
    let [first, second] = [[0.2, 0.35, 0.3], [0.12, 0.06, 0.1]].map(Vector3::from);
    let (m_1, m_2) = (1.3, 0.9);
    let stepper = Stepper::new(
        TwoBodies {
            m_1,
            m_2,
            K_1: NonstandardInertia::from_principal_moments(first)?,
            K_2: NonstandardInertia::from_principal_moments(second)?,
            J_1: Inertia::from_principal_moments(first)?,
            J_2: Inertia::from_principal_moments(second)?,
            G: 1.0,
        },
        h,
    )?;
    let (apart, speed) = (Vector3::x() * 2.0, Vector3::new(0.0, 1.1, 0.4));
    let place = |part: f64| R3::from(apart * part);
    let start = (SO3::identity(), place(-m_2 / (m_1 + m_2)), SO3::identity(), place(m_1 / (m_1 + m_2)));
    let turning = [Vector3::new(0.1, 0.2, 0.6), Vector3::new(-0.3, 0.1, 0.9)];
    let moving = [speed * (-m_2 / (m_1 + m_2)), speed * (m_1 / (m_1 + m_2))];
    let all = [turning[0], moving[0], turning[1], moving[1]];
    let mut state = stepper.start(start, SVector::<f64, 12>::from_fn(|k, _| all[k / 3][k % 3]))?;
    let energy = stepper.energy(&state);
    let (mut ways, mut off) = ([Vec::new(), Vec::new()], Vec::new());
    for step in 0..=steps {
        if step % 4 == 0 {
            let (_, x, _, y) = state.attitude();
            for (way, place) in ways.iter_mut().zip([x.translation(), y.translation()]) {
                way.push((place.x, place.y));
            }
            off.push((f64::from(step) * h, stepper.energy(&state) / energy - 1.0));
        }
        stepper.step(&mut state)?;
    }
    let worst = off.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
    let momentum = state.momentum_of::<1>() + state.momentum_of::<3>();
    // The error is of second order, `(hω)²` at 0.95 rad/s. The momentum changes only by one rounding per step.
    check("energy of the asteroids, relative", worst, 1e-4)?;
    check("momentum of the asteroids", momentum.amax(), 1e-12)?;
    let [one, other] = ways;
    let panels = [
        path("Where they are", ["x", "y"], vec![line(BLUE, one), line(ORANGE, other)]),
        Panel::over_time("Energy, off its start", "relative", Vertical::Linear, vec![line(BLUE, off)]),
    ];
    let names = [("mass 1.3", BLUE), ("mass 0.9", ORANGE)];
    let about = "masses 1.3 and 0.9, the constant of gravitation one, h = 0.01";
    output.write("asteroids.svg", &figure("Two asteroids", about, &names, &panels)?)?;
    Ok(format!("Asteroids: the energy is kept to {worst:.1e}, the momentum to {:.1e}.\n", momentum.amax()))
}

/// The target of the quadrotor, m.
const WANTED: [f64; 3] = [3.0, 0.0, 1.0];

/// Torque and thrust, by the proportional and derivative terms of the geometric tracking control on SE(3) of Lee, Leok
/// and McClamroch (2010), without their feed-forward terms. The thrust is along the third axis, and the torque turns
/// that axis to the desired direction. Gains are 2 N/m, 3 N s/m, 0.8 N m and 0.16 N m s.
#[allow(clippy::doc_markdown)] // a name
fn pushed(load: &SuspendedLoad, attitude: &SO3, x: Vector3<f64>, velocity: &SVector<f64, 9>) -> SVector<f64, 9> {
    let (turning, v) = (velocity.fixed_rows::<3>(0).into_owned(), velocity.fixed_rows::<3>(3).into_owned());
    let weight = (load.m + load.m_load) * load.g;
    let free = (Vector3::from(WANTED) - x) * 2.0 - v * 3.0 + load.up * weight;
    // The force carries at least a fifth of the weight, so it is neither zero nor along the first axis of space.
    let wanted = free + load.up * (0.2 * weight - free.dot(&load.up)).max(0.0);
    let third = wanted.normalize();
    let second = third.cross(&Vector3::x()).normalize();
    let axes = Matrix3::from_columns(&[second.cross(&third), second, third]);
    let r = attitude.as_matrix();
    let error = SO3::vee(&(axes.transpose() * r - r.transpose() * axes)) * 0.5;
    let torque = error * -0.8 - turning * 0.16;
    // The thrust isn't negative, as rotors don't pull.
    let thrust = r.column(2) * wanted.dot(&r.column(2)).max(0.0);
    SVector::from_fn(|k, _| match k {
        0..3 => torque[k],
        3..6 => thrust[k - 3],
        _ => 0.0,
    })
}

fn load(output: &mut Output) -> Result<String, Failure> {
    let (h, steps) = (0.002, 6_000_u32);
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(0.01, 0.01, 0.016))?;
    let K = NonstandardInertia::from_principal_moments(Vector3::new(1e-3, 1e-3, 1e-3))?;
    let system = SuspendedLoad { J_d, m: 1.0, K, m_load: 0.4, cable: Vector3::z() * -1.0, g: 9.81, up: Vector3::z() };
    let stepper = Stepper::new(system, h)?;
    let at_rest = (SO3::identity(), R3::from(Vector3::zeros()), SO3::identity());
    let mut state = stepper.start(at_rest, SVector::zeros())?;
    let (mut ways, mut swing, mut cables) = ([Vec::new(), Vec::new()], Vec::new(), Vec::new());
    let (energy, mut work) = (stepper.energy(&state), 0.0);
    for step in 0..=steps {
        let (attitude, x, cable) = state.attitude();
        let along = cable.as_matrix() * stepper.scene().cable;
        let (x, load) = (x.translation(), x.translation() + along);
        if step % 10 == 0 {
            for (way, place) in ways.iter_mut().zip([x, load]) {
                way.push((place.x, place.z));
            }
            swing.push((f64::from(step) * h, along.x.atan2(-along.z).to_degrees()));
        }
        if step % 250 == 0 && step <= 2_000 {
            cables.push(line(GREEN, vec![(x.x, x.z), (load.x, load.z)]));
        }
        let before = stepper.velocity(&state);
        let force = pushed(stepper.scene(), &attitude, x, &before);
        stepper.step_forced(&mut state, &force)?;
        work += force.dot(&(before + stepper.velocity(&state))) * (0.5 * h);
    }
    let (_, x, _) = state.attitude();
    let missed = (x.translation() - Vector3::from(WANTED)).norm();
    let unaccounted = (stepper.energy(&state) - energy - work).abs();
    let largest = swing.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
    // The gains alone lead to the target as `exp(-1.07 t)`, to some 1e-5 m; the load takes longer to settle. The system
    // is at rest before and after, where the energy has no error of second order: the error is a ten-millionth of the
    // lifting work of 14 J.
    check("way from the wanted place, m", missed, 1e-2)?;
    check("energy beside the rotors' work, J", unaccounted, 1e-6)?;
    let [flyer, load] = ways;
    let mut lines = cables;
    lines.extend([line(ORANGE, load), line(BLUE, flyer)]);
    let panels = [
        path("Where they are, m", ["x", "z"], lines),
        Panel::over_time("The cable against the vertical", "degrees", Vertical::Linear, vec![line(BLUE, swing)]),
    ];
    let names = [("quadrotor", BLUE), ("load", ORANGE), ("cable, each half second of the first 4 s", GREEN)];
    let about = "a control force for each step, h = 2 ms";
    output.write("load.svg", &figure("A load under a quadrotor", about, &names, &panels)?)?;
    Ok(format!(
        "Load: {missed:.2} m from its place after 12 s, the cable has swung up to {largest:.0}°; the energy is that of the \
         rotors' work to {unaccounted:.1e} J.\n"
    ))
}
