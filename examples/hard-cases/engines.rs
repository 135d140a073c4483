//! The updates of physics engines: body rates first, by one of three formulas, then the quaternion with the new rates.
//!
//! All integrate `J Ω' = JΩ × Ω` in the body frame. The quaternion turns by the exact rotation through `hΩ` and is
//! normalised, so they differ only in the gyroscopic term.

use liestep::effects::PrincipalBody;
use liestep::mechanics::{Term as _, inertia};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use workbench::run::{EarlyEnd, Method, Sample};

/// Principal moments, kg m², and their inverses.
#[derive(Clone, Copy)]
pub(crate) struct Moments {
    moments: Vector3<f64>,
    inverses: Vector3<f64>,
}

impl Moments {
    /// The moments of the declared body.
    pub(crate) fn of(body: &PrincipalBody) -> Self {
        let moments = inertia(body, &body.advected()).diagonal();
        Self { moments, inverses: moments.map(f64::recip) }
    }

    /// The momentum `JΩ`.
    pub(crate) fn momentum(&self, rates: &Vector3<f64>) -> Vector3<f64> {
        self.moments.component_mul(rates)
    }

    /// The rates `J⁻¹Π`.
    pub(crate) fn rates(&self, momentum: &Vector3<f64>) -> Vector3<f64> {
        self.inverses.component_mul(momentum)
    }
}

/// The explicit update `Ω + h J⁻¹(JΩ × Ω)`, with the torque of the old rates.
pub(crate) fn explicit(body: &Moments, rates: &Vector3<f64>, h: f64) -> Vector3<f64> {
    rates + body.rates(&body.momentum(rates).cross(rates)) * h
}

/// One Newton step from the old rates towards implicit Euler, `J(Ω⁺ − Ω) + h Ω⁺ × JΩ⁺ = 0`.
pub(crate) fn implicit(body: &Moments, rates: &Vector3<f64>, h: f64) -> Vector3<f64> {
    let momentum = body.momentum(rates);
    let j = Matrix3::from_diagonal(&body.moments);
    let jacobian = j + (rates.cross_matrix() * j - momentum.cross_matrix()) * h;
    let residual = rates.cross(&momentum) * h;
    // The symmetric part of the Jacobian is J, which is positive definite, at the rates of a reasonable step; if the
    // Jacobian is singular, the rates stay.
    jacobian.try_inverse().map_or(*rates, |inverse| rates - inverse * residual)
}

/// The explicit update, with the momentum rescaled to its length: energy may still drift, but is bounded.
pub(crate) fn rescaled(body: &Moments, rates: &Vector3<f64>, h: f64) -> Vector3<f64> {
    let next = explicit(body, rates, h);
    next * (body.momentum(rates).norm() / body.momentum(&next).norm())
}

/// A body with an update of its rates.
#[derive(Clone)]
pub(crate) struct Engine<U> {
    pub(crate) body: Moments,
    pub(crate) h: f64,
    pub(crate) attitude: UnitQuaternion<f64>,
    pub(crate) rates: Vector3<f64>,
    pub(crate) update: U,
}

impl<U: Fn(&Moments, &Vector3<f64>, f64) -> Vector3<f64> + Clone> Method for Engine<U> {
    fn advance(&mut self, steps: u64) -> Result<u64, EarlyEnd> {
        for _ in 0..steps {
            self.rates = (self.update)(&self.body, &self.rates, self.h);
            let turned = self.attitude * UnitQuaternion::from_scaled_axis(self.rates * self.h);
            self.attitude = UnitQuaternion::new_normalize(turned.into_inner());
        }
        Ok(0)
    }

    fn sample(&self) -> Sample {
        let attitude = self.attitude.to_rotation_matrix().into_inner();
        Sample { attitude, momentum: self.body.momentum(&self.rates) }
    }
}
