//! Symmetries of a continuous Lagrangian at its parameters, and the conserved momenta (Noether).

use alloc::vec;
use alloc::vec::Vec;

use crate::groups::{Advected as _, LieGroup};
use crate::mechanics::continuous::ContinuousLagrangian;
use crate::mechanics::term::Term;
use crate::numbers::{Coordinates, Entries, real, reported};

roots!();

type Vector<L> = <<L as Term>::Group as LieGroup>::Vector;

/// The rounding error of a row that depends linearly on others, relative to the size of the terms of the rows.
const ROUNDING: f64 = 1e-10;

/// The symmetries of a scene in space: a basis of the `η` with `η·a_0 = 0`. The spatial momentum along them,
/// `⟨Ad*_{g⁻¹} μ, η⟩`, is conserved.
pub(crate) fn left_symmetries<L: ContinuousLagrangian>(lagrangian: &L) -> Vec<Vector<L>> {
    let spatial = lagrangian.advected();
    let columns = (0..L::Group::DIMENSION).map(|k| {
        let mut entries = Vec::new();
        spatial.rate(&L::Group::hat(&Vector::<L>::axis(k))).each(&mut |entry| entries.push(reported(entry)));
        entries
    });
    let columns: Vec<Vec<f64>> = columns.collect();
    let rows = columns.first().map_or(0, Vec::len);
    let rows = (0..rows).map(|row| columns.iter().map(|column| column[row]).collect());
    let mut scale = 0.0_f64;
    spatial.each(&mut |entry| scale = scale.max(reported(entry).abs()));
    combined::<L>(null_space(rows.collect(), L::Group::DIMENSION, scale))
}

/// The symmetries of a Lagrangian in the body: a basis of the `ζ` with `⟨μ̇, ζ⟩ = 0` at all velocities and advected
/// parameters. The body momentum along them, `⟨μ, ζ⟩`, is conserved.
pub(crate) fn right_symmetries<L: ContinuousLagrangian>(lagrangian: &L) -> Vec<Vector<L>> {
    // A linear congruence (Knuth's MMIX constants) is random enough for sample points.
    let mut state = 1_u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        #[allow(clippy::cast_precision_loss)] // 53 bits are left
        let unit = (state >> 11) as f64 / (1_u64 << 53) as f64;
        real::<L::Scalar>(0.6 * unit - 0.3)
    };
    let dimension = L::Group::DIMENSION;
    let mut scale = 0.0_f64;
    let rows = (0..2 * dimension + 2).map(|_| {
        let velocity = Vector::<L>::from_entries(&mut number);
        let w = L::Advected::from_entries(&mut number);
        let (momentum, diamond) = (lagrangian.momentum(&velocity, &w), lagrangian.diamond_rate(&velocity, &w));
        let squared = momentum.dot(&momentum) * velocity.dot(&velocity) + diamond.dot(&diamond);
        scale = scale.max(reported(squared).sqrt());
        let mut row = Vec::new();
        lagrangian.momentum_rate(&velocity, &w).each(&mut |entry| row.push(reported(entry)));
        row
    });
    let rows = rows.collect();
    combined::<L>(null_space(rows, dimension, scale))
}

/// Vectors of the algebra from their components.
fn combined<L: ContinuousLagrangian>(basis: Vec<Vec<f64>>) -> Vec<Vector<L>> {
    let vector = |components: Vec<f64>| {
        let mut components = components.into_iter();
        Vector::<L>::from_entries(&mut || real(components.next().unwrap_or(f64::NAN)))
    };
    basis.into_iter().map(vector).collect()
}

/// A basis of the null space of these rows, whose terms have the size `scale`, by elimination with row pivots; empty if
/// a row isn't finite.
fn null_space(mut rows: Vec<Vec<f64>>, dimension: usize, scale: f64) -> Vec<Vec<f64>> {
    if rows.iter().flatten().any(|entry| !entry.is_finite()) {
        return Vec::new();
    }
    let mut pivots: Vec<usize> = Vec::new();
    for column in 0..dimension {
        let next = pivots.len();
        let candidates = (next..rows.len()).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()));
        let Some(found) = candidates.filter(|&row| rows[row][column].abs() > ROUNDING * scale) else { continue };
        rows.swap(next, found);
        let pivot: Vec<f64> = rows[next].iter().map(|entry| entry / rows[next][column]).collect();
        for row in &mut rows {
            let factor = row[column];
            row.iter_mut().zip(&pivot).for_each(|(entry, taken)| *entry -= factor * taken);
        }
        rows[next] = pivot;
        pivots.push(column);
    }
    let free = (0..dimension).filter(|column| !pivots.contains(column));
    let vector = |free: usize| {
        let mut vector = vec![0.0; dimension];
        vector[free] = 1.0;
        for (row, &column) in pivots.iter().enumerate() {
            vector[column] = -rows[row][free];
        }
        vector
    };
    free.map(vector).collect()
}
