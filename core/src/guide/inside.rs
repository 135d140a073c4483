//! How it works inside: from a declaration to straight-line code, and the rooms of the sources.
//!
//! Before: [files](super::files). Paths are those of the repository.
//!
//! # Two halves
//!
//! | package | runs | |
//! |---|---|---|
//! | `liestep-derivation`, in `macros/derivation` | when a user's crate is compiled, called by the macros of `liestep-macros` | derives, judges, and writes code |
//! | `liestep`, in `core` | in the user's program | groups, solving, stepping, methods |
//!
//! They meet in a few traits. The macro implements [`Term`](crate::mechanics::Term), which says on which group a term is and
//! what it sees there, and [`Effect`](crate::mechanics::Effect): these two are all that a step asks of a term. It implements
//! [`DiscreteLagrangian`](crate::mechanics::DiscreteLagrangian), too. Who would rather not use the macro writes these by
//! hand: `examples/how-to-write-a-lagrangian-by-hand.rs`.
//!
//! # From tokens to code
//!
//! `macros/derivation/src/expand.rs` shows the whole flow on a screen. Each phase adds its mistakes to a list and gives
//! nothing where the next can't go on, so that several are reported at once.
//!
//! | | room | |
//! |---|---|---|
//! | 1 | `macros/derivation/src/declared` | parses the attribute and the struct, gives each expression a shape, and finds the mistakes of the declaration. Spans end here |
//! | 2 | `macros/derivation/src/mathematics` | sums of products of matrices in a normal form (`symbolic`), the groups (`group.rs`), and the equations of the thesis in its order (`derive`) |
//! | 3 | `macros/derivation/src/program` | matrices to scalars, equal operations once, constants of a step folded, operations counted |
//! | 4 | `macros/derivation/src/judged` | proves what was derived to be that of the declared `l_d`, in exact arithmetic, chooses the cheaper of several forms, and finds what is conserved |
//! | 5 | `macros/derivation/src/emit` | the only room that quotes tokens: implementations, documentation, and after a mistake a stand-in, so that no second error follows from the first |
//!
//! The rooms depend on each other in one direction, `lib → expand → emit → judged → {declared, program} → mathematics`, and a
//! test holds them to it.
//!
//! What comes out of phase 2 is text as well. It is the constant that a program can print, and the documentation of the
//! struct:
//!
//! ```
//! use liestep::mechanics::DiscreteLagrangian;
//! use liestep::prelude::*;
//!
//! #[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
//! struct Body {
//!     J_d: DiagonalNonstandardInertia,
//! }
//!
//! // Phase 2: the trace, differentiated along exp(s E_k) F, in a normal form.
//! assert!(Body::DERIVATION.contains("(R_F)* δl_d/δF = (1/h) (F J_d − J_d Fᵀ)^∨"));
//! // Phase 4: it was found that l_d(F, h) = −l_d(F⁻¹, −h).
//! assert!(Body::SELF_ADJOINT);
//!
//! // Phases 3 and 5: scalar code, beside the declared expression as it stands. They share nothing but the declaration.
//! let body = Body { J_d: DiagonalNonstandardInertia::from_diagonal(Vector3::new(1.2, 0.8, 0.5))? };
//! let (h, s) = (0.05, 1e-6);
//! let F = |angle| SO3::exp(Vector3::new(0.02, angle, 0.1)).matrix();
//! let turned = |s: f64| SO3::exp(Vector3::x() * s).matrix() * F(-0.03);
//! let difference = (body.l_d(&turned(s), &(), h) - body.l_d(&turned(-s), &(), h)) / (2.0 * s);
//! assert!((body.right_momentum(&F(-0.03), &(), h).x - difference).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What is proved, and what isn't
//!
//! When a declaration is compiled, momentum maps, diamond, momentum equation, Newton Jacobian, discrete energy, each stage of a
//! step and each derivative of its momenta are proved to be those of the declared expression, as identities on the connected
//! group that hold whatever the smooth functions in it are, by evaluation at random points of the field of `2⁶¹ − 1` elements:
//! by the lemma of Schwartz and Zippel a wrong one passes with a probability below the bound that is printed with the
//! derivation, `2⁻¹⁰⁰` or less, if the generator's numbers are taken for random.
//! Not proved are that the declaration is what was meant, that a step has a solution, which is found out at run time, what rounding
//! does to it, and the writing of tokens from the graph that was evaluated; and no bound is claimed, which the derivation says,
//! where degrees are too high or a generator `E` of a group of one's own has no `E³ = cE`.
//!
//! `macros/derivation/src/judged/verify/mod.rs` has the argument.
//!
//! `cargo run --example derive -- heavy-top` prints a derivation with its counts of operations, `liestep derive gravity` that of an
//! effect.
//!
//! # A step
//!
//! [`Stepper::new`](crate::Stepper::new) asks a scene for its constants at a step `h`: everything that doesn't depend on the
//! state is computed once. A step then is
//!
//! ```text
//! terms     of (μ, w)           what the momentum equation has beside its unknown       the scene's code
//! solve     (2.7) for F         Newton from a guess, in Cayley coordinates              core/src/solving
//! look      at the solution     does it continue the identity? else a closer look       core/src/solving/branch.rs, careful.rs
//! proceed   μ⁺, w⁺, g⁺          (2.6), (2.4), (2.10)                                     the scene's code; core/src/motion/summation.rs
//! ```
//!
//! The guess is made of the steps before (`core/src/solving/guess.rs`), so that one or two iterations are enough. Where the
//! Jacobian is expensive it is used again (`reused_jacobian.rs`, `secants.rs`). A sum of effects adds constants, terms and residuals of
//! its terms: `core/src/mechanics/sum.rs`.
//!
//! # The rooms of the library
//!
//! ```text
//! error, numbers ← groups ← mechanics ← {effects, solving} ← motion ← methods ← {with, accuracy};  groups ← laws
//! ```
//!
//! | room | |
//! |---|---|
//! | `core/src/numbers` | scalars, lanes, vectors: [`numbers`](crate::numbers) |
//! | `core/src/groups` | one group a file, retractions, what a group carries: [`groups`](crate::groups) |
//! | `core/src/mechanics` | terms, sums, inertias, continuous equations: [`mechanics`](crate::mechanics) |
//! | `core/src/effects` | the library of bodies, potentials and forces, each a declaration: [`effects`](crate::effects) |
//! | `core/src/solving` | the equation of a step |
//! | `core/src/motion` | states, steppers, plans: [`motion`](crate::motion) |
//! | `core/src/gradients` | derivatives of steps: [`gradients`](crate::gradients) |
//! | `core/src/methods` | plans of higher order: [`methods`](crate::methods) |
//! | `core/src/recording` | runs that are observed, recorded and stopped: [`recording`](crate::recording) |
//! | `core/src/with` | what is put around a plan: [`with`](crate::with) |
//! | `core/src/accuracy` | choosing and measuring: [`accuracy`](crate::accuracy) |
//! | `core/src/laws` | the laws of groups as tests: [`laws`](crate::laws) |
//! | `core/src/conventions`, `core/src/guide` | documentation only |
//!
//! `core/tests/rooms.rs` holds them to it. Around the core are packages that use nothing but what is public: `core/scene` and
//! `core/cli` (scene files and the program), `core/late` (declarations as text), `core/plot` (pictures), `core/ensemble`, `core/arrow`.
//!
//! A [`Plan`](crate::motion::Plan) is a method with its constants folded, and everything else (start, forces, substeps, compensated
//! sums, checkpoints, recording, events) is written for any plan. `examples/how-to-add-a-method.rs` adds one.
//!
//! # How it is known to be right
//!
//! | | against | where |
//! |---|---|---|
//! | each derived term | central differences and dual numbers of the declared `l_d` | `tests/derivation` |
//! | random declarations | the same | `tests/random_lagrangians` |
//! | the thesis | its equations, one by one | [`conventions::equations`](crate::conventions::equations) |
//! | orders | references of 25 digits and more, `tests/data` | `tests/accuracy` |
//! | methods of high order | the same maps in 32 digits, written anew | `tests/accuracy/many_digits` |
//! | conservation, the Poisson structure | their definitions | `tests/systems`, `tests/hard_cases` |
//! | steps | their bits, on record | `tests/derivation/golden_steps.rs` |
//! | messages | the text and the place, for every mistake | `macros/derivation/mistakes`, `tests/ui` |
//! | zero cost | instructions counted | `cargo bench --bench scenes -- zero-cost` |
//!
//! `CONTRIBUTING.md` says what to run, and what a new effect, group or method takes.
