//! Motors that a program drives: angles and shifts of joints, and the forces of motors in them on the bodies.

use liestep::motion::AnyMotion;
use nalgebra::{Matrix3, Vector3};

use crate::file::joint::{Joint, Kind};
use crate::file::part::Between;
use crate::file::system::System;

/// The motion of a body. That of space is at rest in the origin.
struct BodyMotion {
    attitude: Matrix3<f64>,
    position: Vector3<f64>,
    /// Angular velocity in the axes of the body, and velocity in space.
    turning: Vector3<f64>,
    moving: Vector3<f64>,
}

/// The entries of the attitude and of the place of a body.
const ENTRIES: usize = 9 + 16;

/// The motion of a body by its number; `None` is space.
fn motion_of(body: Option<usize>, attitude: &[f64], velocity: &[f64]) -> BodyMotion {
    let at = |numbers: &[f64], place: usize| numbers.get(place).copied().unwrap_or(f64::NAN);
    let Some(body) = body else {
        let none = Vector3::zeros();
        return BodyMotion { attitude: Matrix3::identity(), position: none, turning: none, moving: none };
    };
    let vector =
        |numbers: &[f64], first: usize, step: usize| Vector3::from_fn(|row, _| at(numbers, first + step * row));
    BodyMotion {
        attitude: Matrix3::from_fn(|row, column| at(attitude, ENTRIES * body + 3 * row + column)),
        // The last column of a matrix with four rows.
        position: vector(attitude, ENTRIES * body + 9 + 3, 4),
        turning: vector(velocity, 6 * body, 1),
        moving: vector(velocity, 6 * body + 3, 1),
    }
}

impl System {
    /// The number of the joint of this name.
    #[must_use]
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joint_names.iter().position(|own| own.name.as_deref() == Some(name))
    }

    /// The names of the joints that have one.
    pub fn joint_names(&self) -> impl Iterator<Item = &str> {
        self.joint_names.iter().filter_map(|own| own.name.as_deref())
    }

    /// A joint, with the sign of its angle or shift in the file's order of its bodies.
    fn with_sign(&self, joint: usize) -> Option<(&Between<Joint>, f64)> {
        let is_swapped = self.joint_names.get(joint)?.is_swapped;
        Some((self.joints.get(joint)?, if is_swapped { -1.0 } else { 1.0 }))
    }

    /// The coordinate of a joint, the angle about its axis in rad or the shift along it in m, and its rate, from a state and its
    /// velocity; `None` if the joint has several such coordinates, or no axis. An angle is between −π and π.
    #[must_use]
    pub fn coordinate(&self, joint: usize, motion: &AnyMotion, velocity: &[f64]) -> Option<[f64; 2]> {
        let (&Between { bodies, of: Joint { kind, at, axes, zero, .. } }, sign) = self.with_sign(joint)?;
        let [above, below] = bodies.map(|body| motion_of(body, motion.attitude(), velocity));
        let (axis, relative) = (axes[0], above.attitude.tr_mul(&below.attitude));
        if matches!(kind, Kind::Pin | Kind::Plane) {
            let turn = relative * zero.transpose();
            let sine = axis.dot(&Vector3::new(
                turn[(2, 1)] - turn[(1, 2)],
                turn[(0, 2)] - turn[(2, 0)],
                turn[(1, 0)] - turn[(0, 1)],
            ));
            let rate = axis.dot(&(relative * below.turning - above.turning));
            return Some([sign * sine.atan2(turn.trace() - 1.0), sign * rate]);
        }
        if kind != Kind::Slider {
            return None;
        }
        let arm = below.attitude * at[1];
        let from = above.attitude.tr_mul(&(below.position + arm - above.position));
        let moving = below.moving + below.attitude * below.turning.cross(&at[1]) - above.moving;
        let rate = axis.dot(&(above.attitude.tr_mul(&moving) - above.turning.cross(&from)));
        Some([sign * axis.dot(&(from - at[0])), sign * rate])
    }

    /// Adds the forces on all bodies of a motor in a joint, as [`Propagator::step_forced`](liestep::motion::Propagator::step_forced)
    /// takes them: a torque about its axis, N m, or a force along it, N.
    ///
    /// # Errors
    ///
    /// The reason why this joint has no motor.
    pub fn drive(&self, joint: usize, effort: f64, forces: &mut [f64]) -> Result<(), &'static str> {
        let none = "isn't the number of a joint";
        let (&Between { bodies: [above, below], of: Joint { kind, at, axes, zero, .. } }, sign) =
            self.with_sign(joint).ok_or(none)?;
        let (axis, effort) = (axes[0], sign * effort);
        let mut add = |body: Option<usize>, first: usize, part: Vector3<f64>| {
            let places = body.into_iter().flat_map(|body| 6 * body + first..6 * body + first + 3);
            for (place, number) in places.zip(part.iter()) {
                forces.get_mut(place).into_iter().for_each(|force| *force += number);
            }
        };
        if kind.turns_about_axis() {
            add(above, 0, -axis * effort);
            add(below, 0, zero.tr_mul(&axis) * effort);
            return Ok(());
        }
        match (kind, above) {
            (Kind::Slider, None) => {
                add(below, 3, axis * effort);
                add(below, 0, at[1].cross(&zero.tr_mul(&axis)) * effort);
                Ok(())
            }
            (Kind::Slider, _) => Err("slides on a rail that moves: its motor is the joint's own `force`"),
            _ => Err("has no axis that a motor acts about: give torques on its bodies"),
        }
    }
}
