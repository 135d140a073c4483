//! Turns of one body.

use std::f64::consts::{PI, TAU};

use liestep::effects::{Gravity, RigidBody};
use liestep::gradients::Input;
use liestep::mechanics::SecondDerivatives;
use liestep::motion::Plan;
use liestep::{NonstandardInertia, SO3, Stepper};
use liestep_control::{Control, ControlPlan, Cost, Target};
use nalgebra::{UnitQuaternion, Vector3};
use workbench::args::Failure;
use workbench::plot::{
    BLUE, GREEN, Line, ORANGE, Panel, Path, PlotResult, VERMILION, Vertical, heading, legend, px, render, sphere,
};

use crate::{Drawn, found, over_time};

fn turned(angles: [f64; 3]) -> SO3 {
    UnitQuaternion::from_scaled_axis(Vector3::from(angles)).into()
}

/// The torques of a plan, N m.
fn torques<S, P>(plan: &ControlPlan<S, P>) -> Vec<[f64; 3]>
where
    S: SecondDerivatives<Scalar = f64, Group = SO3>,
    P: Plan<S>,
{
    let scalars = |input: &Input<Vector3<f64>, S::Advected>| {
        let scalars: Vec<f64> = input.scalars();
        [scalars[0], scalars[1], scalars[2]]
    };
    plan.inputs.iter().map(scalars).collect()
}

/// Where a vector of the body points on the way.
fn pointed<S, P>(plan: &ControlPlan<S, P>, vector: Vector3<f64>) -> Vec<Vector3<f64>>
where
    S: SecondDerivatives<Scalar = f64, Group = SO3>,
    P: Plan<S>,
{
    plan.states.iter().map(|state| state.attitude().as_matrix() * vector).collect()
}

/// A way on the sphere, and the torques of a plan.
fn picture(
    texts: [&str; 3],
    path: &[Vector3<f64>],
    axis: (Vector3<f64>, &str),
    (step, torques): (f64, &[[f64; 3]]),
) -> Result<String, Failure> {
    let drawn: PlotResult<String> = render((900, 420), |area| {
        heading(area, texts[0], texts[1])?;
        let (_, body) = area.split_vertically(px(56));
        let (left, right) = body.split_horizontally(px(380));
        sphere(&left, &Path { title: texts[2], colour: BLUE, width: 4, points: path, axis })?;
        let torques =
            Panel::over_time("Torque about the body's axes", "N m", Vertical::Linear, over_time(step, torques));
        torques.draw(&right)?;
        legend(&right, (70, 34), &[("1", BLUE), ("2", ORANGE), ("3", GREEN)])
    });
    drawn
}

/// The shortest half turn, beside that about its axis.
pub(crate) fn half_turn() -> Drawn {
    let steps = 200;
    let J_d = NonstandardInertia::from_principal_moments(Vector3::repeat(1.0))?;
    let stepper = Stepper::new(RigidBody { J_d }, 3.5 / f64::from(steps))?;
    let start = stepper.start(SO3::identity(), Vector3::zeros())?;
    // Beside the way about the axis, where the gradient vanishes by symmetry.
    let guess = |step: usize, axis: usize| {
        let share = step as f64 / f64::from(steps);
        let spin = if share < 0.5 { 0.9 } else { -0.9 };
        [0.5 * (TAU * (share - 0.1)).cos(), 0.5 * (TAU * (share - 0.4)).cos(), spin][axis]
    };
    let plan = Control::new(&stepper, start, 200, Target::rest(turned([0.0, 0.0, PI])))
        .bounds(|_, _| (-1.0, 1.0))
        .minimise(Cost { time: 1.0, effort: 0.0 })
        .guess(guess)
        .solve()?;
    let about_the_axis = 2.0 * PI.sqrt();
    let report = format!("{}; {:.5} s, about the axis {about_the_axis:.5} s (2√π)", found(&plan)?, plan.duration);
    let polhode: Vec<(f64, f64)> = plan.states.iter().map(|state| (state.momentum().x, state.momentum().z)).collect();
    let most = about_the_axis / 2.0;
    let drawn: PlotResult<String> = render((900, 420), |area| {
        let title = format!("Half a turn in {:.4} s, about the axis in {about_the_axis:.4} s", plan.duration);
        heading(area, &title, "a sphere of 1 kg m², at most 1 N m about each axis, from rest to rest")?;
        let (_, body) = area.split_vertically(px(56));
        let (left, rest) = body.split_horizontally(px(290));
        let (middle, right) = rest.split_horizontally(px(240));
        let tip = pointed(&plan, Vector3::x());
        let axis = (Vector3::z(), "axis");
        sphere(&left, &Path { title: "The body's first axis in space", colour: BLUE, width: 4, points: &tip, axis })?;
        let lines = vec![
            Line { colour: VERMILION, width: 4, points: vec![(0.0, 0.0), (0.0, most)] },
            Line { colour: BLUE, width: 4, points: polhode },
        ];
        Panel {
            title: "Polhode: Ω3 over Ω1",
            across: "Ω1, rad/s",
            up: "Ω3, rad/s",
            vertical: Vertical::Linear,
            function: false,
            lines,
        }
        .draw(&middle)?;
        legend(&middle, (66, 34), &[("shortest", BLUE), ("axis", VERMILION)])?;
        let lines = over_time(plan.stepper.step_size(), &torques(&plan));
        Panel::over_time("Torque", "N m", Vertical::Linear, lines).draw(&right)?;
        legend(&right, (70, 34), &[("1", BLUE), ("2", ORANGE), ("3", GREEN)])
    });
    Ok((report, drawn?))
}

/// A turn past the sun.
pub(crate) fn sun() -> Drawn {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
    let stepper = Stepper::new(RigidBody { J_d }, 0.02)?;
    let start = stepper.start(SO3::identity(), Vector3::zeros())?;
    let (sun, angle) = (Vector3::new(0.75_f64.cos(), 0.75_f64.sin(), 0.1).normalize(), 0.3_f64);
    let task = || Control::new(&stepper, start, 100, Target::rest(turned([0.0, 0.0, 1.5])));
    let free = task().solve()?;
    let plan =
        task().keep(move |_, motion| angle.cos() - sun.dot(&(motion.attitude().as_matrix() * Vector3::x()))).solve()?;
    let report = format!("{}; effort {:.4} (N m)² s, {:.4} through the sun", found(&plan)?, plan.cost, free.cost);
    let path = pointed(&plan, Vector3::x());
    let texts = [
        "A turn round the sun",
        "the least effort with which an instrument along the first axis keeps 0.3 rad away",
        "Where the instrument looks",
    ];
    Ok((report, picture(texts, &path, (sun, "sun"), (0.02, &torques(&plan)))?))
}

/// A top is swung up.
pub(crate) fn top() -> Drawn {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.2, 1.2, 0.3))?;
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z() * 0.5, up: Vector3::z() };
    let stepper = Stepper::new(RigidBody { J_d } + gravity, 0.02)?;
    let start = stepper.start(turned([PI - 0.05, 0.0, 0.0]), Vector3::zeros())?;
    let plan = Control::new(&stepper, start, 200, Target::rest(SO3::identity()))
        .bounds(|_, _| (-3.0, 3.0))
        .guess(|step, axis| if axis == 0 { (0.03 * step as f64).sin() } else { 0.0 })
        .solve()?;
    let report = format!("{}; effort {:.3} (N m)² s, at most 3 N m of the weight's 4.9", found(&plan)?, plan.cost);
    let path = pointed(&plan, Vector3::z());
    let texts =
        ["A top is swung up in 4 s", "by at most 3 N m, where its weight has 4.9 N m on the horizontal", "Its axis"];
    Ok((report, picture(texts, &path, (Vector3::z(), "up"), (0.02, &torques(&plan)))?))
}
