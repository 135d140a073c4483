//! Systems of rigid bodies with joints, as values: any number of bodies, of terms on them and between them, and of joints.
//! A step of `N` bodies with `L` loops takes time `O(N + N L + L³)`. Terms that couple two bodies within a step, as friction
//! in a joint, add a block for each pair to Newton's matrix: the time stays so if pairs share a joint or are a row, and other
//! pairs fill the blocks on the path between their bodies.
//!
//! The configurations of the bodies are `q = (R_a, x_a)` on (SO(3) × R³)ᴺ, and joints are constraints `g(q) = 0`. With
//! the matrix `G` of the constraints' derivatives along `δR = R ẑ`, `δx`, a step is that of the bodies with the joints'
//! impulses in its momentum equation (2.7), and with the constraints imposed on the next configuration:
//!
//! ```text
//! a = μ + kick_before(w) − G(q)ᵀ λ            solve   U(F, w) = a,   g(q F) = 0            for F and λ
//! μ⁺ = Ad*_F a + kick_after(F, w⁺) − G(q⁺)ᵀ ν          with ν such that G(q⁺) J⁻¹ μ⁺ = 0
//! ```
//!
//! The step is RATTLE for (2.7) and (2.9). Positions are those of SHAKE, as `λ` absorbs the last `ν`; `ν` makes
//! velocities satisfy the constraints, too. The step is variational: order 2, symmetric and symplectic if the terms
//! are. In minimal coordinates, if there are any, it is the same as the step of the minimal form.
//!
//! The unknowns of Newton's iteration are half the coordinates `y` of `F` and the multipliers. The residual is affine
//! in the multipliers, so they need no initial guess from the last step. A Jacobian serves further updates while these shorten
//! fast enough.
//!
//! A body on a ball, a pin, a universal joint or a weld towards the root of its tree is eliminated in blocks of three. Such a
//! link of a chain takes 1.8 to 2.5 times the instructions of one of a [`Chain`](crate::methods::Chain), which has half the unknowns
//! and no momenta to project; the bench `systems` has both.

mod anew;
mod ball;
mod balls;
mod composed;
mod constraint;
mod couplings;
mod elimination;
mod ends;
mod equations;
mod forces;
mod functions;
mod graph;
mod joint;
mod newton;
mod nodes;
mod part;
mod point_joint;
mod point_mass;
mod propagator;
mod redundancy;
mod square;
mod start;
mod state;
mod step;
mod stepper;
mod sums;
mod system;
mod terms;
#[cfg(test)]
mod tests;
mod turning;
mod workspace;

pub use constraint::{Constraint, Place, Slope};
pub use joint::Joint;
pub use part::BodyPart;
pub use redundancy::Redundancy;
pub use stepper::MultibodyStepper;
pub use system::Multibody;

use nalgebra::{Vector3, Vector6};

use crate::groups::{LieGroup, R3, SO3};

/// The group of a body: a rotation, and a translation in the axes of space.
type Body = (SO3, R3);

/// The increments of a body.
type Increment = <Body as LieGroup>::Matrix;

/// The turn and the shift in the components of a body.
fn parts(components: &Vector6<f64>) -> (Vector3<f64>, Vector3<f64>) {
    (components.fixed_rows::<3>(0).into_owned(), components.fixed_rows::<3>(3).into_owned())
}

/// The place of a body.
fn place(body: &Body) -> Place {
    Place { attitude: *body.0.as_matrix(), position: body.1.translation() }
}

/// The body at a place.
fn body_at_place(place: &Place) -> Body {
    (SO3::from_matrix_unchecked(place.attitude), R3::from(place.position))
}

/// The place of a body, or of space.
fn place_of(places: &[Place], body: Option<usize>) -> &Place {
    body.map_or(&Place::SPACE, |body| &places[body])
}
