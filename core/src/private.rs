//! Names that expansions use. Not part of the interface.

pub use core;
pub use nalgebra;

// Declaration macros, which the macro of a user's group calls back.
pub use liestep_macros::{constraint, force, lagrangian, matrix_group, nonholonomic};

// Names in an expanded declaration.
pub use crate::error::SetupError;
pub use crate::groups::rotation_functions::{
    inverse, log_ratio, log_ratio_series, rotation_exp, rotation_log, stumpff, stumpff_series,
};
pub use crate::groups::{CayleyRetraction, Configuration, Relative, Retraction, SeenFrom};
pub use crate::groups::{ContravariantTensor, ContravariantVector, CovariantTensor, Given, MixedTensor};
pub use crate::groups::{Generators, LieGroup, MatrixGroup, SO3};
pub use crate::mechanics::{
    ContinuousLagrangian, DiscreteLagrangian, Effect, Facts, Force, LeftInvariant, Legendre, Limit, Nonholonomic,
    NonholonomicCheck, Operations, Parts, SceneVisitor, SecondDerivatives, SharedBy, StepDerivatives, StepPoint, Sum,
    Term, WithKinetic, WithoutKinetic,
};
pub use crate::methods::{Constraint, Place, Slope};
pub use crate::numbers::{Blocks, Coordinates, Entries, Identity, InLanes, Lanes, Numbers, Real, real};

// Decisions of a solve, for steps that are programs.
pub use crate::solving::{
    LONGEST_DAMPED, MAX_DAMPED_ITERATIONS, MAX_ITERATIONS, MOST_HALVINGS, NEAR_ENOUGH, SETTLED, SUFFICIENT,
    Solvability, TurningLimits, has_sufficed, largest_fraction, may_suffice, safe, six_digits, turning_limits,
};

// Coefficients, convergence test and sums of a collocation, for stages that are slices.
pub use crate::methods::{Changes, Coefficients, Next};
pub use crate::numbers::two_sum;

// Constants of a step, in one place for steps that are programs.
pub use crate::motion::forced;
pub use crate::motion::own_step::RATIO;
pub use crate::motion::summation::{STEPS_BETWEEN_CHECKS, STEPS_BETWEEN_SEVERAL, TOLERATED};

/// The limits of the solve for the velocity of a momentum.
pub mod velocity {
    pub use crate::numbers::newton::{AT_MOST, MOST_HALVINGS, MOST_ITERATIONS, ROUNDINGS, ROUNDINGS_OF_SOLUTION};
}

use nalgebra::{Matrix3, Point, SMatrix, SVector};

use crate::groups::{Advected, homogeneous};
use crate::mechanics::{DiagonalNonstandardInertia, Inertia, NonstandardInertia};

/// The inverse `F⁻¹` of a group element.
#[inline]
pub fn inverse_of<G: LieGroup>(element: G::Matrix) -> G::Matrix {
    G::from_matrix_unchecked(element).inverse().matrix()
}

/// The velocity of a step with increment `F`, and `F⁻¹·w`; NaN if `F` is outside of the retraction's coordinates.
fn at_the_end<L: ContinuousLagrangian, R: Retraction<L::Group>>(
    f: &<L::Group as LieGroup>::Matrix,
    w: &L::Advected,
    h: L::Scalar,
) -> (<L::Group as LieGroup>::Vector, L::Advected) {
    let element = L::Group::from_matrix_unchecked(*f);
    let coordinates = R::local_coordinates(&element);
    let nowhere = || <L::Group as LieGroup>::Vector::zero() * real(f64::NAN);
    let velocity = coordinates.unwrap_or_else(nowhere) * (real::<L::Scalar>(1.0) / h);
    (velocity, w.seen_from(&element))
}

/// The trapezoidal rule `(h/2) (l(ξ, w) + l(ξ, F⁻¹·w))`.
pub fn trapezoid<L: ContinuousLagrangian, R: Retraction<L::Group>>(
    lagrangian: &L,
    f: &<L::Group as LieGroup>::Matrix,
    w: &L::Advected,
    h: L::Scalar,
) -> L::Scalar {
    let (velocity, next) = at_the_end::<L, R>(f, w, h);
    (lagrangian.l(&velocity, w) + lagrangian.l(&velocity, &next)) * (h * real(0.5))
}

/// The chord rule `h l(ξ, (w + F⁻¹·w)/2)`.
pub fn chord<L: ContinuousLagrangian, R: Retraction<L::Group>>(
    lagrangian: &L,
    f: &<L::Group as LieGroup>::Matrix,
    w: &L::Advected,
    h: L::Scalar,
) -> L::Scalar {
    let (velocity, next) = at_the_end::<L, R>(f, w, h);
    let middle = Entries::<L::Scalar>::zip(w, &next, &mut |a, b| (a + b) * real(0.5));
    lagrangian.l(&velocity, &middle) * h
}

/// A field of a declared Lagrangian: its value in the declared expression, and whether it is finite.
#[diagnostic::on_unimplemented(
    message = "`{Self}` isn't the type that a declaration takes it for",
    label = "another type of this name",
    note = "types of fields are known by their names: give yours another one, or import that of liestep or nalgebra"
)]
pub trait Parameter {
    /// The type with which the expression computes.
    type Value;
    /// The scalar type of the value's entries.
    type Scalar: Real;

    /// The value in the expression.
    fn value(&self) -> Self::Value;

    /// Whether all entries are finite.
    fn is_finite(&self) -> bool;

    /// Passes every scalar to the visitor.
    fn describe(&self, field: &'static str, visitor: &mut dyn SceneVisitor<Self::Scalar>);

    /// The error for the first parameter that isn't finite.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] with the name of the field.
    fn validate(&self, field: &'static str) -> Result<(), SetupError> {
        if self.is_finite() { Ok(()) } else { Err(SetupError::Parameter { field, cause: "is not finite" }) }
    }
}

/// Whether all of the constants are finite.
pub fn are_finite<T: Real, const N: usize>(constants: &Numbers<T, N>) -> bool {
    constants.0.iter().all(|constant| crate::numbers::is_finite(*constant))
}

/// The validation of a scalar, as [`Parameter::validate`].
///
/// # Errors
///
/// [`SetupError::Parameter`] with the name of the field.
pub fn validate_scalar<T: Real>(value: T, field: &'static str) -> Result<(), SetupError> {
    if crate::numbers::is_finite(value) { Ok(()) } else { Err(SetupError::Parameter { field, cause: "is not finite" }) }
}

/// Implements `Parameter`: the value with which an expression computes, and the entries that are described and checked
/// if they differ from those of the value.
macro_rules! parameters {
    ($($type:ty $(where $(const $n:ident),+)?: $value:ty = |$of:ident| $get:expr $(, $entries:expr)?;)+) => {$(
        impl<T: Real $($(, const $n: usize)+)?> Parameter for $type {
            type Value = $value;
            type Scalar = T;

            #[hot]
            fn value(&self) -> $value {
                let $of = self;
                $get
            }

            fn describe(&self, field: &'static str, visitor: &mut dyn SceneVisitor<T>) {
                parameters!(@entries self $of $(, $entries)?).each(&mut |entry| visitor.parameter(field, entry));
            }

            fn is_finite(&self) -> bool {
                let mut is_finite = true;
                let look = &mut |entry| is_finite &= crate::numbers::is_finite(entry);
                parameters!(@entries self $of $(, $entries)?).each(look);
                is_finite
            }
        }
    )+};
    (@entries $self:ident $of:ident) => { Parameter::value($self) };
    (@entries $self:ident $of:ident, $entries:expr) => {{ let $of = $self; $entries }};
}

parameters! {
    SMatrix<T, R, C> where const R, const C: Self = |matrix| *matrix;
    NonstandardInertia<T>: Matrix3<T> = |inertia| *inertia.as_matrix();
    Inertia<T>: Matrix3<T> = |inertia| *inertia.as_matrix();
    DiagonalNonstandardInertia<T>: Matrix3<T> = |inertia| inertia.to_matrix();
    ContravariantVector<T, N> where const N: SVector<T, N> = |vector| vector.0;
    ContravariantTensor<T, N> where const N: SMatrix<T, N, N> = |tensor| tensor.0;
    CovariantTensor<T, N> where const N: SMatrix<T, N, N> = |tensor| tensor.0;
    MixedTensor<T, N> where const N: SMatrix<T, N, N> = |tensor| tensor.0;
    // The expression computes with homogeneous coordinates.
    Point<T, 1>: SVector<T, 2> = |point| homogeneous(point), point.coords;
    Point<T, 2>: SVector<T, 3> = |point| homogeneous(point), point.coords;
    Point<T, 3>: SVector<T, 4> = |point| homogeneous(point), point.coords;
}

impl<K: Generators<N, D>, T, const N: usize, const D: usize> MatrixGroup<K, T, N, D> {
    /// Whether an expansion has the generators of this group, by rows.
    #[must_use]
    #[allow(clippy::float_cmp)] // both come from decimal literals
    pub const fn has_generators(matrices: &[[[f64; N]; N]; D]) -> bool {
        let mut place = 0;
        while place < D * N * N {
            let (k, row, column) = (place / (N * N), place / N % N, place % N);
            if K::GENERATORS[k][row][column] != matrices[k][row][column] {
                return false;
            }
            place += 1;
        }
        true
    }
}
