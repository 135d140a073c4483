//! Chapters to read in order. This is documentation only, and every listing is a test.
//!
//! | chapter | |
//! |---|---|
//! | [`thesis`] | from the equations of the thesis *Reduced Discrete Advected Equations* to a program, in an afternoon: for who has it in hand, or knows geometric mechanics |
//! | [`first_program`] | a heavy top, line by line |
//! | [`effects`] | sums; a potential and a force of one's own; what changes with time |
//! | [`groups`] | other groups, a group of one's own, and what they carry |
//! | [`bodies`] | several bodies |
//! | [`accuracy`] | which method when, what it costs, and how to measure that |
//! | [`hard_cases`] | what can go wrong, how it is said, and the ways out |
//! | [`conserved`] | what is conserved, in numbers |
//! | [`recording`] | recording, events, the motion between two steps, games |
//! | [`gradients`] | how a motion depends on its start and on its parameters |
//! | [`ensembles`] | many motions at once |
//! | [`late`] | a Lagrangian in a file, without a compiler |
//! | [`files`] | reading the files from Python, Julia and MATLAB |
//! | [`inside`] | from a declaration to straight-line code, and the rooms of the sources |
//!
//! Left and right, frames, pairing and units are in [`conventions`](crate::conventions), which isn't to be read in order.

pub mod accuracy;
pub mod bodies;
pub mod conserved;
pub mod effects;
pub mod ensembles;
pub mod files;
pub mod first_program;
pub mod gradients;
pub mod groups;
pub mod hard_cases;
pub mod inside;
pub mod late;
pub mod recording;
pub mod thesis;
