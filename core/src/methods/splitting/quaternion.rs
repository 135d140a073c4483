//! Quaternions of increments.

use nalgebra::Matrix3;

use crate::numbers::{Number, Real, real};

/// A quaternion: its real part, and its components along three axes.
pub(super) type Quaternion<T> = [T; 4];

/// The product, as a composition of rotations: the right factor acts first.
#[hot]
pub(super) fn product<T: Number>([s, a, b, c]: Quaternion<T>, [w, x, y, z]: Quaternion<T>) -> Quaternion<T> {
    [
        s * w - (a * x + (b * y + c * z)),
        s * x + (a * w + (b * z - c * y)),
        s * y + (b * w + (c * x - a * z)),
        s * z + (c * w + (a * y - b * x)),
    ]
}

/// The product with a quaternion whose third component is zero.
#[hot]
pub(super) fn product_across<T: Number>([s, a, b, c]: Quaternion<T>, [w, x, y]: [T; 3]) -> Quaternion<T> {
    [s * w - (a * x + b * y), (s * x + a * w) - c * y, (s * y + b * w) + c * x, c * w + (a * y - b * x)]
}

/// The increment `F − I` of a quaternion of any length.
///
/// The diagonal and the length are sums of the products that the matrix consists of. Otherwise constant rounding
/// errors, of a factor or of the length, would accumulate over the steps.
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
