//! Coordinates of increments that stay in a group.

use super::linear::{ROUNDING, inverse_of};

/// The coordinates of an increment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chart {
    /// The Cayley map of an element of the algebra.
    Cayley,
    /// The product of the Cayley maps of all generators, where that of a sum leaves the group.
    Product,
}

/// Coordinates about the identity that stay in the group of these generators, each by rows; the index of a generator whose
/// cube isn't a multiple of it if there are none.
pub fn chart(generators: &[Vec<f64>]) -> Result<Chart, usize> {
    if has_cayley_map(generators) {
        return Ok(Chart::Cayley);
    }
    match generators.iter().position(|e| cube(e).is_none()) {
        Some(generator) => Err(generator),
        None => Ok(Chart::Product),
    }
}

/// `A B` of two square matrices by rows.
pub fn times(a: &[f64], b: &[f64]) -> Vec<f64> {
    let n = a.len().isqrt();
    (0..n * n).map(|at| (0..n).map(|k| a[at / n * n + k] * b[k * n + at % n]).sum()).collect()
}

/// The number `c` with `E³ = c E`.
pub fn cube(e: &[f64]) -> Option<f64> {
    let cube = times(&times(e, e), e);
    let at = e.iter().position(|&entry| entry != 0.0)?;
    let c = cube[at] / e[at];
    cube.iter().zip(e).all(|(a, b)| (a - c * b).abs() < ROUNDING).then_some(c)
}

/// The components of an element of the algebra as sums of terms `(k, entry, factor)`; none if the generators depend on each
/// other.
pub fn dual(generators: &[Vec<f64>]) -> Option<Vec<(usize, usize, f64)>> {
    let count = generators.len();
    let gram = |i: usize, j: usize| generators[i].iter().zip(&generators[j]).map(|(a, b)| a * b).sum::<f64>();
    let pairings: Vec<f64> = (0..count * count).map(|at| gram(at / count, at % count)).collect();
    let inverse = inverse_of(count, &pairings)?;
    let factor =
        |place: usize, k: usize| (0..count).map(|j| inverse[k * count + j] * generators[j][place]).sum::<f64>();
    let entries = generators.first().map_or(0, Vec::len);
    let places = (0..entries).flat_map(|place| (0..count).map(move |k| (k, place)));
    Some(places.map(|(k, place)| (k, place, factor(place, k))).filter(|term| term.2.abs() > 1e-14).collect())
}

/// Whether a matrix is a combination of generators with these dual forms.
pub fn has(generators: &[Vec<f64>], dual: &[(usize, usize, f64)], matrix: &[f64]) -> bool {
    let mut rest = matrix.to_vec();
    for &(k, place, factor) in dual {
        for (rest, e) in rest.iter_mut().zip(&generators[k]) {
            *rest -= factor * matrix[place] * e;
        }
    }
    rest.iter().all(|entry| entry.abs() < ROUNDING)
}

/// Whether the Cayley map of the algebra is in the group, as it is if and only if cubes of elements are in the algebra:
/// `Σ E_i E_j E_k` over all orders, for all three.
fn has_cayley_map(all: &[Vec<f64>]) -> bool {
    let (Some(dual), count) = (dual(all), all.len()) else { return false };
    let orders = |i: usize, j: usize, k: usize| {
        let orders = [[i, j, k], [i, k, j], [j, i, k], [j, k, i], [k, i, j], [k, j, i]];
        let each = orders.map(|[i, j, k]| times(&times(&all[i], &all[j]), &all[k]));
        (0..all[i].len()).map(|at| each.iter().map(|product| product[at]).sum()).collect::<Vec<f64>>()
    };
    (0..count).all(|i| (i..count).all(|j| (j..count).all(|k| has(all, &dual, &orders(i, j, k)))))
}
