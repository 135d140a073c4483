//! The derived equations of declared Lagrangians, to read beside the paper.
//!
//! ```text
//! cargo run -p liestep-declarations --example derive                 what there is
//! cargo run -p liestep-declarations --example derive -- heavy-top    all equations of one
//! ```
//!
//! The documentation of the constant `DERIVATION` contains the same text, and that of each generated method its
//! equation.

use std::process::ExitCode;

use liestep::mechanics::{ContinuousLagrangian, DiscreteLagrangian};
use workbench::args::{Failure, Word, example};
use workbench::output::print;

/// A declaration in the list.
struct Entry {
    name: &'static str,
    about: &'static str,
    derivation: &'static str,
    /// Whether the Lagrangian is self-adjoint, if it is discrete.
    is_self_adjoint: Option<bool>,
}

const fn shown<L: DiscreteLagrangian>(name: &'static str, about: &'static str) -> Entry {
    Entry { name, about, derivation: L::DERIVATION, is_self_adjoint: Some(L::FACTS.is_self_adjoint) }
}

const fn continuous<L: ContinuousLagrangian>(name: &'static str, about: &'static str) -> Entry {
    Entry { name, about, derivation: L::CONTINUOUS_DERIVATION, is_self_adjoint: None }
}

/// All declarations; a new one is one line.
const LAGRANGIANS: [Entry; 21] = [
    shown::<declarations::HeavyTop>("heavy-top", "(3.13) in principal axes: μ is (3.17), (L_F)* δl_d/δF is (3.18)"),
    shown::<declarations::ContinuousTop>("continuous-top", "l(Ω, w) of section 3.2, of which (3.13) is made"),
    shown::<declarations::FullTop>("full-top", "(3.13) with a full inertia tensor"),
    shown::<declarations::FreeBody>("free-body", "the kinetic part of (3.13) alone"),
    shown::<declarations::CayleyTop>("cayley-top", "a kinetic term that is solvable for every h"),
    shown::<declarations::LogTop>("log-top", "the geodesic kinetic term"),
    shown::<declarations::LogTraceTop>("log-trace-top", "Bobenko and Suris' top, which has an energy integral"),
    shown::<declarations::FourthOrderTop>("fourth-order-top", "order 4 in one solve"),
    shown::<declarations::SixthOrderTop>("sixth-order-top", "order 6 in one solve"),
    shown::<declarations::FourthOrderBody>("fourth-order-body", "a free body, order 4 in one solve"),
    shown::<declarations::SixthOrderBody>("sixth-order-body", "a free body, order 6 in one solve"),
    shown::<declarations::Satellite>("satellite", "attitude in the gravity of a near centre"),
    shown::<declarations::OrbitingBody>("orbiting-body", "orbit and attitude on SE(3)"),
    shown::<declarations::Spring>("spring", "a body tied to a fixed point"),
    shown::<declarations::SlidingTop>("sliding-top", "a top on a smooth plane, whose inertia depends on how it stands"),
    shown::<declarations::DoublePendulum>("double-pendulum", "two links on ball joints"),
    shown::<declarations::Magnet>("magnet", "a magnet in a field with a gradient"),
    shown::<declarations::UnderwaterBody>("underwater-body", "Kirchhoff's body on SE(3) with added mass"),
    shown::<declarations::TetheredPlate>("tethered-plate", "a plate on a spring, SE(2)"),
    shown::<declarations::ElasticFlow>("elastic-flow", "an affine flow of an elastic drop, SL(2, R)"),
    continuous::<declarations::RelativisticParticle>("relativistic-particle", "continuous only, not quadratic in v"),
];

const HELP: &str = "Prints what is derived from a declared Lagrangian

Argument:
  [NAME]  Which one; all are listed if it is left away
";

fn main() -> ExitCode {
    example(HELP, |words| {
        let mut name = None;
        while let Some(word) = words.word()? {
            match word {
                Word::Plain(word) if name.is_none() => name = Some(word),
                Word::Plain(word) => return Err(format!("unexpected argument '{}'", word.display()).into()),
                Word::Option(_) => return Err(words.unknown()),
            }
        }
        print(&name.map_or_else(|| Ok(list()), |name| derivation(&name.display().to_string()))?)?;
        Ok(())
    })
}

fn list() -> String {
    let line = |Entry { name, about, is_self_adjoint, .. }: &Entry| {
        let adjoint = match is_self_adjoint {
            Some(true) => "self-adjoint",
            Some(false) => "–",
            None => "continuous",
        };
        format!("{name:<20} {adjoint:<14} {about}\n")
    };
    LAGRANGIANS.iter().map(line).collect()
}

fn derivation(wanted: &str) -> Result<String, Failure> {
    let found = LAGRANGIANS.iter().find(|shown| shown.name == wanted);
    let Entry { name, about, derivation, .. } = found.ok_or_else(|| {
        let names: Vec<_> = LAGRANGIANS.iter().map(|shown| shown.name).collect();
        format!("invalid value '{wanted}': it is none of {}", names.join(", "))
    })?;
    Ok(format!("{name}: {about}\n\n{derivation}\n"))
}
