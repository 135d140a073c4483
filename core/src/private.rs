//! What expansions name. Not part of the interface.

pub use core;
pub use nalgebra;

use nalgebra::{Matrix3, Vector3};

pub use crate::scalar::real;
use crate::{DiagonalNonstandardInertia, Inertia, NonstandardInertia, Real, SetupError};

/// A field of a declared Lagrangian: its value for the declared expression, and whether it can be used.
pub trait Parameter {
    /// What the expression computes with.
    type Value;

    /// The value.
    fn value(&self) -> Self::Value;

    /// Whether all entries are finite.
    fn is_finite(&self) -> bool;

    /// The error for the first parameter that isn't finite.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] with the name of the field.
    fn validate(&self, field: &'static str) -> Result<(), SetupError> {
        if self.is_finite() { Ok(()) } else { Err(SetupError::Parameter { field, cause: "is not finite" }) }
    }
}

/// As [`Parameter::validate`], for a scalar.
///
/// # Errors
///
/// [`SetupError::Parameter`] with the name of the field.
pub fn validate_scalar<T: Real>(value: T, field: &'static str) -> Result<(), SetupError> {
    if crate::scalar::is_finite(value) { Ok(()) } else { Err(SetupError::Parameter { field, cause: "is not finite" }) }
}

macro_rules! matrix_parameter {
    ($type:ty, $value:ty, $get:expr) => {
        impl<T: Real> Parameter for $type {
            type Value = $value;

            #[inline(always)]
            fn value(&self) -> $value {
                $get(self)
            }

            fn is_finite(&self) -> bool {
                Parameter::value(self).iter().all(|&entry| crate::scalar::is_finite(entry))
            }
        }
    };
}

matrix_parameter!(Vector3<T>, Vector3<T>, Clone::clone);
matrix_parameter!(Matrix3<T>, Matrix3<T>, Clone::clone);
matrix_parameter!(NonstandardInertia<T>, Matrix3<T>, |inertia: &Self| *inertia.as_matrix());
matrix_parameter!(Inertia<T>, Matrix3<T>, |inertia: &Self| *inertia.as_matrix());
matrix_parameter!(DiagonalNonstandardInertia<T>, Matrix3<T>, Self::to_matrix);
