//! A choice that is kept for the next time.

use alloc::string::String;

use super::Accuracy;
use super::candidates::Candidate;
use super::search::{Found, MOST_OPERATIONS};
use super::trials::Tried;
use crate::groups::{Advected, LieGroup};

// Roots and powers without a standard library.
#[cfg(not(feature = "std"))]
use nalgebra::ComplexField as _;

/// What of the tolerance the error of a choice may be that is looked at again: it is known to a tenth.
const ACCEPTED_AGAIN: f64 = 0.9;
/// The run that it is compared with has so many times its steps: of order 2 its own error is then less than half as
/// large, and it costs half as much again.
const FINER: f64 = 1.5;

/// A [`Choice`](super::Choice) in short, by [`Choice::saved`](super::Choice::saved): what the same scene is given when
/// it is asked again, by [`Candidates::with_saved`](super::Candidates::with_saved).
///
/// With the feature `serde` it goes to any of its formats.
///
/// # Examples
///
/// ```
/// use liestep::accuracy::{Accuracy, Candidates};
/// use liestep::effects::{Gravity, RigidBody};
/// use liestep::groups::LieGroup;
/// use liestep::{NonstandardInertia, SO3};
/// use nalgebra::Vector3;
///
/// let body = RigidBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(2.0, 1.5, 1.0))? };
/// let top = body + Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.1, 0.0, 1.0), up: Vector3::z() };
/// let (accuracy, velocity) = (Accuracy { tolerance: 1e-6, horizon: 10.0 }, Vector3::new(0.5, 2.0, 3.0));
/// let saved = Candidates::of_body(top, 2).for_accuracy(accuracy, SO3::identity(), velocity)?.choice().saved();
///
/// let again = Candidates::of_body(top, 2).with_saved(saved.clone());
/// let stepper = again.for_accuracy(accuracy, SO3::identity(), velocity)?;
/// assert!(stepper.choice().saved() == saved && stepper.choice().trials < 2.6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct SavedChoice {
    /// The [name](super::Offer::name) of the method.
    pub method: String,
    /// Its step, s.
    pub step: f64,
}

impl SavedChoice {
    /// The choice, if it is near enough: by one run besides, with shorter steps.
    pub(super) fn again<'a, G: LieGroup<Scalar = f64>, A: Advected<G>>(
        &self,
        candidates: &'a [Candidate<'a, G, A>],
        accuracy: Accuracy,
        tried: &mut Tried<'a, G, A>,
    ) -> Option<Found> {
        let index = candidates.iter().position(|candidate| candidate.name == self.method)?;
        let (candidate, start) = (&candidates[index], tried.start);
        // A step that divides another horizon.
        let steps = (accuracy.horizon / self.step * (1.0 - f64::EPSILON.sqrt())).ceil();
        let finer = (FINER * steps).ceil();
        let is_usable = self.step > 0.0 && steps >= 1.0 && candidate.untried(steps + finer) <= MOST_OPERATIONS;
        if !is_usable {
            return None;
        }
        let [run, fine] = [steps, finer].map(|steps| tried.run(candidate, accuracy.horizon, steps).0);
        // What is measured is the difference of two errors.
        let error =
            start.difference(&run.end?, &fine.end?) / (1.0 - (steps / finer).powi(candidate.order.try_into().ok()?));
        let offer = |(other, candidate): (usize, &Candidate<'_, G, A>)| {
            if other == index { (steps, run.cost(), false) } else { (1.0, candidate.least(1.0), true) }
        };
        // What has no error of its own costs the same for any.
        let by_order = |factor: f64| factor.powf(f64::from(candidate.order).recip());
        let nearby = if candidate.is_exact { [1.0; 2] } else { [0.1, 10.0].map(by_order) };
        (error <= ACCEPTED_AGAIN * accuracy.tolerance).then(|| Found {
            index,
            steps,
            error,
            cost: run.cost(),
            trials: tried.total,
            offers: candidates.iter().enumerate().map(offer).collect(),
            nearby,
        })
    }
}
