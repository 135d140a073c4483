//! Which body axis is which.

use nalgebra::Vector3;

use crate::numbers::Real;

/// The axes of the first and of the second rotation, and that of the middle moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axes {
    Xyz,
    Yzx,
    Zxy,
    Yxz,
    Xzy,
    Zyx,
}

impl Axes {
    pub(super) const ALL: [Self; 6] = [Self::Xyz, Self::Yzx, Self::Zxy, Self::Yxz, Self::Xzy, Self::Zyx];

    /// The moments about these axes.
    pub(super) fn moments<T: Real>(self, moments: &Vector3<T>) -> [T; 3] {
        let (x, y, z) = (moments.x, moments.y, moments.z);
        match self {
            Self::Xyz => [x, y, z],
            Self::Yzx => [y, z, x],
            Self::Zxy => [z, x, y],
            Self::Yxz => [y, x, z],
            Self::Xzy => [x, z, y],
            Self::Zyx => [z, y, x],
        }
    }

    /// Components along these axes of a vector that turns. To the left-handed three all rotations are the other way,
    /// which is made good by the signs of all of them: in these components each three are right-handed.
    #[hot]
    pub(super) fn of<T: Real>(self, v: &Vector3<T>) -> [T; 3] {
        let (x, y, z) = (v.x, v.y, v.z);
        match self {
            Self::Xyz => [x, y, z],
            Self::Yzx => [y, z, x],
            Self::Zxy => [z, x, y],
            Self::Yxz => [-y, -x, -z],
            Self::Xzy => [-x, -z, -y],
            Self::Zyx => [-z, -y, -x],
        }
    }

    /// A quaternion from those components of its vector to the body's.
    #[hot]
    pub(super) fn back<T: Real>(self, [w, a, b, c]: [T; 4]) -> [T; 4] {
        match self {
            Self::Xyz => [w, a, b, c],
            Self::Yzx => [w, c, a, b],
            Self::Zxy => [w, b, c, a],
            Self::Yxz => [w, -b, -a, -c],
            Self::Xzy => [w, -a, -c, -b],
            Self::Zyx => [w, -c, -b, -a],
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Vector3, Vector4};

    use super::Axes;

    /// Cross products are those of right-handed axes in all six, and what is taken there comes back.
    #[test]
    fn components_are_right_handed() {
        let (u, v) = (Vector3::new(0.3, -1.2, 0.7), Vector3::new(-0.4, 0.5, 1.1));
        for axes in Axes::ALL {
            let inside = |v: &Vector3<f64>| Vector3::from(axes.of(v));
            assert_eq!(inside(&u.cross(&v)), inside(&u).cross(&inside(&v)), "{axes:?}");
            let [a, b, c] = axes.of(&u);
            assert_eq!(Vector4::from(axes.back([0.5, a, b, c])), Vector4::new(0.5, u.x, u.y, u.z), "{axes:?}");
            assert_eq!(Vector3::from(axes.moments(&u)).abs(), inside(&u).abs(), "{axes:?}");
        }
    }
}
