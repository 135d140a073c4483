//! Collocation of random Lagrangians.

use checks::structure::{Group, poisson};
use liestep::groups::LieGroup as _;
use liestep::laws::samples::{MatrixLieGroup, Random};
use liestep::mechanics::ContinuousLagrangian;
use liestep::methods::CotangentGauss;
use liestep::motion::RightHandSide;
use nalgebra::{SMatrix, SVector};
use workbench::runge_kutta;

/// The end of a motion after the time, in this number of steps; `None` if a step is too long for the iteration.
fn end<L, const PAIRS: usize, const N: usize, const D: usize>(
    system: &L,
    (mut attitude, mut momentum): (L::Group, SVector<f64, D>),
    (time, steps): (f64, u32),
) -> Option<(SMatrix<f64, N, N>, SVector<f64, D>)>
where
    L: ContinuousLagrangian<Scalar = f64, Group: MatrixLieGroup<N, D>> + Clone,
{
    let gauss = CotangentGauss::<L, PAIRS, N>::new(system.clone(), time / f64::from(steps)).expect("regular at rest");
    for _ in 0..steps {
        (attitude, momentum) = gauss.step(&attitude, &momentum).ok()?;
    }
    Some((attitude.matrix(), momentum))
}

/// The orders between successive numbers of steps, as long as errors are above rounding.
fn orders(errors: impl Iterator<Item = (u32, Option<f64>)>, rounding: f64) -> Vec<f64> {
    let told: Vec<(u32, f64)> = errors.filter_map(|(n, error)| Some((n, error?))).collect();
    let pairs = told.windows(2).filter(|pair| pair[1].1 > rounding);
    pairs.map(|pair| (pair[0].1 / pair[1].1).ln() / (f64::from(pair[1].0) / f64::from(pair[0].0)).ln()).collect()
}

/// Checks collocation in attitude and conjugate momentum: relation of the group, order, reversibility, Poisson
/// property, and momenta along symmetries.
pub(crate) fn assert_collocation<L, const N: usize, const D: usize>(with: impl Fn(&L::Advected) -> L, seed: u64)
where
    L: ContinuousLagrangian<Scalar = f64, Group: Group + MatrixLieGroup<N, D>> + Clone,
{
    let mut random = Random::new(seed ^ 0x6A);
    let (xi, w): (SVector<f64, D>, L::Advected) = (random.sample(), random.sample());
    let system = with(&w);
    let momentum = system.momentum(&xi, &w);
    let identity = L::Group::identity();
    // The motion is fast, so that errors of high order are above rounding.
    let start = (identity, system.momentum(&(xi * 3.0), &w));

    let distance = |a: &(SMatrix<f64, N, N>, SVector<f64, D>), b: &(SMatrix<f64, N, N>, SVector<f64, D>)| {
        (a.0 - b.0).norm() + (a.1 - b.1).norm()
    };
    let time = 2.0;
    let exact = end::<L, 4, N, D>(&system, start, (time, 40)).expect("short steps");
    let size = exact.0.norm() + exact.1.norm();
    let defect = L::Group::from_matrix_unchecked(exact.0).defect();
    assert!(defect <= 1e-13 * size, "off the group: {defect:e}");
    let missed = |found: Option<_>| found.map(|found| distance(&found, &exact));
    let fourth =
        orders([60, 120].map(|n| (n, missed(end::<L, 1, N, D>(&system, start, (time, n))))).into_iter(), 1e-12 * size);
    let steps = || [2, 3, 4, 5, 6, 8, 10].into_iter();
    let six = orders(steps().map(|n| (n, missed(end::<L, 3, N, D>(&system, start, (time, n))))), 1e-11 * size);
    let eight = orders(steps().map(|n| (n, missed(end::<L, 4, N, D>(&system, start, (time, n))))), 1e-11 * size);
    println!("orders {fourth:.2?}, {six:.1?}, {eight:.1?}");
    assert!(fourth.iter().all(|order| (3.7..4.3).contains(order)), "two stages: {fourth:?}");
    // Coarse steps have a lower order, and near rounding it is arbitrary; among several, the best is between.
    let reaches = |orders: &[f64], order: f64| orders.len() < 2 || orders.iter().any(|&found| found > order);
    assert!(reaches(&six, 10.5), "six stages: {six:?}");
    assert!(reaches(&eight, 13.0), "eight stages: {eight:?}");

    // The motion by a Runge–Kutta method on the right-hand side, which is independent of matrices off the group.
    let numbers = RightHandSide::new(system.clone()).expect("regular at rest");
    let mut state = numbers.state(&identity, &momentum);
    let rate = |y: &[f64], rate: &mut [f64]| numbers.rate(y, rate).expect("a convex kinetic energy");
    runge_kutta::run(rate, &mut state, 0.1, 100);
    let (there, after) = numbers.parts(&state);
    let found = end::<L, 4, N, D>(&system, (identity, momentum), (0.1, 1)).expect("a short step");
    let apart = distance(&found, &(there.matrix(), after));
    assert!(apart <= 1e-9 * size, "Runge–Kutta: {apart:e}");

    // Reversibility and Poisson property, by a step that isn't small.
    let (there, back) =
        [0.3, -0.3].map(|h| CotangentGauss::<L, 2, N>::new(system.clone(), h).expect("regular at rest")).into();
    let (attitude, after) = there.step(&identity, &momentum).expect("a short step");
    let (again, before) = back.step(&attitude, &after).expect("a short step");
    let missed = (again.matrix() - identity.matrix()).norm() + (before - momentum).norm();
    assert!(missed <= 1e-12 * size, "reversal: {missed:e}");
    let map = |momentum: &SVector<f64, D>, w: &L::Advected| {
        let gauss = CotangentGauss::<L, 2, N>::new(with(w), 0.2).expect("regular at rest");
        let (attitude, momentum) = gauss.step(&identity, momentum).expect("a short step");
        (momentum, gauss.advected(&attitude))
    };
    let differences = &poisson::smooth_derivative;
    let (defect, scale) = poisson::defect_of::<L::Group, _>(map, &momentum, &w, differences);
    println!("Poisson {:.1e}, {defect:.1e} of {scale:.1e}", defect / scale);
    assert!(defect <= 1e-12 * scale, "Poisson: {defect:e} of {scale:e}");
}
