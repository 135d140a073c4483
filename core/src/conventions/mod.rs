//! Left and right, pairing, hat, frames, units, signs: what every formula of this crate means.
//!
//! This page is documentation only. The source of the theory is the thesis \[RDAE\]; its equation numbers are cited
//! as (2.7) throughout the crate. Three further pages: [`equations`] says where each of them lives in the code and what
//! checks it, [`errata`] where this crate departs from the thesis and why, [`guarantees`] what a step conserves and when
//! it exists.
//!
//! # Left and right
//!
//! The two momentum maps of a Lagrangian `l_d(F, w)` are pull-backs of its derivative to the identity. They are named
//! after the translation that is pulled back by, and the perturbation then stands on the *other* side of `F`:
//!
//! | name | definition | component `k` | frame on SO(3) |
//! |---|---|---|---|
//! | [`right_momentum`] | `(R_F)* δl_d/δF`, `R_F(g) = g F` | `d/ds l_d(exp(s E_k) F, w)` | body at the start of the step |
//! | [`left_momentum`] | `(L_F)* δl_d/δF`, `L_F(g) = F g` | `d/ds l_d(F exp(s E_k), w)` | body at the end of the step |
//!
//! They satisfy `left = Ad*_F right`, which tests can use as a law, because `F exp(sξ) = exp(s Ad_F ξ) F`.
//!
//! **A trap.** In robotics a "right Jacobian" belongs to the perturbation `F exp(s E_k)`, and some libraries name the
//! trivialisation, others the perturbation; public codes contradict each other on it. So nothing here is called left or
//! right except these two maps, the trivialisation of a Jacobian (a *right-trivialised* one differentiates along
//! `exp(t E_j) F`), and the choice of those two in a formula. The Legendre transforms are told apart by sign:
//!
//! | name | equation | |
//! |---|---|---|
//! | [`legendre_minus`] | `μ_i = right_momentum − diamond`, (2.7) | momentum at the start of the step |
//! | [`legendre_plus`] | `μ_{i+1} = left_momentum`, (2.6) | momentum at the end of the step |
//!
//! The first is a single variation in disguise, `μ_k = d/ds l_d(exp(s E_k) F, exp(s E_k)·w)` at `s = 0`: start point
//! and advected parameter move together.
//!
//! The stars mean transposes. `Ad*_F` is [`adjoint_transpose`], `⟨Ad*_F μ, ξ⟩ = ⟨μ, Ad_F ξ⟩`, on SO(3) `Fᵀμ`; the
//! coadjoint representation of textbooks is its inverse, `Ad*_{F⁻¹}`, and isn't used under that name. `ad*_ξ` is
//! [`lie_bracket_transpose`], on SO(3) `μ × ξ`, (1.17).
//!
//! # Hat and pairing
//!
//! `ξ̂ = Σ ξ_k E_k` makes an algebra element of components, `vee` undoes it. On SO(3) `ξ̂ v = ξ × v` and `[ξ̂, η̂] =
//! (ξ × η)^`.
//!
//! Covectors are never matrices here. They are their components `μ_k = ⟨μ, E_k⟩`, paired with those of a velocity by
//! `Σ μ_k ξ_k`. On SO(3) they are the components of the physical angular momentum and no factor ½ appears anywhere.
//! The thesis writes a covector of so(3) as a skew matrix `Π̂`, paired by `tr(AᵀB)`. As `tr(âᵀb̂) = 2 a·b`, its matrices
//! are `Π̂ = ½ Σ μ_k Ê_k`:
//!
//! ```text
//! Π̂^∨ = μ/2        Π̂ = ½ μ̂
//! ```
//!
//! # Frames
//!
//! The attitude `g` (`R` on SO(3)) takes body components to space components; its columns are the body's axes seen from
//! space. Increments multiply on the right, `g_{i+1} = g_i F_i`, so `F`, velocities `ξ`, momenta `μ`, the inertias and
//! `w` are all in the body frame, at the time that their index says. Quantities of the space frame have `spatial` in
//! their name or are said to be spatial.
//!
//! # Advected parameters live in `V*`
//!
//! The group acts on `V`, with matrices `ρ(g)`; the advected parameter is an element of the dual, and moves by the
//! contragredient action `⟨g·w, v⟩ = ⟨w, g⁻¹·v⟩`. In columns
//!
//! ```text
//! w_{i+1} = f_i⁻¹ · w_i = ρ(f_i)ᵀ w_i        w_i = ρ(g_i)ᵀ a_0
//! ```
//!
//! which is `ρ(f)⁻¹ w` only where `ρ(f)` is orthogonal, as on SO(3). The declared field (`up` for a top) is the spatial
//! value `a_0`, the same at all times; `w` in the expression is what the body sees of it. The diamond is
//! `⟨δl_d/δw ⋄ w, ξ⟩ = ⟨w, ξ·δl_d/δw⟩ = −d/ds l_d(F, exp(sξ)·w)`, (2.1).
//!
//! # The initial momentum
//!
//! `μ_0` belongs to the same instant as `g_0` and `w_0` and is the physical momentum there: `μ_0 = J Ω_0` for a rigid
//! body, which is what [`Stepper::start`] computes. The half kick `(h/2) τ(w_0)` of the potential is part of the
//! momentum equation (2.7); adding it to `μ_0` as well costs an order of accuracy, and so does `F_0 = exp(hΩ_0)`.
//!
//! # `J_d` and `J`, readings A and B
//!
//! The matrix in the trace of (3.13) is the nonstandard inertia `J_d = ∫ X Xᵀ dm`, not the inertia
//! `J = ∫ (X·X I − X Xᵀ) dm = tr(J_d) I − J_d`; see [`NonstandardInertia`]. The thesis gives `diag(2, 2, 1)` and
//! doesn't use it in one sense only, so there are two readings, and every figure names its own:
//!
//! | reading | `J_d`, kg m² | `J`, kg m² | |
//! |---|---|---|---|
//! | A | `diag(2, 2, 1)` | `diag(3, 3, 4)` | as (3.13) is printed; the default |
//! | B | `diag(½, ½, 3/2)` | `diag(2, 2, 1)` | the values taken as the inertia |
//!
//! # Units
//!
//! Nothing is dimensionless by assumption; any coherent system will do. In SI units on SO(3):
//!
//! | quantity | unit |
//! |---|---|
//! | step `h`, time | s |
//! | attitude `g`, increment `F`, a direction `w` | 1 |
//! | algebra coordinates of an increment | rad |
//! | body velocity `ξ`, `Ω` | rad/s |
//! | momentum `μ`, `Π`; a Legendre transform, the diamond, a kick | kg m²/s |
//! | `J_d`, `J` | kg m² |
//! | centre of mass `ρ` | m |
//! | Lagrangian `l_d` (an action) | J s |
//! | energy, potential | J |
//!
//! # Notation
//!
//! | notation | identifier |
//! |---|---|
//! | `l_d(F, w)` | [`DiscreteLagrangian`], [`l_d`](crate::mechanics::DiscreteLagrangian::l_d) |
//! | `l_d¹ + l_d²` | [`Sum`](crate::mechanics::Sum); a term, whether or not a Lagrangian, is an [`Effect`](crate::mechanics::Effect) |
//! | `(R_F)* δl_d/δF`, `(L_F)* δl_d/δF` | [`right_momentum`], [`left_momentum`] |
//! | `δl_d/δw ⋄ w` | [`diamond`](crate::mechanics::DiscreteLagrangian::diamond) |
//! | `𝔽l_d⁻`, `𝔽l_d⁺` | [`legendre_minus`], [`legendre_plus`] |
//! | `Ad_g`, `Ad*_g` | [`adjoint`](crate::groups::LieGroup::adjoint), [`adjoint_transpose`] |
//! | `ad_ξ`, `ad*_ξ` | [`lie_bracket`](crate::groups::LieGroup::lie_bracket), [`lie_bracket_transpose`] |
//! | `{f, k}(μ)` | [`lie_poisson_bracket`](crate::groups::LieGroup::lie_poisson_bracket) |
//! | `l(ξ, w)`, `h(μ, w)` | [`ContinuousLagrangian`](crate::mechanics::ContinuousLagrangian), [`hamiltonian`](crate::mechanics::ContinuousLagrangian::hamiltonian) |
//! | `ξ̂`, `^∨` | [`hat`](crate::groups::LieGroup::hat), [`vee`](crate::groups::LieGroup::vee) |
//! | `τ(ξ)`, `τ⁻¹(F)` | [`retract`](crate::groups::Retraction::retract), [`local_coordinates`](crate::groups::Retraction::local_coordinates) |
//! | `D = F − I` | [`increment`](crate::groups::LieGroup::increment) |
//! | `F_{l_d}`, `F_{h_d}` (flows) | [`DiscreteEulerPoincare`], [`DiscreteLiePoisson`] |
//! | `g_{i+1} = g_i f_i` | [`reconstruct`](crate::motion::reconstruct) |
//! | `w_{i+1} = f_i⁻¹ w_i` | [`advect`](crate::groups::Advected::advect) |
//! | `a_0`; the thesis' `w_0` of chapter 2 | [`advected`](crate::mechanics::Term::advected) |
//! | `J_d`, `J` | [`NonstandardInertia`], [`Inertia`](crate::mechanics::Inertia) |
//! | `μ_i`, `Π_i` | [`momentum`](crate::motion::Motion::momentum) |
//! | `R Π`, `e₃·R Π` | [`spatial_momentum`](crate::motion::Motion::spatial_momentum), [`momentum_along`](crate::motion::Motion::momentum_along) |
//! | `‖RᵀR − I‖` | [`orthogonality_defect`](crate::motion::Motion::orthogonality_defect) |
//! | `E`, `−∂l_d/∂h` | [`energy`](crate::motion::Stepper::energy), [`discrete_energy`](crate::mechanics::DiscreteLagrangian::discrete_energy) |
//!
//! # Bibliography
//!
//! | key | |
//! |---|---|
//! | \[RDAE\] | Prasanth YSS, *Reduced Discrete Advected Equations*, Master of Technology thesis, Indian Institute of Technology Bombay, 2021 |
//! | \[LML05\] | T. Lee, N. H. McClamroch, M. Leok, *A Lie group variational integrator for the attitude dynamics of a rigid body with applications to the 3D pendulum*, IEEE Conference on Control Applications, 2005 |
//! | \[MW01\] | J. E. Marsden, M. West, *Discrete mechanics and variational integrators*, Acta Numerica 10, 2001 |
//! | \[HSS09\] | D. D. Holm, T. Schmah, C. Stoica, *Geometric Mechanics and Symmetry*, Oxford University Press, 2009 |
//! | \[BGGS80\] | G. Benettin, L. Galgani, A. Giorgilli, J.-M. Strelcyn, *Lyapunov characteristic exponents for smooth dynamical systems and for Hamiltonian systems; a method for computing all of them*, Meccanica 15, 1980 |
//! | \[Su90\] | M. Suzuki, *Fractal decomposition of exponential operators with applications to many-body theories and Monte Carlo simulations*, Physics Letters A 146, 1990 |
//! | \[KL97\] | W. Kahan, R.-C. Li, *Composition constants for raising the orders of unconventional schemes for ordinary differential equations*, Mathematics of Computation 66, 1997 |
//! | \[SS05\] | M. Sofroniou, G. Spaletta, *Derivation of symmetric composition constants for symmetric integrators*, Optimization Methods and Software 20, 2005 |
//! | \[FR90\] | E. Forest, R. D. Ruth, *Fourth-order symplectic integration*, Physica D 43, 1990 |
//! | \[ML93\] | R. I. McLachlan, *Explicit Lie–Poisson integration and the Euler equations*, Physical Review Letters 71, 1993 |
//! | \[TW94\] | J. Touma, J. Wisdom, *Lie–Poisson integrators for rigid body dynamics in the solar system*, The Astronomical Journal 107, 1994 |
//! | \[Fa03\] | F. Fassò, *Comparison of splitting algorithms for the rigid body*, Journal of Computational Physics 189, 2003 |
//! | \[BM02\] | S. Blanes, P. C. Moan, *Practical symplectic partitioned Runge–Kutta and Runge–Kutta–Nyström methods*, Journal of Computational and Applied Mathematics 142, 2002 |
//! | \[ML95\] | R. I. McLachlan, *Composition methods in the presence of small parameters*, BIT 35, 1995 |
//! | \[Ch97\] | S. A. Chin, *Symplectic integrators from composite operator factorizations*, Physics Letters A 226, 1997 |
//! | \[LR01\] | J. Laskar, P. Robutel, *High order symplectic integrators for perturbed Hamiltonian systems*, Celestial Mechanics and Dynamical Astronomy 80, 2001 |
//! | \[OMF02\] | I. P. Omelyan, I. M. Mryglod, R. Folk, *Construction of high-order force-gradient algorithms for integration of motion in classical and quantum systems*, Physical Review E 66, 2002 |
//! | \[BCF13\] | S. Blanes, F. Casas, A. Farrés, J. Laskar, J. Makazaga, A. Murua, *New families of symplectic splitting methods for numerical integration in dynamical astronomy*, Applied Numerical Mathematics 68, 2013 |
//! | \[BCR99\] | S. Blanes, F. Casas, J. Ros, *Symplectic integration with processing: a general study*, SIAM Journal on Scientific Computing 21, 1999 |
//! | \[BCM06\] | S. Blanes, F. Casas, A. Murua, *Composition methods for differential equations with processing*, SIAM Journal on Scientific Computing 27, 2006 |
//! | \[AS64\] | M. Abramowitz, I. A. Stegun (editors), *Handbook of Mathematical Functions*, National Bureau of Standards, 1964 |
//! | \[HLW06\] | E. Hairer, C. Lubich, G. Wanner, *Geometric Numerical Integration*, 2nd edition, Springer, 2006 |
//! | \[HW96\] | E. Hairer, G. Wanner, *Solving Ordinary Differential Equations II*, 2nd edition, Springer, 1996 |
//! | \[AMM17\] | M. Antoñana, J. Makazaga, A. Murua, *Reducing and monitoring round-off error propagation for symplectic implicit Runge–Kutta schemes*, Numerical Algorithms 76, 2017 |
//!
//! The Lagrangian (3.13) gives the integrator of \[LML05\], with the same momentum; the discrete Legendre transforms
//! and the order of accuracy they imply are those of \[MW01\]; the continuous theory of chapter 1 is in \[HSS09\].
//!
//! [`right_momentum`]: crate::mechanics::DiscreteLagrangian::right_momentum
//! [`left_momentum`]: crate::mechanics::DiscreteLagrangian::left_momentum
//! [`legendre_minus`]: crate::mechanics::DiscreteLagrangian::legendre_minus
//! [`legendre_plus`]: crate::mechanics::DiscreteLagrangian::legendre_plus
//! [`adjoint_transpose`]: crate::groups::LieGroup::adjoint_transpose
//! [`lie_bracket_transpose`]: crate::groups::LieGroup::lie_bracket_transpose
//! [`DiscreteLagrangian`]: crate::mechanics::DiscreteLagrangian
//! [`DiscreteEulerPoincare`]: crate::motion::DiscreteEulerPoincare
//! [`DiscreteLiePoisson`]: crate::motion::DiscreteLiePoisson
//! [`NonstandardInertia`]: crate::mechanics::NonstandardInertia
//! [`Stepper::start`]: crate::motion::Stepper::start

#![allow(clippy::doc_markdown)] // the author McClamroch isn't code

pub mod equations;
pub mod errata;
pub mod guarantees;
