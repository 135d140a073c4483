//! The description of a system: its bodies, terms and joints.

use alloc::string::String;
use alloc::sync::Arc;
use alloc::vec::Vec;

use super::Body;
use super::constraint::Constraint;
use super::functions::ConstraintFunctions;
use super::graph::Joint;
use super::part::BodyPart;
use super::terms::{PlacedTerm, placed};
use crate::error::SetupError;
use crate::groups::{CayleyRetraction, Pair};
use crate::mechanics::Effect;

/// A system of rigid bodies, with terms on them and between them, and with joints. Bodies are counted from zero.
///
/// Bodies and joints may be of any types and any number. A chain, a tree or several of them have no loop, whether they
/// are joined to space or not. A joint between bodies that the joints before it connect closes a loop; the choice
/// doesn't change the motion.
///
/// # Examples
///
/// Four rods of 1 m on ball joints, both ends on pivots, with a spring between the middle joint and a point of space: a
/// swing.
///
/// ```
/// use liestep::groups::R3;
/// use liestep::methods::{Joint, Multibody};
/// use liestep::{NonstandardInertia, SO3, lagrangian};
/// use nalgebra::{Vector3, Vector6};
///
/// /// A body and its weight.
/// #[lagrangian(
///     group(F = SO3, d = R3),
///     advected(x = d.seen_from(space)),
///     l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
///         - 0.5 * h * m * g * (x + x + d).dot(&up),
/// )]
/// struct Rod {
///     J_d: NonstandardInertia, // about the centre of mass
///     m: f64,
///     g: f64,
///     up: Vector3<f64>,
/// }
///
/// /// A spring between a point of one body and a point of another.
/// #[lagrangian(
///     group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
///     advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
///     l_d = -0.25 * h * k * ((r + R_2 * at_2 - R_1 * at_1).norm_squared()
///         + (r + d_2 - d_1 + R_2 * F_2 * at_2 - R_1 * F_1 * at_1).norm_squared()),
/// )]
/// struct Cord {
///     k: f64,
///     at_1: Vector3<f64>,
///     at_2: Vector3<f64>,
/// }
///
/// let J_d = NonstandardInertia::from_diagonal(Vector3::new(1.0 / 12.0, 1e-3, 1e-3))?;
/// let (left, right) = (Vector3::x() * -0.5, Vector3::x() * 0.5);
/// let mut swing = Multibody::new();
/// for k in 0..4 {
///     let body = swing.body(Rod { J_d, m: 1.0, g: 9.81, up: Vector3::z() });
///     match body.checked_sub(1) {
///         None => swing.join(Joint::ball([Vector3::zeros(), left]), None, body),
///         Some(before) => swing.join(Joint::ball([right, left]), Some(before), body),
///     }
/// }
/// swing.join(Joint::ball([Vector3::x() * 3.0, right]), None, 3);
/// swing.between([None, Some(1)], Cord { k: 5.0, at_1: Vector3::x() * 1.5, at_2: right });
/// let stepper = swing.stepper(0.01)?;
///
/// // About a garland; it starts at a place next to it where the joints are closed.
/// let about = [0, 1, 2, 3].map(|k| {
///     let tilt = [0.8, 0.3, -0.3, -0.8][k];
///     let place = [[0.3, -0.4], [1.1, -0.9], [1.9, -0.9], [2.7, -0.4]][k];
///     (SO3::exp(Vector3::y() * tilt), R3::from(Vector3::new(place[0], 0.0, place[1])))
/// });
/// let mut state = stepper.start_nearest(&about, &[Vector6::y() * 0.3; 4])?;
/// let energy = stepper.energy(&state);
/// stepper.run(&mut state, 1000)?;
/// assert!(stepper.widest_gap(&state) < 1e-14);
/// assert!((stepper.energy(&state) - energy).abs() < 1e-2 * energy.abs());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Default)]
pub struct Multibody {
    pub(super) bodies: usize,
    /// Each with its body.
    pub(super) terms: Vec<(usize, Arc<dyn PlacedTerm<1>>)>,
    pub(super) pairs: Vec<PlacedPair>,
    pub(super) joints: Vec<Joint>,
}

/// A term between two bodies; `None` is space.
pub(super) type PlacedPair = ([Option<usize>; 2], Arc<dyn PlacedTerm<2>>);

impl Multibody {
    /// A system without bodies.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a body with its kinetic term; returns its number. The term is on the group `(SO3, R3)` or on a part of it, and
    /// [`on`](Self::on) adds the others.
    pub fn body<E>(&mut self, term: E) -> usize
    where
        E: Effect<Scalar = f64, Group: BodyPart, Retraction = CayleyRetraction> + Send + Sync + 'static,
        E::Constants: Send + Sync,
        E::Advected: Send + Sync,
    {
        let body = self.bodies;
        self.bodies += 1;
        self.on(body, term);
        body
    }

    /// Adds a further term to a body, or to its rotation alone, as the [`effects`](crate::effects) of the library are.
    ///
    /// A constraint on velocities is refused at compile time:
    ///
    /// ```compile_fail,E0080
    /// use liestep::effects::RigidBody;
    /// use liestep::methods::Multibody;
    /// use liestep::prelude::*;
    ///
    /// #[nonholonomic(group = SO3, velocity = Omega, zero = a.dot(&Omega))]
    /// struct Suslov {
    ///     a: Vector3<f64>,
    /// }
    ///
    /// let J_d = NonstandardInertia::from_diagonal(Vector3::new(1.0, 2.0, 2.5)).unwrap();
    /// let mut system = Multibody::new();
    /// let body = system.body(RigidBody { J_d });
    /// system.on(body, Suslov { a: Vector3::z() });
    /// ```
    pub fn on<E>(&mut self, body: usize, term: E)
    where
        E: Effect<Scalar = f64, Group: BodyPart, Retraction = CayleyRetraction> + Send + Sync + 'static,
        E::Constants: Send + Sync,
        E::Advected: Send + Sync,
    {
        self.terms.push((body, placed(term)));
    }

    /// Adds a term between two bodies, or between space, `None`, and a body: a potential, a kinetic energy, or a force by
    /// its virtual work. The term is declared on two bodies, or on parts of both ([`BodyPart`]): `group(F_1 = SO3, F_2 = SO3)`
    /// for one that depends on their attitudes alone.
    ///
    /// A potential of the ends of a step adds kicks. Any other term couples the equations of its bodies within the step,
    /// which are solved together: a step isn't bounded by the strength of friction, nor by a stiff potential of the middle of
    /// a step.
    ///
    /// # Examples
    ///
    /// A double pendulum with friction in its second joint: the torque is `c` times the relative angular velocity, half of
    /// its impulse at either end of a step. Its work is negative at any strength.
    ///
    /// ```
    /// use liestep::groups::R3;
    /// use liestep::methods::{Joint, Multibody};
    /// use liestep::{NonstandardInertia, SO3, force, lagrangian};
    /// use nalgebra::{Vector3, Vector6};
    ///
    /// #[force(
    ///     group(F_1 = SO3, F_2 = SO3),
    ///     advected(Q = F_2.seen_from(F_1)),
    ///     displacement(eta_1, eta_2),
    ///     work = {
    ///         let turn = Q * vee(F_2) - vee(F_1);
    ///         -0.5 * c * (turn.dot(&(Q * eta_2 - eta_1)) + turn.dot(&(Q * (F_2 * eta_2_next) - F_1 * eta_1_next)))
    ///     },
    /// )]
    /// struct Friction {
    ///     c: f64, // N m s
    /// }
    ///
    /// /// A body and its weight.
    /// #[lagrangian(
    ///     group(F = SO3, d = R3),
    ///     advected(x = d.seen_from(space)),
    ///     l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
    ///         - 0.5 * h * m * g * (x + x + d)[2],
    /// )]
    /// struct Rod {
    ///     J_d: NonstandardInertia,
    ///     m: f64,
    ///     g: f64,
    /// }
    ///
    /// let J_d = NonstandardInertia::from_diagonal(Vector3::new(1.0 / 12.0, 1e-3, 1e-3))?;
    /// let (left, right) = (Vector3::x() * -0.5, Vector3::x() * 0.5);
    /// let mut pendulum = Multibody::new();
    /// let upper = pendulum.body(Rod { J_d, m: 1.0, g: 9.81 });
    /// let lower = pendulum.body(Rod { J_d, m: 1.0, g: 9.81 });
    /// pendulum.join(Joint::ball([Vector3::zeros(), left]), None, upper);
    /// pendulum.join(Joint::ball([right, left]), Some(upper), lower);
    /// pendulum.between([Some(upper), Some(lower)], Friction { c: 50.0 });
    /// let stepper = pendulum.stepper(0.01)?;
    /// let start = [0.5, 1.5].map(|x| (SO3::identity(), R3::from(Vector3::x() * x)));
    /// let mut state = stepper.start(&start, &[Vector6::zeros(); 2])?;
    /// let energy = stepper.energy(&state);
    /// stepper.run(&mut state, 1000)?;
    /// assert!(stepper.energy(&state) < energy - 0.01);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn between<E>(&mut self, bodies: [Option<usize>; 2], term: E)
    where
        E: Effect<Scalar = f64, Group: Pair<Body: BodyPart>, Retraction = CayleyRetraction> + Send + Sync + 'static,
        E::Constants: Send + Sync,
        E::Advected: Send + Sync,
    {
        self.pairs.push((bodies, placed(term)));
    }

    /// Adds a joint between a body above, or space, `None`, and a body below. Errors count joints from zero.
    pub fn join<C: Constraint<K>, const K: usize>(&mut self, joint: C, above: Option<usize>, below: usize) {
        const { assert!(0 < K && K < 7, "a joint between two bodies has one function at least and six at most") }
        self.joints.push(Joint::new(Arc::new(ConstraintFunctions(joint)), above, below));
    }

    /// The number of bodies.
    #[must_use]
    pub fn bodies(&self) -> usize {
        self.bodies
    }

    /// Checks that terms are at bodies of the system.
    pub(super) fn check_places(&self) -> Result<(), SetupError> {
        if self.bodies == 0 {
            return Err(SetupError::Place { cause: "a system has a body at least" });
        }
        let is_there = |body: usize| body < self.bodies;
        let on_bodies = self.terms.iter().all(|(body, _)| is_there(*body));
        if !on_bodies || !self.pairs.iter().flat_map(|(bodies, _)| bodies).flatten().all(|&body| is_there(body)) {
            return Err(SetupError::Place { cause: "a term is at a body that there isn't" });
        }
        if self.pairs.iter().any(|(bodies, _)| bodies[0] == bodies[1]) {
            return Err(SetupError::Place { cause: "a term is between a body and itself" });
        }
        Ok(())
    }

    /// The system with its constants folded for a step.
    pub(super) fn refolded(&self, h: f64) -> Self {
        Self {
            bodies: self.bodies,
            terms: self.terms.iter().map(|(body, term)| (*body, term.refolded(h))).collect(),
            pairs: self.pairs.iter().map(|(bodies, term)| (*bodies, term.refolded(h))).collect(),
            joints: self.joints.clone(),
        }
    }

    /// Whether all constants are finite.
    pub(super) fn is_finite(&self) -> bool {
        self.terms.iter().all(|(_, term)| term.is_finite()) && self.pairs.iter().all(|(_, term)| term.is_finite())
    }

    /// Whether each term is its own adjoint, so that a step of `−h` undoes one of `h`.
    pub(super) fn is_self_adjoint(&self) -> bool {
        let of_bodies = self.terms.iter().all(|(_, term)| term.is_self_adjoint());
        of_bodies && self.pairs.iter().all(|(_, term)| term.is_self_adjoint())
    }

    /// The derivation of each term.
    pub(super) fn derivation(&self) -> String {
        let of_bodies = self.terms.iter().map(|(_, term)| term.derivation());
        of_bodies.chain(self.pairs.iter().map(|(_, term)| term.derivation())).collect::<Vec<_>>().join("\n")
    }
}

/// The bodies at the ends of a term between two, as configurations.
pub(super) fn ends<'a>(bodies: &[Option<usize>; 2], all: &'a [Body], space: &'a Body) -> [&'a Body; 2] {
    bodies.map(|body| body.map_or(space, |body| &all[body]))
}
