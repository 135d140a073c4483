//! What stands in for the implementation after a mistake, so that one mistake gives one error.

use proc_macro2::{Span, TokenStream};
use quote::quote_spanned;
use syn::ItemStruct;

use crate::parse;

/// An implementation that type-checks wherever the real one would be used.
pub(crate) fn stand_in(arguments: &TokenStream, item: &ItemStruct) -> TokenStream {
    let span = Span::mixed_site();
    let root = parse::root(arguments);
    let mut silent = crate::errors::Errors::default();
    // Without a readable Lagrangian the shape of the advected parameters is still in the arguments, if they parse.
    let declaration = parse::parse(arguments.clone(), item.clone(), &mut silent);
    let header = declaration.as_ref().map(crate::emit::Header::new);
    let Some(header) = header else {
        return TokenStream::new();
    };
    let none = quote_spanned!(span=> ());
    let types = header.types(&none, &none);
    let (vector, square, matrix, scalar) = (header.vector(), header.square(), header.matrix(), &header.scalar);
    let implementation = header.implementation();
    let core = quote_spanned!(span=> #root::__private::core);
    let of_increment = [
        ("right_momentum", &vector),
        ("left_momentum", &vector),
        ("diamond", &vector),
        ("momentum_jacobian", &square),
        ("discrete_energy", scalar),
        ("l_d", scalar),
    ];
    let of_increment = of_increment.map(|(name, result)| {
        let name = syn::Ident::new(name, span);
        quote_spanned!(span=> fn #name(&self, _: &#matrix, _: &Self::Advected, _: #scalar) -> #result { loop {} })
    });
    quote_spanned! {span=>
        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic)]
        #implementation {
            #types
            const DERIVATION: &'static #core::primitive::str = "";
            fn validate(&self) -> #core::result::Result<(), #root::SetupError> { loop {} }
            fn advected(&self) -> Self::Advected { loop {} }
            #(#of_increment)*
            fn inertia(&self) -> #square { loop {} }
            fn momentum_bias(&self, _: &Self::Advected) -> #vector { loop {} }
            fn potential(&self, _: &Self::Advected) -> #scalar { loop {} }
            fn constants(&self, _: #scalar) -> Self::Constants {}
            fn kick_before(_: &Self::Constants, _: &Self::Advected) -> #vector { loop {} }
            fn step_terms(_: &Self::Constants, _: &#vector, _: &Self::Advected) -> Self::StepTerms {}
            fn newton_system(_: &Self::Constants, _: &Self::StepTerms, _: &#vector) -> (#vector, #square) { loop {} }
            fn kick_after(_: &Self::Constants, _: &#matrix, _: &Self::Advected) -> #vector { loop {} }
        }
    }
}
