//! Gauss collocation of a declaration's continuous limit on any group that linear and quadratic relations define.
//!
//! Attitude and conjugate momentum are integrated on the cotangent bundle of all matrices, with the equations, the
//! coefficients and the convergence test of [`CotangentGauss`](liestep::methods::CotangentGauss).

use std::sync::Arc;

use liestep::__private::{Changes, Coefficients, Next, two_sum};
use liestep::motion::{Cost, Layout, Propagator, StepReport};
use liestep::with::{self, Method};
use liestep::{SetupError, StepError};
use liestep_derivation::Array;
use liestep_derivation::whole::Canonical;

use super::linear::are_finite;
use super::stepper::{Whole, WholeError};
use crate::code::Backend;
use crate::declaration::{Declaration, Ready, ready_each};
use crate::error::LateError;

/// The code of the canonical equations.
#[derive(Debug)]
struct Equations<C> {
    lifted: Ready<C>,
    momentum: Ready<C>,
    seen: Ready<C>,
    rates: Ready<C>,
    /// The operations of all rates.
    operations: usize,
}

impl<C: Send + Sync + 'static> Equations<C> {
    fn of<B: Backend<f64, Code = C>>(declaration: &'static Declaration) -> Result<Arc<Self>, LateError> {
        declaration.once(|| {
            let programs = Canonical::of(declaration).map_err(LateError::Step)?;
            let operations = programs.all()[1..].iter().map(|program| program.operations.len()).sum();
            let all = ready_each::<B>(&programs.all())?;
            let [lifted, momentum, seen, rates] = all.try_into().map_err(|_| LateError::TooLarge)?;
            Ok(Self { lifted, momentum, seen, rates, operations })
        })
    }
}

/// The coefficients of a collocation as lists.
#[derive(Clone, Debug)]
struct Table {
    /// The weight of each stage.
    weights: Vec<f64>,
    /// The matrix `1/2 + σ` of the stages, row by row.
    places: Vec<f64>,
}

impl Table {
    fn of(stages: with::Stages) -> Self {
        match stages {
            with::Stages::Four => Self::listed(&Coefficients::<2>::gauss()),
            with::Stages::Eight => Self::listed(&Coefficients::<4>::gauss()),
        }
    }

    fn listed<const PAIRS: usize>(coefficients: &Coefficients<PAIRS>) -> Self {
        let columns = coefficients.places.as_flattened();
        let rows = (0..2 * PAIRS).flat_map(|row| columns.iter().map(move |column| column.as_flattened()[row]));
        Self { weights: [coefficients.weights; 2].concat(), places: rows.collect() }
    }
}

/// The stepper of a declaration by Gauss collocation. The memory of a state has the rounding errors of the sums of attitude
/// and momentum.
#[derive(Debug)]
pub(super) struct Collocation<B: Backend<f64>> {
    whole: Whole<B>,
    equations: Arc<Equations<B::Code>>,
    table: Table,
    layout: Layout,
}

/// The changes of attitude and momentum in a step.
struct Change {
    attitude: Vec<f64>,
    momentum: Vec<f64>,
    iterations: u32,
}

/// A declaration with a force has no Lagrangian for a limit.
const WITH_A_FORCE: SetupError =
    SetupError::Method { cause: "needs a scene without a force; leave the method out, or the force" };

impl<B: Backend<f64>> Collocation<B>
where
    B::Code: Send + Sync + 'static,
{
    /// The collocation of a declaration with the numbers of all parameters and the step `h`, s.
    pub(super) fn of(
        declaration: &'static Declaration,
        numbers: &[f64],
        h: f64,
        stages: with::Stages,
    ) -> Result<Self, WholeError> {
        if declaration.has_force {
            return Err(WITH_A_FORCE.into());
        }
        let whole = Whole::of(declaration, numbers, h, Method::default())?;
        let equations = Equations::of::<B>(declaration)?;
        let sizes = &whole.codes.sizes;
        let layout = Layout { memory: sizes.entries + sizes.n, ..whole.layout().clone() };
        Ok(Self { whole, equations, table: Table::of(stages), layout })
    }

    /// The outputs of one of the equations at an attitude and a conjugate momentum.
    fn at(&self, program: &Ready<B::Code>, place: &[f64], velocity: &[f64]) -> Vec<f64> {
        let (attitude, conjugate) = place.split_at(self.whole.codes.sizes.entries);
        let given = [
            (Array::Attitude, attitude),
            (Array::History, conjugate),
            (Array::Velocity, velocity),
            (Array::Parameters, self.whole.numbers()),
        ];
        let mut outputs = vec![0.0; program.outputs];
        B::run(&program.code, &[], given, &mut outputs);
        outputs
    }

    /// The rates of attitude and conjugate momentum.
    fn rates(&self, place: &[f64]) -> Vec<f64> {
        let (momentum, advected) =
            (self.at(&self.equations.momentum, place, &[]), self.at(&self.equations.seen, place, &[]));
        let velocity = self.whole.numbered().limit(&advected).velocity(&momentum);
        self.at(&self.equations.rates, place, &velocity)
    }

    /// The changes of a step `h`.
    fn change(&self, h: f64, attitude: &[f64], momentum: &[f64]) -> Result<Change, StepError> {
        let (entries, lifted) = (attitude.len(), &self.equations.lifted);
        let mut conjugate = vec![0.0; lifted.outputs];
        B::run(&lifted.code, &[], [(Array::Attitude, attitude), (Array::Momentum, momentum)], &mut conjugate);
        let start = [attitude, &conjugate].concat();
        let rates = self.rates(&start);
        let weighted = |rates: &[f64], weight: f64| rates.iter().map(|rate| rate * (h * weight)).collect::<Vec<f64>>();
        let mut stages: Vec<Vec<f64>> = self.table.weights.iter().map(|&weight| weighted(&rates, weight)).collect();
        let (mut changes, mut last, mut is_settled) = (Changes::none(), false, false);
        let (mut residual, mut iterations) = (f64::INFINITY, 0);
        while !is_settled {
            if iterations == Changes::MOST {
                return Err(StepError::NotConverged { iterations, residual });
            }
            iterations += 1;
            let rows = self.table.places.chunks(stages.len()).zip(&self.table.weights);
            let next: Vec<Vec<f64>> = rows
                .map(|(row, &weight)| {
                    let change = combined(row.iter().copied().zip(&stages), start.len());
                    let place: Vec<f64> = start.iter().zip(change).map(|(start, change)| start + change).collect();
                    weighted(&self.rates(&place), weight)
                })
                .collect();
            let [of_attitude, of_momentum] = relative_changes(&start, (&stages, &next), entries);
            let change = of_attitude + of_momentum;
            residual = change.sqrt();
            if !change.is_finite() {
                return Err(StepError::NotConverged { iterations, residual });
            }
            stages = next;
            let judged = changes.judge(change, of_attitude);
            is_settled = last || judged == Next::Nothing;
            last = judged == Next::Once;
        }
        let change = combined(stages.iter().map(|stage| (1.0, stage)), start.len());
        // Differences stay small without cancellation: (g + Δg)ᵀ(p + Δp) − gᵀp = (g + Δg)ᵀΔp + Δgᵀp.
        let (attitude, of_conjugate) = change.split_at(entries);
        let moved: Vec<f64> = start.iter().zip(attitude).map(|(g, change)| g + change).collect();
        let paired = |g: &[f64], p: &[f64]| self.at(&self.equations.momentum, &[g, p].concat(), &[]);
        let both = paired(&moved, of_conjugate).into_iter().zip(paired(attitude, &conjugate));
        let momentum = both.map(|(a, b)| a + b).collect();
        Ok(Change { attitude: attitude.to_vec(), momentum, iterations })
    }

    /// One step `h` of a state of the right length, which isn't counted. After an error the state is as it was.
    fn advance(&self, h: f64, state: &mut [f64]) -> Result<u32, StepError> {
        let (moving, memory) = (self.layout.momentum().end, self.layout.memory());
        let sizes = &self.whole.codes.sizes;
        let Change { attitude, momentum, iterations } =
            self.change(h, &state[..sizes.entries], &state[self.layout.momentum()])?;
        let mut next = state.to_vec();
        for (at, change) in attitude.iter().chain(&momentum).enumerate() {
            let carry = memory.start + at;
            (next[at], next[carry]) = two_sum(state[at], change + state[carry]);
        }
        if !are_finite(&next[..moving]) {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        self.whole.see(&mut next);
        state.copy_from_slice(&next);
        Ok(iterations)
    }

    /// The state of a whole step at this motion, whose memory isn't read.
    fn of_whole(&self, state: &[f64]) -> Option<Vec<f64>> {
        let moving = &self.layout.checked(state).ok()?[..self.layout.advected().end];
        let mut whole = vec![0.0; self.whole.layout().state()];
        whole[..moving.len()].copy_from_slice(moving);
        Some(whole)
    }

    /// The initial state at the motion of a whole step's.
    fn begun(&self, whole: &[f64]) -> Box<[f64]> {
        let mut state = vec![0.0; self.layout.state()];
        let moving = self.layout.advected().end;
        state[..moving].copy_from_slice(&whole[..moving]);
        state.into()
    }
}

impl<B: Backend<f64>> Propagator for Collocation<B>
where
    B::Code: Send + Sync + 'static,
{
    fn layout(&self) -> &Layout {
        &self.layout
    }

    fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError> {
        self.whole.start(attitude, velocity).map(|state| self.begun(&state))
    }

    fn step(&self, state: &mut [f64]) -> Result<StepReport, StepError> {
        self.layout.checked(state)?;
        let iterations = self.advance(self.whole.step_size(), state)?;
        let last = state.len() - 1;
        state[last] += 1.0;
        Ok(StepReport::of(iterations))
    }

    fn part(&self, state: &[f64], fraction: f64) -> Result<Box<[f64]>, StepError> {
        let mut next: Box<[f64]> = self.layout.checked(state)?.into();
        self.advance(self.whole.step_size() * fraction, &mut next)?;
        next[self.layout.memory()].fill(0.0);
        Ok(next)
    }

    fn adopt(&self, state: &[f64]) -> Box<[f64]> {
        let moving = self.layout.momentum().end;
        match state.get(..moving) {
            Some(moving) => self.begun(&self.whole.adopt(moving)),
            None => vec![f64::NAN; self.layout.state()].into(),
        }
    }

    fn cost(&self) -> Option<Cost> {
        let operations = u32::try_from(self.equations.operations * self.table.weights.len()).unwrap_or(u32::MAX);
        Some(Cost { step: 0.0, iteration: operations.into(), fewest: 3, once: 0.0 })
    }

    fn step_size(&self) -> f64 {
        self.whole.step_size()
    }

    fn velocity(&self, state: &[f64], velocity: &mut [f64]) {
        self.whole.velocity(&self.of_whole(state).unwrap_or_default(), velocity);
    }

    fn energy(&self, state: &[f64]) -> f64 {
        self.whole.energy(&self.of_whole(state).unwrap_or_default())
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]) {
        self.whole.spatial_momentum(&self.of_whole(state).unwrap_or_default(), momentum);
    }

    fn defect(&self, state: &[f64]) -> f64 {
        self.whole.defect(&self.of_whole(state).unwrap_or_default())
    }
}

/// The sum `Σ c L` of phase-space points.
fn combined<'a>(terms: impl Iterator<Item = (f64, &'a Vec<f64>)>, length: usize) -> Vec<f64> {
    let mut sum = vec![0.0; length];
    for (factor, term) in terms {
        sum.iter_mut().zip(term).for_each(|(sum, entry)| *sum += entry * factor);
    }
    sum
}

/// Squared changes between two iterates of attitude and of conjugate momentum, relative to the phase-space point.
fn relative_changes(place: &[f64], (before, after): (&[Vec<f64>], &[Vec<f64>]), entries: usize) -> [f64; 2] {
    let square = |numbers: &[f64]| numbers.iter().map(|number| number * number).sum::<f64>();
    [0..entries, entries..place.len()].map(|part| {
        let difference = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        let pairs = before.iter().zip(after);
        let change: f64 = pairs.map(|(a, b)| difference(&a[part.clone()], &b[part.clone()])).sum();
        let size = square(&place[part.clone()]) + after.iter().map(|stage| square(&stage[part.clone()])).sum::<f64>();
        if change == 0.0 { 0.0 } else { change / size }
    })
}
