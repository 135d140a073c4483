//! Declarations in lanes: several bodies of one text, each with numbers of its own, in one step.

use std::sync::Arc;

use liestep::SO3;
use liestep::groups::{
    Configuration, ContravariantTensor, ContravariantVector, CovariantTensor, Given, Heisenberg, LieGroup, MixedTensor,
    R1, R2, R3, Relative, SE2, SE3, SE23, SL2, SO2, SU2, SeenFrom,
};
use liestep::numbers::{InLanes, Lanes, Real};
use nalgebra::{Point, SMatrix, SimdValue};

use crate::code::Backend;
use crate::effect::Constants;
use crate::term::Late;

/// A group, or an advected parameter, over another scalar.
pub trait Wider<T> {
    /// The type over `T`.
    type Over;
}

macro_rules! wider {
    ($($group:ident)+) => {
        $(impl<S: Real, T: Real> Wider<T> for $group<S> {
            type Over = $group<T>;
        })+
    };
    ($([$($parameter:tt)*] $one:ty => $other:ty;)+) => {
        $(impl<S, T, $($parameter)*> Wider<T> for $one {
            type Over = $other;
        })+
    };
}

wider!(SO2 SO3 SE2 SE3 SE23 SU2 SL2 Heisenberg R1 R2 R3);
wider! {
    [const R: usize, const C: usize] SMatrix<S, R, C> => SMatrix<T, R, C>;
    [const N: usize] ContravariantVector<S, N> => ContravariantVector<T, N>;
    [const N: usize] ContravariantTensor<S, N> => ContravariantTensor<T, N>;
    [const N: usize] CovariantTensor<S, N> => CovariantTensor<T, N>;
    [const N: usize] MixedTensor<S, N> => MixedTensor<T, N>;
    [const R: usize, const C: usize] Given<S, R, C> => Given<T, R, C>;
    [const A: usize, const B: usize, const N: usize]
        Relative<A, B, SMatrix<S, N, N>> => Relative<A, B, SMatrix<T, N, N>>;
    [const B: usize, const N: usize] Configuration<B, SMatrix<S, N, N>> => Configuration<B, SMatrix<T, N, N>>;
}

impl<S: Real, T: Real, const N: usize> Wider<T> for Point<S, N> {
    type Over = Point<T, N>;
}

impl<const A: usize, T, W: Wider<T>> Wider<T> for SeenFrom<A, W> {
    type Over = SeenFrom<A, W::Over>;
}

macro_rules! tuples {
    ($(($($name:ident),*))+) => {
        $(impl<Scalar, $($name: Wider<Scalar>),*> Wider<Scalar> for ($($name,)*) {
            type Over = ($($name::Over,)*);
        })+
    };
}

tuples!(()(A, B)(A, B, C)(A, B, C, D)(A, B, C, D, E)(A, B, C, D, E, F));

/// Puts the numbers of `lane` into lane `k`.
fn replace<T: Real>(numbers: &mut [T], k: usize, lane: &[T::Element]) {
    numbers.iter_mut().zip(lane).for_each(|(number, &lane)| number.replace(k, lane));
}

/// Lanes share the text; a program that is specialised for one lane isn't for all.
impl<G, W, K, B> Lanes for Late<G, W, K, B>
where
    G: LieGroup + Wider<<G::Scalar as SimdValue>::Element>,
    W: Wider<<G::Scalar as SimdValue>::Element>,
    G::Over: LieGroup<Scalar = <G::Scalar as SimdValue>::Element>,
    <G::Scalar as SimdValue>::Element: Real,
    B: Backend<G::Scalar> + Backend<<G::Scalar as SimdValue>::Element, Code = <B as Backend<G::Scalar>>::Code>,
{
    type Lane = Late<G::Over, W::Over, K, B>;

    fn splat(lane: &Self::Lane) -> Self {
        let numbers = lane.numbers.iter().map(|&number| G::Scalar::splat(number)).collect();
        Self::made(lane.declaration, &lane.stages, numbers, lane.derivatives.clone())
    }

    fn lane(&self, k: usize) -> Self::Lane {
        let numbers = self.numbers.iter().map(|number| number.extract(k)).collect();
        Late::made(self.declaration, &self.stages, numbers, self.derivatives.clone())
    }

    fn set_lane(&mut self, k: usize, lane: &Self::Lane) -> bool {
        replace(Arc::make_mut(&mut self.numbers), k, &lane.numbers);
        std::ptr::eq(self.declaration, lane.declaration)
    }
}

impl<G, W, K, B, T> InLanes<T> for Late<G, W, K, B>
where
    G: LieGroup + Wider<T>,
    W: Wider<T>,
    T: Real,
    B: Backend<G::Scalar> + Backend<T>,
    G::Over: LieGroup<Scalar = T>,
    Late<G::Over, W::Over, K, B>: Lanes<Lane = Self>,
{
    type Together = Late<G::Over, W::Over, K, B>;
}

impl<T, B> Lanes for Constants<T, B>
where
    T: Real<Element: Real>,
    B: Backend<T> + Backend<T::Element, Code = <B as Backend<T>>::Code>,
{
    type Lane = Constants<T::Element, B>;

    fn splat(lane: &Self::Lane) -> Self {
        let numbers = lane.numbers.iter().map(|&number| T::splat(number)).collect();
        Self::of(lane.declaration, &lane.stages, lane.is_specialised, numbers)
    }

    fn lane(&self, k: usize) -> Self::Lane {
        let numbers = self.numbers.iter().map(|number| number.extract(k)).collect();
        Constants::of(self.declaration, &self.stages, self.is_specialised, numbers)
    }

    fn set_lane(&mut self, k: usize, lane: &Self::Lane) -> bool {
        replace(Arc::make_mut(&mut self.numbers), k, &lane.numbers);
        let known = self.known.iter_mut().flatten().zip(lane.known.iter().flatten());
        known.for_each(|(own, lane)| replace(Arc::make_mut(own), k, lane));
        // A specialised program belongs to one lane alone.
        std::ptr::eq(self.declaration, lane.declaration) && Arc::ptr_eq(&self.stages, &lane.stages)
    }
}
