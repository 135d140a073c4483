//! A constraint with its derivatives, verified against the declared functions.

use std::rc::Rc;

use super::explain;
use super::verify::{self, ConstraintSlopes, Row, Sureness};
use crate::declared::errors::Errors;
use crate::declared::lower;
use crate::declared::{Declaration, Tree};
use crate::mathematics::derive::Refusal;
use crate::mathematics::symbolic::Expression;
use crate::program::{Graph, along_unit_vectors};

/// The verified constraint; `None` after a mistake, which has been reported.
pub fn held(declaration: &Declaration, functions: Vec<Rc<Tree>>, errors: &mut Errors) -> Option<ConstraintSlopes> {
    let lowered = lower::constraint(declaration, &functions, errors)?;
    let first = functions.first()?;
    let slopes = lowered.declared.slopes();
    let mut all = slopes.iter().flatten().flatten().chain(&lowered.declared.functions);
    if all.any(Expression::has_overflow) {
        explain::refusal(Refusal::Overflow, declaration, first, errors);
        return None;
    }
    for (body, slopes) in slopes.iter().enumerate() {
        if slopes.iter().flatten().all(Expression::is_zero) {
            explain::not_held(body, declaration, errors);
            return None;
        }
    }
    let (mut graph, bodies, symbols) = (Graph::default(), &lowered.declared.bodies, &lowered.declared.symbols);
    let entries = std::array::from_fn(|body| {
        std::array::from_fn(|by| {
            let mut of = |slope| along_unit_vectors(&mut graph, symbols, bodies[body].directions[by], slope);
            slopes[body][by].iter().flat_map(&mut of).collect()
        })
    });
    let held = ConstraintSlopes { functions, lowered, slopes, graph, entries, sureness: Sureness::TooHigh };
    match verify::constraint(declaration, &held) {
        Ok((sureness, rows)) if rows.iter().all(|row| *row == Row::New) => {
            return Some(ConstraintSlopes { sureness, ..held });
        }
        Ok((_, rows)) => report(&held, &rows, errors),
        Err(unconfirmed) => explain::unconfirmed(unconfirmed, declaration, &held.functions[0], errors),
    }
    None
}

/// Reports the scalars and vectors with components that constrain nothing new.
fn report(held: &ConstraintSlopes, mut rows: &[Row], errors: &mut Errors) {
    for part in &held.functions {
        let (own, behind) = rows.split_at(part.shape.rows().min(rows.len()));
        if own.iter().all(|row| *row == Row::Constant) {
            explain::constant(part, errors);
        } else if own.iter().any(|row| *row != Row::New) {
            explain::follows(part, own, errors);
        }
        rows = behind;
    }
}
