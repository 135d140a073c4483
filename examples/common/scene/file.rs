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
use super::quantity::{Duration, Positive};
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

/// A whole number of equal steps.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "ScheduleTable")]
pub(super) struct Schedule {
    /// The step, s.
    pub(super) step: f64,
    pub(super) steps: u32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScheduleTable {
    step: Positive<Duration>,
    duration: Positive<Duration>,
}

/// A few minutes of stepping.
const MOST_STEPS: f64 = 1e8;

impl TryFrom<ScheduleTable> for Schedule {
    type Error = String;

    fn try_from(table: ScheduleTable) -> Result<Self, String> {
        let (step, duration) = (table.step.value, table.duration.value);
        let steps = (duration / step).round();
        if steps < 1.0 {
            return Err(format!("`duration` is {duration} s, shorter than one `step` of {step} s"));
        }
        if steps > MOST_STEPS {
            return Err(format!(
                "`duration` makes {steps:.1e} steps, more than {MOST_STEPS:.0e}; take a larger `step`"
            ));
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // between the two
        let steps = steps as u32;
        Ok(Self { step, steps })
    }
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
}
