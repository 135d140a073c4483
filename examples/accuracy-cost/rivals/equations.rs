//! The heavy top in unit quaternion and body momentum: `q' = ½ q Ω`, `p' = p × Ω + m g w × ρ`.
//!
//! These variables are the rivals' best: seven numbers, products only, and nothing to solve.

use liestep::SO3;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::scenes::Scene;

/// Quaternion `(q_0, q)`, then body momentum.
pub(crate) type State = [f64; 7];

/// The body and the force, in the form that the right-hand side uses.
#[derive(Clone, Copy)]
pub(crate) struct Equations {
    inverse_moments: [f64; 3],
    /// `m g ρ`.
    lever: [f64; 3],
}

impl Equations {
    pub(crate) fn of(scene: &Scene) -> Self {
        Self { inverse_moments: scene.moments.map(f64::recip).into(), lever: (scene.rho * scene.weight).into() }
    }

    /// Where the scene starts.
    pub(crate) fn start(scene: &Scene) -> State {
        let q = SO3::from_matrix_unchecked(scene.attitude).to_quaternion();
        let p = scene.moments.component_mul(&scene.velocity);
        [q.w, q.i, q.j, q.k, p.x, p.y, p.z]
    }

    /// Attitude and body velocity.
    pub(crate) fn end(&self, &[a, b, c, d, p1, p2, p3]: &State) -> (Matrix3<f64>, Vector3<f64>) {
        let [i1, i2, i3] = self.inverse_moments;
        // As it is: a rival that has lost the length of its quaternion shall show it.
        let attitude = UnitQuaternion::new_unchecked(Quaternion::new(a, b, c, d)).to_rotation_matrix().into_inner();
        (attitude, Vector3::new(i1 * p1, i2 * p2, i3 * p3))
    }

    #[inline(always)]
    pub(crate) fn rate(&self, &[a, b, c, d, p1, p2, p3]: &State) -> State {
        let [i1, i2, i3] = self.inverse_moments;
        let [l1, l2, l3] = self.lever;
        let (o1, o2, o3) = (i1 * p1, i2 * p2, i3 * p3);
        let (w1, w2, w3) = (2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a + d * d - b * b - c * c);
        [
            -0.5 * (b * o1 + c * o2 + d * o3),
            0.5 * (a * o1 + c * o3 - d * o2),
            0.5 * (a * o2 + d * o1 - b * o3),
            0.5 * (a * o3 + b * o2 - c * o1),
            p2 * o3 - p3 * o2 + (w2 * l3 - w3 * l2),
            p3 * o1 - p1 * o3 + (w3 * l1 - w1 * l3),
            p1 * o2 - p2 * o1 + (w1 * l2 - w2 * l1),
        ]
    }
}

/// The quaternion brought back to unit length.
#[inline(always)]
pub(crate) fn normalised([a, b, c, d, p1, p2, p3]: State) -> State {
    let scale = 1.0 / (a * a + b * b + c * c + d * d).sqrt();
    [a * scale, b * scale, c * scale, d * scale, p1, p2, p3]
}
