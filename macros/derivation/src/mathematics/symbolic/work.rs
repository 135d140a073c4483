//! A bound on the work of a derivation, counted in operations, so that its result doesn't depend on the machine's
//! speed.

use std::cell::Cell;

thread_local! {
    /// The remaining work; the largest value means no bound.
    static LEFT: Cell<u64> = const { Cell::new(u64::MAX) };
}

/// Counts products of terms, converted terms and operations; false if no work remains. The caller may then return zero:
/// all that follows is short, and the result is refused.
pub fn spend(work: usize) -> bool {
    let left = LEFT.get();
    if left == u64::MAX {
        return true;
    }
    let rest = left.saturating_sub(work as u64);
    LEFT.set(rest);
    rest > 0
}

/// The result of `done` within a bound, and the work that it took; `None` if the bound was too low.
pub fn within<R>(bound: u64, done: impl FnOnce() -> R) -> Option<(R, u64)> {
    LEFT.set(bound);
    let made = done();
    let left = LEFT.replace(u64::MAX);
    (left > 0).then(|| (made, bound.saturating_sub(left)))
}
