//! Derivatives of a scalar, carried back through a step and through all that a motion is read by.

use std::sync::Arc;

use liestep_derivation::whole::{WholeStep, pulled_back};
use liestep_derivation::{Array, Program};

use super::codes::{Codes, rare};
use super::limit::Limit;
use super::linear::solution;
use crate::code::Backend;
use crate::declaration::{Declaration, Ready, ready_each};
use crate::error::LateError;

/// The code of a declaration's derivatives.
#[derive(Debug)]
pub(super) struct SlopeCode<B: Backend<f64>> {
    /// The tangent map of a step along one direction, and its transpose.
    pub(super) forwards: Ready<B::Code>,
    backwards: Ready<B::Code>,
    /// The transposes of what is computed besides the step: constants, advected parameters, momentum, energy, momentum in space.
    constants: Ready<B::Code>,
    seen: Ready<B::Code>,
    momentum: Ready<B::Code>,
    energy: Ready<B::Code>,
    spatial: Ready<B::Code>,
}

impl<B: Backend<f64>> SlopeCode<B> {
    /// The code of a declaration, written and prepared once.
    pub(super) fn of(declaration: &'static Declaration) -> Result<Arc<Self>, LateError> {
        declaration.once(|| {
            let step = WholeStep::of(declaration).map_err(LateError::Step)?;
            let (sizes, numbers, programs) = (&step.sizes, declaration.count(), &step.programs);
            let [forwards, backwards] = step.derivatives(declaration).map_err(LateError::Step)?;
            let of_limit = [(Array::Velocity, sizes.n), (Array::Advected, sizes.carried), (Array::Parameters, numbers)];
            let of_attitude = (Array::Attitude, sizes.entries);
            let rest = [
                pulled_back(&programs.constants, &[(Array::Parameters, numbers)]),
                pulled_back(&programs.seen, &[of_attitude, (Array::Parameters, numbers)]),
                pulled_back(&programs.momentum, &of_limit),
                pulled_back(&programs.energy, &of_limit),
                pulled_back(&programs.spatial, &[of_attitude, (Array::Momentum, sizes.n)]),
            ];
            let list: Vec<&Program> = [&forwards, &backwards].into_iter().chain(&rest).collect();
            let each: Result<[_; 7], _> = ready_each::<B>(&list)?.try_into();
            let [forwards, backwards, constants, seen, momentum, energy, spatial] =
                each.map_err(|_| LateError::TooLarge)?;
            Ok(Self { forwards, backwards, constants, seen, momentum, energy, spatial })
        })
    }
}

/// The state before a stage, and half the coordinates of its increment.
#[derive(Clone, Copy)]
pub(super) struct Made<'a> {
    pub(super) attitude: &'a [f64],
    pub(super) momentum: &'a [f64],
    pub(super) advected: &'a [f64],
    pub(super) half: &'a [f64],
}

/// Derivatives of a scalar: by displacement, momentum and what is advected in one row, and by the parameters.
#[derive(Clone, Debug)]
pub(super) struct Slopes {
    pub(super) by_state: Vec<f64>,
    pub(super) by_numbers: Vec<f64>,
    made: Vec<f64>,
}

impl Slopes {
    /// Adds other derivatives.
    pub(super) fn add(&mut self, other: &Self) {
        add(&mut self.by_state, &other.by_state);
        add(&mut self.by_numbers, &other.by_numbers);
    }
}

/// The transposes of a declaration's maps.
pub(super) struct Back<'a, B: Backend<f64>> {
    pub(super) codes: &'a Codes<B>,
    pub(super) code: &'a SlopeCode<B>,
}

impl<B: Backend<f64>> Back<'_, B> {
    /// No derivatives.
    pub(super) fn none(&self) -> Slopes {
        let (sizes, constants) = (&self.codes.sizes, self.constants());
        let by_state = vec![0.0; 2 * sizes.n + sizes.carried];
        let made = vec![0.0; by_state.len() + constants];
        Slopes { by_state, by_numbers: vec![0.0; self.codes.declaration.count()], made }
    }

    /// The number of a step's constants.
    pub(super) fn constants(&self) -> usize {
        self.codes.code.constants.outputs
    }

    /// Through a stage, by its constants, whose derivatives are added to these.
    pub(super) fn through_stage(
        &self,
        constants: &[f64],
        stage: Made<'_>,
        slopes: &mut Slopes,
        by_constants: &mut [f64],
    ) {
        let n = self.codes.sizes.n;
        let (turn, rest) = slopes.by_state.split_at(n);
        let (momentum, advected) = rest.split_at(n);
        let given = [
            (Array::Half, stage.half),
            (Array::Momentum, stage.momentum),
            (Array::Advected, stage.advected),
            (Array::Velocity, turn),
            (Array::History, momentum),
            (Array::Next, advected),
        ];
        B::run(&self.code.backwards.code, constants, given, &mut slopes.made);
        let (state, own) = slopes.made.split_at(slopes.by_state.len());
        slopes.by_state.copy_from_slice(state);
        add(by_constants, own);
    }

    /// Through the constants of a step of the length `h`.
    pub(super) fn through_constants(&self, (numbers, h): (&[f64], f64), by_constants: &[f64], by_numbers: &mut [f64]) {
        let mut made = vec![0.0; self.code.constants.outputs];
        let given = [(Array::Step, &[h][..]), (Array::Parameters, numbers), (Array::Factors, by_constants)];
        B::run(&self.code.constants.code, &[], given, &mut made);
        add(by_numbers, &made);
    }

    /// Through the view of what is advected, of whose derivatives none are left.
    pub(super) fn through_view(&self, numbers: &[f64], attitude: &[f64], slopes: &mut Slopes) {
        let n = self.codes.sizes.n;
        let own = &mut slopes.by_state[2 * n..];
        if own.iter().all(|slope| *slope == 0.0) {
            return;
        }
        let mut made = vec![0.0; self.code.seen.outputs];
        let given = [(Array::Attitude, attitude), (Array::Parameters, numbers), (Array::Factors, &*own)];
        B::run(&self.code.seen.code, &[], given, &mut made);
        own.fill(0.0);
        let (by_attitude, by_numbers) = made.split_at(attitude.len());
        self.through_attitude(by_attitude, attitude, slopes);
        add(&mut slopes.by_numbers, by_numbers);
    }

    /// Adds the derivatives by an attitude, whose entries `g` have the derivatives `ḡ`: `ḡ·g E_k` along each generator.
    pub(super) fn through_attitude(&self, by_entries: &[f64], attitude: &[f64], slopes: &mut Slopes) {
        for factor in &self.codes.factors {
            let (size, first) = (factor.size(), factor.entry);
            for (k, e) in factor.basis.generators.iter().enumerate() {
                let product = |i: usize, j: usize| -> f64 {
                    (0..size).map(|m| attitude[first + i * size + m] * e[m * size + j]).sum()
                };
                let places = (0..size * size).map(|at| by_entries[first + at] * product(at / size, at % size));
                slopes.by_state[factor.component + k] += places.sum::<f64>();
            }
        }
    }

    /// Through the momentum of a velocity: the derivatives by the velocity.
    pub(super) fn through_momentum(
        &self,
        (numbers, advected): (&[f64], &[f64]),
        velocity: &[f64],
        by_momentum: &[f64],
        slopes: &mut Slopes,
    ) -> Vec<f64> {
        self.through_limit(&self.code.momentum, (numbers, advected), velocity, by_momentum, slopes)
    }

    /// Through a function of the continuous limit.
    fn through_limit(
        &self,
        program: &Ready<B::Code>,
        (numbers, advected): (&[f64], &[f64]),
        velocity: &[f64],
        seeds: &[f64],
        slopes: &mut Slopes,
    ) -> Vec<f64> {
        let n = self.codes.sizes.n;
        let given = [
            (Array::Velocity, velocity),
            (Array::Parameters, numbers),
            (Array::Advected, advected),
            (Array::Factors, seeds),
        ];
        let mut made = vec![0.0; program.outputs];
        B::run(&program.code, &[], given, &mut made);
        let (by_velocity, rest) = made.split_at(n);
        let (by_advected, by_numbers) = rest.split_at(advected.len());
        add(&mut slopes.by_state[2 * n..], by_advected);
        add(&mut slopes.by_numbers, by_numbers);
        by_velocity.to_vec()
    }

    /// Through the velocity of a momentum, `∂l/∂ξ = μ`.
    pub(super) fn through_velocity(
        &self,
        at: (&[f64], &[f64]),
        velocity: &[f64],
        by_velocity: &[f64],
        slopes: &mut Slopes,
    ) {
        let (n, (numbers, advected)) = (self.codes.sizes.n, at);
        let limit = Limit { codes: self.codes, numbers, advected };
        let hessian = match &self.codes.code.hessian {
            None => limit.inertia(),
            Some(hessian) => limit.of(hessian, Array::Velocity, velocity),
        };
        let by_momentum = solution(&hessian, by_velocity);
        add(&mut slopes.by_state[n..2 * n], &by_momentum);
        let minus: Vec<f64> = by_momentum.iter().map(|slope| -slope).collect();
        self.through_momentum(at, velocity, &minus, slopes);
    }

    /// Through the energy at a velocity: the derivatives by the velocity.
    pub(super) fn through_energy(
        &self,
        at: (&[f64], &[f64]),
        velocity: &[f64],
        by_energy: f64,
        slopes: &mut Slopes,
    ) -> Vec<f64> {
        self.through_limit(&self.code.energy, at, velocity, &[by_energy], slopes)
    }

    /// Through the momentum in space.
    pub(super) fn through_spatial(
        &self,
        (attitude, momentum): (&[f64], &[f64]),
        by_spatial: &[f64],
        slopes: &mut Slopes,
    ) {
        let n = self.codes.sizes.n;
        let given = [(Array::Attitude, attitude), (Array::Momentum, momentum), (Array::Factors, by_spatial)];
        let mut made = vec![0.0; self.code.spatial.outputs];
        B::run(&self.code.spatial.code, &[], given, &mut made);
        let (by_attitude, by_momentum) = made.split_at(attitude.len());
        self.through_attitude(by_attitude, attitude, slopes);
        add(&mut slopes.by_state[n..2 * n], by_momentum);
    }

    /// The advected parameters at an attitude.
    pub(super) fn view(&self, numbers: &[f64], attitude: &[f64]) -> Vec<f64> {
        rare::<B>(&self.codes.code.seen, &[], [(Array::Attitude, attitude), (Array::Parameters, numbers)])
    }
}

fn add(sum: &mut [f64], addends: &[f64]) {
    sum.iter_mut().zip(addends).for_each(|(sum, addend)| *sum += addend);
}
