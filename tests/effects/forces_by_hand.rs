//! Forces fit into scenes as effects that aren't Lagrangians: viscous drag, written by hand.

use liestep::groups::CayleyRetraction;
use liestep::mechanics::{Effect, Limit, Parts, SceneVisitor, Sum, Term, WithoutKinetic};
use liestep::prelude::*;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// The torque `−c Ω`, by the discrete Lagrange–d'Alembert principle with `f⁻ = −(c − e) s` and `f⁺ = −e s` for
/// `s = ((F − Fᵀ)/2)^∨`, `e = (c/2)/(1 + y²)`, `y = (c h/2) tr J⁻¹`.
#[derive(Clone, Copy, Debug)]
struct Drag {
    c: f64,
    moments: Vector3<f64>,
}

/// `c`, `e` and `h/2`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Coefficients {
    both: f64,
    end: f64,
    half_step: f64,
}

/// `((F − Fᵀ)/2)^∨`, for `F` or `F − I`.
fn skew(f: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(f.m32 - f.m23, f.m13 - f.m31, f.m21 - f.m12) * 0.5
}

impl Term for Drag {
    type Scalar = f64;
    type Group = SO3;
    type Advected = ();

    fn validate(&self) -> Result<(), SetupError> {
        if self.c.is_finite() { Ok(()) } else { Err(SetupError::Parameter { field: "c", cause: "is not finite" }) }
    }

    fn advected(&self) {}
}

impl Effect for Drag {
    type Retraction = CayleyRetraction;
    type Kinetic = WithoutKinetic;
    type Constants = Coefficients;
    type StepTerms = (f64, Vector3<f64>);

    const PARTS: Parts = Parts { unknown: true, kick_before: false, kick_after: true };
    const DENOMINATORS: u32 = 1;
    const INERTIA_IS_CONSTANT: bool = true;
    const IS_QUADRATIC: bool = true;
    const DERIVATION: &'static str = "viscous drag, by hand";

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        visitor.term(Self::DERIVATION);
        visitor.parameter("c", self.c);
        self.moments.iter().for_each(|&moment| visitor.parameter("moments", moment));
    }

    /// `∂/∂E_j` of `(c − e) s`.
    fn momentum_jacobian(&self, f: &Matrix3<f64>, (): &(), h: f64) -> Matrix3<f64> {
        let Coefficients { both, end, .. } = self.constants(h);
        let moved = |j: usize| skew(&(Vector3::ith(j, 1.0).cross_matrix() * f)) * (both - end);
        Matrix3::from_columns(&[moved(0), moved(1), moved(2)])
    }

    fn limit(&self, velocity: Option<&Vector3<f64>>, (): &()) -> Limit<Self> {
        Limit::quadratic(velocity, Matrix3::zeros(), Vector3::zeros(), 0.0)
    }

    fn constants(&self, h: f64) -> Coefficients {
        let y = 0.5 * self.c * h * self.moments.map(f64::recip).sum();
        Coefficients { both: self.c, end: 0.5 * self.c / (1.0 + y * y), half_step: 0.5 * h }
    }

    fn kick_before(_: &Coefficients, (): &()) -> Vector3<f64> {
        Vector3::zeros()
    }

    fn step_terms(c: &Coefficients, a: &Vector3<f64>, (): &()) -> (f64, Vector3<f64>) {
        (2.0 * c.half_step * (c.both - c.end), a * c.half_step)
    }

    /// `−f⁻ = 2 (c − e) y/(1 + |y|²)`.
    fn newton_system(_: &Coefficients, (c, t): &(f64, Vector3<f64>), y: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let residual = y * *c - t * (1.0 + y.norm_squared());
        (residual, Matrix3::from_diagonal_element(*c) - t * y.transpose() * 2.0)
    }

    /// `Ad*_F f⁻ + f⁺`; `f⁻` is along the axis of `F`.
    fn kick_after(c: &Coefficients, increment: &Matrix3<f64>, (): &()) -> Vector3<f64> {
        skew(increment) * -c.both
    }
}

const MOMENTS: Vector3<f64> = Vector3::new(2.0, 3.0, 4.5);

fn body() -> RigidBody {
    RigidBody { J_d: NonstandardInertia::from_principal_moments(MOMENTS).unwrap() }
}

fn damped(c: f64, h: f64) -> Stepper<Sum<RigidBody, Drag>> {
    Stepper::new(body() + Drag { c, moments: MOMENTS }, h).unwrap()
}

const VELOCITY: Vector3<f64> = Vector3::new(1.0, 4.0, 0.5);

/// The library's drag is derived from its virtual work.
#[test]
fn derived_and_by_hand_agree() {
    let derived = liestep::effects::Drag { c: 0.7, J: body().J_d.to_inertia() };
    let (by_hand, derived) = (damped(0.7, 0.02), Stepper::new(body() + derived, 0.02).unwrap());
    let (mut a, mut b) = (
        by_hand.start(UnitQuaternion::identity(), VELOCITY).unwrap(),
        derived.start(UnitQuaternion::identity(), VELOCITY).unwrap(),
    );
    for _ in 0..500 {
        by_hand.step(&mut a).unwrap();
        derived.step(&mut b).unwrap();
        assert!((a.momentum() - b.momentum()).norm() < 1e-13);
        assert!((a.attitude().as_matrix() - b.attitude().as_matrix()).norm() < 1e-13);
    }
    assert!(a.momentum().norm() < 0.5 * (body().inertia(&()) * VELOCITY).norm());
}

/// `d|p|²/dt = −2c p·Ω`; about a principal axis the velocity decays like `exp(−ct/J)`, and the error is of order `h²`.
#[test]
fn a_spin_decays_to_second_order() {
    let error = |h: f64, steps: u32| {
        let stepper = damped(0.7, h);
        let mut state = stepper.start(UnitQuaternion::identity(), Vector3::new(0.0, 0.0, 2.0)).unwrap();
        for _ in 0..steps {
            stepper.step(&mut state).unwrap();
        }
        (state.momentum().z - 9.0 * (-0.7_f64 / 4.5 * 2.0).exp()).abs()
    };
    // Larger steps have errors of fourth order of the same size.
    let (coarse, fine) = (error(0.004, 500), error(0.002, 1000));
    println!("{coarse:e} {fine:e}");
    assert!((coarse / fine - 4.0).abs() < 0.1, "{coarse:e} {fine:e}");
}
