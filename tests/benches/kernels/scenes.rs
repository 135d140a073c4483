//! The cost of an effect in a step, for sums and for single declarations: `cargo bench -p liestep-benches -- scenes`.
//!
//! A program of its own: beside the kernels of all tables, the compiler cuts a step otherwise, by up to a hundredth.
//!
//! A scene with gravity occurs three times: without it, with the coefficient zero, and with it.

mod kernel;
mod stepping;

use declarations::{DoublePendulum, EqualNeedle, HeavyTop, Needle};
use liestep::effects::{
    AirDrag, CayleyBody, Dipole, Drag, FourthOrderBody, GeodesicBody, GravityGradient, MagneticDamping, Rotor,
    SixthOrderBody, Spring, Thrust, Torque,
};
use liestep::prelude::*;
use nalgebra::Vector3;

use kernel::{Failure, Group, Kernel, arguments, built, instructions, measure};
use stepping::{EFFORT, scene, stepping};

/// A body with a rotor in a single declaration.
#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + spin.dot(&vee(F)))]
#[derive(Clone)]
struct Gyrostat {
    J_d: DiagonalNonstandardInertia,
    spin: Vector3<f64>,
}

fn groups() -> Result<Vec<Group>, Failure> {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5))?;
    let (body, spin) = (PrincipalBody { J_d }, Vector3::new(0.1, 0.2, 0.3));
    let (m, g, rho, up) = (1.0, 9.81, Vector3::new(0.3, 0.2, 0.4), Vector3::z());
    let gravity = Gravity { m, g, rho, up };
    let J = Inertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5))?;
    let kernels = [
        scene("body", body),
        scene("body + gravity", body + gravity),
        scene("heavy top in one piece", HeavyTop { J_d, m, g, rho, up }),
        scene("body + gravity with m = 0", body + Gravity { m: 0.0, ..gravity }),
        scene("body + gravity gradient", body + GravityGradient { GM: 1.0, r: 1.0, J, direction: up }),
        scene("body + dipole", body + Dipole { moment: rho, field: up }),
        scene("body + spring", body + Spring { k: 1.0, length: 0.5, at: rho, anchor: up }),
        scene("body + rotor", body + Rotor { spin }),
        scene("body + torque", body + Torque { torque: spin * 1e-3 }),
        scene("body + thrust", body + Thrust { at: rho, thrust: spin * 1e-3 }),
        scene("body + drag", body + Drag { c: 1e-3, J }),
        scene("body + air drag", body + AirDrag { c: 1e-3, air: spin, J }),
        scene("body + magnetic damping", body + MagneticDamping { k: 1e-3, field: rho, J }),
        scene("gyrostat in one piece", Gyrostat { J_d, spin }),
        scene("Cayley body", CayleyBody { J }),
        scene("geodesic body", GeodesicBody { J }),
        scene("body of fourth order", FourthOrderBody { J }),
        scene("body of sixth order", SixthOrderBody { J }),
        scene("body, full inertia", RigidBody { J_d: J.to_nonstandard() }),
        scene("double pendulum", double_pendulum()?),
    ];
    Ok(vec![Group::new("", EFFORT, kernels.into_iter().chain(needles()))])
}

/// A needle by equal steps and by its pace: both take the same number of steps in 12 s.
fn needles() -> [Kernel; 2] {
    let momentum = Vector3::new(0.9, 0.15, 0.3);
    let equal = move || {
        let Needle { J_d, a, rho, delta, .. } = Needle::new(0.05);
        let equal = Stepper::new(EqualNeedle { J_d, a, rho, delta }, 0.006)?;
        let start = equal.start_with_momentum(SO3::identity(), momentum)?;
        Ok((equal, start))
    };
    let paced = move || {
        let paced = Stepper::new(Needle::new(0.05), 0.01).and_then(Stepper::paced)?;
        let start = paced.start_with_momentum(SO3::identity(), momentum)?;
        Ok((paced, start))
    };
    [stepping("needle", equal), stepping("needle with its pace", paced)]
}

/// Two links of unit mass and length.
fn double_pendulum() -> Result<DoublePendulum, Failure> {
    let rod = |beyond: f64| NonstandardInertia::from_diagonal(Vector3::new(0.02, 0.02, 1.0 / 3.0 + beyond));
    let (down, up) = (-Vector3::z(), Vector3::z());
    Ok(DoublePendulum { J_1: rod(1.0)?, J_2: rod(0.0)?, rho: down, s_1: down * 1.5, s_2: down * 0.5, g: 9.81, up })
}

/// Counts the free body in this program and in a program without other effects.
fn zero_cost() -> Result<(), Failure> {
    let beside = instructions(&std::env::current_exe()?, &["count", "body"], EFFORT.counted)?;
    let alone = instructions(&built("free-body-alone", &[], None)?, &["count", "body"], EFFORT.counted)?;
    println!("free body beside the other effects{beside:>10.1} instructions a step");
    println!("free body alone                   {alone:>10.1} instructions a step");
    // The counts are exact, so they must be equal.
    if beside.to_bits() == alone.to_bits() { Ok(()) } else { Err("what isn't in the scene costs something".into()) }
}

fn main() -> Result<(), Failure> {
    let words = arguments();
    match words.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["zero-cost"] => zero_cost(),
        words => measure(&[], groups()?, words),
    }
}
