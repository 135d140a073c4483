//! Tokens: one `impl DiscreteLagrangian`. Makes no mathematical decision.

mod code;
mod docs;
mod header;
mod inputs;
mod stages;
mod verbatim;

use proc_macro2::{Span, TokenStream};
use quote::quote_spanned;

use crate::ast::Declaration;
use crate::derive::{Derived, SelfAdjointness};
use crate::lower::Lowered;
use crate::scalar::{Given, Graph, Kernel, Scalariser, components, square, with_lets};
use crate::symbolic::{Expression, SymbolId};

use code::Form;
pub(crate) use header::Header;

/// What has been found out about a derivation.
pub(crate) struct Findings {
    pub(crate) kernel: Kernel,
    pub(crate) self_adjointness: SelfAdjointness,
    pub(crate) hypotheses: Vec<String>,
}

/// The whole implementation.
pub(crate) fn implementation(
    declaration: &Declaration,
    lowered: &Lowered,
    derived: &Derived,
    findings: &Findings,
) -> TokenStream {
    let (header, kernel) = (Header::new(declaration), &findings.kernel);
    let emitter = Emitter { declaration, lowered, derived, header: &header };
    let (mathematics, texts) = emitter.mathematics();
    let stages = stages::stages(&emitter, kernel, &texts);
    let l_d = verbatim::l_d(declaration, &header);
    let derivation = docs::derivation(declaration, derived, &texts, findings);
    let documentation = format!("```text\n{derivation}```");
    let is_self_adjoint = findings.self_adjointness.is_found();
    let validate = emitter.validate();
    let describe = emitter.describe();
    let advected = emitter.advected();
    let root = &header.root;
    let span = Span::mixed_site();
    let types = header.types(&stages.constants_type, &stages.step_terms_type);
    let implementation = header.implementation();
    let body = &stages.methods;
    quote_spanned! {span=>
        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic, clippy::nursery, non_snake_case, unused_variables)]
        #implementation {
            #types

            #[doc = #documentation]
            const DERIVATION: &'static #root::__private::core::primitive::str = #derivation;
            const SELF_ADJOINT: #root::__private::core::primitive::bool = #is_self_adjoint;

            #validate
            #describe
            #advected
            #l_d
            #mathematics
            #body
        }
    }
}

/// The arguments of a method.
#[derive(Clone, Copy, Debug)]
enum Takes {
    Nothing,
    Advected,
    Increment,
}

/// What the pieces share.
struct Emitter<'a> {
    declaration: &'a Declaration,
    lowered: &'a Lowered,
    derived: &'a Derived,
    header: &'a Header,
}

impl Emitter<'_> {
    /// The derived terms that don't know stages.
    fn mathematics(&self) -> (TokenStream, Vec<docs::Equation>) {
        let d = self.derived;
        let mut methods = TokenStream::new();
        let equations = docs::equations(d, &self.lowered.declared);
        let covectors = [
            ("right_momentum", &d.right_momentum),
            ("left_momentum", &d.left_momentum),
            ("diamond", &d.diamond),
            ("legendre_minus", &d.momentum),
        ];
        for (name, covector) in covectors {
            methods.extend(self.method(name, Takes::Increment, Form::Vector, covector, &equations));
        }
        let others = [
            ("momentum_jacobian", Takes::Increment, Form::Square, &d.jacobian),
            ("discrete_energy", Takes::Increment, Form::Scalar, &d.energy),
            ("inertia", Takes::Nothing, Form::Square, &d.limit.inertia),
            ("momentum_bias", Takes::Advected, Form::Vector, &d.limit.bias),
            ("potential", Takes::Advected, Form::Scalar, &d.limit.potential),
        ];
        for (name, takes, form, expression) in others {
            methods.extend(self.method(name, takes, form, expression, &equations));
        }
        (methods, equations)
    }

    /// One derived term as a method, with its equation as documentation.
    fn method(
        &self,
        name: &str,
        takes: Takes,
        form: Form,
        expression: &Expression,
        equations: &[docs::Equation],
    ) -> TokenStream {
        let (span, d, root) = (Span::mixed_site(), self.derived, &self.header.root);
        let mut graph = Graph::default();
        let none = with_lets(&mut graph, d, Given::new());
        let (outputs, result) = match form {
            Form::Scalar => {
                let mut scalariser = Scalariser { graph: &mut graph, symbols: &d.symbols, given: none };
                (vec![scalariser.scalar(expression)], self.header.scalar.clone())
            }
            Form::Vector => (components(&mut graph, d, &none, expression), self.header.vector()),
            Form::Square => (square(&mut graph, d, &none, expression), self.header.square()),
        };
        let documentation = docs::of(equations, name, &graph, &outputs);
        let body = self.body(form, &graph, &outputs, &|input| self.input_token(input));
        let name = syn::Ident::new(name, span);
        let (matrix, scalar) = (self.header.matrix(), &self.header.scalar);
        let w = quote_spanned!(span=> w: &<Self as #root::DiscreteLagrangian>::Advected);
        let arguments = match takes {
            Takes::Nothing => TokenStream::new(),
            Takes::Advected => w,
            Takes::Increment => quote_spanned!(span=> f: &#matrix, #w, h: #scalar),
        };
        quote_spanned! {span=>
            #[doc = #documentation]
            fn #name(&self, #arguments) -> #result { #body }
        }
    }

    fn validate(&self) -> TokenStream {
        let span = Span::mixed_site();
        let root = &self.header.root;
        let checks = self.declaration.fields.iter().map(|field| {
            let name = &field.name;
            let text = syn::ext::IdentExt::unraw(name).to_string();
            if field.kind == crate::ast::FieldKind::Scalar {
                quote_spanned!(span=> #root::__private::validate_scalar(self.#name, #text)?;)
            } else {
                quote_spanned!(span=> #root::__private::Parameter::validate(&self.#name, #text)?;)
            }
        });
        quote_spanned! {span=>
            fn validate(&self) -> #root::__private::core::result::Result<(), #root::SetupError> {
                #(#checks)*
                #root::__private::core::result::Result::Ok(())
            }
        }
    }

    fn describe(&self) -> TokenStream {
        let span = Span::mixed_site();
        let root = &self.header.root;
        let scalar = &self.header.scalar;
        let fields = self.declaration.fields.iter().map(|field| {
            let name = &field.name;
            let text = syn::ext::IdentExt::unraw(name).to_string();
            if field.kind == crate::ast::FieldKind::Scalar {
                quote_spanned!(span=> #root::__private::SceneVisitor::parameter(visitor, #text, self.#name);)
            } else {
                quote_spanned!(span=> #root::__private::Parameter::describe(&self.#name, #text, visitor);)
            }
        });
        quote_spanned! {span=>
            fn describe(&self, visitor: &mut dyn #root::__private::SceneVisitor<#scalar>) {
                #root::__private::SceneVisitor::term(visitor, Self::DERIVATION);
                #(#fields)*
            }
        }
    }

    fn advected(&self) -> TokenStream {
        let span = Span::mixed_site();
        let fields = self.declaration.advected.iter().filter_map(|w| self.declaration.fields.get(w.field?));
        let names: Vec<_> = fields.map(|field| &field.name).collect();
        let value = match names.as_slice() {
            [single] => quote_spanned!(span=> self.#single),
            names => quote_spanned!(span=> (#(self.#names),*)),
        };
        quote_spanned! {span=>
            fn advected(&self) -> Self::Advected { #value }
        }
    }

    fn symbol_name(&self, id: SymbolId) -> &str {
        &self.derived.symbols.get(id).name
    }
}
