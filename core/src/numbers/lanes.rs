//! Values of SIMD lanes, gathered from one value for each lane and separated again.

use alloc::vec::Vec;
use core::marker::PhantomData;

use nalgebra::{Point, SMatrix};

use crate::numbers::entries::of_tuples;
use crate::numbers::scalar::Real;

/// A value made of scalars with several [lanes](crate::numbers::Real#lanes), each lane of which is a value of its own.
///
/// A declaration that is generic over its scalar derives it, together with [`InLanes`]; sums, steppers and
/// [states](crate::State) of such scenes implement it, too. A scalar with one lane is allowed.
///
/// The constants of a stepper are gathered and not computed anew, and a state includes the guess and the history of its
/// method: each lane continues with the bits that it would have alone.
///
/// # Examples
///
/// ```
/// use liestep::effects::Torque;
/// use liestep::numbers::Lanes;
/// use nalgebra::Vector3;
/// use simba::simd::AutoF64x4;
///
/// let torques = [1.0, 2.0, 3.0, 4.0].map(|size| Torque { torque: Vector3::z() * size });
/// let mut wide = Torque::<AutoF64x4>::gathered(&torques).expect("they share nothing");
/// assert_eq!(wide.lane(2), torques[2]);
/// assert!(wide.set_lane(2, &torques[0]));
/// assert_eq!(wide.torque.z, AutoF64x4::new(1.0, 2.0, 1.0, 4.0));
/// ```
pub trait Lanes: Sized {
    /// The type of one lane's value.
    type Lane;

    /// One value, repeated in all lanes.
    fn splat(lane: &Self::Lane) -> Self;

    /// The value in lane `k`.
    ///
    /// # Panics
    ///
    /// If there is no lane `k`.
    #[must_use]
    fn lane(&self, k: usize) -> Self::Lane;

    /// Writes a value into lane `k`, and returns whether it fits: data that lanes share, as the number of steps made or
    /// the scheme of a method, has to agree. If it doesn't, the result is useless.
    ///
    /// # Panics
    ///
    /// If there is no lane `k`.
    #[must_use]
    fn set_lane(&mut self, k: usize, lane: &Self::Lane) -> bool;

    /// One value in each lane, and the first in all lanes left over; `None` if the list is empty, or if shared data
    /// doesn't agree.
    ///
    /// # Panics
    ///
    /// If there are more values than lanes.
    #[must_use]
    fn gathered(lanes: &[Self::Lane]) -> Option<Self> {
        let mut together = Self::splat(lanes.first()?);
        let agree = lanes.iter().enumerate().skip(1).all(|(k, lane)| together.set_lane(k, lane));
        agree.then_some(together)
    }
}

/// A type with values that can be put into lanes of the scalar `W`.
///
/// Scenes that are generic over their scalar can: scenes of one body, of several that are declared together, and
/// [systems](crate::mechanics::Placement) of bodies with terms at their places. So can the methods
/// [`Stepper::new`](crate::Stepper::new), [`composed`](crate::Stepper::composed), [`split`](crate::Stepper::split) and
/// [`processed`](crate::Stepper::processed), and all of them [`compensated`](crate::Stepper::compensated).
///
/// Other methods step the bodies one after the other, each for a reason of its own:
///
/// - Collocation has the stages of one body side by side in the registers already, with its matrices as tables of
///   `f64`. With bodies side by side its sums would have another order, and a body other bits than alone.
/// - A remedy repeats single steps that fail a check in another way, for one body at a time. The other lanes would have
///   to wait for it.
/// - Bodies in joints are solved along a graph: the pivots, the joint in an error and the number of restarts of a step
///   belong to one system, and would have to be found for all lanes at once.
/// - [Links](crate::methods::LinkedBodies) are solved with branches that each chain takes by itself: shortened updates,
///   reused Jacobians.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be put into lanes of `{W}`",
    label = "can't be put into lanes",
    note = "a declaration generic over its scalar can be: `struct Top<T> {{ weight: T, … }}`, and `Top<f64>` here",
    note = "of methods the declared step can, compositions of it and splittings, with compensated sums too; others go one by one"
)]
pub trait InLanes<W>: Sized {
    /// The type of several values in lanes.
    type Together: Lanes<Lane = Self>;
}

impl<T: Real, const R: usize, const C: usize> Lanes for SMatrix<T, R, C> {
    type Lane = SMatrix<T::Element, R, C>;

    fn splat(lane: &Self::Lane) -> Self {
        lane.map(T::splat)
    }

    fn lane(&self, k: usize) -> Self::Lane {
        self.map(|entry| entry.extract(k))
    }

    fn set_lane(&mut self, k: usize, lane: &Self::Lane) -> bool {
        self.zip_apply(lane, |entry, lane| entry.replace(k, lane));
        true
    }
}

impl<T: Real, const D: usize> Lanes for Point<T, D> {
    type Lane = Point<T::Element, D>;

    fn splat(lane: &Self::Lane) -> Self {
        Self { coords: Lanes::splat(&lane.coords) }
    }

    fn lane(&self, k: usize) -> Self::Lane {
        Point { coords: Lanes::lane(&self.coords, k) }
    }

    fn set_lane(&mut self, k: usize, lane: &Self::Lane) -> bool {
        Lanes::set_lane(&mut self.coords, k, &lane.coords)
    }
}

/// An array of scalars in lanes. The entries of a plain array implement [`Lanes`], and scalars don't.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Numbers<T, const N: usize>(pub [T; N]);

impl<T: Real, const N: usize> Lanes for Numbers<T, N> {
    type Lane = Numbers<T::Element, N>;

    fn splat(lane: &Self::Lane) -> Self {
        Self(lane.0.map(T::splat))
    }

    fn lane(&self, k: usize) -> Self::Lane {
        Numbers(self.0.map(|entry| entry.extract(k)))
    }

    fn set_lane(&mut self, k: usize, lane: &Self::Lane) -> bool {
        self.0.iter_mut().zip(lane.0).for_each(|(entry, lane)| entry.replace(k, lane));
        true
    }
}

/// An array in lanes, entry by entry.
impl<V: Lanes, const N: usize> Lanes for [V; N] {
    type Lane = [V::Lane; N];

    fn splat(lane: &Self::Lane) -> Self {
        lane.each_ref().map(V::splat)
    }

    fn lane(&self, k: usize) -> Self::Lane {
        self.each_ref().map(|value| value.lane(k))
    }

    fn set_lane(&mut self, k: usize, lane: &Self::Lane) -> bool {
        self.iter_mut().zip(lane).all(|(value, lane)| value.set_lane(k, lane))
    }
}

/// A list in lanes, of the same length in all of them.
impl<V: Lanes> Lanes for Vec<V> {
    type Lane = Vec<V::Lane>;

    fn splat(lane: &Self::Lane) -> Self {
        lane.iter().map(V::splat).collect()
    }

    fn lane(&self, k: usize) -> Self::Lane {
        self.iter().map(|entry| entry.lane(k)).collect()
    }

    fn set_lane(&mut self, k: usize, lane: &Self::Lane) -> bool {
        self.len() == lane.len() && self.iter_mut().zip(lane).all(|(entry, lane)| entry.set_lane(k, lane))
    }
}

/// An optional value, in all lanes or in none.
impl<V: Lanes> Lanes for Option<V> {
    type Lane = Option<V::Lane>;

    fn splat(lane: &Self::Lane) -> Self {
        lane.as_ref().map(V::splat)
    }

    fn lane(&self, k: usize) -> Self::Lane {
        self.as_ref().map(|value| value.lane(k))
    }

    fn set_lane(&mut self, k: usize, lane: &Self::Lane) -> bool {
        match (self, lane) {
            (Some(own), Some(lane)) => own.set_lane(k, lane),
            (None, None) => true,
            _ => false,
        }
    }
}

/// A marker of a type, for the lane's type.
impl<V: Lanes> Lanes for PhantomData<V> {
    type Lane = PhantomData<V::Lane>;

    fn splat(_: &Self::Lane) -> Self {
        Self
    }

    fn lane(&self, _: usize) -> Self::Lane {
        PhantomData
    }

    fn set_lane(&mut self, _: usize, _: &Self::Lane) -> bool {
        true
    }
}

macro_rules! tuple {
    ($($name:ident $index:tt),*) => {
        #[allow(clippy::unused_unit, unused_variables)] // in the impl of the empty tuple
        impl<$($name: Lanes),*> Lanes for ($($name,)*) {
            type Lane = ($($name::Lane,)*);

            fn splat(lane: &Self::Lane) -> Self {
                ($($name::splat(&lane.$index),)*)
            }

            fn lane(&self, k: usize) -> Self::Lane {
                ($(self.$index.lane(k),)*)
            }

            fn set_lane(&mut self, k: usize, lane: &Self::Lane) -> bool {
                true $(&& self.$index.set_lane(k, &lane.$index))*
            }
        }
    };
}

of_tuples!(tuple);
