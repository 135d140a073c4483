use liestep::SetupError;
use liestep::methods::{Constraint, Place, Slope};
use nalgebra::Vector1;

#[derive(Clone, Debug, PartialEq)]
struct Rope {
    lengths: Vec<f64>,
}

impl Constraint<1> for Rope {
    fn name(&self) -> &'static str {
        "rope"
    }

    fn validate(&self) -> Result<(), SetupError> {
        Ok(())
    }

    fn gap(&self, above: &Place, below: &Place) -> Vector1<f64> {
        Vector1::new((below.position - above.position).norm() - self.lengths[0])
    }

    fn slope(&self, _: &Place, _: &Place) -> [Slope<1>; 2] {
        unimplemented!()
    }

    fn describe(&self, _: &mut dyn FnMut(&'static str, f64)) {}
}

fn main() {}
