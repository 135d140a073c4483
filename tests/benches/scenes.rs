//! The cost of an effect in a step: instructions and nanoseconds of scenes, for sums and for single declarations.
//!
//! ```text
//! cargo bench --bench scenes                       times a step of every scene
//! cargo bench --bench scenes -- instructions       counts the instructions of a step of every scene, by valgrind
//! cargo bench --bench scenes -- files              counts those of scenes from files
//! cargo bench --bench scenes -- members            times the members of a file's ensemble
//! cargo bench --bench scenes -- zero-cost          counts those of the free body here and in a program of its own
//! cargo bench --bench scenes -- count NAME 1000    runs 1000 steps of one scene and nothing else
//! ```
//!
//! A scene with gravity occurs three times: without it, with the coefficient zero, and with it.

mod counting;
mod files;
mod stepping;

use declarations::{DoublePendulum, EqualNeedle, HeavyTop, Needle};
use liestep::effects::{
    AirDrag, CayleyBody, Dipole, Drag, FourthOrderBody, GeodesicBody, GravityGradient, MagneticDamping, Rotor,
    SixthOrderBody, Spring, Thrust, Torque,
};
use liestep::mechanics::Regular;
use liestep::motion::Plan;
use liestep::prelude::*;
use nalgebra::Vector3;

use counting::{Uncounted, built, instructions};
use stepping::{Count, Ready, Time, Visit};

/// A body with a rotor in a single declaration.
#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + spin.dot(&vee(F)))]
struct Gyrostat {
    J_d: DiagonalNonstandardInertia,
    spin: Vector3<f64>,
}

fn visit_all(visit: &mut impl Visit) {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).expect("a body");
    let (body, spin) = (PrincipalBody { J_d }, Vector3::new(0.1, 0.2, 0.3));
    let (m, g, rho, up) = (1.0, 9.81, Vector3::new(0.3, 0.2, 0.4), Vector3::z());
    let gravity = Gravity { m, g, rho, up };
    let J = Inertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).expect("a body");
    visit.visit("body", body);
    visit.visit("body + gravity", body + gravity);
    visit.visit("heavy top in one piece", HeavyTop { J_d, m, g, rho, up });
    visit.visit("body + gravity with m = 0", body + Gravity { m: 0.0, ..gravity });
    visit.visit("body + gravity gradient", body + GravityGradient { GM: 1.0, r: 1.0, J, direction: up });
    visit.visit("body + dipole", body + Dipole { moment: rho, field: up });
    visit.visit("body + spring", body + Spring { k: 1.0, length: 0.5, at: rho, anchor: up });
    visit.visit("body + rotor", body + Rotor { spin });
    visit.visit("body + torque", body + Torque { torque: spin * 1e-3 });
    visit.visit("body + thrust", body + Thrust { at: rho, thrust: spin * 1e-3 });
    visit.visit("body + drag", body + Drag { c: 1e-3, J });
    visit.visit("body + air drag", body + AirDrag { c: 1e-3, air: spin, J });
    visit.visit("body + magnetic damping", body + MagneticDamping { k: 1e-3, field: rho, J });
    visit.visit("gyrostat in one piece", Gyrostat { J_d, spin });
    visit.visit("Cayley body", CayleyBody { J });
    visit.visit("geodesic body", GeodesicBody { J });
    visit.visit("body of fourth order", FourthOrderBody { J });
    visit.visit("body of sixth order", SixthOrderBody { J });
    visit.visit("body, full inertia", RigidBody { J_d: J.to_nonstandard() });
    visit.visit("double pendulum", double_pendulum());
    let needle @ Needle { J_d, a, rho, delta, .. } = Needle::new(0.05);
    let momentum = Vector3::new(0.9, 0.15, 0.3);
    // Both take the same number of steps in 12 s.
    let equal = Stepper::new(EqualNeedle { J_d, a, rho, delta }, 0.006).expect("a usable step");
    let start = equal.start_with_momentum(SO3::identity(), momentum).expect("a usable start");
    visit.visit_from("needle", (equal, start));
    let paced = Stepper::new(needle, 0.01).and_then(Stepper::paced).expect("a usable step");
    let start = paced.start_with_momentum(SO3::identity(), momentum).expect("a usable start");
    visit.visit_from("needle with its pace", (paced, start));
}

/// Two links of unit mass and length.
fn double_pendulum() -> DoublePendulum {
    let rod = |beyond: f64| {
        let J_d = Vector3::new(0.02, 0.02, 1.0 / 3.0 + beyond);
        NonstandardInertia::from_diagonal(J_d).expect("a rod")
    };
    let down = -Vector3::z();
    DoublePendulum {
        J_1: rod(1.0),
        J_2: rod(0.0),
        rho: down,
        s_1: down * 1.5,
        s_2: down * 0.5,
        g: 9.81,
        up: Vector3::z(),
    }
}

const COUNTED: u32 = 10_000;
/// The number of steps in counts of files: a file's run samples its motion for a picture, as often in a run as in one
/// twice as long.
const COUNTED_OF_FILES: u32 = 40_000;

/// Counts the instructions of every scene, each in a process of its own.
struct Instructions(Result<(), Uncounted>);

impl Visit for Instructions {
    fn visit_from<L: Regular<Scalar = f64>, P: Plan<L>>(&mut self, name: &'static str, _: Ready<L, P>) {
        let count = || -> Result<(), Uncounted> {
            let steps = instructions(&std::env::current_exe()?, &["count", name], COUNTED)?;
            println!("{name:<28}{steps:>8.1} instructions a step");
            Ok(())
        };
        if self.0.is_ok() {
            self.0 = count();
        }
    }
}

/// Counts the instructions of scenes from files.
fn from_files() -> Result<(), Uncounted> {
    for (name, _) in files::FILES {
        let steps = instructions(&std::env::current_exe()?, &["count-file", name], COUNTED_OF_FILES)?;
        println!("{name:<28}{steps:>8.1} instructions a step from a file");
    }
    Ok(())
}

/// Counts the free body in this program and in a program without other effects.
fn zero_cost() -> Result<(), Uncounted> {
    let beside = instructions(&std::env::current_exe()?, &["count", "body"], COUNTED)?;
    let alone = instructions(&built("free-body-alone")?, &["count", "body"], COUNTED)?;
    println!("free body beside the other effects{beside:>10.1} instructions a step");
    println!("free body alone                   {alone:>10.1} instructions a step");
    // The counts are exact, so they must be equal.
    if beside.to_bits() == alone.to_bits() { Ok(()) } else { Err("what isn't in the scene costs something".into()) }
}

fn main() -> Result<(), Uncounted> {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["count", wanted, steps] => {
            let mut count = Count::new(wanted, steps.parse()?);
            visit_all(&mut count);
            if count.found { Ok(()) } else { Err(format!("there is no scene `{wanted}`").into()) }
        }
        ["count-file", wanted, steps] => {
            let found = files::FILES.iter().find(|(name, _)| name == wanted);
            let (_, tables) = found.ok_or_else(|| format!("there is no file `{wanted}`"))?;
            Ok(files::run(tables, steps.parse()?)?)
        }
        ["files"] => from_files(),
        ["members"] => files::members(),
        ["instructions"] => {
            let mut all = Instructions(Ok(()));
            visit_all(&mut all);
            all.0
        }
        ["zero-cost"] => zero_cost(),
        _ => {
            visit_all(&mut Time);
            Ok(())
        }
    }
}
