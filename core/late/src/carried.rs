//! The group actions on advected parameters, listed from the parameters' types.

use liestep::groups::{
    Configuration, ContravariantTensor, ContravariantVector, CovariantTensor, Given, MixedTensor, Relative, SeenFrom,
};
use liestep::numbers::Real;
use liestep_derivation::Action;
use nalgebra::{Point, SMatrix, SVector};

/// The actions in a type of advected parameters, each with the rows and columns of the stored array.
///
/// A declaration has one such type: `()` if nothing is advected or given, one of these for one parameter, and a tuple
/// for several, in the order of the declaration.
pub trait Slots {
    /// Adds the actions to the list.
    fn list(slots: &mut Vec<(Action, (usize, usize))>);
}

impl Slots for () {
    fn list(_: &mut Vec<(Action, (usize, usize))>) {}
}

macro_rules! carried {
    ($columns:tt: $($type:ident $action:ident),+) => {
        $(impl<T: Real, const N: usize> Slots for $type<T, N> {
            fn list(slots: &mut Vec<(Action, (usize, usize))>) {
                slots.push((Action::$action(0), (N, $columns)));
            }
        })+
    };
}

carried!(1: SVector Covector, ContravariantVector Contravariant, Point Point);
carried!(N: ContravariantTensor ContravariantTensor, CovariantTensor CovariantTensor, MixedTensor MixedTensor);

impl<T, const R: usize, const C: usize> Slots for Given<T, R, C> {
    fn list(slots: &mut Vec<(Action, (usize, usize))>) {
        slots.push((Action::Given, (R, C)));
    }
}

impl<const A: usize, W: Slots> Slots for SeenFrom<A, W> {
    fn list(slots: &mut Vec<(Action, (usize, usize))>) {
        let from = slots.len();
        W::list(slots);
        for (action, _) in slots.iter_mut().skip(from) {
            if let Action::Covector(factor)
            | Action::Contravariant(factor)
            | Action::Point(factor)
            | Action::ContravariantTensor(factor)
            | Action::CovariantTensor(factor)
            | Action::MixedTensor(factor) = action
            {
                *factor = A;
            }
        }
    }
}

impl<const A: usize, const B: usize, T, const N: usize> Slots for Relative<A, B, SMatrix<T, N, N>> {
    fn list(slots: &mut Vec<(Action, (usize, usize))>) {
        slots.push((Action::Relative { of: B, from: A }, (N, N)));
    }
}

impl<const B: usize, T, const N: usize> Slots for Configuration<B, SMatrix<T, N, N>> {
    fn list(slots: &mut Vec<(Action, (usize, usize))>) {
        slots.push((Action::Configuration(B), (N, N)));
    }
}

macro_rules! tuple {
    ($($name:ident),+) => {
        impl<$($name: Slots),+> Slots for ($($name,)+) {
            fn list(slots: &mut Vec<(Action, (usize, usize))>) {
                $($name::list(slots);)+
            }
        }
    };
}

tuple!(A, B);
tuple!(A, B, C);
tuple!(A, B, C, D);
tuple!(A, B, C, D, E);
tuple!(A, B, C, D, E, F);
