//! The seven scenes, with their exact states.
//!
//! The references are those of the tests, to 25 digits and more; `tests/data/README.md` says how each was validated.

use declarations::motions::End;
use declarations::{FourthOrderBody, FourthOrderTop, FreeBody, HeavyTop, Motion, SixthOrderBody, SixthOrderTop};
use liestep::effects::{GravityGradient, PrincipalBody, Spring};
use liestep::mechanics::Sum;
use liestep::prelude::*;
use nalgebra::{Matrix3, Vector3};
use workbench::top_equations::{Equations, State};

use crate::rivals::rates::{Orbiting, Sprung};

/// A body, its start, and where it is later.
pub struct Scene {
    pub name: &'static str,
    /// For names of files and columns.
    pub short: &'static str,
    pub kind: Kind,
    /// Principal moments of the ordinary inertia, kg m².
    pub moments: Vector3<f64>,
    nonstandard: DiagonalNonstandardInertia,
    /// `m g`, N.
    pub weight: f64,
    /// Centre of mass from the pivot, body frame, m.
    pub rho: Vector3<f64>,
    /// At the start, body to space.
    pub attitude: Matrix3<f64>,
    /// At the start, body frame, rad/s.
    pub velocity: Vector3<f64>,
    states: Vec<(f64, End)>,
}

/// What methods a scene allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A symmetric body under gravity along its axis.
    SymmetricTop,
    /// Any body under gravity.
    Top,
    /// Nothing acts on it.
    Free,
    /// Any body under gravity and on a spring.
    Sprung,
    /// Any body in the gradient of gravity of a far mass.
    Satellite,
}

/// The spring of the file.
const SPRING: Spring =
    Spring { k: 20.0, length: 0.5, at: Vector3::new(0.5, 0.0, 0.25), anchor: Vector3::new(1.0, 0.5, 1.0) };

impl Scene {
    /// All seven.
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
        .map(|(name, short, kind, motion)| {
            let motion = Motion::read(motion);
            Self {
                name,
                short,
                kind,
                moments: motion.top.moments(),
                nonstandard: motion.top.J_d,
                weight: motion.top.m * motion.top.g,
                rho: motion.top.rho,
                attitude: motion.attitude.matrix(),
                velocity: motion.velocity,
                states: motion.states().to_vec(),
            }
        })
    }

    /// The exact state at a time of the reference, s.
    pub fn reference(&self, t: f64) -> Option<&End> {
        self.states.iter().find(|(time, _)| (time - t).abs() < 1e-9).map(|(_, end)| end)
    }

    /// The top on its spring.
    pub fn sprung(&self) -> Sum<Sum<PrincipalBody, Gravity>, Spring> {
        let gravity = Gravity { m: 1.0, g: self.weight, rho: self.rho, up: Vector3::z() };
        PrincipalBody { J_d: self.nonstandard } + gravity + SPRING
    }

    pub fn sprung_equations(&self) -> Sprung {
        let Spring { k, length, at, anchor } = SPRING;
        Sprung { top: self.equations(), k, length, at: at.into(), anchor: anchor.into() }
    }

    /// The satellite, in a field with `GM/r³ = 1`.
    pub fn satellite(&self) -> Sum<PrincipalBody, GravityGradient> {
        let field = GravityGradient { GM: 1.0, r: 1.0, J: self.inertia(), direction: Vector3::z() };
        PrincipalBody { J_d: self.nonstandard } + field
    }

    pub fn satellite_equations(&self) -> Orbiting {
        let inverse_moments = self.moments.map(f64::recip).into();
        Orbiting { moments: self.moments.into(), inverse_moments, gradient: 3.0 }
    }

    /// In the variables of the rivals.
    pub fn equations(&self) -> Equations {
        Equations::new(self.moments.into(), (self.rho * self.weight).into())
    }

    /// Where the rivals start.
    pub fn start(&self) -> State {
        let q = SO3::from_matrix_unchecked(self.attitude).to_quaternion();
        let p = self.moments.component_mul(&self.velocity);
        [q.w, q.i, q.j, q.k, p.x, p.y, p.z]
    }

    /// The body with the kinetic term of (3.13) under gravity.
    pub fn top(&self) -> HeavyTop {
        HeavyTop { J_d: self.nonstandard, m: 1.0, g: self.weight, rho: self.rho, up: Vector3::z() }
    }

    /// The body with the kinetic term of (3.13) alone.
    pub fn free_body(&self) -> FreeBody {
        FreeBody { J_d: self.nonstandard.into() }
    }

    /// The top by the Lagrangian of order 4.
    pub fn fourth_order_top(&self) -> FourthOrderTop {
        FourthOrderTop { J: self.inertia(), weight: self.weight, rho: self.rho, up: Vector3::z() }
    }

    /// The top by the Lagrangian of order 6.
    pub fn sixth_order_top(&self) -> SixthOrderTop {
        SixthOrderTop { J: self.inertia(), weight: self.weight, rho: self.rho, up: Vector3::z() }
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
        liestep::NonstandardInertia::from(self.nonstandard).to_inertia()
    }
}

/// The error of attitude and body velocity together, each relative to the size of the exact one.
pub fn error(end: &End, exact: &End) -> f64 {
    let attitude = (end.0 - exact.0).norm() / exact.0.norm();
    attitude.hypot((end.1 - exact.1).norm() / exact.1.norm())
}
