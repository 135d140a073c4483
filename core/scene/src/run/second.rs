//! Error of a run's end, estimated by a second run with other steps (Richardson).

use std::num::NonZeroU32;
use std::ops::Range;

use nalgebra::Vector3;

use crate::file::quantity::round;
use crate::file::sample::Sample;
use crate::file::scene::Scene;
use crate::file::schedule::Pace;
use crate::run::make::{Listeners, Run, Stop};

/// Difference of attitudes, rad, beyond which two runs are different motions.
const ANOTHER: f64 = 1.0;
/// Difference of velocities, relative to the largest, beyond which two runs are different motions.
const SHARE: f64 = 0.5;

/// Differences of two states, the largest among all bodies: rad, rad/s, m and m/s; on a group other than SO(3) those of
/// the attitude's columns and of the velocity, in the places of the second pair.
struct Differences([f64; 4]);

impl Differences {
    fn of(one: &Sample, other: &Sample, parts: Option<&Places>) -> Self {
        if let Some(parts) = parts {
            let [attitude, velocity] = parts.clone().map(|part| distance(one, other, part));
            return Self([0.0, 0.0, attitude, velocity]);
        }
        let mut most = [0.0_f64; 4];
        for (one, other) in one.bodies.iter().zip(&other.bodies) {
            // |R − R'| = √8 sin(θ/2)
            let sine = (one.matrix() - other.matrix()).norm() / 8.0_f64.sqrt();
            let apart = [
                2.0 * sine.min(1.0).asin(),
                (one.velocity - other.velocity).norm(),
                (one.position - other.position).norm(),
                (one.moving - other.moving).norm(),
            ];
            most.iter_mut().zip(apart).for_each(|(most, apart)| *most = most.max(apart));
        }
        Self(most)
    }
}

/// The places of attitude and velocity among the numbers of a sample.
type Places = [Range<usize>; 2];

/// The norm of the difference of some numbers of two samples.
fn distance(one: &Sample, other: &Sample, part: Range<usize>) -> f64 {
    let pairs = one.numbers[part.clone()].iter().zip(&other.numbers[part]);
    pairs.map(|(one, other)| (one - other).powi(2)).sum::<f64>().sqrt()
}

/// The largest angular and linear velocities, rad/s and m/s, and the largest distance of a body from its start, m.
fn largest(run: &Run, parts: Option<&Places>) -> [f64; 3] {
    let Some(first) = run.samples().first() else { return [0.0; 3] };
    let mut most = [0.0_f64; 3];
    if let Some([attitude, velocity]) = parts {
        for sample in run.samples() {
            let speed = sample.numbers[velocity.clone()].iter().map(|part| part * part).sum::<f64>().sqrt();
            most = [0.0, most[1].max(speed), most[2].max(distance(sample, first, attitude.clone()))];
        }
        return most;
    }
    for body in run.samples().iter().flat_map(|sample| sample.bodies.iter().zip(&first.bodies)) {
        let (now, start) = body;
        let size = |of: &Vector3<f64>| of.norm();
        let all = [size(&now.velocity), size(&now.moving), (now.position - start.position).norm()];
        most.iter_mut().zip(all).for_each(|(most, one)| *most = most.max(one));
    }
    most
}

/// Largest difference of the times of two samples that are compared, in steps. Clocks of an orbit are integrated, and their times
/// agree to some digits.
const SAME_TIME: f64 = 1e-3;

/// The line about the end of a run; `order` is that of its method, and `size` the length of the system, m. `again` simulates by this
/// number of steps in the place of the first, which is that of the run, or of an orbit. A scene on a group other than SO(3) has
/// `parts`.
fn line(
    run: &Run,
    (order, steps, size): (u32, u32, f64),
    parts: Option<&Places>,
    again: impl Fn(u32) -> Result<Run, Stop>,
) -> Option<String> {
    // The second run has half as many steps; twice as many if that isn't a whole number, or if longer steps fail.
    let longer = (steps % 2 == 0).then(|| again(steps / 2).ok()).flatten();
    let (second, is_longer) = match longer {
        Some(second) => (second, true),
        None => (again(steps.checked_mul(2)?).ok()?, false),
    };
    let share = f64::from(2_u32.saturating_pow(order));
    let factor = if is_longer { 1.0 / (share - 1.0) } else { share / (share - 1.0) };
    let [turning, moving, way] = largest(run, parts);
    // Slower motions are rounding errors.
    let floor = 1e-6 / run.samples().last()?.time;
    let limits = [ANOTHER, SHARE * turning.max(floor), SHARE * way.max(1e-6 * size), SHARE * moving.max(floor * size)];
    let another = |Differences(apart): &Differences| {
        let place = if parts.is_some() { "attitude" } else { "position" };
        let names = ["attitude", "angular velocity", place, "velocity"].into_iter();
        names.zip(apart.iter().zip(&limits)).find_map(|(name, (apart, limit))| (apart > limit).then_some(name))
    };
    let mut seconds = second.samples().iter().peekable();
    let mut end = None;
    for sample in run.samples() {
        let early = |other: &&&Sample| other.time < sample.time - SAME_TIME * run.step();
        while seconds.next_if(|other| early(&other)).is_some() {}
        let is_now = |other: &&&Sample| other.time < sample.time + SAME_TIME * run.step();
        let Some(other) = seconds.peek().filter(is_now) else { continue };
        let apart = Differences::of(sample, other, parts);
        if let Some(name) = another(&apart) {
            return Some(format!(
                "  the end isn't determined: by steps of {} s{} the {name} is another from t = {} s on\n",
                round(second.step()),
                second.average,
                round(sample.time)
            ));
        }
        end = Some(apart);
    }
    let [turn, rate, place, speed] = end?.0.map(|apart| apart * factor);
    let second = format!("{} s{}", round(second.step()), second.average);
    if parts.is_some() {
        return Some(format!(
            "  the end is off by about {place:.0e} in the attitude and {speed:.0e} in the velocity, as steps of {second} \
             show\n"
        ));
    }
    let shifted = if run.samples().first()?.bodies.len() > 1 || place + speed > 0.0 {
        format!(", {place:.0e} m and {speed:.0e} m/s")
    } else {
        String::new()
    };
    Some(format!("  the end is off by about {turn:.0e} rad and {rate:.0e} rad/s{shifted}, as steps of {second} show\n"))
}

impl Scene {
    /// A line about the error at the end of a run, estimated by a second run with half as many steps, or twice as many.
    /// Empty where steps vary, but for a number of steps per orbit, or were chosen for an accuracy.
    #[must_use]
    pub fn end_error(&self, run: &Run) -> String {
        let file = &self.file;
        let per_orbit = file.run.steps_per_orbit;
        if per_orbit.is_none() && file.has_steps_of_its_own() || run.choice.is_some() {
            return String::new();
        }
        let of_run = u32::try_from(run.steps()).ok().filter(|steps| *steps > 0);
        let Some(steps) = of_run.map(|steps| per_orbit.map_or(steps, NonZeroU32::get)) else { return String::new() };
        let again = |second: u32| {
            let (share, mut file) = (f64::from(steps) / f64::from(second), (**file).clone().unwatched());
            file.run.steps_per_orbit = per_orbit.and_then(|_| NonZeroU32::new(second));
            let of_run = u64::from(second) * run.steps() / u64::from(steps);
            let pace = u32::try_from(of_run).map(|steps| Pace::Step { step: run.step() * share, steps });
            file.run.pace = pace.map_err(|_| Stop::Other("too many steps".to_owned()))?;
            file.simulate(Listeners { progress: &mut |_| (), table: None })
        };
        let size = file.system.as_ref().map_or(1.0, |system| system.size());
        line(run, (file.order(), steps, size), file.places().as_ref(), again).unwrap_or_default()
    }
}
