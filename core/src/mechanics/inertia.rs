//! The two inertia tensors of a rigid body.
//!
//! Both are symmetric 3 × 3 matrices in the body frame, in kg m². Every value of the one is a possible value of the
//! other, so they have two types. With the position `X` of a mass element relative to the pivot,
//!
//! ```text
//! nonstandard   J_d = ∫ X Xᵀ dm            = ½ tr(J) I − J
//! ordinary      J   = ∫ (|X|² I − X Xᵀ) dm = tr(J_d) I − J_d
//! ```
//!
//! A real body has a positive semidefinite `J_d` (equivalently, its moments satisfy the triangle inequality) and a
//! positive definite `J`. The solvability of a step requires both, so the constructors check them. An effective inertia, as of
//! a body with rotors or in a fluid, is positive definite alone, and its steps have to be shorter.

use nalgebra::{Matrix3, RealField, Vector3};
use thiserror::Error;

use crate::error::Text;
use crate::numbers::{Real, real, reported};

/// The reason why a matrix isn't the inertia of a body.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(all(feature = "serde", feature = "std"), derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum InertiaError {
    /// An entry is NaN or infinite.
    #[error("the inertia has an entry that is not finite; give finite numbers")]
    NotFinite,
    /// A mass or a length isn't positive.
    #[error("the {what} of the inertia is {value:e}, not above zero; give a positive one")]
    NotPositive {
        /// The name of the mass or length.
        #[cfg_attr(all(feature = "serde", feature = "std"), serde(deserialize_with = "crate::error::kept"))]
        what: Text,
        /// The value, kg or m.
        value: f64,
    },
    /// The matrix differs from its transpose by more than rounding.
    #[error("the inertia is not symmetric: two entries differ by {defect:e}, more than rounding; give it symmetric")]
    NotSymmetric {
        /// The largest `|A_ij − A_ji|`, kg m².
        defect: f64,
    },
    /// An entry off the diagonal is larger than rounding, although the type is diagonal.
    #[error(
        "the inertia is not diagonal: an entry off the diagonal is {largest:e}; take `NonstandardInertia`, or the principal axes as the body's"
    )]
    NotDiagonal {
        /// The largest of the entries off the diagonal, kg m².
        largest: f64,
    },
    /// `J_d` has a negative eigenvalue, so the principal moments violate the triangle inequality.
    #[error(
        "no body has this inertia: J_d has the negative eigenvalue {smallest:e}, so the largest principal moment exceeds the sum of the others; check which of the two inertias is given, or take `effective`"
    )]
    TriangleInequality {
        /// The smallest eigenvalue of `J_d`, kg m².
        smallest: f64,
    },
    /// `J` isn't positive definite: a rod, a point mass, or zero.
    #[error(
        "the inertia is singular: its smallest principal moment is {smallest:e}; give a rod or a point a small thickness"
    )]
    Singular {
        /// The smallest eigenvalue of `J`, kg m².
        smallest: f64,
    },
    /// The inertia is so large or small that products of three entries leave the range of the scalar.
    #[error("the inertia has the trace {trace:e}, out of range; choose units in which it is nearer to one")]
    OutOfRange {
        /// The trace, kg m².
        trace: f64,
    },
}

/// The nonstandard moment of inertia `J_d = ∫ X Xᵀ dm` of a body about its pivot.
///
/// The reduced discrete Lagrangian (3.13) is written with it and not with the ordinary [`Inertia`]. The ordinary one in
/// its place would still give a structure-preserving step, but that of another body.
///
/// # Shape and units
///
/// 3 × 3, symmetric, body frame, kg m².
///
/// # Source
///
/// The kinetic term of \[RDAE, (3.13)\]; \[LML05\] for the name.
///
/// # Examples
///
/// ```
/// use liestep::NonstandardInertia;
/// use nalgebra::Vector3;
/// let body = NonstandardInertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0))?;
/// assert_eq!(body.as_matrix().diagonal(), Vector3::new(2.0, 2.0, 1.0));
/// # Ok::<(), liestep::mechanics::InertiaError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
#[doc(alias = "J_d")]
pub struct NonstandardInertia<T = f64>(Matrix3<T>);

/// A [`NonstandardInertia`] in principal axes: a diagonal `J_d`.
///
/// The type guarantees that six entries are zero, so the macro derives a smaller step.
///
/// # Shape and units
///
/// The diagonal of a 3 × 3 matrix, body frame, kg m².
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
#[doc(alias = "J_d")]
pub struct DiagonalNonstandardInertia<T = f64>(Vector3<T>);

/// The ordinary moment of inertia `J = ∫ (|X|² I − X Xᵀ) dm` of a body about its pivot.
///
/// # Shape and units
///
/// 3 × 3, symmetric, body frame, kg m².
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
#[doc(alias = "J")]
pub struct Inertia<T = f64>(Matrix3<T>);

impl<T: RealField + Copy> NonstandardInertia<T> {
    /// The inertia with the symmetric matrix `J_d`, kg m².
    ///
    /// # Errors
    ///
    /// [`InertiaError`], if the matrix isn't that of a body.
    pub fn new(matrix: Matrix3<T>) -> Result<Self, InertiaError> {
        check(&matrix).map(Self)
    }

    /// The inertia with this diagonal of `J_d` in principal axes, kg m²; these aren't the principal moments.
    ///
    /// # Errors
    ///
    /// [`InertiaError`], if the matrix isn't that of a body.
    pub fn from_diagonal(diagonal: Vector3<T>) -> Result<Self, InertiaError> {
        Self::new(Matrix3::from_diagonal(&diagonal))
    }

    /// The inertia with these principal moments of the ordinary inertia `J`, kg m².
    ///
    /// # Errors
    ///
    /// [`InertiaError`], if no body has these moments.
    pub fn from_principal_moments(moments: Vector3<T>) -> Result<Self, InertiaError> {
        Self::from_diagonal(nonstandard_diagonal(&moments))
    }

    /// The principal moments of the ordinary inertia `J`, kg m², the smallest first.
    #[must_use]
    pub fn principal_moments(&self) -> Vector3<T> {
        self.to_inertia().principal_moments()
    }
}

impl<T: Real> NonstandardInertia<T> {
    /// The matrix `J_d`, kg m².
    #[must_use]
    pub fn as_matrix(&self) -> &Matrix3<T> {
        &self.0
    }

    /// The ordinary inertia `J = tr(J_d) I − J_d` of the same body.
    #[must_use]
    pub fn to_inertia(&self) -> Inertia<T> {
        Inertia(Matrix3::from_diagonal_element(self.0.trace()) - self.0)
    }
}

impl<T: RealField + Copy> DiagonalNonstandardInertia<T> {
    /// The inertia with the diagonal matrix `J_d`, kg m².
    ///
    /// # Errors
    ///
    /// [`InertiaError`], if the matrix isn't that of a body, or isn't diagonal to rounding.
    pub fn new(matrix: Matrix3<T>) -> Result<Self, InertiaError> {
        let checked = check(&matrix)?;
        let beside = (checked - Matrix3::from_diagonal(&checked.diagonal())).amax();
        if beside > T::default_epsilon() * checked.amax() * real(64.0) {
            return Err(InertiaError::NotDiagonal { largest: reported(beside) });
        }
        Ok(Self(checked.diagonal()))
    }

    /// The inertia with this diagonal of `J_d` in principal axes, kg m²; these aren't the principal moments.
    ///
    /// # Errors
    ///
    /// [`InertiaError`], if the matrix isn't that of a body.
    pub fn from_diagonal(diagonal: Vector3<T>) -> Result<Self, InertiaError> {
        check(&Matrix3::from_diagonal(&diagonal)).map(|_| Self(diagonal))
    }

    /// The inertia with these principal moments of the ordinary inertia `J`, kg m².
    ///
    /// # Errors
    ///
    /// [`InertiaError`], if no body has these moments.
    pub fn from_principal_moments(moments: Vector3<T>) -> Result<Self, InertiaError> {
        Self::from_diagonal(nonstandard_diagonal(&moments))
    }
}

impl<T: Real> DiagonalNonstandardInertia<T> {
    /// The inertia with these principal moments of `J`, kg m², all positive, also where no rigid body has them.
    ///
    /// # Errors
    ///
    /// As of [`Inertia::effective`].
    pub fn effective(moments: Vector3<T>) -> Result<Self, InertiaError>
    where
        T: RealField + Copy,
    {
        let diagonal = nonstandard_diagonal(&moments);
        checked(&Matrix3::from_diagonal(&diagonal), Kind::Effective).map(|_| Self(diagonal))
    }

    /// The principal moments of the ordinary inertia `J`, kg m², in the order of the axes.
    #[must_use]
    pub fn principal_moments(&self) -> Vector3<T> {
        let d = &self.0;
        Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y)
    }

    /// The diagonal of `J_d`, kg m².
    #[must_use]
    pub fn diagonal(&self) -> &Vector3<T> {
        &self.0
    }

    /// The matrix `J_d`, kg m².
    #[must_use]
    pub fn to_matrix(&self) -> Matrix3<T> {
        Matrix3::from_diagonal(&self.0)
    }
}

impl<T: RealField + Copy> Inertia<T> {
    /// The inertia with the symmetric matrix `J`, kg m².
    ///
    /// # Errors
    ///
    /// [`InertiaError`], if the matrix isn't that of a body.
    pub fn new(matrix: Matrix3<T>) -> Result<Self, InertiaError> {
        check(&(Matrix3::from_diagonal_element(matrix.trace() * real(0.5)) - matrix))?;
        Ok(Self(symmetric_part(&matrix)))
    }

    /// The inertia with this diagonal of `J` in principal axes, kg m²: the principal moments.
    ///
    /// # Errors
    ///
    /// [`InertiaError`], if no body has these moments.
    pub fn from_diagonal(diagonal: Vector3<T>) -> Result<Self, InertiaError> {
        Self::new(Matrix3::from_diagonal(&diagonal))
    }

    /// The inertia with these principal moments, kg m².
    ///
    /// # Errors
    ///
    /// [`InertiaError`], if no body has these moments.
    pub fn from_principal_moments(moments: Vector3<T>) -> Result<Self, InertiaError> {
        Self::from_diagonal(moments)
    }

    /// An effective inertia `J`, kg m²: symmetric and positive definite, as of a body with rotors or in a fluid, whose moments may
    /// violate the triangle inequality.
    ///
    /// Steps of (3.13) and of its kind with it are of order two, but a solution isn't unique on the branch of the identity:
    /// keep `h|Ω|` well below one.
    ///
    /// # Errors
    ///
    /// [`InertiaError`], if the matrix isn't finite, symmetric and positive definite.
    ///
    /// # Examples
    ///
    /// ```
    /// use liestep::mechanics::Inertia;
    /// use nalgebra::{Matrix3, Vector3};
    /// let moments = Matrix3::from_diagonal(&Vector3::new(5174.0, 3593.0, 245.4));
    /// assert!(Inertia::new(moments).is_err() && Inertia::effective(moments).is_ok());
    /// ```
    pub fn effective(matrix: Matrix3<T>) -> Result<Self, InertiaError> {
        checked(&(Matrix3::from_diagonal_element(matrix.trace() * real(0.5)) - matrix), Kind::Effective)?;
        Ok(Self(symmetric_part(&matrix)))
    }

    /// The principal moments, kg m², the smallest first.
    #[must_use]
    pub fn principal_moments(&self) -> Vector3<T> {
        let mut moments = self.0.symmetric_eigenvalues();
        moments.as_mut_slice().sort_by(|a, b| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal));
        moments
    }
}

impl<T: Real> Inertia<T> {
    /// The matrix `J`, kg m².
    #[must_use]
    pub fn as_matrix(&self) -> &Matrix3<T> {
        &self.0
    }

    /// The nonstandard inertia `J_d = ½ tr(J) I − J` of the same body.
    #[must_use]
    pub fn to_nonstandard(&self) -> NonstandardInertia<T> {
        NonstandardInertia(Matrix3::from_diagonal_element(self.0.trace() * real::<T>(0.5)) - self.0)
    }
}

impl<T: Real> From<DiagonalNonstandardInertia<T>> for NonstandardInertia<T> {
    fn from(inertia: DiagonalNonstandardInertia<T>) -> Self {
        Self(inertia.to_matrix())
    }
}

fn nonstandard_diagonal<T: RealField + Copy>(moments: &Vector3<T>) -> Vector3<T> {
    Vector3::from_element(moments.sum() * real(0.5)) - moments
}

fn symmetric_part<T: RealField + Copy>(matrix: &Matrix3<T>) -> Matrix3<T> {
    (matrix + matrix.transpose()) * real::<T>(0.5)
}

/// The bodies that an inertia may be that of.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// A rigid body: `J_d` is positive semidefinite.
    Rigid,
    /// Any for which `J` is positive definite.
    Effective,
}

/// Checks that a nonstandard inertia `J_d` is that of a rigid body, and symmetrises it.
fn check<T: RealField + Copy>(nonstandard: &Matrix3<T>) -> Result<Matrix3<T>, InertiaError> {
    checked(nonstandard, Kind::Rigid)
}

fn checked<T: RealField + Copy>(nonstandard: &Matrix3<T>, kind: Kind) -> Result<Matrix3<T>, InertiaError> {
    if !nonstandard.iter().all(|&entry| crate::numbers::is_finite(entry)) {
        return Err(InertiaError::NotFinite);
    }
    let trace = nonstandard.trace();
    // Products of three entries and of inverse step lengths must stay within range: a quarter of the exponents
    // suffices.
    let largest = T::max_value().map_or(real(1e75), |max| max.sqrt().sqrt());
    let size = nonstandard.amax().max(trace.abs());
    if size > largest || (size > T::zero() && size * largest < T::one()) {
        return Err(InertiaError::OutOfRange { trace: reported(trace) });
    }
    // The tolerance for a tensor that is computed, rotated or printed to 15 digits.
    let rounding = T::default_epsilon() * size * real(64.0);
    let defect = (nonstandard - nonstandard.transpose()).amax();
    if defect > rounding {
        return Err(InertiaError::NotSymmetric { defect: reported(defect) });
    }
    let symmetric = symmetric_part(nonstandard);
    let mut eigenvalues = symmetric.symmetric_eigenvalues();
    eigenvalues.as_mut_slice().sort_by(|a, b| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal));
    if eigenvalues[0] < -rounding && kind == Kind::Rigid {
        return Err(InertiaError::TriangleInequality { smallest: reported(eigenvalues[0]) });
    }
    let smallest_moment = eigenvalues[0] + eigenvalues[1];
    if smallest_moment <= rounding {
        return Err(InertiaError::Singular { smallest: reported(smallest_moment) });
    }
    Ok(symmetric)
}

#[cfg(test)]
mod tests {
    use super::{DiagonalNonstandardInertia, Inertia, InertiaError, NonstandardInertia};
    use nalgebra::{Matrix3, Vector3};

    #[test]
    fn the_same_body_by_three_constructors_of_three_types() {
        let (moments, diagonal) = (Vector3::new(1.0, 2.0, 2.5), Vector3::new(1.75, 0.75, 0.25));
        let bodies = [
            NonstandardInertia::from_principal_moments(moments),
            NonstandardInertia::from_diagonal(diagonal),
            NonstandardInertia::new(Matrix3::from_diagonal(&diagonal)),
            DiagonalNonstandardInertia::from_principal_moments(moments).map(Into::into),
            DiagonalNonstandardInertia::from_diagonal(diagonal).map(Into::into),
            DiagonalNonstandardInertia::new(Matrix3::from_diagonal(&diagonal)).map(Into::into),
            Inertia::from_principal_moments(moments).map(|inertia| inertia.to_nonstandard()),
            Inertia::from_diagonal(moments).map(|inertia| inertia.to_nonstandard()),
            Inertia::new(Matrix3::from_diagonal(&moments)).map(|inertia| inertia.to_nonstandard()),
        ];
        for body in bodies {
            let body = body.unwrap();
            assert_eq!(body.as_matrix(), &Matrix3::from_diagonal(&diagonal));
            assert!((body.principal_moments() - moments).norm() < 1e-15);
        }
        let ordered = DiagonalNonstandardInertia::from_diagonal(Vector3::new(0.25, 1.75, 0.75)).unwrap();
        assert_eq!(ordered.principal_moments(), Vector3::new(2.5, 1.0, 2.0));
    }

    #[test]
    fn a_matrix_that_is_not_diagonal_is_refused() {
        let full = Matrix3::new(1.0, 0.125, 0.0, 0.125, 1.0, 0.0, 0.0, 0.0, 1.0);
        assert_eq!(DiagonalNonstandardInertia::new(full), Err(InertiaError::NotDiagonal { largest: 0.125 }));
        assert!(NonstandardInertia::new(full).is_ok());
    }
}
