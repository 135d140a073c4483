//! S3: about a principal axis `sin θ = hΩ` has a second root at `π − θ`.

use declarations::{FreeBody, HeavyTop};
use liestep::groups::Retraction as _;
use liestep::mechanics::{DiscreteLagrangian, Regular, inertia};
use liestep::motion::DiscreteLiePoisson;
use liestep::{SO3, StepError};
use nalgebra::{UnitQuaternion, Vector3};
use workbench::measure::greater;

use crate::row::{Effort, Failure, Row};

const STEP: f64 = 0.1;

fn rotation(axis: &Vector3<f64>, degrees: f64) -> SO3 {
    UnitQuaternion::from_scaled_axis(axis * degrees.to_radians()).into()
}

/// The results of Newton's iteration from all guesses.
struct Tally {
    refused: u32,
    /// The number of solutions with a negative determinant; about a middle axis it may be positive for the wrong root,
    /// and the trace decides.
    negative: u32,
    traps: u32,
    wrong: u32,
    error: f64,
    from_below: bool,
}

impl Tally {
    /// Spins about each principal axis so fast that a step turns the body by 30°.
    fn trap<L>(&mut self, lagrangian: &L, w: &L::Advected) -> Result<(), Failure>
    where
        L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular + Clone,
    {
        let flow = DiscreteLiePoisson::new(lagrangian.clone(), STEP)?;
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            let momentum = inertia(lagrangian, &lagrangian.advected()) * axis * (0.5 / STEP);
            let off = |found: &SO3| (found.log() - axis * 30.0_f64.to_radians()).norm();
            let guess = |degrees: f64| L::Retraction::local_coordinates(&rotation(&axis, degrees)).ok_or("half a turn");
            self.traps += 1;
            let trapped = flow.invert_legendre_minus(&momentum, w, &guess(150.0)?);
            if let Err(StepError::WrongBranch { determinant }) = trapped {
                self.refused += 1;
                self.negative += u32::from(determinant < 0.0);
            }
            // Newton's iteration from elsewhere may converge to either root, but the wrong one must never be returned.
            for degrees in (0..=175).step_by(5) {
                match flow.invert_legendre_minus(&momentum, w, &guess(f64::from(degrees))?) {
                    Ok(found) if off(&found) < 1e-6 => self.error = greater(self.error, off(&found)),
                    Ok(_) => self.wrong += 1,
                    Err(_) => self.from_below &= degrees > 90,
                }
            }
            // A full step starts again at the identity, so it always finds the right root.
            self.error = greater(self.error, off(&flow.step(&momentum, w, &guess(150.0)?)?.element()));
        }
        Ok(())
    }
}

pub(crate) fn s3(_: Effort) -> Result<Row, Failure> {
    let mut seen = Tally { refused: 0, negative: 0, traps: 0, wrong: 0, error: 0.0, from_below: true };
    for moments in [[3.0, 3.0, 4.0], [2.0, 3.0, 4.5], [1.0, 2.0, 3.0], [1.0, 1.0, 1.0]] {
        seen.trap(&FreeBody::with_moments(moments), &())?;
    }
    // There is no weight, so the half kick doesn't move the root.
    for top in [HeavyTop::thesis(), HeavyTop::asymmetric()] {
        seen.trap(&HeavyTop { g: 0.0, ..top }, &Vector3::z())?;
    }
    let Tally { refused, negative, traps, wrong, error, from_below } = seen;
    let row = Row::new("S3", "guess at 150° where the root is at 30°", "refused; the wrong root never comes out")
        .holds(
            &format!("{refused} of {traps} refused as WrongBranch (four bodies, two tops, three axes)"),
            refused == traps,
        )
        .holds(&format!("{negative} of them by a determinant below zero, the others by the trace"), {
            negative > 0 && negative < refused
        })
        .holds(&format!("{wrong} wrong roots from guesses of 0° to 175°"), wrong == 0)
        .holds("solved from every guess up to 90°", from_below)
        .at_most("error of the root in rad", error, 1e-15);
    Ok(row)
}
