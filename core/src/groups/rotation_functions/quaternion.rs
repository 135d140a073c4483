//! The unit quaternion of a rotation.

use crate::numbers::{Mask, Real, real};
use nalgebra::{Matrix3, SimdBool as _};

/// The unit quaternion of a rotation, real part first, computed from a part whose square is a quarter at least. Each
/// lane chooses its own part.
#[hot]
pub(in super::super) fn quaternion<T: Real>(r: &Matrix3<T>) -> [T; 4] {
    let one = T::one();
    let (wx, wy, wz) = (r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12);
    // The square of a component, times four, and the products of that component with all. The four squares have the sum
    // four.
    let ww = one + r.m11 + r.m22 + r.m33;
    // Within 120° of the identity the real part is large enough. Beyond, the largest of the others is.
    let from_another = || {
        let (xy, xz, yz) = (r.m21 + r.m12, r.m13 + r.m31, r.m32 + r.m23);
        let xx = one + r.m11 - r.m22 - r.m33;
        let yy = one - r.m11 + r.m22 - r.m33;
        let zz = one - r.m11 - r.m22 + r.m33;
        let from_x = || scaled(xx, [wx, xx, xy, xz]);
        let from_y = || scaled(yy, [wy, xy, yy, yz]);
        let from_z = || scaled(zz, [wz, xz, yz, zz]);
        let without_y = || either(xx.simd_ge(zz), from_x, from_z);
        let without_x = || either(yy.simd_ge(zz), from_y, from_z);
        either(xx.simd_ge(yy), without_y, without_x)
    };
    either(ww.simd_ge(one), || scaled(ww, [ww, wx, wy, wz]), from_another)
}

/// The first or the second quaternion in each lane; both are computed only if lanes differ.
#[hot]
fn either<T: Real>(is_one: Mask<T>, one: impl FnOnce() -> [T; 4], other: impl FnOnce() -> [T; 4]) -> [T; 4] {
    if is_one.all() {
        one()
    } else if is_one.any() {
        let (one, other) = (one(), other());
        core::array::from_fn(|k| one[k].select(is_one, other[k]))
    } else {
        other()
    }
}

/// The quaternion `q` from its part `p`: `products[k] = 4 p q_k` and `square = 4 p²`.
#[hot]
fn scaled<T: Real>(square: T, products: [T; 4]) -> [T; 4] {
    let scale = real::<T>(0.5) / square.simd_sqrt();
    products.map(|product| product * scale)
}

#[cfg(test)]
mod tests {
    use crate::groups::{LieGroup as _, SO3};
    use nalgebra::{UnitQuaternion, Vector3};

    /// Rotations near every half turn and far from it, with the sign of the one before.
    #[test]
    fn a_rotation_is_shown_by_its_quaternion() {
        let mut numbers = [0.0; 4];
        let mut before: Option<[f64; 4]> = None;
        for turn in 0..2000 {
            let turn = f64::from(turn);
            let axis = Vector3::new((0.01 * turn).sin(), (0.017 * turn).cos(), (0.003 * turn).sin());
            let quaternion = UnitQuaternion::from_scaled_axis(axis.normalize() * (0.01 * turn));
            SO3::from(quaternion).write_numbers(&mut numbers);
            let expected = [quaternion.w, quaternion.i, quaternion.j, quaternion.k];
            let sign = if numbers.iter().zip(expected).map(|(a, b)| a * b).sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
            let error = numbers.iter().zip(expected).map(|(a, b)| (a - sign * b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-15, "{error}");
            let own = SO3::from(quaternion).to_quaternion();
            assert_eq!([own.w, own.i, own.j, own.k].map(|q| q.abs().to_bits()), numbers.map(|q| q.abs().to_bits()));
            let moved = before.map_or(0.0, |before| (0..4).map(|k| (numbers[k] - before[k]).abs()).fold(0.0, f64::max));
            assert!(moved < 0.1, "it jumps");
            before = Some(numbers);
        }
    }

    /// Lanes with different largest parts, and lanes with the same, have the bits of each alone.
    #[test]
    fn each_lane_has_its_own_quaternion() {
        use crate::numbers::Lanes as _;
        use simba::simd::{SimdValue as _, WideF64x4};
        // The fifth quaternion has a real part that is large enough, though another component is larger.
        let quaternions = [[2.0, 0.3, -0.2, 0.5], [0.3, 2.0, 0.5, -0.2], [-0.2, 0.5, 2.0, 0.3], [0.5, -0.2, 0.3, 2.0]]
            .into_iter()
            .chain([[0.6, 0.0, 0.8, 0.0]])
            .map(|[w, x, y, z]| UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z)));
        let quaternions: alloc::vec::Vec<_> = quaternions.collect();
        let together = [
            [0, 1, 2, 3],
            [3, 2, 1, 0],
            [1, 3, 0, 2],
            [1, 1, 1, 1],
            [2, 2, 2, 2],
            [3, 3, 3, 3],
            [0, 3, 3, 3],
            [4, 1, 2, 3],
            [0, 4, 4, 3],
        ];
        for parts in together {
            let alone = parts.map(|k| SO3::from(quaternions[k]));
            let mut numbers = [WideF64x4::splat(0.0); 4];
            SO3::<WideF64x4>::gathered(&alone).unwrap().write_numbers(&mut numbers);
            for (lane, (attitude, k)) in alone.iter().zip(parts).enumerate() {
                let mut expected = [0.0; 4];
                attitude.write_numbers(&mut expected);
                assert_eq!(
                    numbers.map(|number| number.extract(lane).to_bits()),
                    expected.map(f64::to_bits),
                    "{parts:?}"
                );
                let [w, x, y, z] = expected;
                let error = nalgebra::Quaternion::new(w, x, y, z) - quaternions[k].into_inner();
                assert!(error.norm() < 1e-15, "{error}");
            }
        }
    }
}
