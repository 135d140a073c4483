//! Quaternions of increments.

use nalgebra::Matrix3;

use crate::numbers::{Number, Real, real};

/// A real part and the parts along three axes.
pub(super) type Quaternion<T> = [T; 4];

/// The product: first the right one.
#[hot]
pub(super) fn product<T: Number>([s, a, b, c]: Quaternion<T>, [w, x, y, z]: Quaternion<T>) -> Quaternion<T> {
    [
        s * w - (a * x + (b * y + c * z)),
        s * x + (a * w + (b * z - c * y)),
        s * y + (b * w + (c * x - a * z)),
        s * z + (c * w + (a * y - b * x)),
    ]
}

/// The product with one that has no part along the third axis.
#[hot]
pub(super) fn product_across<T: Number>([s, a, b, c]: Quaternion<T>, [w, x, y]: [T; 3]) -> Quaternion<T> {
    [s * w - (a * x + b * y), (s * x + a * w) - c * y, (s * y + b * w) + c * x, c * w + (a * y - b * x)]
}

/// `F − I` of a quaternion of any length.
///
/// That is taken from the very products of the matrix: roundings of a factor that is the same in each step, or of its
/// length, would be made in each step, too.
#[hot]
pub(super) fn increment<T: Real>([w, x, y, z]: Quaternion<T>) -> Matrix3<T> {
    let (wx, wy, wz) = (w * x, w * y, w * z);
    let (xy, xz, yz) = (x * y, x * z, y * z);
    let (xx, yy, zz) = (x * x, y * y, z * z);
    let across = xx + yy;
    #[rustfmt::skip]
    let increment = Matrix3::new(
        -(yy + zz), xy - wz,    xz + wy,
        xy + wz,    -(xx + zz), yz - wx,
        xz - wy,    yz + wx,    -across,
    );
    increment * (real::<T>(2.0) / ((w * w + zz) + across))
}
