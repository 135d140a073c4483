//! Runs of scenes of any parts: by the steps of the file, or by those of the cheapest method for an accuracy.

use std::ops::Range;
use std::sync::Arc;

use liestep::accuracy::{Accuracy, Choice};
use liestep::motion::{AnyState, AnyStepper, Moment};

use crate::file::column::Column;
use crate::file::common::Parts;
use crate::file::mistake::Mistake;
use crate::file::sample::Sample;
use crate::file::schedule::Pace;
use crate::run::make::{Course, Listeners, Note, Run, Stop, Watch, make};

/// The stepper of a scene, and its initial state.
pub type MemberStart = (AnyStepper, AnyState);

/// A stepper at the start of a run, with remarks about the file.
pub(crate) struct Begun {
    pub(crate) start: MemberStart,
    pub(crate) notes: Vec<Note>,
}

/// The function that makes the samples of a run.
pub(crate) type Sampler = Arc<dyn Fn(&Moment<'_, AnyStepper>) -> Sample + Send + Sync>;

/// The parts of a scene, as its runs see them: a stepper by a method and a step, and numbers of its states.
pub(crate) trait Moving: Parts {
    /// The stepper by the method of the schedule and a step, s, at the start.
    fn begun(&self, step: f64) -> Result<Begun, Stop>;

    /// The cheapest choice of method and step for an accuracy.
    fn searched(&self, accuracy: Accuracy) -> Result<Choice, Stop>;

    /// The numbers of a state.
    fn sample(&self, now: &Moment<'_, AnyStepper>) -> Sample;

    fn sampler(&self) -> Sampler;

    /// The events that a run detects.
    fn watches(&self) -> Vec<Watch>;

    /// The mistake for a failed run, with its place in the file.
    fn mistake(&self, stop: Stop) -> Mistake;

    /// The order of the scene's method.
    fn order(&self) -> u32;

    /// The columns whose largest values tell how well a run conserves what it should.
    fn errors(&self) -> Vec<Column>;

    /// The places of attitude and velocity among the numbers of a sample, on a group without bodies.
    fn places(&self) -> Option<[Range<usize>; 2]> {
        None
    }

    /// The failure of a run that came to its end.
    fn fault(&self, _run: &Run) -> Option<Stop> {
        None
    }

    fn unit_of_energy(&self) -> &'static str {
        "J"
    }

    /// The part of a summary behind the energy: the ends of a run in words.
    fn ends_in_words(&self, run: &Run, ends: [&Sample; 2]) -> String;

    /// Differences between the start of a run and that of the file.
    fn changes(&self, _run: &Run) -> String {
        String::new()
    }
}

/// Fewest steps of a run whose number of steps is left open. With fewer, curves would look like polygons.
const FEWEST: u32 = 1000;

/// Simulates a scene.
pub(crate) fn run<P: Moving>(parts: &P, listeners: Listeners<'_>) -> Result<Run, Stop> {
    match parts.schedule().pace {
        Pace::Step { step, steps } => by(parts, (step, u64::from(steps)), listeners),
        Pace::Accuracy(tolerance) => {
            let horizon = parts.schedule().duration;
            let choice = parts.searched(Accuracy { tolerance, horizon })?;
            let mut chosen = parts.clone();
            let schedule = chosen.schedule_mut();
            schedule.method = choice.chosen().scheme;
            let steps = if schedule.is_left_open && choice.steps < u64::from(FEWEST) {
                (horizon / f64::from(FEWEST), u64::from(FEWEST))
            } else {
                (choice.chosen().step, choice.steps)
            };
            let mut run = by(&chosen, steps, listeners)?;
            run.choice = Some(choice);
            Ok(run)
        }
    }
}

/// Makes this many steps of this length, s.
fn by<P: Moving>(parts: &P, (step, steps): (f64, u64), listeners: Listeners<'_>) -> Result<Run, Stop> {
    let Begun { start: (stepper, state), notes } = parts.begun(step)?;
    let (columns, sampler) = (parts.columns(), parts.sampler());
    let course = Course {
        steps,
        end: parts.schedule().duration,
        stride: parts.output().stride(steps),
        columns,
        listed: Column::listed(columns),
    };
    let mut run = make(&stepper, state, course, |now| sampler(now), parts.watches(), listeners)?;
    run.notes = notes.into_iter().map(|(place, why)| Mistake::of_run(parts.path(), place, why)).collect();
    parts.fault(&run).map_or(Ok(run), Err)
}

/// Simulates a scene up to a number of steps; to its end where the step is chosen for an accuracy.
pub(crate) fn first<P: Moving>(parts: &P, most: u32) -> Result<Run, Stop> {
    let mut first = parts.clone();
    let schedule = first.schedule_mut();
    if let Pace::Step { step, steps } = &mut schedule.pace {
        *steps = most.min(*steps);
        schedule.duration = schedule.duration.min(*step * f64::from(*steps));
    }
    run(&first, Listeners { progress: &mut |_| (), table: None })
}

/// The stepper with the file's step, and the initial state.
pub(crate) fn started<P: Moving>(parts: &P) -> Result<MemberStart, Stop> {
    let none = || Stop::Other("the step is chosen for an accuracy by trial runs".to_owned());
    Ok(parts.begun(parts.schedule().step().ok_or_else(none)?)?.start)
}
