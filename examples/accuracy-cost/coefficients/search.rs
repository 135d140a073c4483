//! Solutions from random starts, by Levenberg's and Marquardt's method.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use liestep::laws::samples::Random;
use nalgebra_of_levenberg_marquardt as lm;
use workbench::progress::Progress;

use crate::problem::{Problem, Wanted};

/// A solution.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    pub(crate) unknowns: Vec<f64>,
    /// The norm of the error of the next order.
    pub(crate) left: f64,
}

/// What is made small: what the order asks for, so many times over, and the error of the next order.
struct Weighted<'a> {
    problem: &'a Problem,
    weights: [f64; 2],
    at: Vec<f64>,
    /// The unknowns from this on are varied.
    first: usize,
}

impl Weighted<'_> {
    fn missed(&self, at: &[f64]) -> lm::DVector<f64> {
        let (within, next) = self.problem.missed(at);
        let next = if self.weights[1] == 0.0 { &[] } else { next.as_slice() };
        let weighted = within.iter().map(|x| x * self.weights[0]).chain(next.iter().map(|x| x * self.weights[1]));
        let mut rows: Vec<f64> = weighted.collect();
        // The method asks for as many rows as unknowns.
        rows.resize(rows.len().max(at.len()), 0.0);
        lm::DVector::from_vec(rows)
    }
}

impl LeastSquaresProblem<f64, lm::Dyn, lm::Dyn> for Weighted<'_> {
    type ResidualStorage = lm::VecStorage<f64, lm::Dyn, lm::U1>;
    type JacobianStorage = lm::VecStorage<f64, lm::Dyn, lm::Dyn>;
    type ParameterStorage = lm::VecStorage<f64, lm::Dyn, lm::U1>;

    fn set_params(&mut self, at: &lm::DVector<f64>) {
        self.at[self.first..].copy_from_slice(at.as_slice());
    }

    fn params(&self) -> lm::DVector<f64> {
        lm::DVector::from_column_slice(&self.at[self.first..])
    }

    fn residuals(&self) -> Option<lm::DVector<f64>> {
        Some(self.missed(&self.at))
    }

    fn jacobian(&self) -> Option<lm::DMatrix<f64>> {
        let columns: Vec<_> = (self.first..self.at.len())
            .map(|k| {
                let moved = |change: f64| {
                    let mut at = self.at.clone();
                    at[k] += change;
                    self.missed(&at)
                };
                (moved(1e-6) - moved(-1e-6)) / 2e-6
            })
            .collect();
        Some(lm::DMatrix::from_columns(&columns))
    }
}

/// The solution of the order's equations that the method comes to from a start; nothing where it comes to none.
pub(crate) fn solved(problem: &Problem, start: &[f64]) -> Option<Found> {
    // First what a processor makes good, so that the shares aren't changed for that.
    let at = made_good(problem, start);
    let unknowns = minimized(Weighted { problem, weights: EXACT, at, first: 0 });
    let (within, next) = problem.missed(&unknowns);
    // Rounding of sums of some hundred words.
    (within.norm() < 1e-12).then(|| Found { unknowns, left: next.norm() })
}

/// Of the solutions about this one the one with the least error of the next order.
fn least(problem: &Problem, found: Found) -> Option<Found> {
    let at = [30.0, 1e3, 3e4]
        .iter()
        .fold(found.unknowns, |at, within| minimized(Weighted { problem, weights: [*within, 1.0], at, first: 0 }));
    solved(problem, &at)
}

/// With the same shares, what a processor makes good of a kernel's error.
pub(crate) fn made_good(problem: &Problem, start: &[f64]) -> Vec<f64> {
    let (at, first) = (start.to_vec(), problem.shares());
    if first == at.len() { at } else { minimized(Weighted { problem, weights: EXACT, at, first }) }
}

/// Nothing but what the order asks for.
const EXACT: [f64; 2] = [1.0, 0.0];

fn minimized(weighted: Weighted<'_>) -> Vec<f64> {
    LevenbergMarquardt::new().with_patience(40).minimize(weighted).0.at
}

/// The best solutions from so many random starts, the one with the least left first. Coefficients above the largest aren't
/// taken: rounding would grow with them.
pub(crate) fn best(problem: &Problem, random: &mut Random, starts: u64, keep: usize) -> Vec<Found> {
    let mut progress = Progress::new(starts);
    let mut best: Vec<Found> = Vec::new();
    for _ in 0..starts {
        progress.add(1, &format!("{} found", best.len()));
        let found = solved(problem, &start(problem, random)).and_then(|found| least(problem, found));
        let Some(found) = found else { continue };
        let largest = found.unknowns[..problem.shares()].iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let is_known = best.iter().any(|other| (other.left - found.left).abs() < 1e-4 * found.left);
        if largest > LARGEST || is_known {
            continue;
        }
        best.push(found);
        best.sort_by(|a, b| a.left.total_cmp(&b.left));
        best.truncate(keep);
    }
    best
}

const LARGEST: f64 = 1.3;

/// Shares about those of equal parts for a kernel, about none for a processor.
fn start(problem: &Problem, random: &mut Random) -> Vec<f64> {
    let width = 0.25 + 0.15 * random.signed();
    let gradient = 0.013 + 0.01 * random.signed();
    match &problem.wanted {
        Wanted::Kernel(form) => (0..problem.unknowns())
            .map(|k| {
                if k < form.half {
                    #[allow(clippy::cast_precision_loss)] // a few
                    let equal = 1.0 / form.half as f64;
                    equal + width * random.normal()
                } else if k < form.half + form.gradients.len() {
                    gradient * (1.0 + random.normal())
                } else {
                    0.1 * random.normal()
                }
            })
            .collect(),
        Wanted::Processor { kick_first, .. } => {
            let first = usize::from(*kick_first);
            (first..problem.unknowns() + first)
                .map(|k| random.normal() * if k % 3 == 2 { gradient } else { width })
                .collect()
        }
    }
}
