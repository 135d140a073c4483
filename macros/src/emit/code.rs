//! Straight-line code: one operation a `let`.

use std::collections::BTreeMap;

use proc_macro2::{Literal, Span, TokenStream};
use quote::quote_spanned;
use syn::Ident;

use super::Emitter;
use crate::scalar::{Graph, Node, NodeId};
use crate::symbolic::{Function, Rational};

/// The token of a node that isn't computed here: an input, or what an earlier stage has left.
pub(super) type Given<'a> = &'a dyn Fn(NodeId) -> Option<TokenStream>;

impl Emitter<'_> {
    /// The `let`s that the outputs need, and the outputs as one value: a scalar, a vector or a matrix.
    pub(super) fn body(
        &self,
        graph: &Graph,
        outputs: &[NodeId],
        input: &dyn Fn(crate::scalar::Input) -> TokenStream,
    ) -> TokenStream {
        let given = |id: NodeId| match graph.node(id) {
            Node::Input(entry) => Some(input(entry)),
            _ => None,
        };
        let (lets, values) = self.statements(graph, outputs, &given);
        let value = self.assembled(&values);
        quote_spanned!(Span::mixed_site()=> #lets #value)
    }

    pub(super) fn assembled(&self, values: &[TokenStream]) -> TokenStream {
        let root = &self.header.root;
        match values {
            [value] => value.clone(),
            [x, y, z] => quote_spanned!(Span::mixed_site()=> #root::__private::nalgebra::Vector3::new(#x, #y, #z)),
            entries => quote_spanned!(Span::mixed_site()=> #root::__private::nalgebra::Matrix3::new(#(#entries),*)),
        }
    }

    /// Code for the outputs: the statements, and a token for each output.
    pub(super) fn statements(
        &self,
        graph: &Graph,
        outputs: &[NodeId],
        given: Given,
    ) -> (TokenStream, Vec<TokenStream>) {
        let mut lets = TokenStream::new();
        let mut known: BTreeMap<NodeId, TokenStream> = BTreeMap::new();
        for id in needed(graph, outputs, given) {
            if let Some(token) = given(id) {
                known.insert(id, token);
                continue;
            }
            let at = |operand: NodeId| known.get(&operand).cloned().unwrap_or_default();
            let span = Span::mixed_site();
            let value = match graph.node(id) {
                Node::Constant(value) => {
                    known.insert(id, self.literal(value));
                    continue;
                }
                Node::Input(_) => continue,
                Node::Negate(a) => {
                    let a = at(a);
                    quote_spanned!(span=> -#a)
                }
                Node::Add(a, b) => binary(&at(a), '+', &at(b)),
                Node::Subtract(a, b) => binary(&at(a), '-', &at(b)),
                Node::Multiply(a, b) => binary(&at(a), '*', &at(b)),
                Node::Divide(a, b) => binary(&at(a), '/', &at(b)),
                Node::Apply(function, a) => self.call(function, &at(a)),
            };
            let name = Ident::new(&format!("t{}", id.0), span);
            lets.extend(quote_spanned!(span=> let #name = #value;));
            known.insert(id, quote_spanned!(span=> #name));
        }
        let values = outputs.iter().map(|output| known.get(output).cloned().unwrap_or_default()).collect();
        (lets, values)
    }

    fn call(&self, function: Function, argument: &TokenStream) -> TokenStream {
        let root = &self.header.root;
        let name = Ident::new(&format!("simd_{}", function.name()), Span::mixed_site());
        quote_spanned!(Span::mixed_site()=> #root::__private::nalgebra::SimdComplexField::#name(#argument))
    }

    fn literal(&self, value: Rational) -> TokenStream {
        let (span, root) = (Span::mixed_site(), &self.header.root);
        let mut size = Literal::f64_unsuffixed(value.to_f64().abs());
        size.set_span(span);
        let literal = if value.is_negative() { quote_spanned!(span=> -#size) } else { quote_spanned!(span=> #size) };
        match &self.header.parameter {
            Some(parameter) => quote_spanned!(span=> #root::__private::real::<#parameter>(#literal)),
            None if value.is_negative() => quote_spanned!(span=> (#literal)),
            None => literal,
        }
    }
}

fn binary(left: &TokenStream, operator: char, right: &TokenStream) -> TokenStream {
    let mut operator = proc_macro2::Punct::new(operator, proc_macro2::Spacing::Alone);
    operator.set_span(Span::mixed_site());
    quote_spanned!(Span::mixed_site()=> #left #operator #right)
}

/// The nodes to visit, operands first; what is given needs no operands.
pub(super) fn needed(graph: &Graph, outputs: &[NodeId], given: Given) -> Vec<NodeId> {
    let mut wanted: std::collections::BTreeSet<NodeId> = outputs.iter().copied().collect();
    let mut open: Vec<NodeId> = outputs.to_vec();
    while let Some(id) = open.pop() {
        if given(id).is_some() {
            continue;
        }
        for operand in graph.node(id).operands().into_iter().flatten() {
            if wanted.insert(operand) {
                open.push(operand);
            }
        }
    }
    wanted.into_iter().collect()
}
