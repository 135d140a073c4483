//! The run of one body, or of a Lagrangian of the file's own.

use std::ops::Range;
use std::sync::Arc;

use liestep::accuracy::{Accuracy, Choice};
use liestep::motion::{AnyStepper, Moment};
use liestep::with::Scheme;
use liestep::{SetupError, StepError};

use crate::file::body::Kinetic;
use crate::file::column::Column;
use crate::file::common::Parts as _;
use crate::file::mistake::Mistake;
use crate::file::pointing::at_the_end;
use crate::file::quantity::short;
use crate::file::sample::Sample;
use crate::file::scene::{Origin, SceneFile};
use crate::run::choose;
use crate::run::course::{sample, watch};
use crate::run::make::{Note, Run, Stop, Watch, fast_turn};
use crate::run::moving::{Begun, Moving, Sampler};

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
}

impl Moving for SceneFile {
    fn begun(&self, step: f64) -> Result<Begun, Stop> {
        let of_kicks = self.check_kicks()?;
        let stepper = choose::by_steps(self, step)?;
        let state = self.start.state(&stepper).map_err(Stop::Start)?;
        let notes = of_kicks.into_iter().chain(self.fast_turn()).chain(self.two_frames());
        Ok(Begun { start: (stepper, state), notes: notes.collect() })
    }

    fn searched(&self, accuracy: Accuracy) -> Result<Choice, Stop> {
        self.check_kicks()?;
        choose::searched(self, accuracy)
    }

    fn sample(&self, now: &Moment<'_, AnyStepper>) -> Sample {
        sample(&self.view(), now)
    }

    fn sampler(&self) -> Sampler {
        let view = self.view();
        Arc::new(move |now: &Moment<'_, AnyStepper>| sample(&view, now))
    }

    fn watches(&self) -> Vec<Watch> {
        let sampler = self.sampler();
        self.event.iter().map(|event| watch(event, self.picture.axis.0, &sampler)).collect()
    }

    fn mistake(&self, stop: Stop) -> Mistake {
        let Origin { path, places } = &self.origin;
        let mut message = stop.to_string();
        let place = match stop {
            Stop::Table(message) => return Mistake::of_table(path, message),
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
                places.pace
            }
            Stop::Accuracy(_) => {
                message.push_str(self.run.advice());
                places.pace
            }
            Stop::Setup(SetupError::InvalidStep { .. }) | Stop::Step { .. } | Stop::Other(_) => places.pace,
            // Requirements of a method on the scene.
            Stop::Setup(
                SetupError::NotSeparable { .. }
                | SetupError::InertiaMismatch { .. }
                | SetupError::BiasMismatch
                | SetupError::NoForceGradient,
            ) => places.method,
            Stop::Setup(_) => places.body,
            Stop::Spring(..) => places.spring,
            Stop::Start(SetupError::NotInGroup { .. }) => places.attitude,
            Stop::Start(_) => places.start,
        };
        Mistake::of_run(path, place, message)
    }

    fn order(&self) -> u32 {
        match self.run.method {
            Scheme::Step => self.own_order(),
            scheme => scheme.order(),
        }
    }

    fn errors(&self) -> Vec<Column> {
        let mut all = Column::of_group(&self.group);
        all.retain(|column| ["energy-error", "momentum-error"].contains(&column.key()));
        all
    }

    fn places(&self) -> Option<[Range<usize>; 2]> {
        (!self.group.is_rotation()).then(|| [self.group.attitude(), self.group.velocity()])
    }

    fn unit_of_energy(&self) -> &'static str {
        self.group.unit_of_energy()
    }

    fn ends_in_words(&self, _run: &Run, ends: [&Sample; 2]) -> String {
        let unit = if self.group.is_rotation() { " kg m²/s" } else { "" };
        let norm = |sample: &Sample| sample.numbers[self.group.in_space()].iter().map(|part| part * part).sum::<f64>();
        let [before, after] = ends.map(|sample| short(norm(sample).sqrt()));
        let body = ends[1].bodies.first().map(|body| (body.quaternion, body.velocity));
        let end = body.map(|body| at_the_end(&self.view(), body, &ends[1].numbers)).unwrap_or_default();
        format!(", momentum {before} → {after}{unit}{end}")
    }
}
