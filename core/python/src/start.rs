//! The start of a motion, by numbers that Python gives.

use liestep::motion::{AnyState, AnyStepper, Factor, FactorKind};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion};
use pyo3::prelude::*;

use crate::failure::Failure;

/// The start of a motion: the attitude as a quaternion, as the entries of a matrix row by row, or the identity if it is
/// empty; and a velocity, or a momentum in its place.
#[derive(Clone, FromPyObject)]
pub(crate) struct Start {
    pub(crate) attitude: Vec<f64>,
    pub(crate) is_quaternion: bool,
    pub(crate) velocity: Vec<f64>,
    pub(crate) is_by_momentum: bool,
}

/// The state at a start.
pub(crate) fn started(stepper: &AnyStepper, start: &Start) -> Result<AnyState, Failure> {
    let factors = &stepper.layout().factors;
    let (attitude, numbers) = (start.attitude(factors)?, start.velocity(factors)?);
    let state = if start.is_by_momentum {
        stepper.start_with_momentum(&attitude, numbers)
    } else {
        stepper.start(&attitude, numbers)
    };
    state.map_err(|error| Failure::setup(&error))
}

impl Start {
    /// The components of the velocity, or of the momentum in its place.
    pub(crate) fn velocity(&self, factors: &[Factor]) -> Result<&[f64], Failure> {
        let expected: usize = factors.iter().map(|factor| factor.components.len()).sum();
        let found = self.velocity.len();
        if found == expected {
            return Ok(&self.velocity);
        }
        let what = if self.is_by_momentum { "momentum" } else { "velocity" };
        Err(Failure::Of("SetupError", format!("a {what} has {expected} components here, not {found}")))
    }

    /// The entries of the attitude, the identity by default.
    pub(crate) fn attitude(&self, factors: &[Factor]) -> Result<Vec<f64>, Failure> {
        let wrong = |message: String| Err(Failure::Of("SetupError", message));
        if self.attitude.is_empty() {
            let identity = |rows: usize| (0..rows * rows).map(move |at| f64::from(u8::from(at / rows == at % rows)));
            return Ok(factors.iter().flat_map(|factor| identity(factor.kind.rows())).collect());
        }
        if self.is_quaternion {
            let [w, x, y, z] = self.attitude[..] else {
                return wrong(format!("a quaternion has four components, not {}", self.attitude.len()));
            };
            let unit = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-300);
            let Some(unit) = unit.filter(|unit| unit.coords.iter().all(|part| part.is_finite())) else {
                return wrong("a quaternion isn't zero, and is finite".to_owned());
            };
            if !matches!(factors, [Factor { kind: FactorKind::Rotation, .. }]) {
                return wrong("a quaternion is an attitude on SO3: give a matrix here".to_owned());
            }
            // Entries are row by row, unlike nalgebra's own order.
            return Ok(unit.to_rotation_matrix().into_inner().transpose().as_slice().to_vec());
        }
        let entries: usize = factors.iter().map(|factor| factor.kind.rows() * factor.kind.rows()).sum();
        if self.attitude.len() != entries {
            let found = self.attitude.len();
            return wrong(format!("an attitude has {entries} entries here, and {found} were given"));
        }
        let mut first = 0;
        for factor in factors {
            let own = &self.attitude[first..first + factor.kind.rows() * factor.kind.rows()];
            first += own.len();
            // A reflection satisfies the relation of rotations, too.
            if factor.kind == FactorKind::Rotation && Matrix3::from_row_slice(own).determinant() <= 0.0 {
                return wrong("the attitude isn't in the group: it is a reflection".to_owned());
            }
        }
        Ok(self.attitude.clone())
    }
}
