//! Runs of scenes of any parts: by the steps of the file, or by those of the cheapest method for an accuracy.

use std::sync::Arc;

use liestep::accuracy::Accuracy;
use liestep::motion::{AnyState, AnyStepper, Moment};

use crate::file::column::Column;
use crate::file::mistake::Mistake;
use crate::file::sample::Sample;
use crate::file::scene_file::SceneFile;
use crate::file::schedule::Pace;
use crate::run::make::{Course, Listeners, Note, Run, Stop, make};

/// The stepper of a scene, and its initial state.
pub type MemberStart = (AnyStepper, AnyState);

/// A stepper at the start of a run, with remarks about the file.
pub(crate) struct Begun {
    pub(crate) start: MemberStart,
    pub(crate) notes: Vec<Note>,
}

/// The function that makes the samples of a run.
pub(crate) type Sampler = Arc<dyn Fn(&Moment<'_, AnyStepper>) -> Sample + Send + Sync>;

/// Fewest steps of a run whose number of steps is left open, or that looks for events. With fewer, curves would look like
/// polygons, and of two events within a step neither is found.
const FEWEST: u32 = 1000;

impl SceneFile {
    /// Simulates the scene.
    pub(crate) fn simulate(&self, listeners: Listeners<'_>) -> Result<Run, Stop> {
        match self.run.pace {
            Pace::Step { step, steps } => self.make((step, u64::from(steps)), listeners),
            Pace::Accuracy(tolerance) => {
                let horizon = self.run.duration;
                let choice = self.searched(Accuracy { tolerance, horizon })?;
                let mut chosen = self.clone();
                chosen.run.method = choice.chosen().scheme;
                let is_fine = self.run.is_left_open || !self.event_names().is_empty();
                let steps = if is_fine && choice.steps < u64::from(FEWEST) {
                    (horizon / f64::from(FEWEST), u64::from(FEWEST))
                } else {
                    (choice.chosen().step, choice.steps)
                };
                let mut run = chosen.make(steps, listeners)?;
                run.choice = Some(choice);
                Ok(run)
            }
        }
    }

    /// Makes this many steps of this length, s.
    fn make(&self, (step, steps): (f64, u64), listeners: Listeners<'_>) -> Result<Run, Stop> {
        let Begun { start: (stepper, state), notes } = self.begun(step)?;
        let (columns, sampler) = (&self.columns, self.sampler());
        let (end, stride, listed) = (self.run.duration, self.output.stride(steps), Column::listed(columns));
        let course = Course { steps, end, stride, columns, listed };
        let mut run = make(&stepper, state, course, |now| sampler(now), self.watches(), listeners)?;
        let note = |(place, why)| Mistake::of_run(&self.origin.path, place, why);
        run.notes = notes.into_iter().chain(self.origin.note.clone()).map(note).collect();
        self.fault(&run).map_or(Ok(run), Err)
    }

    /// Simulates the scene up to a number of steps; to its end where the step is chosen for an accuracy.
    pub(crate) fn first(&self, most: u32) -> Result<Run, Stop> {
        let mut first = self.clone();
        if let Pace::Step { step, steps } = &mut first.run.pace {
            *steps = most.min(*steps);
            first.run.duration = first.run.duration.min(*step * f64::from(*steps));
        }
        first.simulate(Listeners { progress: &mut |_| (), table: None })
    }

    /// The stepper with the file's step, and the initial state.
    pub(crate) fn started(&self) -> Result<MemberStart, Stop> {
        let none = || Stop::Other("the step is chosen for an accuracy by trial runs".to_owned());
        Ok(self.begun(self.run.step().ok_or_else(none)?)?.start)
    }
}
