//! What a step conserves, and when it exists.
//!
//! # Conserved
//!
//! In the transport form a step is `(μ, w) ↦ (Ad*_F (μ + δl_d/δw ⋄ w), F⁻¹·w)`: the coadjoint action of an element of
//! the semidirect product of `G` and `V`. What that action leaves alone is exact, whatever Lagrangian is declared.
//! "Exact" means up to rounding, which grows like the square root of the number of steps. Only a body that turns
//! steadily rounds in the same way step by step; its attitude, and what it sees, are put back where that has taken them
//! far.
//!
//! | quantity | conserved | for |
//! |---|---|---|
//! | `F ∈ G`, and so the attitude in the group | exactly | every Lagrangian |
//! | Casimirs; on SO(3) with one vector `w·w` and `p·w = e₃·R p`, (3.20) | exactly | every Lagrangian |
//! | the Lie–Poisson structure of `(μ, w)` | exactly | every Lagrangian |
//! | `R p`, the spatial momentum | exactly | nothing advected |
//! | `Σ R_a p_a` over bodies that see each other; its component along `a` where they also see one vector `a` | exactly | none of them is `seen_from(space)` |
//! | `Σ p_a`, the momentum of bodies that are translated | exactly | `l_d` has only differences of their places, as by `seen_from` of another |
//! | of bodies held together by joints, with `p_a` of translations and `Π_a` of turns: `Σ p_a` and `Σ (x_a × p_a + R_a Π_a)`; where there is a pivot, the component of the latter sum along a vertical through it | as far as steps are solved | what else pulls the bodies leaves it alone |
//! | `p_3` | exactly | `J_1 = J_2`, `ρ` along the third axis |
//! | a step back by `−h` undoes the step | exactly | `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)`; (3.13) is such, others by [`SELF_ADJOINT`](crate::mechanics::DiscreteLagrangian::SELF_ADJOINT) |
//! | kinetic energy `½ p·J⁻¹p` | exactly | the kinetic term of (3.13) alone; not for other kinetic terms |
//! | energy with a potential | nearly: it oscillates with an amplitude of order `h²` and doesn't drift | steps well inside the limit below |
//! | phase, period | not: the error is of order `h²` and grows with time | |
//!
//! For (3.13) the energy that is kept more closely is known. With `Ω = J⁻¹p`, `γ = Ω × JΩ` and `V''` the second time
//! derivative of the potential along the free motion,
//!
//! ```text
//! H + h² [ ((Ω·JΩ) Ω·Ω − γ·J⁻¹γ)/24 + V''/12 − τ·J⁻¹τ/24 ]        V'' = m g [(w × Ω) × Ω + w × J⁻¹(JΩ × Ω)]·ρ
//! ```
//!
//! oscillates with an amplitude of order `h⁴`. A wrong sign or factor in any momentum term spoils that, so it makes a
//! sharp test.
//!
//! # As types
//!
//! What a scene conserves follows from its terms, so it is said in traits; asking a scene for what it hasn't got
//! doesn't compile, and the message names the term in the way.
//!
//! | scene | trait | what it gives |
//! |---|---|---|
//! | has a kinetic part | [`Regular`](crate::mechanics::Regular) | it can be stepped |
//! | only Lagrangians, no force | [`DiscreteLagrangian`](crate::mechanics::DiscreteLagrangian) | bounded energy, Poisson structure, [`Stepper::inverse`](crate::motion::Stepper::inverse) |
//! | and nothing advected | [`LeftInvariant`](crate::mechanics::LeftInvariant) | [`Stepper::spatial_momentum`](crate::motion::Stepper::spatial_momentum) |
//! | or one vector advected, on SO(3) | [`AxiallyInvariant`](crate::mechanics::AxiallyInvariant) | [`Stepper::momentum_along_advected`](crate::motion::Stepper::momentum_along_advected) |
//!
//! # Solvability
//!
//! For (3.13) the momentum equation is `(F J_d − J_d Fᵀ)^∨ = h a` with `a = p + (h/2) τ(w)`. For the inertia of a body
//! (`J_d` positive semidefinite, `J` positive definite, with least and greatest moments `J_min`, `J_max`):
//!
//! | condition | solutions |
//! |---|---|
//! | `h ‖a‖ < J_min` | exactly one with an angle below 90°, and that is the one taken |
//! | in between | depends on the direction of `a`; the wanted solution ends in a fold |
//! | `h ‖a‖ > J_max` | none |
//!
//! About a principal axis the equation reads `sin θ = h Ω`, which shows the fold at 90° a step and the second solution
//! `π − θ`. The other solutions are the reason for the check in a step: along the branch that begins at `F = I` the
//! determinant of the Jacobian `tr(F J_d) I − F J_d` keeps its sign up to the fold. A step beyond it is the error
//! [`StepError::BeyondSolvable`](crate::error::StepError::BeyondSolvable), which names the largest step that would do.
//!
//! A `J_d` with a negative eigenvalue has no such limit at 90°, but one that may lie anywhere; it isn't the inertia of
//! a body and is refused. A rod or a point (`J` singular) has no solution for a momentum along the axis, and is
//! refused.
