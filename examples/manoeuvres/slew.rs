//! Turns of one body.

use std::f64::consts::{PI, TAU};

use liestep::effects::{Gravity, RigidBody};
use liestep::gradients::Plant;
use liestep::{NonstandardInertia, SO3, Stepper};
use liestep_control::{Control, ControlPlan, Cost, Target};
use nalgebra::{UnitQuaternion, Vector3};
use workbench::drawing::path;
use workbench::plot::{BLUE, GREEN, Line, ORANGE, Path, VERMILION};

use crate::{Drawing, Part, found, given, picture};

fn turned(angles: [f64; 3]) -> SO3 {
    UnitQuaternion::from_scaled_axis(Vector3::from(angles)).into()
}

/// The torques of a plan, N m.
fn torques<M: Plant>(plan: &ControlPlan<M>) -> Vec<[f64; 3]> {
    let scalars = |input| {
        let scalars = M::numbers(input);
        [scalars[0], scalars[1], scalars[2]]
    };
    plan.inputs.iter().map(scalars).collect()
}

/// The directions of a body vector during the manoeuvre.
fn pointed<M: Plant<Attitude = SO3>>(plan: &ControlPlan<M>, vector: Vector3<f64>) -> Vec<Vector3<f64>> {
    plan.states.iter().map(|state| plan.stepper.attitude(state).as_matrix() * vector).collect()
}

/// The torques of a plan over time.
fn panel(step: f64, torques: &[[f64; 3]]) -> Part<'static> {
    given(("Torque about the body's axes", "N m", &[("1", BLUE), ("2", ORANGE), ("3", GREEN)]), step, torques)
}

/// The shortest half turn, compared with that about its axis.
pub(crate) fn half_turn() -> Drawing {
    let steps = 200;
    let J_d = NonstandardInertia::from_principal_moments(Vector3::repeat(1.0))?;
    let stepper = Stepper::new(RigidBody { J_d }, 3.5 / f64::from(steps))?;
    let start = stepper.start(SO3::identity(), Vector3::zeros())?;
    // The guess differs from the turn about the axis, where the gradient vanishes by symmetry.
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
    let tip = pointed(&plan, Vector3::x());
    let (title, axis) = ("The body's first axis in space", (Vector3::z(), "axis"));
    let lines = vec![
        Line { colour: VERMILION, width: 4, points: vec![(0.0, 0.0), (0.0, most)] },
        Line { colour: BLUE, width: 4, points: polhode },
    ];
    let parts = [
        Part::Way(Path { title, colour: BLUE, width: 4, points: &tip, axis }),
        Part::Lines(
            path("Polhode", ["Ω1, rad/s", "Ω3, rad/s"], lines),
            &[("shortest", BLUE), ("about the axis", VERMILION)],
        ),
        panel(plan.stepper.step_size(), &torques(&plan)),
    ];
    let title = format!("Half a turn in {:.4} s, about the axis in {about_the_axis:.4} s", plan.duration);
    let below = "a sphere of 1 kg m², at most 1 N m about each axis, from rest to rest";
    Ok((report, picture(&title, below, &parts)?))
}

/// A turn past the sun.
pub(crate) fn sun() -> Drawing {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))?;
    let stepper = Stepper::new(RigidBody { J_d }, 0.02)?;
    let start = stepper.start(SO3::identity(), Vector3::zeros())?;
    let (sun, angle) = (Vector3::new(0.75_f64.cos(), 0.75_f64.sin(), 0.1).normalize(), 0.3_f64);
    let task = || Control::new(&stepper, start, 100, Target::rest(turned([0.0, 0.0, 1.5])));
    let free = task().solve()?;
    let plan =
        task().keep(move |_, motion| angle.cos() - sun.dot(&(motion.attitude().as_matrix() * Vector3::x()))).solve()?;
    let report = format!("{}; effort {:.4} (N m)² s, {:.4} through the sun", found(&plan)?, plan.cost, free.cost);
    let (title, points, axis) = ("Where the instrument looks", &pointed(&plan, Vector3::x()), (sun, "sun"));
    let way = Part::Way(Path { title, colour: BLUE, width: 4, points, axis });
    let below = "the least effort with which an instrument along the first axis keeps 0.3 rad away";
    Ok((report, picture("A turn round the sun", below, &[way, panel(0.02, &torques(&plan))])?))
}

/// A top is swung up.
pub(crate) fn top() -> Drawing {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.2, 1.2, 0.3))?;
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::z() * 0.5, up: Vector3::z() };
    let stepper = Stepper::new(RigidBody { J_d } + gravity, 0.02)?;
    let start = stepper.start(turned([PI - 0.05, 0.0, 0.0]), Vector3::zeros())?;
    let plan = Control::new(&stepper, start, 200, Target::rest(SO3::identity()))
        .bounds(|_, _| (-3.0, 3.0))
        .guess(|step, axis| if axis == 0 { (0.03 * step as f64).sin() } else { 0.0 })
        .solve()?;
    let report = format!("{}; effort {:.3} (N m)² s, at most 3 N m of the weight's 4.9", found(&plan)?, plan.cost);
    let (title, points, axis) = ("Its axis", &pointed(&plan, Vector3::z()), (Vector3::z(), "up"));
    let way = Part::Way(Path { title, colour: BLUE, width: 4, points, axis });
    let below = "by at most 3 N m, where its weight has 4.9 N m on the horizontal";
    Ok((report, picture("A top is swung up in 4 s", below, &[way, panel(0.02, &torques(&plan))])?))
}
