//! Bodies of one declaration in lanes: the usual solve for all at once, and a step of its own for each that needs more.

use std::sync::Arc;

use liestep::__private::{MAX_ITERATIONS, SETTLED, has_sufficed, may_suffice};
use liestep::StepError;
use liestep::motion::{Abreast, AnyStepper};
use liestep::numbers::Mask;
use liestep_derivation::Array;
use nalgebra::{SimdBool as _, SimdPartialOrd as _, SimdValue as _};
use simba::simd::AutoF64x8 as Eight;

use super::constants::{StepConstants, safe_at};
use super::stepper::Whole;
use crate::code::Backend;

/// The number of lanes.
const LANES: usize = 8;

/// A back end whose code runs alone and in eight lanes.
pub trait BackendInLanes: Backend<f64> + Backend<Eight, Code = <Self as Backend<f64>>::Code> {}

impl<B: Backend<f64> + Backend<Eight, Code = <B as Backend<f64>>::Code>> BackendInLanes for B {}

/// Bodies, each in the lane of its number. A lane without a running body is computed, but its state stays.
struct Bodies<B: BackendInLanes> {
    steppers: Vec<Whole<B>>,
    errors: Vec<Option<StepError>>,
    running: Mask<Eight>,
    constants: Vec<Eight>,
    parameters: Vec<Eight>,
    /// The bounds of [`StepConstants`](super::constants::StepConstants).
    bounds: [Eight; 2],
    state: Vec<Eight>,
    room: Vec<Eight>,
    /// The number of steps of those that run.
    steps: f64,
}

/// Numbers of all bodies in lanes; lanes without a body have the first one's.
fn gathered<'a>(bodies: impl Iterator<Item = &'a [f64]>) -> Vec<Eight> {
    let bodies: Vec<&[f64]> = bodies.collect();
    let lane = |lane: usize| bodies.get(lane).or(bodies.first()).copied().unwrap_or_default();
    (0..lane(0).len()).map(|at| Eight::from(std::array::from_fn(|k| lane(k)[at]))).collect()
}

impl<B: BackendInLanes> Whole<B> {
    /// A stepper whose bodies can be stepped in lanes, if they share the declaration and make single steps.
    #[must_use]
    pub fn into_joinable(self) -> AnyStepper {
        AnyStepper::joinable(self, LANES, Bodies::of)
    }
}

impl<B: BackendInLanes> Bodies<B> {
    fn of(bodies: &[(&Whole<B>, &[f64])]) -> Option<Box<dyn Abreast>> {
        let ((first, state), all) = (bodies.first()?, || bodies.iter());
        let is_alike = |(stepper, own): &(&Whole<B>, &[f64])| {
            Arc::ptr_eq(&first.codes, &stepper.codes) && own.len() == state.len() && own.last() == state.last()
        };
        let can_join = bodies.len() <= LANES && state.len() == first.codes.sizes.state() && bodies.iter().all(is_alike);
        let constants: Vec<_> = all().map(|(stepper, _)| stepper.stages.single()).collect::<Option<_>>()?;
        if !can_join {
            return None;
        }
        let bound = |of: fn(&StepConstants) -> f64| {
            Eight::from(std::array::from_fn(|k| of(constants.get(k).unwrap_or(&constants[0]))))
        };
        let mut running = Mask::<Eight>::splat(false);
        (0..bodies.len()).for_each(|lane| running.replace(lane, true));
        let code = &first.codes.code;
        let outputs = [code.target.outputs, code.iterate.outputs, code.again.outputs, code.finish.outputs];
        let room = first.codes.sizes.n + 2 * first.codes.sizes.dets + outputs.iter().sum::<usize>();
        Some(Box::new(Self {
            steppers: all().map(|(stepper, _)| (*stepper).clone()).collect(),
            errors: vec![None; bodies.len()],
            running,
            constants: gathered(constants.iter().map(|constants| &*constants.numbers)),
            parameters: gathered(all().map(|(stepper, _)| &*stepper.numbers)),
            bounds: [bound(|constants| constants.safe), bound(|constants| constants.largest_target)],
            state: gathered(all().map(|(_, state)| *state)),
            room: vec![Eight::splat(0.0); room],
            steps: state.last().copied().unwrap_or_default(),
        }))
    }
}

impl<B: BackendInLanes> Abreast for Bodies<B> {
    fn run(&mut self, steps: u64) {
        for _ in 0..steps {
            if !self.running.any() {
                return;
            }
            self.step();
        }
    }

    fn state(&self, body: usize) -> Box<[f64]> {
        self.state.iter().map(|number| number.extract(body)).collect()
    }

    fn error(&self, body: usize) -> Option<&StepError> {
        self.errors[body].as_ref()
    }
}

impl<B: BackendInLanes> Bodies<B> {
    /// One step of all that run.
    fn step(&mut self) {
        let usual = self.step_usually();
        let is_due = self.steppers[0].numbered().is_due(self.steps);
        for lane in 0..self.steppers.len() {
            let is_usual = usual.extract(lane);
            if !self.running.extract(lane) || is_usual && !is_due {
                continue;
            }
            let mut state = self.state(lane);
            if is_usual {
                self.steppers[lane].numbered().look(&mut state);
            } else if let Err(error) = self.steppers[lane].step_alone(&mut state) {
                self.errors[lane] = Some(error);
                self.running.replace(lane, false);
                continue;
            }
            self.state.iter_mut().zip(&state).for_each(|(number, &own)| number.replace(lane, own));
        }
        // A step of its own has counted itself.
        if let Some(count) = self.state.last_mut() {
            *count = (*count + Eight::splat(1.0)).select(usual, *count);
        }
        self.steps += 1.0;
    }

    /// The usual solve in all lanes; the states of lanes where all about it is usual, which it returns, are those after the
    /// step, but for their counts.
    fn step_usually(&mut self) -> Mask<Eight> {
        let Self { steppers, running, constants, parameters, bounds: [safe, largest], state, room, .. } = self;
        let codes = &*steppers[0].codes;
        let (code, sizes) = (&codes.code, &codes.sizes);
        let n = sizes.n;
        let (target, room) = room.split_at_mut(n + 1);
        let (half, room) = room.split_at_mut(n);
        let (made, room) = room.split_at_mut(code.iterate.outputs);
        let (second, room) = room.split_at_mut(n + 2);
        let (end, determinants) = room.split_at_mut(code.finish.outputs);
        let (momentum, advected) =
            (&state[sizes.momentum()..sizes.advected()], &state[sizes.advected()..sizes.history()]);
        B::run(&code.target.code, constants, [(Array::Momentum, momentum), (Array::Advected, advected)], target);
        let (target, square) = target.split_at(n);
        let safe = safe_at::<Eight, B>(codes, parameters, advected, determinants).unwrap_or(*safe);
        half.copy_from_slice(&state[sizes.guess()..sizes.guess() + n]);
        let (mut settled, mut det) = (!*running, Eight::splat(0.0));
        for _ in 0..MAX_ITERATIONS {
            let given = [(Array::Half, &*half), (Array::Target, target), (Array::Advected, advected)];
            B::run(&code.iterate.code, constants, given, made);
            let (first, size, factors) = (made[n], made[n + 1], &made[n + 2..]);
            half.iter_mut().zip(&*made).for_each(|(half, next)| *half = half.select(settled, *next));
            det = det.select(settled, codes.determinant(&factors[..2 * sizes.dets]));
            settled = settled | first.simd_le(size * Eight::splat(f64::EPSILON * SETTLED));
            let near = may_suffice(first, size) & det.simd_gt(safe) & !settled;
            if near.any() {
                let given = [
                    (Array::Half, &*half),
                    (Array::Target, target),
                    (Array::Advected, advected),
                    (Array::Factors, factors),
                ];
                B::run(&code.again.code, constants, given, second);
                half.iter_mut().zip(&*second).for_each(|(half, next)| *half = next.select(near, *half));
                settled = settled | near & has_sufficed(first, second[n], second[n + 1]);
            }
            if settled.all() {
                break;
            }
        }
        let given = [
            (Array::Half, &*half),
            (Array::Target, target),
            (Array::Advected, advected),
            (Array::Momentum, momentum),
            (Array::Attitude, &state[..sizes.entries]),
            (Array::History, &state[sizes.history()..sizes.guess()]),
        ];
        B::run(&code.finish.code, constants, given, end);
        let (next, others) = end.split_at_mut(sizes.state() - 1);
        let (zero, one) = (Eight::splat(0.0), Eight::splat(1.0));
        let is_near = |times: f64| {
            let all = others[1..].iter().map(|near| (*near * Eight::splat(times * times)).simd_lt(one));
            all.fold(Mask::<Eight>::splat(true), |all, near| all & near)
        };
        // Zero times an infinity or a NaN is NaN.
        let (is_finite, is_far) = ((others[0] * zero).simd_eq(zero), !is_near(3.0));
        let is_solved = settled & det.simd_gt(zero) & square[0].simd_lt(*largest);
        let usual = *running & is_solved & is_finite & (!is_far | is_near(2.0));
        // Near the fold coordinates change too fast for an extrapolation.
        for (guess, half) in next[sizes.guess()..].iter_mut().zip(&*half) {
            *guess = half.select(is_far, *guess);
        }
        state.iter_mut().zip(&*next).for_each(|(number, next)| *number = next.select(usual, *number));
        usual
    }
}
