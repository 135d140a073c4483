//! A scene in the variables of the rivals.

use liestep::SO3;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::scenes::Scene;
pub(crate) use crate::top_equations::{Equations, State};

impl Equations {
    pub(crate) fn of(scene: &Scene) -> Self {
        Self::new(scene.moments.into(), (scene.rho * scene.weight).into())
    }

    /// Where the scene starts.
    pub(crate) fn start(scene: &Scene) -> State {
        let q = SO3::from_matrix_unchecked(scene.attitude).to_quaternion();
        let p = scene.moments.component_mul(&scene.velocity);
        [q.w, q.i, q.j, q.k, p.x, p.y, p.z]
    }

    /// Attitude and body velocity.
    pub(crate) fn end(&self, state: &State) -> (Matrix3<f64>, Vector3<f64>) {
        let [a, b, c, d, ..] = *state;
        // As it is: a rival that has lost the length of its quaternion shall show it.
        let attitude = UnitQuaternion::new_unchecked(Quaternion::new(a, b, c, d)).to_rotation_matrix().into_inner();
        (attitude, self.velocity(state).into())
    }
}
