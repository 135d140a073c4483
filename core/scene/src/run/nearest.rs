//! Closing joints that are open in the file: positions and their velocities are corrected, attitudes and angular
//! velocities aren't.

use liestep::SO3;
use liestep::groups::R3;
use nalgebra::{DMatrix, MatrixXx3, SymmetricEigen, Vector3, Vector6};

use crate::file::system::System;
use crate::run::stiffness::eigen;

/// Attitude and position of a body, and its velocities; the angular velocity is in the body frame.
pub(crate) type BodyState = ((SO3, R3), Vector6<f64>);

impl System {
    /// The bodies with the least mass-weighted shifts that close the joints, and with the nearest velocities that keep
    /// them closed. Attitudes and angular velocities are unchanged. Joints in loops may stay open, by as little as
    /// possible.
    ///
    /// Both problems are linear at fixed attitudes: with `b` the gaps `R_a ρ_a − R_b ρ_b − (x_b − x_a)` and `A` the
    /// differences `x_b − x_a`, the shifts are `M⁻¹ Aᵀ (A M⁻¹ Aᵀ)⁺ b`.
    pub(crate) fn shifted(&self, mut bodies: Vec<BodyState>) -> Vec<BodyState> {
        let mut differences = DMatrix::zeros(self.joints.len(), bodies.len());
        let mut gaps = MatrixXx3::zeros(self.joints.len());
        let mut partings = MatrixXx3::zeros(self.joints.len());
        for (row, joint) in self.joints.iter().enumerate().filter(|(_, joint)| joint.of.kind.has_one_point()) {
            for (side, sign) in [(0, -1.0), (1, 1.0)] {
                let (place, velocity) = point(joint.bodies[side].map(|body| bodies[body]), &joint.of.at[side]);
                for column in 0..3 {
                    gaps[(row, column)] -= sign * place[column];
                    partings[(row, column)] -= sign * velocity[column];
                }
                if let Some(body) = joint.bodies[side] {
                    differences[(row, body)] = sign;
                }
            }
        }
        let by_masses = DMatrix::from_fn(bodies.len(), self.joints.len(), |body, joint| {
            differences[(joint, body)] / self.bodies[body].m
        });
        let inverse = pseudo_inverse(&differences * &by_masses);
        let [shifts, drifts] = [gaps, partings].map(|apart| &by_masses * &inverse * apart);
        for (body, ((_, place), velocity)) in bodies.iter_mut().enumerate() {
            *place = R3::from(place.translation() + Vector3::from_fn(|column, _| shifts[(body, column)]));
            for column in 0..3 {
                velocity[3 + column] += drifts[(body, column)];
            }
        }
        bodies
    }
}

/// Position and velocity of a point of a body, or of space.
fn point(body: Option<BodyState>, point: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    body.map_or((*point, Vector3::zeros()), |((attitude, place), velocity)| {
        let R = attitude.as_matrix();
        let turns = velocity.fixed_rows::<3>(0).cross(point);
        (place.translation() + R * point, velocity.fixed_rows::<3>(3) + R * turns)
    })
}

/// Pseudo-inverse of a positive semidefinite matrix; zero for one that isn't finite.
fn pseudo_inverse(matrix: DMatrix<f64>) -> DMatrix<f64> {
    let (rows, columns) = matrix.shape();
    let Some(SymmetricEigen { eigenvectors, eigenvalues }) = eigen(matrix) else {
        return DMatrix::zeros(rows, columns);
    };
    let limit = 1e-12 * eigenvalues.max();
    let inverse = eigenvalues.map(|value| if value > limit { value.recip() } else { 0.0 });
    &eigenvectors * DMatrix::from_diagonal(&inverse) * eigenvectors.transpose()
}
