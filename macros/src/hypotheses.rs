//! Which hypotheses the derived equations rest on.
//!
//! A relation of the group or a promise of a field's type counts as used if dropping it changes an equation, or the
//! operations of one: that is found out by deriving without it.

use std::rc::Rc;

use syn::ext::IdentExt as _;

use crate::ast::{Declaration, FieldKind, Name, Tree};
use crate::derive::principal_equations;
use crate::errors::Errors;
use crate::lower::{Lowered, lower_without};
use crate::scalar::{Given, Graph, Scalariser, count, with_values};
use crate::symbolic::Structure;

/// The hypotheses that are used, as a paper would write them.
pub(crate) fn hypotheses(declaration: &Declaration, tree: &Rc<Tree>, lowered: &Lowered) -> Vec<String> {
    let without = |name: Name, weaker: Structure| {
        let weaker = |other: Name, structure: Structure| if other == name { weaker } else { structure };
        let candidates = lower_without(declaration, tree, &weaker, &mut Errors::default())?;
        candidates.into_iter().find(|other| other.declared.lets.is_empty() == lowered.declared.lets.is_empty())
    };
    let equations = principal_equations(&lowered.declared);
    let changes_equations = |name: Name| {
        let weakened = without(name, Structure::General);
        weakened.is_none_or(|weakened| principal_equations(&weakened.declared) != equations)
    };
    let operations = operations(lowered);
    let mut used = Vec::new();
    if declaration.structure.orthogonal && changes_equations(Name::Increment) {
        used.push("FᵀF = I".to_owned());
    }
    for (index, field) in declaration.fields.iter().enumerate() {
        let (name, field_name) = (Name::Field(index), field.name.unraw());
        let is_symmetric = matches!(field.kind, FieldKind::SymmetricInertia | FieldKind::DiagonalInertia);
        if is_symmetric && changes_equations(name) {
            used.push(format!("{field_name}ᵀ = {field_name}"));
        }
        if field.kind == FieldKind::DiagonalInertia
            && without(name, Structure::Symmetric).is_none_or(|full| self::operations(&full) != operations)
        {
            used.push(format!("{field_name} diagonal"));
        }
    }
    used
}

/// How many operations one value of `l_d` takes.
fn operations(lowered: &Lowered) -> usize {
    let (mut graph, declared) = (Graph::default(), &lowered.declared);
    let given = with_values(
        &mut graph,
        &declared.symbols,
        declared.lets.iter().map(|one| (one.symbol, &one.value)),
        Given::new(),
    );
    let mut scalariser = Scalariser { graph: &mut graph, symbols: &declared.symbols, given };
    let output = scalariser.scalar(&declared.l_d);
    count(&graph, &[output], None).arithmetic
}
