//! The unit quaternion of a rotation.

use crate::numbers::{Mask, Real, real};
use nalgebra::{Matrix3, SimdBool as _};

/// The unit quaternion of a rotation, real part first, from a part whose square is a quarter at least. Every lane has its
/// own.
#[hot]
pub(in super::super) fn quaternion<T: Real>(r: &Matrix3<T>) -> [T; 4] {
    let one = T::one();
    let (wx, wy, wz) = (r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12);
    // Four times the square of a part, and that part times all. The four squares have the sum four.
    let ww = one + r.m11 + r.m22 + r.m33;
    // Within 120° of the identity no other part need be asked. Beyond, the largest of the others is large enough.
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

/// One or the other in each lane; both are found only where lanes differ.
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
