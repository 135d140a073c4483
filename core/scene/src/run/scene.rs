//! The run of a scene with one body.

use std::error::Error;

use liestep::motion::Moment;
use liestep::recording::Sink;
use liestep::with::Scheme;
use liestep::{SetupError, StepError};

use crate::file::body::Kinetic;
use crate::file::column::Column;
use crate::file::mistake::Mistake;
use crate::file::pointing::at_the_end;
use crate::file::quantity::short;
use crate::file::sample::Sample;
use crate::file::scene::{Origin, SceneFile};
use crate::file::schedule::Pace;
use crate::run::choose;
use crate::run::course::{BodyIntegrator, MemberStart, sample};
use crate::run::data::Whole;
use crate::run::make::{Listeners, Run, Stop, fast_turn};

impl SceneFile {
    /// Simulates the scene.
    ///
    /// # Errors
    ///
    /// A [`Mistake`] of the kind [`Run`](crate::Kind::Run) where the scene can't be started or a step fails.
    pub fn run(&self) -> Result<Run, Mistake> {
        self.run_with(&mut |_| (), None)
    }

    /// Simulates the scene. `progress` is called up to a hundred times with the completed share of the run, from
    /// 0 to 1. The table has the time and the scene's [columns](Self::columns), with a row for each `every`-th step and for
    /// the last. Rows are written during the run, so that a run that fails leaves those up to then.
    ///
    /// ```
    /// # fn recorded(scene: &liestep_scene::SceneFile) -> Result<(), Box<dyn std::error::Error>> {
    /// use liestep::recording::Csv;
    ///
    /// scene.run_with(&mut |_| (), Some(&mut Csv::create("top.csv")?))?;
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// The errors of [`run`](Self::run), and one of the kind [`Table`](crate::Kind::Table) where a row can't be
    /// written.
    pub fn run_with<'a>(
        &self,
        progress: &'a mut dyn FnMut(f64),
        table: Option<&'a mut dyn Sink>,
    ) -> Result<Run, Mistake> {
        let of_kicks = self.check_kicks().map_err(|stop| self.mistake(stop))?;
        let mut run = choose::run(self, Listeners { progress, table }).map_err(|stop| self.mistake(stop))?;
        let Origin { path, places } = &self.origin;
        let notes = of_kicks.into_iter().chain(self.fast_turn().map(|why| (places.body, why)));
        run.notes = notes.map(|(place, why)| Mistake::of_run(path, place, why)).collect();
        Ok(run)
    }

    /// A note about a body that turns too far in a step of (3.13).
    fn fast_turn(&self) -> Option<String> {
        let is_own_step = matches!(self.run.method, Scheme::Step) && !self.has_steps_of_its_own();
        let by_steps = self.body.is_some() && is_own_step && self.kinetic() == Kinetic::Rigid;
        fast_turn(self.turn_of_a_step().filter(|_| by_steps)?)
    }

    /// Simulates the scene up to a number of steps. A scene with an accuracy is simulated to its end, as its step isn't
    /// known before.
    ///
    /// # Errors
    ///
    /// The errors of [`run`](Self::run).
    pub fn first(&self, most: u32) -> Result<Run, Mistake> {
        let mut first = self.clone();
        if let Pace::Step { step, steps } = &mut first.run.pace {
            *steps = most.min(*steps);
            first.run.duration = first.run.duration.min(*step * f64::from(*steps));
        }
        first.run()
    }

    /// The stepper of the scene, with its initial state.
    ///
    /// # Errors
    ///
    /// A [`Mistake`] of the kind [`Run`](crate::Kind::Run) where the scene can't be started.
    pub fn stepper(&self) -> Result<MemberStart, Mistake> {
        choose::stepper(self).map_err(|stop| self.mistake(stop))
    }

    /// The scene's step as data, for members of its ensemble in lanes. `None` for another method, for varying steps, and for
    /// effects along orbits.
    #[must_use]
    pub fn whole(&self) -> Option<Whole> {
        choose::whole(self)
    }

    /// The stepper and the initial state for lanes, from the step of a file that differs from this one in numbers
    /// alone.
    ///
    /// # Errors
    ///
    /// The errors of [`stepper`](Self::stepper).
    pub fn in_lanes(&self, whole: &Whole) -> Result<MemberStart, Mistake> {
        choose::member(self, whole).map_err(|stop| self.mistake(stop))
    }

    /// The numbers of these columns at a moment, one after the other. The sign of a quaternion is arbitrary.
    #[must_use]
    pub fn numbers<I: BodyIntegrator>(&self, columns: &[Column], now: &Moment<'_, I>) -> Vec<f64> {
        let now = sample(&self.view(), now);
        Column::row(columns, &now, &now)
    }

    /// The mistake for a failed run, with its place in the file.
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
            Stop::Accuracy(_) if self.run.is_left_open => {
                message.push_str(
                    "; a run without a `step` is one for an accuracy of 1e-6: give a `step`, or an `accuracy`",
                );
                places.pace
            }
            Stop::Setup(SetupError::InvalidStep { .. }) | Stop::Accuracy(_) | Stop::Step { .. } | Stop::Other(_) => {
                places.pace
            }
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

    /// The events of a run as comma-separated values: name, 1 where the quantity rose and 0 where it fell, time, and
    /// the scene's columns.
    ///
    /// # Errors
    ///
    /// None, as it is written to memory.
    pub fn event_table(&self, run: &Run) -> Result<String, Box<dyn Error + Send + Sync>> {
        run.event_table(self.columns(), self.events())
    }

    /// Lines about the start and the end of a run, its events, and the table of the choice if there was one.
    #[must_use]
    pub fn summary(&self, run: &Run) -> String {
        let events = run.events_in_words(self.events());
        let unit = if self.group.is_rotation() { " kg m²/s" } else { "" };
        let norm = |sample: &Sample| sample.numbers[self.group.in_space()].iter().map(|part| part * part).sum::<f64>();
        let ends = run.summary(&self.title, &self.sum(), self.group.unit_of_energy(), |first, last| {
            let [before, after] = [first, last].map(|sample| short(norm(sample).sqrt()));
            let body = last.bodies.first().map(|body| (body.quaternion, body.velocity));
            let end = body.map(|body| at_the_end(&self.view(), body, &last.numbers)).unwrap_or_default();
            format!(", momentum {before} → {after}{unit}{end}{events}")
        });
        let choice = run.choice.as_ref().map(|choice| {
            let (error, accuracy, method) = (choice.error, choice.accuracy.tolerance, choice.chosen().scheme);
            if self.run.is_left_open {
                format!("  the end is off by at most about {error:.0e}, by a method for {accuracy:e}: {method}\n")
            } else {
                choice.to_string()
            }
        });
        let choice = choice.unwrap_or_default();
        format!("{ends}{choice}")
    }
}
