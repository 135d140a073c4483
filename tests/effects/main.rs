//! Scenes: sums of Lagrangians and forces, the effects of the library, changes during a run.

mod changing_scenes;
mod control;
mod driven;
mod forces;
mod kinetic_terms;
mod library;
mod nonholonomic;
mod placed;
mod sums;

use liestep::effects::{Gravity, RigidBody};
use liestep::groups::Advected;
use liestep::mechanics::Regular;
use liestep::motion::Motion;
use liestep::{NonstandardInertia, SO3, StateOf, Stepper};
use nalgebra::{UnitQuaternion, Vector3};
use workbench::measure::relative;

fn body() -> RigidBody {
    RigidBody { J_d: NonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).unwrap() }
}

fn gravity() -> Gravity {
    Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.3, 0.2, 0.4), up: Vector3::z() }
}

fn started<L: Regular<Scalar = f64, Group = SO3>>(scene: L, h: f64) -> (Stepper<L>, StateOf<L>) {
    let stepper = Stepper::new(scene, h).unwrap();
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.3, -0.2));
    let state = stepper.start(attitude, Vector3::new(0.5, -1.0, 3.0)).unwrap();
    (stepper, state)
}

/// The state after a number of steps from that start.
fn moved<L: Regular<Scalar = f64, Group = SO3>>(scene: L, h: f64, steps: u64) -> StateOf<L> {
    let (stepper, mut state) = started(scene, h);
    stepper.run(&mut state, steps).unwrap();
    state
}

/// The distance of attitude and momentum of two motions.
fn apart<A: Advected<SO3>, B: Advected<SO3>>(a: &Motion<SO3, A>, b: &Motion<SO3, B>) -> f64 {
    let attitude = (a.attitude().as_matrix() - b.attitude().as_matrix()).norm();
    attitude.max(relative(&a.momentum(), &b.momentum()))
}
