//! Places of bodies that the file doesn't give: by the joints, from bodies that have one.

use liestep::SO3;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use crate::file::joint::Joint;
use crate::file::part::{Between, SystemBody};
use crate::file::start::Start;

/// The place of a body and its velocities in the axes of space.
#[derive(Clone, Copy)]
struct Pose {
    attitude: Matrix3<f64>,
    position: Vector3<f64>,
    /// Angular velocity, rad/s.
    turning: Vector3<f64>,
    /// Velocity of the centre of mass, m/s.
    moving: Vector3<f64>,
}

impl Pose {
    const SPACE: Self = Self {
        attitude: Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
        position: Vector3::new(0.0, 0.0, 0.0),
        turning: Vector3::new(0.0, 0.0, 0.0),
        moving: Vector3::new(0.0, 0.0, 0.0),
    };

    fn of(body: &SystemBody) -> Self {
        let attitude = *SO3::from(body.start.attitude).as_matrix();
        let turning = attitude * body.start.velocity;
        Self { attitude, position: body.position, turning, moving: body.moving }
    }

    fn set(&self, body: &mut SystemBody) {
        let attitude = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(self.attitude));
        // Along a row of hundreds of bodies rounding errors grow to where the attitude would be no rotation.
        let attitude = UnitQuaternion::new_normalize(attitude.into_inner());
        body.start = Start { attitude, velocity: self.attitude.tr_mul(&self.turning) };
        (body.position, body.moving) = (self.position, self.moving);
    }

    /// The pose of the body below a joint, where this is that of the body above.
    fn below(&self, joint: &Joint) -> Self {
        let [angle, rate, shift, speed] = joint.start();
        let attitude = self.attitude * joint.attitude_at(angle);
        let axis = self.attitude * joint.axes[0];
        let arm = self.attitude * (joint.at[0] + joint.axes[0] * shift);
        let back = attitude * joint.at[1];
        let turning = self.turning + axis * rate;
        let point = self.moving + self.turning.cross(&arm) + axis * speed;
        Self { attitude, position: self.position + arm - back, turning, moving: point - turning.cross(&back) }
    }

    /// The pose of the body above a joint, where this is that of the body below.
    fn above(&self, joint: &Joint) -> Self {
        let [angle, rate, shift, speed] = joint.start();
        let attitude = self.attitude * joint.attitude_at(angle).transpose();
        let axis = attitude * joint.axes[0];
        let arm = attitude * (joint.at[0] + joint.axes[0] * shift);
        let back = self.attitude * joint.at[1];
        let turning = self.turning - axis * rate;
        let point = self.moving + self.turning.cross(&back) - axis * speed;
        Self { attitude, position: self.position + back - arm, turning, moving: point - turning.cross(&arm) }
    }
}

/// Gives a place to each body without one, along the joints in the order of the file. Returns the numbers of the joints that
/// did so, and the first body that none of them reaches.
pub(crate) fn place(
    bodies: &mut [SystemBody],
    is_placed: &mut [bool],
    joints: &[Between<Joint>],
) -> (Vec<usize>, Option<usize>) {
    let mut used = Vec::new();
    loop {
        let before = used.len();
        for (number, &Between { bodies: [above, below], of: joint }) in joints.iter().enumerate() {
            let Some(below) = below.filter(|_| joint.kind.places()) else { continue };
            let is_above_placed = above.is_none_or(|above| is_placed[above]);
            match (is_above_placed, is_placed[below], above) {
                (true, false, _) => {
                    let pose = above.map_or(Pose::SPACE, |above| Pose::of(&bodies[above]));
                    pose.below(&joint).set(&mut bodies[below]);
                    is_placed[below] = true;
                }
                (false, true, Some(above)) => {
                    Pose::of(&bodies[below]).above(&joint).set(&mut bodies[above]);
                    is_placed[above] = true;
                }
                _ => continue,
            }
            used.push(number);
        }
        if used.len() == before {
            return (used, is_placed.iter().position(|is_placed| !is_placed));
        }
    }
}
