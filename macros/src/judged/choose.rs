//! Multiplied out or with closed `let`s: whichever costs less to run.
//!
//! Multiplied out, what cancels is found; with closed `let`s, nothing is written twice. Both are derived where there
//! are `let`s, and counted.

use crate::declared::lower::Lowered;
use crate::mathematics::derive::{self, Derived, ForceError, LimitError};
use crate::program::{self, Kernel};

/// What is emitted.
pub(crate) struct Chosen {
    pub(crate) lowered: Lowered,
    pub(crate) derived: Derived,
    pub(crate) kernel: Kernel,
}

/// Why nothing can be.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Refusal {
    Limit(LimitError),
    Force(ForceError),
    /// A coefficient left the range of exact arithmetic.
    Overflow,
}

/// The candidate with the least operations a step; the first, which is simpler to read, if it is nearly as cheap.
pub(crate) fn cheapest(candidates: Vec<Lowered>) -> Result<Chosen, Refusal> {
    let mut chosen: Option<(usize, Chosen)> = None;
    let mut refusal = None;
    let least = candidates.iter().map(size).min().unwrap_or(0);
    // What is twice as long is surely not cheaper and takes long to derive, so it comes last, and only if it has to.
    let (short, long): (Vec<Lowered>, Vec<Lowered>) =
        candidates.into_iter().partition(|candidate| size(candidate) <= 2 * least);
    for (lowered, is_long) in short.into_iter().map(|one| (one, false)).chain(long.into_iter().map(|one| (one, true))) {
        if is_long && chosen.is_some() {
            break;
        }
        match derived(lowered) {
            Ok(candidate) => {
                let cost = candidate.kernel.cost();
                if chosen.as_ref().is_none_or(|(least, _)| cost < least - least / 8) {
                    chosen = Some((cost, candidate));
                }
            }
            Err(why) => refusal = refusal.or(Some(why)),
        }
    }
    chosen.map(|(_, chosen)| chosen).ok_or(refusal.unwrap_or(Refusal::Overflow))
}

fn size(lowered: &Lowered) -> usize {
    let lets = lowered.declared.lets.iter().map(|one| one.value.size());
    lowered.declared.expression.size() + lets.sum::<usize>()
}

fn derived(lowered: Lowered) -> Result<Chosen, Refusal> {
    let derived = match lowered.displacements {
        None => derive::derive(&lowered.declared).map_err(Refusal::Limit)?,
        Some(displacements) => derive::force(&lowered.declared, displacements).map_err(Refusal::Force)?,
    };
    if !derived.is_exact() {
        return Err(Refusal::Overflow);
    }
    let kernel = program::kernel(&derived);
    Ok(Chosen { lowered, derived, kernel })
}
