//! Where the thesis \[RDAE\] has to be read with care.
//!
//! The equations that aren't listed hold as printed. `p` stands for the momentum components of this crate, `Π̂` for the
//! matrices of the thesis, `J` for the inertia of `J_d`, and `τ(w) = m g w × ρ` for the torque of gravity.
//!
//! # What changes numbers
//!
//! | where | printed | to be read as | why |
//! |---|---|---|---|
//! | (1.31), (3.17), (3.18) against (1.17), (1.32), (3.19) | one letter `Π` | `Π̂^∨ = p/2` in the first group, `p` in the second | two pairings, `tr(AᵀB)` of matrices and the dot product of vectors; taken with `Π̂^∨`, (3.19) needs `h/4` in place of `h/2` |
//! | examples 1 and 3, (2.3), section 3.2 | the matrix inside the trace is an inertia about the pivot | the nonstandard inertia `J_d` | `½ tr(Ω̂ J_d Ω̂ᵀ) = ½ Ω·(tr(J_d) I − J_d)Ω`; `J_d = diag(2, 2, 1)` is the body with `J = diag(3, 3, 4)` |
//! | theorem 2.2.1, (2.4), (2.6), (2.9) | `w_{i+1} = f_i⁻¹ w_i` | `ρ(f_i)ᵀ w_i` | the parameter lives in `V*`; the plain product is right for orthogonal representations only, and wrong on SE(3) |
//! | section 3.1, `Ω_Z` of the frame `(X, Y, Z)` | `ψ' + φ' cos θ` | `φ' cos θ` | that frame doesn't take part in the spin `ψ`; (3.10) to (3.12) use the right one |
//! | section 3.2, arguments of `L_d` | `w_i` | the spatial `a_0 = e₃` | `L` contains `R`, so it must be given the vector in space; (3.13), written in the body, is right |
//! | section 3.2.1, diamond, third line | `exp(sξ)ρ − exp(sρ)Fρ` | `exp(sξ)ρ + exp(sξ)Fρ` | sign and exponent; the line after it is right |
//! | section 3.2.2, line before (3.19) | `R_{i+1}ᵀ Π_{i+1} − R_iᵀ Π_i` | `R_{i+1} Π̂_{i+1} R_{i+1}ᵀ − R_i Π̂_i R_iᵀ` | a matrix momentum is carried to space by conjugation, a vector by `R`, as in (3.19) itself; on its right side the hat covers the whole sum |
//! | figure 3.10 | "unidirectional" | looping under reading A | with the printed `J_d`, `m`, `ρ` and `g = 9.81` the precession reverses; it is unidirectional under reading B |
//!
//! Readings A and B are defined in [`conventions`](super). Each row fails a test as it is printed and passes it as it is
//! to be read: `tests/derivation/thesis.rs`, `tests/hard_cases/bodies/euler_angles.rs` for `Ω_Z`, the law
//! `kinds_move_as_declared` on SE(3) for theorem 2.2.1, and row T11 of the hard cases for figure 3.10.
//!
//! # What only changes words
//!
//! | where | remark |
//! |---|---|
//! | theorem 1.1.1, proof | the derivative of `exp(εη(t))` in `t` is right to first order in `ε`, which is all that is used |
//! | lemma 1.2.1 | its functions live on `𝔤*`; the bracket of two algebra elements is `ad`, without a star |
//! | chapter 1, introduction | the cotangent bundle `TG*` is `T*G` |
//! | example 1 | `𝔽L⁻¹` and `L` in the line of `h(Π)` are the reduced `𝔽l⁻¹` and `l` |
//! | section 1.4 | a path has `N` points; in (1.20) the flow is `F_{H_d}`, and in the right half of its diagram the two transforms have changed places |
//! | section 1.4, property 3 | the point with the number `k` is `q(kh)`, not `q(k)` |
//! | chapter 2 | `w_0` is the spatial constant, here `a_0`; it is the value of `w` at `i = 0` only for `g_0 = e` |
//! | theorem 2.2.1 | `l_d(f, w)` is defined by `L_d`; the sum by parts has boundary terms, which vanish with the variations at the ends |
//! | (2.4), (2.6), (2.7) | `δl_d/δf` is taken at `(f, w)`: gravity couples the two |
//! | (2.5) | the flow also moves the parameter, `v = f⁻¹·u` |
//! | (3.1) | this `R` has no spin: `R_z(φ) R_x(θ)`; the attitude of section 3.2 is `R_z(φ) R_x(θ) R_z(ψ)` |
//! | (3.9) | `ρ` is a length here and a vector elsewhere |
//! | section 3.2.1 | a pull-back is set equal to its value on `η`; read both sides as applied to `η` |
//! | section 3.2.1, footnote 2 | `w` determines the attitude up to a rotation about the vertical |
//! | section 3.2.2 | what is constant for a symmetric top is `Ω_Z = ψ' + φ' cos θ`, not `ψ'` |
//! | section 3.2.2 | the decay ascribed to Runge–Kutta is that of large steps; at small ones its energy error is the smaller one for a long time, though its attitude leaves the group |
//! | section 3.2.3 | the top with `J_1 = J_2` and `ρ` along the axis is integrable, so its motion isn't chaotic |
//! | section 3.2.2, energy | "theoretically, we did study the energy conservation property" means "did not" |
//! | section 3.2.2, figures | `g`, `h`, `φ(0)` and `ψ(0)` aren't given; here 9.81 m/s², as said at each figure, 0 and 0 |
//!
//! The step `h = 0.1 s`, which tests call the published one, is that of the script that the author has published, and
//! not of the thesis. That script starts from the momentum `diag(2, 2, 1) Ω` of reading B and steps with the inertia of
//! reading A, takes 9.8 m/s² in the step and 9.81 m/s² elsewhere, and plots `T − U` as the energy. So no choice of the
//! two readings repeats its figures.
//!
//! # The start of a motion
//!
//! The thesis gives initial Euler angles and rates. With the attitude of section 3.2,
//!
//! ```text
//! R_0 = R_z(φ) R_x(θ) R_z(ψ)
//! Ω_0 = (θ' cos ψ + φ' sin θ sin ψ,  −θ' sin ψ + φ' sin θ cos ψ,  ψ' + φ' cos θ)
//! w_0 = (sin ψ sin θ,  cos ψ sin θ,  cos θ)
//! p_0 = J Ω_0
//! ```
