//! Random states from a fixed seed: `SplitMix64` of Steele, Lea and Flood (2014), so that a failure repeats.

use liestep::SO3;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// A stream of pseudo-random numbers.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number uniform in `[−1, 1)`.
    #[allow(clippy::cast_precision_loss)] // 53 bits are left
    pub fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A vector with components uniform in `[−1, 1)`.
    pub fn vector(&mut self) -> Vector3<f64> {
        Vector3::new(self.signed(), self.signed(), self.signed())
    }

    pub fn direction(&mut self) -> Vector3<f64> {
        self.vector().normalize()
    }

    pub fn matrix(&mut self) -> Matrix3<f64> {
        Matrix3::from_columns(&[self.vector(), self.vector(), self.vector()])
    }

    /// A rotation of arbitrary angle.
    pub fn rotation(&mut self) -> SO3 {
        UnitQuaternion::from_quaternion(Quaternion::new(self.signed(), self.signed(), self.signed(), self.signed()))
            .into()
    }

    /// A rotation by the given angle about a random axis.
    pub fn rotation_by(&mut self, angle: f64) -> SO3 {
        UnitQuaternion::from_scaled_axis(self.direction() * angle).into()
    }

    /// Rotations at which formulas may fail: the identity, near it, in general position, and near a half turn.
    pub fn hard_rotations(&mut self) -> Vec<SO3> {
        let mut rotations = vec![SO3::identity()];
        for _ in 0..20 {
            rotations.push(self.rotation_by(1e-8));
            rotations.push(self.rotation());
            rotations.push(self.rotation_by(core::f64::consts::PI - 1e-6));
        }
        rotations
    }
}
