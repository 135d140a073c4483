//! A Lagrangian in a file, or in a text: without a compiler.
//!
//! Before: [ensembles](super::ensembles). Next: [files](super::files).
//!
//! What the macro does with a declaration takes milliseconds, and needs no compiler. The package `liestep-late` does it
//! while a program runs, and scene files hand it their table `[lagrangian]`, which stands in place of `[body]` and the
//! effects:
//!
//! ```toml
//! [lagrangian]
//! advected = { w = "up" }
//! l_d = """
//! ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
//!     - 0.5 * h * m * g * w.dot(&(rho + F * rho))"""
//! J_d = { moments = [3, 3, 4] }
//! m = "1 kg"
//! g = 9.81
//! rho = [0, 0, 1]
//! up = [0, 0, 1]
//! ```
//!
//! `liestep run` makes its steps, `liestep sweep` and `liestep ensemble` vary its parameters, and `liestep derive FILE` prints
//! what was derived: with `--latex` for a paper, with `--rust` as the straight-line code of a step, and with `--c` as a step in C99 that needs
//! nothing else, for a flight computer. `examples/scenes/own-lagrangian.toml` is the whole file.
//!
//! | key | |
//! |---|---|
//! | `l_d` | the discrete Lagrangian, (3.13) here; the expression is that of the [macro](macro@crate::lagrangian) |
//! | `l`, `discretise`, `velocity` | in place of `l_d` a continuous one, how it is discretised, as `"trapezoid(Cayley)"`, and the name of the velocity, `Omega` if it isn't given |
//! | `advected` | names of what the body sees, with the parameters that have their values in space; four vectors at most |
//! | any other | a parameter: a number, a vector of three, a matrix of three rows, or an inertia: `{ moments = […] }`, `{ tensor = [[…], […], […]] }`. Where the name ends in `_d`, the nonstandard inertia of these is meant |
//!
//! # What is the same, and what isn't
//!
//! The derivation is the macro's, and so is its proof: a text that it accepts is derived right, or it gets the macro's message
//! at the line and the column of the file. The steps have the bits of the compiled ones; tests hold both together on every
//! kind of group. A text names nothing outside itself.
//!
//! The step is interpreted, and costs several times what the compiled one does. In a file the group is SO(3), and what is
//! given, joints, forces, splittings and the choice of a method for an accuracy are not there: those a program has, where
//! `Late<G, W, K>` is an [`Effect`](crate::mechanics::Effect) as any other, on each group of the library and on their
//! products. `liestep-machine` runs it there as machine code, `Late<G, W, K, Machine>`, with the same bits; of one whose numbers are
//! all known, [`specialised`](https://docs.rs/liestep-late) is faster, and may differ by rounding. In lanes many with one text move
//! together, as [ensembles](super::ensembles) do.
