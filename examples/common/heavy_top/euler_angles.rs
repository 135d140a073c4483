//! The symmetric top in Euler angles, \[RDAE, section 3.1\]: a rival with a singularity where the axis is vertical.

use liestep::mechanics::{Term as _, inertia};
use nalgebra::{Matrix3, Rotation3, Vector3, Vector6};

use super::declaration::HeavyTop;
use crate::run::{EarlyEnd, Method, Sample};
use crate::runge_kutta::change;

/// Angles and their rates: precession `φ`, nutation `θ`, spin `ψ`, applied about `z`, `x'` and `z''`.
#[derive(Clone, Copy, Debug)]
pub struct EulerAngles {
    /// The angles, rad.
    pub angles: Vector3<f64>,
    /// The rates, rad/s.
    pub rates: Vector3<f64>,
}

impl EulerAngles {
    /// The angles and rates for an attitude and a body velocity. If the axis is vertical only the sum of the first and
    /// the last is determined, and the rates aren't finite.
    pub fn of(attitude: &Matrix3<f64>, velocity: &Vector3<f64>) -> Self {
        let (w, axis) = (attitude.row(2), attitude.column(2));
        let sine = w[0].hypot(w[1]);
        let angles = Vector3::new(axis[0].atan2(-axis[1]), sine.atan2(w[2]), w[0].atan2(w[1]));
        let (precession, nutation) =
            ((velocity.x * w[0] + velocity.y * w[1]) / (sine * sine), (velocity.x * w[1] - velocity.y * w[0]) / sine);
        Self { angles, rates: Vector3::new(precession, nutation, velocity.z - precession * w[2]) }
    }

    /// The attitude `R_z(φ) R_x(θ) R_z(ψ)`: (3.1) and the spin.
    pub fn attitude(&self) -> Matrix3<f64> {
        let about = |axis, angle| Rotation3::from_axis_angle(&axis, angle).into_inner();
        let [z, x] = [Vector3::z_axis(), Vector3::x_axis()];
        about(z, self.angles.x) * about(x, self.angles.y) * about(z, self.angles.z)
    }

    /// The velocity by (3.2) to (3.4), in the frame that doesn't take part in the spin.
    pub fn velocity_without_spin(&self) -> Vector3<f64> {
        let ((sine, cosine), rates) = (self.angles.y.sin_cos(), self.rates);
        Vector3::new(rates.y, rates.x * sine, rates.z + rates.x * cosine)
    }

    /// The velocity of the body in its own frame, rad/s.
    pub fn velocity(&self) -> Vector3<f64> {
        Rotation3::from_axis_angle(&Vector3::z_axis(), -self.angles.z) * self.velocity_without_spin()
    }
}

/// The moments `I_0` and `I` in kg m² and the weight `m g ρ` in N m, of (3.5) and (3.9).
#[derive(Clone, Copy, Debug)]
pub struct SymmetricTop {
    pub across: f64,
    pub along: f64,
    pub weight: f64,
}

impl SymmetricTop {
    /// The constants of a top with equal first two moments and its centre of mass on the third axis.
    pub fn of(top: &HeavyTop) -> Self {
        let moments = inertia(top, &top.advected()).diagonal();
        Self { across: moments.x, along: moments.z, weight: top.m * top.g * top.rho.z }
    }

    /// The accelerations `φ''`, `θ''`, `ψ''` by (3.10) to (3.12).
    pub fn accelerations(&self, EulerAngles { angles, rates }: &EulerAngles) -> Vector3<f64> {
        let Self { across, along, weight } = *self;
        let (sine, cosine) = angles.y.sin_cos();
        let spin = along * (rates.x * cosine + rates.z);
        let nutation = (weight * sine - spin * rates.x * sine) / across + rates.x * rates.x * sine * cosine;
        let precession = (spin * rates.y / across - 2.0 * rates.x * rates.y * cosine) / sine;
        Vector3::new(precession, nutation, rates.x * rates.y * sine - precession * cosine)
    }

    fn momentum(&self, velocity: &Vector3<f64>) -> Vector3<f64> {
        velocity.component_mul(&Vector3::new(self.across, self.across, self.along))
    }
}

/// The classical Runge–Kutta method on (3.10) to (3.12).
#[derive(Clone)]
pub struct OnEulerAngles {
    top: SymmetricTop,
    h: f64,
    /// The angles, then the rates.
    state: Vector6<f64>,
}

fn joined(EulerAngles { angles, rates }: &EulerAngles) -> Vector6<f64> {
    Vector6::from_fn(|i, _| if i < 3 { angles[i] } else { rates[i - 3] })
}

fn apart(state: &Vector6<f64>) -> EulerAngles {
    EulerAngles { angles: state.fixed_rows::<3>(0).into(), rates: state.fixed_rows::<3>(3).into() }
}

impl OnEulerAngles {
    pub fn new(top: &HeavyTop, h: f64, attitude: &Matrix3<f64>, velocity: &Vector3<f64>) -> Self {
        Self { top: SymmetricTop::of(top), h, state: joined(&EulerAngles::of(attitude, velocity)) }
    }
}

impl Method for OnEulerAngles {
    fn advance(&mut self, steps: u64) -> Result<u64, EarlyEnd> {
        let top = self.top;
        for _ in 0..steps {
            self.state += change(self.state, self.h, |state| {
                let here = apart(&state);
                joined(&EulerAngles { angles: here.rates, rates: top.accelerations(&here) })
            });
        }
        Ok(0)
    }

    fn sample(&self) -> Sample {
        let here = apart(&self.state);
        Sample { attitude: here.attitude(), momentum: self.top.momentum(&here.velocity()) }
    }
}
