//! A left-invariant motion on SL(2).

use liestep::groups::{CovariantTensor, SL2};
use liestep::lagrangian;
use nalgebra::Matrix2;

/// The area-preserving deformations of the plane with a left-invariant kinetic energy and an elastic potential.
///
/// The kinetic energy is `½ tr(ξ M ξᵀ)` in the body velocity `ξ = g⁻¹ġ`, so that without the potential the motion is a
/// geodesic flow. The metric of space is advected: in the body frame it is the Cauchy–Green tensor `C = gᵀg`, and the
/// potential is `½ k tr C`. On SL(2) `F − ½ tr(F) I` is half of `F − F⁻¹`, which changes its sign if the step is
/// reversed; `F − I` doesn't, and would lead to a scheme of first order.
#[lagrangian(
    group = SL2,
    advected(C = metric),
    l_d = {
        let odd = F - 0.5 * F.trace() * I;
        let kinetic = (odd * M * odd.transpose()).trace() / (2.0 * h);
        kinetic - 0.25 * h * k * (C + F.transpose() * C * F).trace()
    },
)]
#[derive(Clone, Debug)]
pub struct ElasticFlow {
    /// The metric of the kinetic energy, symmetric, kg m².
    pub M: Matrix2<f64>,
    /// Stiffness, N m.
    pub k: f64,
    /// The metric of space, the identity in Cartesian coordinates.
    pub metric: CovariantTensor<f64, 2>,
}
