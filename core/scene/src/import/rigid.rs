//! Masses that are rigidly connected: their sum in one frame.

use nalgebra::{Isometry3, Matrix3, SymmetricEigen, Vector3};

/// A mass with its centre and its tensor of inertia about it, in the axes of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Distribution {
    /// kg.
    pub(super) mass: f64,
    /// m.
    pub(super) centre: Vector3<f64>,
    /// kg m².
    pub(super) inertia: Matrix3<f64>,
}

impl Distribution {
    pub(super) const NOTHING: Self = Self {
        mass: 0.0,
        centre: Vector3::new(0.0, 0.0, 0.0),
        inertia: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    };

    /// The distribution in a frame where its own has this place.
    pub(super) fn seen(&self, place: &Isometry3<f64>) -> Self {
        let R = place.rotation.to_rotation_matrix();
        Self {
            mass: self.mass,
            centre: place.transform_point(&self.centre.into()).coords,
            inertia: R.matrix() * self.inertia * R.matrix().transpose(),
        }
    }

    /// The sum, by Steiner's theorem about the common centre.
    pub(super) fn with(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        if mass <= 0.0 {
            return Self { mass: 0.0, centre: self.centre, inertia: self.inertia + other.inertia };
        }
        let centre = (self.centre * self.mass + other.centre * other.mass) / mass;
        let about = |one: &Self| {
            let arm = one.centre - centre;
            one.inertia + (Matrix3::identity() * arm.norm_squared() - arm * arm.transpose()) * one.mass
        };
        Self { mass, centre, inertia: about(self) + about(other) }
    }

    /// The tensor with the least principal moment raised until a body can have it, and whether it was. A principal moment is at
    /// most the sum of the others; none for a tensor with a moment that isn't positive.
    pub(super) fn possible(&self) -> Option<(Matrix3<f64>, bool)> {
        let symmetric = (self.inertia + self.inertia.transpose()) * 0.5;
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::try_new(symmetric, f64::EPSILON, 1000)?;
        let largest = eigenvalues.imax();
        let (sum, most) = (eigenvalues.sum(), eigenvalues[largest]);
        if !(eigenvalues.min() > ROUNDED * most && most.is_finite()) {
            return None;
        }
        let lack = most - (sum - most);
        if lack <= 0.0 {
            return Some((symmetric, false));
        }
        let mut moments = eigenvalues;
        // The least moment grows by slightly more than it lacks: rounded to printed digits, the tensor is possible, too.
        moments[eigenvalues.imin()] += lack + most * 1e-9;
        Some((eigenvectors * Matrix3::from_diagonal(&moments) * eigenvectors.transpose(), true))
    }
}

/// The least principal moment, relative to the largest, that isn't zero.
const ROUNDED: f64 = 1e-12;
