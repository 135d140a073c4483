//! Types and generics of the implementation.

use proc_macro2::{Literal, Span, TokenStream, TokenTree};
use quote::{ToTokens as _, quote_spanned};
use syn::{Ident, Path};

use crate::declared::{Declaration, FieldKind, Scalar, Shape};
use crate::mathematics::derive::View;
use crate::mathematics::symbolic::Variance;
use crate::program::Form;

/// The types and generics of the signatures.
pub(crate) struct Header {
    /// The module of liestep that expansions name; no other path of the library is used.
    pub(crate) private: Path,
    /// The path of liestep, if not `::liestep`.
    root: Option<Path>,
    /// The type of each factor of the group.
    group_paths: Vec<Path>,
    pub(crate) scalar: TokenStream,
    /// The type parameter, if the scalar is one.
    pub(crate) parameter: Option<Ident>,
    pub(super) name: Ident,
    pub(super) generics: syn::Generics,
    advected: Vec<(FieldKind, View)>,
    /// The size of the matrices of each factor.
    sizes: Vec<usize>,
    size: usize,
    dimension: usize,
}

impl Header {
    pub(crate) fn new(declaration: &Declaration) -> Self {
        let private: Path = match declaration.root {
            Some(_) => syn::parse_quote_spanned!(Span::mixed_site()=> __liestep),
            None => syn::parse_quote_spanned!(Span::mixed_site()=> ::liestep::__private),
        };
        let paths = declaration
            .factors
            .iter()
            .map(|factor| factor.path.clone().unwrap_or_else(|| syn::parse_quote!(#private::SO3)));
        let group_paths = paths.collect();
        let (scalar, parameter) = match &declaration.scalar {
            // The path finds the primitive type even if its name is shadowed.
            Scalar::Primitive(name) => (quote_spanned!(Span::mixed_site()=> #private::core::primitive::#name), None),
            Scalar::Parameter(name) => (name.to_token_stream(), Some(name.clone())),
        };
        Self {
            private,
            root: declaration.root.clone(),
            group_paths,
            scalar,
            parameter,
            name: declaration.item.ident.clone(),
            generics: declaration.item.generics.clone(),
            advected: (0..)
                .zip(&declaration.advected)
                .map(|(index, w)| (declaration.advected_kind(index), w.seen))
                .collect(),
            sizes: declaration.group.factors().iter().map(|factor| factor.size).collect(),
            size: declaration.group.size,
            dimension: declaration.group.dimension(),
        }
    }

    /// `private` with a span at this place, for errors of its arguments.
    pub(crate) fn private_at(&self, place: Span) -> TokenStream {
        let placed = |mut token: TokenTree| {
            token.set_span(place);
            token
        };
        self.private.to_token_stream().into_iter().map(placed).collect()
    }

    /// The items in the scope of `private`. A path of the user's is written once, so that a wrong one is one error.
    pub(crate) fn enclosing(&self, items: TokenStream) -> TokenStream {
        let Some(root) = &self.root else { return items };
        quote_spanned! {Span::mixed_site()=>
            const _: () = {
                use #root::__private as __liestep;
                #items
            };
        }
    }

    /// The type of the components of covectors.
    pub(crate) fn vector(&self) -> TokenStream {
        self.column(self.dimension)
    }

    /// The type of linear maps of components.
    pub(crate) fn square(&self) -> TokenStream {
        self.matrix_of(self.dimension)
    }

    /// The type of a value of this form.
    pub(crate) fn of(&self, form: Form) -> TokenStream {
        match form {
            Form::Scalar => self.scalar.clone(),
            Form::Vector => self.vector(),
            Form::Square => self.square(),
        }
    }

    /// The type of the group's matrices.
    pub(crate) fn matrix(&self) -> TokenStream {
        let matrices = self.sizes.iter().map(|&size| self.matrix_of(size));
        Self::of_factors(&matrices.collect::<Vec<_>>())
    }

    /// The single type, or a tuple.
    fn of_factors(each: &[TokenStream]) -> TokenStream {
        match each {
            [single] => single.clone(),
            each => quote_spanned!(Span::mixed_site()=> (#(#each),*)),
        }
    }

    /// The value of `I`: of any size where that of the matrices isn't one.
    pub(crate) fn identity(&self, rows: Option<usize>) -> TokenStream {
        let (span, private) = (Span::mixed_site(), &self.private);
        let of_size = |rows: usize| {
            let matrix = self.matrix_of(rows);
            quote_spanned!(span=> <#matrix>::identity())
        };
        rows.map_or_else(|| quote_spanned!(span=> #private::Identity), of_size)
    }

    fn column(&self, rows: usize) -> TokenStream {
        let (private, scalar, rows) = (&self.private, &self.scalar, Literal::usize_unsuffixed(rows));
        quote_spanned!(Span::mixed_site()=> #private::nalgebra::SVector<#scalar, #rows>)
    }

    fn advected_type(&self, (kind, seen): (FieldKind, View)) -> TokenStream {
        let (private, span) = (&self.private, Span::mixed_site());
        let place = Literal::usize_unsuffixed;
        match (seen, kind) {
            (View::Relative { of, from }, FieldKind::Configuration(_) | FieldKind::Place(_)) => {
                let rows = self.sizes.get(of).copied().unwrap_or(self.size);
                let (matrix, of, from) = (self.matrix_of(rows), place(of), place(from));
                quote_spanned!(span=> #private::Relative<#from, #of, #matrix>)
            }
            (View::Configuration(of), FieldKind::Configuration(_) | FieldKind::Place(_)) => {
                let rows = self.sizes.get(of).copied().unwrap_or(self.size);
                let (matrix, of) = (self.matrix_of(rows), place(of));
                quote_spanned!(span=> #private::Configuration<#of, #matrix>)
            }
            (View::From(factor), kind) if self.sizes.len() > 1 && !matches!(kind, FieldKind::Given(_)) => {
                let rows = self.sizes.get(factor).copied().unwrap_or(self.size);
                let (own, factor) = (self.own_advected_type(kind, rows), place(factor));
                quote_spanned!(span=> #private::SeenFrom<#factor, #own>)
            }
            _ => self.own_advected_type(kind, self.size),
        }
    }

    fn own_advected_type(&self, kind: FieldKind, size: usize) -> TokenStream {
        let (variance, rows) = match kind {
            FieldKind::Advected(variance, rows) => (variance, rows),
            FieldKind::Point(rows) => return self.point(rows - 1),
            FieldKind::Given(shape) => return self.given(shape),
            _ => return self.column(size),
        };
        let name =
            Variance::TYPES.iter().find(|(_, own)| *own == variance).map_or("ContravariantVector", |(name, _)| name);
        let (private, scalar, rows) = (&self.private, &self.scalar, Literal::usize_unsuffixed(rows));
        let name = Ident::new(name, Span::mixed_site());
        quote_spanned!(Span::mixed_site()=> #private::#name<#scalar, #rows>)
    }

    fn point(&self, coordinates: usize) -> TokenStream {
        let (private, scalar, coordinates) = (&self.private, &self.scalar, Literal::usize_unsuffixed(coordinates));
        quote_spanned!(Span::mixed_site()=> #private::nalgebra::Point<#scalar, #coordinates>)
    }

    fn given(&self, shape: Shape) -> TokenStream {
        let (rows, columns) = match shape {
            Shape::Scalar => (1, 1),
            Shape::Matrix(rows, columns) => (rows, columns),
        };
        let (private, scalar) = (&self.private, &self.scalar);
        let (rows, columns) = (Literal::usize_unsuffixed(rows), Literal::usize_unsuffixed(columns));
        quote_spanned!(Span::mixed_site()=> #private::Given<#scalar, #rows, #columns>)
    }

    fn matrix_of(&self, rows: usize) -> TokenStream {
        let (private, scalar, rows) = (&self.private, &self.scalar, Literal::usize_unsuffixed(rows));
        quote_spanned!(Span::mixed_site()=> #private::nalgebra::SMatrix<#scalar, #rows, #rows>)
    }

    /// `impl … liestep::Trait for …`.
    pub(crate) fn implementation(&self, name: &str) -> TokenStream {
        let (private, implemented) = (&self.private, Ident::new(name, Span::mixed_site()));
        self.implementation_of(None, &quote_spanned!(Span::mixed_site()=> #private::#implemented))
    }

    /// `impl … liestep::methods::Constraint<…> for …`.
    pub(crate) fn constraint(&self, functions: &Literal) -> TokenStream {
        let private = &self.private;
        self.implementation_of(None, &quote_spanned!(Span::mixed_site()=> #private::Constraint<#functions>))
    }

    /// `impl … Add<Other> for …`: the sum with any term of the same group.
    pub(crate) fn addition(&self) -> TokenStream {
        let (span, private, group) = (Span::mixed_site(), &self.private, self.group());
        let core = quote_spanned!(span=> #private::core);
        let other = self.free_name("Other");
        let bounds = [
            syn::parse_quote_spanned!(span=> #other: #private::Term),
            syn::parse_quote_spanned! {span=>
                <#other as #private::Term>::Group: #private::SharedBy<#group, Self, #other>
            },
        ];
        let added = quote_spanned!(span=> #core::ops::Add<#other>);
        let implementation = self.implementation_of(Some((&other, bounds)), &added);
        quote_spanned! {span=>
            #[automatically_derived]
            #[allow(clippy::all, clippy::pedantic, clippy::nursery)]
            #implementation {
                type Output = #private::Sum<Self, #other>;

                fn add(self, other: #other) -> #private::Sum<Self, #other> {
                    #private::Sum::new(self, other)
                }
            }
        }
    }

    /// The name of one more type parameter of an implementation, which no type in its header has.
    pub(super) fn free_name(&self, wanted: &str) -> Ident {
        let (own, generics, bounds, groups) =
            (&self.name, &self.generics, &self.generics.where_clause, &self.group_paths);
        let taken = quote_spanned!(Span::mixed_site()=> #own #generics #bounds #(#groups)*).to_string();
        let is_taken = |name: &str| {
            taken.split(|letter: char| !letter.is_alphanumeric() && letter != '_').any(|word| word == name)
        };
        let mut name = wanted.to_owned();
        while is_taken(&name) {
            name.push('_');
        }
        Ident::new(&name, Span::mixed_site())
    }

    /// `impl … trait for …`, with one more type parameter if there is one.
    fn implementation_of(
        &self,
        more: Option<(&Ident, [syn::WherePredicate; 2])>,
        implemented: &TokenStream,
    ) -> TokenStream {
        let (private, name) = (&self.private, &self.name);
        let mut generics = self.generics.clone();
        if let Some(parameter) = &self.parameter {
            generics.make_where_clause().predicates.push(syn::parse_quote!(#parameter: #private::Real));
        }
        if let Some((parameter, bounds)) = more {
            generics.params.push(syn::parse_quote!(#parameter));
            generics.make_where_clause().predicates.extend(bounds);
        }
        let (before, _, _) = generics.split_for_impl();
        let (_, arguments, _) = self.generics.split_for_impl();
        let (_, _, conditions) = generics.split_for_impl();
        quote_spanned!(Span::mixed_site()=> impl #before #implemented for #name #arguments #conditions)
    }

    /// The types of the advected parameters.
    pub(crate) fn advected_types(&self) -> TokenStream {
        let values: Vec<TokenStream> = self.advected.iter().map(|&each| self.advected_type(each)).collect();
        match values.as_slice() {
            [single] => single.clone(),
            values => quote_spanned!(Span::mixed_site()=> (#(#values),*)),
        }
    }

    /// The type of the group.
    pub(crate) fn group(&self) -> TokenStream {
        Self::of_factors(&self.groups().collect::<Vec<_>>())
    }

    /// The type of each factor of the group.
    pub(crate) fn groups(&self) -> impl Iterator<Item = TokenStream> {
        let scalar = &self.scalar;
        self.group_paths.iter().map(move |group| quote_spanned!(Span::mixed_site()=> #group<#scalar>))
    }

    /// The implementation of `Term`, with these two methods.
    pub(crate) fn term(&self, methods: &TokenStream) -> TokenStream {
        let (scalar, group, advected) = (&self.scalar, self.group(), self.advected_types());
        let implementation = self.implementation("Term");
        quote_spanned! {Span::mixed_site()=>
            #[automatically_derived]
            #[allow(clippy::all, clippy::pedantic, clippy::nursery, non_snake_case, unused_variables)]
            #implementation {
                type Scalar = #scalar;
                type Group = #group;
                type Advected = #advected;

                #methods
            }
        }
    }

    /// The associated types of an effect.
    pub(crate) fn types(&self, kinetic: &str, constants: &TokenStream, step_terms: &TokenStream) -> TokenStream {
        let kinetic = Ident::new(kinetic, Span::mixed_site());
        let private = &self.private;
        quote_spanned! {Span::mixed_site()=>
            type Retraction = #private::CayleyRetraction;
            type Kinetic = #private::#kinetic;
            type Constants = #constants;
            type StepTerms = #step_terms;
        }
    }
}
