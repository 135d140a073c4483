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
fn of_the_heavy_top() {
    expect![[r#""#]].assert_eq(&derivation(HEAVY_TOP, &top("NonstandardInertia")));
}
