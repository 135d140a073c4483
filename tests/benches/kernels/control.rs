//! The time of a search, and the peak memory so far if the system reports it: the shortest half turn of a sphere, and
//! the least effort of many steps.

use std::f64::consts::{PI, TAU};
use std::time::Instant;

use liestep::effects::RigidBody;
use liestep::{NonstandardInertia, SO3, Stepper};
use liestep_control::{Control, Cost, Target};
use nalgebra::{UnitQuaternion, Vector3};

use crate::kernel::Failure;
use crate::most_memory;

/// Prints the searches with these numbers of steps, or all.
#[allow(clippy::cast_precision_loss)] // small counts
pub(crate) fn print(words: &[&str]) -> Result<(), Failure> {
    let tasks = [(50_u32, 1.0), (200, 1.0), (100, 0.0), (1_000, 0.0), (10_000, 0.0), (100_000, 0.0)];
    let only = words.iter().map(|word| word.parse()).collect::<Result<Vec<u32>, _>>()?;
    for (steps, time) in tasks.into_iter().filter(|(steps, _)| only.is_empty() || only.contains(steps)) {
        let (moments, angles) =
            if time > 0.0 { ([1.0; 3], [0.0, 0.0, PI]) } else { ([1.0, 2.0, 2.5], [0.9, -0.7, 1.1]) };
        let J_d = NonstandardInertia::from_principal_moments(Vector3::from(moments))?;
        let stepper = Stepper::new(RigidBody { J_d }, 3.5 / f64::from(steps))?;
        let start = stepper.start(SO3::identity(), Vector3::zeros())?;
        let end = UnitQuaternion::from_scaled_axis(Vector3::from(angles));
        let mut task = Control::new(&stepper, start, steps as usize, Target::rest(end));
        if time > 0.0 {
            // The guessed torque goes round once during the turn.
            let guess = move |step: usize, axis: usize| {
                let share = step as f64 / f64::from(steps);
                let spin = if share < 0.5 { 0.9 } else { -0.9 };
                [0.5 * (TAU * (share - 0.1)).cos(), 0.5 * (TAU * (share - 0.4)).cos(), spin][axis]
            };
            task = task.bounds(|_, _| (-1.0, 1.0)).guess(guess).minimise(Cost { time, effort: 0.0 });
        }
        let mut least = f64::INFINITY;
        let mut plan = task.solve()?;
        for _ in 0..if steps > 1_000 { 1 } else { 5 } {
            let begin = Instant::now();
            plan = task.solve()?;
            least = least.min(begin.elapsed().as_secs_f64() * 1e3);
        }
        let each = 1e3 * least / f64::from(steps) / plan.iterations.max(1) as f64;
        let (duration, iterations, verdict) = (plan.duration, plan.iterations, plan.verdict);
        let most = most_memory();
        println!(
            "{steps} steps: {duration:.5} s, {least:.1} ms, {iterations} iterations of {each:.2} µs a step, {verdict:?}, {most}"
        );
    }
    Ok(())
}
