//! The state of a scene at one time.

use std::sync::Arc;

use liestep::SO3;
use liestep::groups::LieGroup as _;
use nalgebra::{Matrix3, Vector3};

/// A state, in SI units.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sample {
    /// Time since the start, s.
    pub time: f64,
    /// States of the bodies, in the order of the file; none on another group than SO(3).
    pub bodies: Vec<BodySample>,
    /// Numbers of a scene on one group: the attitude's columns as a recorder has them, the components of velocity, momentum
    /// and momentum in space, the energy, the distance from the group, and those of pointings, laws and wheels. Of several
    /// bodies those of all columns, in their order.
    pub numbers: Vec<f64>,
    /// The places of quaternions among the numbers.
    pub(crate) quaternions: Arc<[usize]>,
    /// Energy of the continuous limit, J.
    pub energy: f64,
    /// Total momentum in space, kg m/s; zero for a body that turns about a fixed point.
    pub momentum: Vector3<f64>,
    /// Total angular momentum about the origin, in space, kg m²/s.
    pub angular_momentum: Vector3<f64>,
    /// Constraint violation of the joint where it is largest, m; for pins together with the cosines of their axes. Zero
    /// without joints.
    pub gap: f64,
}

/// The state of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BodySample {
    /// Body to space.
    pub attitude: SO3,
    /// The attitude as the unit quaternion `w, x, y, z`, with the sign that is nearer to the previous sample.
    pub quaternion: [f64; 4],
    /// Angular velocity, body frame, rad/s.
    pub velocity: Vector3<f64>,
    /// The angular momentum, body frame, kg m²/s.
    pub momentum: Vector3<f64>,
    /// Position of the centre of mass in space, m; zero for a body that turns about a fixed point.
    pub position: Vector3<f64>,
    /// Velocity of the centre of mass in space, m/s; zero for a body that turns about a fixed point.
    pub moving: Vector3<f64>,
}

impl Sample {
    /// Chooses the signs of the quaternions that are nearer to an earlier sample.
    pub(crate) fn follow(&mut self, before: &Self) {
        for (body, before) in self.bodies.iter_mut().zip(&before.bodies) {
            body.quaternion = before.quaternion;
            body.attitude.write_numbers(&mut body.quaternion);
        }
        for &place in self.quaternions.iter() {
            let (now, before) = (&mut self.numbers[place..place + 4], &before.numbers[place..place + 4]);
            if now.iter().zip(before).map(|(now, before)| now * before).sum::<f64>() < 0.0 {
                for part in now {
                    *part = -*part;
                }
            }
        }
    }
}

impl BodySample {
    /// The state of a body that only turns; its centre of mass rests at the origin.
    pub(crate) fn turning(attitude: SO3, velocity: Vector3<f64>, momentum: Vector3<f64>) -> Self {
        let mut quaternion = [0.0; 4];
        attitude.write_numbers(&mut quaternion);
        let (position, moving) = (Vector3::zeros(), Vector3::zeros());
        Self { attitude, quaternion, velocity, momentum, position, moving }
    }

    pub(crate) fn matrix(&self) -> Matrix3<f64> {
        self.attitude.matrix()
    }
}
