//! What a million steps leave of the energy, of the vertical momentum and of the attitude's orthogonality.
//!
//! Each method makes as many steps, of the length with which it reached `ERROR` after ten seconds.

use declarations::motions::End;
use nalgebra::Matrix3;
use workbench::table::{aligned, number};

use crate::methods::{Family, Method};
use crate::report::Measured;
use crate::scenes::Scene;

/// The error that sets the step.
const ERROR: f64 = 1e-4;

/// Deviations after a number of steps.
#[derive(Clone, Copy)]
pub struct Lost {
    pub steps: f64,
    /// Relative to the kinetic energy at the start.
    pub energy: f64,
    /// Of `e₃·RJΩ`, relative to the momentum's size at the start.
    pub vertical: f64,
    /// `‖RᵀR − I‖`, Frobenius.
    pub orthogonality: f64,
}

/// A method, its step in s, and what it lost after ever more steps; of one that failed, after those that it made.
pub struct Kept {
    pub name: String,
    pub family: Family,
    /// None where no step reached the error that sets it.
    step: Option<f64>,
    /// The number of steps that it should have made and didn't.
    failed: Option<f64>,
    pub lost: Vec<Lost>,
}

/// Runs those methods that a user would choose among: the first declared one, the cheapest of each family, and the
/// rivals with steps of equal length.
pub fn kept(scene: &Scene, methods: &[Method], measured: &[Measured], most: u32) -> Vec<Kept> {
    let cheapest = [Family::Poisson, Family::NearlyPoisson].map(|family| {
        let costs = measured.iter().enumerate().filter(|(_, method)| method.family == family);
        let costs = costs.filter_map(|(i, method)| Some((i, method.cost(ERROR)?)));
        costs.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
    });
    let chosen = methods.iter().enumerate().filter(|(i, method)| {
        let rival = method.family == Family::Rival && method.steps_are_equal();
        *i == 0 || rival || cheapest.contains(&Some(*i))
    });
    chosen
        .map(|(i, method)| {
            let step = measured[i].runs.longest_step_to(ERROR);
            let (mut losses, mut failed) = (Vec::new(), None);
            for steps in decades(most) {
                let run = step.and_then(|step| (method.prepare)(scene, steps * step, step));
                let Some(end) = run.and_then(|run| run()) else {
                    failed = Some(steps);
                    break;
                };
                losses.push(lost(scene, steps, &end));
            }
            Kept { name: method.name.clone(), family: method.family, step, failed, lost: losses }
        })
        .collect()
}

/// Ten, then twice or more and five times or more as many, up to the most.
fn decades(most: u32) -> impl Iterator<Item = f64> {
    (1..=6)
        .flat_map(|power| [1, 2, 5].map(|digit| digit * 10_u32.pow(power)))
        .filter(move |n| *n <= most)
        .map(f64::from)
}

fn lost(scene: &Scene, steps: f64, (attitude, velocity): &End) -> Lost {
    let momentum = scene.moments.component_mul(velocity);
    let start = scene.moments.component_mul(&scene.velocity);
    let kinetic = 0.5 * start.dot(&scene.velocity);
    let potential = |attitude: &Matrix3<f64>| scene.weight * (attitude * scene.rho).z;
    let energy = 0.5 * momentum.dot(velocity) - kinetic + potential(attitude) - potential(&scene.attitude);
    Lost {
        steps,
        energy: (energy / kinetic).abs(),
        vertical: ((attitude * momentum - scene.attitude * start).z / start.norm()).abs(),
        orthogonality: (attitude.transpose() * attitude - Matrix3::identity()).norm(),
    }
}

/// What the methods lost in all their steps.
pub fn table(methods: &[Kept]) -> String {
    let steps = methods.iter().filter_map(|kept| kept.lost.last()).map(|lost| lost.steps).fold(0.0, f64::max);
    let heading = [&format!("after {steps:.0e} steps"), "h, s", "energy", "vertical momentum", "‖RᵀR − I‖"];
    let mut rows = vec![heading.map(str::to_owned).to_vec()];
    for Kept { name, step, failed, lost, .. } in methods {
        let mut row = vec![name.clone()];
        match (step, failed, lost.last()) {
            (None, ..) => row.push(format!("no step reaches {ERROR:.0e}")),
            (Some(step), Some(steps), _) => row.extend([number(*step), format!("a step of {steps:.0e} failed")]),
            (Some(step), None, last) => {
                let lost = last.map(|last| [last.energy, last.vertical, last.orthogonality].map(number));
                row.push(number(*step));
                row.extend(lost.into_iter().flatten());
            }
        }
        rows.push(row);
    }
    aligned(&rows)
}
