//! Systems of many bodies: terms on one body and on two, at their places.

use checks::drift::tenths;
use checks::structure::momenta::assert_momenta;
use declarations::Alike;
use declarations::motions::{matrix, number, read, vector};
use liestep::effects::{CayleyBody, Gravity, PrincipalBody, Spring};
use liestep::groups::LieGroup;
use liestep::mechanics::{
    Along, Between, DiagonalNonstandardInertia, DiscreteLagrangian, Each, Effect as _, Inertia, On, Pairs, Regular,
    Term as _,
};
use liestep::methods::CompositionScheme;
use liestep::motion::Motion;
use liestep::numbers::Bodies;
use liestep::{SO3, SetupError, Stepper};
use nalgebra::{SVector, Vector3};

use super::declared::CoupledAttitudes;
use super::{all, apart, array, attitudes_of, momentum, order, stacked, started};

fn principal(J: [f64; 3]) -> PrincipalBody {
    PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(J.into()).unwrap() }
}

/// Four bodies of the reference, and the coupling of neighbours.
fn parts() -> ([PrincipalBody; 4], f64) {
    let data = &read("several bodies")["coupled_attitudes4"]["parameters"];
    let body = |a: usize| principal([0, 1, 2].map(|k| data["J"][a][k].as_f64().unwrap()));
    ([0, 1, 2, 3].map(body), data["kappa"].as_f64().unwrap())
}

/// The bodies in a row.
fn row() -> impl DiscreteLagrangian<Scalar = f64, Group = [SO3; 4], Advected: 'static> + Regular + Clone {
    let (bodies, kappa) = parts();
    Each::<4>::of(bodies) + Along::<4>::of([Alike { kappa }])
}

fn whole<A: liestep::groups::Advected<[SO3; N]>, const N: usize>(state: &Motion<[SO3; N], A>) -> Vector3<f64> {
    state.spatial_momentum().0.iter().sum()
}

/// A step agrees to rounding with one of 30 digits: as a system, and as one declaration, in which each body is solved
/// separately.
#[test]
fn golden_step() {
    let golden = &read("several bodies")["golden steps"]["coupled_attitudes4"];
    let (h, start): (_, [SO3; 4]) = (number(&golden["h"]), array(attitudes_of(&golden["R0"])));
    let stepper = Stepper::new(row(), h).unwrap();
    let mut state = stepper.start_with_momentum(start, Bodies(array(all(&golden["mu0"], vector)))).unwrap();
    stepper.step(&mut state).unwrap();
    let (bodies, kappa) = parts();
    let [J_1, J_2, J_3, J_4] = bodies.map(|body| body.J_d);
    let declared = Stepper::new(CoupledAttitudes { J_1, J_2, J_3, J_4, kappa }, h).unwrap();
    let together: (SO3, SO3, SO3, SO3) = start.into();
    let mut other = declared.start_with_momentum(together, momentum(&golden["mu0"])).unwrap();
    declared.step(&mut other).unwrap();
    let expected: SVector<f64, 12> = momentum(&golden["mu1"]);
    for (attitudes, found) in
        [(state.attitude(), stacked(&state.momentum().0)), (other.attitude().into(), other.momentum())]
    {
        let errors = [apart(&attitudes, &attitudes_of(&golden["R1"])), (found - expected).norm() / expected.norm()];
        println!("{errors:?}");
        assert!(errors.iter().all(|&error| error < 1e-14), "{errors:?}");
    }
    assert_eq!(CoupledAttitudes::FACTS.apart, <(SO3, SO3, SO3, SO3) as LieGroup>::FACTORS);
}

/// The order, and the total momentum in space; compositions work as with one body.
#[test]
fn trajectory() {
    let states = &read("several bodies")["coupled_attitudes4"]["states"];
    let start: [SO3; 4] = array(all(&states[0]["bodies"], |body| SO3::try_from(matrix(&body["R"])).unwrap()));
    let velocity = Bodies(array(all(&states[0]["bodies"], |body| vector(&body["Omega_body"]))));
    let end = all(&states[1]["bodies"], |body| (matrix(&body["R"]), vector(&body["Omega_body"])));
    let error = |attitude: &[SO3; 4], velocity: &Bodies<Vector3<f64>, 4>| {
        (attitude[3].as_matrix() - end[3].0).norm() + (velocity.0[1] - end[1].1).norm()
    };
    let errors = [(0.02, 100), (0.01, 200), (0.005, 400)].map(|(h, steps)| {
        let (stepper, mut state) = started(row(), h, (start, velocity));
        let before = whole(&state);
        stepper.run(&mut state, steps).unwrap();
        assert!((whole(&state) - before).norm() < 1e-12);
        error(&state.attitude(), &stepper.velocity(&state))
    });
    order(&errors);
    let composed = Stepper::composed(row(), 0.02, CompositionScheme::KAHAN_LI_8).unwrap();
    let mut state = composed.start(start, velocity).unwrap();
    composed.run(&mut state, 100).unwrap();
    assert!(error(&state.attitude(), &composed.velocity(&state)) < 1e-8);
}

/// A body without a coupling moves as it would alone.
#[test]
fn bodies_that_are_not_coupled_move_as_alone() {
    let (m, g, up) = (1.3, 9.81, Vector3::z());
    let gravity = |k: f64| Gravity { m, g, rho: Vector3::new(0.1 * k, 0.2, 0.3), up };
    let bodies = [principal([2.0, 3.0, 4.0]), principal([1.0, 1.5, 2.0]), principal([5.0, 4.0, 3.0])];
    let spring = Spring { k: 2.0, length: 0.5, at: Vector3::new(0.1, 0.3, 0.2), anchor: Vector3::new(0.4, 0.1, 1.0) };
    let system = Each::<3>::of(bodies) + Each::<3>::of([gravity(1.0), gravity(2.0), gravity(3.0)]);
    let together = Stepper::new(system + On::<1, 3>::of([spring]), 0.01).unwrap();
    let attitudes = [0.1, 0.2, 0.3].map(|angle| SO3::from_euler_angles(angle, 0.7, -angle));
    let velocities = [Vector3::new(1.0, 2.0, 3.0), Vector3::new(-0.1, 0.2, 0.3), Vector3::new(0.0, 0.5, 2.0)];
    let mut state = together.start(attitudes, Bodies(velocities)).unwrap();
    together.run(&mut state, 200).unwrap();
    for (k, (times, stiffness)) in [(1.0, 0.0), (2.0, spring.k), (3.0, 0.0)].into_iter().enumerate() {
        let held = bodies[k] + gravity(times) + Spring { k: stiffness, ..spring };
        let (alone, mut one) = started(held, 0.01, (attitudes[k], velocities[k]));
        alone.run(&mut one, 200).unwrap();
        assert!(apart(&[one.attitude()], &state.attitude()[k..=k]) < 1e-13, "{k}");
        assert!((state.momentum().0[k] - one.momentum()).norm() < 1e-12, "{k}");
    }
}

/// Pairs of three bodies along the row and between its ends are all pairs.
#[test]
fn pairs_are_what_is_between_each_two() {
    let bodies = Each::<3>::of([principal([2.0, 3.0, 4.0]), principal([1.0, 1.5, 2.0]), principal([5.0, 4.0, 3.0])]);
    let alike = [Alike { kappa: 3.0 }];
    let ring = Stepper::new(bodies + Along::<3>::of(alike) + Between::<0, 2, 3>::of(alike), 0.01).unwrap();
    let pairs = Stepper::new(bodies + Pairs::<3>::of(alike), 0.01).unwrap();
    let attitudes = [0.1, 0.5, -0.4].map(|angle| SO3::from_euler_angles(angle, 0.7, -angle));
    let velocities = Bodies([Vector3::new(1.0, 2.0, 3.0), Vector3::zeros(), Vector3::new(0.0, 0.5, 2.0)]);
    let (mut first, mut second) =
        (ring.start(attitudes, velocities).unwrap(), pairs.start(attitudes, velocities).unwrap());
    let (before, energy) = (whole(&first), ring.energy(&first));
    assert!((pairs.energy(&second) - energy).abs() < 1e-13 * energy.abs());
    ring.run(&mut first, 500).unwrap();
    pairs.run(&mut second, 500).unwrap();
    assert!(apart(&first.attitude(), &second.attitude()) < 1e-12);
    assert!((whole(&first) - before).norm() < 1e-12 && (whole(&second) - before).norm() < 1e-12);
    let (alone, mut free) = started(bodies, 0.01, (attitudes, velocities));
    alone.run(&mut free, 500).unwrap();
    assert!(apart(&first.attitude(), &free.attitude()) > 1e-2, "the bodies don't feel each other");
}

/// A system for any number of bodies is valid for one, too: there is no pair.
#[test]
fn one_body_has_no_pair() {
    let body = Each::<1>::of([principal([2.0, 3.0, 4.0])]);
    let alone = Stepper::new(body, 0.05).unwrap();
    let paired = Stepper::new(body + Pairs::<1>::of([Alike { kappa: 3.0 }]), 0.05).unwrap();
    let start = ([SO3::from_euler_angles(0.1, 0.7, -0.2)], Bodies([Vector3::new(1.0, 2.0, 3.0)]));
    let (mut one, mut other) = (alone.start(start.0, start.1).unwrap(), paired.start(start.0, start.1).unwrap());
    alone.run(&mut one, 100).unwrap();
    paired.run(&mut other, 100).unwrap();
    assert!(one.attitude() != start.0);
    let [one, other] = [
        (one.attitude(), one.momentum(), alone.energy(&one)),
        (other.attitude(), other.momentum(), paired.energy(&other)),
    ];
    assert_eq!(one, other);
}

/// Terms whose momentum equations have different powers of `1 + |y|²` are raised to one power body by body, each with
/// its own `y`.
#[test]
fn unlike_denominators() {
    const { assert!(CayleyBody::<f64>::FACTS.denominators != PrincipalBody::<f64>::FACTS.denominators) };
    let bodies = [principal([2.0, 3.0, 4.0]), principal([1.0, 1.5, 2.0])];
    let more = [[0.4, 0.5, 0.6], [1.0, 0.7, 0.9]];
    let more = more.map(|J| CayleyBody { J: Inertia::from_principal_moments(Vector3::from(J)).unwrap() });
    let together = Stepper::new(Each::<2>::of(bodies) + Each::<2>::of(more), 0.05).unwrap();
    let attitudes = [0.1, 0.2].map(|angle| SO3::from_euler_angles(angle, 0.7, -angle));
    let velocities = [Vector3::new(1.0, 2.0, 3.0), Vector3::new(-4.0, 0.2, 1.3)];
    let mut state = together.start(attitudes, Bodies(velocities)).unwrap();
    together.run(&mut state, 100).unwrap();
    for k in 0..2 {
        let (alone, mut one) = started(bodies[k] + more[k], 0.05, (attitudes[k], velocities[k]));
        alone.run(&mut one, 100).unwrap();
        let errors =
            [apart(&[one.attitude()], &state.attitude()[k..=k]), (state.momentum().0[k] - one.momentum()).norm()];
        println!("{k}: {errors:?}");
        assert!(errors.iter().all(|&error| error < 1e-12), "{k}: {errors:?}");
    }
}

/// Momentum maps, diamond and momentum equation are derivatives of the sum of the declared terms.
#[test]
fn what_is_put_at_places_is_derived_there() {
    let bodies = Each::<3>::of([principal([2.0, 3.0, 4.0]), principal([1.0, 1.5, 2.0]), principal([5.0, 4.0, 3.0])]);
    let (kappa, other) = ([Alike { kappa: 3.0 }], [Alike { kappa: 1.0 }, Alike { kappa: 2.0 }]);
    let l = bodies + Along::<3>::of(other) + Between::<2, 0, 3>::of(kappa) + Pairs::<3>::of(kappa);
    assert_momenta(&l, 9);
}

/// Over a million steps the energy stays within its bounds and doesn't drift, and the total momentum is conserved to
/// rounding.
#[test]
fn energy_and_momentum_of_a_million_steps() {
    let states = &read("several bodies")["coupled_attitudes4"]["states"];
    let start: [SO3; 4] = array(all(&states[0]["bodies"], |body| SO3::try_from(matrix(&body["R"])).unwrap()));
    let velocity = Bodies(array(all(&states[0]["bodies"], |body| vector(&body["Omega_body"]))));
    let (stepper, mut state) = started(row(), 0.01, (start, velocity));
    let (before, energy) = (whole(&state), stepper.energy(&state));
    let (means, most) = tenths(|| {
        stepper.run(&mut state, 10).unwrap();
        stepper.energy(&state) - energy
    });
    let spread = means.iter().fold(0.0_f64, |spread, mean| spread.max((mean - means[0]).abs()));
    let momentum = (whole(&state) - before).norm() / before.norm();
    println!("energy {energy}: within {most:.1e}, means apart by {spread:.1e}; momentum {momentum:.1e}");
    assert!(most < 1e-3 * energy.abs() && spread < 0.1 * most, "{most} {means:?}");
    assert!(momentum < 2e-13);
}

/// An invalid start is an error, and so is a step too long; the state stays.
#[test]
fn errors() {
    let bodies = Each::<2>::of([principal([2.0, 3.0, 4.0]), principal([1.0, 1.5, 2.0])]);
    let scene = bodies + Along::<2>::of([Alike { kappa: 1.0 }]);
    assert!(matches!(Stepper::new(scene, f64::NAN), Err(SetupError::InvalidStep { .. })));
    let broken = bodies + Along::<2>::of([Alike { kappa: f64::NAN }]);
    assert!(matches!(Stepper::new(broken, 0.01), Err(SetupError::Parameter { field: "kappa", .. })));
    // An invalid parameter of one of several terms names its body.
    let weight = |m: f64| Gravity { m, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let of_second = |result: Result<(), SetupError>| matches!(result, Err(SetupError::BodyParameter { body: 1, .. }));
    assert!(of_second(Each::<2>::of([weight(1.0), weight(f64::NAN)]).validate()));
    assert!(of_second(On::<1, 2>::of([weight(f64::NAN)]).validate()));
    assert!(matches!(Each::<2>::of([weight(f64::NAN)]).validate(), Err(SetupError::Parameter { .. })));
    // If a velocity isn't determined, the error names the body.
    let alone = On::<0, 2>::of([principal([2.0, 3.0, 4.0])]) + Along::<2>::of([Alike { kappa: 1.0 }]);
    let error = Stepper::new(alone, 0.01).map(|_| ()).unwrap_err();
    assert!(matches!(error, SetupError::SingularKinetic { body: Some(1), .. }), "{error}");
    let stepper = Stepper::new(scene, 0.1).unwrap();
    let fast = Bodies([Vector3::zeros(), Vector3::new(0.0, 0.0, 100.0)]);
    let mut state = stepper.start([SO3::identity(); 2], fast).unwrap();
    let before = state;
    let error = stepper.step(&mut state).unwrap_err();
    assert!(matches!(error, liestep::StepError::BeyondSolvable { .. }), "{error:?}");
    assert_eq!(state, before);
    // Two bodies whose blocks have negative determinants don't compensate each other.
    let both = Bodies([Vector3::new(0.0, 0.0, 100.0); 2]);
    assert!(stepper.step(&mut stepper.start([SO3::identity(); 2], both).unwrap()).is_err());
}
