//! Chains of rigid links on ball joints, in the minimal form on SO(3)ᴺ, each step in time proportional to `N`.
//!
//! The links' attitudes are the only unknowns, so joints can't open. All velocities are coupled,
//!
//! ```text
//! l_d = Σ tr((F_a − I) K_a (F_a − I)ᵀ)/2h + Σ_a m_a |u_a + (F_a − I) c_a|²/2h − (h/2) g Σ w_a·(s_a + F_a s_a)
//! ```
//!
//! Here `K_a = J_a − m_a c_a c_aᵀ` is the nonstandard inertia about the centre of mass, `u_a` the displacement of the
//! upper joint over the step, which depends on the links above, and `s_a = m_a c_a + M_a ρ_a` with the mass `M_a` of
//! all links beyond. The Newton matrix is full. But all links beyond act on a link like a mass at its lower joint, so
//! links are eliminated from the end of the chain to the pivot, as in the articulated-body algorithm.

mod elimination;
mod link;
mod plan;
#[cfg(test)]
mod tests;

use nalgebra::Vector3;

pub use link::Link;
pub use plan::LinkedBodies;

use crate::effects::Gravity;
use crate::error::SetupError;
use crate::groups::SO3;
use crate::mechanics::{Each, Placement, Term as _};
use crate::motion::{Motion, Stepper};
use crate::numbers::{Bodies, Coordinates as _};

/// The tolerance for a vector to be of length one: twelve printed digits pass.
const ROUNDED: f64 = f64::EPSILON * 1e4;

/// The gravity term of each link, with the mass of the links beyond included.
pub type Weights<const N: usize> = Placement<Each<N>, Gravity, N>;

/// The integrator of [`Chain::stepper`]: links under gravity alone.
pub type ChainStepper<const N: usize> = Stepper<Weights<N>, LinkedBodies<Weights<N>, N>>;

/// Links on ball joints, the first on a fixed pivot, under uniform gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chain<const N: usize> {
    /// The links in order, from the pivot on.
    pub links: [Link; N],
    /// Gravitational acceleration, m/s².
    pub g: f64,
    /// The unit vector upwards, in space.
    pub up: Vector3<f64>,
}

impl<const N: usize> Chain<N> {
    /// An integrator of these links with a fixed step, s; of second order, symmetric and symplectic. A negative step is
    /// the inverse map; `h = 0` is the identity. [`LinkedBodies`] describes the method and its cost.
    ///
    /// # Errors
    ///
    /// The errors of [`Stepper::linked`].
    ///
    /// # Examples
    ///
    /// ```
    /// use liestep::methods::{Chain, Link};
    /// use liestep::numbers::Bodies;
    /// use liestep::{NonstandardInertia, SO3};
    /// use nalgebra::Vector3;
    ///
    /// // Rods of one metre, of one kilogram, that hang along their axis.
    /// let J_d = NonstandardInertia::from_diagonal(Vector3::new(1e-3, 1e-3, 1.0 / 3.0))?;
    /// let link = Link { J_d, m: 1.0, c: Vector3::new(0.0, 0.0, -0.5), rho: Vector3::new(0.0, 0.0, -1.0) };
    /// let stepper = Chain { links: [link; 5], g: 9.81, up: Vector3::z() }.stepper(0.01)?;
    /// let tilted = SO3::from_euler_angles(0.0, 1.0, 0.0);
    /// let mut state = stepper.start([tilted; 5], Bodies([Vector3::new(0.0, 0.2, 0.0); 5]))?;
    /// let (energy, vertical) = (stepper.energy(&state), stepper.vertical_momentum(&state));
    /// stepper.run(&mut state, 1000)?;
    /// assert!((stepper.energy(&state) - energy).abs() < 1e-2 * energy.abs());
    /// assert!((stepper.vertical_momentum(&state) - vertical).abs() < 1e-11);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn stepper(self, h: f64) -> Result<ChainStepper<N>, SetupError> {
        if !self.up.iter().all(|entry| entry.is_finite()) {
            return Err(SetupError::Parameter { field: "up", cause: "is not finite" });
        }
        if (self.up.norm_squared() - 1.0).abs() > ROUNDED {
            return Err(SetupError::Parameter { field: "up", cause: "is not of length one" });
        }
        if !self.g.is_finite() {
            return Err(SetupError::Parameter { field: "g", cause: "is not finite" });
        }
        Stepper::linked(self.weights(), self.links, h)
    }

    /// The weight of each link, with the mass of all links beyond at its lower joint: the gravity of a scene for
    /// [`Stepper::linked`].
    #[must_use]
    pub fn weights(&self) -> Weights<N> {
        let mut gravity = [Gravity { m: 0.0, g: self.g, rho: Vector3::zeros(), up: self.up }; N];
        let mut beyond = 0.0;
        for (gravity, link) in gravity.iter_mut().zip(&self.links).rev() {
            let moment = link.c * link.m + link.rho * beyond;
            beyond += link.m;
            gravity.m = beyond;
            if beyond != 0.0 {
                gravity.rho = moment / beyond;
            }
        }
        Each::of(gravity)
    }
}

impl<const N: usize> ChainStepper<N> {
    /// The momentum of all links about the vertical through the pivot, kg m²/s; it is conserved.
    #[must_use]
    pub fn vertical_momentum(&self, motion: &Motion<[SO3; N], [Vector3<f64>; N]>) -> f64 {
        let up = self.scene().advected();
        motion.spatial_momentum().dot(&Bodies(up))
    }
}
