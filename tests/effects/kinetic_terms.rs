//! The library's kinetic terms: each adds with the other effects, and has its order.

use checks::order;
use checks::random::Random;
use declarations::{CayleyTop, LogTop, Motion};
use liestep::effects::{CayleyBody, Drag, FourthOrderBody, GeodesicBody, Rotor, SixthOrderBody};
use liestep::mechanics::Regular;
use liestep::prelude::*;
use nalgebra::{UnitQuaternion, Vector3};
use workbench::measure::relative;

use super::{apart, gravity, moved};

fn tensor() -> Inertia {
    let axes = *Random::new(3).rotation().as_matrix();
    let principal = nalgebra::Matrix3::from_diagonal(&Vector3::new(2.0, 3.0, 4.5));
    Inertia::new(axes * principal * axes.transpose()).unwrap()
}

/// The sum of a body and gravity moves as the top declared in one piece.
#[test]
fn body_and_gravity_are_the_top() {
    let (J, Gravity { m, g, rho, up }) = (tensor(), gravity());
    let weight = m * g;
    let (cayley, geodesic) =
        (moved(CayleyBody { J } + gravity(), 0.01, 1000), moved(gravity() + GeodesicBody { J }, 0.01, 1000));
    let errors = [
        apart(&cayley, &moved(CayleyTop { J, weight, rho, up }, 0.01, 1000)),
        apart(&geodesic, &moved(LogTop { J, weight, rho, up }, 0.01, 1000)),
    ];
    println!("{errors:?}");
    assert!(errors.iter().all(|&error| error < 1e-11), "{errors:?}");
    // The two kinetic terms make different steps, or the test would show nothing.
    assert!(apart(&cayley, &geodesic) > 1e-6);
}

fn assert_order<L: Regular<Scalar = f64, Group = SO3>>(
    name: &str,
    expected: u32,
    span: (f64, f64),
    scene: impl Fn(Inertia) -> L,
) {
    order::assert_own_order(name, expected, span, |motion| scene(motion.top.ordinary_inertia()));
}

#[test]
fn a_free_body_is_of_its_order() {
    let name = "free flip";
    assert_order(name, 2, (10.0, 1.0 / 20.0), |J| CayleyBody { J });
    assert_order(name, 2, (10.0, 1.0 / 20.0), |J| GeodesicBody { J });
    assert_order(name, 4, (10.0, 1.0 / 20.0), |J| FourthOrderBody { J });
    let name = "free symmetric";
    assert_order(name, 6, (10.0, 1.0 / 5.0), |J| SixthOrderBody { J });
}

/// A potential at the two ends of a step is of second order with any body.
#[test]
fn a_heavy_body_is_of_second_order() {
    let name = "looping A";
    let top = Motion::read(name).top;
    let gravity = Gravity { m: top.m, g: top.g, rho: top.rho, up: top.up };
    assert_order(name, 2, (1.0, 1.0 / 100.0), |J| CayleyBody { J } + gravity);
    assert_order(name, 2, (1.0, 1.0 / 100.0), |J| GeodesicBody { J } + gravity);
    assert_order(name, 2, (1.0, 1.0 / 100.0), |J| FourthOrderBody { J } + gravity);
    assert_order(name, 2, (1.0, 1.0 / 100.0), |J| SixthOrderBody { J } + gravity);
}

/// Bodies add with a rotor and drag, whose terms are in the Newton system too; all kinetic terms agree in the limit of
/// small steps.
#[test]
fn bodies_add_with_what_is_in_the_unknown() {
    let J = tensor();
    let (rotor, weight, drag) = (Rotor { spin: Vector3::new(0.4, -0.3, 0.2) }, gravity(), Drag { c: 0.3, J });
    let expected = moved(RigidBody { J_d: J.to_nonstandard() } + rotor + weight + drag, 0.01, 100).momentum();
    let found = [
        moved(CayleyBody { J } + rotor + weight + drag, 0.01, 100).momentum(),
        moved(GeodesicBody { J } + rotor + weight + drag, 0.01, 100).momentum(),
        moved(FourthOrderBody { J } + rotor + weight + drag, 0.01, 100).momentum(),
        moved(SixthOrderBody { J } + rotor + weight + drag, 0.01, 100).momentum(),
    ]
    .map(|momentum| relative(&momentum, &expected));
    println!("{found:?}");
    assert!(found.iter().all(|&error| error < 2e-3), "{found:?}");
}

/// A body turns by 115° a step about a principal axis, where (3.13) has no solution beyond 90°.
#[test]
fn a_spin_may_turn_by_more_than_a_quarter_a_step() {
    fn turn<L: Regular<Scalar = f64, Group = SO3>>(scene: L) -> Option<f64> {
        let stepper = Stepper::new(scene, 0.1).unwrap();
        let mut state = stepper.start(SO3::identity(), Vector3::new(0.0, 0.0, 20.0)).unwrap();
        stepper.step(&mut state).ok()?;
        assert!((stepper.velocity(&state) - Vector3::new(0.0, 0.0, 20.0)).norm() < 1e-11);
        Some(UnitQuaternion::from_matrix(&state.attitude().matrix()).angle())
    }
    let moments = Vector3::new(2.0, 3.0, 4.5);
    let J = Inertia::from_principal_moments(moments).unwrap();
    let J_d = DiagonalNonstandardInertia::from_principal_moments(moments).unwrap();
    assert_eq!(turn(PrincipalBody { J_d }), None);
    // The momentum is p = Jθ/h, and (2/h) J tan(θ/2) (1 + tan²(θ/2)) in Cayley coordinates.
    let tangent = (0.5 * turn(CayleyBody { J }).unwrap()).tan();
    assert!((2.0 * tangent * (1.0 + tangent * tangent) - 2.0).abs() < 1e-12, "{tangent}");
    let turns = [turn(GeodesicBody { J }), turn(FourthOrderBody { J }), turn(SixthOrderBody { J })];
    println!("{turns:?}");
    assert!(turns.iter().all(|turn| turn.is_some_and(|turn| (turn - 2.0).abs() < 1e-12)), "{turns:?}");
}
