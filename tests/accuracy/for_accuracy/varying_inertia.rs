//! Scenes whose inertia depends on advected parameters.

use liestep::numbers::Entries;
use liestep::with::Steppable;

use super::*;

fn entries<E: Entries<f64>>(of: &E) -> Vec<f64> {
    let mut entries = Vec::new();
    of.each(&mut |entry| entries.push(entry));
    entries
}

fn norm(entries: &[f64]) -> f64 {
    entries.iter().map(|entry| entry.powi(2)).sum::<f64>().sqrt()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>())
}

/// The claims for a scene with varying inertia: order 2, for a composition the order of its scheme, and the tolerance.
/// The reference solves the continuous equations, independently of steps.
fn assert_claims_of_varying_inertia<S, G>(scene: &S, attitude: G, momentum: G::Vector)
where
    S: Scene<Scalar = f64, Group = G> + ContinuousLagrangian<Scalar = f64, Group = G>,
    G: Steppable<S>,
{
    assert!(!S::FACTS.has_constant_inertia);
    let (horizon, system) = (1.0, RightHandSide::new(scene.clone()).unwrap());
    let mut exact = system.state(&attitude, &momentum);
    runge_kutta::run(|y, rate| system.rate(y, rate).unwrap(), &mut exact, horizon, 8000);
    let own = Stepper::new(scene.clone(), 0.01).unwrap();
    let velocity = own.velocity(&own.start_with_momentum(attitude, momentum).unwrap());
    let order = |scheme: Option<CompositionScheme>, steps: [u32; 2]| {
        let [coarse, fine] = steps.map(|steps| {
            let h = horizon / f64::from(steps);
            let stepper = match scheme {
                Some(scheme) => Stepper::composed(scene.clone(), h, scheme).unwrap().into_any(),
                None => Stepper::new(scene.clone(), h).unwrap().into_any(),
            };
            let stepper = stepper.on_group::<G, S::Advected>().unwrap();
            let mut state = stepper.start(attitude, velocity).unwrap();
            stepper.run(&mut state, steps.into()).unwrap();
            apart(&system.state(&state.attitude(), &state.momentum()), &exact)
        });
        (coarse / fine).ln() / (f64::from(steps[1]) / f64::from(steps[0])).ln()
    };
    let own = order(None, [200, 400]);
    assert!((own - 2.0).abs() < 0.1, "{own}");
    for (scheme, steps) in [(CompositionScheme::SUZUKI_4, [50, 100]), (CompositionScheme::KAHAN_LI_6, [25, 50])] {
        let shown = order(Some(scheme), steps);
        assert!((shown - f64::from(scheme.order())).abs() < 0.4, "{}: {shown}", scheme.name());
    }
    let (exact_attitude, exact_momentum) = system.parts(&exact);
    let seen = scene.advected().seen_from(&exact_attitude);
    let exact_velocity = entries(&system.velocity(&exact_momentum, &seen).unwrap());
    let exact_attitude = entries(&exact_attitude.matrix());
    let scale = norm(&exact_velocity).max(norm(&entries(&velocity))).max(1.0 / horizon);
    for tolerance in TOLERANCES {
        let accuracy = Accuracy { tolerance, horizon };
        let stepper = Stepper::for_accuracy(scene.clone(), accuracy, attitude, velocity).unwrap();
        let mut state = stepper.start();
        stepper.run(&mut state).unwrap();
        assert!(stepper.choice().trials <= 60.0, "{}", stepper.choice());
        // The error as `Accuracy` defines it.
        let attitudes = apart(&entries(&state.attitude().matrix()), &exact_attitude) / norm(&exact_attitude);
        let error = attitudes.hypot(apart(&entries(&stepper.velocity(&state)), &exact_velocity) / scale);
        assert!(error <= tolerance, "{error:e}\n{}", stepper.choice());
    }
}

#[test]
fn the_order_of_a_body_whose_inertia_depends_on_how_it_stands() {
    let J_d = NonstandardInertia::from_diagonal(Vector3::new(0.5, 0.4, 0.2)).unwrap();
    let top = SlidingTop { J_d, m: 1.1, g: 9.81, rho: Vector3::new(0.1, -0.2, 0.7), up: Vector3::z() };
    let attitude = SO3::from(UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.1, 0.0)));
    assert_claims_of_varying_inertia(&top, attitude, Vector3::new(0.4, 0.9, 3.0));
}

#[test]
fn the_order_of_two_bodies_whose_inertia_depends_on_each_other() {
    let turned = |axis: Vector3<f64>| SO3::from(UnitQuaternion::from_scaled_axis(axis));
    let attitudes = (turned(Vector3::new(0.8, 0.1, 0.0)), turned(Vector3::new(-0.3, 0.5, 0.2)));
    let momenta = Vector6::new(0.4, 0.3, 0.1, -0.1, 0.2, 0.3);
    assert_claims_of_varying_inertia(&DoublePendulum::asymmetric(), attitudes, momenta);
}
