//! Splittings in lanes: shares are gathered as they were folded for each body alone.

use super::{Kick, KineticFlow, Spin, Split, Stage, Stages};
use crate::mechanics::{Effect, Scalar};
use crate::numbers::{InLanes, Lanes, Real, lanes_of_fields};
use nalgebra::SimdValue;

type Element<S> = <Scalar<S> as SimdValue>::Element;

lanes_of_fields!(
    impl[S, K] Split<S, K> => Split<S::Lane, K::Lane>, as Split
    where [
        S: Effect<Constants: Lanes<Lane = <S::Lane as Effect>::Constants>>
            + Lanes<Lane: Effect<Scalar = Element<S>>>,
        K: KineticFlow<Scalar<S>, Drift: Lanes<Lane = <K::Lane as KineticFlow<Element<S>>>::Drift>>
            + Lanes<Lane: KineticFlow<Element<S>>>
    ]
    { lanes: [torque, inverse_inertia, kinetic, first, step, last, spin], scalars: [h], shared: [scheme] }
);

impl<W, S, K> InLanes<W> for Split<S, K>
where
    S: Effect + InLanes<W, Together: Effect>,
    K: KineticFlow<Scalar<S>> + InLanes<W, Together: KineticFlow<Scalar<S::Together>>>,
    Split<S::Together, K::Together>: Lanes<Lane = Self>,
{
    type Together = Split<S::Together, K::Together>;
}

lanes_of_fields!(
    impl[T: Real] Spin<T> => Spin<T::Element>, as Spin { lanes: [], scalars: [angle], shared: [] }
);

lanes_of_fields!(
    impl[T: Real] Kick<T> => Kick<T::Element>, as Kick
    { lanes: [mobility], scalars: [time], shared: [] }
);

lanes_of_fields!(
    impl[D: Lanes, T: Real] Stage<D, T> => Stage<D::Lane, T::Element>, as Stage
    { lanes: [drift, kick], scalars: [], shared: [] }
);

lanes_of_fields!(
    impl[D: Lanes, T: Real] Stages<D, T> => Stages<D::Lane, T::Element>, as Stages
    { lanes: [lead, stages], scalars: [], shared: [] }
);

/// A flow of the free body that is a type of its scalar.
macro_rules! flow_in_lanes {
    ($($flow:ident),+) => {$(
        impl<W: Real> InLanes<W> for super::$flow<W::Element> {
            type Together = super::$flow<W>;
        }
    )+};
}

flow_in_lanes!(SymmetricBody, ExactBody);
