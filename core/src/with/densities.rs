//! Rates of densities of steps, ready made: [`Stepper::with_density`](crate::Stepper::with_density) takes them.

use nalgebra::{Matrix3, Vector3, Vector6};

use crate::groups::{R3, SO3};
use crate::mechanics::DiscreteLagrangian;
use crate::motion::Motion;
use crate::numbers::{Bodies, Coordinates as _};

/// Steps proportional to the power `p` of the distance between two of several bodies, counted from zero:
/// `G = −p r·ṙ/|r|²`, 1/s. Of two bodies that attract each other by gravity 3/2 is Kepler's own.
#[allow(clippy::type_complexity)] // what `with_density` asks for
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

/// Steps in which a body turns by about as much, `h ∝ (|Ω|² + ω²)^{-1/2}` with `ω` in rad/s, below which they don't get
/// longer: `G = Ω·Ω̇/(|Ω|² + ω²)`, 1/s, with `J Ω̇ = μ × Ω + τ` and the torque `τ` of the scene at rest, without forces. Where
/// the inertia depends on the attitude `Ω̇` is about that, which a density may be.
///
/// # Source
///
/// \[RDAE, (1.12)\]; as `l_d(I, w) = −h V(w)`, its diamond there is `h τ`.
#[allow(clippy::type_complexity)] // as above
pub fn turn<L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Clone>(
    scene: L,
    floor: f64,
) -> impl Fn(&Motion<SO3, L::Advected>, &Vector3<f64>) -> f64 + Clone {
    move |motion, velocity| {
        let torque = scene.diamond(&Matrix3::identity(), &motion.advected, 1.0);
        let (rate, _) = Vector3::solve(&scene.inertia(&motion.advected), &(motion.momentum.cross(velocity) + torque));
        velocity.dot(&rate) / (velocity.norm_squared() + floor * floor)
    }
}
