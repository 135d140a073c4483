//! From the thesis to a running program, in the order of the thesis.
//!
//! Each section has the thesis' equation, what you write for it, and what is generated. The generated equations are
//! text that a program can print. The listings of this page are tests, and they compare that text, so the equations
//! below are those of the version that you read.
//!
//! What the letters mean is in [`conventions`](crate::conventions). Covectors are components `μ_k = ⟨μ, E_k⟩`. On SO(3)
//! they are the physical angular momentum in the body frame, so no factor ½ appears where the thesis has one: `Π̂ = ½
//! μ̂`. Single equations are found by number in [`equations`](crate::conventions::equations).
//!
//! # Chapter 1: reduction
//!
//! ## A reduced Lagrangian
//!
//! Where `L` on `TG` is invariant under left multiplication, it's a function of `ξ = g⁻¹ġ` alone, (1.1). Theorem 1.1.1
//! says that the variational principle on `TG` is one on the algebra, (1.2) and (1.3):
//!
//! <math display="block">
//! <mo>δ</mo><msubsup><mo>∫</mo><mi>a</mi><mi>b</mi></msubsup><mi>l</mi><mo>(</mo><mi>ξ</mi><mo>)</mo><mi>d</mi>
//! <mi>t</mi><mo>=</mo><mn>0</mn><mspace width="2em"/><mo>δ</mo><mi>ξ</mi><mo>=</mo>
//! <mover><mi>η</mi><mo>˙</mo></mover><mo>+</mo><msub><mrow><mi>ad</mi></mrow><mi>ξ</mi></msub><mi>η</mi>
//! </math>
//!
//! and that both are the Euler–Poincaré equation (1.4), from which (1.5) regenerates the path:
//!
//! <math display="block">
//! <mfrac><mrow><mi>d</mi></mrow><mrow><mi>d</mi><mi>t</mi></mrow></mfrac>
//! <mfrac><mrow><mo>∂</mo><mi>l</mi></mrow><mrow><mo>∂</mo><mi>ξ</mi></mrow></mfrac><mo>=</mo>
//! <msubsup><mrow><mi>ad</mi></mrow><mi>ξ</mi><mo>*</mo></msubsup>
//! <mfrac><mrow><mo>∂</mo><mi>l</mi></mrow><mrow><mo>∂</mo><mi>ξ</mi></mrow></mfrac><mspace width="2em"/>
//! <mover><mi>g</mi><mo>˙</mo></mover><mo>=</mo><mi>g</mi><mi>ξ</mi>
//! </math>
//!
//! You declare `l`, and give the velocity a name. This is the free body of example 1:
//!
//! ```
//! use liestep::mechanics::ContinuousLagrangian;
//! use liestep::prelude::*;
//!
//! #[lagrangian(group = SO3, velocity = Omega, l = 0.5 * Omega.dot(&(J * Omega)))]
//! struct Body {
//!     J: Inertia, // kg m²
//! }
//!
//! let generated = [
//!     "μ = J Omega    [∂l/∂ξ, (1.14)]",
//!     "dμ/dt = 𝕀 dOmega/dt = (J Omega) × Omega    [(1.4): ad*_ξ μ]",
//!     "h(μ) = ½ ⟨μ, 𝕀⁻¹ μ⟩    [(1.16)]",
//! ];
//! for equation in generated {
//!     assert!(Body::CONTINUOUS_DERIVATION.contains(equation), "{equation}");
//! }
//!
//! let body = Body { J: Inertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))? };
//! let Omega = Vector3::new(0.3, -0.2, 0.9); // rad/s
//! let Pi = body.momentum(&Omega, &());
//! assert!((body.momentum_rate(&Omega, &()) - Pi.cross(&Omega)).norm() < 1e-15);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The `()` stands for what is advected, which is nothing yet. That `ad*_Ω Π = Π × Ω` on SO(3), (1.17), is
//! [`lie_bracket_transpose`]; on any other group the generated line has that group's `ad*`.
//!
//! ## The Lie–Poisson side
//!
//! The dual of the algebra carries the bracket of lemma 1.2.1, (1.11),
//!
//! ```text
//! {f, k}(μ) = −⟨μ, ad_{δf/δμ} δk/δμ⟩
//! ```
//!
//! which is [`lie_poisson_bracket`]. It is what is left of the canonical bracket of `T*G` and of Hamilton's equations there
//! on functions of the momentum alone, with `r` for the map from `T*G` to the momentum. Before reduction the Legendre
//! transform is `𝔽L`:
//!
//! ```text
//! {F, K}(q, p) = ∂F/∂qⁱ ∂K/∂p_i − ∂K/∂qⁱ ∂F/∂p_i        (1.7)
//! {·, H} = Z_H(·)                                       (1.8)
//! q̇ = ∂H/∂p,    ṗ = −∂H/∂q                              (1.9)
//! {f, k}∘r = {f∘r, k∘r}                                 (1.10)
//! ⟨𝔽L(q, v), u⟩ = d/ds L(q, v + su) at s = 0            (1.13)
//! H = ⟨𝔽L(g, ġ), ġ⟩ − L(g, ġ)                           (1.15)
//! ```
//!
//! The tests compute these to compare; a program needs none of them. With the bracket a reduced Hamiltonian moves the
//! momentum by (1.12), `μ̇ = ad*_{δh/δμ} μ`.
//! The reduced Legendre transform (1.14) goes from one side to the other, and (1.16) is its Hamiltonian:
//!
//! <math display="block">
//! <mi>μ</mi><mo>=</mo><mfrac><mrow><mo>δ</mo><mi>l</mi></mrow><mrow><mo>δ</mo><mi>ξ</mi></mrow></mfrac>
//! <mspace width="2em"/><mi>h</mi><mo>(</mo><mi>μ</mi><mo>)</mo><mo>=</mo><mo>⟨</mo><mi>μ</mi><mo>,</mo><mi>ξ</mi>
//! <mo>⟩</mo><mo>−</mo><mi>l</mi><mo>(</mo><mi>ξ</mi><mo>)</mo><mspace width="2em"/>
//! <mfrac><mrow><mo>δ</mo><mi>h</mi></mrow><mrow><mo>δ</mo><mi>μ</mi></mrow></mfrac><mo>=</mo><mi>ξ</mi>
//! </math>
//!
//! ```
//! use liestep::groups::LieGroup;
//! use liestep::mechanics::ContinuousLagrangian;
//! use liestep::prelude::*;
//!
//! # #[lagrangian(group = SO3, velocity = Omega, l = 0.5 * Omega.dot(&(J * Omega)))]
//! # struct Body {
//! #     J: Inertia,
//! # }
//! let body = Body { J: Inertia::from_principal_moments(Vector3::new(1.0, 2.0, 2.5))? };
//! let Pi = Vector3::new(0.3, -0.4, 2.2);
//! let Omega = body.velocity(&Pi, &())?; // (1.14), inverted
//! let (rate, _) = body.lie_poisson(&Pi, &())?; // (1.12)
//! assert!((body.hamiltonian(&Pi, &())? - 0.5 * Pi.dot(&Omega)).abs() < 1e-15); // (1.16)
//!
//! // f = Π·e changes at the rate {f, h}.
//! let e = Vector3::new(1.0, 2.0, -1.0);
//! assert!((SO3::lie_poisson_bracket(&Pi, &e, &Omega) - e.dot(&rate)).abs() < 1e-15);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Discrete reduction
//!
//! A discrete Lagrangian approximates the action of a step, (1.18), and its path makes the sum of these stationary:
//!
//! <math display="block">
//! <msub><mi>L</mi><mi>d</mi></msub><mo>(</mo><msub><mi>q</mi><mn>0</mn></msub><mo>,</mo>
//! <msub><mi>q</mi><mn>1</mn></msub><mo>)</mo><mo>≈</mo><msubsup><mo>∫</mo><mn>0</mn><mi>h</mi></msubsup><mi>L</mi>
//! <mo>(</mo><mi>q</mi><mo>,</mo><mover><mi>q</mi><mo>˙</mo></mover><mo>)</mo><mi>d</mi><mi>t</mi>
//! <mspace width="2em"/><mo>δ</mo><mo>∑</mo><msub><mi>L</mi><mi>d</mi></msub><mo>(</mo>
//! <msub><mi>q</mi><mi>i</mi></msub><mo>,</mo><msub><mi>q</mi><mrow><mi>i</mi><mo>+</mo><mn>1</mn></mrow></msub>
//! <mo>)</mo><mo>=</mo><mn>0</mn>
//! </math>
//!
//! On a group, `L_d(g_1, g_2) = l_d(g_1⁻¹g_2)`, (1.22). The stationary path obeys the discrete Euler–Poincaré equation
//! (1.23), in which the pull-backs are the momenta (1.26) at the two ends of a step:
//!
//! ```text
//! (R_{f⁺})* δl_d/δf (f⁺) = (L_f)* δl_d/δf (f)        g⁺ = g f
//! ```
//!
//! You declare `l_d`; `F` is the increment `f`, `h` the step, `I` the identity. This is example 2:
//!
//! ```
//! use liestep::prelude::*;
//!
//! #[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
//! struct FreeBody {
//!     J_d: NonstandardInertia, // kg m²
//! }
//!
//! let generated = [
//!     "(R_F)* δl_d/δF = (1/h) (F J_d − J_d Fᵀ)^∨", // (1.31), twice the thesis' matrix
//!     "(L_F)* δl_d/δF = (1/h) (J_d F − Fᵀ J_d)^∨",
//!     "(1/h) (F⁺ J_d − J_d F⁺ᵀ)^∨ = (1/h) (J_d F − Fᵀ J_d)^∨", // (1.23)
//!     "𝕀 = tr(J_d) I − J_d", // the inertia that the matrix in the trace stands for
//! ];
//! for equation in generated {
//!     assert!(FreeBody::DERIVATION.contains(equation), "{equation}");
//! }
//!
//! let body = FreeBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(1.2, 0.8, 0.5))? };
//! let stepper = Stepper::new(body, 0.05)?; // s
//! let mut state = stepper.start(SO3::identity(), Vector3::new(0.3, -0.2, 0.9))?;
//! let momentum = stepper.spatial_momentum(&state);
//! stepper.run(&mut state, 1000)?;
//! assert!((stepper.spatial_momentum(&state) - momentum).norm() < 1e-13); // (1.32)
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`Stepper`] makes the steps of the discrete Lie–Poisson flow (1.28), `𝔽l_d⁺ ∘ (𝔽l_d⁻)⁻¹`, because a motion starts
//! from a momentum. [`DiscreteEulerPoincare`] is the flow (1.25) on increments.
//!
//! # Chapter 2: advected parameters
//!
//! Gravity isn't invariant under all rotations. Theorem 2.1.1 makes it so by a parameter `a = g⁻¹·a_0` that the group
//! carries along. The diamond (2.1), `⟨v ⋄ a, ξ⟩ = ⟨a, ξ·v⟩`, is what it adds to the equations (2.2):
//!
//! <math display="block">
//! <mfrac><mrow><mi>d</mi></mrow><mrow><mi>d</mi><mi>t</mi></mrow></mfrac>
//! <mfrac><mrow><mo>δ</mo><mi>l</mi></mrow><mrow><mo>δ</mo><mi>ξ</mi></mrow></mfrac><mo>=</mo>
//! <msubsup><mrow><mi>ad</mi></mrow><mi>ξ</mi><mo>*</mo></msubsup>
//! <mfrac><mrow><mo>δ</mo><mi>l</mi></mrow><mrow><mo>δ</mo><mi>ξ</mi></mrow></mfrac><mo>+</mo>
//! <mfrac><mrow><mo>δ</mo><mi>l</mi></mrow><mrow><mo>δ</mo><mi>a</mi></mrow></mfrac><mo>⋄</mo><mi>a</mi>
//! <mspace width="2em"/><mover><mi>a</mi><mo>˙</mo></mover><mo>=</mo><mo>−</mo><mi>ξ</mi><mo>·</mo><mi>a</mi>
//! <mspace width="2em"/><mover><mi>g</mi><mo>˙</mo></mover><mo>=</mo><mi>g</mi><mi>ξ</mi>
//! </math>
//!
//! `advected(w = up)` says that `w` is the field `up`, seen from the body. The heavy top of example 3, with the trace
//! of (2.3), and its three results:
//!
//! ```
//! use liestep::mechanics::ContinuousLagrangian;
//! use liestep::prelude::*;
//!
//! #[lagrangian(
//!     group = SO3,
//!     velocity = Omega,
//!     advected(w = up),
//!     l = 0.5 * (hat(Omega) * J_d * hat(Omega).transpose()).trace() - m * g * w.dot(&rho),
//!     discretise = trapezoid,
//! )]
//! struct HeavyTop {
//!     J_d: NonstandardInertia, // about the pivot, kg m²
//!     m: f64,                  // kg
//!     g: f64,                  // m/s²
//!     rho: Vector3<f64>,       // the centre of mass in the body, m
//!     up: Vector3<f64>,        // a_0, in space
//! }
//!
//! let generated = [
//!     "μ = tr(J_d) Omega − J_d Omega    [∂l/∂ξ, (1.14)]", // 1: 𝕀Ω
//!     "∂l/∂w ⋄ w = m g w × rho    [(2.1)]", // 3
//!     "dμ/dt = 𝕀 dOmega/dt = (tr(J_d) Omega − J_d Omega) × Omega + m g w × rho", // 2 and 3
//!     "dw/dt = w × Omega    [(2.2): −ξ·w]",
//!     "kept = h(μ, w); |w|²; ⟨μ, w⟩, the spatial momentum along it",
//! ];
//! for equation in generated {
//!     assert!(HeavyTop::CONTINUOUS_DERIVATION.contains(equation), "{equation}");
//! }
//!
//! // The last line of the declaration has made (3.13) of it.
//! assert!(HeavyTop::DERIVATION.contains(
//!     "l_d = −(1/h) tr(F J_d) + (1/h) tr(J_d) − (h m g/2) ⟨rho, Fᵀ w⟩ − (h m g/2) ⟨rho, w⟩",
//! ));
//! ```
//!
//! In the discrete theorem 2.2.1 increment and parameter go on together, (2.4):
//!
//! ```text
//! w⁺ = f⁻¹·w        (R_{f⁺})* δl_d/δf (f⁺, w⁺) − (δl_d/δw ⋄ w)(f⁺, w⁺) = (L_f)* δl_d/δf (f, w)
//! ```
//!
//! The parameter lives in `V*`, so `f⁻¹·w` is `ρ(f)ᵀw` in columns, which is `f⁻¹w` for rotations only. The left side is
//! the momentum (2.7). A step solves it for `f`, and the other two of (2.9) follow:
//!
//! ```text
//! μ = 𝔽l_d⁻(f, w)        μ⁺ = 𝔽l_d⁺(f, w)        w⁺ = f⁻¹·w        g⁺ = g f
//! ```
//!
//! # Chapter 3: the heavy top
//!
//! Section 3.1 describes a symmetric top, with moments `I_0` across its axis and `I` along it, in the frame `(X, Y, Z)` that
//! follows precession `φ` and nutation `θ`, but not the spin `ψ`; `ρ` is how far the centre of mass is up the axis:
//!
//! ```text
//! 𝕀 = diag(I_0, I_0, I)                                                     (3.5)
//! H_X = I_0 ω_X = I_0 θ'                                                    (3.6)
//! H_Y = I_0 ω_Y = I_0 φ' sin θ                                              (3.7)
//! H_Z = I ω_Z = I ψ' + I φ' cos θ                                           (3.8)
//! M_X = m g ρ sin θ,    M_Y = 0,    M_Z = 0                                 (3.9)
//! m g ρ sin θ = I_0 (θ'' − φ'² sin θ cos θ) + I φ' sin θ (φ' cos θ + ψ')    (3.10)
//! 0 = I_0 (φ'' sin θ + 2 φ' θ' cos θ) − I θ' (φ' cos θ + ψ')                (3.11)
//! 0 = I (ψ'' + φ'' cos θ − φ' θ' sin θ)                                     (3.12)
//! ```
//!
//! The equations of motion, (3.10) to (3.12), have poles where the axis is vertical. Here they are a rival and a reference of
//! the tests; a step has no angles in it.
//!
//! The trapezoidal rule with `Ω̂ ≈ (F − I)/h` makes (3.13) of (2.3):
//!
//! <math display="block">
//! <msub><mi>l</mi><mi>d</mi></msub><mo>(</mo><mi>F</mi><mo>,</mo><mi>w</mi><mo>)</mo><mo>=</mo>
//! <mfrac><mrow><mn>1</mn></mrow><mrow><mn>2</mn><mi>h</mi></mrow></mfrac><mi>tr</mi><mo>(</mo><mo>(</mo><mi>F</mi>
//! <mo>−</mo><mi>I</mi><mo>)</mo><msub><mi>J</mi><mi>d</mi></msub>
//! <msup><mrow><mo>(</mo><mi>F</mi><mo>−</mo><mi>I</mi><mo>)</mo></mrow><mi>T</mi></msup><mo>)</mo><mo>−</mo>
//! <mfrac><mrow><mi>h</mi></mrow><mrow><mn>2</mn></mrow></mfrac><mi>m</mi><mi>g</mi><mo>⟨</mo><mi>w</mi><mo>,</mo>
//! <mi>ρ</mi><mo>+</mo><mi>F</mi><mi>ρ</mi><mo>⟩</mo>
//! </math>
//!
//! It can be declared by itself, as it stands. The three items of section 3.2.1, then (3.16), (3.17) and (3.18), up to
//! the pairing:
//!
//! ```
//! use liestep::groups::LieGroup;
//! use liestep::mechanics::DiscreteLagrangian;
//! use liestep::prelude::*;
//!
//! #[lagrangian(
//!     group = SO3,
//!     advected(w = up),
//!     l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
//!         - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
//! )]
//! struct HeavyTop {
//!     J_d: NonstandardInertia,
//!     m: f64,
//!     g: f64,
//!     rho: Vector3<f64>,
//!     up: Vector3<f64>,
//! }
//!
//! let generated = [
//!     "(L_F)* δl_d/δF = (1/h) (J_d F − Fᵀ J_d)^∨ + (h m g/2) (rho wᵀ F − Fᵀ w rhoᵀ)^∨    [section 3.2.1, item 1; (2.6)]",
//!     "(R_F)* δl_d/δF = (1/h) (F J_d − J_d Fᵀ)^∨ + (h m g/2) (F rho wᵀ − w rhoᵀ Fᵀ)^∨    [section 3.2.1, item 2]",
//!     "δl_d/δw ⋄ w = (h m g/2) (F rho wᵀ − w rhoᵀ Fᵀ + rho wᵀ − w rhoᵀ)^∨    [(2.1)]", // item 3
//!     "(1/h) (F⁺ J_d − J_d F⁺ᵀ)^∨ + (h m g/2) (w⁺ rhoᵀ − rho w⁺ᵀ)^∨ = (1/h) (J_d F − Fᵀ J_d)^∨", // (3.16)
//!     "μ = (1/h) (F J_d − J_d Fᵀ)^∨ + (h m g/2) (w rhoᵀ − rho wᵀ)^∨    [(2.7)]", // (3.17)
//! ];
//! for equation in generated {
//!     assert!(HeavyTop::DERIVATION.contains(equation), "{equation}");
//! }
//!
//! // (3.17) typed by hand, with its ½ and its pairing.
//! let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
//! let top = HeavyTop { J_d, m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
//! let (h, w) = (0.01, Vector3::new(0.0, 0.6, 0.8));
//! let F = SO3::from(UnitQuaternion::from_scaled_axis(Vector3::new(0.02, 0.01, 0.1))).matrix();
//! let kinetic = (F * J_d.as_matrix() - J_d.as_matrix() * F.transpose()) / h;
//! let weight = (top.rho * w.transpose() - w * top.rho.transpose()) * (0.5 * h * top.m * top.g);
//! let Pi_hat = (kinetic - weight) * 0.5;
//! let Pi = Vector3::new(Pi_hat.m32, Pi_hat.m13, Pi_hat.m21); // Π̂^∨
//! assert!((top.legendre_minus(&F, &w, h) - Pi * 2.0).norm() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The numerical approach of section 3.2.1 is the stepper: (3.17) is solved for `F`, (3.14) and (3.15) move attitude
//! and parameter, and (3.18) is the next momentum. The looping top of figure 3.8, whose vertical momentum (3.20) is
//! exact:
//!
//! ```
//! use liestep::prelude::*;
//!
//! # #[lagrangian(
//! #     group = SO3,
//! #     advected(w = up),
//! #     l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
//! #         - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
//! # )]
//! # struct HeavyTop {
//! #     J_d: NonstandardInertia,
//! #     m: f64,
//! #     g: f64,
//! #     rho: Vector3<f64>,
//! #     up: Vector3<f64>,
//! # }
//! let J_d = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0))?;
//! let stepper = Stepper::new(HeavyTop { J_d, m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() }, 0.01)?;
//!
//! let (tilt, rates): (f64, [f64; 3]) = (0.8, [3.0, 0.5, 10.0]); // θ, and φ', θ', ψ'
//! let [precession, nutation, spin] = rates;
//! let attitude = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), tilt);
//! let velocity = Vector3::new(nutation, precession * tilt.sin(), spin + precession * tilt.cos()); // (3.2) to (3.4)
//!
//! let mut state = stepper.start(attitude, velocity)?; // Π = 𝕀Ω, with no half kick
//! let (vertical, energy) = (stepper.momentum_along_advected(&state), stepper.energy(&state));
//! for _ in 0..20_000 {
//!     stepper.step(&mut state)?; // to 200 s
//! }
//! assert!(state.orthogonality_defect() < 1e-13); // figure 3.4
//! assert!((stepper.momentum_along_advected(&state) - vertical).abs() < 1e-11); // figure 3.5, (3.20)
//! assert!((stepper.energy(&state) - energy).abs() < 1e-2); // figure 3.6, J
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! What a step conserves, and when it has no solution, is in [`guarantees`](crate::conventions::guarantees). Where a
//! printed equation has to be read with care is in [`errata`](crate::conventions::errata). `cargo run --release
//! --example thesis-figures` draws the figures again.
//!
//! # Beyond the thesis
//!
//! The same declaration is stepped at a higher order, up to 16, by [`methods`](crate::methods). Lagrangians add, as
//! `body + gravity`: see [`effects`](crate::effects). Other groups, and groups of your own, are in
//! [`groups`](crate::groups).
//!
//! [`DiscreteEulerPoincare`]: crate::motion::DiscreteEulerPoincare
//! [`Stepper`]: crate::Stepper
//! [`lie_bracket_transpose`]: crate::groups::LieGroup::lie_bracket_transpose
//! [`lie_poisson_bracket`]: crate::groups::LieGroup::lie_poisson_bracket
