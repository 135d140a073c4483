//! Several bodies at the limits of a step: steps up to the longest solvable one, and bodies that nearly touch.

use core::f64::consts::{FRAC_PI_2, PI};
use core::fmt::Debug;

use declarations::{DoublePendulum, TwoBodies};
use liestep::groups::R3;

use liestep::motion::Integrator;
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, StepError};
use nalgebra::{SVector, Vector3, Vector6};

use super::links::irregular;
use super::translated::whole;
use super::{assert_same, started};
use liestep::laws::samples::Random;

/// The reason why longer steps have no solution.
#[derive(Debug, PartialEq)]
enum End {
    /// Two solutions of the equation meet.
    Fold,
    /// A link's part of the Jacobian changes its sign, after which a solution may be on another branch.
    Turned,
}

/// Steps of every length up to the longest are solved, with increments that are continuous in the length and turn no
/// body by much more than a right angle; a longer step is an error, and leaves the state unchanged.
fn scanned<I>(
    started: impl Fn(f64) -> (I, I::State),
    bodies: impl Fn(&I::State) -> Vec<SO3>,
    refused: fn(&StepError) -> bool,
    expected: &End,
) where
    I: Integrator<State: Clone + PartialEq + Debug>,
{
    let turns = |h: f64| -> Result<Vec<Vector3<f64>>, StepError> {
        let (stepper, first) = started(h);
        let mut state = first.clone();
        match stepper.step(&mut state) {
            Ok(report) => {
                // The bound allows twenty iterations from the velocity, and up to sixty shortened ones from rest.
                assert!(report.iterations < 80, "{h}: {report:?}");
                let turn = |(from, to): (SO3, SO3)| (from.inverse().compose(&to)).log();
                Ok(bodies(&first).into_iter().zip(bodies(&state)).map(turn).collect())
            }
            Err(error) => {
                assert!(refused(&error), "{h}: {error:?}");
                assert_eq!(state, first, "{h}");
                Err(error)
            }
        }
    };
    // The length is doubled until there is no solution, then bisected.
    let mut longest = [1e-3, 2e-3];
    while turns(longest[1]).is_ok() {
        longest = [longest[1], 2.0 * longest[1]];
        assert!(longest[1] < 10.0);
    }
    for _ in 0..40 {
        let middle = 0.5 * (longest[0] + longest[1]);
        longest[usize::from(turns(middle).is_err())] = middle;
    }
    let longest = longest[0];
    // At a fold `h*` increments change as `√(h* − h)`; so steps are denser there, and increments change evenly. They
    // are continuous if doubling the density halves the largest change: a jump would stay the same.
    let changes = |parts: u32| -> Vec<f64> {
        let share = |k: u32| 1.0 - (f64::from(k) / f64::from(parts)).powi(2);
        let found: Vec<_> = (0..parts).map(|k| turns(share(k) * longest).unwrap()).collect();
        // A single body is solvable up to a right angle. For links there is no theorem, and one turns 1.60 rad here, 2
        // % more.
        assert!(found.iter().flatten().all(|turn| turn.norm() < 1.05 * FRAC_PI_2), "{found:?}");
        let change =
            |pair: &[Vec<Vector3<f64>>]| pair[0].iter().zip(&pair[1]).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        found.windows(2).map(change).collect()
    };
    let [coarse, fine] = [200, 400].map(changes);
    let [largest, then] = [&coarse, &fine].map(|changes| changes.iter().copied().fold(0.0, f64::max));
    assert!(then < 0.6 * largest, "{then} after {largest}");
    // Beyond a fold the iteration may end anywhere, occasionally also beyond the sign change.
    let behind = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10].map(|k| turns(longest * (1.0 + 1e-6 * f64::from(k))).unwrap_err());
    println!("{longest:.4} s, where changes are {:.1e} and then {:.1e}; {}", fine[0], fine[20], behind[9]);
    let is_turned =
        behind.iter().all(|error| matches!(error, StepError::UnsolvedBody { determinant, .. } if *determinant < 0.0));
    let end = if is_turned { End::Turned } else { End::Fold };
    assert_eq!(end, *expected, "{behind:?}");
    // At a fold the first change is as large as that twenty steps after it. Without a fold it would be 1/41 of that, as
    // the lengths differ by `2k + 1` parts there.
    assert!(end == End::Turned || fine[0] > 0.5 * fine[20], "{:?}", &fine[..20]);
    // Beyond the longest step no solution on another branch is accepted.
    for k in 0..300 {
        let more = 1.0001 * 1.02_f64.powi(k);
        assert!(turns(more * longest).is_err(), "{more}");
    }
}

#[test]
fn steps_of_a_double_pendulum_up_to_the_longest() {
    let attitudes = (SO3::from_euler_angles(0.3, 1.0, -0.2), SO3::from_euler_angles(-0.5, 0.4, 0.1));
    for velocity in [Vector6::new(0.5, -1.0, 2.0, 1.0, 0.3, -0.5), Vector6::new(4.0, 1.0, 9.0, -3.0, 2.0, -8.0)] {
        let started = |h: f64| started(DoublePendulum::asymmetric(), h, (attitudes, velocity));
        scanned(
            started,
            |state| vec![state.attitude().0, state.attitude().1],
            |error| matches!(error, StepError::BeyondSolvable { .. }),
            &End::Fold,
        );
    }
}

#[test]
fn steps_of_a_chain_up_to_the_longest() {
    let random = &mut Random::new(17);
    for (speed, end) in [(1.0, End::Fold), (5.0, End::Turned)] {
        let chain = irregular::<5>(random);
        let attitudes = [(); 5].map(|()| SO3::exp(random.sample::<Vector3<f64>>()));
        let velocities = Bodies([(); 5].map(|()| random.sample::<Vector3<f64>>() * speed));
        let started = |h: f64| {
            let stepper = chain.stepper(h).unwrap();
            let state = stepper.start(attitudes, velocities).unwrap();
            (stepper, state)
        };
        scanned(
            started,
            |state| state.attitude().to_vec(),
            |error| matches!(error, StepError::UnsolvedBody { .. } | StepError::NotConverged { .. }),
            &end,
        );
    }
}

/// Two bodies that pass each other at a hundredth of their distance: with short enough steps, the energy and the
/// momenta afterwards are those before. If the bodies coincide there is no step, and the error says so.
#[test]
fn bodies_that_nearly_touch() {
    let (size, G) = (1e-3, 1.0);
    let K =
        |m: f64| NonstandardInertia::from_principal_moments(Vector3::new(1.0, 0.8, 0.5) * (m * size * size)).unwrap();
    let [K_1, K_2] = [1.0, 0.4].map(K);
    let scene = TwoBodies { m_1: 1.0, m_2: 0.4, K_1, K_2, J_1: K_1.to_inertia(), J_2: K_2.to_inertia(), G };
    // The configuration about the centre of mass.
    let at = |apart: f64| {
        let [first, second] = [-0.4, 1.0].map(|share| R3::from(Vector3::x() * (share / 1.4 * apart)));
        (SO3::identity(), first, SO3::identity(), second)
    };
    // The velocity across the line between them, such that points would approach to `(1 − e)/(1 + e)` of their
    // distance, 1/101.
    let speed = (G * 1.4 * 2.0 / 101.0).sqrt();
    let mut velocity = SVector::<f64, 12>::zeros();
    (velocity[4], velocity[10]) = (-speed * 0.4 / 1.4, speed / 1.4);
    // The Kepler period for the semi-major axis 51/101.
    let period = 2.0 * PI * ((51.0_f64 / 101.0).powi(3) / (G * 1.4)).sqrt();
    let errors = [2e-5, 1e-5].map(|h| {
        let (stepper, mut state) = started(scene.clone(), h, (at(1.0), velocity));
        let (energy, momenta) = (stepper.energy(&state), whole(&state));
        let (mut nearest, mut most, mut time, mut moved) = (f64::INFINITY, 0.0_f64, 0.0, [0.0_f64; 2]);
        while time < period {
            stepper.step(&mut state).unwrap();
            time += h;
            let (_, x, _, y) = state.attitude();
            nearest = nearest.min((y.translation() - x.translation()).norm());
            most = most.max((stepper.energy(&state) - energy).abs());
            let now = whole(&state);
            moved = [moved[0].max((now.0 - momenta.0).norm()), moved[1].max((now.1 - momenta.1).norm())];
        }
        let off = (stepper.energy(&state) - energy).abs();
        println!(
            "{h:e}: as near as {nearest:.5}, energy {energy:.3} off by {most:.2e}, in the end {off:.1e}, {moved:.1?}"
        );
        // At that distance the bodies' shapes add 0.7 (size/nearest)² to the potential of points, and take about the
        // same fraction of the angular momentum.
        assert!((nearest * 101.0 - 1.0).abs() < 2.0 * (size * 101.0).powi(2), "{nearest}");
        // The bound is a rounding in each step, of the potential at the nearest approach, and of the initial momenta of
        // one body.
        let rounding = f64::EPSILON * period / h;
        assert!(off < rounding * G * 0.4 / nearest, "{off:e}");
        let [linear, angular] = [0.4 * velocity[10], momenta.1.norm()];
        assert!(moved[0] < rounding * linear && moved[1] < rounding * angular, "{moved:?}");
        most
    });
    // The order is two; the fourth-order term is smaller by `(h v/r)²`, 1e-3 at the nearest approach.
    let order = (errors[0] / errors[1]).log2();
    assert!((order - 2.0).abs() < 0.05, "{order}");

    let (stepper, mut state) = started(scene, 1e-3, (at(0.0), velocity));
    let before = state;
    let error = stepper.step(&mut state).unwrap_err();
    println!("{error}");
    assert_eq!(error, StepError::NonFinite { what: "momentum equation" });
    assert_same(&state, &before);
}
