//! The stepper of a Hamiltonian: its own step, which needs no velocity to have a momentum, and compositions of it.

use std::sync::Arc;

use liestep::motion::{Cost, Layout, Propagator, StepReport};
use liestep::with::{Method, Scheme};
use liestep::{SetupError, StepError};
use liestep_derivation::Array;
use liestep_derivation::whole::HamiltonianStep;

use super::codes::layout;
use super::linear::are_finite;
use super::stepper::{WholeError, write_or_nan};
use crate::code::Backend;
use crate::declaration::{Declaration, Ready, ready_each};
use crate::error::LateError;

/// The code of a Hamiltonian's step.
#[derive(Debug)]
struct Equations<C> {
    code: HamiltonianStep<Ready<C>>,
    layout: Layout,
    /// The operations of an iteration, and of a step besides them.
    operations: [f64; 2],
}

/// The stepper of a Hamiltonian with numbers, a step and a method.
#[derive(Debug)]
pub(super) struct Hamiltonian<B: Backend<f64>> {
    equations: Arc<Equations<B::Code>>,
    numbers: Arc<[f64]>,
    h: f64,
    /// The parts of a step.
    parts: Vec<f64>,
}

/// The limit of iterations, of which a step of reasonable length takes some fifteen.
const MOST_ITERATIONS: u32 = 100;
/// The square of a relative change that is rounding, and the one below which a change that grows is.
const ROUNDING: f64 = f64::EPSILON * f64::EPSILON;
const NEAR_ROUNDING: f64 = ROUNDING * 1e6;

impl<B: Backend<f64>> Hamiltonian<B>
where
    B::Code: Send + Sync + 'static,
{
    /// The stepper of a declaration with the numbers of all parameters and the step `h`, s.
    pub(super) fn of(
        declaration: &'static Declaration,
        numbers: &[f64],
        h: f64,
        method: Method,
    ) -> Result<Self, WholeError> {
        let (expected, found) = (declaration.count(), numbers.len());
        if expected != found {
            return Err(LateError::Size { name: declaration.name.clone(), expected, found }.into());
        }
        let parts = match method.scheme {
            Scheme::Step if method == Method::default() => vec![1.0],
            Scheme::Composition(scheme) if method == Method::from(method.scheme) => scheme.stages().collect(),
            _ => {
                let cause = "of a Hamiltonian is its step, or a composition of it; leave the others out";
                return Err(WholeError::Setup(SetupError::Method { cause }));
            }
        };
        declaration.check(numbers)?;
        if !(h.is_finite() && (h == 0.0 || (1.0 / h).is_finite())) {
            return Err(WholeError::Setup(SetupError::InvalidStep { step: h }));
        }
        Ok(Self { equations: Self::equations(declaration)?, numbers: numbers.into(), h, parts })
    }

    /// The code of a declaration, written and prepared once.
    fn equations(declaration: &'static Declaration) -> Result<Arc<Equations<B::Code>>, LateError> {
        declaration.once(|| {
            let (programs, factors) = HamiltonianStep::of(declaration).map_err(LateError::Step)?;
            let carried = declaration.carried.iter().map(|one| one.shape.0 * one.shape.1).sum();
            let all = ready_each::<B>(&programs.all())?.try_into().map_err(|_| LateError::TooLarge)?;
            let count = |at: usize| u32::try_from(programs.all()[at].operations.len()).map_or(f64::INFINITY, f64::from);
            let operations = [count(0), count(1)];
            Ok(Equations { code: HamiltonianStep::from_all(all), layout: layout(carried, 0, &factors), operations })
        })
    }

    /// Names, units and places of the states.
    pub(super) fn layout_of(declaration: &'static Declaration) -> Result<Layout, LateError> {
        Ok(Self::equations(declaration)?.layout.clone())
    }

    fn run_on<const K: usize>(&self, program: &Ready<B::Code>, given: [(Array, &[f64]); K]) -> Vec<f64> {
        let mut outputs = vec![0.0; program.outputs];
        let mut all = given.to_vec();
        all.push((Array::Parameters, &self.numbers));
        // Back ends take arrays of a known length.
        match all[..] {
            [a, b] => B::run(&program.code, &[], [a, b], &mut outputs),
            [a, b, c] => B::run(&program.code, &[], [a, b, c], &mut outputs),
            [a, b, c, d, e, f] => B::run(&program.code, &[], [a, b, c, d, e, f], &mut outputs),
            _ => outputs.fill(f64::NAN),
        }
        outputs
    }

    /// The state at this attitude and momentum.
    fn begun(&self, attitude: &[f64], momentum: &[f64]) -> Box<[f64]> {
        let layout = &self.equations.layout;
        let mut state = vec![0.0; layout.state()].into_boxed_slice();
        state[layout.attitude()].copy_from_slice(attitude);
        state[layout.momentum()].copy_from_slice(momentum);
        let seen = self.run_on(&self.equations.code.seen, [(Array::Attitude, attitude)]);
        state[layout.advected()].copy_from_slice(&seen);
        state
    }

    fn velocity_of(&self, momentum: &[f64], advected: &[f64]) -> Vec<f64> {
        self.run_on(&self.equations.code.velocity, [(Array::Velocity, momentum), (Array::Advected, advected)])
    }

    /// Advances attitude, momentum and advected parameters by a step of this length; returns the iterations.
    fn advance(&self, h: f64, state: &mut [f64]) -> Result<u32, StepError> {
        let Equations { code, layout, .. } = &*self.equations;
        let n = layout.components();
        let (momentum, advected) = (state[layout.momentum()].to_vec(), state[layout.advected()].to_vec());
        let mut half: Vec<f64> = self.velocity_of(&momentum, &advected).iter().map(|xi| xi * (h * 0.5)).collect();
        let (mut within, mut before) = (momentum.clone(), f64::INFINITY);
        let step = [h];
        let mut iterations = 0;
        loop {
            iterations += 1;
            let made = self.run_on(
                &code.iterate,
                [
                    (Array::Half, &half),
                    (Array::Velocity, &within),
                    (Array::Momentum, &momentum),
                    (Array::Advected, &advected),
                    (Array::Step, &step),
                ],
            );
            half.copy_from_slice(&made[..n]);
            within.copy_from_slice(&made[n..2 * n]);
            let share = |change: f64, size: f64| if change == 0.0 { 0.0 } else { change / size };
            let change = share(made[2 * n], made[2 * n + 1]).max(share(made[2 * n + 2], made[2 * n + 3]));
            // NaN is no convergence.
            if change <= ROUNDING || change < NEAR_ROUNDING && change >= before {
                break;
            }
            if iterations == MOST_ITERATIONS || !change.is_finite() {
                return Err(StepError::NotConverged { iterations, residual: change.sqrt() });
            }
            before = change;
        }
        let attitude = state[layout.attitude()].to_vec();
        let end = self.finished([&half, &within, &momentum, &advected, &attitude], h);
        if !are_finite(&end) {
            return Err(StepError::NonFinite { what: "momentum after the step" });
        }
        state[..end.len()].copy_from_slice(&end);
        Ok(iterations)
    }

    fn finished(&self, [half, within, momentum, advected, attitude]: [&[f64]; 5], h: f64) -> Vec<f64> {
        let program = &self.equations.code.finish;
        let mut outputs = vec![0.0; program.outputs];
        let given = [
            (Array::Half, half),
            (Array::Velocity, within),
            (Array::Momentum, momentum),
            (Array::Advected, advected),
            (Array::Attitude, attitude),
            (Array::Step, &[h][..]),
            (Array::Parameters, &self.numbers),
        ];
        B::run(&program.code, &[], given, &mut outputs);
        outputs
    }

    /// The numbers of an attitude and of a momentum in a state of another layout that begins as this one does.
    fn moving<'a>(&self, state: &'a [f64]) -> Option<[&'a [f64]; 2]> {
        let layout = &self.equations.layout;
        Some([state.get(layout.attitude())?, state.get(layout.momentum())?])
    }
}

impl<B: Backend<f64>> Propagator for Hamiltonian<B>
where
    B::Code: Send + Sync + 'static,
{
    fn layout(&self) -> &Layout {
        &self.equations.layout
    }

    /// A velocity needn't have a momentum, so that a start has a momentum: at rest it is zero.
    fn start(&self, attitude: &[f64], velocity: &[f64]) -> Result<Box<[f64]>, SetupError> {
        let layout = &self.equations.layout;
        SetupError::check_length("attitude", attitude.len(), layout.entries())?;
        SetupError::check_length("velocity", velocity.len(), layout.components())?;
        if velocity.iter().any(|component| *component != 0.0) {
            let cause =
                "of a Hamiltonian starts with a momentum, as no momentum may have this velocity; give a `momentum`";
            return Err(SetupError::Method { cause });
        }
        let defect = self.run_on(&self.equations.code.defect, [(Array::Attitude, attitude)])[0];
        // Twelve printed digits pass, as in other steppers; NaN fails.
        let is_in_group = defect <= f64::EPSILON * 1e4;
        if !is_in_group {
            return Err(SetupError::NotInGroup { defect });
        }
        Ok(self.begun(attitude, velocity))
    }

    fn step(&self, state: &mut [f64]) -> Result<StepReport, StepError> {
        let (mut next, mut iterations) = (self.equations.layout.checked(state)?.to_vec(), 0);
        for part in &self.parts {
            iterations += self.advance(self.h * part, &mut next)?;
        }
        let last = next.len() - 1;
        next[last] += 1.0;
        state.copy_from_slice(&next);
        Ok(StepReport::of(iterations))
    }

    fn part(&self, state: &[f64], fraction: f64) -> Result<Box<[f64]>, StepError> {
        let mut next: Box<[f64]> = self.equations.layout.checked(state)?.into();
        for part in &self.parts {
            self.advance(self.h * fraction * part, &mut next)?;
        }
        Ok(next)
    }

    fn adopt(&self, state: &[f64]) -> Box<[f64]> {
        match self.moving(state) {
            Some([attitude, momentum]) => self.begun(attitude, momentum),
            None => vec![f64::NAN; self.equations.layout.state()].into(),
        }
    }

    fn cost(&self) -> Option<Cost> {
        let parts = u32::try_from(self.parts.len()).unwrap_or(u32::MAX);
        let [iteration, step] = self.equations.operations;
        Some(Cost { step: f64::from(parts) * step, iteration, fewest: parts.saturating_mul(3), once: 0.0 })
    }

    fn step_size(&self) -> f64 {
        self.h
    }

    fn velocity(&self, state: &[f64], velocity: &mut [f64]) {
        let layout = &self.equations.layout;
        let found = self
            .equations
            .layout
            .checked(state)
            .map(|state| self.velocity_of(&state[layout.momentum()], &state[layout.advected()]));
        write_or_nan(found.ok(), velocity);
    }

    fn energy(&self, state: &[f64]) -> f64 {
        let Equations { code, layout, .. } = &*self.equations;
        self.equations.layout.checked(state).map_or(f64::NAN, |state| {
            let given = [(Array::Velocity, &state[layout.momentum()]), (Array::Advected, &state[layout.advected()])];
            self.run_on(&code.energy, given)[0]
        })
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]) {
        let Equations { code, layout, .. } = &*self.equations;
        let found = self.equations.layout.checked(state).map(|state| {
            let given = [(Array::Attitude, &state[layout.attitude()]), (Array::Momentum, &state[layout.momentum()])];
            self.run_on(&code.spatial, given)
        });
        write_or_nan(found.ok(), momentum);
    }

    fn defect(&self, state: &[f64]) -> f64 {
        let Equations { code, layout, .. } = &*self.equations;
        self.equations
            .layout
            .checked(state)
            .map_or(f64::NAN, |state| self.run_on(&code.defect, [(Array::Attitude, &state[layout.attitude()])])[0])
    }
}
