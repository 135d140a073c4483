//! The chosen method, and the alternatives.

use alloc::format;
use alloc::string::ToString as _;
use alloc::vec::Vec;
use core::fmt;

use super::question::Accuracy;
use crate::with::Scheme;

/// A method for an accuracy.
#[derive(Clone, Debug, PartialEq)]
pub struct Offer {
    /// The scheme of the method.
    pub scheme: Scheme,
    /// Order of the method. Errors may fall faster if a small potential is split off.
    pub order: u32,
    /// Approximate step that the method needs, s; an upper bound if [`is_bound`](Self::is_bound).
    pub step: f64,
    /// The arithmetic of the run, relative to that of the chosen method.
    pub cost: f64,
    /// Whether the method's trials ended early, as the method could only be more expensive.
    pub is_bound: bool,
}

/// The choice of [`Stepper::for_accuracy`](crate::motion::Stepper::for_accuracy), with its reasons; as text, a table.
///
/// # Examples
///
/// The choice for a heavy top:
///
/// ```
/// use liestep::effects::{Gravity, PrincipalBody};
/// use liestep::{SO3, Stepper};
/// use liestep::accuracy::Accuracy;
/// use liestep::groups::LieGroup;
/// use liestep::mechanics::DiagonalNonstandardInertia;
/// use nalgebra::Vector3;
///
/// let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0))?;
/// let scene = PrincipalBody { J_d } + Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::x() };
/// let accuracy = Accuracy { tolerance: 1e-8, horizon: 10.0 };
/// let stepper = Stepper::for_accuracy(scene, accuracy, SO3::identity(), Vector3::new(0.1, 0.0, 9.0))?;
/// let choice = stepper.choice();
/// assert!(choice.error <= 1e-8 && choice.chosen().order >= 6);
/// println!("{choice}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// The requested accuracy.
    pub accuracy: Accuracy,
    /// The number of steps to the horizon.
    pub steps: u64,
    /// The error at the horizon, measured against a run with a smaller error.
    pub error: f64,
    /// The arithmetic of all trial runs, relative to that of the run.
    pub trials: f64,
    /// Costs of the method for ten times the tolerance and for a tenth of it.
    pub nearby: [f64; 2],
    pub(super) offers: Vec<Offer>,
    pub(super) chosen: usize,
}

impl Choice {
    /// The chosen method.
    #[must_use]
    pub fn chosen(&self) -> &Offer {
        &self.offers[self.chosen]
    }

    /// All methods for the scene.
    #[must_use]
    pub fn offers(&self) -> &[Offer] {
        &self.offers
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (chosen, Accuracy { tolerance, horizon }) = (self.chosen(), self.accuracy);
        writeln!(
            f,
            "{tolerance:.0e} at t = {horizon} s: {}, {} steps of {:.4e} s",
            chosen.scheme, self.steps, chosen.step
        )?;
        writeln!(f, "error {:.1e}; its trials cost {:.1} runs", self.error, self.trials)?;
        let [rougher, finer] = self.nearby;
        writeln!(f, "{:.0e} would cost {rougher:.2}, {:.0e} {finer:.2}", 10.0 * tolerance, 0.1 * tolerance)?;
        let width = self.offers.iter().map(|offer| offer.scheme.to_string().chars().count()).max().unwrap_or(0);
        writeln!(f, "{:<width$}  order    step, s      cost", "method")?;
        for Offer { scheme, order, step, cost, is_bound } in &self.offers {
            let name = scheme.to_string();
            let (least, most) = if *is_bound { ("≥", "<") } else { ("", "") };
            let (step, cost) = (format!("{most}{step:.2e}"), format!("{least}{cost:.2}"));
            writeln!(f, "{name:<width$}  {order:>5}  {step:>9}  {cost:>8}")?;
        }
        Ok(())
    }
}
