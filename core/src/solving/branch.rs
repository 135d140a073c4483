//! The ball of increments in which the Jacobian is near that of the free body.

use alloc::vec;
use alloc::vec::Vec;

use super::problem::{newton_system, step_terms};
use crate::groups::{Advected as _, LieGroup as _, Retraction};
use crate::mechanics::{Effect, Group, Scalar, Square, Vector};
use crate::numbers::{Coordinates as _, Mask, nowhere, real};
use nalgebra::{SimdBool as _, SimdComplexField as _, SimdPartialOrd as _, SimdValue as _};

/// Radii of the sampled balls in radians, in ascending order.
const RADII: [f64; 3] = [0.25, 0.5, 1.0];
/// Limit of `‖I − B⁻¹A‖_F` at a sample. One would be enough for the sign of the determinant; the margin is for the
/// points between the samples.
const DEPARTURE: f64 = 0.5;

/// The largest of some radii up to which the model `B` is near the Jacobian `A` in every direction of `ξ` and at every
/// attitude of the body; zero if it isn't up to the smallest.
///
/// The samples are the advected parameters after quarter turns about the axes of the basis, and `ξ` along these axes
/// and the diagonals between them. That proves nothing between the samples; but `A` and `B` are smooth on the scale of
/// a radian, apart from potentials with narrower features, and the check of the branch doesn't rest on this alone.
pub(crate) fn trusted_radius<L: Effect>(lagrangian: &L, constants: &L::Constants) -> Scalar<L> {
    let standing: Vec<(Square<L>, L::StepTerms)> = elements::<L>()
        .map(|g| {
            let w = lagrangian.advected().seen_from(&g);
            (lagrangian.inertia(&w), step_terms::<L>(constants, &Vector::<L>::zero(), &w))
        })
        .collect();
    let directions = directions::<L>();
    let mut trusted = real::<Scalar<L>>(0.0);
    let mut is_near = !nowhere::<Scalar<L>>();
    for radius in RADII {
        for direction in &directions {
            let xi = *direction * real::<Scalar<L>>(radius);
            for (inertia, terms) in &standing {
                let model = L::Retraction::free_momentum_tangent(inertia, &xi);
                let (_, jacobian) = newton_system::<L>(constants, terms, &(xi * real(0.5)));
                is_near = is_near & is_nearly::<L>(&model, &jacobian);
            }
        }
        trusted = real::<Scalar<L>>(radius).select(is_near, trusted);
        if !is_near.any() {
            break;
        }
    }
    trusted
}

/// Whether the model is near the Jacobian, by `‖I − B⁻¹A‖_F`.
fn is_nearly<L: Effect>(model: &Square<L>, jacobian: &Square<L>) -> Mask<Scalar<L>> {
    let departure = axes::<L>().map(|axis| {
        let column = axis - Vector::<L>::solve(model, &(*jacobian * axis)).0;
        column.dot(&column)
    });
    departure.fold(real::<Scalar<L>>(0.0), |sum, one| sum + one).simd_le(real(DEPARTURE * DEPARTURE))
}

fn axes<L: Effect>() -> impl Iterator<Item = Vector<L>> {
    (0..Group::<L>::DIMENSION).map(Vector::<L>::axis)
}

/// Sampled directions of length one: the axes and the diagonals, both ways.
fn directions<L: Effect>() -> Vec<Vector<L>> {
    let mut sums = vec![Vector::<L>::zero()];
    for axis in axes::<L>() {
        sums = sums.iter().flat_map(|&sum| [sum + axis, sum - axis]).collect();
    }
    let diagonals = sums.into_iter().map(|sum| sum * (real::<Scalar<L>>(1.0) / sum.dot(&sum).simd_sqrt()));
    axes::<L>().flat_map(|axis| [axis, -axis]).chain(diagonals).collect()
}

/// Sampled attitudes: the identity, and quarter, half and three-quarter turns about each axis.
fn elements<L: Effect>() -> impl Iterator<Item = Group<L>> {
    let turned = axes::<L>().flat_map(|axis| {
        let quarter = L::Retraction::retract(&(axis * real::<Scalar<L>>(2.0)));
        let half = quarter.compose(&quarter);
        [quarter, half, half.compose(&quarter)]
    });
    core::iter::once(Group::<L>::identity()).chain(turned)
}
