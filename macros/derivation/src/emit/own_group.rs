//! A user's group: its type, its generators, and a `macro_rules!` macro of its name that passes them on.
//!
//! An attribute can't read the result of another one from a file or from memory: the compiler may run them in any
//! order, or not at all. A macro of the group's name is found by the rules of names, and always expands to the same
//! tokens.

use proc_macro2::{Literal, Span, TokenStream};
use quote::{format_ident, quote, quote_spanned};
use syn::{Ident, Path, Visibility};

use crate::declared::Role;
use crate::declared::errors::Errors;
use crate::declared::parse::{OwnGroup, Request};

fn private(root: Option<&Path>) -> TokenStream {
    root.map_or_else(|| quote!(::liestep::__private), |root| quote!(#root::__private))
}

/// The items of `matrix_group!`, or its mistakes.
pub(crate) fn own_group(group: Option<&OwnGroup>, name: Option<&Ident>, errors: &Errors) -> TokenStream {
    let mistakes: TokenStream = errors.iter().map(syn::Error::to_compile_error).collect();
    let Some(group) = group else {
        let stand_in = stand_in(name);
        return quote!(#mistakes #stand_in);
    };
    let OwnGroup { root, attributes, visibility, name, generators, size, functions } = group;
    let (span, private) = (Span::mixed_site(), private(root.as_ref()));
    let core = quote_spanned!(span=> #private::core);
    let (marker, asked) = (format_ident!("{name}Generators"), format_ident!("__liestep_{name}"));
    let [size, dimension] = [*size, generators.elems.len()].map(Literal::usize_unsuffixed);
    let about = format!("What declares [`{name}`].");
    // A `macro_rules!` macro can leave its crate by a path from the root only.
    let reach = match visibility {
        Visibility::Public(_) => quote!(pub(crate)),
        other => quote!(#other),
    };
    quote_spanned! {span=>
        #(#attributes)*
        #visibility type #name<T = #core::primitive::f64> = #private::MatrixGroup<#marker, T, #size, #dimension>;

        #[doc = #about]
        #[derive(
            #core::clone::Clone, #core::marker::Copy, #core::fmt::Debug, #core::cmp::PartialEq,
        )]
        #visibility struct #marker;

        impl #private::Generators<#size, #dimension> for #marker {
            const GENERATORS: [[[#core::primitive::f64; #size]; #size]; #dimension] = #generators;

            #(#functions)*
        }

        #[allow(unused_macros)]
        macro_rules! #asked {
            ({ $($attribute:tt)* } { $($arguments:tt)* } $($item:tt)*) => {
                #[$($attribute)* (generators = #generators, $($arguments)*)]
                $($item)*
            };
        }

        #[allow(unused_imports)]
        #reach use #asked as #name;
    }
}

/// A macro for `group = Name!` after a mistake, so that it isn't one more: it leaves the struct unchanged.
fn stand_in(name: Option<&Ident>) -> Option<TokenStream> {
    let name = name?;
    let asked = format_ident!("__liestep_{name}");
    Some(quote! {
        #[allow(unused_macros)]
        macro_rules! #asked {
            ($attribute:tt $arguments:tt $($item:tt)*) => { $($item)* };
        }

        #[allow(unused_imports)]
        pub(crate) use #asked as #name;
    })
}

/// The declaration passed through the group's macro, which adds the generators.
pub(crate) fn ask(role: Role, asked: &Request, item: &TokenStream) -> TokenStream {
    let Request { group, root, arguments } = asked;
    let (private, attribute) = (private(root.as_ref()), format_ident!("{}", role.attribute()));
    quote!(#group! { { #private::#attribute } { #arguments } #item })
}
