//! Terms around another term: what they hand on to it.

/// Writes functions of a term that wraps another, as `delegate_term!(within: l_d diamond)`. `within!(self, term => value)` is
/// a macro of the caller's: the value of an expression in the inner term.
#[doc(hidden)]
#[macro_export]
macro_rules! delegate_term {
    ($within:ident: $($name:ident)+) => {
        $($crate::delegate_term!(@$within $name);)+
    };
    (@$within:ident validate) => {
        fn validate(&self) -> Result<(), $crate::SetupError> {
            $within!(self, term => term.validate())
        }
    };
    (@$within:ident advected) => {
        fn advected(&self) -> Self::Advected {
            $within!(self, term => term.advected())
        }
    };
    (@$within:ident describe) => {
        fn describe(&self, visitor: &mut dyn $crate::mechanics::SceneVisitor<Self::Scalar>) {
            $within!(self, term => term.describe(visitor))
        }
    };
    (@$within:ident momentum_jacobian) => {
        $crate::delegate_term!(@$within momentum_jacobian(f, w, h) -> $crate::mechanics::Square<Self>);
    };
    (@$within:ident limit) => {
        fn limit(
            &self,
            velocity: Option<&$crate::mechanics::Vector<Self>>,
            w: &Self::Advected,
        ) -> $crate::mechanics::Limit<Self> {
            let (l, momentum, hessian) = $within!(self, term => {
                let $crate::mechanics::Limit { l, momentum, hessian } = term.limit(velocity, w);
                (l, momentum, hessian)
            });
            $crate::mechanics::Limit { l, momentum, hessian }
        }
    };
    (@$within:ident l_d) => { $crate::delegate_term!(@$within l_d(f, w, h) -> Self::Scalar); };
    (@$within:ident discrete_energy) => { $crate::delegate_term!(@$within discrete_energy(f, w, h) -> Self::Scalar); };
    (@$within:ident $covector:ident) => {
        $crate::delegate_term!(@$within $covector(f, w, h) -> $crate::mechanics::Vector<Self>);
    };
    (@$within:ident $name:ident($f:ident, $w:ident, $h:ident) -> $result:ty) => {
        fn $name(&self, $f: &$crate::mechanics::Matrix<Self>, $w: &Self::Advected, $h: Self::Scalar) -> $result {
            $within!(self, term => term.$name($f, $w, $h))
        }
    };
}
