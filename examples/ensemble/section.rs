//! A Poincaré section of an asymmetric heavy top, for motions with one energy and one momentum about the vertical.
//!
//! By that momentum the top is a system of two degrees of freedom, and its energy surface has three dimensions. The
//! section is the passage of the second body axis upwards through the horizontal plane. Its coordinates are the
//! nutation, which is the angle of the vertical from the third axis towards the first, and the momentum `p_2`: regular
//! motions draw curves there, chaotic ones fill areas.

use liestep::effects::{Gravity, PrincipalBody};
use liestep::mechanics::{DiagonalNonstandardInertia, Sum};
use liestep::motion::Moment;
use liestep::recording::{Event, sections};
use liestep::{SO3, Stepper};
use liestep_ensemble::{Ensemble, Failure, Member, Section, Store};
use nalgebra::Vector3;

use crate::Mistake;

const STEP: f64 = 0.01; // s
const MOMENTS: Vector3<f64> = Vector3::new(2.0, 3.0, 4.0); // kg m²
const WEIGHT: f64 = 9.81; // N, at the centre of mass:
const CENTRE: Vector3<f64> = Vector3::new(0.2, 0.0, 0.9); // m
const ENERGY: f64 = 13.0; // J
const VERTICAL: f64 = 3.0; // kg m²/s
/// The largest possible `p_2` at this energy, kg m²/s.
pub(crate) const LARGEST: f64 = 12.5;

type Top = Stepper<Sum<PrincipalBody, Gravity>>;

/// The ensemble of `members` motions, each of `steps` steps.
pub(crate) fn ensemble(members: u64, steps: u64) -> Ensemble<Top> {
    let section = Section::new(Event::rising(), sections::plane(Vector3::y(), Vector3::z())).keep(
        ["t", "nutation", "p2"],
        |now: &Moment<'_, Top>| {
            let w = now.advected().1;
            [now.time(), w.x.atan2(w.z), now.momentum().y]
        },
    );
    Ensemble::new("a section of a top", members, steps, top)
        .chunks_of(8)
        .keep(["energy"], |run| [run.stepper.energy(run.state)])
        .section(section)
}

/// A top at a random point of the section.
fn top(member: &Member<'_>) -> Result<(Top, <Top as liestep::motion::Integrator>::State), Failure> {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(MOMENTS)?;
    let gravity = Gravity { m: 1.0, g: WEIGHT, rho: CENTRE, up: Vector3::z() };
    let stepper = Stepper::new(PrincipalBody { J_d } + gravity, STEP)?;
    for attempt in 0..1_000 {
        let nutation = member.uniform(&format!("nutation {attempt}"), -3.1..3.1);
        let across = member.uniform(&format!("p_2 {attempt}"), -LARGEST..LARGEST);
        if let Some(momentum) = momentum(nutation, across) {
            let attitude = SO3::exp(-Vector3::y() * nutation);
            let state = stepper.start_with_momentum(attitude, momentum)?;
            return Ok((stepper, state));
        }
    }
    Err(Failure::Other("no motion of this energy was drawn".to_owned()))
}

/// The momentum of a motion with the energy that passes upwards through the section at this point, if there is one.
fn momentum(nutation: f64, across: f64) -> Option<Vector3<f64>> {
    let (sine, cosine) = nutation.sin_cos();
    let (w, u) = (Vector3::new(sine, 0.0, cosine), Vector3::new(cosine, 0.0, -sine));
    let mobility = MOMENTS.map(f64::recip);
    let kinetic = |a: &Vector3<f64>, b: &Vector3<f64>| a.dot(&b.component_mul(&mobility));
    let left = ENERGY - WEIGHT * CENTRE.dot(&w) - 0.5 * across * across / MOMENTS.y;
    // In p = c w + a u + p_2 E_2 the value of ½ p·J⁻¹p is known: A a² + 2B a + C = 0. The rate through the section is A
    // a + B.
    let (quadratic, half) = (kinetic(&u, &u), VERTICAL * kinetic(&u, &w));
    let square = half * half - quadratic * (VERTICAL * VERTICAL * kinetic(&w, &w) - 2.0 * left);
    (square > 0.0).then(|| w * VERTICAL + u * ((square.sqrt() - half) / quadratic) + Vector3::y() * across)
}

/// A motion by its crossings.
#[derive(Clone, Debug)]
pub(crate) struct Orbit {
    /// The energy error at the end, J.
    pub(crate) off: f64,
    /// Nutation (rad) and `p_2` (kg m²/s) of each crossing.
    pub(crate) points: Vec<[f64; 2]>,
}

/// The crossings and the energy error of each member.
pub(crate) fn crossings(ensemble: &Ensemble<Top>, store: &Store) -> Result<Vec<Orbit>, Mistake> {
    let mut found = Vec::new();
    for shard in ensemble.shards(store)? {
        let rows = shard.map_err(|fault| fault.to_string())?.rows;
        let first = found.len();
        found.extend(rows.columns[0].iter().map(|energy| Orbit { off: energy - ENERGY, points: Vec::new() }));
        // Each member has one row with all its crossings.
        for (place, row) in rows.crossings[0].row.iter().enumerate() {
            let [nutation, across] = [1, 2].map(|column| rows.crossings[0].columns[column][place]);
            found[first + row].points.push([nutation, across]);
        }
    }
    Ok(found)
}
