//! How much a derivation may do: counted, so that it ends as soon on a fast machine as on a slow one.

use std::cell::Cell;

thread_local! {
    /// What is left of it; without a bound it doesn't become less.
    static LEFT: Cell<u64> = const { Cell::new(u64::MAX) };
}

/// Counts products of terms, terms that are looked into, and operations. Where nothing is left, what would be computed is as well taken for zero: so
/// all that follows is short, and what comes out is refused.
pub fn spend(work: usize) -> bool {
    let left = LEFT.get();
    if left == u64::MAX {
        return true;
    }
    let rest = left.saturating_sub(work as u64);
    LEFT.set(rest);
    rest > 0
}

/// What is done within a bound, and how much that was; `None` where it wasn't enough.
pub fn within<R>(bound: u64, done: impl FnOnce() -> R) -> Option<(R, u64)> {
    LEFT.set(bound);
    let made = done();
    let left = LEFT.replace(u64::MAX);
    (left > 0).then(|| (made, bound.saturating_sub(left)))
}
