//! Stages of a motion on a tape, and derivatives of a scalar carried back through them.

use liestep::StepError;

use super::slopes::{Back, Made, Slopes};
use super::varied::{Room, Varied};
use crate::code::Backend;

/// The stages of some steps, in order.
#[derive(Default)]
pub(super) struct Tape {
    /// For each stage attitude, momentum and advected parameters before it, and half the coordinates of its increment.
    moving: Vec<f64>,
    /// Constants, numbers and span of each stage, where these change with time.
    own: Vec<(Vec<f64>, Vec<f64>, [f64; 2])>,
}

/// Constants and length of a stage whose numbers don't change.
pub(super) type Constants = (Vec<f64>, f64);

/// A function of a span of time, its start and length in s, and of the derivatives by all parameters over it.
pub(super) type Given<'a> = &'a mut dyn FnMut([f64; 2], &[f64]);

impl Tape {
    pub(super) fn clear(&mut self) {
        self.moving.clear();
        self.own.clear();
    }
}

/// Derivatives by the constants of each stage, and those that are handed on.
pub(super) struct Sums<'a> {
    pub(super) by_constants: Vec<Vec<f64>>,
    pub(super) given: Given<'a>,
    /// The derivatives by the parameters that were handed on.
    pub(super) total: Vec<f64>,
}

impl Sums<'_> {
    /// Hands on the derivatives by the parameters over a span.
    pub(super) fn hand_on(&mut self, span: [f64; 2], slopes: &mut Slopes) {
        if slopes.by_numbers.iter().all(|slope| *slope == 0.0) {
            return;
        }
        (self.given)(span, &slopes.by_numbers);
        self.total.iter_mut().zip(&slopes.by_numbers).for_each(|(sum, slope)| *sum += slope);
        slopes.by_numbers.fill(0.0);
    }
}

impl<B: Backend<f64>> Varied<B> {
    pub(super) fn is_steady(&self) -> bool {
        self.course.is_none()
    }

    /// The time after so many steps, s.
    #[allow(clippy::cast_precision_loss)] // exact up to 2⁵³
    pub(super) fn time_of(&self, steps: u64) -> f64 {
        self.whole.h * steps as f64
    }

    /// The numbers of a stage on a tape.
    fn width(&self) -> usize {
        let sizes = &self.whole.codes.sizes;
        sizes.history() + sizes.n
    }

    /// The number of steps whose stages fit into so many numbers, one at least.
    pub(super) fn steps_within(&self, numbers: usize) -> u64 {
        let own =
            if self.is_steady() { 0 } else { self.whole.numbers().len() + self.whole.codes.code.constants.outputs };
        let each = self.stages.len() * (self.width() + own);
        u64::try_from((numbers / each.max(1)).max(1)).unwrap_or(u64::MAX)
    }

    /// Makes a step of this start and length in a room, with its stages on a tape.
    pub(super) fn record(&self, room: &mut Room<B>, span: [f64; 2], tape: &mut Tape) -> Result<(), StepError> {
        let (sizes, is_steady) = (&self.whole.codes.sizes, self.is_steady());
        let (mut is_after, mut stage) = (false, 0);
        self.watched(room, span, &mut |stepper, state| {
            if is_after {
                tape.moving.extend_from_slice(&state[sizes.history()..sizes.history() + sizes.n]);
                stage += 1;
            } else {
                tape.moving.extend_from_slice(&state[..sizes.history()]);
                if !is_steady {
                    let (constants, numbers) = (stepper.stages.first().numbers.clone(), stepper.numbers().to_vec());
                    let [begin, share] = self.stages[stage];
                    tape.own.push((constants, numbers, [span[0] + span[1] * begin, span[1] * share]));
                }
            }
            is_after = !is_after;
        })?;
        Ok(())
    }

    /// The state before a step on a tape, without its memory.
    pub(super) fn before<'t>(&self, tape: &'t Tape, step: usize) -> &'t [f64] {
        let first = step * self.stages.len() * self.width();
        &tape.moving[first..first + self.whole.codes.sizes.history()]
    }

    /// Carries derivatives back through a step on a tape, whose constants are these unless they change with time.
    pub(super) fn back(
        &self,
        back: &Back<'_, B>,
        (tape, step): (&Tape, usize),
        constants: &[Constants],
        slopes: &mut Slopes,
        sums: &mut Sums<'_>,
    ) {
        let (sizes, count) = (&self.whole.codes.sizes, self.stages.len());
        for stage in (0..count).rev() {
            let at = step * count + stage;
            let row = &tape.moving[at * self.width()..(at + 1) * self.width()];
            let made = Made {
                attitude: &row[..sizes.momentum()],
                momentum: &row[sizes.momentum()..sizes.advected()],
                advected: &row[sizes.advected()..sizes.history()],
                half: &row[sizes.history()..],
            };
            let Some((constants, numbers, span)) = tape.own.get(at) else {
                back.through_stage(&constants[stage].0, made, slopes, &mut sums.by_constants[stage]);
                continue;
            };
            let mut by_constants = vec![0.0; constants.len()];
            back.through_stage(constants, made, slopes, &mut by_constants);
            back.through_constants((numbers, span[1]), &by_constants, &mut slopes.by_numbers);
            back.through_view(numbers, made.attitude, slopes);
            sums.hand_on(*span, slopes);
        }
    }
}
