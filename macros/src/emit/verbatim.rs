//! The declared expression as the method `l_d`, as it stands.
//!
//! Its names are bound to the values that the macro gave them, so that rustc checks the types that the macro assumed.
//! Their spans keep the place but resolve where the bindings do, whatever `macro_rules!` they came through. In a struct
//! that is generic in its scalar, literals and scalar functions are written as the scalar's own.

use proc_macro2::{Span, TokenStream};
use quote::{quote, quote_spanned};
use syn::ext::IdentExt as _;
use syn::visit_mut::{self, VisitMut};
use syn::{Expr, Ident};

use super::Header;
use crate::ast::{Declaration, FieldKind};

pub(super) fn l_d(declaration: &Declaration, header: &Header) -> TokenStream {
    let span = Span::mixed_site();
    let (root, scalar, square) = (&header.root, &header.scalar, header.square());
    let mut expression = declaration.l_d.clone();
    let mut rewrite = Rewrite { header, mentioned: Vec::new() };
    rewrite.visit_expr_mut(&mut expression);
    let mentioned = |name: &str| rewrite.mentioned.iter().any(|used| used == name);
    let mut bindings = TokenStream::new();
    let local = |name: &str| Ident::new_raw_or_plain(name, span);
    if mentioned("F") {
        let name = local("F");
        bindings.extend(quote_spanned!(span=> let #name = *f;));
    }
    if mentioned("I") {
        let name = local("I");
        bindings.extend(quote_spanned!(span=> let #name: #square = <#square>::identity();));
    }
    if mentioned("vee") {
        let (name, vector) = (local("vee"), header.vector());
        bindings.extend(quote_spanned!(span=> let #name = |matrix: #square| -> #vector {
            <#root::SO3<#scalar> as #root::LieGroup>::vee(&matrix)
        };));
    }
    for (index, w) in declaration.advected.iter().enumerate() {
        let text = w.name.unraw().to_string();
        let name = local(&text);
        let value = if declaration.advected.len() == 1 {
            quote_spanned!(span=> *w)
        } else {
            let index = syn::Index::from(index);
            quote_spanned!(span=> w.#index)
        };
        bindings.extend(quote_spanned!(span=> let #name = #value;));
    }
    for field in &declaration.fields {
        let text = field.name.unraw().to_string();
        if !mentioned(&text) {
            continue;
        }
        let (name, member) = (local(&text), &field.name);
        let value = match field.kind {
            FieldKind::Scalar => quote_spanned!(span=> self.#member),
            _ => quote_spanned!(span=> #root::__private::Parameter::value(&self.#member)),
        };
        bindings.extend(quote_spanned!(span=> let #name = #value;));
    }
    let traits = header.parameter.as_ref().map(|_| quote!(use #root::__private::nalgebra::SimdComplexField as _;));
    quote_spanned! {span=>
        /// The Lagrangian as declared.
        fn l_d(&self, f: &#square, w: &Self::Advected, h: #scalar) -> #scalar {
            #traits
            #bindings
            #expression
        }
    }
}

/// Resolves the names of the expression at the macro's site, and notes which there are.
struct Rewrite<'a> {
    header: &'a Header,
    mentioned: Vec<String>,
}

impl VisitMut for Rewrite<'_> {
    fn visit_ident_mut(&mut self, ident: &mut Ident) {
        self.mentioned.push(ident.unraw().to_string());
        ident.set_span(ident.span().resolved_at(Span::mixed_site()));
    }

    fn visit_expr_method_call_mut(&mut self, call: &mut syn::ExprMethodCall) {
        self.visit_expr_mut(&mut call.receiver);
        for argument in &mut call.args {
            self.visit_expr_mut(argument);
        }
        // Fields and methods have no hygiene; a scalar's functions are those of nalgebra's scalars.
        let name = call.method.to_string();
        if self.header.parameter.is_some() && ["sqrt", "ln", "exp", "sin", "cos", "powi"].contains(&name.as_str()) {
            call.method = Ident::new(&format!("simd_{name}"), call.method.span());
        }
    }

    fn visit_expr_mut(&mut self, expression: &mut Expr) {
        visit_mut::visit_expr_mut(self, expression);
        if let (Expr::Lit(literal), Some(parameter)) = (&*expression, &self.header.parameter)
            && matches!(literal.lit, syn::Lit::Float(_))
        {
            let root = &self.header.root;
            *expression =
                syn::parse_quote_spanned!(Span::mixed_site()=> #root::__private::real::<#parameter>(#literal));
        }
    }

    fn visit_member_mut(&mut self, _: &mut syn::Member) {}
}

/// An identifier for a name that may be a keyword.
trait RawOrPlain {
    fn new_raw_or_plain(name: &str, span: Span) -> Self;
}

impl RawOrPlain for Ident {
    fn new_raw_or_plain(name: &str, span: Span) -> Self {
        if syn::parse_str::<Ident>(name).is_ok() { Self::new(name, span) } else { Self::new_raw(name, span) }
    }
}
