//! A magnetised body.

use liestep::groups::CovariantTensor;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::{Matrix3, Vector3};

/// A body about a pivot with a magnetic dipole and a quadrupole of its own, in a field with a gradient.
///
/// Two parameters of different kinds are advected: the field is a covector, its gradient a bilinear form. The energy
/// is `−m·B − ½ tr(Q S)`.
#[lagrangian(
    group = SO3,
    advected(B = field, S = gradient),
    l_d = {
        let kinetic = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h);
        let dipolar = B.dot(&(m + F * m));
        let quadrupolar = 0.5 * (S * (Q + F * Q * F.transpose())).trace();
        kinetic + 0.5 * h * (dipolar + quadrupolar)
    },
)]
#[derive(Clone, Debug)]
pub struct Magnet {
    /// Nonstandard inertia about the pivot, kg m².
    pub J_d: NonstandardInertia,
    /// Dipole moment, body frame, A m².
    pub m: Vector3<f64>,
    /// Quadrupole moment, body frame, A m³.
    pub Q: Matrix3<f64>,
    /// The field at the pivot, in space, T.
    pub field: Vector3<f64>,
    /// Gradient of the field, in space, T/m.
    pub gradient: CovariantTensor<f64, 3>,
}
