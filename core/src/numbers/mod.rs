//! Numbers: the scalars of a motion, several of them in SIMD lanes, vectors and lists of them.
//!
//! This room has no groups and no mechanics.

/// An inlined operator of two equal types: its type, trait, function and result.
macro_rules! operation {
    ([$($parameter:tt)*] $(#[$attribute:meta])? $kind:ty, $operation:ident $function:ident |$a:ident, $b:ident| $made:expr) => {
        impl<$($parameter)*> $operation for $kind {
            type Output = Self;
            #[hot]
            $(#[$attribute])?
            fn $function(self, $b: Self) -> Self {
                let $a = self;
                $made
            }
        }
    };
}

mod blocks;
mod bodies;
mod columns;
mod coordinates;
mod digest;
mod dual;
pub(crate) mod elimination;
mod entries;
mod exact;
mod history;
mod identity;
mod join;
mod lanes;
pub(crate) mod newton;
mod registers;
mod scalar;
mod simd;

pub use blocks::{Blocks, Pattern};
pub use bodies::{BlockDiagonal, Bodies};
pub(crate) use bodies::{filled, least, most};
pub use columns::FourVectors;
pub use coordinates::Coordinates;
#[doc(hidden)]
pub use digest::Digest;
pub(crate) use dual::{Dual, Number};
pub use entries::Entries;
pub(crate) use entries::{entries_of_value, flag, of_tuples, replaced, sum, zero};
#[doc(hidden)]
pub use exact::two_sum;
pub(crate) use exact::{carried_sum, two_square};
pub(crate) use history::{History, Parabola, Polynomial};
#[doc(hidden)]
pub use identity::Identity;
pub use join::Join;
pub use lanes::{InLanes, Lanes, Numbers};
pub(crate) use newton::{NewtonEnd, newton_halving};
pub(crate) use registers::{Columns, OnRegisters, Plain, Register, cross, dot, on_registers, padded, square, vector};
pub use scalar::real;
pub use scalar::{Mask, Real};
pub(crate) use scalar::{count, counted, is_finite, largest_lane, nowhere, reported};

pub use simd::Vectors;
pub(crate) use simd::{Kernel, dispatch};
