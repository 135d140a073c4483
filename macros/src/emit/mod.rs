//! Tokens: one `impl DiscreteLagrangian`. Makes no mathematical decision.

mod code;
mod docs;
mod header;
mod inputs;
mod stages;
mod verbatim;

use std::collections::BTreeMap;

use proc_macro2::{Span, TokenStream};
use quote::quote_spanned;

use crate::ast::Declaration;
use crate::derive::Derived;
use crate::lower::Lowered;
use crate::scalar::{Graph, NodeId, Scalariser, components, kernel, square};
use crate::symbolic::{Expression, SymbolId};

pub(crate) use header::Header;

/// The whole implementation.
pub(crate) fn implementation(declaration: &Declaration, lowered: &Lowered, derived: &Derived) -> TokenStream {
    let header = Header::new(declaration);
    let kernel = kernel(derived);
    let emitter = Emitter { declaration, lowered, derived, header: &header };
    let (mathematics, texts) = emitter.mathematics(&kernel);
    let stages = stages::stages(&emitter, &kernel);
    let l_d = verbatim::l_d(declaration, &header);
    let derivation = docs::derivation(&texts);
    let validate = emitter.validate();
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

            const DERIVATION: &'static #root::__private::core::primitive::str = #derivation;

            #validate
            #advected
            #l_d
            #mathematics
            #body
        }
    }
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
    fn mathematics(&self, kernel: &crate::scalar::Kernel) -> (TokenStream, Vec<docs::Equation>) {
        let d = self.derived;
        let direction = d.directions.first;
        let mut methods = TokenStream::new();
        let equations = docs::equations(d, &self.lowered.declared, kernel);
        let vectors = [
            ("right_momentum", &d.right_momentum),
            ("left_momentum", &d.left_momentum),
            ("diamond", &d.diamond),
            ("legendre_minus", &d.momentum),
        ];
        for (name, covector) in vectors {
            let mut graph = Graph::default();
            let outputs = components(&mut graph, &d.symbols, &BTreeMap::new(), covector, direction);
            let documentation = docs::of(&equations, name, &graph, &outputs);
            methods.extend(self.method_of_increment(name, &documentation, &graph, &outputs, &self.header.vector()));
        }
        let mut graph = Graph::default();
        let pair = (direction, d.directions.second);
        let outputs = square(&mut graph, &d.symbols, &BTreeMap::new(), &d.jacobian, pair);
        let documentation = docs::of(&equations, "momentum_jacobian", &graph, &outputs);
        methods.extend(self.method_of_increment(
            "momentum_jacobian",
            &documentation,
            &graph,
            &outputs,
            &self.header.square(),
        ));
        let (graph, outputs) = self.scalar(&d.energy);
        let documentation = docs::of(&equations, "discrete_energy", &graph, &outputs);
        methods.extend(self.method_of_increment(
            "discrete_energy",
            &documentation,
            &graph,
            &outputs,
            &self.header.scalar,
        ));
        methods.extend(self.limit(&equations));
        (methods, equations)
    }

    fn scalar(&self, expression: &Expression) -> (Graph, Vec<NodeId>) {
        let mut graph = Graph::default();
        let mut scalariser = Scalariser { graph: &mut graph, symbols: &self.derived.symbols, given: BTreeMap::new() };
        let output = scalariser.scalar(expression);
        (graph, vec![output])
    }

    fn method_of_increment(
        &self,
        name: &str,
        documentation: &str,
        graph: &Graph,
        outputs: &[NodeId],
        result: &TokenStream,
    ) -> TokenStream {
        let span = Span::mixed_site();
        let name = syn::Ident::new(name, span);
        let (matrix, scalar) = (self.header.square(), &self.header.scalar);
        let root = &self.header.root;
        let body = self.body(graph, outputs, &|id| self.input_token(id));
        quote_spanned! {span=>
            #[doc = #documentation]
            fn #name(&self, f: &#matrix, w: &<Self as #root::DiscreteLagrangian>::Advected, h: #scalar) -> #result {
                #body
            }
        }
    }

    fn limit(&self, equations: &[docs::Equation]) -> TokenStream {
        let d = self.derived;
        let span = Span::mixed_site();
        let root = &self.header.root;
        let mut graph = Graph::default();
        let pair = (d.directions.first, d.directions.second);
        let outputs = square(&mut graph, &d.symbols, &BTreeMap::new(), &d.limit.inertia, pair);
        let inertia_text = docs::of(equations, "inertia", &graph, &outputs);
        let inertia = self.body(&graph, &outputs, &|id| self.input_token(id));
        let mut graph = Graph::default();
        let outputs = components(&mut graph, &d.symbols, &BTreeMap::new(), &d.limit.bias, d.directions.first);
        let bias_text = docs::of(equations, "momentum_bias", &graph, &outputs);
        let bias = self.body(&graph, &outputs, &|id| self.input_token(id));
        let (graph, outputs) = self.scalar(&d.limit.potential);
        let potential_text = docs::of(equations, "potential", &graph, &outputs);
        let potential = self.body(&graph, &outputs, &|id| self.input_token(id));
        let (vector, square, scalar) = (self.header.vector(), self.header.square(), &self.header.scalar);
        quote_spanned! {span=>
            #[doc = #inertia_text]
            fn inertia(&self) -> #square { #inertia }

            #[doc = #bias_text]
            fn momentum_bias(&self, w: &<Self as #root::DiscreteLagrangian>::Advected) -> #vector { #bias }

            #[doc = #potential_text]
            fn potential(&self, w: &<Self as #root::DiscreteLagrangian>::Advected) -> #scalar { #potential }
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
