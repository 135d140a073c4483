//! `Lanes` and `InLanes`, field by field: of declarations that are generic over their scalar, and of liestep's own types.

use proc_macro2::{Group, Span, TokenStream, TokenTree};
use quote::{ToTokens, format_ident, quote_spanned};
use syn::{Generics, Ident, Member, Type, WherePredicate, parse_quote};

use super::Header;
use crate::declared::{Field, FieldKind};

/// A struct with lanes.
struct Struct<'a> {
    private: TokenStream,
    name: &'a Ident,
    /// The generics of the type with one lane.
    generics: &'a Generics,
    /// The parameters that differ between one lane and several.
    parameters: Vec<Parameter>,
    /// The bounds on the fields.
    conditions: Vec<WherePredicate>,
    /// The fields; without them, after a mistake, the bodies are endless loops.
    parts: Option<Vec<Part>>,
}

/// A type parameter for one lane, and its counterpart for several.
struct Parameter {
    one: Ident,
    several: Ident,
    is_scalar: bool,
}

/// A field.
struct Part {
    /// `private` with the span for errors.
    private: TokenStream,
    member: Member,
    kind: Kind,
}

#[derive(Clone, Copy)]
enum Kind {
    Scalar,
    Lanes,
    /// A field with one value for all lanes.
    Shared,
}

/// Both implementations of a declaration.
pub(super) fn lanes(header: &Header, fields: Option<&[Field]>) -> TokenStream {
    let Some(scalar) = &header.parameter else { return TokenStream::new() };
    let span = Span::mixed_site();
    let part = |field: &Field| Part {
        private: header.private_at(field.at.resolved_at(span)),
        member: field.name.clone().into(),
        kind: if field.kind == FieldKind::Scalar { Kind::Scalar } else { Kind::Lanes },
    };
    // A `RealField` has one lane, and is its own element; a second lane would contradict that.
    let is_single = [header.generics.to_token_stream(), header.generics.where_clause.to_token_stream()]
        .into_iter()
        .any(|bounds| names(bounds, &["RealField", "ComplexField"]));
    let several = if is_single { scalar.clone() } else { header.free_name("Several") };
    let target = Struct {
        private: header.private.to_token_stream(),
        name: &header.name,
        generics: &header.generics,
        parameters: vec![Parameter { one: scalar.clone(), several, is_scalar: true }],
        conditions: Vec::new(),
        parts: fields.map(|fields| fields.iter().map(part).collect()),
    };
    let (lanes, in_lanes) = (target.lanes(), target.in_lanes());
    quote_spanned!(span=> #lanes #in_lanes)
}

/// `Lanes` or `InLanes` of a struct of liestep.
///
/// `T` is the scalar. Other type parameters have lanes, unless they stand in fields marked `#[shared]` only.
pub(crate) fn derived(item: &syn::ItemStruct, is_in_lanes: bool) -> TokenStream {
    let private = quote_spanned!(Span::mixed_site()=> ::liestep::__private);
    let mentions = |field: &syn::Field, of: &Ident| names(field.ty.to_token_stream(), &[&of.to_string()]);
    let differs = |of: &&Ident| item.fields.iter().any(|field| !is_shared(field) && mentions(field, of));
    let parameters: Vec<Parameter> = (item.generics.type_params().map(|parameter| &parameter.ident).filter(differs))
        .map(|one| Parameter { one: one.clone(), several: format_ident!("{one}Together"), is_scalar: one == "T" })
        .collect();
    let condition = |field: &syn::Field| -> Option<WherePredicate> {
        let (one, several) = (&field.ty, renamed(field.ty.to_token_stream(), &parameters));
        if !item.generics.type_params().any(|parameter| mentions(field, &parameter.ident)) {
            return None;
        }
        match kind(field) {
            Kind::Shared => Some(parse_quote!(#one: Clone + PartialEq)),
            // The bounds of the parameter include this one.
            _ if matches!(one, Type::Path(path) if path.path.get_ident().is_some()) => None,
            Kind::Scalar => Some(parse_quote!(#several: #private::nalgebra::SimdValue<Element = #one>)),
            Kind::Lanes => Some(parse_quote!(#several: #private::Lanes<Lane = #one>)),
        }
    };
    let part = |(member, field)| Part { private: private.clone(), member, kind: kind(field) };
    let target = Struct {
        private: private.clone(),
        name: &item.ident,
        generics: &item.generics,
        conditions: item.fields.iter().filter_map(condition).collect(),
        parts: Some(item.fields.members().zip(&item.fields).map(part).collect()),
        parameters,
    };
    if is_in_lanes { target.in_lanes() } else { target.lanes() }
}

fn is_shared(field: &syn::Field) -> bool {
    field.attrs.iter().any(|attribute| attribute.path().is_ident("shared"))
}

fn kind(field: &syn::Field) -> Kind {
    match &field.ty {
        _ if is_shared(field) => Kind::Shared,
        Type::Path(path) if path.path.is_ident("T") => Kind::Scalar,
        Type::Path(path) if path.path.segments.last().is_some_and(|last| last.ident == "Scalar") => Kind::Scalar,
        _ => Kind::Lanes,
    }
}

impl Struct<'_> {
    fn lanes(&self) -> TokenStream {
        let (private, name, generics) = (&self.private, self.name, self.generics_of_both());
        let (before, _, conditions) = generics.split_for_impl();
        let (_, arguments, _) = self.generics.split_for_impl();
        let together = renamed(arguments.to_token_stream(), &self.parameters);
        let [splat, lane, set_lane] = match &self.parts {
            Some(parts) => self.bodies(parts),
            None => [0; 3].map(|_| quote_spanned!(Span::mixed_site()=> loop {})),
        };
        quote_spanned! {Span::mixed_site()=>
            #[automatically_derived]
            #[allow(clippy::all, clippy::pedantic, clippy::nursery, private_bounds)]
            impl #before #private::Lanes for #name #together #conditions {
                type Lane = #name #arguments;

                fn splat(lane: &Self::Lane) -> Self { #splat }

                fn lane(&self, k: #private::core::primitive::usize) -> Self::Lane { #lane }

                fn set_lane(
                    &mut self,
                    k: #private::core::primitive::usize,
                    lane: &Self::Lane,
                ) -> #private::core::primitive::bool {
                    #set_lane
                }
            }
        }
    }

    fn in_lanes(&self) -> TokenStream {
        let (private, name, mut generics) = (&self.private, self.name, self.generics_of_both());
        let scalar = self.parameters.iter().find(|parameter| parameter.is_scalar);
        let wide = scalar.map_or_else(|| format_ident!("Wide"), |scalar| scalar.several.clone());
        if scalar.is_none() {
            generics.params.push(parse_quote!(#wide));
        }
        for Parameter { one, several, .. } in self.parameters.iter().filter(|parameter| !parameter.is_scalar) {
            let is_of_it = parse_quote!(#one: #private::InLanes<#wide, Together = #several>);
            generics.make_where_clause().predicates.push(is_of_it);
        }
        let (before, _, conditions) = generics.split_for_impl();
        let (_, arguments, _) = self.generics.split_for_impl();
        let together = renamed(arguments.to_token_stream(), &self.parameters);
        quote_spanned! {Span::mixed_site()=>
            #[automatically_derived]
            #[allow(clippy::all, clippy::pedantic, clippy::nursery, private_bounds)]
            impl #before #private::InLanes<#wide> for #name #arguments #conditions {
                type Together = #name #together;
            }
        }
    }

    /// The parameters for one lane and for several, with their bounds and the relations between them.
    fn generics_of_both(&self) -> Generics {
        let (private, mut generics) = (&self.private, self.generics.clone());
        let asked = self.generics.where_clause.iter().flat_map(|clause| &clause.predicates);
        let asked = asked.filter_map(|asked| syn::parse2(renamed(asked.to_token_stream(), &self.parameters)).ok());
        let asked: Vec<WherePredicate> = asked.collect();
        let clause = generics.make_where_clause();
        for Parameter { one, several, is_scalar } in &self.parameters {
            if *is_scalar {
                clause.predicates.push(parse_quote!(#one: #private::Real));
            }
            if one == several {
                continue;
            }
            clause.predicates.push(if *is_scalar {
                parse_quote!(#several: #private::Real + #private::nalgebra::SimdValue<Element = #one>)
            } else {
                parse_quote!(#several: #private::Lanes<Lane = #one>)
            });
        }
        clause.predicates.extend(asked);
        clause.predicates.extend(self.conditions.iter().cloned());
        for Parameter { several, one, .. } in
            self.parameters.iter().filter(|parameter| parameter.one != parameter.several)
        {
            let bounds = self.generics.type_params().find(|of| of.ident == *one).map(|of| &of.bounds);
            let bounds = renamed(bounds.to_token_stream(), &self.parameters);
            generics.params.push(parse_quote!(#several: #bounds));
        }
        generics
    }

    /// The bodies of `splat`, `lane` and `set_lane`.
    fn bodies(&self, parts: &[Part]) -> [TokenStream; 3] {
        let (span, name) = (Span::mixed_site(), self.name);
        let splat = parts.iter().map(|Part { private, member, kind }| match kind {
            Kind::Scalar => quote_spanned!(span=> #member: #private::nalgebra::SimdValue::splat(lane.#member)),
            Kind::Lanes => quote_spanned!(span=> #member: #private::Lanes::splat(&lane.#member)),
            Kind::Shared => quote_spanned!(span=> #member: Clone::clone(&lane.#member)),
        });
        let lane = parts.iter().map(|Part { private, member, kind }| match kind {
            Kind::Scalar => quote_spanned!(span=> #member: #private::nalgebra::SimdValue::extract(&self.#member, k)),
            Kind::Lanes => quote_spanned!(span=> #member: #private::Lanes::lane(&self.#member, k)),
            Kind::Shared => quote_spanned!(span=> #member: Clone::clone(&self.#member)),
        });
        let set_lane = parts.iter().map(|Part { private, member, kind }| match kind {
            Kind::Scalar => quote_spanned! {span=>
                { #private::nalgebra::SimdValue::replace(&mut self.#member, k, lane.#member); true }
            },
            Kind::Lanes => quote_spanned!(span=> #private::Lanes::set_lane(&mut self.#member, k, &lane.#member)),
            Kind::Shared => quote_spanned!(span=> self.#member == lane.#member),
        });
        [
            quote_spanned!(span=> #name { #(#splat),* }),
            quote_spanned!(span=> #name { #(#lane),* }),
            quote_spanned!(span=> true #(&& #set_lane)*),
        ]
    }
}

/// Whether one of these names is among the tokens.
fn names(tokens: TokenStream, any: &[&str]) -> bool {
    tokens.into_iter().any(|token| match token {
        TokenTree::Ident(ident) => any.iter().any(|name| ident == name),
        TokenTree::Group(group) => names(group.stream(), any),
        _ => false,
    })
}

/// The tokens with the parameters for several lanes in the place of those for one.
fn renamed(tokens: TokenStream, parameters: &[Parameter]) -> TokenStream {
    let rename = |token| match token {
        TokenTree::Ident(ident) => {
            let of_it = parameters.iter().find(|parameter| ident == parameter.one);
            TokenTree::Ident(of_it.map_or(ident, |parameter| parameter.several.clone()))
        }
        TokenTree::Group(group) => {
            let inner = renamed(group.stream(), parameters);
            TokenTree::Group(Group::new(group.delimiter(), inner))
        }
        token => token,
    };
    tokens.into_iter().map(rename).collect()
}
