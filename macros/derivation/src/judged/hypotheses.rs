//! The hypotheses that the derived equations rest on.
//!
//! A relation of the group or a property of a field's type counts as used if the derivation without it has other
//! equations or other operations.

use std::rc::Rc;

use super::choose::Choice;
use crate::declared::errors::Errors;
use crate::declared::lower::{Reading, readings_without};
use crate::declared::{Declaration, FieldKind, Name, Tree};
use crate::mathematics::derive::has_equations;
use crate::mathematics::symbolic::{Stage, Structure};
use crate::program::{Graph, KnownEntries, Scalariser, count, with_values};

/// The hypotheses that are used, as a paper would write them.
pub(super) fn hypotheses(declaration: &Declaration, tree: &Rc<Tree>, chosen: &Choice) -> Vec<String> {
    let Choice { lowered, derived, .. } = chosen;
    let without = |name: Name, weaker: Structure| {
        // The relations are dropped for all increments together.
        let is_meant = |other: Name| match name {
            Name::Increment(_) => matches!(other, Name::Increment(_)),
            _ => other == name,
        };
        let weaker = |other: Name, structure: Structure| if is_meant(other) { weaker } else { structure };
        let candidates = readings_without(declaration, tree, &weaker, &mut Errors::default())?;
        let mut found =
            candidates.into_iter().find(|other| other.declared.lets.is_empty() == lowered.declared.lets.is_empty())?;
        // Equal names have equal symbols.
        found.declared.discretised.clone_from(&lowered.declared.discretised);
        Some(found)
    };
    let changes_equations = |name: Name, weaker: Structure| {
        let weakened = without(name, weaker);
        weakened.is_none_or(|weakened| !has_equations(&weakened.declared, &lowered.declared, derived))
    };
    let operations = operations(lowered);
    let mut used = Vec::new();
    if declaration.group.factors().iter().any(|factor| factor.orthogonal) {
        // The factors' increments are called components of `F`.
        let each = match declaration.group.is_product() {
            true if declaration.group.orthogonal => " of each component",
            true => " of each component that turns",
            false => "",
        };
        if changes_equations(Name::Increment(0), Structure::General) {
            used.push(format!("FᵀF = I{each}"));
        }
        if changes_equations(Name::Increment(0), Structure::Orthogonal) {
            used.push(format!("det F = 1{each}"));
        }
    }
    for (index, w) in declaration.advected.iter().enumerate() {
        let (name, shown) = (Name::Advected(index), w.plain_name());
        let is_rotation = matches!(declaration.advected_kind(index), FieldKind::Configuration(_));
        if is_rotation && changes_equations(name, Structure::General) {
            used.push(format!("{shown}ᵀ{shown} = I"));
        }
    }
    for (index, field) in declaration.fields.iter().enumerate() {
        let (name, field_name) = (Name::Field(index), field.plain_name());
        let is_symmetric = field.kind.is_inertia();
        if is_symmetric && changes_equations(name, Structure::General) {
            used.push(format!("{field_name}ᵀ = {field_name}"));
        }
        if let FieldKind::Point(rows) = field.kind {
            let carried = declaration.advected.iter().position(|w| w.field == Some(index));
            let (name, shown) = match carried {
                Some(place) => (Name::Advected(place), declaration.advected[place].plain_name()),
                None => (name, field_name.clone()),
            };
            if without(name, Structure::General).is_none_or(|any| self::operations(&any) != operations) {
                used.push(format!("{shown}{} = 1", subscript(rows)));
            }
        }
        if field.kind == FieldKind::DiagonalInertia
            && without(name, Structure::Symmetric).is_none_or(|full| self::operations(&full) != operations)
        {
            used.push(format!("{field_name} diagonal"));
        }
    }
    used
}

/// The number of operations in one evaluation of `l_d`.
fn operations(lowered: &Reading) -> usize {
    let (mut graph, declared) = (Graph::default(), &lowered.declared);
    let mut symbols = declared.symbols.clone();
    let increments = declared.increments.iter().zip(declared.group.factors());
    for (&increment, _) in increments.filter(|(_, group)| !group.is_added) {
        let shape = symbols.get(increment).shape;
        let inverse = symbols.add("F⁻¹", shape, Structure::General, Stage::Iteration);
        symbols.set_inverse(increment, inverse);
    }
    let given = with_values(
        &mut graph,
        &symbols,
        declared.lets.iter().map(|one| (one.symbol, &one.value)),
        KnownEntries::new(),
    );
    let mut scalariser = Scalariser::new(&mut graph, &symbols, &given);
    let output = scalariser.scalar(&declared.expression);
    count(&graph, &[output], None).arithmetic
}

/// A number of one digit as an index.
fn subscript(index: usize) -> char {
    ['₀', '₁', '₂', '₃', '₄'].get(index).copied().unwrap_or('…')
}
