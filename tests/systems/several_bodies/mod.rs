//! Several bodies on a product of groups: by hand a chain of links, all of which feel each other's velocities, and bodies
//! that feel each other's attitudes alone; a double pendulum, and these bodies, as declared; systems of many, and chains of many links.

mod attitudes;
mod chain;
mod declared;
mod links;
mod many;

use liestep::SO3;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use serde_json::Value;

use declarations::motions::{matrix, vector};

/// Attitude and body velocity of one body.
type End = (Matrix3<f64>, Vector3<f64>);

/// `(M − Mᵀ)^∨`, twice the components of the skew part.
fn twice_vee(m: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12)
}

/// The components of all bodies, one after the other.
fn stacked<const D: usize>(parts: &[Vector3<f64>]) -> SVector<f64, D> {
    SVector::from_fn(|k, _| parts[k / 3][k % 3])
}

/// Those of one body.
fn part<const D: usize>(of: &SVector<f64, D>, body: usize) -> Vector3<f64> {
    of.fixed_rows::<3>(3 * body).into_owned()
}

fn put<const D: usize>(square: &mut SMatrix<f64, D, D>, (row, column): (usize, usize), block: &Matrix3<f64>) {
    let mut place = square.fixed_view_mut::<3, 3>(3 * row, 3 * column);
    place += block;
}

/// `F − I` without a rounding of `I`, and `F`.
fn increments<const N: usize>(f: [&Matrix3<f64>; N]) -> [(Matrix3<f64>, Matrix3<f64>); N] {
    f.map(|f| (f - Matrix3::identity(), *f))
}

/// What a file has of all bodies.
fn all<R>(values: &Value, read: impl Fn(&Value) -> R) -> Vec<R> {
    values.as_array().unwrap().iter().map(read).collect()
}

fn attitudes_of(values: &Value) -> Vec<SO3> {
    all(values, |value| SO3::try_from(matrix(value)).unwrap())
}

fn momentum<const D: usize>(values: &Value) -> SVector<f64, D> {
    stacked(&all(values, vector))
}

/// The largest difference of an entry.
fn apart(attitudes: &[SO3], expected: &[SO3]) -> f64 {
    let differences = attitudes.iter().zip(expected).map(|(a, b)| (a.as_matrix() - b.as_matrix()).amax());
    differences.fold(0.0, f64::max)
}
