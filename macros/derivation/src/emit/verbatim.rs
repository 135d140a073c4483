//! The declared expression, unchanged, as the method `l_d`, `l`, `virtual_work` or `zero`.
//!
//! Its names are bound to values with the types that the macro assumed, so that rustc checks these. Their spans keep
//! the place but resolve at the bindings, whatever `macro_rules!` they came through; the names of its own `let`s keep
//! their spans. In a struct that is generic in its scalar, literals and scalar functions are those of the scalar.

use proc_macro2::{Span, TokenStream};
use quote::{quote, quote_spanned};
use syn::ext::IdentExt as _;
use syn::visit_mut::{self, VisitMut};
use syn::{Expr, Ident};

use super::Header;
use crate::declared::{AdvectedParameter, Declaration, FieldKind, Role, Shape, Spelling};
use crate::mathematics::derive::View;

/// The names of the bodies in the methods of a constraint.
pub(super) const BODIES: [&str; 2] = ["above", "below"];

/// The Lagrangian's `l_d` or `l`, a force's `virtual_work`, or a constraint's `gap`.
pub(super) fn declared(declaration: &Declaration, header: &Header) -> TokenStream {
    let span = Span::mixed_site();
    let private = &header.private;
    let Some(mut expression) = declaration.expression.clone() else { return TokenStream::new() };
    let mut rewrite =
        Rewrite { header, is_product: declaration.group.is_product(), mentioned: Vec::new(), scopes: Vec::new() };
    rewrite.visit_expr_mut(&mut expression);
    let BoundNames { names, values, .. } = bound(declaration, header, rewrite.mentioned);
    // `F` and `I` may be constants or unit structs in the user's scope, which a pattern would compare with instead of
    // binding the name. The functions hide them, and the pattern may hide functions.
    let imposed = names.iter().filter(|name| *name == "F" || *name == "I");
    let hidden: TokenStream = imposed.map(|name| quote_spanned!(span=> #[allow(dead_code)] fn #name() {})).collect();
    // The expression is a statement, which has parentheses around a block that it begins with.
    let expression = syn::Stmt::Expr(expression, None);
    let traits = header.parameter.as_ref().map(|_| quote!(use #private::nalgebra::SimdComplexField as _;));
    let declared = quote_spanned! {span=>
        #traits
        #hidden
        // One pattern binds all names, so that none hides a value that a later one needs.
        let (#(#names,)*) = (#(#values,)*);
        #expression
    };
    if declaration.role == Role::Constraint {
        return declared;
    }
    let signature = signature(declaration, header);
    quote_spanned! {span=>
        #signature { #declared }
    }
}

/// The names that the macro knows and the expression mentions, with their values.
struct BoundNames {
    mentioned: Vec<String>,
    names: Vec<Ident>,
    values: Vec<TokenStream>,
}

impl BoundNames {
    fn bind(&mut self, name: &str, value: TokenStream) {
        if self.mentioned.iter().any(|used| used == name) {
            self.names.push(Ident::new_raw_or_plain(name, Span::mixed_site()));
            self.values.push(value);
        }
    }
}

fn bound(declaration: &Declaration, header: &Header, mentioned: Vec<String>) -> BoundNames {
    let (span, private, scalar) = (Span::mixed_site(), &header.private, &header.scalar);
    let mut bound = BoundNames { mentioned, names: Vec::new(), values: Vec::new() };
    // A constraint has no increments.
    if declaration.role != Role::Constraint {
        increments(declaration, header, &mut bound);
    }
    maps(declaration, header, &mut bound);
    for (factor, name) in declaration.velocities().iter().enumerate() {
        let velocity = Ident::new("velocity", span);
        bound.bind(&name.unraw().to_string(), of_factor(declaration, header, &velocity, factor));
    }
    for factor in 0..declaration.factors.len() {
        let Some(names) = declaration.displacement(factor) else { continue };
        for (name, components) in names.iter().zip(["eta", "eta_next"]) {
            bound.bind(name, of_factor(declaration, header, &Ident::new(components, span), factor));
        }
    }
    bound.bind("log", quote_spanned!(span=> #private::rotation_log::<#scalar>));
    bound.bind("exp", quote_spanned!(span=> #private::rotation_exp::<#scalar>));
    for (index, parameter) in declaration.advected.iter().enumerate() {
        let value = if declaration.role == Role::Constraint {
            seen(declaration, header, parameter)
        } else {
            let part = if declaration.advected.len() == 1 {
                quote_spanned!(span=> (*w))
            } else {
                let index = syn::Index::from(index);
                quote_spanned!(span=> w.#index)
            };
            advected(declaration, header, index, part)
        };
        bound.bind(&parameter.plain_name(), value);
    }
    for field in &declaration.fields {
        let (member, span) = (&field.name, field.at.resolved_at(span));
        let private = header.private_at(span);
        let value = if field.kind == FieldKind::Scalar {
            quote_spanned!(span=> self.#member)
        } else {
            quote_spanned!(span=> #private::Parameter::value(&self.#member))
        };
        bound.bind(&field.plain_name(), value);
    }
    bound
}

/// The increments.
fn increments(declaration: &Declaration, header: &Header, bound: &mut BoundNames) {
    let span = Span::mixed_site();
    for (index, factor) in declaration.factors.iter().enumerate() {
        let group = declaration.group.factor(index);
        let value = if declaration.group.is_product() {
            let index = syn::Index::from(index);
            let is_alone = declaration.factors.len() == 1;
            let matrix = if is_alone { quote_spanned!(span=> (*f)) } else { quote_spanned!(span=> f.#index) };
            if group.is_added { translation(header, &matrix, group.dimension()) } else { matrix }
        } else {
            quote_spanned!(span=> *f)
        };
        bound.bind(&factor.name, value);
    }
}

/// The identity, and the maps between vectors and matrices.
fn maps(declaration: &Declaration, header: &Header, bound: &mut BoundNames) {
    let (span, private, scalar) = (Span::mixed_site(), &header.private, &header.scalar);
    bound.bind("I", header.identity(declaration.group.rows_of_identity()));
    let three = quote_spanned!(span=> #private::nalgebra::Matrix3<#scalar>);
    bound.bind(
        "vee",
        quote_spanned!(span=> |matrix: #three| <#private::SO3<#scalar> as #private::LieGroup>::vee(&matrix)),
    );
    let own = declaration.group.of_hat().and_then(|factor| header.groups().nth(factor));
    let group = own.unwrap_or_else(|| quote_spanned!(span=> #private::SO3<#scalar>));
    let vector = quote_spanned!(span=> <#group as #private::LieGroup>::Vector);
    bound.bind("hat", quote_spanned!(span=> |v: #vector| <#group as #private::LieGroup>::hat(&v)));
}

/// The value of a name of `advected(…)`, at the positions of both bodies.
fn seen(declaration: &Declaration, header: &Header, w: &AdvectedParameter) -> TokenStream {
    let (span, private) = (Span::mixed_site(), &header.private);
    let place = |factor: usize| {
        let body = Ident::new(BODIES[factor / 2 % 2], span);
        let part = Ident::new(["attitude", "position"][factor % 2], span);
        quote_spanned!(span=> #body.#part)
    };
    match w.seen {
        View::Configuration(of) => place(of),
        View::Relative { of, from } => {
            let (of_place, from_place) = (place(of), place(from));
            if of % 2 == 1 {
                quote_spanned!(span=> #of_place - #from_place)
            } else {
                quote_spanned!(span=> #from_place.transpose() * #of_place)
            }
        }
        View::From(factor) => {
            let Some(field) = w.field.and_then(|field| declaration.fields.get(field)) else {
                return TokenStream::new();
            };
            let (name, attitude) = (&field.name, place(factor));
            quote_spanned!(span=> #attitude.transpose() * #private::Parameter::value(&self.#name))
        }
    }
}

/// The signature of the method with the expression.
fn signature(declaration: &Declaration, header: &Header) -> TokenStream {
    let (span, scalar, square, vector) = (Span::mixed_site(), &header.scalar, header.matrix(), header.vector());
    match declaration.role {
        Role::Lagrangian if declaration.continuous.is_some() => quote_spanned! {span=>
            /// The Lagrangian as declared.
            fn l(&self, velocity: &#vector, w: &Self::Advected) -> #scalar
        },
        Role::Lagrangian | Role::Constraint | Role::Hamiltonian => quote_spanned! {span=>
            /// The Lagrangian as declared.
            fn l_d(&self, f: &#square, w: &Self::Advected, h: #scalar) -> #scalar
        },
        Role::Force => quote_spanned! {span=>
            /// The virtual work as declared.
            fn virtual_work(
                &self, f: &#square, w: &Self::Advected, h: #scalar, eta: &#vector, eta_next: &#vector,
            ) -> #scalar
        },
        Role::Nonholonomic => quote_spanned!(span=> fn zero(&self, velocity: &#vector, w: &Self::Advected) -> #scalar),
    }
}

/// The value of an advected parameter in the expression, from its part of `w`.
fn advected(declaration: &Declaration, header: &Header, index: usize, part: TokenStream) -> TokenStream {
    let (span, private) = (Span::mixed_site(), &header.private);
    let kind = declaration.advected_kind(index);
    let is_seen = declaration.group.is_product() && !matches!(kind, FieldKind::Given(_));
    let part = if is_seen { quote_spanned!(span=> #part.0) } else { part };
    match kind {
        FieldKind::Given(Shape::Scalar) => quote_spanned!(span=> #part.0.x),
        FieldKind::Advected(..) | FieldKind::Given(_) => quote_spanned!(span=> #part.0),
        FieldKind::Point(_) => quote_spanned!(span=> #private::Parameter::value(&#part)),
        FieldKind::Place(coordinates) => translation(header, &part, coordinates),
        _ => part,
    }
}

/// The components of a factor among `components`, which is a reference; on a line a scalar.
fn of_factor(declaration: &Declaration, header: &Header, components: &Ident, factor: usize) -> TokenStream {
    let (span, private, group) = (Span::mixed_site(), &header.private, &declaration.group);
    if !group.is_product() {
        return quote_spanned!(span=> *#components);
    }
    let (own, first) = (group.factor(factor), group.component_of(factor));
    let entries = (first..first + own.dimension()).map(|row| {
        let row = proc_macro2::Literal::usize_unsuffixed(row);
        quote_spanned!(span=> #components.data.0[0][#row])
    });
    if own.dimension() == 1 {
        return entries.collect();
    }
    let vector = Ident::new(&format!("Vector{}", own.dimension()), span);
    quote_spanned!(span=> #private::nalgebra::#vector::new(#(#entries),*))
}

/// `x` of the matrix `[I, x; 0, 1]`, on a line a scalar.
fn translation(header: &Header, matrix: &TokenStream, coordinates: usize) -> TokenStream {
    let (span, private) = (Span::mixed_site(), &header.private);
    let entries = (0..coordinates).map(|row| {
        let [row, column] = [row, coordinates].map(proc_macro2::Literal::usize_unsuffixed);
        quote_spanned!(span=> #matrix.data.0[#column][#row])
    });
    if coordinates == 1 {
        return entries.collect();
    }
    let vector = Ident::new(&format!("Vector{coordinates}"), span);
    quote_spanned!(span=> #private::nalgebra::#vector::new(#(#entries),*))
}

/// A visitor that resolves the names of the expression at the macro's site, and records them.
struct Rewrite<'a> {
    header: &'a Header,
    is_product: bool,
    mentioned: Vec<String>,
    /// The names that `let`s of the enclosing blocks have declared so far.
    scopes: Vec<Vec<Spelling>>,
}

impl VisitMut for Rewrite<'_> {
    fn visit_ident_mut(&mut self, ident: &mut Ident) {
        if self.scopes.iter().flatten().any(|bound| *bound == Spelling::of(ident)) {
            return;
        }
        self.mentioned.push(ident.unraw().to_string());
        ident.set_span(ident.span().resolved_at(Span::mixed_site()));
    }

    fn visit_block_mut(&mut self, block: &mut syn::Block) {
        self.scopes.push(Vec::new());
        visit_mut::visit_block_mut(self, block);
        self.scopes.pop();
    }

    fn visit_local_mut(&mut self, local: &mut syn::Local) {
        // A name is in scope behind its value, which may use an earlier one of that name.
        if let Some(init) = &mut local.init {
            self.visit_expr_mut(&mut init.expr);
        }
        if let (syn::Pat::Ident(name), Some(scope)) = (&local.pat, self.scopes.last_mut()) {
            scope.push(Spelling::of(&name.ident));
        }
    }

    fn visit_expr_closure_mut(&mut self, closure: &mut syn::ExprClosure) {
        let names = closure.inputs.iter().filter_map(|parameter| match parameter {
            syn::Pat::Type(typed) => match &*typed.pat {
                syn::Pat::Ident(name) => Some(Spelling::of(&name.ident)),
                _ => None,
            },
            _ => None,
        });
        self.scopes.push(names.collect());
        // The types are names of the user's.
        self.visit_expr_mut(&mut closure.body);
        self.scopes.pop();
    }

    fn visit_expr_method_call_mut(&mut self, call: &mut syn::ExprMethodCall) {
        self.visit_expr_mut(&mut call.receiver);
        for argument in &mut call.args {
            self.visit_expr_mut(argument);
        }
        // Fields and methods have no hygiene. Functions of a generic scalar are those of nalgebra's `SimdComplexField`.
        let name = call.method.to_string();
        if self.header.parameter.is_some() && ["sqrt", "ln", "exp", "sin", "cos", "powi"].contains(&name.as_str()) {
            call.method = Ident::new(&format!("simd_{name}"), call.method.span());
        }
    }

    fn visit_expr_mut(&mut self, expression: &mut Expr) {
        visit_mut::visit_expr_mut(self, expression);
        // The compiler never receives the invisible brackets of a `macro_rules!` fragment.
        if let Expr::Group(fragment) = expression {
            let inner = std::mem::replace(&mut *fragment.expr, Expr::Verbatim(TokenStream::new()));
            let paren_token = syn::token::Paren(fragment.group_token.span);
            let expr = Box::new(inner);
            *expression = Expr::Paren(syn::ExprParen { attrs: Vec::new(), paren_token, expr });
        }
        if let (Expr::Lit(literal), Some(parameter)) = (&*expression, &self.header.parameter)
            && matches!(literal.lit, syn::Lit::Float(_))
        {
            let private = &self.header.private;
            *expression = syn::parse_quote_spanned!(Span::mixed_site()=> #private::real::<#parameter>(#literal));
        }
    }

    fn visit_expr_call_mut(&mut self, call: &mut syn::ExprCall) {
        visit_mut::visit_expr_call_mut(self, call);
        // A generic function by its path: a closure has one type, while matrices have several sizes.
        if matches!(&*call.func, Expr::Path(path) if path.path.is_ident("inverse")) {
            let private = &self.header.private;
            // Among several bodies `F` isn't an element of the whole group.
            *call.func = if !self.is_product && call.args.first().is_some_and(is_increment) {
                syn::parse_quote_spanned!(Span::mixed_site()=> #private::inverse_of::<<Self as #private::Term>::Group>)
            } else {
                syn::parse_quote_spanned!(Span::mixed_site()=> #private::inverse)
            };
        }
    }

    fn visit_member_mut(&mut self, _: &mut syn::Member) {}
}

/// Whether the expression is `F`.
fn is_increment(expression: &Expr) -> bool {
    match expression {
        Expr::Path(path) => path.path.is_ident("F"),
        Expr::Paren(inner) => is_increment(&inner.expr),
        Expr::Group(inner) => is_increment(&inner.expr),
        _ => false,
    }
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
