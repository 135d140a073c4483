//! The state of a scene at one time.

use liestep::SO3;
use liestep::groups::LieGroup as _;
use nalgebra::{Matrix3, Vector3};

/// A state, in SI units.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sample {
    /// Since the start, s.
    pub time: f64,
    /// In the order of the file.
    pub bodies: Vec<BodySample>,
    /// Of the continuous limit, J.
    pub energy: f64,
    /// Of all bodies, in space, kg m/s; zero of a body that turns about a fixed point.
    pub momentum: Vector3<f64>,
    /// Of all bodies, about the origin, in space, kg m²/s.
    pub angular_momentum: Vector3<f64>,
    /// Of the joint that is open farthest, m; of pins with the cosines of their axes. Zero where there are no joints.
    pub gap: f64,
}

/// The state of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BodySample {
    /// Body to space.
    pub attitude: SO3,
    /// The attitude as the unit quaternion `w, x, y, z`: of the two the one nearer to the sample before.
    pub quaternion: [f64; 4],
    /// Body frame, rad/s.
    pub velocity: Vector3<f64>,
    /// The angular momentum, body frame, kg m²/s.
    pub momentum: Vector3<f64>,
    /// Of the centre of mass in space, m; zero of a body that turns about a fixed point.
    pub position: Vector3<f64>,
    /// The velocity of the centre of mass in space, m/s; zero of a body that turns about a fixed point.
    pub moving: Vector3<f64>,
}

impl Sample {
    /// Takes the quaternions that are nearer to those of an earlier sample.
    pub(crate) fn follow(&mut self, before: &Self) {
        for (body, before) in self.bodies.iter_mut().zip(&before.bodies) {
            body.quaternion = before.quaternion;
            body.attitude.write_numbers(&mut body.quaternion);
        }
    }
}

impl BodySample {
    /// The turning part; the centre of mass rests at the origin.
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
