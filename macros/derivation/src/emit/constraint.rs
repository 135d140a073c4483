//! The implementation of `Constraint`.

use proc_macro2::{Literal, Span, TokenStream};
use quote::quote_spanned;
use syn::Ident;

use super::inputs::entry;
use super::verbatim::{self, BODIES};
use super::{Code, Header, docs, page};
use crate::declared::{Declaration, FieldKind, Shape, check};
use crate::judged::ConstraintSlopes;
use crate::mathematics::derive::Body;
use crate::mathematics::symbolic::{Expression, text};
use crate::program::{Input, Node, NodeId};

/// The item with its implementation.
pub(crate) fn constraint(item: &TokenStream, declaration: &Declaration, held: &ConstraintSlopes) -> TokenStream {
    let (header, span) = (Header::new(declaration), Span::mixed_site());
    let (private, symbols) = (&header.private, &held.lowered.declared.symbols);
    let code = Code { declaration, header: &header, names: &held.lowered.names, symbols, directions: None };
    let (checks, kind) = (code.checks(), syn::ext::IdentExt::unraw(&declaration.item.ident).to_string());
    let functions = Literal::usize_unsuffixed(held.rows());
    let implementation = header.constraint(&functions);
    let (gap, slope, describe) = (gap(declaration, &header, held), code.slope(held), code.shown());
    let core = quote_spanned!(span=> #private::core);
    let places = quote_spanned!(span=> above: &#private::Place, below: &#private::Place);
    let implementation = quote_spanned! {span=>
        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic, clippy::nursery, non_snake_case, unused_variables)]
        #implementation {
            fn validate(&self) -> #core::result::Result<(), #private::SetupError> {
                #checks
                #core::result::Result::Ok(())
            }

            fn name(&self) -> &'static #core::primitive::str { #kind }

            /// The functions as declared.
            fn gap(&self, #places) -> #private::nalgebra::SVector<#core::primitive::f64, #functions> { #gap }

            /// The derivatives of the constraint's functions, as derived.
            fn slope(&self, #places) -> [#private::Slope<#functions>; 2] { #slope }

            fn describe(&self, visit: &mut dyn #core::ops::FnMut(&'static #core::primitive::str, #core::primitive::f64)) {
                #describe
            }
        }
    };
    let item = page::documented(item, &documentation(held));
    let implementation = header.enclosing(implementation);
    quote_spanned!(span=> #item #implementation)
}

/// The declared functions in one column; the compiler checks the shapes that the macro found.
fn gap(declaration: &Declaration, header: &Header, held: &ConstraintSlopes) -> TokenStream {
    let (span, private) = (Span::mixed_site(), &header.private);
    let expression = verbatim::declared(declaration, header);
    let parts = &held.functions;
    let names: Vec<Ident> = (0..parts.len()).map(|part| Ident::new(&format!("part{part}"), span)).collect();
    let scalar = quote_spanned!(span=> #private::core::primitive::f64);
    let types = parts.iter().map(|part| match part.shape {
        Shape::Scalar => scalar.clone(),
        shape @ Shape::Matrix(..) => {
            let rows = Literal::usize_unsuffixed(shape.rows());
            quote_spanned!(span=> #private::nalgebra::SVector<#scalar, #rows>)
        }
    });
    let entries = parts.iter().zip(&names).flat_map(|(part, name)| {
        (0..part.shape.rows()).map(move |row| {
            if part.shape == Shape::Scalar {
                return quote_spanned!(span=> #name);
            }
            let row = Literal::usize_unsuffixed(row);
            quote_spanned!(span=> #name.data.0[0][#row])
        })
    });
    let is_tuple = matches!(declaration.expression.as_ref().map(check::value), Some(syn::Expr::Tuple(_)));
    let (pattern, types) = if is_tuple {
        (quote_spanned!(span=> (#(#names,)*)), quote_spanned!(span=> (#(#types,)*)))
    } else {
        (quote_spanned!(span=> #(#names)*), quote_spanned!(span=> #(#types)*))
    };
    quote_spanned! {span=>
        let #pattern: #types = { #expression };
        #private::nalgebra::SVector::from_array_storage(#private::nalgebra::ArrayStorage([[#(#entries),*]]))
    }
}

impl Code<'_> {
    /// The slopes of both bodies in straight-line code.
    fn slope(&self, held: &ConstraintSlopes) -> TokenStream {
        let (span, private, functions) = (Span::mixed_site(), &self.header.private, held.rows());
        let bodies = &held.lowered.declared.bodies;
        let given = |id: NodeId| match held.graph.node(id) {
            Node::Input(input) => Some(entry_of_place(bodies, input).unwrap_or_else(|| self.input_token(input))),
            _ => None,
        };
        let (lets, values) = self.statements(&held.graph, &held.entries.concat().concat(), &given);
        let mut matrices = values.chunks(3 * functions).map(|entries| {
            let column = |k: usize| entries.iter().skip(k).step_by(3).cloned().collect();
            self.columns(functions, &[column(0), column(1), column(2)])
        });
        let slopes = BODIES.map(|_| {
            let (turn, shift) = (matrices.next(), matrices.next());
            quote_spanned!(span=> #private::Slope { turn: #turn, shift: #shift })
        });
        quote_spanned!(span=> #lets [#(#slopes),*])
    }

    /// All parameters with their names.
    fn shown(&self) -> TokenStream {
        let private = &self.header.private;
        let fields = self.declaration.fields.iter().map(|field| {
            let (name, text) = (&field.name, field.plain_name());
            let span = field.at.resolved_at(Span::mixed_site());
            if field.kind == FieldKind::Scalar {
                quote_spanned!(span=> visit(#text, self.#name);)
            } else {
                quote_spanned!(span=> #private::Parameter::value(&self.#name).iter().for_each(|&entry| visit(#text, entry));)
            }
        });
        fields.collect()
    }
}

/// An entry of a body's attitude or position.
fn entry_of_place(bodies: &[Body; 2], input: Input) -> Option<TokenStream> {
    let span = Span::mixed_site();
    BODIES.iter().zip(bodies).find_map(|(name, body)| {
        let name = Ident::new(name, span);
        let place = match input.symbol {
            symbol if symbol == body.attitude => quote_spanned!(span=> #name.attitude),
            symbol if symbol == body.position => quote_spanned!(span=> #name.position),
            _ => return None,
        };
        Some(entry(&place, input))
    })
}

/// The section on the constraint in the struct's documentation.
fn documentation(held: &ConstraintSlopes) -> String {
    let symbols = &held.lowered.declared.symbols;
    let heading = match held.rows() {
        1 => "One function".to_owned(),
        rows => format!("{rows} functions"),
    };
    let mut lines = String::new();
    for (part, function) in held.lowered.declared.functions.iter().enumerate() {
        let mut line = |what: &str, expression: &Expression| {
            lines = std::mem::take(&mut lines) + what + &text(expression, symbols) + "\n";
        };
        line("zero = ", function);
        for (body, slopes) in BODIES.iter().zip(&held.slopes) {
            line(&format!("    {body}, η: "), &slopes[0][part]);
            line(&format!("    {body}, ξ: "), &slopes[1][part]);
        }
    }
    format!(
        "\n# Derived constraint\n\n{heading} of where the bodies above, `R_a` and `x_a`, and below, `R_b` and `x_b`, are, \
         with the derivatives along `δR = hat(η) R` and `δx = ξ`:\n\n```text\n{lines}```\n\nCertainty: {}.",
        docs::certified("the derivatives", held.sureness)
    )
}
