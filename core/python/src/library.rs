//! The library's own declarations, as the macro leaves them.

use liestep::effects::{
    CayleyBody, Dipole, Drag, FourthOrderBody, GeodesicBody, Gravity, GravityGradient, MagneticDamping, RigidBody,
    Rotor, SixthOrderBody, Spring, Thrust, Torque,
};
use liestep::mechanics::Effect;
use pyo3::prelude::*;

const DECLARATIONS: [(&str, &str); 14] = [
    ("rigid_body", <RigidBody as Effect>::DECLARATION),
    ("cayley_body", <CayleyBody as Effect>::DECLARATION),
    ("geodesic_body", <GeodesicBody as Effect>::DECLARATION),
    ("fourth_order_body", <FourthOrderBody as Effect>::DECLARATION),
    ("sixth_order_body", <SixthOrderBody as Effect>::DECLARATION),
    ("gravity", <Gravity as Effect>::DECLARATION),
    ("gravity_gradient", <GravityGradient as Effect>::DECLARATION),
    ("dipole", <Dipole as Effect>::DECLARATION),
    ("spring", <Spring as Effect>::DECLARATION),
    ("rotor", <Rotor as Effect>::DECLARATION),
    ("drag", <Drag as Effect>::DECLARATION),
    ("magnetic_damping", <MagneticDamping as Effect>::DECLARATION),
    ("torque", <Torque as Effect>::DECLARATION),
    ("thrust", <Thrust as Effect>::DECLARATION),
];

/// The attribute and the struct of one of them: what `liestep._library` reads.
#[pyfunction]
pub(crate) fn library(name: &str) -> Option<&'static str> {
    DECLARATIONS.iter().find(|(own, _)| *own == name).map(|(_, text)| *text)
}
