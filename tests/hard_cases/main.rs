//! Cases that a right implementation survives and a sloppy one fails. The name of a test begins with its row.
//!
//! | | where |
//! |---|---|
//! | the rows themselves | [`rows`], by `examples/hard-cases` |
//! | S1 for random momenta, S4 where something turns | [`solvability`]; S1 and S2 as bounds and policies in `tests/robustness` |
//! | B6 in full, T10 equation by equation | [`bodies`] |
//! | P6, and R under every summation; rows that take more than a second | `tests/long/runs` |
//! | P1, P2, P7 | P1 and P2 of every declaration in `tests/systems` and `tests/long/random_lagrangians`, of every method in `tests/accuracy`; P7 in `tests/robustness/checkpoints.rs` |

mod bodies;
mod rows;
mod solvability;
