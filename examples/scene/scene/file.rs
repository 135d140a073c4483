//! A scene file as a whole.

use std::ops::Range;

use liestep::effects::PrincipalBody;
use serde::Deserialize;
use toml::Spanned;

use super::choose::MOST_EFFECTS;
use super::effects::{
    Body, DipoleTable, DragTable, GravityGradientTable, GravityTable, MagneticDampingTable, RotorTable, SpringTable,
    TorqueTable,
};
use super::picture::Picture;
use super::quantity::{Duration, Number, Positive};
use super::start::Start;

/// What a scene file says. An effect is in the scene if its table is in the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SceneFile {
    pub(super) title: String,
    body: Body,
    pub(super) gravity: Option<Spanned<GravityTable>>,
    pub(super) gravity_gradient: Option<Spanned<GravityGradientTable>>,
    pub(super) dipole: Option<Spanned<DipoleTable>>,
    pub(super) spring: Option<Spanned<SpringTable>>,
    pub(super) rotor: Option<Spanned<RotorTable>>,
    pub(super) drag: Option<Spanned<DragTable>>,
    pub(super) magnetic_damping: Option<Spanned<MagneticDampingTable>>,
    pub(super) torque: Option<Spanned<TorqueTable>>,
    pub(super) start: Start,
    pub(super) run: Schedule,
    #[serde(default)]
    pub(super) picture: Picture,
}

/// How long, and by which steps.
#[derive(Clone, Deserialize)]
#[serde(try_from = "ScheduleTable")]
pub(super) struct Schedule {
    /// s.
    pub(super) duration: f64,
    pub(super) pace: Pace,
    /// Where an accuracy is asked for although there is a step.
    too_much: Option<Range<usize>>,
}

/// What sets the step.
#[derive(Clone)]
pub(super) enum Pace {
    /// A whole number of equal steps, s.
    Step { step: f64, steps: u32 },
    /// The error at the end, and where in the file it is asked for.
    Accuracy(Spanned<f64>),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScheduleTable {
    step: Option<Positive<Duration>>,
    accuracy: Option<Spanned<Positive<Number>>>,
    duration: Positive<Duration>,
}

/// A few minutes of stepping.
const MOST_STEPS: f64 = 1e8;

impl TryFrom<ScheduleTable> for Schedule {
    type Error = String;

    fn try_from(table: ScheduleTable) -> Result<Self, String> {
        let duration = table.duration.value;
        let too_much = table.step.and(table.accuracy.as_ref()).map(Spanned::span);
        let pace = match (table.step, table.accuracy) {
            (Some(step), _) => equal_steps(step.value, duration)?,
            (None, Some(accuracy)) => {
                let span = accuracy.span();
                Pace::Accuracy(Spanned::new(span, accuracy.into_inner().value))
            }
            (None, None) => return Err("a run has either a `step` or an `accuracy`".to_owned()),
        };
        Ok(Self { duration, pace, too_much })
    }
}

fn equal_steps(step: f64, duration: f64) -> Result<Pace, String> {
    let steps = (duration / step).round();
    if steps < 1.0 {
        return Err(format!("`duration` is {duration} s, shorter than one `step` of {step} s"));
    }
    if steps > MOST_STEPS {
        return Err(format!("`duration` makes {steps:.1e} steps, more than {MOST_STEPS:.0e}; take a larger `step`"));
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // between the two
    let steps = steps as u32;
    Ok(Pace::Step { step, steps })
}

impl SceneFile {
    pub(super) fn body(&self) -> PrincipalBody {
        self.body.0
    }

    /// The effects by their names in the file, and where each is.
    fn effects(&self) -> Vec<(&'static str, Range<usize>)> {
        fn span<T>(table: Option<&Spanned<T>>) -> Option<Range<usize>> {
            table.map(Spanned::span)
        }
        let all = [
            ("gravity", span(self.gravity.as_ref())),
            ("gravity gradient", span(self.gravity_gradient.as_ref())),
            ("dipole", span(self.dipole.as_ref())),
            ("spring", span(self.spring.as_ref())),
            ("rotor", span(self.rotor.as_ref())),
            ("drag", span(self.drag.as_ref())),
            ("magnetic damping", span(self.magnetic_damping.as_ref())),
            ("torque", span(self.torque.as_ref())),
        ];
        all.into_iter().filter_map(|(name, span)| Some((name, span?))).collect()
    }

    /// The sum, in words.
    pub(super) fn sum(&self) -> String {
        self.effects().iter().fold("body".to_owned(), |sum, (name, _)| format!("{sum} + {name}"))
    }

    /// Where the first effect is that is one too many.
    pub(super) fn excess(&self) -> Option<Range<usize>> {
        let mut spans: Vec<_> = self.effects().into_iter().map(|(_, span)| span).collect();
        spans.sort_by_key(|span| span.start);
        spans.into_iter().nth(MOST_EFFECTS)
    }

    /// Where an accuracy is asked for although there is a step.
    pub(super) fn step_and_accuracy(&self) -> Option<Range<usize>> {
        self.run.too_much.clone()
    }

    /// Where an accuracy is asked for that a force stands in the way of, and which.
    pub(super) fn force_in_the_way(&self) -> Option<(Range<usize>, &'static str)> {
        let Pace::Accuracy(accuracy) = &self.run.pace else { return None };
        let forces = ["drag", "magnetic damping", "torque"];
        let (name, _) = self.effects().into_iter().find(|(name, _)| forces.contains(name))?;
        Some((accuracy.span(), name))
    }
}
