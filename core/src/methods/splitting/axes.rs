//! Cyclic permutations of the body axes.

use nalgebra::Vector3;

use crate::numbers::Real;

/// A right-handed order of the body axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axes {
    Xyz,
    Yzx,
    Zxy,
}

#[hot]
impl Axes {
    /// The components of a vector along the axes in this order.
    pub(super) fn of<T: Real>(self, v: &Vector3<T>) -> [T; 3] {
        let (x, y, z) = (v.x, v.y, v.z);
        match self {
            Self::Xyz => [x, y, z],
            Self::Yzx => [y, z, x],
            Self::Zxy => [z, x, y],
        }
    }

    /// A quaternion in the body's axes, from one with its vector part in this order.
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

    /// Each order is right-handed, and `back` inverts `of`.
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
