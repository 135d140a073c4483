//! The integrator of a declared Lagrangian, as a method to run.

use liestep::mechanics::DiscreteLagrangian;
use liestep::{SO3, StateOf, Stepper};

use super::run::{EarlyEnd, Method, Sample};

/// A motion with its stepper.
pub struct Variational<'a, L: DiscreteLagrangian<Scalar = f64, Group = SO3>> {
    pub stepper: &'a Stepper<L>,
    pub state: StateOf<L>,
}

impl<L: DiscreteLagrangian<Scalar = f64, Group = SO3>> Clone for Variational<'_, L> {
    fn clone(&self) -> Self {
        Self { stepper: self.stepper, state: self.state }
    }
}

impl<L: DiscreteLagrangian<Scalar = f64, Group = SO3>> Method for Variational<'_, L> {
    fn advance(&mut self, steps: u64) -> Result<u64, EarlyEnd> {
        let mut iterations = 0;
        for _ in 0..steps {
            match self.stepper.step(&mut self.state) {
                Ok(report) => iterations += u64::from(report.iterations),
                Err(cause) => return Err(EarlyEnd { time: self.stepper.time(&self.state), cause }),
            }
        }
        Ok(iterations)
    }

    fn sample(&self) -> Sample {
        Sample { attitude: *self.state.attitude().as_matrix(), momentum: self.state.momentum() }
    }
}
