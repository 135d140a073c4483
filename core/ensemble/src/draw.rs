//! Random numbers that are functions of a seed, a member and a name, and of no earlier draws.

use core::f64::consts::TAU;
use core::ops::Range;

use liestep::laws::samples;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::{Failure, Table};
use liestep::numbers::Digest;

/// One member of an ensemble, from which its scene and its initial state draw numbers.
///
/// Numbers are drawn by name: the same seed, member and name give the same number, in whatever order they are drawn, so
/// that a member is the same on every machine. (Logarithms, sines and cosines are those of the machine's own library;
/// [`uniform`](Self::uniform) needs none.)
#[derive(Clone, Copy, Debug)]
pub struct Member<'a> {
    pub(crate) number: u64,
    pub(crate) seed: u64,
    pub(crate) table: Option<&'a Table>,
}

impl Member<'_> {
    /// The member of this number in an ensemble of this seed, without a table.
    #[must_use]
    pub fn of(number: u64, seed: u64) -> Self {
        Self { number, seed, table: None }
    }

    /// The number of this member, from zero.
    #[must_use]
    pub fn number(&self) -> u64 {
        self.number
    }

    /// A uniformly distributed number of this range.
    #[must_use]
    pub fn uniform(&self, name: &str, range: Range<f64>) -> f64 {
        range.start + (range.end - range.start) * self.units(name, 0)[0]
    }

    /// A normally distributed number, by [`samples::normal`].
    #[must_use]
    pub fn normal(&self, name: &str, mean: f64, deviation: f64) -> f64 {
        mean + deviation * samples::normal(self.units(name, 0))
    }

    /// A uniformly distributed unit vector.
    #[must_use]
    pub fn direction(&self, name: &str) -> Vector3<f64> {
        let [height, angle] = self.units(name, 0);
        let z = 2.0 * height - 1.0;
        let across = (1.0 - z * z).sqrt();
        Vector3::new(across * (TAU * angle).cos(), across * (TAU * angle).sin(), z)
    }

    /// A uniformly distributed rotation.
    ///
    /// # Source
    ///
    /// K. Shoemake, *Uniform random rotations*, Graphics Gems III, 1992.
    #[must_use]
    pub fn rotation(&self, name: &str) -> UnitQuaternion<f64> {
        let ([share, first], [second, _]) = (self.units(name, 0), self.units(name, 1));
        let (a, b) = ((1.0 - share).sqrt(), share.sqrt());
        let (first, second) = (TAU * first, TAU * second);
        UnitQuaternion::new_normalize(Quaternion::new(
            b * second.cos(),
            a * first.sin(),
            a * first.cos(),
            b * second.sin(),
        ))
    }

    /// The number in a column of the [table](crate::Ensemble::over), in this member's row.
    ///
    /// # Errors
    ///
    /// [`Failure::Other`] if there is no table, no such column or no such row.
    pub fn cell(&self, column: &str) -> Result<f64, Failure> {
        let table = self.table.ok_or_else(|| Failure::Other("the ensemble has no table".to_owned()))?;
        table.cell(column, self.number)
    }

    /// Two numbers from zero to below one.
    #[allow(clippy::cast_precision_loss)] // 53 bits are left
    fn units(&self, name: &str, index: u64) -> [f64; 2] {
        let mut digest = Digest::default();
        digest.text(name);
        digest.number(index);
        let ([a, b], [c, d], key) = (halves(self.number), halves(digest.value()), halves(self.seed));
        let [a, b, c, d] = philox([a, b, c, d], key);
        [(a, b), (c, d)].map(|(high, low)| {
            let bits = (u64::from(high) << 32 | u64::from(low)) >> 11;
            bits as f64 * (0.5 * f64::EPSILON)
        })
    }
}

#[allow(clippy::cast_possible_truncation)] // each half is cut off on purpose
fn halves(number: u64) -> [u32; 2] {
    [number as u32, (number >> 32) as u32]
}

/// Philox 4×32 with ten rounds.
///
/// # Source
///
/// J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, *Parallel random numbers: as easy as 1, 2, 3*, SC11, 2011.
fn philox(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    for _ in 0..10 {
        let [low_a, high_a] = halves(0xD251_1F53 * u64::from(counter[0]));
        let [low_b, high_b] = halves(0xCD9E_8D57 * u64::from(counter[2]));
        counter = [high_b ^ counter[1] ^ key[0], low_b, high_a ^ counter[3] ^ key[1], low_a];
        key = [key[0].wrapping_add(0x9E37_79B9), key[1].wrapping_add(0xBB67_AE85)];
    }
    counter
}

#[cfg(test)]
mod tests {
    use super::{Member, philox};

    /// The known answers that the authors of Philox publish with their library.
    #[test]
    fn it_is_philox() {
        assert_eq!(philox([0; 4], [0; 2]), [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]);
        assert_eq!(philox([u32::MAX; 4], [u32::MAX; 2]), [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]);
        let pi = [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344];
        assert_eq!(philox(pi, [0xa409_3822, 0x299f_31d0]), [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]);
    }

    /// Means and spreads of a hundred thousand are within four standard errors; names are uncorrelated, and members
    /// differ.
    #[test]
    fn numbers_are_spread_as_they_should_be() {
        let count = 100_000_u32;
        let members = || (0..u64::from(count)).map(|number| Member { number, seed: 5, table: None });
        let mean = |value: &dyn Fn(Member) -> f64| members().map(value).sum::<f64>() / f64::from(count);
        let error = 4.0 / f64::from(count).sqrt();
        assert!((mean(&|member| member.uniform("x", -1.0..1.0))).abs() < error);
        assert!((mean(&|member| member.normal("x", 3.0, 2.0)) - 3.0).abs() < 2.0 * error);
        assert!((mean(&|member| member.normal("x", 0.0, 1.0).powi(2)) - 1.0).abs() < 1.5 * error);
        for axis in 0..3 {
            assert!((mean(&|member| member.direction("x")[axis].powi(2)) - 1.0 / 3.0).abs() < error);
            assert!((mean(&|member| member.rotation("x").coords[axis].powi(2)) - 0.25).abs() < error);
        }
        assert!((mean(&|member| member.uniform("x", -1.0..1.0) * member.uniform("y", -1.0..1.0))).abs() < error);
        let [one, other] = [0, 1].map(|number| Member { number, seed: 5, table: None }.uniform("x", 0.0..1.0));
        assert!((one - other).abs() > 0.0);
    }
}
