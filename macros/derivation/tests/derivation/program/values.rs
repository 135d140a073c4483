//! Constant folding in a graph, and operations that aren't folded. That entries and products that are multiplied out
//! keep their values, the check of each declaration says.

use std::collections::{BTreeMap, BTreeSet};

use crate::common::random::{Random, World};
use liestep_derivation::mathematics::symbolic::{Rational, Stage, SymbolId};
use liestep_derivation::program::expand::expanded;
use liestep_derivation::program::{Graph, Input, Node, NodeId, Scalariser, count};

use crate::common::evaluated;

fn variable(graph: &mut Graph, index: usize, stage: Stage) -> NodeId {
    graph.input(Input { symbol: SymbolId(index), row: 0, column: 0 }, stage)
}

#[test]
fn constructors_fold() {
    let mut graph = Graph::default();
    let g = &mut graph;
    let (x, y) = (variable(g, 0, Stage::Construction), variable(g, 1, Stage::Construction));
    let (zero, one, minus_x) = (g.zero(), g.one(), g.negate(x));
    let minus_y = g.negate(y);
    let half = g.constant(Rational::new(1, 2));
    assert_eq!(g.negate(minus_x), x);
    assert_eq!(g.add(x, zero), x);
    assert_eq!(g.subtract(x, x), zero);
    assert_eq!(g.add(x, minus_x), zero);
    assert_eq!(g.subtract(zero, x), minus_x);
    assert_eq!(g.multiply(x, one), x);
    assert_eq!(g.multiply(zero, x), zero);
    assert_eq!(g.add(half, half), one);
    assert_eq!(g.divide(one, half), g.constant(Rational::integer(2)));
    assert_eq!(g.divide(zero, x), zero);
    assert_eq!(g.divide(x, one), x);
    // Operands of commutative operations are in one order.
    assert_eq!(g.add(x, y), g.add(y, x));
    assert_eq!(g.multiply(x, y), g.multiply(y, x));
    assert_ne!(g.subtract(x, y), g.subtract(y, x));
    // Signs move outward.
    let product = g.multiply(x, y);
    assert_eq!(g.multiply(minus_x, minus_y), product);
    assert_eq!(g.multiply(minus_x, y), g.negate(product));
    let sum = g.add(x, y);
    assert_eq!(g.subtract(minus_x, y), g.negate(sum));
    let minus_half = g.constant(Rational::new(-1, 2));
    let halved = g.multiply(half, x);
    assert_eq!(g.multiply(minus_half, x), g.negate(halved));
    let difference = g.subtract(x, y);
    assert_eq!(g.negate(difference), g.subtract(y, x));
    // Twice a half is the whole.
    let double = g.add(x, x);
    assert_eq!(g.multiply(half, double), x);
    // Nothing is divided by a zero at compile time.
    let quotient = g.divide(one, zero);
    assert!(matches!(g.node(quotient), Node::Divide(..)));
}

#[test]
fn powers_by_squaring() {
    for exponent in -9..=9 {
        let mut graph = Graph::default();
        let x = variable(&mut graph, 0, Stage::Construction);
        let power = graph.power(x, exponent);
        let found = evaluated(&graph, &[power], &|_| 1.7)[0];
        assert!((found / 1.7_f64.powi(exponent) - 1.0).abs() < 1e-14);
        assert!(count(&graph, &[power], None).arithmetic <= 5);
    }
}

/// Values of earlier stages are combined first, so that an iteration makes one addition and one multiplication only.
#[test]
fn sums_and_products_go_by_stage() {
    let mut graph = Graph::default();
    let stages = [Stage::Iteration, Stage::Construction, Stage::Step, Stage::Construction, Stage::Step];
    let nodes: Vec<NodeId> = stages.iter().enumerate().map(|(at, &stage)| variable(&mut graph, at, stage)).collect();
    for output in [graph.sum(&nodes), graph.product(nodes.clone())] {
        let of = |stage| count(&graph, &[output], Some(stage)).arithmetic;
        assert_eq!([Stage::Construction, Stage::Step, Stage::Iteration].map(of), [1, 2, 1]);
    }
    // The order of the terms doesn't matter, and a sum of negatives is the negative of the sum.
    let reversed: Vec<NodeId> = nodes.iter().rev().copied().collect();
    assert_eq!(graph.sum(&nodes), graph.sum(&reversed));
    let negatives: Vec<NodeId> = nodes.iter().map(|&node| graph.negate(node)).collect();
    let (sum, of_negatives) = (graph.sum(&nodes), graph.sum(&negatives));
    assert_eq!(of_negatives, graph.negate(sum));
}

#[test]
fn too_large_polynomials_are_left_alone() {
    let mut graph = Graph::default();
    let unknowns: Vec<NodeId> = (0..40).map(|at| variable(&mut graph, at, Stage::Iteration)).collect();
    let sum = graph.sum(&unknowns);
    let power = graph.power(sum, 4);
    assert!(expanded(&mut graph, &[power], &BTreeSet::new()).is_none());
}

#[test]
fn entries_by_structure() {
    let world = World::new(&mut Random::new(1));
    let mut graph = Graph::default();
    let mut entry = |id, row, column| {
        let unit = |index: usize, transposed| {
            let factor = liestep_derivation::mathematics::symbolic::Factor::Unit { index, size: 3, transposed };
            let shape = if transposed { (1, 3) } else { (3, 1) };
            liestep_derivation::mathematics::symbolic::Expression::from_word(vec![factor], shape, &world.symbols)
        };
        let matrix = world.expression(id);
        let entry = unit(row, true).times(&matrix, &world.symbols).times(&unit(column, false), &world.symbols);
        Scalariser::new(&mut graph, &world.symbols, &BTreeMap::new()).scalar(&entry)
    };
    assert_eq!(entry(world.symmetric, 0, 2), entry(world.symmetric, 2, 0));
    assert_ne!(entry(world.a, 0, 2), entry(world.a, 2, 0));
    let (off, on) = (entry(world.diagonal, 0, 2), entry(world.diagonal, 1, 1));
    assert!(graph.is_zero(off) && !graph.is_zero(on));
}
