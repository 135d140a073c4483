//! Delegation of a wrapping plan's functions to the inner plan.

/// Generates functions of a plan that wraps another, as in `delegate_plan!(plan, |kept| *kept; keep cost)`: the field
/// of the inner plan, the inner memory as a place in the wrapper's, and the names of the functions.
#[doc(hidden)]
#[macro_export]
macro_rules! delegate_plan {
    ($plan:tt, |$kept:ident| $inner:expr; $($name:ident)+) => {
        $($crate::delegate_plan!(@$name $plan, $kept, $inner);)+
    };
    (@facts $($of:tt)*) => {
        const FACTS: $crate::motion::PlanFacts =
            $crate::motion::PlanFacts { runs: $crate::motion::Runs::Merged, counts_time: false, ..P::FACTS };
    };
    (@step_size $plan:tt, $($kept:tt)*) => {
        fn step_size(&self) -> $crate::mechanics::Scalar<S> {
            self.$plan.step_size()
        }
    };
    (@keep $plan:tt, $($kept:tt)*) => {
        fn keep(&self, scene: &S, motion: &$crate::delegate_plan!(@motion)) -> Self::Kept {
            self.$plan.keep(scene, motion)
        }
    };
    (@momentum $plan:tt, $($kept:tt)*) => {
        fn momentum(
            &self,
            scene: &S,
            attitude: &$crate::mechanics::Group<S>,
            velocity: &$crate::mechanics::Vector<S>,
            w: &S::Advected,
        ) -> $crate::mechanics::Vector<S> {
            self.$plan.momentum(scene, attitude, velocity, w)
        }
    };
    (@velocity $plan:tt, $($kept:tt)*) => {
        fn velocity(&self, scene: &S, motion: &$crate::delegate_plan!(@motion)) -> $crate::mechanics::Vector<S> {
            self.$plan.velocity(scene, motion)
        }
    };
    (@push $plan:tt, $kept:ident, $inner:expr) => {
        fn push<M: $crate::motion::Summation<$crate::mechanics::Group<S>, S::Advected>>(
            &self,
            scene: &S,
            motion: &mut M,
            $kept: &mut Self::Kept,
            impulse: &$crate::mechanics::Vector<S>,
        ) {
            self.$plan.push(scene, motion, &mut $inner, impulse);
        }
    };
    (@see $plan:tt, $kept:ident, $inner:expr) => {
        fn see(&self, motion: &mut $crate::delegate_plan!(@motion), $kept: &mut Self::Kept, advected: S::Advected) {
            self.$plan.see(motion, &mut $inner, advected);
        }
    };
    (@step_of $plan:tt, $kept:ident, $inner:expr) => {
        fn step_of<M: $crate::motion::Summation<$crate::mechanics::Group<S>, S::Advected>>(
            &self,
            scene: &S,
            motion: &mut M,
            $kept: &mut Self::Kept,
            length: $crate::mechanics::Scalar<S>,
        ) -> Result<$crate::motion::StepReport, $crate::StepError> {
            self.$plan.step_of(scene, motion, &mut $inner, length)
        }
    };
    (@max_step $plan:tt, $kept:ident, $inner:expr) => {
        fn max_step(
            &self,
            scene: &S,
            motion: &$crate::delegate_plan!(@motion),
            $kept: &Self::Kept,
        ) -> $crate::mechanics::Scalar<S> {
            self.$plan.max_step(scene, motion, &$inner)
        }
    };
    (@cost $plan:tt, $($kept:tt)*) => {
        fn cost(&self) -> $crate::motion::Cost {
            self.$plan.cost()
        }
    };
    (@motion) => { $crate::motion::Motion<$crate::mechanics::Group<S>, S::Advected> };
}
