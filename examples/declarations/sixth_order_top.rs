//! The heavy top to the sixth order.

use liestep::prelude::*;
use nalgebra::Vector3;

/// The heavy top to the sixth order in one solve: the action of a path that satisfies the equations of motion to the
/// second order beyond the geodesic, by three-point Gauss quadrature.
///
/// In units of the step, from its middle, the path is `g(s) = g_m exp(ξ s) exp(η(s))` with
/// `η = (a/2)(s² − 1/4) + (b/6)(s³ − s/4)`, where `a` and `b` are the angular acceleration and its rate at the middle,
/// by the equations of motion. Velocity and attitude are expanded to the third order in `η`,
///
/// ```text
/// exp(−η) v ≈ v − η × v + η × (η × v)/2 − η × (η × (η × v))/6 = d v − c η × v + η (η·v)/2
/// ```
///
/// with `d = 1 − |η|²/2` and `c = 1 − |η|²/6`: `η' − η × η'/2 + η × (η × η')/6 + exp(−η) ξ`, and `exp(η) ρ`.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = {
        let xi = log(F);
        let middle = exp(-0.5 * xi) * w;
        let momentum = J * xi;
        let pull = h * h * weight * rho;
        let f = momentum.cross(&xi) + middle.cross(&pull);
        let a = inverse(J) * f;
        let a_xi = a.cross(&xi);
        let b = inverse(J) * (f.cross(&xi) + momentum.cross(&a) + J * a_xi + middle.cross(&xi).cross(&pull));
        let a_b = a.cross(&b);

        // The nodes s = −σ, 0 and σ, σ² = 3/20.
        let sigma = 0.3872983346207417;
        let twist = (sigma / 60.0) * b;
        let eta1 = twist - a / 20.0;
        let eta2 = a / -8.0;
        let eta3 = -twist - a / 20.0;
        let lean = sigma * a;
        let rate1 = b / 30.0 - lean;
        let rate2 = b / -24.0;
        let rate3 = b / 30.0 + lean;
        let n1 = eta1.norm_squared();
        let n2 = eta2.norm_squared();
        let n3 = eta3.norm_squared();
        let c1 = 1.0 - n1 / 6.0;
        let c2 = 1.0 - n2 / 6.0;
        let c3 = 1.0 - n3 / 6.0;
        let d1 = 1.0 - n1 / 2.0;
        let d2 = 1.0 - n2 / 2.0;
        let d3 = 1.0 - n3 / 2.0;

        // η × η' is a × b/1200 at the outer nodes and a × b/192 at the middle one.
        let turn1 = rate1 - eta1.cross(&xi);
        let turn2 = rate2 + a_xi / 8.0;
        let turn3 = rate3 - eta3.cross(&xi);
        let along1 = eta1.dot(&(xi / 2.0 + rate1 / 6.0));
        let along2 = eta2.dot(&(xi / 2.0 + rate2 / 6.0));
        let along3 = eta3.dot(&(xi / 2.0 + rate3 / 6.0));
        let velocity1 = d1 * xi + c1 * turn1 + along1 * eta1 - a_b / 2400.0;
        let velocity2 = d2 * xi + c2 * turn2 + along2 * eta2 - a_b / 384.0;
        let velocity3 = d3 * xi + c3 * turn3 + along3 * eta3 - a_b / 2400.0;
        let kinetic = (5.0 * velocity1.dot(&(J * velocity1)) + 8.0 * velocity2.dot(&(J * velocity2))
            + 5.0 * velocity3.dot(&(J * velocity3))) / 2.0;

        let outward = sigma * xi;
        let w1 = exp(outward) * middle;
        let w3 = exp(-outward) * middle;
        let lever1 = eta1.cross(&pull);
        let lever2 = eta2.cross(&pull);
        let lever3 = eta3.cross(&pull);
        let pull1 = d1 * pull + c1 * lever1 + 0.5 * eta1.dot(&pull) * eta1;
        let pull2 = d2 * pull + c2 * lever2 + 0.5 * eta2.dot(&pull) * eta2;
        let pull3 = d3 * pull + c3 * lever3 + 0.5 * eta3.dot(&pull) * eta3;
        let potential = 5.0 * w1.dot(&pull1) + 8.0 * middle.dot(&pull2) + 5.0 * w3.dot(&pull3);
        (kinetic - potential) / (18.0 * h)
    },
)]
#[derive(Clone, Debug)]
pub struct SixthOrderTop {
    /// Inertia about the pivot, kg m².
    pub J: Inertia,
    /// Weight `m g`, N.
    pub weight: f64,
    /// Centre of mass from the pivot, body frame, m.
    pub rho: Vector3<f64>,
    /// The vertical, in space.
    pub up: Vector3<f64>,
}
