//! What schemes cost on tops that no scheme was chosen by.

use declarations::motions::End;
use liestep::laws::samples::Random;
use liestep::mechanics::Sum;
use liestep::methods::{ExactBody, ProcessedScheme};
use liestep::prelude::*;
use nalgebra::Vector3;

use accuracy_cost::scenes::error;
use workbench::args::Failure;
use workbench::measure::steps_in;

/// The errors that are asked for.
pub(crate) const LEVELS: [f64; 5] = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10];
/// How long each run is, s.
const TIME: f64 = 10.0;
/// What a kick costs, and a gradient, in drifts. A guess, that weighs schemes which have other numbers of them against
/// each other; those with the same kernel it doesn't compare otherwise.
const KICK: f64 = 0.17;

type Scene = Sum<liestep::effects::PrincipalBody, Gravity>;

/// An asymmetric top, thrown anyhow, and where it is after the time.
pub(crate) struct Top {
    scene: Scene,
    flow: ExactBody,
    attitude: SO3,
    velocity: Vector3<f64>,
    exact: End,
}

impl Top {
    /// So many, of the stream.
    pub(crate) fn drawn(random: &mut Random, count: usize) -> Result<Vec<Self>, Failure> {
        core::iter::repeat_with(|| Self::new(random)).take(count).collect()
    }

    fn new(random: &mut Random) -> Result<Self, Failure> {
        let nonstandard = Vector3::from_fn(|_, _| 0.7 + 0.5 * random.signed());
        let weight = 1.5 + random.signed();
        let gravity = Gravity { m: 1.0, g: weight, rho: random.sample::<Vector3<f64>>() * 0.8, up: Vector3::z() };
        let body = liestep::effects::PrincipalBody { J_d: DiagonalNonstandardInertia::from_diagonal(nonstandard)? };
        let inertia = liestep::NonstandardInertia::from(body.J_d).to_inertia();
        let scene = body + gravity;
        let (attitude, velocity) = (SO3::exp(random.sample()), random.sample::<Vector3<f64>>() * 3.0);
        // Of order 16 with steps that are so short that what is missed is rounding.
        let stepper = Stepper::collocated::<4>(scene, 0.02)?;
        let mut state = stepper.start(attitude, velocity)?;
        stepper.run(&mut state, steps_in(TIME, 0.02))?;
        let exact = (*state.attitude().as_matrix(), stepper.velocity(&state));
        Ok(Self { scene, flow: ExactBody::new(&inertia), attitude, velocity, exact })
    }

    /// What each accuracy costs, in drifts: the longest steps, of those that are tried, from which on all shorter ones
    /// reach it; nothing where 5000 steps don't.
    fn costs(&self, scheme: ProcessedScheme) -> [Option<f64>; 5] {
        let mut costs = [None; 5];
        let mut is_open = [true; 5];
        // From the shortest steps on, so that a lucky crossing doesn't count.
        for k in (0..56_i32).rev() {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small and positive
            let steps = (6.0 * 1.13_f64.powi(k)).round() as u64;
            let missed = self.missed(scheme, steps).unwrap_or(f64::INFINITY);
            for (level, (cost, is_open)) in LEVELS.iter().zip(costs.iter_mut().zip(&mut is_open)) {
                *is_open &= missed <= *level;
                if *is_open {
                    *cost = Some(drifts(&scheme, steps));
                }
            }
        }
        costs
    }

    fn missed(&self, scheme: ProcessedScheme, steps: u64) -> Option<f64> {
        #[allow(clippy::cast_precision_loss)] // thousands
        let stepper = Stepper::processed(self.scene, TIME / steps as f64, self.flow, scheme).ok()?;
        let mut state = stepper.start(self.attitude, self.velocity).ok()?;
        stepper.run(&mut state, steps).ok()?;
        Some(error(&(*state.attitude().as_matrix(), stepper.velocity(&state)), &self.exact))
    }
}

/// What a run costs, in drifts.
fn drifts(scheme: &ProcessedScheme, steps: u64) -> f64 {
    use liestep::methods::Flow;
    let cost = |(flow, share, gradient): (Flow, f64, f64)| match flow {
        Flow::Drift => f64::from(u8::from(share != 0.0)),
        Flow::Kick if gradient == 0.0 => KICK,
        Flow::Kick => 2.0 * KICK,
    };
    let kernel = scheme.kernel();
    // The last part of a step is one with the first of the next.
    let step: f64 = kernel.shares().zip(kernel.gradients()).skip(1).map(|((flow, a), g)| cost((flow, a, g))).sum();
    let ends: f64 = scheme.processor().map(cost).sum();
    #[allow(clippy::cast_precision_loss)] // thousands
    let steps = steps as f64;
    step * steps + 2.0 * ends
}

/// The geometric means over the tops of what each accuracy costs, where all reach it, in drifts.
pub(crate) fn means(tops: &[Top], scheme: ProcessedScheme) -> [Option<f64>; 5] {
    let all: Vec<_> = tops.iter().map(|top| top.costs(scheme)).collect();
    core::array::from_fn(|k| {
        let logarithms: Option<Vec<f64>> = all.iter().map(|costs| costs[k].map(f64::ln)).collect();
        #[allow(clippy::cast_precision_loss)] // some ten
        logarithms.map(|logarithms| (logarithms.iter().sum::<f64>() / logarithms.len() as f64).exp())
    })
}
