//! The derived equations in print.

use expect_test::expect_file;

use crate::common::{HEAVY_TOP, expanded, tokens, top};
use liestep_derivation::declared::Role;

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
fn on_the_struct() {
    let item = format!("/// A top.\n#[derive(Clone)] #[repr(C)] pub {}", top("NonstandardInertia"));
    expect_file!["printed/heavy_top_page.txt"].assert_eq(&page(HEAVY_TOP, &item));
    let text = expanded(HEAVY_TOP, &item).to_string();
    let (attributes, rest) = text.split_once("# [allow (non_snake_case)]").expect("the letters of the field");
    assert!(attributes.starts_with("# [doc = \" A top.\"] # [derive (Clone)] # [repr (C)] # [doc ="), "{attributes}");
    assert!(rest.starts_with(" pub struct Top { J_d : NonstandardInertia , m : f64 ,"), "{rest}");
    let pull = "group = SO3, advected(w = up), l_d = -h * k * w.dot(&(F * rho))";
    expect_file!["printed/pull_page.txt"]
        .assert_eq(&page(pull, "struct Pull { k: f64, rho: Vector3<f64>, up: Vector3<f64> }"));
    let drag = "group = SO3, work = -0.5 * c * vee(F).dot(&(eta + eta_next))";
    let drag = liestep_derivation::expand(Role::Force, tokens(drag), &tokens("struct Drag { c: f64 }")).to_string();
    assert!(drag.contains("# Derived terms") && !drag.contains("* Order"), "{drag}");
}

/// (3.17) is `μ`, (3.18) is `(L_F)* δl_d/δF`, and the diamond is that of section 3.2.1, item 3.
#[test]
fn of_the_heavy_top() {
    expect_file!["printed/heavy_top.txt"].assert_eq(&derivation(HEAVY_TOP, &top("NonstandardInertia")));
}

/// Whatever parameters are called, the equations have no letter that is another's.
#[test]
fn the_names_are_those_of_the_declaration() {
    let text = derivation(
        "group = SO3, advected(A = a),
        l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * V * A.dot(&(s + F * s))",
        "struct Top { J: NonstandardInertia, V: f64, s: Vector3<f64>, a: Vector3<f64> }",
    );
    for line in [
        "inertia\n    𝕀 = tr(J) I − J ",
        "momentum_bias\n    s(A) = 0 ",
        "potential\n    V(A) = V ⟨s, A⟩ ",
        "    ∂l/∂A ⋄ A = V A × s ",
        "    dA/dt = A × Ω    [(2.2): −ξ·A]",
    ] {
        assert!(text.contains(&format!("\n{line}")), "{line} isn't in {text}");
    }
    assert!(!text.split(|letter: char| !letter.is_alphanumeric()).any(|word| word == "w"), "{text}");
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

/// Names stand for letters of the formulas, and may have letters of each other.
#[test]
fn names_have_letters_of_each_other() {
    let kinetic = |f: &str| format!("(({f} - I) * J * ({f} - I).transpose()).trace() / (2.0 * h)");
    let covector = format!(
        "group(F_down = SO3, d = R1), advected(F_w = up.seen_from(F_down)),
        l_d = {} + d.powi(2) / h - h * F_w.dot(&r)",
        kinetic("F_down")
    );
    let item = "struct Body { J: NonstandardInertia, r: Vector3<f64>, up: Vector3<f64> }";
    assert!(
        derivation(&covector, item).contains("F_w⁺ = F_down⁻¹·F_w = F_downᵀ F_w for"),
        "{}",
        derivation(&covector, item)
    );
    let tensor = format!("group = SE2, advected(up = S), l_d = {} - h * (up * J).trace()", kinetic("F"));
    let item = "struct Body { J: Matrix3<f64>, S: ContravariantTensor<f64, 3> }";
    assert!(derivation(&tensor, item).contains("up⁺ = F⁻¹·up = F⁻¹ up F⁻ᵀ for"), "{}", derivation(&tensor, item));
}
