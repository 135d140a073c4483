//! The derived equations in print.

use expect_test::expect;

use super::{HEAVY_TOP, expanded, tokens, top};
use crate::declared::Role;

/// The text of `const DERIVATION` in an expansion.
pub(super) fn derivation(arguments: &str, item: &str) -> String {
    constant("DERIVATION", arguments, item)
}

/// The text of `const CONTINUOUS_DERIVATION`.
pub(super) fn continuous_derivation(arguments: &str, item: &str) -> String {
    constant("CONTINUOUS_DERIVATION", arguments, item)
}

fn constant(name: &str, arguments: &str, item: &str) -> String {
    let file: syn::File = syn::parse2(expanded(arguments, item)).expect("items");
    let constants = file.items.iter().filter_map(|item| match item {
        syn::Item::Impl(implementation) => Some(&implementation.items),
        _ => None,
    });
    let mut texts = constants.flatten().filter_map(|item| match item {
        syn::ImplItem::Const(constant) if constant.ident == name => match &constant.expr {
            syn::Expr::Block(block) => block.block.stmts.iter().find_map(|statement| match statement {
                syn::Stmt::Item(syn::Item::Const(constant)) => text_of(&constant.expr),
                _ => None,
            }),
            _ => None,
        },
        _ => None,
    });
    texts.next().expect("a derivation")
}

fn text_of(value: &syn::Expr) -> Option<String> {
    match value {
        syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) => Some(text.value()),
        _ => None,
    }
}

/// What the struct's own documentation says, in the lines of `///`.
pub(super) fn page(arguments: &str, item: &str) -> String {
    let file: syn::File = syn::parse2(expanded(arguments, item)).expect("items");
    let Some(syn::Item::Struct(item)) = file.items.first() else { panic!("no struct") };
    let values = item.attrs.iter().filter_map(|attribute| match &attribute.meta {
        syn::Meta::NameValue(doc) if doc.path.is_ident("doc") => text_of(&doc.value),
        _ => None,
    });
    let lines = values.collect::<Vec<_>>().join("\n");
    lines.lines().map(|line| line.strip_prefix(' ').unwrap_or(line)).collect::<Vec<_>>().join("\n")
}

/// A vector has as many components by name as it has rows, up to four.
#[test]
fn components_are_entries() {
    for (group, rows) in [("SE3", 4), ("SE2", 3), ("SL2", 2)] {
        let item = format!("struct Body {{ A: Matrix{rows}<f64>, v: Vector{rows}<f64> }}");
        let with = |last: &str, first: &str| {
            let kinetic = "((F - I) * A * A.transpose() * (F - I).transpose()).trace() / h";
            derivation(&format!("group = {group}, l_d = {kinetic} - h * v{last} * (F * v){first}"), &item)
        };
        let last = ["", ".x", ".y", ".z", ".w"][rows];
        assert_eq!(with(last, ".x"), with(&format!("[{}]", rows - 1), "[0]"));
        assert_ne!(with(last, ".x"), with("[0]", "[0]"));
    }
}

/// Where an editor shows it; the user's own attributes come first, and the item stays as it is.
#[test]
#[allow(clippy::needless_raw_string_hashes)] // as expect-test writes them
fn on_the_struct() {
    let item = format!("/// A top.\n#[derive(Clone)] #[repr(C)] pub {}", top("NonstandardInertia"));
    expect![[r#"
        A top.


        # Derived integrator

        The momentum equation, solved for `F` in each step:

        ```text
        μ = (1/h) (F J_d − J_d Fᵀ)^∨ + (h m g/2) (w rhoᵀ − rho wᵀ)^∨    [(2.7)]
        k₀ = (h m g/2) (rho wᵀ − w rhoᵀ)^∨    [a = μ + k₀]
        k₁⁺ = (h m g/2) (rho w⁺ᵀ − w⁺ rhoᵀ)^∨    [μ⁺ = Ad*_F a + k₁⁺]
        ```

        * Order: even, as `l_d` is self-adjoint: a step of −h undoes a step of h.
        * Limit of a step: the part of `μ` with `F` is a polynomial in `F`, so it is bounded. Where the body turns too fast for the step, there is no solution, and the error names the largest step that has one.
        * Certainty: the terms and the stages of a step are identities; wrong with a probability below 2⁻¹¹⁰.
        * Cost:
          * construction: 9 operations
          * step, before the solve: 18 operations
          * Newton iteration: 97 operations
          * step, after the solve: 9 operations

        The continuous equations that it discretises:

        ```text
        l(Ω, w) = −m g ⟨rho, w⟩ + (1/2) tr(J_d) ⟨Ω, Ω⟩ − (1/2) ⟨Ω, J_d Ω⟩    [the limit of l_d/h]
        μ = tr(J_d) Ω − J_d Ω    [∂l/∂ξ, (1.14)]
        dμ/dt = 𝕀 dΩ/dt = (tr(J_d) Ω − J_d Ω) × Ω + m g w × rho    [(1.4) and (2.2): ad*_ξ μ + ∂l/∂w ⋄ w]
        dw/dt = w × Ω    [(2.2): −ξ·w]
        h(μ, w) = ½ ⟨μ, 𝕀⁻¹ μ⟩ + m g ⟨rho, w⟩    [(1.16)]
        ```

        All equations are in `DERIVATION` and in the documentation of the methods."#]].assert_eq(&page(HEAVY_TOP, &item));
    let text = expanded(HEAVY_TOP, &item).to_string();
    let (attributes, rest) = text.split_once("# [allow (non_snake_case)]").expect("the letters of the field");
    assert!(attributes.starts_with("# [doc = \" A top.\"] # [derive (Clone)] # [repr (C)] # [doc ="), "{attributes}");
    assert!(rest.starts_with(" pub struct Top { J_d : NonstandardInertia , m : f64 ,"), "{rest}");
    let pull = "group = SO3, advected(w = up), l_d = -h * k * w.dot(&(F * rho))";
    expect![[r#"


        # Derived terms

        The share in the momentum equation of a body that this is added to:

        ```text
        μ = 0    [(2.7)]
        k₀ = 0    [a = μ + k₀]
        k₁⁺ = h k (rho w⁺ᵀ − w⁺ rhoᵀ)^∨    [μ⁺ = Ad*_F a + k₁⁺]
        ```

        * Order: 1 in general, as `l_d` isn't self-adjoint: a step of −h doesn't undo a step of h.
        * Certainty: the terms and the stages of a step are identities; wrong with a probability below 2⁻¹¹⁰.
        * Cost:
          * construction: 5 operations
          * step, before the solve: 6 operations, 3 sign flips
          * Newton iteration: 0 operations
          * step, after the solve: 9 operations

        The continuous equations that it discretises:

        ```text
        l(Ω, w) = −k ⟨rho, w⟩    [the limit of l_d/h]
        μ = 0    [∂l/∂ξ, (1.14)]
        dμ/dt = μ × Ω + k w × rho    [(1.4) and (2.2): ad*_ξ μ + ∂l/∂w ⋄ w]
        dw/dt = w × Ω    [(2.2): −ξ·w]
        h(μ, w) = k ⟨rho, w⟩    [(1.16)]
        ```

        All equations are in `DERIVATION` and in the documentation of the methods."#]]
    .assert_eq(&page(pull, "struct Pull { k: f64, rho: Vector3<f64>, up: Vector3<f64> }"));
    let drag = "group = SO3, work = -0.5 * c * vee(F).dot(&(eta + eta_next))";
    let drag = crate::expand::expand(Role::Force, tokens(drag), &tokens("struct Drag { c: f64 }")).to_string();
    assert!(drag.contains("# Derived terms") && !drag.contains("* Order"), "{drag}");
}

/// (3.17) is `μ`, (3.18) is `(L_F)* δl_d/δF`, and the diamond is that of section 3.2.1, item 3.
#[test]
#[allow(clippy::needless_raw_string_hashes)] // as expect-test writes them
fn of_the_heavy_top() {
    expect![[r#"
        group
            F = g⁻¹ g⁺ in SO3
            w⁺ = F⁻¹·w = Fᵀ w for w in V*
        l_d
            l_d = −(1/h) tr(F J_d) + (1/h) tr(J_d) − (h m g/2) ⟨rho, Fᵀ w⟩ − (h m g/2) ⟨rho, w⟩    [as declared, in normal form]
        right_momentum
            (R_F)* δl_d/δF = (1/h) (F J_d − J_d Fᵀ)^∨ + (h m g/2) (F rho wᵀ − w rhoᵀ Fᵀ)^∨    [section 3.2.1, item 2]
        left_momentum
            (L_F)* δl_d/δF = (1/h) (J_d F − Fᵀ J_d)^∨ + (h m g/2) (rho wᵀ F − Fᵀ w rhoᵀ)^∨    [section 3.2.1, item 1; (2.6)]
        diamond
            δl_d/δw ⋄ w = (h m g/2) (F rho wᵀ − w rhoᵀ Fᵀ + rho wᵀ − w rhoᵀ)^∨    [(2.1)]
        legendre_minus
            μ = (1/h) (F J_d − J_d Fᵀ)^∨ + (h m g/2) (w rhoᵀ − rho wᵀ)^∨    [(2.7)]
        momentum_jacobian
            ∂μ_k along exp(tE_j)F = −(1/h) tr(F J_d E_k E_j)    [exact, right-trivialised]
        discrete_energy
            −∂l_d/∂h = −(1/h²) tr(F J_d) + (1/h²) tr(J_d) + (m g/2) ⟨rho, Fᵀ w⟩ + (m g/2) ⟨rho, w⟩
        inertia
            J = tr(J_d) I − J_d    [continuous limit]
        momentum_bias
            s = 0    [continuous limit]
        potential
            V = m g ⟨rho, w⟩    [continuous limit]
        kick_before
            k₀ = (h m g/2) (rho wᵀ − w rhoᵀ)^∨    [a = μ + k₀]
        kick_after
            k₁⁺ = (h m g/2) (rho w⁺ᵀ − w⁺ rhoᵀ)^∨    [μ⁺ = Ad*_F a + k₁⁺]
        increments
            (1/h) (F⁺ J_d − J_d F⁺ᵀ)^∨ + (h m g/2) (w⁺ rhoᵀ − rho w⁺ᵀ)^∨ = (1/h) (J_d F − Fᵀ J_d)^∨ + (h m g/2) (rho w⁺ᵀ − w⁺ rhoᵀ)^∨    [F ↦ F⁺, the flow (2.5); of the heavy top (3.16)]
        kick_derivative
            ∂k₀ along exp(−tE_j)·w = (h m g/2) (E_j w rhoᵀ + rho wᵀ E_j)^∨    [the force gradient's]
        continuous
            Ω = g⁻¹ dg/dt
            l_d(exp(h Ω), w, h) = h l(Ω, w) + O(h²)    [at random points, exactly, without a bound]
            pairing: μ_k = ⟨μ, E_k⟩, so that μ is the body momentum; the thesis' matrix, paired by tr(AᵀB), is half of hat(μ)
            l(Ω, w) = −m g ⟨rho, w⟩ + (1/2) tr(J_d) ⟨Ω, Ω⟩ − (1/2) ⟨Ω, J_d Ω⟩    [the limit of l_d/h]
            μ = tr(J_d) Ω − J_d Ω    [∂l/∂ξ, (1.14)]
            𝕀 = tr(J_d) I − J_d    [∂²l/∂ξ², the inertia]
            ∂l/∂w ⋄ w = m g w × rho    [(2.1)]
            dμ/dt = 𝕀 dΩ/dt = (tr(J_d) Ω − J_d Ω) × Ω + m g w × rho    [(1.4) and (2.2): ad*_ξ μ + ∂l/∂w ⋄ w]
            dw/dt = w × Ω    [(2.2): −ξ·w]
            Ω = 𝕀⁻¹ μ    [(1.14) inverted, 𝕀⁻¹ once for all]
            h(μ, w) = ½ ⟨μ, 𝕀⁻¹ μ⟩ + m g ⟨rho, w⟩    [(1.16)]
            kept = h(μ, w); |w|²; ⟨μ, w⟩, the spatial momentum along it    [left and right symmetries]
            certainty: the equations are identities; wrong with a probability below 2⁻¹¹²
        hypotheses used
            FᵀF = I, J_dᵀ = J_d
        self-adjoint
            l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)    [by the normal forms: even order; a step of −h undoes a step of h]
        certainty
            the terms and the stages of a step are identities; wrong with a probability below 2⁻¹¹⁰
        Newton system
            U(F, w) = a in the Cayley vector y of F, tan(θ/2) along the axis
            taken: Cayley, denominators cleared, 97 operations an iteration
            rejected: Cayley, denominators cleared, multiplied out, 105 operations an iteration
            rejected: F rebuilt from y, 147 operations, 3 sign flips an iteration
            rejected: F rebuilt from y, multiplied out, 268 operations, 3 sign flips an iteration
        operations
            construction: 9 operations
            step, before the solve: 18 operations
            Newton iteration: 97 operations
            step, after the solve: 9 operations
    "#]].assert_eq(&derivation(HEAVY_TOP, &top("NonstandardInertia")));
}

/// The line below a title.
fn section(arguments: &str, item: &str, title: &str) -> String {
    let text = derivation(arguments, item);
    let mut lines = text.lines().skip_while(|line| *line != title).skip(1);
    lines.next().expect("the section").trim().to_owned()
}

/// Only what an equation would be different without.
#[test]
fn hypotheses_that_are_used() {
    let hypotheses = |arguments: &str, item: &str| section(arguments, item, "hypotheses used");
    let diagonal = hypotheses(HEAVY_TOP, &top("DiagonalNonstandardInertia"));
    assert_eq!(diagonal, "FᵀF = I, J_dᵀ = J_d, J_d diagonal");
    // Nothing is multiplied by the inertia: neither its symmetry nor its zeros matter.
    let trace = "group = SO3, advected(w = up),
        l_d = J_d.trace() * (3.0 - F.trace()) / h - 0.5 * h * k * w.dot(&(rho + F * rho))";
    let item = "struct Top { J_d: DiagonalNonstandardInertia, k: f64, rho: Vector3<f64>, up: Vector3<f64> }";
    assert_eq!(hypotheses(trace, item), "FᵀF = I");
    let free = "group = SO3, l_d = k * (3.0 - F.trace()) / h";
    assert_eq!(hypotheses(free, "struct Body { k: f64 }"), "none");
    let without_relation = "group = SO3, l_d = (J_d.trace() - (F * J_d).trace()) / h + (J_d * F * J_d * F).trace() * h";
    assert_eq!(hypotheses(without_relation, "struct Body { J_d: NonstandardInertia }"), "J_dᵀ = J_d");
    // aᵀ Fᵀ ŵ F b = aᵀ (Fᵀw)^ b holds for rotations, not for reflections.
    let triple = "group = SO3, advected(w = up),
        l_d = k * (3.0 - F.trace()) / h - h * (F * a).dot(&w.cross(&(F * b)))";
    let item = "struct Body { k: f64, a: Vector3<f64>, b: Vector3<f64>, up: Vector3<f64> }";
    assert_eq!(hypotheses(triple, item), "FᵀF = I, det F = 1");
    // Of what is promised of a point, what saves an operation.
    let tether = "group = SE2, advected(a = anchor),
        l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * k * (a - F * p).norm_squared()";
    let item = "struct Planar { J: Matrix3<f64>, k: f64, p: Point2<f64>, anchor: Point2<f64> }";
    assert_eq!(hypotheses(tether, item), "p₃ = 1, a₃ = 1");
    // Elsewhere nothing is assumed.
    let planar = "group = SE2, l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h)";
    assert_eq!(hypotheses(planar, "struct Planar { J: Matrix3<f64> }"), "none");
}

/// What is advected moves by its kind, under its own name.
#[test]
fn the_setting() {
    let text = derivation(
        "group = SE2, advected(w = up, S = field),
        l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * (w.dot(&(F * r)) + (S * F).trace())",
        "struct Planar { J: Matrix3<f64>, r: Vector3<f64>, up: Vector3<f64>, field: MixedTensor<f64, 3> }",
    );
    assert!(text.starts_with(
        "group\n    F = g⁻¹ g⁺ in SE2\n    w⁺ = F⁻¹·w = Fᵀ w for w in V*\n    S⁺ = F⁻¹·S = F⁻¹ S F for S in V ⊗ V*\n"
    ));
}
