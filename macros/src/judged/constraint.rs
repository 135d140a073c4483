//! A constraint with its derivatives, which are checked against the declared functions.

use std::rc::Rc;

use super::{explain, verify};
use crate::declared::errors::Errors;
use crate::declared::lower::{self, LoweredConstraint};
use crate::declared::{Declaration, Tree};
use crate::mathematics::derive::Refusal;
use crate::mathematics::symbolic::Expression;
use crate::program::{Graph, NodeId, along_unit_vectors};

/// What is emitted of a constraint.
pub(crate) struct Held {
    pub(crate) lowered: LoweredConstraint,
    /// Of either body by its turn and by its shift, linear in the directions.
    pub(crate) slopes: [[Expression; 2]; 2],
    pub(crate) graph: Graph,
    /// The same as matrices with a row for each function, row by row.
    pub(crate) entries: [[Vec<NodeId>; 2]; 2],
}

/// `None` where something is wrong with it, which has been reported.
pub(crate) fn held(declaration: &Declaration, tree: &Rc<Tree>, errors: &mut Errors) -> Option<Held> {
    let lowered = lower::constraint(declaration, tree, errors)?;
    let Some(slopes) = lowered.declared.slopes() else {
        explain::refusal(Refusal::Overflow, declaration, tree, errors);
        return None;
    };
    for (body, [turn, shift]) in slopes.iter().enumerate() {
        if turn.is_zero() && shift.is_zero() {
            explain::not_held(body, declaration, errors);
            return None;
        }
    }
    let (mut graph, bodies) = (Graph::default(), &lowered.declared.bodies);
    let entries = std::array::from_fn(|body| {
        std::array::from_fn(|by| {
            let direction = bodies[body].directions[by];
            along_unit_vectors(&mut graph, &lowered.declared.symbols, direction, &slopes[body][by])
        })
    });
    let held = Held { lowered, slopes, graph, entries };
    if let Err(unconfirmed) = verify::constraint(declaration, tree, &held) {
        explain::unconfirmed(unconfirmed, declaration, tree, errors);
        return None;
    }
    Some(held)
}
