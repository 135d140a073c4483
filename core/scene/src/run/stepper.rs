//! The run of a scene: its stepper, its samples and events, and the words about its end.

use std::ops::Range;
use std::sync::Arc;

use liestep::accuracy::{Accuracy, Choice};
use liestep::motion::{AnyStepper, Moment};
use liestep::with::Scheme;
use liestep::{SetupError, StepError};

use crate::file::body::Kinetic;
use crate::file::mistake::Mistake;
use crate::file::quantity::{round, short};
use crate::file::sample::Sample;
use crate::file::scene_file::{Origin, SceneFile};
use crate::file::system::System;
use crate::run::choose;
use crate::run::make::{Note, Place, Run, Stop, Watch, fast_turn};
use crate::run::sample::{sample, watch};
use crate::run::simulate::{Begun, Sampler};

impl SceneFile {
    /// A note about a body that turns too far in a step of (3.13).
    fn fast_turn(&self) -> Option<Note> {
        let is_own_step = matches!(self.run.method, Scheme::Step) && !self.has_steps_of_its_own();
        let by_steps = self.body.is_some() && is_own_step && self.kinetic() == Kinetic::Rigid;
        let why = fast_turn(self.turn_of_a_step().filter(|_| by_steps)?)?;
        Some((self.origin.places.body, why))
    }

    /// A note about a law that reads the attitude in space beside a start relative to the local vertical.
    fn two_frames(&self) -> Option<Note> {
        let why = "this law reads attitude and velocity in space, and the start is relative to the local vertical: write \
                   `relative_to = \"local vertical\"`, or `relative_to = \"space\"` if that is meant";
        self.law_of_no_frame().map(|_| (self.origin.places.law, why.to_owned()))
    }

    /// The stepper by the method of the schedule and a step, s, at the start.
    pub(crate) fn begun(&self, step: f64) -> Result<Begun, Stop> {
        if let Some(system) = &self.system {
            return system.begun(self, step);
        }
        let of_kicks = self.check_kicks()?;
        let stepper = choose::by_steps(self, step)?;
        let state = self.start.state(&stepper).map_err(Stop::Start)?;
        let notes = of_kicks.into_iter().chain(self.fast_turn()).chain(self.two_frames());
        Ok(Begun { start: (stepper, state), notes: notes.collect() })
    }

    /// The cheapest choice of method and step for an accuracy.
    pub(crate) fn searched(&self, accuracy: Accuracy) -> Result<Choice, Stop> {
        if let Some(system) = &self.system {
            return system.searched(self, accuracy);
        }
        self.check_kicks()?;
        choose::searched(self, accuracy)
    }

    pub(crate) fn sampler(&self) -> Sampler {
        let file = self.clone();
        Arc::new(move |now: &Moment<'_, AnyStepper>| sample(&file, now))
    }

    /// The events that a run detects.
    pub(crate) fn watches(&self) -> Vec<Watch> {
        let sampler = self.sampler();
        let of_file = self.event.iter().map(|event| watch(event, self.picture.axis.0, &sampler));
        of_file.chain(self.system.iter().flat_map(|system| system.watches())).collect()
    }

    /// The mistake for a failed run, with its place in the file.
    pub(crate) fn mistake(&self, stop: Stop) -> Mistake {
        let Origin { path, places, .. } = &self.origin;
        let stop = match stop {
            Stop::Table(message) => return Mistake::of_table(path, message),
            stop => stop,
        };
        let (place, mut message) = match &self.system {
            Some(system) => system.mistake(&stop, self.run.nearest),
            None => self.mistake_of_body(&stop),
        };
        if let Stop::Accuracy(_) = stop {
            message.push_str(self.run.advice());
        }
        Mistake::of_run(path, place.unwrap_or(places.pace), message)
    }

    /// The place and the message of a failed run of one body, or of a Lagrangian of the file's own.
    fn mistake_of_body(&self, stop: &Stop) -> (Option<Place>, String) {
        let places = &self.origin.places;
        let mut message = stop.to_string();
        let place = match stop {
            Stop::Step { cause: StepError::BeyondSolvable { .. }, .. } => {
                if self.body.is_some() && self.kinetic() == Kinetic::Rigid {
                    message.push_str(", or `kinetic = \"geodesic\"` of the body, which may turn further");
                }
                let rate = self.start.rate().filter(|_| self.group.is_rotation()).unwrap_or_default().amax();
                let fastest = short(rate);
                // A number like 180 suggests degrees.
                if rate >= 20.0 && fastest.len() < 5 {
                    let hint = format!("; numbers alone are in rad/s: were degrees meant, write \"{fastest} deg/s\"");
                    message.push_str(&hint);
                }
                return (None, message);
            }
            // Requirements of a method on the scene.
            Stop::Setup(
                SetupError::NotSeparable { .. }
                | SetupError::InertiaMismatch { .. }
                | SetupError::BiasMismatch
                | SetupError::NoForceGradient,
            ) => places.method,
            Stop::Setup(SetupError::InvalidStep { .. }) => places.pace,
            Stop::Setup(_) => places.body,
            Stop::Spring(..) => places.spring,
            Stop::Start(SetupError::NotInGroup { .. }) => places.attitude,
            Stop::Start(_) => places.start,
            _ => places.pace,
        };
        (Some(place), message)
    }

    /// The order of the scene's method.
    pub(crate) fn order(&self) -> u32 {
        match self.run.method {
            Scheme::Step => self.own_order(),
            scheme => scheme.order(),
        }
    }

    /// The places of attitude and velocity among the numbers of a sample, on a group without bodies.
    pub(crate) fn places(&self) -> Option<[Range<usize>; 2]> {
        (!self.group.is_rotation()).then(|| [self.group.attitude(), self.group.velocity()])
    }

    /// The failure of a run that came to its end.
    pub(crate) fn fault(&self, run: &Run) -> Option<Stop> {
        self.system.as_ref().and_then(|_| System::fault(run))
    }

    /// The number of orbits in a run, with their period; nothing without an orbit.
    pub(crate) fn orbits(&self, run: &Run) -> String {
        let (Some(orbit), Some(last)) = (&self.orbit, run.samples().last()) else { return String::new() };
        let (number, period) = (round(last.time / orbit.period()), short(orbit.period()));
        let orbits = if number == "1" { "orbit" } else { "orbits" };
        format!(", {number} {orbits} of {period} s")
    }

    /// The part of a summary behind the energy: the ends of a run in words.
    pub(crate) fn ends_in_words(&self, run: &Run, ends: [&Sample; 2]) -> String {
        if let Some(system) = &self.system {
            return system.gaps(run);
        }
        let momenta = ends.map(|sample| &sample.numbers[self.group.in_space()]);
        let norms = momenta.map(|parts| parts.iter().map(|part| part * part).sum::<f64>().sqrt());
        if !self.group.is_rotation() {
            let [before, after] = norms.map(short);
            return format!(", norm of the momentum {before} → {after}{}", self.last_state(ends[1]));
        }
        // Components show a momentum along the vertical that is conserved alone; rounding errors of zero are zero.
        let largest = norms[0].max(norms[1]);
        let number = |part: &f64| short(if part.abs() <= 1e-13 * largest { 0.0 } else { *part });
        let [before, after] = momenta.map(|parts| parts.iter().map(number).collect::<Vec<_>>().join(", "));
        format!("\n  momentum in space [{before}] → [{after}] kg m²/s{}", self.last_state(ends[1]))
    }
}
