//! A satellite that tumbles about its middle axis, with moments and rates known to one per cent: the time until its
//! attitude is unknown.

use liestep::effects::RigidBody;
use liestep::motion::Motion;
use liestep::{NonstandardInertia, SO3, Stepper};
use liestep_ensemble::{Ensemble, Failure, Reduction, Store};
use nalgebra::Vector3;

use crate::Mistake;

const STEP: f64 = 0.05; // s
const STEPS: u64 = 4_000;
const EVERY: u64 = 40;

type Satellite = Stepper<RigidBody>;

/// The satellite with these factors of its moments and of its rates.
fn satellite(
    factors: [Vector3<f64>; 2],
) -> Result<(Satellite, <Satellite as liestep::motion::Integrator>::State), Failure> {
    let moments = Vector3::new(20.0, 25.0, 30.0).component_mul(&factors[0]); // kg m²
    let stepper = Stepper::new(RigidBody { J_d: NonstandardInertia::from_principal_moments(moments)? }, STEP)?;
    let rates = Vector3::new(0.02, 0.3, 0.01).component_mul(&factors[1]); // rad/s
    let state = stepper.start(SO3::identity(), rates)?;
    Ok((stepper, state))
}

/// The direction of the first axis in space.
fn pointing(motion: &Motion<SO3, ()>) -> [f64; 3] {
    (motion.attitude().as_matrix() * Vector3::x()).into()
}

/// The ensemble of this number of satellites.
pub(crate) fn ensemble(members: u64) -> Ensemble<Satellite> {
    let make = |member: &liestep_ensemble::Member<'_>| {
        let near_one =
            |name: &str| Vector3::from([1, 2, 3].map(|axis| member.normal(&format!("{name} {axis}"), 1.0, 0.01)));
        satellite([near_one("moment"), near_one("rate")])
    };
    Ensemble::new("a tumbling satellite", members, STEPS, make)
        .seed(1)
        .chunks_of(64)
        .every(EVERY)
        .keep(["x", "y", "z"], |run| pointing(run.state))
        .reduce("energy", Reduction::Moments, |run| run.stepper.energy(run.state))
}

/// The angles from the nominal satellite's direction at each recorded time, s, in degrees: the deciles 0.1, 0.5 and 0.9
/// of the members.
pub(crate) fn spread(ensemble: &Ensemble<Satellite>, store: &Store) -> Result<Vec<(f64, [f64; 3])>, Mistake> {
    let (stepper, mut nominal) = satellite([Vector3::repeat(1.0); 2])?;
    let mut angles: Vec<Vec<f64>> = Vec::new();
    let mut axes = vec![pointing(&nominal)];
    for _ in 0..STEPS / EVERY {
        stepper.run(&mut nominal, EVERY)?;
        axes.push(pointing(&nominal));
    }
    angles.resize(axes.len(), Vec::new());
    for shard in ensemble.shards(store)? {
        let rows = shard.map_err(|fault| fault.to_string())?.rows;
        for (row, step) in rows.step.iter().enumerate() {
            let time = usize::try_from(step / EVERY)?;
            let axis = Vector3::from([0, 1, 2].map(|column| rows.columns[column][row]));
            angles[time].push(axis.angle(&Vector3::from(axes[time])).to_degrees());
        }
    }
    #[allow(clippy::cast_precision_loss)] // steps
    let spread = angles.into_iter().enumerate().map(|(time, mut angles)| {
        angles.sort_by(f64::total_cmp);
        let quantile = |tenths: usize| angles.get((angles.len().max(1) - 1) * tenths / 10).copied().unwrap_or(f64::NAN);
        (time as f64 * EVERY as f64 * STEP, [1, 5, 9].map(quantile))
    });
    Ok(spread.collect())
}
