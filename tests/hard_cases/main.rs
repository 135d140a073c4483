//! Cases that a right implementation survives and a sloppy one fails. The name of a test begins with its row.
//!
//! | rows | where |
//! |---|---|
//! | S1 to S6: no solution, or more than one | [`solvability`]; S1 and S2 as bounds and policies in `tests/robustness` |
//! | B1 to B8: bodies | [`bodies`] |
//! | T1 to T9: tops | [`tops`] |
//! | P1 to P8: structure | [`structure`]; P1 and P2 of every declaration in `tests/systems` and `tests/random_lagrangians`, of every method in `tests/accuracy`; P7 in `tests/robustness/checkpoints.rs` |

// The letters of the field.
#![allow(non_snake_case)]

mod bodies;
mod solvability;
mod structure;
mod tops;
