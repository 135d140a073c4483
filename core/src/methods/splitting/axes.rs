//! Which body axis is which.

use nalgebra::Vector3;

use crate::numbers::Real;

/// The body axes, in an order that keeps them right-handed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axes {
    Xyz,
    Yzx,
    Zxy,
}

#[hot]
impl Axes {
    /// The components of a vector along these axes, which are right-handed.
    pub(super) fn of<T: Real>(self, v: &Vector3<T>) -> [T; 3] {
        let (x, y, z) = (v.x, v.y, v.z);
        match self {
            Self::Xyz => [x, y, z],
            Self::Yzx => [y, z, x],
            Self::Zxy => [z, x, y],
        }
    }

    /// A quaternion from those components of its vector to the body's.
    pub(super) fn back<T: Real>(self, [w, a, b, c]: [T; 4]) -> [T; 4] {
        match self {
            Self::Xyz => [w, a, b, c],
            Self::Yzx => [w, c, a, b],
            Self::Zxy => [w, b, c, a],
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Vector3, Vector4};

    use super::Axes;

    /// Cross products are those of right-handed axes in all three, and what is taken there comes back.
    #[test]
    fn components_are_right_handed() {
        let (u, v) = (Vector3::new(0.3, -1.2, 0.7), Vector3::new(-0.4, 0.5, 1.1));
        for axes in [Axes::Xyz, Axes::Yzx, Axes::Zxy] {
            let inside = |v: &Vector3<f64>| Vector3::from(axes.of(v));
            assert_eq!(inside(&u.cross(&v)), inside(&u).cross(&inside(&v)), "{axes:?}");
            let [a, b, c] = axes.of(&u);
            assert_eq!(Vector4::from(axes.back([0.5, a, b, c])), Vector4::new(0.5, u.x, u.y, u.z), "{axes:?}");
        }
    }
}
