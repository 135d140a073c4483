//! The library's own declarations, as they stand in its sources.

use pyo3::prelude::*;

macro_rules! declarations {
    ($($name:literal $file:literal $declared:literal),+ $(,)?) => {
        /// The name in Python, the struct's name, and the file that declares it.
        const DECLARATIONS: &[(&str, &str, &str)] =
            &[$(($name, $declared, include_str!(concat!("../../src/effects/", $file, ".rs")))),+];
    };
}

declarations! {
    "rigid_body" "rigid_body" "RigidBody",
    "cayley_body" "cayley_body" "CayleyBody",
    "geodesic_body" "geodesic_body" "GeodesicBody",
    "gravity" "gravity" "Gravity",
    "gravity_gradient" "gravity_gradient" "GravityGradient",
    "dipole" "dipole" "Dipole",
    "spring" "spring" "Spring",
    "rotor" "rotor" "Rotor",
    "drag" "drag" "Drag",
    "magnetic_damping" "magnetic_damping" "MagneticDamping",
    "torque" "torque" "Torque",
    "thrust" "thrust" "Thrust",
}

/// The attribute and the struct of one of them: what `liestep._library` reads.
#[pyfunction]
pub(crate) fn library(name: &str) -> Option<&'static str> {
    let (_, declared, file) = DECLARATIONS.iter().find(|(own, ..)| *own == name)?;
    let at = file.find(&format!("pub struct {declared}"))?;
    let begin = ["\n#[lagrangian", "\n#[force"].iter().filter_map(|mark| file.get(..at)?.rfind(mark)).max()?;
    let end = at + file.get(at..)?.find("\n}")?;
    file.get(begin + 1..end)
}
