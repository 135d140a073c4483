//! Straight-line code from a graph of operations.

use std::collections::BTreeMap;

use proc_macro2::{Literal, Span, TokenStream};
use quote::{ToTokens as _, quote_spanned};
use syn::Ident;

use super::header::Header;
use crate::declared::{Declaration, Name};
use crate::mathematics::derive::Directions;
use crate::mathematics::symbolic::{Function, Rational, SymbolId, Symbols};
use crate::program::{Form, Graph, Node, NodeId, needed};

/// The declaration, types and symbols that code is written for.
pub(super) struct Code<'a> {
    pub(super) declaration: &'a Declaration,
    pub(super) header: &'a Header,
    pub(super) names: &'a BTreeMap<Name, SymbolId>,
    pub(super) symbols: &'a Symbols,
    /// The symbols that the derivation of a step adds.
    pub(super) directions: Option<&'a Directions>,
}

/// The token of a node that needs no code here: an input, or a value of an earlier stage.
pub(super) type KnownTokens<'a> = &'a dyn Fn(NodeId) -> Option<TokenStream>;

impl Code<'_> {
    /// The `let`s that the outputs need, and the outputs as one value.
    pub(super) fn body(
        &self,
        form: Form,
        graph: &Graph,
        outputs: &[NodeId],
        input: &dyn Fn(crate::program::Input) -> TokenStream,
    ) -> TokenStream {
        let (lets, values) = self.values(graph, outputs, input);
        let value = self.assembled(form, &values);
        quote_spanned!(Span::mixed_site()=> #lets #value)
    }

    /// The `let`s that the outputs need, and the outputs.
    pub(super) fn values(
        &self,
        graph: &Graph,
        outputs: &[NodeId],
        input: &dyn Fn(crate::program::Input) -> TokenStream,
    ) -> (TokenStream, Vec<TokenStream>) {
        let given = |id: NodeId| match graph.node(id) {
            Node::Input(entry) => Some(input(entry)),
            _ => None,
        };
        self.statements(graph, outputs, &given)
    }

    /// One value from its entries, a square matrix by rows.
    pub(super) fn assembled(&self, form: Form, values: &[TokenStream]) -> TokenStream {
        let (private, span) = (&self.header.private, Span::mixed_site());
        let dimension = self.declaration.group.dimension();
        let nalgebra = quote_spanned!(span=> #private::nalgebra);
        match (form, dimension, values) {
            (Form::Scalar, ..) => values.iter().cloned().collect(),
            (Form::Vector, 3, entries) => quote_spanned!(span=> #nalgebra::Vector3::new(#(#entries),*)),
            (Form::Square, 3, entries) => quote_spanned!(span=> #nalgebra::Matrix3::new(#(#entries),*)),
            (Form::Vector, _, entries) => self.columns(dimension, &[entries.to_vec()]),
            (Form::Square, _, entries) => self.matrix(dimension, entries),
        }
    }

    /// The `let`s that matrices need, and the matrices of the group: one, or a tuple of those of the factors.
    pub(super) fn blocks(
        &self,
        graph: &Graph,
        blocks: &[Vec<NodeId>],
        input: &dyn Fn(crate::program::Input) -> TokenStream,
    ) -> TokenStream {
        let (lets, mut values) = self.values(graph, &blocks.concat(), input);
        let matrices = blocks.iter().zip(self.declaration.group.factors()).map(|(block, own)| {
            let rest = values.split_off(block.len().min(values.len()));
            self.matrix(own.size, &std::mem::replace(&mut values, rest))
        });
        let matrices: Vec<TokenStream> = matrices.collect();
        match matrices.as_slice() {
            [single] => quote_spanned!(Span::mixed_site()=> #lets #single),
            several => quote_spanned!(Span::mixed_site()=> #lets (#(#several),*)),
        }
    }

    /// A square matrix from its entries, by rows.
    fn matrix(&self, size: usize, values: &[TokenStream]) -> TokenStream {
        let column = |j: usize| values.iter().skip(j).step_by(size).cloned().collect();
        self.columns(size, &(0..size).map(column).collect::<Vec<_>>())
    }

    pub(super) fn columns(&self, rows: usize, columns: &[Vec<TokenStream>]) -> TokenStream {
        let (private, span, scalar) = (&self.header.private, Span::mixed_site(), &self.header.scalar);
        let nalgebra = quote_spanned!(span=> #private::nalgebra);
        let (rows, count) = (Literal::usize_unsuffixed(rows), Literal::usize_unsuffixed(columns.len()));
        let columns = columns.iter().map(|entries| quote_spanned!(span=> [#(#entries),*]));
        quote_spanned! {span=>
            #nalgebra::SMatrix::<#scalar, #rows, #count>::from_array_storage(#nalgebra::ArrayStorage([#(#columns),*]))
        }
    }

    /// Code for the outputs: the statements, and a token for each output.
    ///
    /// A value that is used once is written in place. All others are bound by a `let`.
    pub(super) fn statements(
        &self,
        graph: &Graph,
        outputs: &[NodeId],
        given: KnownTokens,
    ) -> (TokenStream, Vec<TokenStream>) {
        let order = needed(graph, outputs, &|id| given(id).is_some());
        let mut uses: BTreeMap<NodeId, usize> = BTreeMap::new();
        let operands = |id: NodeId| graph.node(id).operands().into_iter().flatten();
        for &id in order.iter().filter(|&&id| given(id).is_none()) {
            operands(id).for_each(|operand| *uses.entry(operand).or_insert(0) += 1);
        }
        // An output is always bound, as if it were used twice.
        for &output in outputs {
            *uses.entry(output).or_insert(0) += 2;
        }
        let mut known: BTreeMap<NodeId, Value> = BTreeMap::new();
        let mut bound: Vec<Binding> = Vec::new();
        for id in order {
            let Some(value) = self.value(graph, id, given, &known) else { continue };
            let is_operation = operands(id).next().is_some() && given(id).is_none();
            if !is_operation || (uses.get(&id) == Some(&1) && value.depth < DEEPEST) {
                known.insert(id, value);
                continue;
            }
            let name = Ident::new(&format!("t{}", id.0), Span::mixed_site());
            let reference = Value { tokens: name.to_token_stream(), reads: vec![bound.len()], depth: 0 };
            bound.push(Binding { name, value });
            known.insert(id, reference);
        }
        let values: Vec<Value> = outputs.iter().filter_map(|output| known.get(output).cloned()).collect();
        let read_last: Vec<usize> = values.iter().flat_map(|value| value.reads.iter().copied()).collect();
        (grouped(&bound, &read_last), values.into_iter().map(|value| value.tokens).collect())
    }

    fn value(&self, graph: &Graph, id: NodeId, given: KnownTokens, known: &BTreeMap<NodeId, Value>) -> Option<Value> {
        let leaf = |tokens: TokenStream| Some(Value { tokens, reads: Vec::new(), depth: 0 });
        if let Some(tokens) = given(id) {
            return leaf(tokens);
        }
        let node = graph.node(id);
        let parts: Vec<&Value> =
            node.operands().into_iter().flatten().filter_map(|operand| known.get(&operand)).collect();
        let reads = parts.iter().flat_map(|part| part.reads.iter().copied()).collect();
        let depth = 1 + parts.iter().map(|part| part.depth).max().unwrap_or(0);
        let tokens: Vec<TokenStream> = parts
            .iter()
            .map(|part| {
                let tokens = &part.tokens;
                if part.depth > 0 { quote_spanned!(Span::mixed_site()=> (#tokens)) } else { tokens.clone() }
            })
            .collect();
        let tokens = match (node, tokens.as_slice()) {
            (Node::Constant(value), _) => return leaf(self.literal(value)),
            (Node::Negate(_), [a]) => quote_spanned!(Span::mixed_site()=> -#a),
            (Node::Apply(function, _), [a]) => self.call(function, a),
            (Node::Add(..), [a, b]) => binary(a, '+', b),
            (Node::Subtract(..), [a, b]) => binary(a, '-', b),
            (Node::Multiply(..), [a, b]) => binary(a, '*', b),
            (Node::Divide(..), [a, b]) => binary(a, '/', b),
            _ => return None,
        };
        Some(Value { tokens, reads, depth })
    }

    fn call(&self, function: Function, argument: &TokenStream) -> TokenStream {
        let (private, span) = (&self.header.private, Span::mixed_site());
        let ours = |name: &str, order: u8| {
            let (name, order) = (Ident::new(name, span), Literal::u8_unsuffixed(order));
            quote_spanned!(span=> #private::#name::<_, #order>(#argument))
        };
        match function {
            Function::Stumpff(k) => return ours("stumpff", k),
            Function::LogRatio(k) => return ours("log_ratio", k),
            _ => {}
        }
        let name = Ident::new(&format!("simd_{}", function.name()), span);
        quote_spanned!(Span::mixed_site()=> #private::nalgebra::SimdComplexField::#name(#argument))
    }

    fn literal(&self, value: Rational) -> TokenStream {
        let (span, private) = (Span::mixed_site(), &self.header.private);
        let mut size = Literal::f64_unsuffixed(value.to_f64().abs());
        size.set_span(span);
        let literal = if value.is_negative() { quote_spanned!(span=> -#size) } else { quote_spanned!(span=> #size) };
        match &self.header.parameter {
            Some(parameter) => quote_spanned!(span=> #private::real::<#parameter>(#literal)),
            None if value.is_negative() => quote_spanned!(span=> (#literal)),
            None => literal,
        }
    }
}

/// The tokens of a value, and the `let`s that it reads.
#[derive(Clone)]
struct Value {
    tokens: TokenStream,
    reads: Vec<usize>,
    depth: usize,
}

struct Binding {
    name: Ident,
    value: Value,
}

/// The limit on nested parentheses, for readers.
const DEEPEST: usize = 4;

/// The limit on consecutive `let`s: each opens a scope inside the last one, and compilers walk scopes recursively, so
/// that more would overflow the stack.
const LONGEST: usize = 200;

/// The `let`s, in blocks that return the values read later.
fn grouped(bound: &[Binding], read_last: &[usize]) -> TokenStream {
    let lets = |bindings: &[Binding]| -> TokenStream {
        let each = bindings.iter().map(|Binding { name, value }| {
            let tokens = &value.tokens;
            quote_spanned!(Span::mixed_site()=> let #name = #tokens;)
        });
        each.collect()
    };
    if bound.len() <= LONGEST {
        return lets(bound);
    }
    let mut code = TokenStream::new();
    for (group, bindings) in bound.chunks(LONGEST).enumerate() {
        let (start, end) = (group * LONGEST, group * LONGEST + bindings.len());
        let later = bound.get(end..).unwrap_or_default().iter().flat_map(|binding| binding.value.reads.iter());
        let wanted: std::collections::BTreeSet<usize> =
            later.chain(read_last).copied().filter(|read| (start..end).contains(read)).collect();
        let names: Vec<&Ident> = wanted.iter().filter_map(|&at| bound.get(at)).map(|binding| &binding.name).collect();
        let inner = lets(bindings);
        code.extend(quote_spanned!(Span::mixed_site()=> let [#(#names),*] = { #inner [#(#names),*] };));
    }
    code
}

fn binary(left: &TokenStream, operator: char, right: &TokenStream) -> TokenStream {
    let mut operator = proc_macro2::Punct::new(operator, proc_macro2::Spacing::Alone);
    operator.set_span(Span::mixed_site());
    quote_spanned!(Span::mixed_site()=> #left #operator #right)
}
