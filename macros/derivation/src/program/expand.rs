//! Polynomials in the unknown, multiplied out, with coefficients that are known before the iteration.
//!
//! Terms with the same monomial are collected into one coefficient, which is then computed at construction or once a
//! step. Afterwards the pair of factors that occurs most often is multiplied first, and shared.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::graph::{Graph, Node, NodeId};
use crate::mathematics::symbolic::Stage;

/// Monomials in iteration-stage nodes, with their coefficients.
type Polynomial = BTreeMap<Vec<NodeId>, NodeId>;

/// The limit on all monomials, beyond which multiplying out can't pay.
const MOST_MONOMIALS: usize = 600;
/// The limit on the monomials of one product before they are collected.
const MOST_PRODUCTS: usize = 2_000;

/// The outputs multiplied out, with `opaque` nodes as variables; `None` if they grow too large.
pub fn expanded(graph: &mut Graph, outputs: &[NodeId], opaque: &BTreeSet<NodeId>) -> Option<Vec<NodeId>> {
    let mut known = BTreeMap::new();
    let mut polynomials = Vec::new();
    for &output in outputs {
        polynomials.push(polynomial(graph, output, opaque, &mut known)?);
    }
    if polynomials.iter().map(|polynomial| polynomial.len()).sum::<usize>() > MOST_MONOMIALS {
        return None;
    }
    let mut products: Vec<Vec<Vec<NodeId>>> = Vec::new();
    for polynomial in &polynomials {
        products
            .push(polynomial.iter().map(|(variables, &coefficient)| factors(graph, variables, coefficient)).collect());
    }
    share_pairs(graph, &mut products);
    let mut sums = Vec::new();
    for (polynomial, products) in polynomials.iter().zip(products) {
        let mut terms = Vec::new();
        for (product, &coefficient) in products.into_iter().zip(polynomial.values()) {
            let node = graph.product(product);
            let negative = matches!(graph.node(coefficient), Node::Negate(_))
                || graph.value(coefficient).is_some_and(crate::mathematics::symbolic::Rational::is_negative);
            terms.push(if negative { graph.negate(node) } else { node });
        }
        sums.push(graph.sum(&terms));
    }
    Some(sums)
}

/// The factors of a term without its sign.
fn factors(graph: &mut Graph, variables: &[NodeId], coefficient: NodeId) -> Vec<NodeId> {
    let mut all = variables.to_vec();
    let size = match graph.node(coefficient) {
        Node::Negate(inner) => inner,
        Node::Constant(value) if value.is_negative() => graph.constant(-value),
        _ => coefficient,
    };
    if graph.value(size) != Some(crate::mathematics::symbolic::Rational::ONE) || all.is_empty() {
        all.push(size);
    }
    all.sort_unstable();
    all
}

fn polynomial(
    graph: &mut Graph,
    id: NodeId,
    opaque: &BTreeSet<NodeId>,
    known: &mut BTreeMap<NodeId, Rc<Polynomial>>,
) -> Option<Rc<Polynomial>> {
    if let Some(found) = known.get(&id) {
        return Some(Rc::clone(found));
    }
    if graph.stage(id) < Stage::Iteration {
        let term = if graph.is_zero(id) { Polynomial::new() } else { Polynomial::from([(Vec::new(), id)]) };
        return Some(Rc::new(term));
    }
    let variable = |graph: &mut Graph| Some(Rc::new(Polynomial::from([(vec![id], graph.one())])));
    if opaque.contains(&id) {
        return variable(graph);
    }
    let result = match graph.node(id) {
        Node::Negate(a) => {
            let a = polynomial(graph, a, opaque, known)?;
            let mut negated = Polynomial::new();
            combine(graph, &mut negated, &a, true);
            negated
        }
        Node::Add(a, b) | Node::Subtract(a, b) => {
            let negative = matches!(graph.node(id), Node::Subtract(..));
            let (a, b) = (polynomial(graph, a, opaque, known)?, polynomial(graph, b, opaque, known)?);
            let mut sum = Polynomial::clone(&a);
            combine(graph, &mut sum, &b, negative);
            sum
        }
        Node::Multiply(a, b) => {
            let (a, b) = (polynomial(graph, a, opaque, known)?, polynomial(graph, b, opaque, known)?);
            if a.len() * b.len() > MOST_PRODUCTS {
                return None;
            }
            let mut product = Polynomial::new();
            for (left, &x) in &*a {
                for (right, &y) in &*b {
                    let mut variables = [left.as_slice(), right].concat();
                    variables.sort_unstable();
                    let coefficient = graph.multiply(x, y);
                    insert(graph, &mut product, variables, coefficient);
                }
            }
            product
        }
        Node::Constant(_) | Node::Input(_) | Node::Divide(..) | Node::Apply(..) => return variable(graph),
    };
    if result.len() > MOST_MONOMIALS {
        return None;
    }
    let result = Rc::new(result);
    known.insert(id, Rc::clone(&result));
    Some(result)
}

fn combine(graph: &mut Graph, a: &mut Polynomial, b: &Polynomial, negative: bool) {
    for (variables, &coefficient) in b {
        let coefficient = if negative { graph.negate(coefficient) } else { coefficient };
        insert(graph, a, variables.clone(), coefficient);
    }
}

/// Adds a term; one whose coefficients cancel is left out.
fn insert(graph: &mut Graph, polynomial: &mut Polynomial, variables: Vec<NodeId>, coefficient: NodeId) {
    if graph.is_zero(coefficient) {
        return;
    }
    match polynomial.entry(variables) {
        Entry::Vacant(place) => {
            place.insert(coefficient);
        }
        Entry::Occupied(mut place) => {
            let sum = graph.sum(&[*place.get(), coefficient]);
            if graph.is_zero(sum) {
                place.remove();
            } else {
                place.insert(sum);
            }
        }
    }
}

/// Multiplies the pair of factors that occurs in most different products, until none occurs twice.
fn share_pairs(graph: &mut Graph, products: &mut [Vec<Vec<NodeId>>]) {
    loop {
        let distinct: BTreeSet<&Vec<NodeId>> = products.iter().flatten().collect();
        let mut counts: BTreeMap<(NodeId, NodeId), usize> = BTreeMap::new();
        for product in distinct {
            let mut pairs = BTreeSet::new();
            for (i, &a) in product.iter().enumerate() {
                pairs.extend(product.iter().skip(i + 1).map(|&b| (a, b)));
            }
            for pair in pairs {
                *counts.entry(pair).or_insert(0) += 1;
            }
        }
        // The first of equally frequent pairs is used: nodes are in the order of their construction, the same on every
        // machine.
        let best =
            counts.into_iter().filter(|&(_, count)| count > 1).min_by_key(|&(pair, count)| (usize::MAX - count, pair));
        let Some(((a, b), _)) = best else { return };
        let joined = graph.multiply(a, b);
        for product in products.iter_mut().flatten() {
            while let Some((i, j)) = positions(product, a, b) {
                product.remove(j);
                product.remove(i);
                product.push(joined);
                product.sort_unstable();
            }
        }
    }
}

fn positions(product: &[NodeId], a: NodeId, b: NodeId) -> Option<(usize, usize)> {
    let i = product.iter().position(|&factor| factor == a)?;
    let j = product.iter().enumerate().position(|(at, &factor)| at > i && factor == b)?;
    Some((i, j))
}
