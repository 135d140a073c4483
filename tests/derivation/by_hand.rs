//! The run-time half works without the macro: the heavy top (3.13) written by hand in Cayley form.

use liestep::accuracy::Accuracy;
use liestep::groups::CayleyRetraction;
use liestep::mechanics::{DiscreteLagrangian, Effect, Inertia, Limit, SceneVisitor, Term, WithKinetic};
use liestep::methods::{SplittingScheme, SymmetricBody};
use liestep::{NonstandardInertia, SO3, SetupError, Stepper};
use nalgebra::{Matrix3, Vector3};

#[derive(Clone, Debug)]
struct HandWrittenTop {
    inertia: NonstandardInertia,
    weight: f64,
    rho: Vector3<f64>,
}

fn hat(v: &Vector3<f64>) -> Matrix3<f64> {
    v.cross_matrix()
}

/// `(M − Mᵀ)^∨`.
fn skew(m: Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12)
}

impl HandWrittenTop {
    fn torque(&self, w: &Vector3<f64>) -> Vector3<f64> {
        w.cross(&self.rho) * self.weight
    }
}

impl DiscreteLagrangian for HandWrittenTop {
    const SELF_ADJOINT: bool = true;

    fn l_d(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> f64 {
        let d = f - Matrix3::identity();
        (d * self.inertia.as_matrix() * d.transpose()).trace() / (2.0 * h)
            - 0.5 * h * self.weight * w.dot(&(self.rho + f * self.rho))
    }

    fn right_momentum(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> Vector3<f64> {
        skew(f * self.inertia.as_matrix()) / h - (f * self.rho).cross(w) * (0.5 * h * self.weight)
    }

    fn left_momentum(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> Vector3<f64> {
        skew(self.inertia.as_matrix() * f) / h + self.torque(&(f.transpose() * w)) * (0.5 * h)
    }

    fn diamond(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> Vector3<f64> {
        w.cross(&(self.rho + f * self.rho)) * (0.5 * h * self.weight)
    }

    fn discrete_energy(&self, f: &Matrix3<f64>, w: &Vector3<f64>, h: f64) -> f64 {
        let d = f - Matrix3::identity();
        (d * self.inertia.as_matrix() * d.transpose()).trace() / (2.0 * h * h)
            + 0.5 * self.weight * w.dot(&(self.rho + f * self.rho))
    }
}

impl Term for HandWrittenTop {
    type Scalar = f64;
    type Group = SO3;
    type Advected = Vector3<f64>;

    fn validate(&self) -> Result<(), SetupError> {
        Ok(())
    }

    fn advected(&self) -> Vector3<f64> {
        Vector3::z()
    }
}

impl Effect for HandWrittenTop {
    type Retraction = CayleyRetraction;
    type Kinetic = WithKinetic;
    /// `J`, `(h/2) m g ρ`, `h/2`.
    type Constants = (Matrix3<f64>, Vector3<f64>, f64);
    /// `(h/2) a`.
    type StepTerms = Vector3<f64>;

    const DENOMINATORS: u32 = 1;
    const INERTIA_IS_CONSTANT: bool = true;
    const IS_QUADRATIC: bool = true;
    const DERIVATION: &'static str = "the heavy top (3.13), by hand";

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        visitor.term(Self::DERIVATION);
        self.inertia.as_matrix().iter().for_each(|&entry| visitor.parameter("inertia", entry));
        visitor.parameter("weight", self.weight);
        self.rho.iter().for_each(|&entry| visitor.parameter("rho", entry));
    }

    fn momentum_jacobian(&self, f: &Matrix3<f64>, _: &Vector3<f64>, h: f64) -> Matrix3<f64> {
        let p = f * self.inertia.as_matrix() / h;
        Matrix3::from_diagonal_element(p.trace()) - p
    }

    fn limit(&self, velocity: Option<&Vector3<f64>>, w: &Vector3<f64>) -> Limit<Self> {
        let inertia = *self.inertia.to_inertia().as_matrix();
        Limit::quadratic(velocity, inertia, Vector3::zeros(), self.weight * w.dot(&self.rho))
    }

    fn constants(&self, h: f64) -> Self::Constants {
        (*self.inertia.to_inertia().as_matrix(), self.rho * (0.5 * h * self.weight), 0.5 * h)
    }

    fn kick_before((_, lever, _): &Self::Constants, w: &Vector3<f64>) -> Vector3<f64> {
        w.cross(lever)
    }

    fn step_terms((.., half_step): &Self::Constants, a: &Vector3<f64>, _: &Vector3<f64>) -> Vector3<f64> {
        a * *half_step
    }

    fn newton_system((j, ..): &Self::Constants, t: &Vector3<f64>, y: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let jy = j * y;
        let residual = jy + y.cross(&jy) - t * (1.0 + y.norm_squared());
        let jacobian = j + hat(y) * j - hat(&jy) - t * y.transpose() * 2.0;
        (residual, jacobian)
    }

    fn kick_after((_, lever, _): &Self::Constants, _: &Matrix3<f64>, next: &Vector3<f64>) -> Vector3<f64> {
        next.cross(lever)
    }
}

#[test]
fn a_top_written_by_hand_steps_and_keeps_its_vertical_momentum() {
    let inertia = NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap();
    let top = HandWrittenTop { inertia, weight: 9.81, rho: Vector3::z() };
    let stepper = Stepper::new(top, 0.01).unwrap();
    let attitude = nalgebra::UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
    let velocity = Vector3::new(0.5, 3.0 * 0.8_f64.sin(), 10.0 + 3.0 * 0.8_f64.cos());
    let mut state = stepper.start(attitude, velocity).unwrap();
    let (momentum, energy) = (state.momentum_along(&Vector3::z()), stepper.energy(&state));
    let mut most = 0;
    for _ in 0..10_000 {
        most = most.max(stepper.step(&mut state).unwrap().iterations);
        assert!((stepper.energy(&state) - energy).abs() < 1e-2);
    }
    assert!(most <= 4, "{most} iterations");
    assert!((state.momentum_along(&Vector3::z()) - momentum).abs() < 1e-12);
    assert!(state.orthogonality_defect() < 1e-13);
}

/// What a kick's derivative isn't written for can be split, but not with force gradients.
#[test]
fn a_force_gradient_has_to_be_written() {
    let moments = Vector3::new(3.0, 3.0, 4.0);
    let top = HandWrittenTop {
        inertia: NonstandardInertia::from_diagonal(Vector3::new(2.0, 2.0, 1.0)).unwrap(),
        weight: 9.81,
        rho: Vector3::z(),
    };
    let body = SymmetricBody::new(&Inertia::from_principal_moments(moments).unwrap()).unwrap();
    let split = |scheme| Stepper::split(top.clone(), 0.01, body, scheme).map(|splitting| *splitting.plan().scheme());
    assert_eq!(split(SplittingScheme::NYSTROM_6), Ok(SplittingScheme::NYSTROM_6));
    assert_eq!(split(SplittingScheme::FORCE_GRADIENT_2), Err(SetupError::NoForceGradient));
    // Nor is it chosen.
    let accuracy = Accuracy { tolerance: 1e-4, horizon: 1.0 };
    let stepper = Stepper::for_accuracy(top, accuracy, SO3::identity(), Vector3::new(0.5, 2.0, 12.0)).unwrap();
    assert!(!stepper.choice().to_string().contains("force gradient"));
}
