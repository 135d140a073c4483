//! The lanes of a declaration that is generic over its scalar: `Lanes` and `InLanes`, field by field.

use proc_macro2::{Group, Span, TokenStream, TokenTree};
use quote::{ToTokens as _, quote_spanned};
use syn::Ident;

use super::Header;
use crate::declared::{Field, FieldKind};

/// Both implementations; without fields, after a mistake, with bodies that never come to an end.
pub(super) fn lanes(header: &Header, fields: Option<&[Field]>) -> TokenStream {
    let Some(parameter) = &header.parameter else { return TokenStream::new() };
    let (span, private, name) = (Span::mixed_site(), &header.private, &header.name);
    // A name that no type of the user's has.
    let several = Ident::new("LiestepLanes", span);
    let of_several = |tokens: TokenStream| renamed(tokens, parameter, &several);
    let mut generics = header.generics.clone();
    let where_clause = generics.make_where_clause();
    where_clause.predicates.push(syn::parse_quote!(#parameter: #private::Real));
    // A `RealField` has one lane, and is its element. That it might have another would be a contradiction.
    let several = if names(header.generics.to_token_stream(), &["RealField", "ComplexField"])
        || names(header.generics.where_clause.to_token_stream(), &["RealField", "ComplexField"])
    {
        parameter.clone()
    } else {
        let asked = header.generics.where_clause.iter().flat_map(|clause| &clause.predicates);
        let asked = asked.map(|predicate| syn::parse2(of_several(predicate.to_token_stream()))).filter_map(Result::ok);
        where_clause.predicates.extend::<Vec<syn::WherePredicate>>(asked.collect());
        let is_of_them = quote_spanned!(span=> #private::nalgebra::SimdValue<Element = #parameter>);
        where_clause.predicates.push(syn::parse_quote!(#several: #private::Real + #is_of_them));
        let bounds = header.generics.type_params().find(|of| of.ident == *parameter).map(|of| &of.bounds);
        let bounds = of_several(bounds.to_token_stream());
        generics.params.push(syn::parse_quote!(#several: #bounds));
        several.clone()
    };
    let (before, _, conditions) = generics.split_for_impl();
    let (_, arguments, _) = header.generics.split_for_impl();
    let together = renamed(arguments.to_token_stream(), parameter, &several);
    let [splat, lane, set_lane] =
        fields.map_or_else(|| [0; 3].map(|_| quote_spanned!(span=> loop {})), |fields| bodies(header, fields));
    let core = quote_spanned!(span=> #private::core);
    quote_spanned! {span=>
        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic, clippy::nursery)]
        impl #before #private::Lanes for #name #together #conditions {
            type Lane = #name #arguments;

            fn splat(lane: &Self::Lane) -> Self { #splat }

            fn lane(&self, k: #core::primitive::usize) -> Self::Lane { #lane }

            fn set_lane(&mut self, k: #core::primitive::usize, lane: &Self::Lane) -> #core::primitive::bool { #set_lane }
        }

        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic, clippy::nursery)]
        impl #before #private::InLanes<#several> for #name #arguments #conditions {
            type Together = #name #together;
        }
    }
}

fn bodies(header: &Header, fields: &[Field]) -> [TokenStream; 3] {
    let (span, name) = (Span::mixed_site(), &header.name);
    let each = |scalar: fn(&TokenStream, &Ident) -> TokenStream, other: fn(&TokenStream, &Ident) -> TokenStream| {
        let of_field = |field: &Field| {
            let private = header.private_at(field.at.resolved_at(span));
            let made = if field.kind == FieldKind::Scalar { scalar } else { other };
            made(&private, &field.name)
        };
        fields.iter().map(of_field).collect::<Vec<TokenStream>>()
    };
    let splat = each(
        |private, field| quote_spanned!(Span::mixed_site()=> #field: #private::nalgebra::SimdValue::splat(lane.#field)),
        |private, field| quote_spanned!(Span::mixed_site()=> #field: #private::Lanes::splat(&lane.#field)),
    );
    let lane = each(
        |private, field| quote_spanned!(Span::mixed_site()=> #field: #private::nalgebra::SimdValue::extract(&self.#field, k)),
        |private, field| quote_spanned!(Span::mixed_site()=> #field: #private::Lanes::lane(&self.#field, k)),
    );
    let set_lane = each(
        |private, field| {
            quote_spanned! {Span::mixed_site()=>
                { #private::nalgebra::SimdValue::replace(&mut self.#field, k, lane.#field); true }
            }
        },
        |private, field| quote_spanned!(Span::mixed_site()=> #private::Lanes::set_lane(&mut self.#field, k, &lane.#field)),
    );
    [
        quote_spanned!(span=> #name { #(#splat),* }),
        quote_spanned!(span=> #name { #(#lane),* }),
        quote_spanned!(span=> true #(&& #set_lane)*),
    ]
}

/// Whether one of these names is among the tokens.
fn names(tokens: TokenStream, any: &[&str]) -> bool {
    tokens.into_iter().any(|token| match token {
        TokenTree::Ident(ident) => any.iter().any(|name| ident == name),
        TokenTree::Group(group) => names(group.stream(), any),
        _ => false,
    })
}

/// The tokens with another name in the place of one.
fn renamed(tokens: TokenStream, name: &Ident, other: &Ident) -> TokenStream {
    let rename = |token| match token {
        TokenTree::Ident(ident) if ident == *name => TokenTree::Ident(other.clone()),
        TokenTree::Group(group) => {
            let inner = renamed(group.stream(), name, other);
            TokenTree::Group(Group::new(group.delimiter(), inner))
        }
        token => token,
    };
    tokens.into_iter().map(rename).collect()
}
