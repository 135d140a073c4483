//! Products of groups, for several bodies.

use alloc::vec::Vec;

use super::{CayleyRetraction, ExponentialRetraction, LieGroup, Retraction, layout};
use crate::numbers::{Blocks, Coordinates, Join, Mask, nowhere};
use nalgebra::SimdBool as _;

/// The factor `K` of a product of groups, counted from zero.
///
/// # Examples
///
/// ```
/// use liestep::SO3;
/// use liestep::groups::{Factor, LieGroup};
/// use nalgebra::Vector6;
///
/// type Bodies = (SO3, SO3);
/// let momentum = Vector6::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);
/// assert_eq!(<Bodies as Factor<1>>::components(&momentum), nalgebra::Vector3::new(4.0, 5.0, 6.0));
/// assert_eq!(Bodies::DIMENSION, 6);
/// ```
pub trait Factor<const K: usize>: LieGroup {
    /// The group of the factor.
    type Of: LieGroup<Scalar = Self::Scalar>;

    /// The factor of an element.
    fn factor(&self) -> Self::Of;

    /// The factor's matrix.
    fn of_matrix(matrix: &Self::Matrix) -> <Self::Of as LieGroup>::Matrix;

    /// The factor's components of an element of the algebra, or of a covector.
    fn components(joined: &Self::Vector) -> <Self::Of as LieGroup>::Vector;
}

/// The components of two groups, one after the other.
type JointOf<A, B, T> = <A as Join<T, B>>::Joined;

/// The factors of a product, whose names end with their places.
fn at_places<const N: usize>(factors: [Vec<layout::Factor>; N]) -> Vec<layout::Factor> {
    let placed = |(place, factors): (usize, Vec<layout::Factor>)| factors.into_iter().map(move |one| one.at(place));
    (1..).zip(factors).flat_map(placed).collect()
}

/// Implements a product from the type of each factor, its place, and a name for its part; then an expression that joins
/// the parts' components, and one that splits them into these names.
macro_rules! product {
    (
        $($group:ident $place:tt $part:ident),+;
        $scalar:ident: $vector:ty where [$($bound:tt)*];
        join $join:expr;
        split $joined:ident $split:block;
        squares $squares:expr;
        dimension $dimension:expr;
        factors $factors:expr;
    ) => {
        impl<$($group: LieGroup<Scalar = $scalar>,)+ $scalar: crate::numbers::Real> LieGroup for ($($group,)+)
        where
            $($bound)*
        {
            type Scalar = $scalar;
            type Vector = $vector;
            type Matrix = ($($group::Matrix,)+);

            const DIMENSION: usize = $dimension;
            const ATTITUDES: usize = 0 $(+ $group::ATTITUDES)+;
            const FACTORS: Blocks = {
                assert!(Self::DIMENSION <= Blocks::MOST, "a product of groups has at most 64 dimensions");
                $factors
            };

            fn identity() -> Self {
                ($($group::identity(),)+)
            }

            fn compose(&self, right: &Self) -> Self {
                ($(self.$place.compose(&right.$place),)+)
            }

            fn inverse(&self) -> Self {
                ($(self.$place.inverse(),)+)
            }

            fn matrix(&self) -> Self::Matrix {
                ($(self.$place.matrix(),)+)
            }

            #[hot]
            fn from_matrix_unchecked(matrix: Self::Matrix) -> Self {
                ($($group::from_matrix_unchecked(matrix.$place),)+)
            }

            #[hot]
            fn hat($joined: &Self::Vector) -> Self::Matrix {
                let ($($part,)+) = $split;
                ($($group::hat(&$part),)+)
            }

            #[hot]
            fn vee(matrix: &Self::Matrix) -> Self::Vector {
                let ($($part,)+) = ($($group::vee(&matrix.$place),)+);
                $join
            }

            fn adjoint(&self, $joined: &Self::Vector) -> Self::Vector {
                let ($($part,)+) = $split;
                let ($($part,)+) = ($(self.$place.adjoint(&$part),)+);
                $join
            }

            #[hot]
            fn adjoint_transpose(&self, $joined: &Self::Vector) -> Self::Vector {
                let ($($part,)+) = $split;
                let ($($part,)+) = ($(self.$place.adjoint_transpose(&$part),)+);
                $join
            }

            fn lie_bracket($joined: &Self::Vector, eta: &Self::Vector) -> Self::Vector {
                let first = $split;
                let $joined = eta;
                let second = $split;
                let ($($part,)+) = ($($group::lie_bracket(&first.$place, &second.$place),)+);
                $join
            }

            fn lie_bracket_transpose($joined: &Self::Vector, momentum: &Self::Vector) -> Self::Vector {
                let first = $split;
                let $joined = momentum;
                let second = $split;
                let ($($part,)+) = ($($group::lie_bracket_transpose(&first.$place, &second.$place),)+);
                $join
            }

            #[hot]
            fn from_increment(increment: &Self::Matrix) -> Self {
                ($($group::from_increment(&increment.$place),)+)
            }

            #[hot]
            fn increment(&self) -> Self::Matrix {
                ($(self.$place.increment(),)+)
            }

            #[hot]
            fn inverse_increment(increment: &Self::Matrix) -> Self::Matrix {
                ($($group::inverse_increment(&increment.$place),)+)
            }

            #[hot]
            fn change(&self, increment: &Self::Matrix) -> Self::Matrix {
                ($(self.$place.change(&increment.$place),)+)
            }

            #[hot]
            fn advance(&self, increment: &Self::Matrix) -> Self {
                ($(self.$place.advance(&increment.$place),)+)
            }

            #[hot]
            fn adjoint_transpose_increment(increment: &Self::Matrix, $joined: &Self::Vector) -> Self::Vector {
                let ($($part,)+) = $split;
                let ($($part,)+) = ($($group::adjoint_transpose_increment(&increment.$place, &$part),)+);
                $join
            }

            fn factors() -> Vec<layout::Factor> {
                at_places([$($group::factors()),+])
            }

            fn write_numbers<'a>(&self, numbers: &'a mut [$scalar]) -> &'a mut [$scalar] {
                $(let numbers = self.$place.write_numbers(numbers);)+
                numbers
            }

            fn turning_components() -> Vec<bool> {
                [$($group::turning_components()),+].concat()
            }

            /// The sum of the factors' defects.
            fn defect(&self) -> $scalar {
                $scalar::zero() $(+ self.$place.defect())+
            }

            fn restored(&self, beyond: f64) -> Option<(Self, Mask<$scalar>)> {
                let (mut element, mut far) = (*self, nowhere::<$scalar>());
                $(if let Some((restored, lanes)) = self.$place.restored(beyond) {
                    element.$place = restored;
                    far = far | lanes;
                })+
                far.any().then_some((element, far))
            }
        }

        product!(@retraction CayleyRetraction [$($group $place $part),+] $scalar $joined $split $join, $squares, [$($bound)*]);
        product!(@retraction ExponentialRetraction [$($group $place $part),+] $scalar $joined $split $join, $squares, [$($bound)*]);
        product!(@factors [$($group $place $part),+] [$($group $place $part),+] $scalar $joined $split [$($bound)*]);
    };
    (
        @retraction $retraction:ident [$($group:ident $place:tt $part:ident),+]
        $scalar:ident $joined:ident $split:block $join:expr, $squares:expr, [$($bound:tt)*]
    ) => {
        /// Retraction factor by factor.
        #[hot]
        impl<$($group: LieGroup<Scalar = $scalar>,)+ $scalar: crate::numbers::Real> Retraction<($($group,)+)> for $retraction
        where
            $($retraction: Retraction<$group>,)+
            $($bound)*
        {
            fn increment($joined: &<($($group,)+) as LieGroup>::Vector) -> ($($group::Matrix,)+) {
                let ($($part,)+) = $split;
                ($(<$retraction as Retraction<$group>>::increment(&$part),)+)
            }

            fn increment_of_half($joined: &<($($group,)+) as LieGroup>::Vector) -> ($($group::Matrix,)+) {
                let ($($part,)+) = $split;
                ($(<$retraction as Retraction<$group>>::increment_of_half(&$part),)+)
            }

            fn local_coordinates(element: &($($group,)+)) -> Option<<($($group,)+) as LieGroup>::Vector> {
                let ($($part,)+) = ($(<$retraction as Retraction<$group>>::local_coordinates(&element.$place)?,)+);
                Some($join)
            }

            #[inline]
            fn tangent(
                $joined: &<($($group,)+) as LieGroup>::Vector,
            ) -> <<($($group,)+) as LieGroup>::Vector as Coordinates<$scalar>>::Square {
                let ($($part,)+) = $split;
                let ($($part,)+) = ($(<$retraction as Retraction<$group>>::tangent(&$part),)+);
                $squares
            }

            fn is_near($joined: &<($($group,)+) as LieGroup>::Vector, times: f64) -> Mask<$scalar> {
                let ($($part,)+) = $split;
                !nowhere::<$scalar>() $(& <$retraction as Retraction<$group>>::is_near(&$part, times))+
            }
        }
    };
    (@factors [$($own:ident $place:tt $part:ident),+] $all:tt $scalar:ident $joined:ident $split:block $bound:tt) => {
        $(product!(@factor $own $place $part $all $scalar $joined $split $bound);)+
    };
    (
        @factor $own:ident $own_place:tt $own_part:ident [$($group:ident $place:tt $part:ident),+]
        $scalar:ident $joined:ident $split:block [$($bound:tt)*]
    ) => {
        #[hot]
        impl<$($group: LieGroup<Scalar = $scalar>,)+ $scalar: crate::numbers::Real> Factor<$own_place> for ($($group,)+)
        where
            $($bound)*
        {
            type Of = $own;

            fn factor(&self) -> $own {
                self.$own_place
            }

            fn of_matrix(matrix: &Self::Matrix) -> $own::Matrix {
                matrix.$own_place
            }

            fn components($joined: &Self::Vector) -> $own::Vector {
                let ($($part,)+) = $split;
                let _ = ($(&$part,)+);
                $own_part
            }
        }
    };
}

product! {
    A 0 a, B 1 b;
    T: JointOf<A::Vector, B::Vector, T> where [A::Vector: Join<T, B::Vector>];
    join a.join(&b);
    split joined { A::Vector::split(joined) };
    squares <A::Vector as Join<T, B::Vector>>::join_squares(&a, &b);
    dimension A::DIMENSION + B::DIMENSION;
    factors A::FACTORS.then(A::DIMENSION, B::FACTORS);
}

product! {
    A 0 a, B 1 b, C 2 c;
    T: JointOf<JointOf<A::Vector, B::Vector, T>, C::Vector, T> where [
        A::Vector: Join<T, B::Vector>,
        JointOf<A::Vector, B::Vector, T>: Join<T, C::Vector>,
    ];
    join a.join(&b).join(&c);
    split joined {
        let (others, c) = JointOf::<A::Vector, B::Vector, T>::split(joined);
        let (a, b) = A::Vector::split(&others);
        (a, b, c)
    };
    squares {
        let others = <A::Vector as Join<T, B::Vector>>::join_squares(&a, &b);
        <JointOf<A::Vector, B::Vector, T> as Join<T, C::Vector>>::join_squares(&others, &c)
    };
    dimension A::DIMENSION + B::DIMENSION + C::DIMENSION;
    factors A::FACTORS.then(A::DIMENSION, B::FACTORS.then(B::DIMENSION, C::FACTORS));
}

product! {
    A 0 a, B 1 b, C 2 c, D 3 d;
    T: JointOf<JointOf<JointOf<A::Vector, B::Vector, T>, C::Vector, T>, D::Vector, T> where [
        A::Vector: Join<T, B::Vector>,
        JointOf<A::Vector, B::Vector, T>: Join<T, C::Vector>,
        JointOf<JointOf<A::Vector, B::Vector, T>, C::Vector, T>: Join<T, D::Vector>,
    ];
    join a.join(&b).join(&c).join(&d);
    split joined {
        let (three, d) = JointOf::<JointOf<A::Vector, B::Vector, T>, C::Vector, T>::split(joined);
        let (two, c) = JointOf::<A::Vector, B::Vector, T>::split(&three);
        let (a, b) = A::Vector::split(&two);
        (a, b, c, d)
    };
    squares {
        let two = <A::Vector as Join<T, B::Vector>>::join_squares(&a, &b);
        let three = <JointOf<A::Vector, B::Vector, T> as Join<T, C::Vector>>::join_squares(&two, &c);
        <JointOf<JointOf<A::Vector, B::Vector, T>, C::Vector, T> as Join<T, D::Vector>>::join_squares(&three, &d)
    };
    dimension A::DIMENSION + B::DIMENSION + C::DIMENSION + D::DIMENSION;
    factors A::FACTORS.then(A::DIMENSION, B::FACTORS.then(B::DIMENSION, C::FACTORS.then(C::DIMENSION, D::FACTORS)));
}
