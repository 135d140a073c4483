//! The stand-in for the implementation after a mistake, so that one mistake gives one error.

use proc_macro2::{Span, TokenStream, TokenTree};
use quote::{quote, quote_spanned};
use syn::{Item, ItemStruct};

use super::Header;
use crate::declared::errors::Errors;
use crate::declared::parse;
use crate::declared::{Declaration, Role};

/// The item with all mistakes and a stand-in for its implementation.
pub(crate) fn mistakes(role: Role, arguments: TokenStream, item: &TokenStream, errors: &Errors) -> TokenStream {
    let mistakes: TokenStream = errors.iter().map(syn::Error::to_compile_error).collect();
    let stand_in = stand_in(role, arguments, item);
    quote!(#item #mistakes #stand_in)
}

/// An implementation with the types of the real one.
fn stand_in(role: Role, arguments: TokenStream, item: &TokenStream) -> TokenStream {
    let Some(item) = as_struct(item).filter(|item| parse::declared_again(item).is_none()) else {
        return TokenStream::new();
    };
    let mut silent = Errors::default();
    let declaration = parse::as_far_as_readable(role, without_lagrangian(role, arguments), item, &mut silent);
    let header = Header::new(&declaration);
    match role {
        Role::Constraint => constraint(&header),
        Role::Lagrangian | Role::Force | Role::Nonholonomic | Role::Hamiltonian => of_effect(&declaration, &header),
    }
}

/// The stand-in of a Lagrangian, a force or a constraint on velocities.
fn of_effect(declaration: &Declaration, header: &Header) -> TokenStream {
    let (span, private) = (Span::mixed_site(), &header.private);
    let none = quote_spanned!(span=> ());
    let types = header.types("WithKinetic", &none, &none);
    let (vector, square, matrix, scalar) = (header.vector(), header.square(), header.matrix(), &header.scalar);
    let effect = header.implementation("Effect");
    let addition = header.addition();
    let lanes = super::lanes::lanes(header, None);
    let core = quote_spanned!(span=> #private::core);
    let of_role = of_role(declaration, header);
    let gradients = declaration.gradients.map(|_| gradients(header));
    let term = header.term(&quote_spanned! {span=>
        fn validate(&self) -> #core::result::Result<(), #private::SetupError> { loop {} }
        fn advected(&self) -> Self::Advected { loop {} }
    });
    let implementations = quote_spanned! {span=>
        #term

        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic)]
        #of_role

        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic)]
        #effect {
            #types
            // Whatever asks for a simple limit compiles.
            const FACTS: #private::Facts =
                #private::Facts { has_constant_inertia: true, is_quadratic: true, ..#private::Facts::ANY };
            const DERIVATION: &'static #core::primitive::str = "";
            fn describe(&self, _: &mut dyn #private::SceneVisitor<#scalar>) { loop {} }
            fn momentum_jacobian(&self, _: &#matrix, _: &Self::Advected, _: #scalar) -> #square { loop {} }
            fn limit(&self, _: #core::option::Option<&#vector>, _: &Self::Advected) -> #private::Limit<Self> { loop {} }
            fn constants(&self, _: #scalar) -> Self::Constants {}
            fn kick_before(_: &Self::Constants, _: &Self::Advected) -> #vector { loop {} }
            fn step_terms(_: &Self::Constants, _: &#vector, _: &Self::Advected) -> Self::StepTerms {}
            fn newton_system(_: &Self::Constants, _: &Self::StepTerms, _: &#vector) -> (#vector, #square) { loop {} }
            fn kick_after(_: &Self::Constants, _: &#matrix, _: &Self::Advected) -> #vector { loop {} }
        }

        #gradients
        #addition
        #lanes
    };
    header.enclosing(implementations)
}

/// The implementations of a declaration besides that of an effect.
fn of_role(declaration: &Declaration, header: &Header) -> TokenStream {
    let (span, private) = (Span::mixed_site(), &header.private);
    let (vector, square, matrix, scalar) = (header.vector(), header.square(), header.matrix(), &header.scalar);
    let core = quote_spanned!(span=> #private::core);
    let of_increment = [
        ("right_momentum", &vector),
        ("left_momentum", &vector),
        ("diamond", &vector),
        ("discrete_energy", scalar),
        ("l_d", scalar),
    ];
    let of_increment = of_increment.map(|(name, result)| {
        let name = syn::Ident::new(name, span);
        quote_spanned!(span=> fn #name(&self, _: &#matrix, _: &Self::Advected, _: #scalar) -> #result { loop {} })
    });
    match declaration.role {
        Role::Lagrangian => {
            let (lagrangian, invariance) =
                (header.implementation("DiscreteLagrangian"), header.implementation("LeftInvariant"));
            let continuous = header.implementation("ContinuousLagrangian");
            quote_spanned! {span=>
                #lagrangian {
                    #(#of_increment)*
                }

                #[automatically_derived]
                #invariance {}

                #[automatically_derived]
                #[allow(clippy::all, clippy::pedantic)]
                #continuous {
                    const LEGENDRE: #private::Legendre = #private::Legendre::Constant;
                    const CONTINUOUS_DERIVATION: &'static #core::primitive::str = "";
                    fn l(&self, _: &#vector, _: &Self::Advected) -> #scalar { loop {} }
                    fn momentum(&self, _: &#vector, _: &Self::Advected) -> #vector { loop {} }
                    fn velocity_hessian(&self, _: &#vector, _: &Self::Advected) -> #square { loop {} }
                    fn diamond_rate(&self, _: &#vector, _: &Self::Advected) -> #vector { loop {} }
                    fn diamond_matrix(&self, _: &#vector, _: &Self::Advected) -> #matrix { loop {} }
                    fn momentum_advection(&self, _: &#vector, _: &Self::Advected) -> #vector { loop {} }
                }
            }
        }
        Role::Nonholonomic => {
            let constraint = header.implementation("Nonholonomic");
            quote_spanned! {span=>
                #constraint {
                    fn zero(&self, _: &#vector, _: &Self::Advected) -> #scalar { loop {} }
                    fn at_increment(&self, _: &#matrix, _: &Self::Advected, _: #scalar) -> #scalar { loop {} }
                    fn slope(&self, _: &#matrix, _: &Self::Advected, _: #scalar) -> #vector { loop {} }
                    fn reaction(&self, _: &Self::Advected) -> #vector { loop {} }
                }
            }
        }
        Role::Force | Role::Constraint | Role::Hamiltonian => {
            let force = header.implementation("Force");
            quote_spanned! {span=>
                #force {
                    fn virtual_work(
                        &self, _: &#matrix, _: &Self::Advected, _: #scalar, _: &#vector, _: &#vector,
                    ) -> #scalar {
                        loop {}
                    }
                }
            }
        }
    }
}

/// The stand-in of a constraint, with one function: their number isn't known.
fn constraint(header: &Header) -> TokenStream {
    let (span, private) = (Span::mixed_site(), &header.private);
    let (core, implementation) =
        (quote_spanned!(span=> #private::core), header.constraint(&proc_macro2::Literal::usize_unsuffixed(1)));
    let real = quote_spanned!(span=> #core::primitive::f64);
    let items = quote_spanned! {span=>
        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic)]
        #implementation {
            fn validate(&self) -> #core::result::Result<(), #private::SetupError> { loop {} }
            fn name(&self) -> &'static #core::primitive::str { loop {} }
            fn gap(&self, _: &#private::Place, _: &#private::Place) -> #private::nalgebra::SVector<#real, 1> { loop {} }
            fn slope(&self, _: &#private::Place, _: &#private::Place) -> [#private::Slope<1>; 2] { loop {} }
            fn describe(&self, _: &mut dyn #core::ops::FnMut(&'static #core::primitive::str, #real)) { loop {} }
        }
    };
    header.enclosing(items)
}

/// The stand-in of the derivatives of a step.
fn gradients(header: &Header) -> TokenStream {
    let (span, private, implementation) =
        (Span::mixed_site(), &header.private, header.implementation("SecondDerivatives"));
    let (vector, square, scalar) = (header.vector(), header.square(), &header.scalar);
    let core = quote_spanned!(span=> #private::core);
    let point = quote_spanned!(span=> #private::StepPoint<'_, Self::Group, Self::Advected>);
    let visits = ["by_parameters", "by_advected"].map(|name| {
        let name = syn::Ident::new(name, span);
        quote_spanned! {span=>
            fn #name(
                &self, _: #point,
                _: &mut impl #core::ops::FnMut(#core::primitive::usize, #vector, #vector),
            ) {
                loop {}
            }
        }
    });
    quote_spanned! {span=>
        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic)]
        #implementation {
            const PARAMETERS: #core::primitive::usize = 0;
            fn step_derivatives(&self, _: #point) -> #private::StepDerivatives<#square> { loop {} }
            #(#visits)*
            fn carried_parameters(_: &mut impl #core::ops::FnMut(#core::primitive::usize, #core::primitive::usize)) {}
            fn adjoint_system(&self, _: #point, _: &#vector) -> (#square, #vector) { loop {} }
            fn adjoint_gradient(
                &self, _: #point, _: [&#vector; 2],
                _: &mut impl #core::ops::FnMut(#core::primitive::usize, #scalar),
            ) -> (#vector, Self::Advected) {
                loop {}
            }
        }
    }
}

/// The struct, or one of the same name for an enum.
fn as_struct(item: &TokenStream) -> Option<ItemStruct> {
    match syn::parse2(item.clone()).ok()? {
        Item::Struct(item) => Some(item),
        Item::Enum(item) => {
            let name = &item.ident;
            Some(ItemStruct { generics: item.generics, ..syn::parse_quote!(struct #name;) })
        }
        _ => None,
    }
}

/// The arguments without the expression, which may be too large to be parsed.
fn without_lagrangian(role: Role, arguments: TokenStream) -> TokenStream {
    let mut is_lagrangian = false;
    let other = arguments.into_iter().filter(|token| {
        is_lagrangian |= matches!(token, TokenTree::Ident(key) if key == role.key() || key == "l");
        let is_other = !is_lagrangian;
        is_lagrangian &= !matches!(token, TokenTree::Punct(comma) if comma.as_char() == ',');
        is_other
    });
    other.collect()
}
