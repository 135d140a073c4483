//! The derived equations in print.

use expect_test::expect;

use super::{HEAVY_TOP, expanded, top};

/// The text of `const DERIVATION` in an expansion.
fn derivation(arguments: &str, item: &str) -> String {
    let file: syn::File = syn::parse2(expanded(arguments, item)).expect("items");
    let constants = file.items.iter().filter_map(|item| match item {
        syn::Item::Impl(implementation) => Some(&implementation.items),
        _ => None,
    });
    let mut texts = constants.flatten().filter_map(|item| match item {
        syn::ImplItem::Const(constant) => match &constant.expr {
            syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) => Some(text.value()),
            _ => None,
        },
        _ => None,
    });
    texts.next().expect("a derivation")
}

/// (3.17) is `μ`, (3.18) is `(L_F)* δl_d/δF`, and the diamond is that of section 3.2.1, item 3.
#[test]
#[allow(clippy::needless_raw_string_hashes)] // as expect-test writes them
fn of_the_heavy_top() {
    expect![[r#"
        l_d
            l_d = −(1/h) tr(F J_d) + (1/h) tr(J_d) − (h m g/2) ⟨rho, Fᵀ w⟩ − (h m g/2) ⟨rho, w⟩    [as declared, with FᵀF = I used]
        right_momentum
            (R_F)* δl_d/δF = (1/h) (F J_d − J_d Fᵀ)^∨ + (h m g/2) (F rho wᵀ − w rhoᵀ Fᵀ)^∨    [section 3.2.1, item 2]
        left_momentum
            (L_F)* δl_d/δF = (1/h) (J_d F − Fᵀ J_d)^∨ + (h m g/2) (rho wᵀ F − Fᵀ w rhoᵀ)^∨    [section 3.2.1, item 1; (2.6)]
        diamond
            δl_d/δw ⋄ w = (h m g/2) (F rho wᵀ − w rhoᵀ Fᵀ)^∨ + (h m g/2) (rho wᵀ − w rhoᵀ)^∨    [(2.1)]
        legendre_minus
            μ = (1/h) (F J_d − J_d Fᵀ)^∨ + (h m g/2) (w rhoᵀ − rho wᵀ)^∨    [(2.7)]
        momentum_jacobian
            ∂μ_k along exp(tE_j)F = −(1/h) tr(F J_d E_k E_j)    [exact, right-trivialised]
        discrete_energy
            −∂l_d/∂h = −(1/h²) tr(F J_d) + (1/h²) tr(J_d) + (m g/2) ⟨rho, Fᵀ w⟩ + (m g/2) ⟨rho, w⟩
        inertia
            η·Jξ for η̂ = E_k, ξ̂ = E_j = −tr(J_d E_k E_j)    [continuous limit]
        momentum_bias
            s = 0    [continuous limit]
        potential
            V = m g ⟨rho, w⟩    [continuous limit]
        kick_before
            k₀ = (h m g/2) (rho wᵀ − w rhoᵀ)^∨    [a = μ + k₀]
        kick_after
            k₁⁺ = (h m g/2) (rho w⁺ᵀ − w⁺ rhoᵀ)^∨    [μ⁺ = Ad*_F a + k₁⁺]
        newton_system
            candidates, cheapest first = Cayley, denominators cleared, multiplied out: 111 operations; Cayley, denominators cleared: 112 operations; F rebuilt from ξ: 151 operations, 3 sign flips; F rebuilt from ξ, multiplied out: 275 operations, 3 sign flips    [an iteration]
        self-adjoint
            l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)    [by the normal forms: even order; a step of −h undoes a step of h]
    "#]].assert_eq(&derivation(HEAVY_TOP, &top("NonstandardInertia")));
}
