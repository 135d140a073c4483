//! Motors that a program drives: angles and shifts of joints, and the forces of motors in them on the bodies.

use liestep::motion::AnyMotion;
use nalgebra::{Matrix3, Vector3};

use crate::file::joint::{Joint, Pose};
use crate::file::joint_kind::Kind;
use crate::file::part::Between;
use crate::file::system::System;

/// The motion of a body, or of space, which rests in the origin.
struct BodyMotion {
    pose: Pose,
    /// Angular velocity in the axes of the body, and velocity in space.
    turning: Vector3<f64>,
    moving: Vector3<f64>,
}

/// The entries of the attitude and of the place of a body.
pub(crate) const ENTRIES: usize = 9 + 16;

/// The attitude and the place of a body by its number, from the attitudes of all; `None` is space.
pub(crate) fn pose(body: Option<usize>, attitudes: &[f64]) -> Pose {
    let Some(body) = body else { return (Matrix3::identity(), Vector3::zeros()) };
    let at = |place: usize| attitudes.get(ENTRIES * body + place).copied().unwrap_or(f64::NAN);
    // The place is the last column of a matrix with four rows.
    (Matrix3::from_fn(|row, column| at(3 * row + column)), Vector3::from_fn(|row, _| at(9 + 4 * row + 3)))
}

/// The motion of a body by its number; `None` is space.
fn motion_of(body: Option<usize>, attitude: &[f64], velocity: &[f64]) -> BodyMotion {
    let vector = |first: usize| {
        let part = |row: usize| velocity.get(6 * body? + first + row).copied();
        Vector3::from_fn(|row, _| part(row).unwrap_or(if body.is_some() { f64::NAN } else { 0.0 }))
    };
    BodyMotion { pose: pose(body, attitude), turning: vector(0), moving: vector(3) }
}

impl System {
    /// The number of the joint of this name.
    #[must_use]
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joint_names.iter().position(|own| own == name)
    }

    /// The names of the joints, given or by their numbers from one: `joint-1`.
    pub fn joint_names(&self) -> impl Iterator<Item = &str> {
        self.joint_names.iter().map(String::as_str)
    }

    /// The coordinate of a joint, the angle about its axis in rad or the shift along it in m, and its rate, from a state and its
    /// velocity; `None` if the joint has several such coordinates, or no axis. An angle is between −π and π.
    #[must_use]
    pub fn coordinate(&self, joint: usize, motion: &AnyMotion, velocity: &[f64]) -> Option<[f64; 2]> {
        let &Between { bodies, of } = self.joints.get(joint)?;
        let [above, below] = bodies.map(|body| motion_of(body, motion.attitude(), velocity));
        let ([angle, shift], axis) = (of.coordinates([&above.pose, &below.pose]), of.axes[0]);
        let ((attitude, at), (of_below, to)) = (above.pose, below.pose);
        let numbers = match of.kind {
            Kind::Pin | Kind::Plane => {
                let turning = attitude.tr_mul(&of_below) * below.turning;
                [angle, axis.dot(&(turning - above.turning))]
            }
            Kind::Slider => {
                let arm = of_below * of.at[1];
                let from = attitude.tr_mul(&(to + arm - at));
                let moving = below.moving + of_below * below.turning.cross(&of.at[1]) - above.moving;
                [shift, axis.dot(&(attitude.tr_mul(&moving) - above.turning.cross(&from)))]
            }
            _ => return None,
        };
        Some(numbers.map(|number| of.sign * number))
    }

    /// Adds the forces on all bodies of a motor in a joint, as [`Propagator::step_forced`](liestep::motion::Propagator::step_forced)
    /// takes them: a torque about its axis, N m, or a force along it, N.
    ///
    /// # Errors
    ///
    /// The reason why this joint has no motor.
    pub fn drive(&self, joint: usize, effort: f64, forces: &mut [f64]) -> Result<(), &'static str> {
        let none = "isn't the number of a joint";
        let &Between { bodies: [above, below], of: Joint { kind, at, axes, zero, sign, .. } } =
            self.joints.get(joint).ok_or(none)?;
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
