//! The same bodies placed in several ways: sums of terms whose unknown parts are at different bodies, in all orders.

use liestep::effects::RigidBody;
use liestep::groups::LieGroup as _;
use liestep::mechanics::On;
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, Stepper};
use nalgebra::Vector3;

fn rigid(moments: [f64; 3]) -> RigidBody {
    RigidBody { J_d: NonstandardInertia::from_principal_moments(moments.into()).unwrap() }
}

/// Two spheres at one radian per second each turn by one radian in a second.
#[test]
fn bodies_placed_one_by_one_turn_as_placed_together() {
    let b = rigid([1.0; 3]);
    let stepper = Stepper::new(On::<0, 2>::of([b]) + On::<1, 2>::of([b]), 0.01).unwrap();
    let mut s = stepper.start([SO3::identity(); 2], Bodies([Vector3::z(), Vector3::z()])).unwrap();
    stepper.run(&mut s, 100).unwrap();
    let turned = s.attitude().map(|attitude| attitude.log().norm());
    println!("{turned:?}");
    assert!(turned.iter().all(|turned| (turned - 1.0).abs() < 2e-5), "{turned:?}");
}
