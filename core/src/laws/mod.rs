//! Tests of the laws of groups, retractions and advected parameters, which macros generate for any type.
//!
//! The laws are tested at the identity, next to it and at random places, with a fixed seed, so that a failure repeats.

// Public for the macros' expansions.
#[doc(hidden)]
pub mod advected;
#[doc(hidden)]
pub mod group;
#[doc(hidden)]
pub mod retraction;
#[doc(hidden)]
pub mod samples;

#[doc(inline)]
pub use crate::{advected_laws, lie_group_laws, retraction_laws};

/// Generates the tests of the laws of [`LieGroup`](crate::groups::LieGroup) for a group over `f64`.
///
/// | test | laws |
/// |---|---|
/// | `group_axioms` | products and inverses are in the group, `(FG)H = F(GH)`, `F F⁻¹ = F⁻¹F = I` |
/// | `hat_and_vee` | `ξ̂^∨ = ξ`, linear |
/// | `brackets` | `ad_ξ η = (ξ̂η̂ − η̂ξ̂)^∨`, antisymmetry, Jacobi |
/// | `adjoint_action` | `Ad_F ξ = (F ξ̂ F⁻¹)^∨`, `Ad_{FG} = Ad_F Ad_G`, an automorphism of the bracket; its matrix |
/// | `pairings` | `⟨Ad*_F μ, ξ⟩ = ⟨μ, Ad_F ξ⟩`, `⟨ad*_ξ μ, η⟩ = ⟨μ, ad_ξ η⟩` |
/// | `brackets_are_derivatives` | `ad` and `ad*` are the derivatives of `Ad` and `Ad*` at the identity |
/// | `variations` | `δξ = η' + ad_ξ η` for `g exp(εη)` |
/// | `lie_poisson_brackets` | antisymmetry, Jacobi, `{f, h} = ⟨δf, ad*_{δh} μ⟩`, `Ad*_F` is a Poisson map |
/// | `increments` | `g + gD = gF`, `F⁻¹` and `Ad*_F μ − μ` from `D`, to all digits for a small `D` |
/// | `the_relation_tells` | a matrix off the group has a defect |
///
/// Invoke it in a test module of its own, one for each group.
///
/// # Examples
///
/// ```
/// #[cfg(test)]
/// mod rigid_motions {
///     liestep::lie_group_laws!(liestep::groups::SE3);
/// }
/// ```
#[doc(hidden)]
#[macro_export]
macro_rules! lie_group_laws {
    ($group:ty) => {
        $crate::__law_tests! {
            group::<$group>: group_axioms hat_and_vee brackets adjoint_action pairings brackets_are_derivatives variations
            lie_poisson_brackets increments the_relation_tells
        }
    };
}

/// Generates the tests of the laws of [`Retraction`](crate::groups::Retraction) for a group over `f64`.
///
/// | test | laws |
/// |---|---|
/// | `retraction_at_zero` | `τ(0) = e`, the tangent there is the identity, and zero is near it |
/// | `retraction_stays_in_the_group` | `τ(ξ)` satisfies the relation |
/// | `retraction_round_trips` | `local_coordinates` is the inverse |
/// | `retraction_tangent` | `dF F⁻¹ = (T dξ)^`, against differences |
/// | `retraction_keeps_digits` | `τ(ξ) − I = ξ̂` to first order, to all digits for a small `ξ` |
///
/// Invoke it in a test module of its own, one for each pair.
///
/// # Examples
///
/// ```
/// #[cfg(test)]
/// mod rigid_motions_by_cayley {
///     liestep::retraction_laws!(liestep::groups::SE3, liestep::groups::CayleyRetraction);
/// }
/// ```
#[doc(hidden)]
#[macro_export]
macro_rules! retraction_laws {
    ($group:ty, $retraction:ty) => {
        $crate::__law_tests! {
            retraction::<$group, $retraction>: retraction_at_zero retraction_stays_in_the_group retraction_round_trips
            retraction_tangent retraction_keeps_digits
        }
    };
}

/// Generates the tests of the laws of [`Advected`](crate::groups::Advected) for a group over `f64`.
///
/// For a group alone the tests cover the five kinds of parameters that its matrices act on:
///
/// | test | laws |
/// |---|---|
/// | `kinds_move_as_declared` | the product that each kind is defined by |
/// | `kinds_act` | the laws of an action, below |
///
/// For a group and a type of parameters, which must implement [`Entries`](crate::numbers::Entries), they are the laws
/// of an action on that type: `e · w = w`, `(gf)⁻¹ · w = f⁻¹ · (g⁻¹ · w)`, linear in `w`.
///
/// Invoke it in a test module of its own.
///
/// # Examples
///
/// ```
/// #[cfg(test)]
/// mod carried_by_rigid_motions {
///     liestep::advected_laws!(liestep::groups::SE3);
/// }
/// #[cfg(test)]
/// mod planes_carried_by_rigid_motions {
///     liestep::advected_laws!(liestep::groups::SE3, nalgebra::Vector4<f64>);
/// }
/// ```
#[doc(hidden)]
#[macro_export]
macro_rules! advected_laws {
    ($group:ty) => {
        $crate::__law_tests! { advected::<$group>: kinds_move_as_declared kinds_act }
    };
    ($group:ty, $kind:ty) => {
        $crate::__law_tests! { advected::<$group, $kind>: parameter_is_acted_on }
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __law_tests {
    ($module:ident::<$($type:ty),+>: $first:ident $($rest:ident)*) => {
        #[test]
        fn $first() {
            $crate::laws::$module::$first::<$($type),+, _, _>();
        }
        $crate::__law_tests! { $module::<$($type),+>: $($rest)* }
    };
    ($module:ident::<$($type:ty),+>:) => {};
}
