//! The terms of a scene by the numbers of each step, as steps with laws, wheels and values over time take them.

use liestep::motion::{Cost, Layout, StepReport};
use liestep::{SetupError, StepError};
use nalgebra::Vector3;

/// The spin of a body's wheels and the torque on it in a step, body frame, kg m²/s and N m.
#[derive(Clone, Copy, Default, PartialEq)]
pub(crate) struct BodyInput {
    pub(crate) spin: Vector3<f64>,
    pub(crate) torque: Vector3<f64>,
}

/// The terms of a scene, whose numbers are given for each step.
pub(crate) trait Mechanism {
    /// The numbers of a step.
    type Numbers;

    fn layout(&self) -> &Layout;

    /// The numbers of a step of this start and length, s, with the length zero those of a time; none where one isn't finite.
    fn numbers(&self, span: [f64; 2], held: &[BodyInput]) -> Option<Self::Numbers>;

    fn start(&self, numbers: &Self::Numbers, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError>;

    /// Makes a stage of a step, of this length, s.
    fn step(
        &self,
        stage: usize,
        numbers: &Self::Numbers,
        length: f64,
        state: &mut Vec<f64>,
    ) -> Result<StepReport, StepError>;

    /// Gives a state the memory of a new start.
    fn forget(&self, _state: &mut Vec<f64>) {}

    fn velocity(&self, numbers: &Self::Numbers, state: &[f64]) -> Vec<f64>;

    fn energy(&self, numbers: &Self::Numbers, state: &[f64]) -> f64;

    /// Adds impulses to the momenta of the bodies, N m s in the body frame and N s in space.
    fn push(&self, numbers: &Self::Numbers, state: &mut [f64], impulses: &[f64]) -> Result<(), StepError>;

    /// Projects momenta onto those whose velocities keep joints closed: a step does so with other numbers than those of its end.
    fn project(&self, _: &Self::Numbers, _state: &mut [f64]) -> Result<(), StepError> {
        Ok(())
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]);

    fn defect(&self, state: &[f64]) -> f64;

    fn gap(&self, _state: &[f64]) -> f64 {
        0.0
    }

    /// The operations of a stage.
    fn cost(&self) -> Option<Cost> {
        None
    }

    fn joint_forces(&self, _: &Self::Numbers, _state: &[f64]) -> Result<Vec<[Vector3<f64>; 2]>, StepError> {
        Ok(Vec::new())
    }
}
