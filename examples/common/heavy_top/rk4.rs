//! The classical Runge–Kutta method of order 4 on the equations of the top, in two sets of variables.
//!
//! Both integrate `Π' = Π × Ω + m g w × ρ` with `w = Rᵀ e₃`. They differ in the representation of the attitude, and in
//! the origin of the equations: those in quaternions are written by hand, the others derived.

use liestep::SO3;
use liestep::mechanics::{Term as _, inertia};
use liestep::motion::RightHandSide;
use nalgebra::{Matrix3, Matrix3x4, UnitQuaternion, Vector3};

use super::declaration::HeavyTop;
use crate::run::{EarlyEnd, Method, Sample};
use crate::runge_kutta::change;
use crate::top_equations::{Equations, State};

/// The body's constants in the right-hand side.
#[derive(Clone, Copy)]
pub struct Body {
    /// The inverses of the principal moments, 1/(kg m²).
    pub inverse_moments: Vector3<f64>,
    /// The lever `m g ρ`, J.
    pub lever: Vector3<f64>,
}

impl Body {
    /// The body and the weight of the declared top.
    pub fn of(top: &HeavyTop) -> Self {
        let inverse_moments = inertia(top, &top.advected()).diagonal().map(f64::recip);
        Self { inverse_moments, lever: top.rho * (top.m * top.g) }
    }
}

/// The method on a unit quaternion, normalised after every step, as a careful user would do it.
#[derive(Clone)]
pub struct OnQuaternion {
    equations: Equations,
    h: f64,
    state: State,
}

/// The method on the nine entries of `R`, whose orthogonality isn't enforced, as in the thesis, and on the momentum.
///
/// The equations are derived from the declared top.
#[derive(Clone)]
pub struct OnMatrix {
    system: RightHandSide<HeavyTop>,
    h: f64,
    state: Matrix3x4<f64>,
}

fn joined(attitude: &Matrix3<f64>, momentum: &Vector3<f64>) -> Matrix3x4<f64> {
    Matrix3x4::from_fn(|i, j| if j < 3 { attitude[(i, j)] } else { momentum[i] })
}

fn apart(state: &Matrix3x4<f64>) -> (Matrix3<f64>, Vector3<f64>) {
    (state.fixed_columns::<3>(0).into(), state.column(3).into())
}

impl OnQuaternion {
    pub fn new(body: Body, h: f64, attitude: &UnitQuaternion<f64>, momentum: Vector3<f64>) -> Self {
        let (q, p) = (attitude.quaternion(), momentum);
        let state = [q.w, q.i, q.j, q.k, p.x, p.y, p.z];
        Self { equations: Equations::of(body.inverse_moments.into(), body.lever.into()), h, state }
    }
}

impl OnMatrix {
    pub fn new(top: &HeavyTop, h: f64, attitude: &UnitQuaternion<f64>, momentum: Vector3<f64>) -> Self {
        let system = RightHandSide::new(top.clone()).expect("a regular inertia");
        Self { system, h, state: joined(attitude.to_rotation_matrix().matrix(), &momentum) }
    }
}

impl Method for OnQuaternion {
    fn advance(&mut self, steps: u64) -> Result<u64, EarlyEnd> {
        for _ in 0..steps {
            self.state = self.equations.rk4_step(self.h, &self.state);
        }
        Ok(0)
    }

    fn sample(&self) -> Sample {
        let [.., p1, p2, p3] = self.state;
        Sample { attitude: self.equations.end(&self.state).0, momentum: Vector3::new(p1, p2, p3) }
    }
}

impl Method for OnMatrix {
    fn advance(&mut self, steps: u64) -> Result<u64, EarlyEnd> {
        for _ in 0..steps {
            self.state += change(self.state, self.h, |y| {
                let (attitude, momentum) = apart(&y);
                let rates = self.system.rates(&SO3::from_matrix_unchecked(attitude), &momentum);
                let (turn, torque) = rates.expect("an inertia that is regular anywhere");
                joined(&turn, &torque)
            });
        }
        Ok(0)
    }

    fn sample(&self) -> Sample {
        let (attitude, momentum) = apart(&self.state);
        Sample { attitude, momentum }
    }
}
