//! A scene file as a whole.

use std::ops::Range;

use liestep::effects::PrincipalBody;
use serde::Deserialize;
use toml::Spanned;
use workbench::table::short;

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
    #[serde(deserialize_with = "title")]
    pub(super) title: String,
    body: Body,
    pub(super) gravity: Option<GravityTable>,
    pub(super) gravity_gradient: Option<GravityGradientTable>,
    pub(super) dipole: Option<DipoleTable>,
    pub(super) spring: Option<SpringTable>,
    pub(super) rotor: Option<RotorTable>,
    pub(super) drag: Option<DragTable>,
    pub(super) magnetic_damping: Option<MagneticDampingTable>,
    pub(super) torque: Option<TorqueTable>,
    pub(super) start: Start,
    pub(super) run: Schedule,
    #[serde(default)]
    pub(super) picture: Picture,
}

/// A title with its control characters written out: a terminal would obey them, and SVG has no room for them.
fn title<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    let title = String::deserialize(deserializer)?;
    let visible = |character: char| {
        let escaped: Vec<char> =
            if character.is_control() { character.escape_default().collect() } else { vec![character] };
        escaped
    };
    Ok(title.chars().flat_map(visible).collect())
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
        let (duration, step) = (short(duration), short(step));
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

    /// The effects by their names in the file.
    fn effects(&self) -> impl Iterator<Item = &'static str> {
        [
            ("gravity", self.gravity.is_some()),
            ("gravity gradient", self.gravity_gradient.is_some()),
            ("dipole", self.dipole.is_some()),
            ("spring", self.spring.is_some()),
            ("rotor", self.rotor.is_some()),
            ("drag", self.drag.is_some()),
            ("magnetic damping", self.magnetic_damping.is_some()),
            ("torque", self.torque.is_some()),
        ]
        .into_iter()
        .filter_map(|(name, is_there)| is_there.then_some(name))
    }

    /// The sum, in words.
    pub(super) fn sum(&self) -> String {
        self.effects().fold("body".to_owned(), |sum, name| format!("{sum} + {name}"))
    }

    /// The first force, by its name.
    pub(super) fn force(&self) -> Option<&'static str> {
        let forces = ["drag", "magnetic damping", "torque"];
        self.effects().find(|name| forces.contains(name))
    }

    /// Where an accuracy is asked for although there is a step.
    pub(super) fn step_and_accuracy(&self) -> Option<Range<usize>> {
        self.run.too_much.clone()
    }

    /// Where an accuracy is asked for that a force stands in the way of, and which.
    pub(super) fn force_in_the_way(&self) -> Option<(Range<usize>, &'static str)> {
        let Pace::Accuracy(accuracy) = &self.run.pace else { return None };
        let name = self.force()?;
        Some((accuracy.span(), name))
    }
}
