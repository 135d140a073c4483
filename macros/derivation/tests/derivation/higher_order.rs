//! Counts of the operations of Lagrangians of higher order.

use crate::common::{arguments_and_struct, derived};
use liestep_derivation::mathematics::symbolic::Stage;
use liestep_derivation::program::{Graph, KnownEntries, NodeId, count, kernel, with_values};

const FOURTH: &str = include_str!("../../../../examples/declarations/fourth_order_top.rs");
const SIXTH: &str = include_str!("../../../../examples/declarations/sixth_order_top.rs");

/// Operations of an iteration, and of the residual alone.
fn operations(file: &str) -> (usize, usize) {
    let (arguments, item) = arguments_and_struct(file);
    let kernel = kernel(&derived(arguments, item));
    let count = |outputs: &[NodeId]| count(&kernel.graph, outputs, Some(Stage::Iteration)).arithmetic;
    (count(&[kernel.residual.as_slice(), &kernel.jacobian].concat()), count(&kernel.residual))
}

#[test]
fn closed_lets_halve_the_operations_of_the_fourth_order_top() {
    let (iteration, residual) = operations(FOURTH);
    assert!(iteration <= 1_550 && residual <= 350, "{iteration} {residual}");
}

/// The gradient of the sixth order's Lagrangian by multipliers is the residual.
#[test]
fn a_gradient_costs_less_than_three_values_of_the_sixth_order_top() {
    let (arguments, item) = arguments_and_struct(SIXTH);
    let derived = derived(arguments, item);
    let mut graph = Graph::default();
    let lets = derived.closed.iter().map(|one| (one.symbol, &one.value));
    let values = with_values(&mut graph, &derived.symbols, lets, KnownEntries::new());
    let nodes: Vec<NodeId> = values.values().flat_map(|entries| entries.all().to_vec()).collect();
    let value = count(&graph, &nodes, None).arithmetic;
    let (iteration, residual) = operations(SIXTH);
    assert!(residual < 3 * value, "{residual} for the gradient, {value} for the value");
    assert!(iteration <= 9_200 && residual <= 1_600, "{iteration} {residual}");
}
