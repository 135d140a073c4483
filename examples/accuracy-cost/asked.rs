//! The automatic choice for an accuracy, compared with the best of all fixed methods.

use std::time::Duration;

use liestep::accuracy::{Accuracy, AccuracyError, AccurateStepper};
use liestep::{SO3, Stepper, mechanics};
use liestep_refinement::Effort;
use workbench::table::{aligned, number};

use crate::measure::ladder;
use crate::methods::{self, PreparedRun};
use crate::report::microseconds;
use crate::scenes::{Kind, Scene, error};

/// The requested tolerances.
const TOLERANCES: [f64; 3] = [1e-3, 1e-6, 1e-9];

/// The table, and whether all choices are within their tolerance and twice the best time.
pub fn compare(scenes: &[Scene], effort: impl Fn(f64) -> (Effort, f64)) -> String {
    let heading = ["scene", "t, s", "asked", "chosen", "step, s", "error", "µs", "best fixed", "µs", "ratio", "trials"];
    let mut rows = vec![heading.map(str::to_owned).to_vec()];
    for t in [10.0, 100.0] {
        for scene in scenes {
            add(&mut rows, scene, t, effort(t));
        }
    }
    aligned(&rows)
}

/// A choice for an accuracy.
type Ask = dyn Fn(Accuracy) -> Result<Answer, AccuracyError>;

/// A chosen method, ready to run.
struct Answer {
    name: String,
    step: f64,
    trials: f64,
    run: PreparedRun,
}

impl Answer {
    fn new<A>(stepper: AccurateStepper<SO3, A>) -> Self
    where
        A: liestep::groups::Advected<SO3> + 'static,
    {
        let choice = stepper.choice();
        let (name, step, trials) = (choice.chosen().scheme.to_string(), choice.chosen().step, choice.trials);
        let run = Box::new(move || {
            let mut state = stepper.start();
            stepper.run(&mut state).ok()?;
            Some((*state.attitude().as_matrix(), stepper.velocity(&state)))
        });
        Self { name, step, trials, run }
    }
}

/// The function that chooses a method for a scene.
fn question(scene: &Scene) -> Box<Ask> {
    match scene.kind {
        Kind::Sprung => asking(scene, scene.sprung()),
        Kind::Satellite => asking(scene, scene.satellite()),
        Kind::Free => asking(scene, scene.free_body()),
        Kind::Top | Kind::SymmetricTop => asking(scene, scene.top()),
    }
}

fn asking<S>(scene: &Scene, body: S) -> Box<Ask>
where
    S: mechanics::Scene<Scalar = f64, Group = SO3>,
{
    let (attitude, velocity) = (scene.motion.attitude, scene.motion.velocity);
    Box::new(move |accuracy| Stepper::for_accuracy(body.clone(), accuracy, attitude, velocity).map(Answer::new))
}

fn add(rows: &mut Vec<Vec<String>>, scene: &Scene, t: f64, effort: (Effort, f64)) {
    let Some(exact) = scene.reference(t) else { return };
    let fixed = methods::ours(scene);
    let runs: Vec<_> = fixed.iter().map(|method| (method, ladder(method, scene, t, effort))).collect();
    let question = question(scene);
    for tolerance in TOLERANCES {
        let mut row = vec![scene.name.to_owned(), t.to_string(), format!("{tolerance:.0e}")];
        match question(Accuracy { tolerance, horizon: t }) {
            Ok(answer) => {
                let best = runs
                    .iter()
                    .filter_map(|(method, runs)| Some((method.name.as_str(), runs.seconds_to(tolerance)?)))
                    .min_by(|a, b| a.1.total_cmp(&b.1));
                let repeated = effort.0.repeated.max(Duration::from_millis(5));
                let Ok((end, cost)) = (Effort { repeated, ..effort.0 }).time(|| (answer.run)().ok_or(())) else {
                    rows.push(row.into_iter().chain([answer.name, "a step failed".to_owned()]).collect());
                    continue;
                };
                row.extend([answer.name.clone(), number(answer.step), number(error(&end, exact)), microseconds(cost)]);
                row.extend(best.map_or_else(
                    || vec!["–".to_owned(); 3],
                    |(name, least)| vec![name.to_owned(), microseconds(least), format!("{:.2}", cost / least)],
                ));
                row.push(format!("{:.1}", answer.trials));
            }
            Err(AccuracyError::Unreachable { floor, .. }) => {
                row.push(format!("only {floor:.0e} can be reached"));
            }
            Err(refusal) => row.push(refusal.to_string()),
        }
        rows.push(row);
    }
}
