//! Tangent maps and adjoints compared with dual numbers through the steps themselves, or with differences of them.

use liestep::gradients::{Input, InputOf, Linearisable};
use liestep::groups::LieGroup;
use liestep::laws::samples::{MatrixLieGroup, Random, along};
use liestep::mechanics::{Effect, SecondDerivatives};
use liestep::motion::{Steerable, Stepper};
use liestep::numbers::{Coordinates, Entries};
use nalgebra::{SMatrix, SVector};
use num_dual::Dual64;

use super::inputs::{assert_columns, some_inputs};

pub(crate) const STEPS: u64 = 12;
pub(crate) const STEP: f64 = 0.02;
/// The bounds relative to the largest entry, and to the largest of each column. Small columns are differences of larger
/// terms.
pub(crate) const BOUNDS: (f64, f64) = (1e-13, 1e-11);
/// The bound for entries that should be zero, relative to the largest entry.
pub(crate) const ROUNDING: f64 = 1e-17;
pub(crate) const SEEDS: std::ops::Range<u64> = 0..2;

/// The changes of attitude and momentum, for each varied number.
pub(crate) type Columns<const D: usize> = Vec<(SVector<f64, D>, SVector<f64, D>)>;

/// The derivatives of the last state by dual numbers: along displacements at the start, with respect to its momentum,
/// to parameters, and to the scalars of each step's input.
fn by_dual_numbers<M, P, A: Entries<f64>, const N: usize, const D: usize>(
    stepper: impl Fn(Option<usize>) -> Stepper<M, P>,
    parameters: usize,
    start: (SMatrix<f64, N, N>, SVector<f64, D>),
    inputs: &[Input<SVector<f64, D>, A>],
) -> Columns<D>
where
    M: Effect<Scalar = Dual64>,
    M::Group: LieGroup<Scalar = Dual64, Matrix = SMatrix<Dual64, N, N>, Vector = SVector<Dual64, D>>,
    P: Steerable<M>,
{
    let lift = |value: f64, change: f64| Dual64::new(value, change);
    let given = |n: usize, varied: Option<(usize, usize)>| -> InputOf<M> {
        let Some(input) = inputs.get(n) else { return Input::Free };
        let mut scalars = input.scalars().into_iter().enumerate();
        let next = &mut || {
            let (place, scalar) = scalars.next().expect("as many scalars");
            lift(scalar, if varied == Some((n, place)) { 1.0 } else { 0.0 })
        };
        match input {
            Input::Free => Input::Free,
            Input::Force(_) => Input::Force(Entries::from_entries(next)),
            Input::Values(_) => Input::Values(Entries::from_entries(next)),
        }
    };
    let run = |number, displaced: SMatrix<f64, N, N>, pushed: SVector<f64, D>, varied| {
        let stepper = stepper(number);
        let attitude = start.0.zip_map(&(start.0 * displaced), lift);
        let momentum = start.1.zip_map(&pushed, lift);
        let attitude = M::Group::from_matrix_unchecked(attitude);
        let mut state = stepper.start_with_momentum(attitude, momentum).expect("a start");
        for n in 0..usize::try_from(STEPS).expect("a few") {
            stepper.step_given(&mut state, &given(n, varied)).expect("a step");
        }
        let (matrix, momentum) = (state.attitude().matrix(), state.momentum());
        let inverse = matrix.map(|entry| entry.re).try_inverse().expect("an element of a group");
        let displaced = (inverse * matrix.map(|entry| entry.eps)).map(Dual64::from);
        (M::Group::vee(&displaced).map(|entry| entry.re), momentum.map(|entry| entry.eps))
    };
    let outcome = |number, displaced, pushed| run(number, displaced, pushed, None);
    let axis = |k: usize| SVector::<f64, D>::from_fn(|row, _| if row == k { 1.0 } else { 0.0 });
    let hat = |k: usize| M::Group::hat(&axis(k).map(Dual64::from)).map(|entry| entry.re);
    let of_attitude = (0..D).map(|k| outcome(None, hat(k), SVector::zeros()));
    let of_momentum = (0..D).map(|k| outcome(None, SMatrix::zeros(), axis(k)));
    let of_parameters = (0..parameters).map(|number| outcome(Some(number), SMatrix::zeros(), SVector::zeros()));
    let scalars =
        inputs.iter().enumerate().flat_map(|(n, input)| (0..input.scalars().len()).map(move |place| (n, place)));
    let of_inputs = scalars.map(|varied| run(None, SMatrix::zeros(), SVector::zeros(), Some(varied)));
    of_attitude.chain(of_momentum).chain(of_parameters).chain(of_inputs).collect()
}

/// Checks tangent map and adjoints at random starts, without inputs and with some.
pub(crate) fn assert_linearised<L, M, P, Q, const N: usize, const D: usize>(
    stepper: &Stepper<L, P>,
    dual: impl Fn(Option<usize>) -> Stepper<M, Q>,
) where
    L: SecondDerivatives<Scalar = f64>,
    L::Group: MatrixLieGroup<N, D>,
    P: Linearisable<L>,
    M: Effect<Scalar = Dual64>,
    M::Group: LieGroup<Scalar = Dual64, Matrix = SMatrix<Dual64, N, N>, Vector = SVector<Dual64, D>>,
    Q: Steerable<M>,
    SVector<f64, D>: Coordinates<f64, Square = SMatrix<f64, D, D>>,
{
    let parameters = stepper.linearised().expect("derivatives").parameters().len();
    for seed in SEEDS {
        let mut random = Random::new(seed);
        let (attitude, momentum) = (along::<L::Group, N, D>(&random.sample(), 1.0), random.sample());
        let inputs = some_inputs(stepper, seed, usize::MAX);
        // The column of an input must only be accurate relative to the largest entry.
        for (inputs, bounds) in [(&[][..], BOUNDS), (&inputs, (BOUNDS.0, 1.0))] {
            let expected = by_dual_numbers(&dual, parameters, (attitude.matrix(), momentum), inputs);
            assert_columns(stepper, (attitude, momentum), inputs, &expected, bounds, seed);
        }
    }
}
