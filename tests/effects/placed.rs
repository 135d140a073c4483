//! Bodies of several kinds, placed one by one: sums of terms whose unknown parts belong to different bodies.

use checks::structure::stages::{assert_stages, assert_step};
use checks::structure::{System, norm};
use declarations::{Alike, FloatingBody};
use liestep::effects::{CayleyBody, FourthOrderBody, GeodesicBody, RigidBody, SixthOrderBody};
use liestep::groups::R3;
use liestep::mechanics::{Between, Coupling, Each, Effect as _, Inertia, On, Regular};
use liestep::methods::{Joint, Multibody, MultibodyStepper};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, StepError, Stepper, lagrangian};
use nalgebra::{Vector3, Vector6};

/// A kinetic term with a part of fourth order, whose Newton system has the square of the Cayley denominator.
#[lagrangian(
    group = SO3,
    l_d = m * (((F - I) * (F - I).transpose()).trace() + ((F - I) * (F - I).transpose()).trace().powi(2)) / h,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Quartic {
    m: f64,
}

fn rigid(moments: [f64; 3]) -> RigidBody {
    RigidBody { J_d: NonstandardInertia::from_principal_moments(moments.into()).unwrap() }
}

fn inertia(moments: [f64; 3]) -> Inertia {
    Inertia::from_principal_moments(moments.into()).unwrap()
}

/// The angles, rad, by which two bodies turn about their third axes in a second of a thousand steps.
fn turned<L: Regular<Scalar = f64, Group = [SO3; 2]>>(scene: L, rate: f64) -> [f64; 2] {
    let stepper = Stepper::new(scene, 1e-3).unwrap();
    let mut state = stepper.start([SO3::identity(); 2], Bodies([Vector3::z() * rate; 2])).unwrap();
    let mut turned = [0.0; 2];
    for _ in 0..1000 {
        let before = state.attitude();
        stepper.step(&mut state).unwrap();
        for (body, turned) in turned.iter_mut().enumerate() {
            *turned += before[body].inverse().compose(&state.attitude()[body]).log().z;
        }
    }
    turned
}

/// Spheres at one radian per second turn as (3.13) makes a sphere turn, by `θ` a step with `sin θ = hΩ`.
#[test]
fn two_spheres_turn_alike() {
    let sphere = rigid([1.0; 3]);
    let expected = 1e3 * 1e-3_f64.asin();
    let turned = turned(On::<0, 2>::of([sphere]) + On::<1, 2>::of([sphere]), 1.0);
    assert!(turned.iter().all(|turned| (turned - expected).abs() < 1e-12), "{turned:?}");
}

/// A wheel of 500 rad/s by steps of a millisecond, with each kinetic term. About a principal axis the momentum `J Ω` is one of
/// `θ` a step with `sin θ = hΩ` by (3.13), and `2x (1 + x²) = hΩ` for `x = tan(θ/2)` by that in Cayley coordinates; geodesics
/// are exact.
#[test]
fn a_fast_wheel_turns_as_its_kinetic_term_says() {
    let moments = [0.006, 0.006, 0.01];
    let (J, wheel) = (inertia(moments), rigid(moments));
    let x = (0..50).fold(0.25, |x: f64, _| x - (2.0 * x * (1.0 + x * x) - 0.5) / (2.0 + 6.0 * x * x));
    let [by_sine, by_tangent] = [1e3 * 0.5_f64.asin(), 2e3 * x.atan()];
    assert!((by_sine - 523.6).abs() < 0.01 && (by_tangent - 464.9).abs() < 0.01, "{by_sine} {by_tangent}");
    let found = [
        turned(On::<0, 2>::of([wheel]) + On::<1, 2>::of([GeodesicBody { J }]), 500.0),
        turned(On::<1, 2>::of([SixthOrderBody { J }]) + On::<0, 2>::of([CayleyBody { J }]), 500.0),
        turned(Each::<2>::of([FourthOrderBody { J }]), 500.0),
        turned(Each::<2>::of([FourthOrderBody { J }]), 2000.0), // by more than a right angle a step
    ];
    let expected = [[by_sine, 500.0], [by_tangent, 500.0], [500.0; 2], [2000.0; 2]];
    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
}

/// A potential that aligns the third axes of two bodies, at both ends of a step.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = 0.5 * h * k * (axis.dot(&(Q * axis)) + (F_1 * axis).dot(&(Q * (F_2 * axis)))),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct AxisAlignment {
    k: f64,
    axis: Vector3<f64>,
}

/// Two coupled bodies end with the velocity that a solver of order eight finds at a tolerance of 1e-12; a step of 2.5
/// ms conserves six digits of the energy.
#[test]
fn two_coupled_bodies_move_as_by_a_solver() {
    fn end<L: Regular<Scalar = f64, Group = [SO3; 2]>>(scene: L) -> (f64, Vector3<f64>) {
        let stepper = Stepper::new(scene, 0.0025).unwrap();
        let start = [SO3::identity(), SO3::exp(Vector3::y() * 0.5)];
        let velocity = Bodies([Vector3::new(0.3, 0.2, 1.0), Vector3::new(-0.5, 0.4, 0.1)]);
        let mut state = stepper.start(start, velocity).unwrap();
        stepper.run(&mut state, 4000).unwrap();
        (stepper.energy(&state), stepper.velocity(&state).0[0])
    }
    let (first, second, aligned) =
        (rigid([3.0, 2.5, 2.0]), rigid([1.1, 0.9, 0.5]), AxisAlignment { k: 3.0, axis: Vector3::z() });
    let between = Between::<0, 1, 2>::of([aligned]);
    let (one, other) = (On::<0, 2>::of([first]), On::<1, 2>::of([second]));
    let found =
        [end(one + other + between), end(Each::<2>::of([first, second]) + between), end(between + (other + one))];
    println!("{found:?}");
    for (energy, velocity) in found {
        assert!((energy - (1.397 - 3.0 * 0.5_f64.cos())).abs() < 5e-6);
        assert!((velocity - Vector3::new(-0.003_201, -0.487_492, 1.031_511)).norm() < 1e-5);
        assert!((velocity - found[1].1).norm() < 1e-12);
    }
}

/// A step whose terms are on different bodies, and of several kinds, has the momenta of the Lagrangian at both ends.
#[test]
fn a_step_has_the_momenta_of_all_terms() {
    fn check<L: System + Clone>(scene: &L) {
        assert_stages(scene, 5);
        assert_step(scene, &[1e-3, 0.1, 0.3], 6);
    }
    let (first, J) = (rigid([3.0, 2.5, 2.0]), inertia([1.1, 0.9, 0.5]));
    let alike = Between::<0, 1, 2>::of([Alike { kappa: 2.0 }]);
    check(&(On::<1, 2>::of([GeodesicBody { J }]) + On::<0, 2>::of([first])));
    check(&(On::<0, 2>::of([CayleyBody { J }]) + alike + On::<1, 2>::of([SixthOrderBody { J }])));
    check(
        &(On::<1, 2>::of([first])
            + Each::<2>::of([FourthOrderBody { J }, FourthOrderBody { J: first.J_d.to_inertia() }])),
    );
}

/// A potential `½ k (3 − tr Q)²` of the mean `Q` of the relative configurations at both ends of a step.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = -0.5 * h * k * (3.0 - 0.5 * (Q.trace() + (F_1.transpose() * Q * F_2).trace())).powi(2),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct SquaredPotential {
    k: f64,
}

/// Bodies whose Newton systems have cleared denominators are coupled in a row that is solved together.
#[test]
fn bodies_with_cleared_denominators_are_coupled() {
    const { assert!(RigidBody::<f64>::FACTS.denominators == 1 && GeodesicBody::<f64>::FACTS.denominators == 0) };
    let (body, J) = (rigid([3.0, 2.5, 2.0]), inertia([1.1, 0.9, 0.5]));
    let coupling = Coupling::<3>::of([SquaredPotential { k: 20.0 }]);
    let ends = On::<0, 3>::of([body]) + On::<2, 3>::of([body]);
    assert_step(&(ends + coupling + On::<1, 3>::of([GeodesicBody { J }])), &[1e-3, 0.1], 7);
    assert_step(&(coupling + Each::<3>::of([body])), &[1e-3, 0.1], 8);
}

/// Bodies with different denominators of their Newton systems, and a term with more, add in any order.
#[test]
fn bodies_with_different_denominators_add() {
    fn end<L: Regular<Scalar = f64, Group = [SO3; 2]>>(scene: L) -> Bodies<Vector3<f64>, 2> {
        let stepper = Stepper::new(scene, 0.1).unwrap();
        let velocity = Bodies([Vector3::new(0.3, 0.2, 1.0), Vector3::new(-0.5, 0.4, 0.1)]);
        let mut state = stepper.start([SO3::identity(), SO3::exp(Vector3::y() * 0.5)], velocity).unwrap();
        stepper.run(&mut state, 5).unwrap();
        state.momentum()
    }
    let (body, J, quartic) = (rigid([3.0, 2.5, 2.0]), inertia([1.1, 0.9, 0.5]), Each::<2>::of([Quartic { m: 0.4 }]));
    let (one, other) = (On::<0, 2>::of([body]), On::<1, 2>::of([GeodesicBody { J }]));
    let found = [end(one + other + quartic), end(quartic + other + one), end(other + quartic + one)];
    assert!(found.iter().all(|end| norm(&(*end - found[0])) < 1e-13), "{found:?}");
}

/// A body that turns along geodesics and is translated.
#[lagrangian(
    group(F = SO3, d = R3),
    l_d = {
        let xi = log(F);
        xi.dot(&(J * xi)) / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Geodesic {
    m: f64,
    J: Inertia,
}

/// A body that turns in Cayley coordinates and is translated.
#[lagrangian(
    group(F = SO3, d = R3),
    l_d = {
        let x = vee(F - F.transpose()) / (1.0 + F.trace());
        2.0 * x.dot(&(J * x)) / h + m * d.norm_squared() / (2.0 * h)
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cayley {
    m: f64,
    J: Inertia,
}

type Body = (SO3, R3);

/// Energy, J, linear momentum and angular momentum about the origin of two bodies.
fn conserved(stepper: &MultibodyStepper, state: &[f64]) -> Vec<f64> {
    let mut sums = Vector6::zeros();
    for body in 0..2 {
        let ((attitude, place), momentum) = (stepper.attitude(state, body), stepper.momentum(state, body));
        let [turning, linear] = [0, 3].map(|first| momentum.fixed_rows::<3>(first).into_owned());
        let angular = attitude.as_matrix() * turning + place.translation().cross(&linear);
        sums += Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z);
    }
    let mut kept = vec![stepper.energy(state)];
    kept.extend(&sums);
    kept
}

/// A hub and a rod of one metre on a ball joint move freely for ten seconds: the bodies at the end, and the errors of
/// the energy, J, and of the momenta.
fn hub_and_rod(make: impl Fn(&mut Multibody)) -> ([Body; 2], [f64; 2]) {
    let mut system = Multibody::new();
    make(&mut system);
    let joint = Joint::ball([Vector3::new(0.3, 0.0, 0.0), Vector3::new(-0.5, 0.0, 0.0)]);
    system.join(joint, Some(0), 1);
    let stepper = system.stepper(0.005).unwrap();
    let start = [Vector3::zeros(), Vector3::new(0.8, 0.0, 0.0)].map(|place| (SO3::identity(), R3::from(place)));
    let velocity = [Vector6::new(0.3, 0.2, 1.0, 0.0, 0.0, 0.0), Vector6::new(0.4, -0.6, 0.5, 0.0, 0.55, 0.0)];
    let mut state = stepper.start_nearest(&start, &velocity).unwrap();
    let before = conserved(&stepper, &state);
    stepper.run(&mut state, 2000).unwrap();
    let off: Vec<f64> =
        conserved(&stepper, &state).iter().zip(&before).map(|(after, before)| (after - before).abs()).collect();
    ([0, 1].map(|body| stepper.attitude(&state, body)), [off[0], off[1..].iter().copied().fold(0.0, f64::max)])
}

/// Bodies on a joint are the sums of their terms in any order, and conserve energy and momenta.
#[test]
fn a_joint_holds_bodies_that_are_placed_one_by_one() {
    let J = NonstandardInertia::from_principal_moments(Vector3::new(1.1, 0.9, 0.5)).unwrap();
    let thin = NonstandardInertia::from_principal_moments(Vector3::new(0.01, 0.09, 0.09)).unwrap();
    let (hub, rod) = (FloatingBody { m: 2.0, J_d: J }, FloatingBody { m: 1.0, J_d: thin });
    let (together, _) = hub_and_rod(|system| {
        system.body(hub);
        system.body(rod);
    });
    let half = FloatingBody { m: 0.5, J_d: NonstandardInertia::new(thin.as_matrix() * 0.5).unwrap() };
    let apart = [
        hub_and_rod(|system| {
            system.body(hub);
            system.body(half);
            system.on(1, half);
        }),
        hub_and_rod(|system| {
            system.on(1, half);
            system.body(hub);
            system.body(half);
        }),
    ];
    for (bodies, [energy, momenta]) in apart {
        let distance = bodies.iter().zip(&together).map(|(a, b)| (a.0.as_matrix() - b.0.as_matrix()).norm());
        let distance = distance.fold(0.0, f64::max);
        println!("{distance:e}, energy {energy:e}, momenta {momenta:e}");
        assert!(distance < 1e-10 && energy < 1e-3 && momenta < 1e-12);
    }
    // Kinetic terms of three kinds, another one on each body, have one continuous limit.
    let geodesic = Geodesic { m: 1.0, J: thin.to_inertia() };
    let (bodies, [energy, momenta]) = hub_and_rod(|system| {
        system.body(Cayley { m: 2.0, J: J.to_inertia() });
        system.body(geodesic);
    });
    let distance = (bodies[1].1.translation() - together[1].1.translation()).norm();
    println!("{distance:e}, energy {energy:e}, momenta {momenta:e}");
    assert!(distance < 1e-2 && energy < 1e-3 && momenta < 1e-12);
}

/// A wheel of 500 rad/s on a pin of a hub at rest turns by 500 rad in a second of a thousand steps, where (3.13) makes 523.6 of it.
#[test]
fn a_fast_wheel_on_a_pin_turns_by_geodesics() {
    let J = inertia([0.006, 0.006, 0.01]);
    let hub =
        FloatingBody { m: 2.0, J_d: NonstandardInertia::from_principal_moments(Vector3::new(1.1, 0.9, 0.5)).unwrap() };
    let axis = Vector3::z();
    let pin = Joint::pin([Vector3::x(), Vector3::zeros()], [axis; 2]);
    let mut system = Multibody::new();
    system.body(hub);
    system.body(Geodesic { m: 1.0, J });
    system.join(pin, Some(0), 1);
    let stepper = system.stepper(1e-3).unwrap();
    let start = [Vector3::zeros(), Vector3::x()].map(|place| (SO3::identity(), R3::from(place)));
    let still = Vector6::zeros();
    let mut state = stepper.start(&start, &[still, Vector6::z() * 500.0]).unwrap();
    let mut turned = 0.0;
    for _ in 0..1000 {
        let before = stepper.attitude(&state, 1).0;
        stepper.step(&mut state).unwrap();
        turned += before.inverse().compose(&stepper.attitude(&state, 1).0).log().z;
    }
    assert!((turned - 500.0).abs() < 1e-9, "{turned}");
    assert!((stepper.attitude(&state, 0).0.as_matrix() - nalgebra::Matrix3::identity()).norm() < 1e-12);
    // A step that turns a body on a joint by a right angle is refused.
    let mut faster = stepper.start(&start, &[still, Vector6::z() * 1600.0]).unwrap();
    assert!(matches!(stepper.step(&mut faster), Err(StepError::UnsolvedBody { body: 1, .. })));
}
