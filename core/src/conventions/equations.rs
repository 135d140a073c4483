//! Where each numbered equation of \[RDAE\] lives in the code.
//!
//! What is continuous in time serves to check the discrete theory and to read energies and velocities off a state; it
//! isn't integrated. Files are relative to `core/src` unless they begin with `examples`.
//!
//! # Chapter 1: reduction
//!
//! | equation | what | file | item |
//! |---|---|---|---|
//! | (1.1)–(1.13), (1.15) | continuous reduction | | not in the code |
//! | (1.14) | `μ = δl/δξ` of the continuous limit | `stepper.rs` | [`Stepper::start`], [`Stepper::velocity`] |
//! | (1.16) | the energy `μ·ξ − l(ξ)` | `stepper.rs` | [`Stepper::energy`] |
//! | (1.17) | `ad*_Ω Π = Π × Ω` | `groups/so3.rs` | [`lie_bracket_transpose`] |
//! | (1.18) | `l_d` approximates the action of a step | | up to the declaration |
//! | (1.19) | Legendre transforms before reduction | | only reduced, as (2.6) |
//! | (1.20), (1.28) | `𝔽l_d⁺ ∘ (𝔽l_d⁻)⁻¹` | `flows.rs` | [`DiscreteLiePoisson`] |
//! | (1.21), (1.32) | momentum map `R Π` | `state.rs` | [`State::spatial_momentum`] |
//! | (1.22) | `l_d(f) = L_d(g_1, g_2)` | `lagrangian.rs` | [`DiscreteLagrangian::l_d`] |
//! | (1.23), (1.25) | discrete Euler–Poincaré flow | `flows.rs` | [`DiscreteEulerPoincare`] with nothing advected |
//! | (1.24), (1.30) | reconstruction | `flows.rs`, `stepper.rs` | [`reconstruct`], [`Stepper::step`] |
//! | (1.26), (1.27) | reduced Legendre transforms, momentum | `lagrangian.rs` | [`legendre_minus`], [`legendre_plus`] |
//! | (1.29) | `μ_{i+1} = Ad*_f μ_i` | `flows.rs` | [`DiscreteLiePoisson::step`], without kicks |
//! | (1.31) | momentum of the free body | | derived from the declaration: [`right_momentum`] |
//!
//! # Chapter 2: advected parameters
//!
//! | equation | what | file | item |
//! |---|---|---|---|
//! | (2.1) | `δl_d/δw ⋄ w` | `lagrangian.rs` | [`DiscreteLagrangian::diamond`] |
//! | (2.2) | continuous advected equations | | not in the code |
//! | (2.3) | continuous Lagrangian of a top | `effect.rs` | [`inertia`] and [`potential`] of the continuous limit |
//! | (2.4), first line | `w_{i+1} = f_i⁻¹ w_i` | `advected.rs` | [`Advected::advect`] |
//! | (2.4), second line; (2.5) | discrete advected Euler–Poincaré flow | `flows.rs` | [`DiscreteEulerPoincare::step`] |
//! | (2.6) | `𝔽l_d⁻`, `𝔽l_d⁺` | `lagrangian.rs` | [`legendre_minus`], [`legendre_plus`] |
//! | (2.7) | the momentum equation | `lagrangian.rs`, `newton.rs` | [`legendre_minus`]; solved by [`invert_legendre_minus`] |
//! | (2.8) | discrete advected Lie–Poisson flow | `flows.rs` | [`DiscreteLiePoisson`] |
//! | (2.9) | its three equations | `flows.rs` | [`DiscreteLiePoisson::step`] |
//! | (2.10) | `g_{i+1} = g_i f_i` | `groups/mod.rs`, `flows.rs` | [`LieGroup::advance`], [`reconstruct`] |
//!
//! The second line of (2.9) is computed in its transport form `μ_{i+1} = Ad*_F (μ_i + δl_d/δw ⋄ w)`. It equals the
//! printed one where (2.7) holds, and keeps `μ·w` to rounding even where (2.7) has been solved to fewer digits.
//!
//! # What the macro derives
//!
//! Files are relative to `macros/src/mathematics/derive`; the rules of differentiation are in `macros/src/mathematics/symbolic/variation.rs`.
//!
//! | equation | what | file |
//! |---|---|---|
//! | (1.26), (1.31), (3.18); section 3.2.1, items 1 and 2 | `(R_F)* δl_d/δF`, `(L_F)* δl_d/δF` | `momentum_maps.rs` |
//! | (2.1); section 3.2.1, item 3 | `δl_d/δw ⋄ w` | `diamond.rs`, with the action in `action.rs` |
//! | (2.7), (3.17) | the momentum equation and its Newton Jacobian | `momentum_equation.rs` |
//! | (2.9) | the kicks of the transport form | `transport.rs` |
//! | (3.17) in Cayley coordinates | residual and Jacobian without denominators | `cayley.rs` |
//! | (2.3) from (3.13) | inertia, bias and potential of the limit `h → 0` | `limit.rs` |
//! | `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)` | whether a step of `−h` undoes a step of `h` | `self_adjoint.rs` |
//!
//! # Chapter 3: the heavy top
//!
//! | equation | what | file | item |
//! |---|---|---|---|
//! | (3.1)–(3.4) | Euler angles and their rates | `examples/common/heavy_top/cases.rs` | initial values only; no angle enters a step |
//! | (3.5)–(3.12) | equations of motion in Euler angles | | not in the code |
//! | (3.13) | the reduced discrete Lagrangian | `examples/common/heavy_top/declaration.rs` | declared |
//! | (3.14) | `R_{i+1} = R_i F_i` | `groups/so3.rs` | [`LieGroup::advance`] |
//! | (3.15) | `w_{i+1} = F_iᵀ w_i` | `advected.rs` | [`Advected::advect`] |
//! | (3.16) | the flow on increments | | derived from (3.13); [`DiscreteEulerPoincare::step`] |
//! | (3.17) | momentum at the start of a step | | derived: [`legendre_minus`], and [`newton_system`] for its solution |
//! | (3.18) | momentum at its end | | derived: [`legendre_plus`]; a step uses the transport form |
//! | (3.19) | change of the spatial momentum | | a consequence of (2.9): the two half kicks, in space |
//! | (3.20) | `e₃·R Π` is constant | `state.rs` | [`State::momentum_along`] |
//!
//! [`Advected::advect`]: crate::groups::Advected::advect
//! [`DiscreteEulerPoincare`]: crate::motion::DiscreteEulerPoincare
//! [`DiscreteEulerPoincare::step`]: crate::motion::DiscreteEulerPoincare::step
//! [`DiscreteLagrangian::diamond`]: crate::mechanics::DiscreteLagrangian::diamond
//! [`DiscreteLagrangian::l_d`]: crate::mechanics::DiscreteLagrangian::l_d
//! [`DiscreteLiePoisson`]: crate::motion::DiscreteLiePoisson
//! [`DiscreteLiePoisson::step`]: crate::motion::DiscreteLiePoisson::step
//! [`LieGroup::advance`]: crate::groups::LieGroup::advance
//! [`State::momentum_along`]: crate::motion::Motion::momentum_along
//! [`State::spatial_momentum`]: crate::motion::Motion::spatial_momentum
//! [`Stepper::energy`]: crate::motion::Stepper::energy
//! [`Stepper::start`]: crate::motion::Stepper::start
//! [`Stepper::step`]: crate::motion::Stepper::step
//! [`Stepper::velocity`]: crate::motion::Stepper::velocity
//! [`inertia`]: crate::mechanics::Effect::inertia
//! [`invert_legendre_minus`]: crate::motion::DiscreteLiePoisson::invert_legendre_minus
//! [`legendre_minus`]: crate::mechanics::DiscreteLagrangian::legendre_minus
//! [`legendre_plus`]: crate::mechanics::DiscreteLagrangian::legendre_plus
//! [`lie_bracket_transpose`]: crate::groups::LieGroup::lie_bracket_transpose
//! [`newton_system`]: crate::mechanics::Effect::newton_system
//! [`potential`]: crate::mechanics::Effect::potential
//! [`reconstruct`]: crate::motion::reconstruct
//! [`right_momentum`]: crate::mechanics::DiscreteLagrangian::right_momentum
