//! Exponential coordinates of any group by its generators, on slices: for small changes, not for steps.

use liestep::SO3;
use liestep::groups::{ExponentialRetraction, Retraction as _};
use liestep_derivation::whole::{Form, MatrixFactor};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Square roots before the series of a logarithm, which then has some ten terms.
const MOST_ROOTS: u32 = 30;
/// The iterations for a square root.
const MOST_ITERATIONS: u32 = 60;
/// The terms of the tangent's series: enough for a turn of some ten radians.
const TERMS: u32 = 60;

/// `Σ x_k E_k`.
fn hat(factor: &MatrixFactor, x: &[f64]) -> DMatrix<f64> {
    let n = factor.size();
    let generators = factor.basis.generators.iter().zip(x);
    generators.fold(DMatrix::zeros(n, n), |sum, (e, x)| sum + DMatrix::from_row_slice(n, n, e) * *x)
}

/// The components of an element of the algebra.
fn components(factor: &MatrixFactor, matrix: &DMatrix<f64>) -> Option<Vec<f64>> {
    let n = factor.size();
    let all: Vec<DMatrix<f64>> = factor.basis.generators.iter().map(|e| DMatrix::from_row_slice(n, n, e)).collect();
    let gram = DMatrix::from_fn(all.len(), all.len(), |i, j| all[i].dot(&all[j]));
    let right = DVector::from_fn(all.len(), |i, _| all[i].dot(matrix));
    gram.lu().solve(&right).map(|x| x.as_slice().to_vec())
}

/// The matrix of `ad_ξ`, whose columns are the components of `[ξ, E_j]`; a block for each factor.
pub(super) fn adjoint(factors: &[MatrixFactor], xi: &[f64]) -> Option<DMatrix<f64>> {
    let mut ad = DMatrix::zeros(xi.len(), xi.len());
    for factor in factors {
        let (n, first) = (factor.size(), factor.component);
        let own = hat(factor, &xi[first..first + factor.dimension()]);
        for (j, e) in factor.basis.generators.iter().enumerate() {
            let e = DMatrix::from_row_slice(n, n, e);
            let bracket = components(factor, &(&own * &e - &e * &own))?;
            ad.view_mut((first, first + j), (factor.dimension(), 1)).copy_from_slice(&bracket);
        }
    }
    Some(ad)
}

/// The columns of the left-trivialised tangent of the exponential, `Σ (−ad_ξ)^k/(k + 1)!`.
pub(super) fn tangent(factors: &[MatrixFactor], xi: &[f64]) -> Option<Vec<f64>> {
    let ad = adjoint(factors, xi)?;
    let mut term = DMatrix::identity(xi.len(), xi.len());
    let mut sum = term.clone();
    for k in 1..=TERMS {
        term = -(&ad * term) / f64::from(k + 1);
        sum += &term;
    }
    Some(sum.as_slice().to_vec())
}

/// The attitude `g exp ξ̂`, its matrices row by row.
pub(super) fn displaced(factors: &[MatrixFactor], attitude: &[f64], xi: &[f64]) -> Vec<f64> {
    let mut displaced = Vec::with_capacity(attitude.len());
    for factor in factors {
        let (g, xi) = (element(factor, attitude), &xi[factor.component..factor.component + factor.dimension()]);
        let turn = if factor.form == Form::Rotation {
            let turn: SO3 = ExponentialRetraction::retract(&Vector3::from_column_slice(xi));
            DMatrix::from_row_slice(3, 3, turn.as_matrix().transpose().as_slice())
        } else {
            hat(factor, xi).exp()
        };
        displaced.extend((g * turn).transpose().iter());
    }
    displaced
}

/// The coordinates of `g_0⁻¹ g`; none where the logarithm isn't defined, or isn't near.
pub(super) fn displacement(factors: &[MatrixFactor], from: &[f64], to: &[f64]) -> Option<Vec<f64>> {
    let mut coordinates = Vec::new();
    for factor in factors {
        let turn = element(factor, from).try_inverse()? * element(factor, to);
        if factor.form == Form::Rotation {
            let turn = SO3::from_matrix_unchecked(Matrix3::from_column_slice(turn.as_slice()));
            coordinates.extend(ExponentialRetraction::local_coordinates(&turn)?.iter());
        } else {
            coordinates.extend(components(factor, &logarithm(turn)?)?);
        }
    }
    Some(coordinates)
}

fn element(factor: &MatrixFactor, attitude: &[f64]) -> DMatrix<f64> {
    let n = factor.size();
    DMatrix::from_row_slice(n, n, &attitude[factor.entry..factor.entry + n * n])
}

/// The principal logarithm, by square roots and `log A = 2 Σ X^{2k+1}/(2k+1)` with `X = (A − I)(A + I)⁻¹`.
fn logarithm(mut a: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let one = DMatrix::identity(a.nrows(), a.nrows());
    let mut scale = 2.0;
    for _ in 0..MOST_ROOTS {
        if (&a - &one).norm() < 0.25 {
            break;
        }
        a = root(&a)?;
        scale *= 2.0;
    }
    let x = (&a - &one) * (&a + &one).try_inverse()?;
    let square = &x * &x;
    let (mut power, mut sum) = (x.clone(), x);
    for k in 1..12 {
        power = &power * &square;
        sum += &power / f64::from(2 * k + 1);
    }
    let logarithm = sum * scale;
    logarithm.iter().all(|entry| entry.is_finite()).then_some(logarithm)
}

/// The principal square root, by the iteration of Denman and Beavers; none if a negative number is an eigenvalue.
fn root(a: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let (mut y, mut z) = (a.clone(), DMatrix::identity(a.nrows(), a.nrows()));
    for _ in 0..MOST_ITERATIONS {
        let next = (&y + z.clone().try_inverse()?) * 0.5;
        z = (&z + y.clone().try_inverse()?) * 0.5;
        let change = (&next - &y).norm();
        y = next;
        if change <= 1e-15 * y.norm() {
            break;
        }
    }
    let missed = (&y * &y - a).norm();
    (missed <= 1e-12 * a.norm()).then_some(y)
}
