//! Advected parameters: what the group carries along, seen from the body.
//!
//! The spatial value `a_0` is constant; the body sees `w_i = g_i⁻¹ · a_0`. A parameter in `V*` moves by the
//! contragredient action, in columns `w_{i+1} = ρ(f)ᵀ w_i`; on SO(3) that is the rotation `Fᵀ w`.

use core::fmt::Debug;

use nalgebra::Vector3;

use crate::coordinates::Coordinates;
use crate::groups::{LieGroup, SO3};
use crate::scalar::Real;

/// The advected parameters of a Lagrangian: `()` for none, a vector for one, a tuple for several.
pub trait Advected<G: LieGroup>: Copy + Debug + PartialEq {
    /// `g⁻¹ · a_0`: the spatial value as the body with attitude `g` sees it.
    #[must_use]
    fn seen_from(&self, attitude: &G) -> Self;

    /// `f⁻¹ · w` for `f = I + D`, \[RDAE, (2.4)\].
    #[must_use]
    fn advect(&self, increment: &G::Matrix) -> Self;

    /// Whether all components are finite.
    fn is_finite(&self) -> bool;
}

impl<G: LieGroup> Advected<G> for () {
    fn seen_from(&self, _: &G) -> Self {}

    fn advect(&self, _: &G::Matrix) -> Self {}

    fn is_finite(&self) -> bool {
        true
    }
}

impl<T: Real> Advected<SO3<T>> for Vector3<T> {
    #[inline]
    fn seen_from(&self, attitude: &SO3<T>) -> Self {
        attitude.adjoint_transpose(self)
    }

    #[inline(always)]
    fn advect(&self, increment: &nalgebra::Matrix3<T>) -> Self {
        self + SO3::adjoint_transpose_increment(increment, self)
    }

    #[inline(always)]
    fn is_finite(&self) -> bool {
        Coordinates::is_finite(self)
    }
}

macro_rules! tuple {
    ($($name:ident $index:tt),+) => {
        impl<G: LieGroup, $($name: Advected<G>),+> Advected<G> for ($($name,)+) {
            #[inline(always)]
            fn seen_from(&self, attitude: &G) -> Self {
                ($(self.$index.seen_from(attitude),)+)
            }

            #[inline(always)]
            fn advect(&self, increment: &G::Matrix) -> Self {
                ($(self.$index.advect(increment),)+)
            }

            #[inline(always)]
            fn is_finite(&self) -> bool {
                $(self.$index.is_finite())&&+
            }
        }
    };
}

tuple!(A 0, B 1);
tuple!(A 0, B 1, C 2);
tuple!(A 0, B 1, C 2, D 3);
tuple!(A 0, B 1, C 2, D 3, E 4);
tuple!(A 0, B 1, C 2, D 3, E 4, F 5);
