//! A joint that the library doesn't have.

use liestep::SetupError;
use liestep::methods::{Constraint, Place, Slope};
use nalgebra::{Vector1, Vector3};

/// A rod without mass between a point of one body and a point of the other, or what is called by another name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strut {
    /// Its name.
    pub called: &'static str,
    /// In the axes of the body above, m.
    pub above: Vector3<f64>,
    /// In the axes of the body below, m.
    pub below: Vector3<f64>,
    /// m.
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
