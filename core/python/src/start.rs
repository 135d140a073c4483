//! The start of a motion, by numbers that Python gives.

use liestep::SetupError;
use liestep::groups::LieGroup;
use liestep::motion::{AnyState, AnyStepper};
use liestep::numbers::Entries;
use nalgebra::{Quaternion, UnitQuaternion};
use pyo3::prelude::*;

use crate::failure::Failure;

/// How a motion starts: the attitude as a quaternion, as the entries of a matrix row by row, or none at all; and a velocity.
#[derive(Clone, FromPyObject)]
pub(crate) struct Start {
    pub(crate) attitude: Vec<f64>,
    pub(crate) is_quaternion: bool,
    pub(crate) velocity: Vec<f64>,
}

/// The state at a start.
pub(crate) fn started<G: LieGroup<Scalar = f64>, W>(
    stepper: &AnyStepper<G, W>,
    start: &Start,
) -> Result<AnyState<G, W>, Failure> {
    let setup = |error: SetupError| Failure::setup(&error);
    stepper.start(start.attitude::<G>()?, start.velocity::<G>()?).map_err(setup)
}

/// More is no rounding of an element of a group.
const DEFECT: f64 = 1e-6;

impl Start {
    pub(crate) fn velocity<G: LieGroup<Scalar = f64>>(&self) -> Result<G::Vector, Failure> {
        if self.velocity.len() != G::DIMENSION {
            let (expected, found) = (G::DIMENSION, self.velocity.len());
            return Err(Failure::Of("SetupError", format!("a velocity has {expected} components here, not {found}")));
        }
        let mut numbers = self.velocity.iter().copied();
        Ok(G::Vector::from_entries(&mut || numbers.next().unwrap_or(f64::NAN)))
    }

    pub(crate) fn attitude<G: LieGroup<Scalar = f64>>(&self) -> Result<G, Failure> {
        let wrong = |message: String| Err(Failure::Of("SetupError", message));
        if self.attitude.is_empty() {
            return Ok(G::identity());
        }
        if self.is_quaternion {
            let [w, x, y, z] = self.attitude[..] else {
                return wrong(format!("a quaternion has four components, not {}", self.attitude.len()));
            };
            let unit = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-300);
            let Some(unit) = unit.filter(|unit| unit.coords.iter().all(|part| part.is_finite())) else {
                return wrong("a quaternion isn't zero, and is finite".to_owned());
            };
            let rotation = G::from_rotation(unit.to_rotation_matrix().into_inner());
            return rotation
                .map_or_else(|| wrong("a quaternion is an attitude on SO3: give a matrix here".to_owned()), Ok);
        }
        let mut entries = 0;
        G::identity().matrix().each(&mut |_| entries += 1);
        if self.attitude.len() != entries {
            let found = self.attitude.len();
            return wrong(format!("an attitude has {entries} entries here, and {found} were given"));
        }
        let mut numbers = self.attitude.iter().copied();
        let matrix = G::Matrix::from_entries(&mut || numbers.next().unwrap_or(f64::NAN));
        let element = G::from_matrix_unchecked(matrix);
        let defect = element.defect();
        // A reflection satisfies the relation, too. Rotations stand first in a product.
        let rotations = G::named_numbers().iter().filter(|(name, _)| name.starts_with("q_w")).count();
        let turns = |entries: &[f64]| nalgebra::Matrix3::from_row_slice(entries).determinant() > 0.0;
        if defect < DEFECT && self.attitude.chunks_exact(9).take(rotations).all(turns) {
            return Ok(element);
        }
        wrong(format!("the attitude isn't in the group: its relation is violated by {defect:e}, or it is a reflection"))
    }
}
