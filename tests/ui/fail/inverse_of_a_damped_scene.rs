use liestep::effects::RigidBody;
use liestep::{CayleyRetraction, Effect, Parts, SO3, SetupError, Stepper, Sum, WithoutKinetic};
use nalgebra::{Matrix3, Vector3};

#[derive(Clone)]
struct Drag;

impl Effect for Drag {
    type Scalar = f64;
    type Group = SO3;
    type Retraction = CayleyRetraction;
    type Kinetic = WithoutKinetic;
    type Advected = ();
    type Constants = ();
    type StepTerms = ();
    const PARTS: Parts = Parts::ALL;
    const DERIVATION: &'static str = "";
    fn validate(&self) -> Result<(), SetupError> { todo!() }
    fn advected(&self) {}
    fn momentum_jacobian(&self, _: &Matrix3<f64>, _: &(), _: f64) -> Matrix3<f64> { todo!() }
    fn inertia(&self) -> Matrix3<f64> { todo!() }
    fn momentum_bias(&self, _: &()) -> Vector3<f64> { todo!() }
    fn potential(&self, _: &()) -> f64 { todo!() }
    fn constants(&self, _: f64) {}
    fn kick_before(_: &(), _: &()) -> Vector3<f64> { todo!() }
    fn step_terms(_: &(), _: &Vector3<f64>, _: &()) {}
    fn newton_system(_: &(), _: &(), _: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) { todo!() }
    fn kick_after(_: &(), _: &Matrix3<f64>, _: &()) -> Vector3<f64> { todo!() }
}

fn claim(damped: &Stepper<Sum<RigidBody, Drag>>) {
    let _ = damped.inverse();
}

fn main() {}
