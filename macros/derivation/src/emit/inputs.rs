//! The places of a symbol's entries in the generated methods.

use proc_macro2::{Literal, Span, TokenStream};
use quote::quote_spanned;

use super::Code;
use crate::declared::{FieldKind, Name};
use crate::program::Input;

impl Code<'_> {
    /// An entry of `F`, `w`, `h` or a parameter; arrays are indexed by numbers, so nothing can panic.
    pub(super) fn input_token(&self, input: Input) -> TokenStream {
        let span = Span::mixed_site();
        let found = self.names.iter().find(|(_, id)| **id == input.symbol).map(|(name, _)| *name);
        match found {
            Some(Name::Step) => quote_spanned!(span=> h),
            Some(Name::Velocity(factor)) => {
                let row = self.declaration.group.component_of(factor) + input.row;
                entry(&quote_spanned!(span=> velocity), Input { row, ..input })
            }
            Some(Name::Increment(factor)) => self.increment_entry(&quote_spanned!(span=> f), factor, input),
            Some(Name::Advected(index)) => self.advected_entry(&quote_spanned!(span=> w), index, input),
            Some(Name::Field(index)) => self.field_entry(index, input),
            // Displacements have been replaced by directions.
            Some(Name::DisplacementBefore(_) | Name::DisplacementAfter(_)) | None => self.derived_input(input),
        }
    }

    /// An entry of a symbol that the derivation has added.
    fn derived_input(&self, input: Input) -> TokenStream {
        let span = Span::mixed_site();
        let Some(directions) = self.directions else { return self.no_input(input) };
        if let Some(index) = directions.next.iter().position(|&next| next == input.symbol) {
            return self.advected_entry(&quote_spanned!(span=> next), index, input);
        }
        if input.symbol == directions.coordinates {
            return entry(&quote_spanned!(span=> half), input);
        }
        for (factor, one) in directions.factors.iter().enumerate() {
            let all = if input.symbol == one.small {
                quote_spanned!(span=> increment)
            } else if input.symbol == one.small_inverse {
                quote_spanned!(span=> inverse_increment)
            } else if input.symbol == one.inverse {
                quote_spanned!(span=> inverse)
            } else {
                continue;
            };
            return self.increment_entry(&all, factor, input);
        }
        if input.symbol == directions.along {
            return entry(&quote_spanned!(span=> velocity), input);
        }
        if input.symbol == directions.target {
            return entry(&quote_spanned!(span=> a), input);
        }
        self.no_input(input)
    }

    /// A compile error: directions have been replaced by their entries, so that a leftover is a bug of the derivation.
    fn no_input(&self, input: Input) -> TokenStream {
        let name = &self.symbols.get(input.symbol).name;
        let message = format!("liestep: no value for `{name}`; please report this declaration");
        quote_spanned!(Span::mixed_site()=> compile_error!(#message))
    }

    /// An entry of a factor's increment: of its matrix, or for a translation of the last column.
    fn increment_entry(&self, all: &TokenStream, factor: usize, input: Input) -> TokenStream {
        let own = self.declaration.group.factor(factor);
        let input = if own.is_added { Input { column: own.dimension(), ..input } } else { input };
        entry(&self.of_factor(all, factor), input)
    }

    /// The matrix of a factor among those of a product.
    pub(super) fn of_factor(&self, all: &TokenStream, factor: usize) -> TokenStream {
        if self.declaration.group.factors().len() == 1 {
            return all.clone();
        }
        let factor = syn::Index::from(factor);
        quote_spanned!(Span::mixed_site()=> #all.#factor)
    }

    /// An entry of one advected parameter.
    fn advected_entry(&self, all: &TokenStream, index: usize, input: Input) -> TokenStream {
        let span = Span::mixed_site();
        let part = if self.declaration.advected.len() == 1 {
            all.clone()
        } else {
            let index = syn::Index::from(index);
            quote_spanned!(span=> #all.#index)
        };
        let kind = self.declaration.advected_kind(index);
        let is_seen = self.declaration.group.is_product() && !matches!(kind, FieldKind::Given(_));
        let part = if is_seen { quote_spanned!(span=> #part.0) } else { part };
        match kind {
            FieldKind::Advected(..) | FieldKind::Given(_) => entry(&quote_spanned!(span=> #part.0), input),
            // The last coordinate of a point has been replaced by a constant.
            FieldKind::Point(_) => entry(&quote_spanned!(span=> #part.coords), input),
            FieldKind::Place(coordinates) => entry(&part, Input { column: coordinates, ..input }),
            _ => entry(&part, input),
        }
    }

    pub(super) fn field_entry(&self, index: usize, input: Input) -> TokenStream {
        let Some(field) = self.declaration.fields.get(index) else { return TokenStream::new() };
        // The compiler reports a name of another type at the field.
        let (name, span) = (&field.name, field.at.resolved_at(Span::mixed_site()));
        let place = |value: TokenStream| entry_at(span, &value, input);
        match field.kind {
            FieldKind::Scalar => quote_spanned!(span=> self.#name),
            FieldKind::Vector(_)
            | FieldKind::Matrix(_)
            | FieldKind::Configuration(_)
            | FieldKind::Place(_)
            | FieldKind::Advected(..)
            | FieldKind::Given(_) => place(quote_spanned!(span=> self.#name)),
            FieldKind::Point(_) => place(quote_spanned!(span=> self.#name.coords)),
            FieldKind::SymmetricInertia | FieldKind::StandardInertia => {
                place(quote_spanned!(span=> self.#name.as_matrix()))
            }
            FieldKind::DiagonalInertia => {
                let diagonal = Input { column: 0, ..input };
                entry_at(span, &quote_spanned!(span=> self.#name.diagonal()), diagonal)
            }
        }
    }
}

/// An entry in column-major storage, `[[_; rows]; columns]`.
pub(super) fn entry(value: &TokenStream, input: Input) -> TokenStream {
    entry_at(Span::mixed_site(), value, input)
}

fn entry_at(span: Span, value: &TokenStream, input: Input) -> TokenStream {
    let (row, column) = (Literal::usize_unsuffixed(input.row), Literal::usize_unsuffixed(input.column));
    quote_spanned!(span=> #value.data.0[#column][#row])
}
