//! The code of a declaration's whole step: written, prepared and stored once, for all numbers and steps.

use std::sync::Arc;

use liestep::motion::{Cost, Factor, FactorKind, Layout};
use liestep::numbers::Real;
use liestep_derivation::whole::{Form, MatrixFactor, Programs, Sizes, WholeStep};
use liestep_derivation::{Array, Program};

use crate::code::{Backend, UsualStep};
use crate::declaration::{Declaration, Ready, ready_each};
use crate::error::LateError;

/// The code of all programs of a step, with the sizes of a state.
#[derive(Debug)]
pub(super) struct Codes<B: Backend<f64>> {
    pub(super) declaration: &'static Declaration,
    pub(super) sizes: Sizes,
    pub(super) factors: Vec<MatrixFactor>,
    /// The number of factors that are rotations of space.
    pub(super) rotations: usize,
    pub(super) layout: Layout,
    pub(super) code: Programs<Ready<B::Code>>,
    /// For each number of the parameters, whether the constants of a step, or their bounds, depend on it.
    pub(super) folds: Vec<bool>,
    /// The operations of an iteration, and of a step besides them.
    operations: [f64; 2],
}

/// An array of a program, and its numbers.
pub(super) type Input<'a> = (Array, &'a [f64]);

impl<B: Backend<f64>> Codes<B> {
    /// The code of a declaration's step.
    pub(super) fn of(declaration: &'static Declaration) -> Result<Arc<Self>, LateError> {
        declaration.once(|| Self::written(declaration))
    }

    fn written(declaration: &'static Declaration) -> Result<Self, LateError> {
        let WholeStep { sizes, factors, programs } = WholeStep::of(declaration).map_err(LateError::Step)?;
        let mut list: Vec<&Program> = Vec::new();
        programs.try_map(|program| {
            list.push(program);
            Ok::<_, LateError>(())
        })?;
        let mut each = ready_each::<B>(&list)?.into_iter();
        let code = programs.try_map(|_| each.next().ok_or(LateError::TooLarge))?;
        let length = |programs: [&Program; 2]| {
            let operations: usize = programs.iter().map(|program| program.operations.len()).sum();
            u32::try_from(operations).map_or(f64::INFINITY, f64::from)
        };
        let operations =
            [length([&programs.iterate, &programs.again]) * 0.5, length([&programs.target, &programs.finish])];
        let layout = layout(sizes.carried, 3 * sizes.n, &factors);
        let mut folds = vec![false; declaration.count()];
        let inputs = [&programs.constants, &programs.rest].into_iter().flat_map(|program| &program.inputs);
        for source in inputs.filter(|source| source.array == Array::Parameters) {
            folds[source.at] = true;
        }
        let rotations = factors.iter().filter(|factor| factor.form == Form::Rotation).count();
        Ok(Self { declaration, sizes, factors, rotations, layout, code, folds, operations })
    }

    /// The programs of a usual step.
    #[inline]
    pub(super) fn usual(&self) -> UsualStep<'_, B::Code> {
        let Programs { target, iterate, again, finish, safe, .. } = &self.code;
        UsualStep {
            sizes: &self.sizes,
            is_product: self.is_product(),
            target: &target.code,
            iterate: &iterate.code,
            again: &again.code,
            finish: &finish.code,
            safe: safe.as_ref().map(|program| &program.code),
        }
    }

    pub(super) fn is_product(&self) -> bool {
        self.factors.len() > 1
    }

    /// The determinant of a matrix by those of its blocks, relative to the products of their diagonals; negative where one
    /// of these is. A single block's is its own.
    pub(super) fn determinant<T: Real>(&self, pairs: &[T]) -> T {
        if !self.is_product() {
            return pairs[0];
        }
        let (mut value, mut is_negative) = (T::one(), T::zero().simd_lt(T::zero()));
        for pair in pairs.chunks_exact(2) {
            value *= pair[0] / pair[1].simd_abs();
            is_negative = is_negative | pair[0].simd_lt(T::zero());
        }
        (-value.simd_abs()).select(is_negative, value)
    }

    /// The advected parameters, seen from an attitude.
    pub(super) fn seen(&self, numbers: &[f64], attitude: &[f64]) -> Vec<f64> {
        rare::<B>(&self.code.seen, &[], [(Array::Attitude, attitude), (Array::Parameters, numbers)])
    }

    /// The identity of the group, row by row.
    pub(super) fn identity(&self) -> Vec<f64> {
        let entry = |at: usize, size: usize| f64::from(u8::from(at / size == at % size));
        let factors = self.factors.iter().map(MatrixFactor::size);
        factors.flat_map(|size| (0..size * size).map(move |at| entry(at, size))).collect()
    }

    /// The approximate number of operations of a step of so many stages.
    pub(super) fn cost(&self, stages: usize) -> Cost {
        let stages = u32::try_from(stages).unwrap_or(u32::MAX);
        let [iteration, step] = self.operations;
        Cost { step: f64::from(stages) * step, iteration, fewest: stages.saturating_mul(2), once: 0.0 }
    }
}

/// The outputs of a program that runs rarely.
pub(super) fn rare<B: Backend<f64>>(program: &Ready<B::Code>, constants: &[f64], given: [Input<'_>; 2]) -> Vec<f64> {
    let mut outputs = vec![0.0; program.outputs];
    B::run(&program.code, constants, given, &mut outputs);
    outputs
}

/// The names and places of a state's numbers.
pub(super) fn layout(carried: usize, memory: usize, factors: &[MatrixFactor]) -> Layout {
    let named = factors.iter().enumerate().map(|(place, factor)| {
        let kind = match factor.form {
            Form::Rotation => FactorKind::Rotation,
            Form::Translation => FactorKind::Translation(factor.size()),
            _ => FactorKind::Matrix(factor.size()),
        };
        let named = Factor::of(kind, factor.dimension()).with_generators(&factor.basis.generators);
        if factors.len() > 1 { named.at(place + 1) } else { named }
    });
    let advected = (1..=carried).map(|number| format!("advected_{number}")).collect();
    Layout { factors: named.collect(), advected, memory }
}
