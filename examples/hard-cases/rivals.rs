//! Our method and others on the bodies of the rows.

use declarations::{FreeBody, HeavyTop, Motion};
use liestep::prelude::*;
use nalgebra::{UnitQuaternion, Vector3};
use workbench::heavy_top::rk4::{Body, OnMatrix, OnQuaternion};
use workbench::run::{EarlyEnd, Method, Sample};
use workbench::variational::Variational;

use crate::engines::{Engine, Moments, explicit, implicit, rescaled};
use crate::row::Failure;

/// A free body, its initial velocity and its step.
#[derive(Clone, Copy)]
pub(crate) struct Spin {
    pub(crate) inertia: DiagonalNonstandardInertia,
    /// The body velocity in the body frame, rad/s.
    pub(crate) velocity: Vector3<f64>,
    /// The step, s.
    pub(crate) h: f64,
}

/// The conserved quantities of a free body, at one time.
#[derive(Clone, Copy)]
pub(crate) struct Invariants {
    pub(crate) energy: f64,
    pub(crate) spatial: Vector3<f64>,
    pub(crate) velocity: Vector3<f64>,
}

/// The run of a method, step by step.
pub(crate) struct Trace {
    pub(crate) name: &'static str,
    pub(crate) kept: Vec<Invariants>,
}

impl Spin {
    pub(crate) fn body(&self) -> PrincipalBody {
        PrincipalBody { J_d: self.inertia }
    }

    /// The principal moments, kg m².
    pub(crate) fn moments(&self) -> Vector3<f64> {
        let d = self.inertia.diagonal();
        Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y)
    }

    /// The traces of the derived integrator, then of the engines' updates and of Runge–Kutta.
    pub(crate) fn traces(&self, steps: u64) -> Result<Vec<Trace>, Failure> {
        let (attitude, rates, h) = (UnitQuaternion::identity(), self.velocity, self.h);
        let stepper = Stepper::new(self.body(), h)?;
        let state = stepper.start(attitude, rates)?;
        let body = Moments::of(stepper.scene());
        let rk4 = Body { inverse_moments: self.moments().map(f64::recip), lever: Vector3::zeros() };
        let momentum = state.momentum();
        let engine = |update: Update| Engine { body, h, attitude, rates, update };
        Ok(vec![
            self.trace("variational", Variational { stepper: &stepper, state }, steps)?,
            self.trace("explicit", engine(explicit), steps)?,
            self.trace("implicit", engine(implicit), steps)?,
            self.trace("rescaled", engine(rescaled), steps)?,
            self.trace("RK4", OnQuaternion::new(rk4, h, &attitude, momentum), steps)?,
        ])
    }

    /// The trace of the same body with a full tensor of inertia.
    pub(crate) fn full(&self, steps: u64) -> Result<Trace, Failure> {
        let stepper = Stepper::new(FreeBody { J_d: self.inertia.into() }, self.h)?;
        let state = stepper.start(UnitQuaternion::identity(), self.velocity)?;
        Ok(self.trace("full tensor", Variational { stepper: &stepper, state }, steps)?)
    }

    fn trace(&self, name: &'static str, mut method: impl Method, steps: u64) -> Result<Trace, EarlyEnd> {
        let mut kept = vec![self.kept(&method.sample())];
        for _ in 0..steps {
            method.advance(1)?;
            kept.push(self.kept(&method.sample()));
        }
        Ok(Trace { name, kept })
    }

    fn kept(&self, Sample { attitude, momentum }: &Sample) -> Invariants {
        let velocity = momentum.component_div(&self.moments());
        Invariants { energy: 0.5 * velocity.dot(momentum), spatial: attitude * momentum, velocity }
    }
}

/// An update: the rates after a step from those before it.
pub(crate) type Update = fn(&Moments, &Vector3<f64>, f64) -> Vector3<f64>;

impl Trace {
    /// The largest relative error of the energy.
    pub(crate) fn energy_error(&self) -> f64 {
        let start = self.kept[0].energy;
        self.worst(|kept| (kept.energy / start - 1.0).abs())
    }

    /// The largest relative error of the spatial momentum.
    pub(crate) fn momentum_error(&self) -> f64 {
        let start = self.kept[0].spatial;
        self.worst(|kept| (kept.spatial - start).norm() / start.norm())
    }

    /// The ratio `E/E(0)` at the end.
    pub(crate) fn final_energy(&self) -> f64 {
        self.kept[self.kept.len() - 1].energy / self.kept[0].energy
    }

    pub(crate) fn worst(&self, size: impl Fn(&Invariants) -> f64) -> f64 {
        self.kept.iter().map(size).fold(0.0, workbench::measure::greater)
    }
}

/// The stepper (3.13) of a motion's top, and its initial state.
pub(crate) fn started(motion: &Motion, h: f64) -> Result<(Stepper<HeavyTop>, StateOf<HeavyTop>), Failure> {
    let stepper = Stepper::new(motion.top.clone(), h)?;
    let state = stepper.start(motion.attitude, motion.velocity)?;
    Ok((stepper, state))
}

/// Runge–Kutta on a motion, with the quaternion normalised after every step.
pub(crate) fn on_quaternion(motion: &Motion, h: f64) -> OnQuaternion {
    let body = Body::of(&motion.top);
    let momentum = motion.velocity.component_div(&body.inverse_moments);
    OnQuaternion::new(body, h, &motion.attitude.to_quaternion(), momentum)
}

/// Runge–Kutta on a motion, with the nine entries of `R`.
pub(crate) fn on_matrix(motion: &Motion, h: f64) -> OnMatrix {
    let momentum = motion.velocity.component_mul(&motion.top.moments());
    OnMatrix::new(&motion.top, h, &motion.attitude.to_quaternion(), momentum)
}

/// The energy of a top, J.
pub(crate) fn energy_of(top: &HeavyTop, Sample { attitude, momentum }: &Sample) -> f64 {
    let body = Body::of(top);
    0.5 * momentum.dot(&body.inverse_moments.component_mul(momentum)) + (attitude * body.lever).z
}
