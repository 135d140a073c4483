//! The choice between two ways to derive a step: with each `let` written out, or kept as a variable of its own.
//!
//! Multiplied out, terms can cancel; with closed `let`s, nothing is computed twice. If there are `let`s, both readings
//! are derived and their operations counted.

use std::rc::Rc;

use super::explain;
use crate::declared::errors::Errors;
use crate::declared::lower::Reading;
use crate::declared::{Declaration, Tree};
use crate::mathematics::derive::{DeclaredFunction, Derivation, Refusal};
use crate::program::{self, Kernel};

/// The reading that is emitted.
pub struct Choice {
    pub lowered: Reading,
    pub derived: Derivation,
    pub kernel: Kernel,
}

/// The derivation of a reading.
type Derive = fn(&DeclaredFunction) -> Result<Derivation, Refusal>;

/// The reading with the fewest operations a step, or the first, which is simpler, if it is nearly as cheap.
///
/// `None` if nothing can be derived, which has been reported.
pub fn cheapest(
    readings: Vec<Reading>,
    derive: Derive,
    declaration: &Declaration,
    tree: &Rc<Tree>,
    errors: &mut Errors,
) -> Option<Choice> {
    let least = readings.iter().map(size).min().unwrap_or(0);
    // A reading of twice the length is never cheaper and takes long to derive: it is the last resort.
    let (short, long): (Vec<Reading>, Vec<Reading>) =
        readings.into_iter().partition(|reading| size(reading) <= 2 * least);
    let chosen = cheapest_of(short, derive).or_else(|refusal| {
        // The refusal of the simpler reading is reported.
        cheapest_of(long, derive).map_err(|other| refusal.or(other))
    });
    chosen.map_err(|refusal| explain::refusal(refusal.unwrap_or(Refusal::Overflow), declaration, tree, errors)).ok()
}

/// The cheapest of these readings. The error is the first refusal, if there is one.
fn cheapest_of(readings: Vec<Reading>, derive: Derive) -> Result<Choice, Option<Refusal>> {
    let mut chosen: Option<(usize, Choice)> = None;
    let mut first = None;
    for lowered in readings {
        match derive(&lowered.declared) {
            Ok(derived) => {
                let kernel = program::kernel(&derived);
                let cost = kernel.cost();
                if chosen.as_ref().is_none_or(|(least, _)| cost < least - least / 8) {
                    chosen = Some((cost, Choice { lowered, derived, kernel }));
                }
            }
            Err(refusal) => first = first.or(Some(refusal)),
        }
    }
    chosen.map(|(_, chosen)| chosen).ok_or(first)
}

fn size(lowered: &Reading) -> usize {
    let lets = lowered.declared.lets.iter().map(|one| one.value.size());
    lowered.declared.expression.size() + lets.sum::<usize>()
}
