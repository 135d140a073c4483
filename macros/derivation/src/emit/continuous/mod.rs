//! The implementation of `ContinuousLagrangian`.

pub(super) mod text;

use proc_macro2::{Span, TokenStream};
use quote::quote_spanned;
use syn::Ident;

use super::{Code, Emitter, Header, docs, page, stages, verbatim};
use crate::declared::{Coordinates, Declaration, Discretisation, Quadrature};
use crate::judged::Equations;
use crate::mathematics::derive::Inverse;
use crate::mathematics::symbolic::Expression;
use crate::program::{Form, Graph, along_directions, diamond_matrices};

/// The item with the continuous equations alone.
pub(crate) fn alone(item: &TokenStream, declaration: &Declaration, equations: &Equations) -> TokenStream {
    let header = Header::new(declaration);
    let implementation = implementation(declaration, &header, equations, false);
    let code = Code {
        declaration,
        header: &header,
        names: &equations.names,
        symbols: &equations.derived.symbols,
        directions: None,
    };
    let term = code.term(&stages::same_generators(&code));
    let addition = header.addition();
    let item = page::documented(item, &text::page(declaration, equations));
    let implementations = header.enclosing(quote_spanned!(Span::mixed_site()=> #term #implementation #addition));
    quote_spanned!(Span::mixed_site()=> #item #implementations)
}

/// The continuous equations of a declared `l`, or of the limit of `l_d`. If there is a step, its effect has the
/// inertia.
pub(super) fn implementation(
    declaration: &Declaration,
    header: &Header,
    equations: &Equations,
    has_step: bool,
) -> TokenStream {
    let (span, derived, private) = (Span::mixed_site(), &equations.derived, &header.private);
    let code = Code { declaration, header, names: &equations.names, symbols: &derived.symbols, directions: None };
    let texts = text::equations(declaration, equations);
    let method =
        |name: &str, rank, form, expression| code.continuous_method(name, rank, form, expression, equations, &texts);
    let l = match declaration.continuous {
        Some(_) => verbatim::declared(declaration, header),
        None => method("l", 0, Form::Scalar, &derived.lagrangian),
    };
    let methods: TokenStream = [
        method("momentum", 1, Form::Vector, &derived.momentum),
        if has_step && derived.inverse != Inverse::Nonlinear {
            of_effect(header)
        } else {
            method("velocity_hessian", 2, Form::Square, &derived.hessian)
        },
        method("diamond_rate", 1, Form::Vector, &derived.diamond),
        method("momentum_advection", 1, Form::Vector, &derived.advection),
        code.diamond_matrix(equations),
    ]
    .into_iter()
    .collect();
    let legendre = match derived.inverse {
        Inverse::Constant => "Constant",
        Inverse::Varying => "Varying",
        Inverse::Nonlinear => "Nonlinear",
    };
    let legendre = Ident::new(legendre, span);
    let derivation = text::derivation(declaration, equations);
    let documentation = format!("```text\n{derivation}```");
    let implementation = header.implementation("ContinuousLagrangian");
    quote_spanned! {span=>
        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic, clippy::nursery, non_snake_case, unused_variables)]
        #implementation {
            const LEGENDRE: #private::Legendre = #private::Legendre::#legendre;

            #[doc = #documentation]
            const CONTINUOUS_DERIVATION: &'static #private::core::primitive::str = {
                // A block instead of the value: rustdoc would show it with each letter escaped that isn't ASCII.
                const TEXT: &#private::core::primitive::str = #derivation;
                TEXT
            };

            #l
            #methods
        }
    }
}

/// The second derivative by the velocity, which is the inertia of the step.
fn of_effect(header: &Header) -> TokenStream {
    let (private, vector, square) = (&header.private, header.vector(), header.square());
    quote_spanned! {Span::mixed_site()=>
        fn velocity_hessian(&self, _: &#vector, w: &Self::Advected) -> #square {
            #private::Effect::limit(self, #private::core::option::Option::None, w).hessian
        }
    }
}

/// The limit of an `l` that isn't quadratic in the velocity.
pub(super) fn at_velocity(private: &syn::Path, equations: &Equations) -> Option<TokenStream> {
    (equations.derived.inverse == Inverse::Nonlinear).then(|| {
        quote_spanned! {Span::mixed_site()=>
            if let #private::core::option::Option::Some(velocity) = velocity {
                return #private::Limit {
                    l: #private::ContinuousLagrangian::l(self, velocity, w),
                    momentum: #private::ContinuousLagrangian::momentum(self, velocity, w),
                    hessian: #private::ContinuousLagrangian::velocity_hessian(self, velocity, w),
                };
            }
        }
    })
}

/// The method `l_d`, discretised from `l`.
pub(super) fn discretised(emitter: &Emitter, discretisation: Discretisation) -> TokenStream {
    let (span, header) = (Span::mixed_site(), emitter.header);
    let (private, square, scalar) = (&header.private, header.matrix(), &header.scalar);
    let name = match discretisation.quadrature {
        Quadrature::Trapezoid => "trapezoid",
        Quadrature::Chord => "chord",
        // The midpoint rule uses the derived expression.
        Quadrature::Midpoint => "",
    };
    // The discretisation at run time, with the Cayley map, shares nothing with the derivation.
    if discretisation.coordinates == Coordinates::Cayley && !name.is_empty() {
        let name = Ident::new(name, span);
        return quote_spanned! {span=>
            /// The discrete Lagrangian as it is made from the declared `l`.
            fn l_d(&self, f: &#square, w: &<Self as #private::Term>::Advected, h: #scalar) -> #scalar {
                #private::#name::<Self, #private::CayleyRetraction>(self, f, w, h)
            }
        };
    }
    let lagrangian = &emitter.lowered.declared.expression;
    let equations = docs::equations(emitter.derived, &emitter.lowered.declared, emitter.equations);
    let l_d = emitter.kernel.beginning.term(emitter.derived, Form::Scalar, lagrangian);
    emitter.method("l_d", Form::Scalar, &l_d, &equations)
}

impl Code<'_> {
    /// A term as a method, with its equation as documentation.
    fn continuous_method(
        &self,
        name: &str,
        rank: usize,
        form: Form,
        expression: &Expression,
        equations: &Equations,
        texts: &[docs::Equation],
    ) -> TokenStream {
        let (span, header) = (Span::mixed_site(), self.header);
        let mut graph = Graph::default();
        let outputs = along_directions(&mut graph, &equations.derived, rank, expression);
        let documentation = docs::of(texts, &[name], &graph, &outputs);
        let body = self.body(form, &graph, &outputs, &|input| self.input_token(input));
        let result = header.of(form);
        let (name, vector) = (Ident::new(name, span), header.vector());
        quote_spanned! {span=>
            #[doc = #documentation]
            fn #name(&self, velocity: &#vector, w: &Self::Advected) -> #result { #body }
        }
    }

    /// The diamond along all matrices.
    fn diamond_matrix(&self, equations: &Equations) -> TokenStream {
        let (span, header) = (Span::mixed_site(), self.header);
        let mut graph = Graph::default();
        let blocks = diamond_matrices(&mut graph, &equations.derived);
        let documentation = docs::of(&[], &[], &graph, &blocks.concat());
        let body = self.blocks(&graph, &blocks, &|input| self.input_token(input));
        let (vector, matrix) = (header.vector(), header.matrix());
        quote_spanned! {span=>
            #[doc = #documentation]
            fn diamond_matrix(&self, velocity: &#vector, w: &Self::Advected) -> #matrix { #body }
        }
    }
}
