//! Derivatives with respect to each step's input: blocks of a step, and adjoints of a run, compared with dual numbers
//! and differences.

use liestep::Stepper;
use liestep::gradients::{Cotangent, Input, InputOf, Linearisable, Tape, Transition};
use liestep::groups::{CayleyRetraction, LieGroup, Retraction};
use liestep::laws::samples::Random;
use liestep::mechanics::SecondDerivatives;
use liestep::numbers::{Coordinates, Entries};
use nalgebra::{SMatrix, SVector};

use super::dual::{BOUNDS, Columns, ROUNDING, STEPS};

/// Inputs in rotation: none, a force, and other values than the scene's; only the first `varied` of the values differ.
pub(crate) fn some_inputs<L, P, const D: usize>(stepper: &Stepper<L, P>, seed: u64, varied: usize) -> Vec<InputOf<L>>
where
    L: SecondDerivatives<Scalar = f64>,
    L::Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>>,
    P: Linearisable<L>,
    SVector<f64, D>: Coordinates<f64>,
{
    let mut random = Random::new(seed + 200);
    let mut scalars = Vec::new();
    stepper.scene().advected().each(&mut |scalar| scalars.push(scalar));
    let kinds = [Input::Free, Input::Force(random.sample()), Input::Values(stepper.scene().advected())];
    let inputs = (0..STEPS).zip(kinds.iter().cycle()).map(|(_, kind)| {
        let mut own = scalars.iter();
        let is_force = matches!(kind, Input::Force(_));
        let mut place = 0;
        kind.of_scalars(&mut || {
            place += 1;
            let scalar = if is_force { 0.0 } else { *own.next().expect("as many scalars") };
            // A long step gets the impulse of a short one, so that it stays solvable.
            let size = if is_force { 0.1 / stepper.step_size().abs() } else { 0.2 };
            if is_force || place <= varied { scalar + random.signed() * size } else { scalar }
        })
    });
    inputs.collect()
}

type Column<const D: usize> = (SVector<f64, D>, SVector<f64, D>);

/// The product `A x`.
fn carried<const D: usize>(transition: &Transition<SVector<f64, D>>, x: &Column<D>) -> Column<D> {
    let factors = x.0.iter().chain(x.1.iter());
    let zero = (SVector::zeros(), SVector::zeros());
    transition
        .by_state
        .iter()
        .zip(factors)
        .fold(zero, |sum, (by, factor)| (sum.0 + by.0 * *factor, sum.1 + by.1 * *factor))
}

/// The cotangents of a cost at the states of a run; some are zero.
fn cotangents<const D: usize>(random: &mut Random, steps: usize) -> Vec<Cotangent<SVector<f64, D>>> {
    let mut read = |n: usize| match n % 3 {
        1 => Cotangent::zero::<f64>(),
        _ => Cotangent { attitude: random.sample(), momentum: random.sample() },
    };
    (0..=steps).map(&mut read).collect()
}

/// The contribution of each column to the cost.
fn paired<const D: usize>(columns: &[Column<D>], cotangent: &Cotangent<SVector<f64, D>>) -> Vec<f64> {
    columns.iter().map(|(a, m)| a.dot(&cotangent.attitude) + m.dot(&cotangent.momentum)).collect()
}

fn add(sums: &mut Vec<f64>, shares: Vec<f64>) {
    sums.resize(shares.len(), 0.0);
    sums.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share);
}

/// Checks that the columns with respect to the start, the parameters and the inputs are as expected, and that the
/// adjoints are their transposes, with either tape. Steps after the last input are free.
///
/// The first bound is relative to the largest entry, also for the adjoint, the second to each column.
pub(crate) fn assert_columns<L, P, const D: usize>(
    stepper: &Stepper<L, P>,
    start: (L::Group, SVector<f64, D>),
    inputs: &[InputOf<L>],
    expected: &Columns<D>,
    bounds: (f64, f64),
    seed: u64,
) where
    L: SecondDerivatives<Scalar = f64>,
    L::Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>>,
    P: Linearisable<L>,
    SVector<f64, D>: Coordinates<f64, Square = SMatrix<f64, D, D>>,
{
    let linear = stepper.linearised().expect("derivatives");
    let numbers: Vec<usize> = (0..linear.parameters().len()).collect();
    let start = stepper.start_with_momentum(start.0, start.1).expect("a start");
    let inputs: Vec<InputOf<L>> = inputs
        .iter()
        .copied()
        .chain(std::iter::repeat(Input::Free))
        .take(usize::try_from(STEPS).expect("a few"))
        .collect();
    let cotangents = cotangents(&mut Random::new(seed + 300), inputs.len());

    // The tangent has the columns of start and parameters, and the blocks of the steps those of the inputs.
    let (mut state, mut plain, mut blocks) = (start, start, start);
    let mut tangent = linear.tangent(&numbers);
    let mut of_inputs: Vec<Column<D>> = Vec::new();
    let (mut of_start, mut of_given) = (paired(&tangent.columns().collect::<Vec<_>>(), &cotangents[0]), Vec::new());
    for (input, cotangent) in inputs.iter().zip(&cotangents[1..]) {
        linear.step_given(&mut state, input, &mut tangent).expect("a step");
        stepper.step_given(&mut plain, input).expect("a step");
        let transition = linear.transition(&mut blocks, input).expect("blocks");
        assert_eq!(plain, state, "the step is what it is without derivatives");
        assert_eq!(plain, blocks, "the step is what it is without derivatives");
        for column in &mut of_inputs {
            *column = carried(&transition, column);
        }
        of_inputs.extend(&transition.by_input);
        add(&mut of_start, paired(&tangent.columns().collect::<Vec<_>>(), cotangent));
        add(&mut of_given, paired(&of_inputs, cotangent));
    }
    let largest = |(attitude, momentum): &Column<D>| attitude.amax().max(momentum.amax());
    let size = expected.iter().map(largest).fold(0.0, f64::max);
    let found: Vec<Column<D>> = tangent.columns().chain(of_inputs).collect();
    assert_eq!(found.len(), expected.len());
    for (number, (found, expected)) in found.iter().zip(expected).enumerate() {
        let (error, own) = (largest(&(found.0 - expected.0, found.1 - expected.1)), largest(expected));
        let is_right = error <= bounds.0 * size && error <= bounds.1 * own + ROUNDING * size;
        assert!(is_right, "column {number}: off by {error:e} of {own:e}, {found:?}, not {expected:?}");
    }

    let gradients = [Tape::All, Tape::SquareRoot].map(|tape| {
        let mut state = start;
        let place = |n: u64| usize::try_from(n).expect("a few");
        let mut shown = Vec::new();
        let (gradient, by_inputs) = linear
            .adjoint_given(&mut state, &inputs, tape, |n, motion| {
                shown.push(*motion);
                cotangents[place(n)]
            })
            .expect("a gradient");
        assert_eq!(plain, state);
        // The states are those between the steps, and not those after an input.
        assert_eq!(shown.last(), Some(&*start));
        let kinds = |inputs: &[InputOf<L>]| inputs.iter().map(std::mem::discriminant).collect::<Vec<_>>();
        assert_eq!(kinds(&by_inputs), kinds(&inputs));
        let start = gradient.start.attitude.iter().chain(gradient.start.momentum.iter());
        let found = start.chain(&gradient.parameters).copied().chain(by_inputs.iter().flat_map(Input::scalars));
        let expected = of_start.iter().chain(&of_given);
        let size = expected.clone().fold(size, |size: f64, entry| size.max(entry.abs()));
        for (number, (found, expected)) in found.zip(expected).enumerate() {
            let error = (found - expected).abs();
            assert!(error <= BOUNDS.0 * size, "{number}: {found} by the adjoint, {expected} by the blocks");
        }
        gradient
    });
    assert_eq!(gradients[0], gradients[1], "checkpoints change a bit");
}

/// The blocks of one step compared with differences of fourth order. Only the first values vary: others may be entries
/// of a rotation, and derivations assume that they are.
pub(crate) fn assert_blocks<L, P, const D: usize>(
    stepper: &Stepper<L, P>,
    start: (L::Group, SVector<f64, D>),
    seed: u64,
    varied: usize,
) where
    L: SecondDerivatives<Scalar = f64>,
    L::Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>>,
    P: Linearisable<L>,
    SVector<f64, D>: Coordinates<f64, Square = SMatrix<f64, D, D>>,
    CayleyRetraction: Retraction<L::Group>,
{
    const SMALL: f64 = 1e-3;
    let begin = |turn: SVector<f64, D>, push: SVector<f64, D>| {
        let attitude = start.0.compose(&CayleyRetraction::retract(&turn));
        stepper.start_with_momentum(attitude, start.1 + push).expect("a start")
    };
    let zero = SVector::<f64, D>::zeros();
    let count = |input: &InputOf<L>| match input {
        Input::Values(_) => input.scalars().len().min(varied),
        _ => input.scalars().len(),
    };
    for input in some_inputs(stepper, seed, varied).into_iter().take(3) {
        let mut middle = begin(zero, zero);
        let found = stepper.linearised().expect("derivatives").transition(&mut middle, &input).expect("blocks");
        let end = |turn, push, input: &InputOf<L>| -> Column<D> {
            let mut state = begin(turn, push);
            stepper.step_given(&mut state, input).expect("a step");
            (L::Group::vee(&middle.attitude().inverse().compose(&state.attitude()).matrix()), state.momentum())
        };
        let slope = |outcome: &dyn Fn(f64) -> Column<D>| {
            let [a, b, c, d] = [2.0, 1.0, -1.0, -2.0].map(|step| outcome(step * SMALL));
            let slope = |a, b, c, d| ((b - c) * 8.0 - (a - d)) / (12.0 * SMALL);
            (slope(a.0, b.0, c.0, d.0), slope(a.1, b.1, c.1, d.1))
        };
        let axis = |k: usize| SVector::<f64, D>::from_fn(|i, _| if i == k { 1.0 } else { 0.0 });
        let changed = |place: usize, by: f64| {
            let mut scalars = input.scalars().into_iter().enumerate();
            let next = &mut || scalars.next().map_or(0.0, |(k, scalar)| if k == place { scalar + by } else { scalar });
            input.of_scalars(next)
        };
        let of_attitude = (0..D).map(|k| slope(&|by| end(axis(k) * by, zero, &input)));
        let of_momentum = (0..D).map(|k| slope(&|by| end(zero, axis(k) * by, &input)));
        let of_input = (0..count(&input)).map(|k| slope(&|by| end(zero, zero, &changed(k, by))));
        let expected: Vec<_> = of_attitude.chain(of_momentum).chain(of_input).collect();
        assert_eq!(found.by_state.len() + count(&input), expected.len());
        for (k, (found, expected)) in found.by_state.iter().chain(&found.by_input).zip(&expected).enumerate() {
            let error = (found.0 - expected.0).amax().max((found.1 - expected.1).amax());
            assert!(error < 1e-8, "{seed}, column {k}: off by {error:e}, {found:?}, not {expected:?}, of {input:?}");
        }
    }
}
