//! The derived terms that know no stages, each as outputs of a graph.

use super::closed::{Given, with_lets};
use super::graph::{Graph, NodeId};
use super::kernel::{components, square};
use super::scalarise::Scalariser;
use crate::mathematics::derive::Derived;
use crate::mathematics::symbolic::Expression;

/// What the outputs make together.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Form {
    Scalar,
    /// The components of a covector.
    Vector,
    /// A square matrix, row by row.
    Square,
}

/// The outputs of one derived term.
pub(crate) fn term(derived: &Derived, form: Form, expression: &Expression) -> (Graph, Vec<NodeId>) {
    let mut graph = Graph::default();
    let given = with_lets(&mut graph, derived, Given::new());
    let outputs = in_form(&mut graph, derived, &given, form, expression);
    (graph, outputs)
}

/// Inertia, bias and potential of the limit at rest.
pub(crate) fn limit(derived: &Derived) -> (Graph, [Vec<NodeId>; 3]) {
    let mut graph = Graph::default();
    let given = with_lets(&mut graph, derived, Given::new());
    let limit = &derived.limit;
    let parts = [(Form::Square, &limit.inertia), (Form::Vector, &limit.bias), (Form::Scalar, &limit.potential)];
    let outputs = parts.map(|(form, part)| in_form(&mut graph, derived, &given, form, part));
    (graph, outputs)
}

fn in_form(graph: &mut Graph, derived: &Derived, given: &Given, form: Form, expression: &Expression) -> Vec<NodeId> {
    match form {
        Form::Scalar => {
            vec![Scalariser::new(graph, &derived.symbols, given.clone()).scalar(expression)]
        }
        Form::Vector => components(graph, derived, given, expression),
        Form::Square => square(graph, derived, given, expression),
    }
}
