//! Rates of common densities of steps, for [`Stepper::with_density`](crate::Stepper::with_density).

use nalgebra::{Matrix3, Vector3, Vector6};

use crate::groups::{R3, SO3};
use crate::mechanics::{DiscreteLagrangian, inertia};
use crate::motion::Motion;
use crate::numbers::{Bodies, Coordinates as _};

/// The rate `G = −p r·ṙ/|r|²`, 1/s, for steps proportional to the power `p` of the distance between two of several
/// bodies, counted from zero. For two bodies that attract each other by gravity Kepler's own power is 3/2.
#[allow(clippy::type_complexity)] // the type that `with_density` requires
pub fn distance<const N: usize, A>(
    bodies: [usize; 2],
    power: f64,
) -> impl Fn(&Motion<[(SO3, R3); N], A>, &Bodies<Vector6<f64>, N>) -> f64 + Clone {
    move |motion, velocity| {
        let [from, to] = bodies.map(|body| (motion.attitude.get(body), velocity.0.get(body)));
        let ((Some((_, from)), Some(back)), (Some((_, to)), Some(ahead))) = (from, to) else { return f64::NAN };
        let apart = to.translation() - from.translation();
        let rate = ahead.fixed_rows::<3>(3) - back.fixed_rows::<3>(3);
        -power * apart.dot(&rate) / apart.norm_squared()
    }
}

/// The rate `G = Ω·Ω̇/(|Ω|² + ω²)`, 1/s, for steps in which a body turns by about the same angle,
/// `h ∝ (|Ω|² + ω²)^{-1/2}`, with a `floor` `ω`, rad/s, of the velocity that limits the length of a step.
/// `J Ω̇ = μ × Ω + τ` has the torque `τ` of the scene at rest, without forces. If the inertia depends on the attitude
/// `Ω̇` is approximate, which a density may be.
///
/// # Source
///
/// \[RDAE, (1.12)\]; the diamond of `l_d(I, w) = −h V(w)` is `h τ`.
#[allow(clippy::type_complexity)] // as above
pub fn turn<L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Clone>(
    scene: L,
    floor: f64,
) -> impl Fn(&Motion<SO3, L::Advected>, &Vector3<f64>) -> f64 + Clone {
    move |motion, velocity| {
        let torque = scene.diamond(&Matrix3::identity(), &motion.advected, 1.0);
        let (rate, _) = Vector3::solve(&inertia(&scene, &motion.advected), &(motion.momentum.cross(velocity) + torque));
        velocity.dot(&rate) / (velocity.norm_squared() + floor * floor)
    }
}
