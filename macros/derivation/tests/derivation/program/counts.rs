//! Counts of the operations of the heavy top (3.13), so that a change that costs more is noticed.

use std::collections::{BTreeMap, BTreeSet};

use crate::common::{HEAVY_TOP, derived, top};
use liestep_derivation::mathematics::derive::Derivation;
use liestep_derivation::mathematics::symbolic::Stage;
use liestep_derivation::program::count::Operations;
use liestep_derivation::program::{Graph, Input, Kernel, NodeId, components, count, kernel, square};

fn heavy_top(inertia: &str) -> Derivation {
    derived(HEAVY_TOP, &top(inertia))
}

/// Operations of a step on matrices: `U(F, w) − a` and its Jacobian with the entries of `F` as inputs, and `k₀`.
fn on_matrices(derived: &Derivation, stage: Stage) -> Operations {
    let mut graph = Graph::default();
    let (directions, none) = (&derived.directions, BTreeMap::new());
    let unknown = derived.momentum.clone().plus(derived.kick_before.clone());
    let unknown = components(&mut graph, derived, &none, &unknown);
    let target = |graph: &mut Graph, row| graph.input(Input { symbol: directions.target, row, column: 0 }, Stage::Step);
    let mut outputs: Vec<NodeId> = Vec::new();
    for (row, value) in unknown.into_iter().enumerate() {
        let a = target(&mut graph, row);
        outputs.push(graph.subtract(value, a));
    }
    outputs.extend(square(&mut graph, derived, &none, &derived.jacobian));
    outputs.extend(components(&mut graph, derived, &none, &derived.kick_before));
    count(&graph, &outputs, Some(stage))
}

fn iteration(kernel: &Kernel) -> Operations {
    let outputs = [kernel.residual.as_slice(), &kernel.jacobian].concat();
    count(&kernel.graph, &outputs, Some(Stage::Iteration))
}

fn of_stage(kernel: &Kernel, stage: Stage) -> Operations {
    let all = [kernel.kick_before.as_slice(), &kernel.residual, &kernel.jacobian, &kernel.kick_after].concat();
    count(&kernel.graph, &all, Some(stage))
}

/// Operations before the solve: `a = μ + k₀`, with the kick in it.
fn before_the_solve(kernel: &Kernel) -> usize {
    let outputs = [kernel.kick_before.as_slice(), &kernel.residual, &kernel.jacobian].concat();
    3 + count(&kernel.graph, &outputs, Some(Stage::Step)).arithmetic
}

fn left_momentum(derived: &Derivation) -> Operations {
    let mut graph = Graph::default();
    let outputs = components(&mut graph, derived, &BTreeMap::new(), &derived.left_momentum);
    count(&graph, &outputs, None)
}

#[test]
fn in_principal_axes() {
    let derived = heavy_top("DiagonalNonstandardInertia");
    let kernel = kernel(&derived);
    assert!(iteration(&kernel).arithmetic <= 45, "{}", iteration(&kernel));
    let matrices = on_matrices(&derived, Stage::Iteration);
    assert!(matrices.arithmetic <= 18 && matrices.sign_flips <= 6, "{matrices}");
    assert!(on_matrices(&derived, Stage::Construction).arithmetic <= 14);
    assert!(3 + on_matrices(&derived, Stage::Step).arithmetic <= 18);
    // Operations at construction: sums and differences of the entries of `J_d`, `h/2`, and the lever.
    assert!(of_stage(&kernel, Stage::Construction).arithmetic <= 12);
    assert!(before_the_solve(&kernel) <= 18, "{}", before_the_solve(&kernel));
    assert!(left_momentum(&derived).arithmetic <= 52, "{}", left_momentum(&derived));
}

#[test]
fn with_a_full_tensor() {
    let derived = heavy_top("NonstandardInertia");
    let kernel = kernel(&derived);
    assert!(iteration(&kernel).arithmetic <= 97, "{}", iteration(&kernel));
    let matrices = on_matrices(&derived, Stage::Iteration);
    assert!(matrices.arithmetic <= 54 && matrices.sign_flips <= 6, "{matrices}");
    assert!(on_matrices(&derived, Stage::Construction).arithmetic <= 14);
    assert!(3 + on_matrices(&derived, Stage::Step).arithmetic <= 18);
    assert!(of_stage(&kernel, Stage::Construction).arithmetic <= 9);
    assert!(before_the_solve(&kernel) <= 18, "{}", before_the_solve(&kernel));
    assert!(left_momentum(&derived).arithmetic <= 76, "{}", left_momentum(&derived));
}

/// Operations of a free body: without a potential there is no work before the solve but for `a`.
#[test]
fn without_a_potential() {
    let free = derived(
        "group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)",
        "struct Free { J_d: DiagonalNonstandardInertia }",
    );
    let (free, top) = (kernel(&free), kernel(&heavy_top("DiagonalNonstandardInertia")));
    assert_eq!(iteration(&free), iteration(&top));
    let none: Vec<NodeId> = [free.kick_before.as_slice(), &free.kick_after].concat();
    let distinct: BTreeSet<NodeId> = none.iter().copied().collect();
    assert!(distinct.into_iter().all(|node| free.graph.is_zero(node)));
    assert!(before_the_solve(&free) < before_the_solve(&top));
}
