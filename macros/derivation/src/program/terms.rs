//! The derived terms without stages, each as outputs of a graph.

use super::closed::Beginning;
use super::graph::{Graph, NodeId};
use super::kernel::{components, square};
use super::scalarise::Scalariser;
use crate::mathematics::derive::Derivation;
use crate::mathematics::symbolic::Expression;

/// The form of the outputs together.
#[derive(Clone, Copy, Debug)]
pub enum Form {
    Scalar,
    /// The components of a covector.
    Vector,
    /// A square matrix, by rows.
    Square,
}

/// A graph with outputs.
pub type Outputs<T = Vec<NodeId>> = (Graph, T);

impl Beginning {
    /// The outputs of one derived term.
    pub fn term(&self, derived: &Derivation, form: Form, expression: &Expression) -> Outputs {
        let mut graph = self.graph.clone();
        let outputs = self.in_form(&mut graph, derived, form, expression);
        (graph, outputs)
    }

    /// Inertia, bias and potential of the limit at rest.
    pub fn limit(&self, derived: &Derivation) -> Outputs<[Vec<NodeId>; 3]> {
        let (mut graph, limit) = (self.graph.clone(), &derived.limit);
        let parts = [(Form::Square, &limit.inertia), (Form::Vector, &limit.bias), (Form::Scalar, &limit.potential)];
        let outputs = parts.map(|(form, part)| self.in_form(&mut graph, derived, form, part));
        (graph, outputs)
    }

    fn in_form(&self, graph: &mut Graph, derived: &Derivation, form: Form, expression: &Expression) -> Vec<NodeId> {
        match form {
            Form::Scalar => vec![Scalariser::new(graph, &derived.symbols, &self.given).scalar(expression)],
            Form::Vector => components(graph, derived, &self.given, expression),
            Form::Square => square(graph, derived, &self.given, expression),
        }
    }
}
