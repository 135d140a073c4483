//! B6: a matrix that isn't the inertia of a body is refused at construction.

use liestep::NonstandardInertia;
use liestep::mechanics::{Inertia, InertiaError};
use nalgebra::{Matrix3, Vector3};

use crate::row::{Effort, Failure, Row};

/// A test for the expected kind of error.
type IsRight = fn(&InertiaError) -> bool;

#[allow(clippy::unnecessary_wraps)] // as for all rows
pub(crate) fn b6(_: Effort) -> Result<Row, Failure> {
    let diagonal = |x, y, z| Matrix3::from_diagonal(&Vector3::new(x, y, z));
    let mut askew = diagonal(2.0, 2.0, 1.0);
    askew.m12 = 0.1;
    let nonstandard = |matrix| NonstandardInertia::<f64>::new(matrix).err();
    let cases: [(&str, Option<InertiaError>, IsRight); 9] = [
        ("negative entry of J_d", nonstandard(diagonal(2.0, 2.0, -0.1)), |e| {
            matches!(e, InertiaError::TriangleInequality { .. })
        }),
        (
            "J without the triangle inequality",
            Inertia::from_principal_moments(Vector3::new(1.0, 1.0, 3.0)).err(),
            |e| matches!(e, InertiaError::TriangleInequality { .. }),
        ),
        ("singular J", nonstandard(diagonal(0.0, 0.0, 1.0)), |e| matches!(e, InertiaError::Singular { .. })),
        ("nothing", nonstandard(Matrix3::zeros()), |e| matches!(e, InertiaError::Singular { .. })),
        ("not symmetric", nonstandard(askew), |e| matches!(e, InertiaError::NotSymmetric { .. })),
        ("NaN", nonstandard(diagonal(2.0, f64::NAN, 1.0)), |e| matches!(e, InertiaError::NotFinite)),
        ("infinite", nonstandard(diagonal(2.0, f64::INFINITY, 1.0)), |e| matches!(e, InertiaError::NotFinite)),
        ("1e150", nonstandard(diagonal(2e150, 2e150, 1e150)), |e| matches!(e, InertiaError::OutOfRange { .. })),
        ("1e-150", nonstandard(diagonal(2e-150, 2e-150, 1e-150)), |e| matches!(e, InertiaError::OutOfRange { .. })),
    ];
    let mut row = Row::new("B6", "inertias that no body has", "typed error at construction");
    for (name, found, is_right) in cases {
        row = row.holds(name, found.as_ref().is_some_and(is_right));
    }
    Ok(row)
}
