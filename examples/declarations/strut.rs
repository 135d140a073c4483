//! A joint of the user's own.

use liestep::SetupError;
use liestep::methods::{Constraint, Place, Slope};
use nalgebra::{Vector1, Vector3};

/// A massless rod between a point of one body and a point of the other, under a name of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strut {
    /// The name of the joint.
    pub called: &'static str,
    /// The point of the body above, in that body's axes, m.
    pub above: Vector3<f64>,
    /// The point of the body below, in that body's axes, m.
    pub below: Vector3<f64>,
    /// The length of the rod, m.
    pub length: f64,
}

impl Strut {
    fn along(&self, above: &Place, below: &Place) -> Vector3<f64> {
        below.of(&self.below) - above.of(&self.above)
    }
}

impl Constraint<1> for Strut {
    fn name(&self) -> &'static str {
        self.called
    }

    fn validate(&self) -> Result<(), SetupError> {
        if self.length > 0.0 {
            Ok(())
        } else {
            Err(SetupError::Parameter { field: "length", cause: "is not a length" })
        }
    }

    fn gap(&self, above: &Place, below: &Place) -> Vector1<f64> {
        Vector1::new((self.along(above, below).norm_squared() / self.length - self.length) / 2.0)
    }

    fn slope(&self, above: &Place, below: &Place) -> [Slope<1>; 2] {
        let along = self.along(above, below) / self.length;
        let of = |place: &Place, point: &Vector3<f64>, side: f64| Slope {
            turn: (place.attitude * point).cross(&along).transpose() * side,
            shift: along.transpose() * side,
        };
        [of(above, &self.above, -1.0), of(below, &self.below, 1.0)]
    }

    fn describe(&self, visit: &mut dyn FnMut(&'static str, f64)) {
        self.above.iter().chain(&self.below).for_each(|&entry| visit("point", entry));
        visit("length", self.length);
    }
}
