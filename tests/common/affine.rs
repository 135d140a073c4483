//! A group outside of the library: the affine maps `x ↦ a x + b` of the line, `a > 0`.

use liestep::groups::{Generators, MatrixGroup};
use nalgebra::{RealField, SMatrix};

/// The generators of scalings and of shifts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AffineGenerators;

impl Generators<2, 2> for AffineGenerators {
    const GENERATORS: [[[f64; 2]; 2]; 2] = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [0.0, 0.0]]];

    fn relation<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> T {
        m[(1, 0)].abs() + (m[(1, 1)] - T::one()).abs()
    }
}

pub type Affine<T = f64> = MatrixGroup<AffineGenerators, T, 2, 2>;
