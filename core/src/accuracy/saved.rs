//! A choice that is kept for the next time.

use alloc::string::String;

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
