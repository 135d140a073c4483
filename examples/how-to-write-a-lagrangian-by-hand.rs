//! How to write a Lagrangian by hand, without the macro: the free rigid body (3.13), in Cayley form.
//!
//! ```text
//! cargo run -p liestep-examples --example how-to-write-a-lagrangian-by-hand
//! ```

use std::error::Error;

use liestep::effects::{Gravity, RigidBody};
use liestep::groups::CayleyRetraction;
use liestep::mechanics::{DiscreteLagrangian, Effect, Facts, Limit, Parts, SceneVisitor, Term, WithKinetic, inertia};
use liestep::nalgebra::{Matrix3, UnitQuaternion, Vector3};
use liestep::{NonstandardInertia, SO3, SetupError, Stepper};

#[derive(Clone, Debug)]
struct Body {
    inertia: NonstandardInertia,
}

/// The vector `(M − Mᵀ)^∨`.
fn skew(m: Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12)
}

/// The Lagrangian and its momenta, from which a step is derived and by which its properties are tested.
impl DiscreteLagrangian for Body {
    /// The Lagrangian `tr((F − I) J_d (F − I)ᵀ)/(2h)`.
    fn l_d(&self, f: &Matrix3<f64>, (): &(), h: f64) -> f64 {
        let d = f - Matrix3::identity();
        (d * self.inertia.as_matrix() * d.transpose()).trace() / (2.0 * h)
    }

    /// The derivative of `l_d(exp(s E_k) F)` at `s = 0`.
    fn right_momentum(&self, f: &Matrix3<f64>, (): &(), h: f64) -> Vector3<f64> {
        skew(f * self.inertia.as_matrix()) / h
    }

    /// The derivative of `l_d(F exp(s E_k))`.
    fn left_momentum(&self, f: &Matrix3<f64>, (): &(), h: f64) -> Vector3<f64> {
        skew(self.inertia.as_matrix() * f) / h
    }

    /// There are no advected parameters.
    fn diamond(&self, _: &Matrix3<f64>, (): &(), _: f64) -> Vector3<f64> {
        Vector3::zeros()
    }

    /// The energy `−∂l_d/∂h`.
    fn discrete_energy(&self, f: &Matrix3<f64>, w: &(), h: f64) -> f64 {
        self.l_d(f, w, h) / h
    }
}

impl Term for Body {
    type Scalar = f64;
    type Group = SO3;
    type Advected = ();

    fn validate(&self) -> Result<(), SetupError> {
        Ok(())
    }

    fn advected(&self) {}
}

/// The stages of a step; the documentation of the trait has their formulas.
impl Effect for Body {
    type Retraction = CayleyRetraction;
    type Kinetic = WithKinetic;
    /// The constants `J` and `h/2`.
    type Constants = (Matrix3<f64>, f64);
    /// The right-hand side `(h/2) a`.
    type StepTerms = Vector3<f64>;

    const FACTS: Facts = Facts {
        parts: Parts { unknown: true, kick_before: false, kick_after: false },
        denominators: 1,
        has_constant_inertia: true,
        is_quadratic: true,
        is_self_adjoint: true,
        ..Facts::ANY
    };
    const DERIVATION: &'static str = "the free rigid body (3.13), by hand";

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        visitor.term(Self::DERIVATION);
        self.inertia.as_matrix().iter().for_each(|&entry| visitor.parameter("inertia", entry));
    }

    fn momentum_jacobian(&self, f: &Matrix3<f64>, (): &(), h: f64) -> Matrix3<f64> {
        let p = f * self.inertia.as_matrix() / h;
        Matrix3::from_diagonal_element(p.trace()) - p
    }

    fn limit(&self, velocity: Option<&Vector3<f64>>, (): &()) -> Limit<Self> {
        Limit::quadratic(velocity, *self.inertia.to_inertia().as_matrix(), Vector3::zeros(), 0.0)
    }

    fn constants(&self, h: f64) -> Self::Constants {
        (inertia(self, &()), 0.5 * h)
    }

    fn kick_before(_: &Self::Constants, (): &()) -> Vector3<f64> {
        Vector3::zeros()
    }

    fn step_terms((_, half_step): &Self::Constants, a: &Vector3<f64>, (): &()) -> Vector3<f64> {
        a * *half_step
    }

    /// `(h/2) (1 + |y|²) (U(F) − a) = J y + y × J y − (1 + |y|²) (h/2) a`, and its derivative.
    fn newton_system((j, _): &Self::Constants, t: &Vector3<f64>, y: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let jy = j * y;
        let jacobian = j + y.cross_matrix() * j - jy.cross_matrix() - t * y.transpose() * 2.0;
        (jy + y.cross(&jy) - t * (1.0 + y.norm_squared()), jacobian)
    }

    fn kick_after(_: &Self::Constants, _: &Matrix3<f64>, (): &()) -> Vector3<f64> {
        Vector3::zeros()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let inertia = NonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5))?;
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.3, 0.2, 0.4), up: Vector3::z() };
    // The hand-written body adds with declared effects, and agrees with the body that the macro derives.
    let by_hand = Stepper::new(gravity + Body { inertia }, 0.01)?;
    let derived = Stepper::new(gravity + RigidBody { J_d: inertia }, 0.01)?;
    let (attitude, velocity) = (UnitQuaternion::from_scaled_axis(Vector3::x() * 0.8), Vector3::new(0.5, 1.0, 3.0));
    let (mut a, mut b) = (by_hand.start(attitude, velocity)?, derived.start(attitude, velocity)?);
    by_hand.run(&mut a, 1000)?;
    derived.run(&mut b, 1000)?;
    let difference = (a.momentum() - b.momentum()).norm();
    println!("after 10 s by hand and derived differ by {difference:.1e} kg m²/s");
    assert!(difference < 1e-11);
    Ok(())
}

#[test]
fn a_lagrangian_by_hand_steps() -> Result<(), Box<dyn Error>> {
    main()
}
