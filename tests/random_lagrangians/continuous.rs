//! The continuous equations of random Lagrangians, against dual numbers of the declared `l`.
//!
//! The gradient of `l` is that of dual numbers, its change along a motion that of hyper-dual ones; the brackets and the
//! rates of what is advected are those of the library, which its laws test.

use checks::structure::numbers::{Numbers, lifted, varied};
use checks::structure::poisson;
use liestep::groups::{Advected, LieGroup};
use liestep::laws::samples::{MatrixLieGroup, Random};
use liestep::mechanics::ContinuousLagrangian;
use liestep::methods::CotangentGauss;
use liestep::motion::RightHandSide;
use liestep::numbers::{Coordinates, Entries};
use nalgebra::{SMatrix, SVector};
use num_dual::{Dual64, HyperDual64};
use workbench::runge_kutta;

/// Some dozens of roundings, relative to the size of the terms. The worst of each Lagrangian is printed by
/// `cargo test -p liestep-tests --test random_lagrangians continuous -- --nocapture`.
const BOUND: f64 = 1e-14;

/// Returns the error, relative to the scale.
fn assert_near<const D: usize>(found: &SVector<f64, D>, expected: &SVector<f64, D>, scale: f64, what: &str) -> f64 {
    let error = (found - expected).norm();
    assert!(error <= BOUND * scale, "{what}: {error:e} of {scale:e}, {found} and {expected}");
    error / scale
}

/// Momentum, diamond, Euler–Poincaré, Lie–Poisson and their inverse, at a random velocity.
pub(crate) fn assert_equations<L, D1, D2, const N: usize, const D: usize>(system: &L, dual: &D1, hyper: &D2, seed: u64)
where
    L: ContinuousLagrangian<Scalar = f64, Group: MatrixLieGroup<N, D>> + Clone,
    SVector<f64, D>: Coordinates<f64, Square = SMatrix<f64, D, D>>,
    D1: ContinuousLagrangian<Scalar = Dual64>,
    D1::Group: LieGroup<Scalar = Dual64, Vector = SVector<Dual64, D>>,
    D2: ContinuousLagrangian<Scalar = HyperDual64>,
    D2::Group: LieGroup<Scalar = HyperDual64, Vector = SVector<HyperDual64, D>>,
{
    let mut random = Random::new(seed ^ 0xC0);
    let (xi, w): (SVector<f64, D>, L::Advected) = (random.sample(), random.sample());
    let unit = |k: usize| SVector::<f64, D>::from_fn(|j, _| if j == k { 1.0 } else { 0.0 });
    let epsilon = Dual64::new(0.0, 1.0);
    // δw along `E_k`, by the library's action.
    let carried = |eta: &SVector<f64, D>| w.rate(&L::Group::hat(&-eta));
    let none = random.sample::<L::Advected>().zip(&w, &mut |_, _| 0.0);
    let slope = |eta: &SVector<f64, D>, delta: &L::Advected| {
        dual.l(&varied(&xi, eta, epsilon), &varied(&w, delta, epsilon)).eps
    };
    let momentum = SVector::<f64, D>::from_fn(|k, _| slope(&unit(k), &none));
    let diamond = SVector::<f64, D>::from_fn(|k, _| -slope(&SVector::zeros(), &carried(&unit(k))));
    let scale = 1.0 + momentum.norm() * (1.0 + xi.norm()) + diamond.norm();
    let mut worst = assert_near(&system.momentum(&xi, &w), &momentum, scale, "momentum");
    worst = worst.max(assert_near(&system.diamond_rate(&xi, &w), &diamond, scale, "diamond"));
    let rate = L::Group::lie_bracket_transpose(&xi, &momentum) + diamond;
    worst = worst.max(assert_near(&system.momentum_rate(&xi, &w), &rate, scale, "rate of the momentum"));

    // Along the motion the momentum changes as (1.4) and (2.2) say.
    let (acceleration, turn) = system.euler_poincare(&xi, &w).expect("regular");
    let (first, second) = (HyperDual64::new(0.0, 1.0, 0.0, 0.0), HyperDual64::new(0.0, 0.0, 1.0, 0.0));
    let change = SVector::<f64, D>::from_fn(|k, _| {
        let along: SVector<HyperDual64, D> = varied(&xi, &acceleration, first);
        let direction: SVector<HyperDual64, D> = lifted(&unit(k));
        hyper.l(&(along + direction * second), &varied(&w, &turn, first)).eps1eps2
    });
    let scale = scale + system.velocity_hessian(&xi, &w).norm() * acceleration.norm();
    worst = worst.max(assert_near(&change, &rate, scale, "Euler–Poincaré"));

    // Solved for the velocity again, and with the Hamiltonian's equations in (μ, w).
    let found = system.velocity(&momentum, &w).expect("a convex kinetic energy");
    let condition = system.velocity_hessian(&xi, &w).norm();
    worst = worst.max(assert_near(&found, &xi, (1.0 + condition) * (1.0 + xi.norm()), "velocity of the momentum"));
    let (torque, again) = system.lie_poisson(&momentum, &w).expect("a convex kinetic energy");
    worst = worst.max(assert_near(&torque, &rate, scale, "Lie–Poisson"));
    let mut entries = Vec::new();
    again.each(&mut |entry| entries.push(entry));
    let mut others = Vec::new();
    turn.each(&mut |entry| others.push(entry));
    let allowed = 10.0 * BOUND * (1.0 + condition) * (1.0 + xi.norm());
    assert!(entries.iter().zip(&others).all(|(a, b)| (a - b).abs() <= allowed), "the rate of what is advected");
    let energy = momentum.dot(&xi) - dual.l(&lifted(&xi), &lifted(&w)).re;
    let hamiltonian = system.hamiltonian(&momentum, &w).expect("a convex kinetic energy");
    assert!((hamiltonian - energy).abs() <= 10.0 * BOUND * (scale + energy.abs() + (momentum.dot(&xi)).abs()));

    // For a solver it is the same in numbers.
    let numbers = RightHandSide::new(system.clone()).expect("regular at rest");
    let attitude = L::Group::identity();
    let spatial = system.advected();
    let expected = system.lie_poisson(&momentum, &spatial).expect("a convex kinetic energy").0;
    let state = numbers.state(&attitude, &momentum);
    let mut rates = vec![0.0; state.len()];
    numbers.rate(&state, &mut rates).expect("a convex kinetic energy");
    let found = SVector::from_column_slice(&rates[N * N..]);
    worst = worst.max(assert_near(&found, &expected, 1.0 + expected.norm(), "numbers"));
    println!("the worst error of a term is {worst:.1e} of its size");
}

/// Where a motion ends after the time, in so many steps; `None` where one is too long for the iteration.
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

/// The orders that the errors of ever more steps show, as long as they are above rounding.
fn orders(errors: impl Iterator<Item = (u32, Option<f64>)>, rounding: f64) -> Vec<f64> {
    let told: Vec<(u32, f64)> = errors.filter_map(|(n, error)| Some((n, error?))).collect();
    let pairs = told.windows(2).filter(|pair| pair[1].1 > rounding);
    pairs.map(|pair| (pair[0].1 / pair[1].1).ln() / (f64::from(pair[1].0) / f64::from(pair[0].0)).ln()).collect()
}

/// Collocation in attitude and conjugate momentum: on the group, of its order, reversible, Poisson, with the momenta along
/// symmetries.
pub(crate) fn assert_collocation<L, const N: usize, const D: usize>(with: impl Fn(&L::Advected) -> L, seed: u64)
where
    L: ContinuousLagrangian<Scalar = f64, Group: MatrixLieGroup<N, D>> + Clone,
    L::Advected: Numbers,
    SVector<f64, D>: Coordinates<f64, Square = SMatrix<f64, D, D>>,
{
    let mut random = Random::new(seed ^ 0x6A);
    let (xi, w): (SVector<f64, D>, L::Advected) = (random.sample(), random.sample());
    let system = with(&w);
    let momentum = system.momentum(&xi, &w);
    let identity = L::Group::identity();
    // Fast, so that errors of high order are above rounding.
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
    // Of coarse steps the order is less, and near rounding it is anything; with several the best is between.
    let reaches = |orders: &[f64], order: f64| orders.len() < 2 || orders.iter().any(|&found| found > order);
    assert!(reaches(&six, 10.5), "six stages: {six:?}");
    assert!(reaches(&eight, 13.0), "eight stages: {eight:?}");

    // The same motion as by a Runge–Kutta method on the right-hand side, which knows nothing of the matrices off the group.
    let numbers = RightHandSide::new(system.clone()).expect("regular at rest");
    let mut state = numbers.state(&identity, &momentum);
    let rate = |y: &[f64], rate: &mut [f64]| numbers.rate(y, rate).expect("a convex kinetic energy");
    runge_kutta::run(rate, &mut state, 0.1, 100);
    let (there, after) = numbers.parts(&state);
    let found = end::<L, 4, N, D>(&system, (identity, momentum), (0.1, 1)).expect("a short step");
    let apart = distance(&found, &(there.matrix(), after));
    assert!(apart <= 1e-9 * size, "Runge–Kutta: {apart:e}");

    // Back again, and Poisson, by a step that isn't small.
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
    let (defect, scale) = poisson::defect_by::<L::Group, L::Advected, N, D>(map, &momentum, &w, differences);
    println!("Poisson {:.1e}, {defect:.1e} of {scale:.1e}", defect / scale);
    assert!(defect <= 1e-12 * scale, "Poisson: {defect:e} of {scale:e}");
}
