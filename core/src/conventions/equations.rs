//! Each numbered equation, theorem, example and figure of \[RDAE\]: where it lives in the code, and which test would
//! notice if it were wrong.
//!
//! Paths are relative to the root of the repository. A test is named behind its file; where that file makes a test for
//! each group or each declared system, the name is of the function that they all call. Where an equation has to be read
//! with care, [`errata`](super::errata) says how. [`guide::thesis`](crate::guide::thesis) goes through them in order, with
//! the generated equation beside each.
//!
//! # Chapter 1: reduction
//!
//! | | what | where | checked by |
//! |---|---|---|---|
//! | `TG/G ≃ 𝔤` | the body velocity `ξ = g⁻¹ġ` | [`Stepper::velocity`], [`Stepper::start`] | `core/src/laws/group.rs` `variations` |
//! | (1.1) | `l(ξ) = L(e, ξ)` | [`l`], declared as `l = …` or the limit of `l_d` | `tests/random_lagrangians/continuous.rs` `assert_equations`; no attitude is in scope, `macros/derivation/mistakes/advected.txt` |
//! | theorem 1.1.1 | four equivalent statements | | `tests/groups/reduction.rs` `euler_poincare_reduction` |
//! | (1.2) | `δ∫l dt = 0` | in [the guide][reduced] | `tests/groups/reduction.rs` `euler_poincare_reduction` |
//! | (1.3), (1.6) | `δξ = η' + ad_ξ η` | [`lie_bracket`] | `core/src/laws/group.rs` `variations` |
//! | (1.4) | `d/dt δl/δξ = ad*_ξ δl/δξ` | [`euler_poincare`], [`momentum_rate`]; exact for a free body in [`ExactBody`] | `tests/groups/reduction.rs` `euler_poincare_reduction`; `tests/random_lagrangians/continuous.rs` `assert_equations` |
//! | (1.5) | `ġ = g ξ` | [`RightHandSide`] | `tests/groups/reduction.rs` `euler_poincare_reduction`; `tests/derivation/continuous.rs` `discretisations_converge_to_the_continuous_motion` |
//! | (1.7)–(1.9) | the canonical bracket and Hamilton's equations | printed in [the guide][lie-poisson]; on `T*GL(n)` [`CotangentGauss`], on `T*ℝ⁴` `core/src/methods/gauss/lift.rs` | `tests/groups/reduction.rs` `reduction_of_the_bracket` `legendre_transform`; `tests/accuracy/poisson.rs` |
//! | (1.10) | `{f, k}∘r = {f∘r, k∘r}` | printed in [the guide][lie-poisson] | `tests/groups/reduction.rs` `reduction_of_the_bracket` |
//! | lemma 1.2.1, (1.11) | `{f, k}(μ) = −⟨μ, ad_{δf/δμ} δk/δμ⟩` | [`lie_poisson_bracket`] | `tests/groups/reduction.rs` `reduction_of_the_bracket`; `core/src/laws/group.rs` `lie_poisson_brackets` |
//! | theorem 1.2.2, (1.12) | `μ̇ = ad*_{δh/δμ} μ` | [`lie_poisson`] | `tests/groups/reduction.rs` `legendre_transform`; `tests/random_lagrangians/continuous.rs` `assert_equations`; `core/src/laws/group.rs` `lie_poisson_brackets` |
//! | (1.13) | `𝔽L` before reduction | printed in [the guide][lie-poisson] | `tests/groups/reduction.rs` `legendre_transform` |
//! | (1.14) | `μ = δl/δξ` | [`momentum`], inverse [`velocity`]; [`Stepper::start`], [`Stepper::velocity`] | `tests/systems/limit.rs` `assert_limit`; `tests/random_lagrangians/continuous.rs` `assert_equations`; `tests/derivation/continuous.rs` `an_inertia_that_depends_on_what_is_advected` |
//! | (1.15) | `H = ⟨𝔽L, ġ⟩ − L` | printed in [the guide][lie-poisson] | `tests/groups/reduction.rs` `legendre_transform` |
//! | (1.16) | `h(μ) = μ·ξ − l(ξ)`, with `δh/δμ = ξ` | [`hamiltonian`], [`Stepper::energy`] | `tests/systems/limit.rs` `assert_limit`; `tests/groups/reduction.rs` `legendre_transform`; `tests/random_lagrangians/continuous.rs` `assert_equations` |
//! | lemma 1.3.1 | `𝔽l` carries (1.4) to (1.12) | [`euler_poincare`], [`lie_poisson`] | `tests/groups/reduction.rs` `legendre_transform`; `tests/random_lagrangians/continuous.rs` `assert_equations` |
//! | example 1 | the free body; `J = tr(J_d) I − J_d` | [`NonstandardInertia::to_inertia`], [`ExactBody`] | `tests/derivation/thesis.rs` `matrix_in_the_trace`; `tests/hard_cases/bodies/inertia.rs` `conversions_agree_with_the_integrals` |
//! | (1.17) | `ad*_Ω Π = Π × Ω` | [`lie_bracket_transpose`] of [`SO3`] | `tests/groups/so3_laws.rs` `adjoint_actions_and_their_pairings` |
//! | (1.18) | `l_d` approximates the action of a step | [`l_d`] as declared, or by `discretise = …` | `tests/derivation/exact_lagrangian.rs` `order_of_the_action`; `tests/derivation/continuous.rs` `every_discretisation_is_what_it_says` |
//! | discrete action | `Σ L_d(g_i, g_{i+1})` is stationary | | `tests/systems/unreduced.rs` `assert_variational` |
//! | (1.19) | `𝔽L_d⁻ = −D₁L_d`, `𝔽L_d⁺ = D₂L_d` | reduced: [`legendre_minus`], [`legendre_plus`] | `tests/systems/unreduced.rs` `assert_variational` |
//! | (1.20) | `𝔽L_d⁺ ∘ (𝔽L_d⁻)⁻¹` | [`DiscreteLiePoisson`] with [`LieGroup::advance`] | `tests/systems/unreduced.rs` `assert_variational`; `tests/common/structure/stages.rs` `assert_step` |
//! | section 1.4, property 1 | symplectic on `T*Q` | | `tests/systems/unreduced.rs` `assert_symplectic`; reduced, `tests/common/structure/poisson.rs` `assert_poisson` |
//! | (1.21), property 2 | the momentum map, conserved | [`spatial_momentum`], [`momentum_along`] | `tests/systems/unreduced.rs` `assert_variational`; `tests/common/structure/symmetry.rs` `drift` |
//! | property 3 | an exact `L_d` gives `q_d(k) = q(kh)` | | `tests/derivation/exact_lagrangian.rs` `a_free_sphere_turns_exactly` |
//! | theorem 1.4.1, (1.22) | `l_d(f) = L_d(g_1, g_2)` | [`l_d`] | `tests/systems/unreduced.rs` `assert_variational` |
//! | (1.23), (1.25) | discrete Euler–Poincaré flow | [`DiscreteEulerPoincare`] with nothing advected | `tests/hard_cases/rows.rs` `p5_two_flows`; `tests/systems/flows.rs` `p5` |
//! | (1.24), (1.30) | reconstruction `g_{i+1} = g_i f_i` | [`reconstruct`], [`LieGroup::advance`], [`Stepper::step`] | `tests/common/structure/two_flows.rs` `parting`; `core/src/laws/group.rs` `increments` |
//! | (1.26), (1.27) | reduced Legendre transforms, momentum | [`legendre_minus`], [`legendre_plus`] | `tests/common/structure/momenta.rs` `assert_momenta` |
//! | (1.28) | discrete Lie–Poisson flow | [`DiscreteLiePoisson`] | `tests/common/structure/stages.rs` `assert_step` |
//! | (1.29) | `μ_{i+1} = Ad*_f μ_i` | [`DiscreteLiePoisson::step`], without kicks; [`adjoint_transpose`] | `tests/common/structure/momenta.rs` `assert_momenta` |
//! | example 2, (1.31) | momentum of the free body | derived: [`right_momentum`]; [`RigidBody`] | `tests/derivation/thesis.rs` `derived_terms_as_printed` |
//! | (1.32) | `J_{L_d} = R Π` is constant | [`Stepper::spatial_momentum`] | `tests/hard_cases/rows.rs` `b1_box` `t8_no_gravity`; `tests/systems/symmetry.rs` `free_body` |
//!
//! # Chapter 2: advected parameters
//!
//! | | what | where | checked by |
//! |---|---|---|---|
//! | actions on `V` and `V*` | `ρ(g)`, `ξ·v` | [`Advected`] | `core/src/laws/advected.rs` `kinds_move_as_declared` `kinds_act` `pairings_are_invariant` |
//! | (2.1) | `δl_d/δw ⋄ w` | [`diamond`] | `tests/common/structure/momenta.rs` `assert_momenta`; `tests/derivation/dual_numbers.rs` `assert_terms` |
//! | theorem 2.1.1, (2.2) | continuous advected equations | [`momentum_rate`], [`advected_rate`], [`RightHandSide`] | `tests/groups/reduction.rs` `euler_poincare_reduction`; `tests/random_lagrangians/continuous.rs` `assert_equations`; `tests/systems/order.rs` `assert_second_order`; of several bodies `tests/derivation/continuous_bodies.rs` `bodies_that_feel_each_other` `two_links_move_as_a_double_spherical_pendulum` |
//! | example 3, (2.3) | continuous Lagrangian of a top | [`l`], and [`inertia`], [`momentum_bias`], [`potential`] of a limit | `tests/systems/limit.rs` `assert_limit`; `tests/hard_cases/rows.rs` `t1_orders_of_the_tops_of_the_thesis` |
//! | theorem 2.2.1 | reduced and unreduced paths are one | | `tests/systems/unreduced.rs` `assert_variational` |
//! | (2.4), first line | `w_{i+1} = f_i⁻¹ w_i` | [`Advected::advect`] | `core/src/laws/advected.rs` `kinds_move_as_declared` |
//! | (2.4), second line; (2.5) | discrete advected Euler–Poincaré flow | [`DiscreteEulerPoincare::step`] | `tests/systems/flows.rs` `p5` |
//! | (2.6) | `𝔽l_d⁻`, `𝔽l_d⁺` | [`legendre_minus`], [`legendre_plus`] | `tests/common/structure/momenta.rs` `assert_momenta` |
//! | (2.7) | the momentum equation | [`legendre_minus`]; solved by [`invert_legendre_minus`] | `tests/common/structure/stages.rs` `assert_step` |
//! | (2.8) | discrete advected Lie–Poisson flow | [`DiscreteLiePoisson`] | `tests/common/structure/stages.rs` `assert_step` |
//! | (2.9) | its three equations | [`DiscreteLiePoisson::step`] | `tests/common/structure/stages.rs` `assert_stages` `assert_step` |
//! | (2.10) | `g_{i+1} = g_i f_i` | [`LieGroup::advance`], [`reconstruct`] | `tests/systems/flows.rs` `p5` |
//!
//! The second line of (2.9) is computed in its transport form `μ_{i+1} = Ad*_F (μ_i + δl_d/δw ⋄ w)`. It equals the
//! printed one where (2.7) holds, and keeps `μ·w` to rounding even where (2.7) has been solved to fewer digits.
//!
//! # Chapter 3: the heavy top
//!
//! | | what | where | checked by |
//! |---|---|---|---|
//! | (3.1)–(3.4) | Euler angles and their rates | [`from_euler_angles`], [`euler_angles`], `examples/common/heavy_top/euler_angles.rs`; no angle enters a step | `tests/hard_cases/bodies/euler_angles.rs` `t10_frame_and_rates` |
//! | (3.5)–(3.9) | inertia, momenta and moment in the frame of the axis | printed in [the guide][top]; `examples/common/heavy_top/euler_angles.rs` | `tests/hard_cases/bodies/euler_angles.rs` `t10_equations_of_motion` |
//! | (3.10)–(3.12) | equations of motion in Euler angles | printed in [the guide][top]; `examples/common/heavy_top/euler_angles.rs`, as a rival | `tests/hard_cases/bodies/euler_angles.rs` `t10_equations_of_motion`; `tests/hard_cases/rows.rs` `t10_euler_angles` |
//! | three kinds of precession | looping, cuspidal, unidirectional | `examples/common/heavy_top/precession.rs` | `tests/hard_cases/rows.rs` `t11_nutation_and_precession` |
//! | section 3.2, `Ω̂ ≈ (F − I)/h` | the trapezoidal rule makes (3.13) | `discretise = trapezoid` | `tests/derivation/thesis.rs` `trapezoidal_rule_gives_3_13`; `tests/derivation/continuous.rs` `the_trapezoidal_rule_makes_the_steps_of_the_heavy_top` |
//! | (3.13) | the reduced discrete Lagrangian | `examples/common/heavy_top/declaration.rs`; [`RigidBody`] and [`Gravity`] | `tests/derivation/thesis.rs` `trapezoidal_rule_gives_3_13`; `tests/effects/sums.rs` `body_and_gravity_are_the_heavy_top` |
//! | section 3.2.1, items 1 to 3 | `(L_F)* δl_d/δF`, `(R_F)* δl_d/δF`, `δl_d/δw ⋄ w` | derived: [`left_momentum`], [`right_momentum`], [`diamond`] | `tests/derivation/thesis.rs` `derived_terms_as_printed` |
//! | (3.14) | `R_{i+1} = R_i F_i` | [`LieGroup::advance`] | `core/src/laws/group.rs` `increments`; `tests/derivation/golden_steps.rs` |
//! | (3.15) | `w_{i+1} = F_iᵀ w_i` | [`Advected::advect`] | `tests/derivation/thesis.rs` `flow_on_increments_as_printed` |
//! | (3.16) | the flow on increments; equations of \[LML05\] | [`DiscreteEulerPoincare::step`] | `tests/derivation/thesis.rs` `flow_on_increments_as_printed` |
//! | (3.17) | momentum at the start of a step | derived: [`legendre_minus`], and [`newton_system`] for its solution | `tests/derivation/thesis.rs` `derived_terms_as_printed`; `tests/derivation/golden_steps.rs` |
//! | (3.18) | momentum at its end | derived: [`legendre_plus`]; a step uses the transport form | `tests/derivation/thesis.rs` `derived_terms_as_printed` |
//! | equivalence with \[LML05\] | the same step, with the same momentum | | `tests/derivation/thesis.rs` `momentum_in_space_as_printed` `flow_on_increments_as_printed` `trapezoidal_rule_gives_3_13` |
//! | (3.19) | change of the spatial momentum | a consequence of (2.9) in [`DiscreteLiePoisson::step`]: the two half kicks, in space | `tests/derivation/thesis.rs` `momentum_in_space_as_printed` |
//! | (3.20) | `e₃·R Π` is constant | [`momentum_along`], [`Stepper::momentum_along_advected`] | `tests/derivation/thesis.rs` `momentum_in_space_as_printed`; `tests/hard_cases/rows.rs` `t3_ten_million_steps` |
//!
//! # Figures
//!
//! `cargo run --release --example thesis-figures` draws all of them; `examples/figures/thesis/README.md` shows them, with
//! the reason of each difference.
//!
//! | | what | checked by |
//! |---|---|---|
//! | 3.1, 3.2 | the Euler angles, the top | `tests/hard_cases/bodies/euler_angles.rs` `t10_frame_and_rates` |
//! | 3.3 | three kinds of precession | `tests/hard_cases/rows.rs` `t11_nutation_and_precession` |
//! | 3.4 | `‖RᵀR − I‖` | `tests/hard_cases/rows.rs` `t3_ten_million_steps` `t12_runge_kutta_loses_rigidity_and_its_path` |
//! | 3.5 | `e₃·R Π` | `tests/hard_cases/rows.rs` `t3_ten_million_steps` |
//! | 3.6 | energy | `tests/hard_cases/rows.rs` `t2_modified_energy` `t3_ten_million_steps`; `tests/systems/energy.rs` `heavy_tops` |
//! | 3.7 | body rates; `Ω_Z` constant, nutation periodic | `tests/systems/symmetry.rs` `bodies_with_an_axis`; `tests/hard_cases/rows.rs` `t11_nutation_and_precession` |
//! | 3.8, 3.9, 3.10 | the paths from 100 s to 200 s | `tests/hard_cases/rows.rs` `t1_orders_of_the_tops_of_the_thesis` `t11_nutation_and_precession` `t12_runge_kutta_loses_rigidity_and_its_path` |
//!
//! # What the macro derives
//!
//! The rules of differentiation are in `macros/derivation/src/mathematics/symbolic/variation.rs`.
//!
//! | equation | what | file |
//! |---|---|---|
//! | (1.26), (1.31), (3.18); section 3.2.1, items 1 and 2 | `(R_F)* δl_d/δF`, `(L_F)* δl_d/δF` | `macros/derivation/src/mathematics/derive/momentum_maps.rs` |
//! | (2.1); section 3.2.1, item 3 | `δl_d/δw ⋄ w` | `macros/derivation/src/mathematics/derive/diamond.rs`, with the action in `macros/derivation/src/mathematics/derive/action.rs` |
//! | (2.7), (3.17) | the momentum equation and its Newton Jacobian | `macros/derivation/src/mathematics/derive/momentum_equation.rs` |
//! | (2.9) | the kicks of the transport form | `macros/derivation/src/mathematics/derive/transport.rs` |
//! | (3.17) in Cayley coordinates | residual and Jacobian without denominators | `macros/derivation/src/mathematics/derive/cayley.rs` |
//! | (1.4), (1.12), (1.14), (1.16), (2.2) | the continuous equations | `macros/derivation/src/mathematics/derive/continuous.rs` |
//! | (3.13) from (2.3) | the discretisations of a declared `l` | `macros/derivation/src/judged/discretise.rs` |
//! | `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)` | whether a step of `−h` undoes a step of `h` | `macros/derivation/src/mathematics/derive/self_adjoint.rs` |
//!
//! [lie-poisson]: crate::guide::thesis#the-liepoisson-side
//! [reduced]: crate::guide::thesis#a-reduced-lagrangian
//! [top]: crate::guide::thesis#chapter-3-the-heavy-top
//! [`Advected`]: crate::groups::Advected
//! [`Advected::advect`]: crate::groups::Advected::advect
//! [`CotangentGauss`]: crate::methods::CotangentGauss
//! [`DiscreteEulerPoincare`]: crate::motion::DiscreteEulerPoincare
//! [`DiscreteEulerPoincare::step`]: crate::motion::DiscreteEulerPoincare::step
//! [`DiscreteLiePoisson`]: crate::motion::DiscreteLiePoisson
//! [`DiscreteLiePoisson::step`]: crate::motion::DiscreteLiePoisson::step
//! [`ExactBody`]: crate::methods::ExactBody
//! [`Gravity`]: crate::effects::Gravity
//! [`LieGroup::advance`]: crate::groups::LieGroup::advance
//! [`NonstandardInertia::to_inertia`]: crate::mechanics::NonstandardInertia::to_inertia
//! [`RigidBody`]: crate::effects::RigidBody
//! [`SO3`]: crate::groups::SO3
//! [`Stepper::energy`]: crate::motion::Stepper::energy
//! [`Stepper::momentum_along_advected`]: crate::motion::Stepper::momentum_along_advected
//! [`Stepper::spatial_momentum`]: crate::motion::Stepper::spatial_momentum
//! [`Stepper::start`]: crate::motion::Stepper::start
//! [`Stepper::step`]: crate::motion::Stepper::step
//! [`Stepper::velocity`]: crate::motion::Stepper::velocity
//! [`adjoint_transpose`]: crate::groups::LieGroup::adjoint_transpose
//! [`diamond`]: crate::mechanics::DiscreteLagrangian::diamond
//! [`inertia`]: crate::mechanics::Effect::inertia
//! [`invert_legendre_minus`]: crate::motion::DiscreteLiePoisson::invert_legendre_minus
//! [`l_d`]: crate::mechanics::DiscreteLagrangian::l_d
//! [`left_momentum`]: crate::mechanics::DiscreteLagrangian::left_momentum
//! [`legendre_minus`]: crate::mechanics::DiscreteLagrangian::legendre_minus
//! [`legendre_plus`]: crate::mechanics::DiscreteLagrangian::legendre_plus
//! [`lie_bracket`]: crate::groups::LieGroup::lie_bracket
//! [`lie_bracket_transpose`]: crate::groups::LieGroup::lie_bracket_transpose
//! [`lie_poisson_bracket`]: crate::groups::LieGroup::lie_poisson_bracket
//! [`momentum_along`]: crate::motion::Motion::momentum_along
//! [`momentum_bias`]: crate::mechanics::Effect::momentum_bias
//! [`newton_system`]: crate::mechanics::Effect::newton_system
//! [`potential`]: crate::mechanics::Effect::potential
//! [`reconstruct`]: crate::motion::reconstruct
//! [`right_momentum`]: crate::mechanics::DiscreteLagrangian::right_momentum
//! [`spatial_momentum`]: crate::motion::Motion::spatial_momentum
//! [`RightHandSide`]: crate::motion::RightHandSide
//! [`advected_rate`]: crate::mechanics::ContinuousLagrangian::advected_rate
//! [`euler_poincare`]: crate::mechanics::ContinuousLagrangian::euler_poincare
//! [`hamiltonian`]: crate::mechanics::ContinuousLagrangian::hamiltonian
//! [`l`]: crate::mechanics::ContinuousLagrangian::l
//! [`lie_poisson`]: crate::mechanics::ContinuousLagrangian::lie_poisson
//! [`momentum_rate`]: crate::mechanics::ContinuousLagrangian::momentum_rate
//! [`momentum`]: crate::mechanics::ContinuousLagrangian::momentum
//! [`velocity`]: crate::mechanics::ContinuousLagrangian::velocity
//! [`euler_angles`]: crate::groups::SO3::euler_angles
//! [`from_euler_angles`]: crate::groups::SO3::from_euler_angles
