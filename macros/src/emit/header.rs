//! Types and generics of the implementation.

use proc_macro2::{Span, TokenStream};
use quote::{ToTokens as _, quote_spanned};
use syn::{Ident, Path};

use crate::ast::{Declaration, Scalar};

/// What the signatures are written with.
pub(crate) struct Header {
    pub(crate) root: Path,
    group: Path,
    pub(crate) scalar: TokenStream,
    /// The type parameter, if the scalar is one.
    pub(crate) parameter: Option<Ident>,
    name: Ident,
    generics: syn::Generics,
    advected: usize,
}

impl Header {
    pub(crate) fn new(declaration: &Declaration) -> Self {
        let (scalar, parameter) = match &declaration.scalar {
            // The primitive type even where the name is shadowed.
            Scalar::Primitive(name) => {
                let root = &declaration.root;
                (quote_spanned!(Span::mixed_site()=> #root::__private::core::primitive::#name), None)
            }
            Scalar::Parameter(name) => (name.to_token_stream(), Some(name.clone())),
        };
        Self {
            root: declaration.root.clone(),
            group: declaration.group.clone(),
            scalar,
            parameter,
            name: declaration.item.ident.clone(),
            generics: declaration.item.generics.clone(),
            advected: declaration.advected.len(),
        }
    }

    pub(crate) fn vector(&self) -> TokenStream {
        let (root, scalar) = (&self.root, &self.scalar);
        quote_spanned!(Span::mixed_site()=> #root::__private::nalgebra::Vector3<#scalar>)
    }

    pub(crate) fn square(&self) -> TokenStream {
        let (root, scalar) = (&self.root, &self.scalar);
        quote_spanned!(Span::mixed_site()=> #root::__private::nalgebra::Matrix3<#scalar>)
    }

    /// `impl … DiscreteLagrangian for …`.
    pub(crate) fn implementation(&self) -> TokenStream {
        let (root, name) = (&self.root, &self.name);
        let mut generics = self.generics.clone();
        if let Some(parameter) = &self.parameter {
            generics.make_where_clause().predicates.push(syn::parse_quote!(#parameter: #root::Real));
        }
        let (before, _, _) = generics.split_for_impl();
        let (_, arguments, _) = self.generics.split_for_impl();
        let (_, _, conditions) = generics.split_for_impl();
        quote_spanned!(Span::mixed_site()=> impl #before #root::DiscreteLagrangian for #name #arguments #conditions)
    }

    pub(crate) fn types(&self, constants: &TokenStream, step_terms: &TokenStream) -> TokenStream {
        let (root, group, scalar, vector) = (&self.root, &self.group, &self.scalar, self.vector());
        let vectors = (0..self.advected).map(|_| &vector);
        let advected =
            if self.advected == 1 { vector.clone() } else { quote_spanned!(Span::mixed_site()=> (#(#vectors),*)) };
        quote_spanned! {Span::mixed_site()=>
            type Scalar = #scalar;
            type Group = #group<#scalar>;
            type Retraction = #root::CayleyRetraction;
            type Advected = #advected;
            type Constants = #constants;
            type StepTerms = #step_terms;
        }
    }
}
