//! Other groups, groups of one's own, and what they carry.
//!
//! Before: [effects and forces](super::effects). Next: [several bodies](super::bodies).
//!
//! # The groups there are
//!
//! `SO2`, `SO3`, `SE2`, `SE3`, `SE23`, `SU2`, `SL2`, `Heisenberg`, `R1`, `R2`, `R3`: [`groups`](crate::groups) has a page for
//! each, with the basis `E_k` of its algebra. A declaration names one, and all of this crate that isn't about rotations
//! works for it: steps, forces, compositions, events, recording, gradients. `F` is the group's matrix, and vectors have the
//! size of its columns.
//!
//! On SE(2) and SE(3) these columns are homogeneous coordinates. A free rigid body has the kinetic term of (3.13) with
//! `J = ∫ X Xᵀ dm` of `X = (x, y, z, 1)`: second moments, first moments, and the mass in the last corner.
//!
//! ```
//! use liestep::nalgebra::{Matrix4, Vector4, Vector6};
//! use liestep::prelude::*;
//!
//! #[lagrangian(
//!     group = SE3,
//!     advected(w = up),
//!     l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * g * w.dot(&(r + F * r)),
//! )]
//! struct Thrown {
//!     J: Matrix4<f64>,  // ∫ X Xᵀ dm
//!     g: f64,           // m/s²
//!     r: Vector4<f64>,  // ∫ X dm: first moments and mass
//!     up: Vector4<f64>, // the height as a function of the place: n·x + c
//! }
//!
//! // 2 kg with the centre of mass at the origin.
//! let J = Matrix4::from_diagonal(&Vector4::new(0.2, 0.1, 0.3, 2.0));
//! let thrown = Thrown { J, g: 9.81, r: Vector4::new(0.0, 0.0, 0.0, 2.0), up: Vector4::new(0.0, 0.0, 1.0, 0.0) };
//! let stepper = Stepper::new(thrown, 0.01)?;
//!
//! // Rotation first, then velocity, both in the body frame.
//! let mut state = stepper.start(SE3::identity(), Vector6::new(1.0, -2.0, 0.5, 3.0, 0.0, 4.0))?;
//! stepper.run(&mut state, 100)?;
//! let place = state.attitude().matrix() * Vector4::w();
//! assert!((place.x - 3.0).abs() < 1e-3 && (place.z - (4.0 - 0.5 * 9.81)).abs() < 1e-3);
//! assert!(state.orthogonality_defect() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! `tests/random_lagrangians` and `tests/derivation/other_groups.rs` declare Lagrangians on all of them, and
//! `examples/declarations/underwater_body.rs` is Kirchhoff's body in a fluid. On SO(3) the steps are tuned for speed; on other groups the derived terms are as exact, and
//! the step isn't.
//!
//! # What the group carries
//!
//! An advected parameter is an element of a representation. Its field's type says of which:
//!
//! | field | moves as `f⁻¹·w =` | |
//! |---|---|---|
//! | `Vector3<f64>`, of the size of `F` | `ρ(f)ᵀ w` | a covector: what measures, like the vertical |
//! | `Point3<f64>` on SE(3), `Point2<f64>` on SE(2) | `ρ(f)⁻¹ w` | a place |
//! | [`ContravariantVector`](crate::groups::ContravariantVector) | `ρ(f)⁻¹ w` | a vector: what is measured |
//! | [`CovariantTensor`](crate::groups::CovariantTensor), [`ContravariantTensor`](crate::groups::ContravariantTensor), [`MixedTensor`](crate::groups::MixedTensor) | | of second rank |
//!
//! On SO(3) the first three are the same. Elsewhere they aren't, and a vector where a covector belongs is another problem, so
//! [`conventions`](crate::conventions#advected-parameters-live-in-v) is worth its two minutes.
//!
//! # A group of one's own
//!
//! A matrix group, of matrices with at most eight rows, is declared by its generators, written once, and by a relation that tells members from others. The
//! affine maps `x ↦ a x + b` of the line:
//!
//! ```
//! use liestep::groups::LieGroup as _;
//! use liestep::nalgebra::{Matrix2, RealField, SMatrix, Vector2};
//! use liestep::{Stepper, lagrangian};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! liestep::groups::matrix_group! {
//!     /// Matrices `[a, b; 0, 1]` with `a > 0`: `E_1` stretches, `E_2` shifts.
//!     pub type Affine = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [0.0, 0.0]]];
//!
//!     /// Zero on the group, and nowhere else.
//!     fn relation<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> T {
//!         m[(1, 0)].abs() + (m[(1, 1)] - T::one()).abs()
//!     }
//! }
//!
//! // With the mark the declaration finds the generators.
//! #[lagrangian(group = Affine!, l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h))]
//! struct Line {
//!     J: Matrix2<f64>, // kg m²
//! }
//!
//! let stepper = Stepper::new(Line { J: Matrix2::new(1.0, 0.2, 0.2, 2.0) }, 0.01)?;
//! let mut state = stepper.start(Affine::identity(), Vector2::new(0.1, 0.2))?;
//! let momentum = stepper.spatial_momentum(&state);
//! stepper.run(&mut state, 1000)?;
//! assert!((stepper.spatial_momentum(&state) - momentum).norm() < 1e-12);
//! assert!(Affine::<f64>::try_from(Matrix2::new(2.0, 1.0, 0.25, 1.0)).is_err());
//! # Ok(())
//! # }
//! ```
//!
//! That the generators are orthogonal and span a Lie algebra is checked when the program is compiled. That the group
//! satisfies its laws is for tests, which [`laws`](crate::laws) has ready made:
//!
//! ```text
//! liestep::lie_group_laws!(Affine);
//! liestep::advected_laws!(Affine);
//! liestep::retraction_laws!(Affine, liestep::groups::CayleyRetraction);
//! ```
//!
//! `examples/how-to-add-a-group.rs` has them and a potential. On a group whose kinetic term isn't self-adjoint the step is
//! of first order only, and the documentation of the struct says so: there `Line::SELF_ADJOINT` is false.
//!
//! # Products
//!
//! A tuple of groups is a group, `(SO3, SO3)` for two bodies: [several bodies](super::bodies).
