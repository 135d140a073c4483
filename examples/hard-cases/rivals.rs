//! Other methods on the bodies of the rows.

use declarations::{FreeBody, HeavyTop, Motion};
use liestep::prelude::*;
use nalgebra::{UnitQuaternion, Vector3};
use plotters::style::RGBColor;
use workbench::heavy_top::rk4::{Body, OnMatrix, OnQuaternion};
use workbench::plot::{BLUE, GREEN, ORANGE, PURPLE};
use workbench::run::{Method, Sample, Stopped};
use workbench::variational::Variational;

use crate::engines::{Engine, Moments, explicit, implicit, rescaled};
use crate::row::Failure;

pub(crate) const GREY: RGBColor = RGBColor(120, 120, 120);

/// A free body, its start and its step.
#[derive(Clone, Copy)]
pub(crate) struct Spin {
    pub(crate) inertia: DiagonalNonstandardInertia,
    /// Body frame, rad/s.
    pub(crate) velocity: Vector3<f64>,
    /// s
    pub(crate) h: f64,
}

/// What is conserved of a free body, at one time.
#[derive(Clone, Copy)]
pub(crate) struct Kept {
    pub(crate) time: f64,
    pub(crate) energy: f64,
    pub(crate) spatial: Vector3<f64>,
    pub(crate) velocity: Vector3<f64>,
}

/// The run of a method, sampled.
pub(crate) struct Trace {
    pub(crate) name: &'static str,
    pub(crate) colour: RGBColor,
    pub(crate) kept: Vec<Kept>,
}

impl Spin {
    pub(crate) fn body(&self) -> PrincipalBody {
        PrincipalBody { J_d: self.inertia }
    }

    /// Principal moments, kg m².
    pub(crate) fn moments(&self) -> Vector3<f64> {
        let d = self.inertia.diagonal();
        Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y)
    }

    /// The derived integrator first, then the engines' updates and Runge–Kutta, with each `stride`th step kept.
    pub(crate) fn traces(&self, steps: u64, stride: u64) -> Result<Vec<Trace>, Failure> {
        let (attitude, rates, h) = (UnitQuaternion::identity(), self.velocity, self.h);
        let stepper = Stepper::new(self.body(), h)?;
        let state = stepper.start(attitude, rates)?;
        let body = Moments::of(stepper.scene());
        let rk4 = Body { inverse_moments: self.moments().map(f64::recip), lever: Vector3::zeros() };
        let momentum = state.momentum();
        let engine = |update: Update| Engine { body, h, attitude, rates, update };
        Ok(vec![
            self.trace("variational", BLUE, Variational { stepper: &stepper, state }, steps, stride)?,
            self.trace("explicit", ORANGE, engine(explicit), steps, stride)?,
            self.trace("implicit", GREEN, engine(implicit), steps, stride)?,
            self.trace("rescaled", PURPLE, engine(rescaled), steps, stride)?,
            self.trace("RK4", GREY, OnQuaternion::new(rk4, h, &attitude, momentum), steps, stride)?,
        ])
    }

    /// The same body with a full tensor of inertia.
    pub(crate) fn full(&self, steps: u64) -> Result<Trace, Failure> {
        let stepper = Stepper::new(FreeBody { J_d: self.inertia.into() }, self.h)?;
        let state = stepper.start(UnitQuaternion::identity(), self.velocity)?;
        Ok(self.trace("full tensor", BLUE, Variational { stepper: &stepper, state }, steps, 1)?)
    }

    fn trace<M: Method>(
        &self,
        name: &'static str,
        colour: RGBColor,
        mut method: M,
        steps: u64,
        stride: u64,
    ) -> Result<Trace, Stopped> {
        let mut kept = vec![self.kept(0, &method.sample())];
        for sample in 1..=steps / stride {
            method.advance(stride)?;
            kept.push(self.kept(sample * stride, &method.sample()));
        }
        Ok(Trace { name, colour, kept })
    }

    fn kept(&self, steps: u64, Sample { attitude, momentum }: &Sample) -> Kept {
        let velocity = momentum.component_div(&self.moments());
        let time = self.h * workbench::measure::float(steps);
        Kept { time, energy: 0.5 * velocity.dot(momentum), spatial: attitude * momentum, velocity }
    }
}

/// The rates after a step from those before it.
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

    /// `E/E(0)` at each sample; nothing where it isn't finite.
    pub(crate) fn relative_energy(&self) -> Vec<(f64, f64)> {
        let start = self.kept[0].energy;
        self.kept.iter().map(|kept| (kept.time, kept.energy / start)).collect()
    }

    /// `E/E(0)` at the end.
    pub(crate) fn final_energy(&self) -> f64 {
        self.relative_energy().last().map_or(f64::NAN, |(_, energy)| *energy)
    }

    pub(crate) fn worst(&self, size: impl Fn(&Kept) -> f64) -> f64 {
        self.kept.iter().map(size).fold(0.0, workbench::measure::greater)
    }
}

/// The body of a top, in the form that the Runge–Kutta methods use.
pub(crate) fn rk4_body(top: &HeavyTop) -> Body {
    let d = top.J_d.diagonal();
    let moments = Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y);
    Body { inverse_moments: moments.map(f64::recip), lever: top.rho * (top.m * top.g) }
}

/// Runge–Kutta on a motion, with the quaternion brought back to unit length after every step.
pub(crate) fn on_quaternion(motion: &Motion, h: f64) -> OnQuaternion {
    let body = rk4_body(&motion.top);
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
    let body = rk4_body(top);
    0.5 * momentum.dot(&body.inverse_moments.component_mul(momentum)) + (attitude * body.lever).z
}
