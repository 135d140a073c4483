//! Quaternions of increments.

use nalgebra::Matrix3;

use crate::numbers::{Number, Real};

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

/// `F − I` times the square of the length.
#[hot]
pub(super) fn scaled_increment<T: Real>([w, x, y, z]: Quaternion<T>) -> Matrix3<T> {
    let (tx, ty, tz) = (x + x, y + y, z + z);
    let (wx, wy, wz) = (w * tx, w * ty, w * tz);
    let (xy, xz, yz) = (x * ty, x * tz, y * tz);
    let (sx, sy, sz) = (x * tx, y * ty, z * tz);
    #[rustfmt::skip]
    let increment = Matrix3::new(
        -(sy + sz), xy - wz,    xz + wy,
        xy + wz,    -(sx + sz), yz - wx,
        xz - wy,    yz + wx,    -(sx + sy),
    );
    increment
}
