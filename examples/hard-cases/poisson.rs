//! The distance of a map of momentum and vertical from a Poisson map of the semidirect product.
//!
//! The tensor is in closed form on SO(3); the tests compute it from the brackets of any group.

use liestep::laws::samples::derivative;
use nalgebra::{Matrix6, Vector3, Vector6};
use workbench::heavy_top::continuous::phase;

/// The momentum and the vertical.
pub(crate) type Phase = (Vector3<f64>, Vector3<f64>);

fn joined((momentum, w): &Phase) -> Vector6<f64> {
    phase(momentum, w)
}

fn apart(z: &Vector6<f64>) -> Phase {
    (z.fixed_rows::<3>(0).into_owned(), z.fixed_rows::<3>(3).into_owned())
}

/// The Poisson tensor `B = [[μ̂, ŵ], [ŵ, 0]]`.
fn tensor((momentum, w): &Phase) -> Matrix6<f64> {
    let mut tensor = Matrix6::zeros();
    tensor.fixed_view_mut::<3, 3>(0, 0).copy_from(&momentum.cross_matrix());
    tensor.fixed_view_mut::<3, 3>(0, 3).copy_from(&w.cross_matrix());
    tensor.fixed_view_mut::<3, 3>(3, 0).copy_from(&w.cross_matrix());
    tensor
}

/// The largest entry of `DΦ B(z) DΦᵀ − B(Φ(z))`; NaN where `Φ` isn't defined near `z`.
pub(crate) fn defect(map: impl Fn(&Phase) -> Option<Phase>, z: &Phase) -> f64 {
    let value = |z: &Vector6<f64>| map(&apart(z)).map_or(Vector6::repeat(f64::NAN), |after| joined(&after));
    let columns: Vec<_> = (0..6).map(|k| derivative(|t| value(&(joined(z) + Vector6::ith(k, t))))).collect();
    let tangent = Matrix6::from_columns(&columns);
    let defect = tangent * tensor(z) * tangent.transpose() - tensor(&apart(&value(&joined(z))));
    // `amax` would ignore NaN.
    defect.iter().map(|entry| entry.abs()).fold(0.0, workbench::measure::greater)
}
