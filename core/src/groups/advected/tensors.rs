//! Advected parameters other than covectors: vectors and tensors.
//!
//! Each product is written by `F = I + D` and `F⁻¹ = I + E`, `E = −F⁻¹D`, as the old value plus a small change, so that
//! a small step loses no digit.

use nalgebra::{SMatrix, SVector};

use super::Advected;
use crate::groups::LieGroup;
use crate::numbers::{Real, entries_of_value};

/// A vector, an element of `V`, on which `ρ(f)⁻¹` acts: a vector fixed in space, in the body frame.
///
/// An example on SE(3) with `N = 4` is a direction `(d, 0)`. A point is better declared as nalgebra's `Point3`.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct ContravariantVector<T, const N: usize>(pub SVector<T, N>);

/// A contravariant tensor, an element of `V ⊗ V`, with the action `ρ(f)⁻¹ S ρ(f)⁻ᵀ`.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct ContravariantTensor<T, const N: usize>(pub SMatrix<T, N, N>);

/// A bilinear form, an element of `V* ⊗ V*`, with the action `ρ(f)ᵀ S ρ(f)`.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct CovariantTensor<T, const N: usize>(pub SMatrix<T, N, N>);

/// A linear map, an element of `V ⊗ V*`, with the action `ρ(f)⁻¹ S ρ(f)`.
#[derive(Clone, Copy, Debug, PartialEq, Lanes)]
pub struct MixedTensor<T, const N: usize>(pub SMatrix<T, N, N>);

macro_rules! kind {
    ($type:ident, $pulled:expr, $change:expr, $rate:expr, $through:expr) => {
        entries_of_value!([const N: usize] $type<S, N>);

        impl<G, T: Real, const N: usize> Advected<G> for $type<T, N>
        where
            G: LieGroup<Scalar = T, Matrix = SMatrix<T, N, N>>,
        {
            fn seen_from(&self, attitude: &G) -> Self {
                Advected::<G>::seen_through(self, &attitude.matrix(), &attitude.inverse().matrix())
            }

            fn pulled_back(&self, attitude: &G) -> Self {
                Self($pulled(&self.0, attitude))
            }

            fn change(&self, increment: &SMatrix<T, N, N>) -> Self {
                Self($change(&self.0, increment))
            }

            fn rate(&self, velocity: &SMatrix<T, N, N>) -> Self {
                Self($rate(&self.0, velocity))
            }

            fn seen_through(&self, matrix: &SMatrix<T, N, N>, inverse: &SMatrix<T, N, N>) -> Self {
                Self($through(&self.0, matrix, inverse))
            }
        }
    };
}

kind!(
    ContravariantVector,
    |by: &SVector<T, N>, g: &G| g.inverse().matrix().transpose() * by,
    |v: &SVector<T, N>, d| G::inverse_increment(d) * v,
    |v: &SVector<T, N>, x: &SMatrix<T, N, N>| -(x * v),
    |v: &SVector<T, N>, _: &SMatrix<T, N, N>, inverse: &SMatrix<T, N, N>| inverse * v
);

kind!(
    ContravariantTensor,
    |by: &SMatrix<T, N, N>, g: &G| {
        let inverse = g.inverse().matrix();
        inverse.transpose() * by * inverse
    },
    |s: &SMatrix<T, N, N>, d| {
        let inverse = G::inverse_increment(d);
        let change = inverse * s;
        change + (s + change) * inverse.transpose()
    },
    |s: &SMatrix<T, N, N>, x: &SMatrix<T, N, N>| -(x * s + s * x.transpose()),
    |s: &SMatrix<T, N, N>, _: &SMatrix<T, N, N>, inverse: &SMatrix<T, N, N>| inverse * s * inverse.transpose()
);

kind!(
    CovariantTensor,
    |by: &SMatrix<T, N, N>, g: &G| g.matrix() * by * g.matrix().transpose(),
    |s: &SMatrix<T, N, N>, d: &SMatrix<T, N, N>| {
        let change = d.transpose() * s;
        change + (s + change) * d
    },
    |s: &SMatrix<T, N, N>, x: &SMatrix<T, N, N>| x.transpose() * s + s * x,
    |s: &SMatrix<T, N, N>, g: &SMatrix<T, N, N>, _: &SMatrix<T, N, N>| g.transpose() * s * g
);

kind!(
    MixedTensor,
    |by: &SMatrix<T, N, N>, g: &G| g.inverse().matrix().transpose() * by * g.matrix().transpose(),
    |s: &SMatrix<T, N, N>, d: &SMatrix<T, N, N>| {
        let change = G::inverse_increment(d) * s;
        change + (s + change) * d
    },
    |s: &SMatrix<T, N, N>, x: &SMatrix<T, N, N>| s * x - x * s,
    |s: &SMatrix<T, N, N>, g: &SMatrix<T, N, N>, inverse: &SMatrix<T, N, N>| inverse * s * g
);
