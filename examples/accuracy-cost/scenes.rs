//! The seven scenes, with their exact states.
//!
//! The references are those of the tests, to 25 digits and more; `tests/data/README.md` describes the validation of
//! each.

use declarations::motions::End;
use declarations::{
    FourthOrderBody, FourthOrderTop, FreeBody, HeavyTop, Motion, SixthOrderBody, SixthOrderTop, Top as _,
};
use liestep::effects::{GravityGradient, PrincipalBody, Spring};
use liestep::mechanics::Sum;
use liestep::prelude::*;
use nalgebra::Vector3;
use workbench::measure::relative;
use workbench::top_equations::{Equations, State};

use crate::rivals::rates::{SatelliteRates, SpringRates};

/// A body, its initial state, and its exact later states.
pub struct Scene {
    pub name: &'static str,
    /// The short name in files and columns.
    pub short: &'static str,
    pub kind: Kind,
    /// The body under gravity. Other potentials are added to gravity or replace it.
    pub motion: Motion,
}

/// The kind of a scene, which determines its methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A symmetric body under gravity along its axis.
    SymmetricTop,
    /// Any body under gravity.
    Top,
    /// A body without forces.
    Free,
    /// Any body under gravity and on a spring.
    Sprung,
    /// Any body in the gradient of gravity of a far mass.
    Satellite,
}

/// The spring in the reference's file.
const SPRING: Spring =
    Spring { k: 20.0, length: 0.5, at: Vector3::new(0.5, 0.0, 0.25), anchor: Vector3::new(1.0, 0.5, 1.0) };

impl Scene {
    /// All seven scenes.
    pub fn all() -> [Self; 7] {
        [
            ("looping top", "looping", Kind::SymmetricTop, "looping A"),
            ("cuspidal top", "cuspidal", Kind::SymmetricTop, "cuspidal A"),
            ("third top of the thesis", "third", Kind::SymmetricTop, "third A"),
            ("chaotic asymmetric top", "chaotic", Kind::Top, "chaotic"),
            ("asymmetric free body", "free", Kind::Free, "free"),
            ("asymmetric top on a spring", "sprung", Kind::Sprung, "sprung"),
            ("fast asymmetric satellite", "orbiting", Kind::Satellite, "satellite"),
        ]
        .map(|(name, short, kind, motion)| Self { name, short, kind, motion: Motion::read(motion) })
    }

    /// The exact state at a time of the reference, s.
    pub fn reference(&self, t: f64) -> Option<&End> {
        self.motion.states().iter().find(|(time, _)| (time - t).abs() < 1e-9).map(|(_, end)| end)
    }

    fn body(&self) -> PrincipalBody {
        PrincipalBody { J_d: self.motion.top.J_d }
    }

    /// The top on its spring.
    pub fn sprung(&self) -> Sum<Sum<PrincipalBody, Gravity>, Spring> {
        let HeavyTop { m, g, rho, up, .. } = self.motion.top;
        self.body() + Gravity { m, g, rho, up } + SPRING
    }

    pub fn sprung_equations(&self) -> SpringRates {
        let Spring { k, length, at, anchor } = SPRING;
        SpringRates { top: self.equations(), k, length, at: at.into(), anchor: anchor.into() }
    }

    /// The satellite, in a field with `GM/r³ = 1`.
    pub fn satellite(&self) -> Sum<PrincipalBody, GravityGradient> {
        self.body() + GravityGradient { GM: 1.0, r: 1.0, J: self.inertia(), direction: Vector3::z() }
    }

    pub fn satellite_equations(&self) -> SatelliteRates {
        let moments = self.motion.top.moments();
        SatelliteRates { moments: moments.into(), inverse_moments: moments.map(f64::recip).into(), gradient: 3.0 }
    }

    /// The equations in the variables of the rivals.
    pub fn equations(&self) -> Equations {
        let HeavyTop { m, g, rho, .. } = self.motion.top;
        Equations::new(self.motion.top.moments().into(), (rho * (m * g)).into())
    }

    /// The initial state in the variables of the rivals.
    pub fn start(&self) -> State {
        let q = self.motion.attitude.to_quaternion();
        let p = self.motion.top.moments().component_mul(&self.motion.velocity);
        [q.w, q.i, q.j, q.k, p.x, p.y, p.z]
    }

    /// The body with the kinetic term of (3.13) under gravity.
    pub fn top(&self) -> HeavyTop {
        self.motion.top.clone()
    }

    /// The body with the kinetic term of (3.13) alone.
    pub fn free_body(&self) -> FreeBody {
        FreeBody { J_d: self.motion.top.J_d.into() }
    }

    /// The top by the Lagrangian of order 4.
    pub fn fourth_order_top(&self) -> FourthOrderTop {
        FourthOrderTop::of(&self.motion.top)
    }

    /// The top by the Lagrangian of order 6.
    pub fn sixth_order_top(&self) -> SixthOrderTop {
        SixthOrderTop::of(&self.motion.top)
    }

    /// The body by the Lagrangian of order 4.
    pub fn fourth_order_body(&self) -> FourthOrderBody {
        FourthOrderBody { J: self.inertia() }
    }

    /// The body by the Lagrangian of order 6.
    pub fn sixth_order_body(&self) -> SixthOrderBody {
        SixthOrderBody { J: self.inertia() }
    }

    /// The ordinary inertia.
    pub fn inertia(&self) -> Inertia {
        self.motion.top.ordinary_inertia()
    }
}

/// The error of attitude and body velocity together, each relative to the size of the exact one.
pub fn error(end: &End, exact: &End) -> f64 {
    relative(&end.0, &exact.0).hypot(relative(&end.1, &exact.1))
}
