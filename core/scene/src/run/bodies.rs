//! The bodies of a file in a system of one of a few sizes. Padding bodies fill the size and stay at rest, and padding
//! joints constrain nothing.

use std::array::from_fn;

use liestep::groups::{LieGroup as _, R3};
use liestep::mechanics::{Each, Inertia, Placement, Sum};
use liestep::methods::{Joint, JointedBodies, Joints, PlacedJoint};
use liestep::motion::Integrator;
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, SetupError, Stepper, lagrangian};
use nalgebra::{Vector3, Vector6};

use crate::file::arrangement::Arrangement;
use crate::file::body::Kinetic;
use crate::file::system::{Between, System, SystemBody};
use crate::run::nearest::Moving;
use crate::run::springs::Springs;

/// A body with its weight. One of the three kinetic terms has the factor one, the others zero.
#[lagrangian(
    group(F = SO3, d = R3),
    advected(x = d.seen_from(space)),
    l_d = {
        let xi = log(F);
        let tangent = vee(F - F.transpose()) / (1.0 + F.trace());
        (rigid * ((F - I) * J_d * (F - I).transpose()).trace()
            + geodesic * xi.dot(&(J * xi))
            + cayley * 4.0 * tangent.dot(&(J * tangent))
            + m * d.norm_squared()) / (2.0 * h)
            - 0.5 * h * m * g * (x + x + d).dot(&up)
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Heavy {
    /// Moment of inertia about the centre of mass, kg m².
    pub(crate) J: Inertia,
    pub(crate) J_d: NonstandardInertia,
    pub(crate) rigid: f64,
    pub(crate) geodesic: f64,
    pub(crate) cayley: f64,
    /// Mass, kg.
    pub(crate) m: f64,
    /// Acceleration of gravity, m/s².
    pub(crate) g: f64,
    pub(crate) up: Vector3<f64>,
}

type Parts<const N: usize> = Sum<Placement<Each<N>, Heavy, N>, Springs<N>>;
pub(crate) type SystemStepper<const N: usize, const L: usize> =
    Stepper<Parts<N>, JointedBodies<Parts<N>, Link, 5, N, N, L>>;

type StateOf<const N: usize, const L: usize> = <SystemStepper<N, L> as Integrator>::State;

/// A joint; `None` is padding.
type Link = Option<Joint>;

impl Arrangement {
    fn joints<const N: usize, const L: usize>(&self, joints: &[Between<Joint>]) -> Joints<Link, N, L> {
        let joined = |&number: &usize| {
            let between = &joints[number];
            let [above, below] = between.bodies;
            PlacedJoint { joint: Some(between.of), above, below: below.unwrap_or_default() }
        };
        let loose = |below: usize| PlacedJoint::to_space(None, below);
        let of_tree =
            |place: usize| self.tree.get(place).map_or_else(|| loose(self.free[place - self.tree.len()]), joined);
        Joints::tree(from_fn(of_tree))
            .closed_by(from_fn(|place| self.loops.get(place).map_or_else(|| loose(0), joined)))
    }
}

impl System {
    pub(crate) fn stepper<const N: usize, const L: usize>(&self) -> Result<SystemStepper<N, L>, SetupError> {
        let (g, up) = self.gravity.unwrap_or((0.0, Vector3::z()));
        // Padding bodies copy the first body, feel no gravity and stay at rest.
        let heavy = |place: usize| {
            let (body, g) = self.bodies.get(place).map_or((&self.bodies[0], 0.0), |body| (body, g));
            let is = |kinetic| f64::from(u8::from(body.kinetic == kinetic));
            let [rigid, geodesic, cayley] = [Kinetic::Rigid, Kinetic::Geodesic, Kinetic::Cayley].map(is);
            Heavy { J: body.J, J_d: body.J.to_nonstandard(), rigid, geodesic, cayley, m: body.m, g, up }
        };
        let parts = Each::<N>::of(from_fn::<_, N, _>(heavy)) + Springs::of(&self.springs);
        Stepper::jointed(parts, self.arrangement.joints(&self.joints), self.step)
    }

    /// The file's initial configurations and velocities.
    fn given(&self) -> Vec<Moving> {
        let of = |body: &SystemBody| {
            let (turn, shift) = (body.start.velocity, body.moving);
            let velocity = Vector6::new(turn.x, turn.y, turn.z, shift.x, shift.y, shift.z);
            ((SO3::from(body.start.attitude), R3::from(body.position)), velocity)
        };
        self.bodies.iter().map(of).collect()
    }

    /// The initial state of the file. With `nearest`, it is the nearest state that satisfies the constraints.
    pub(crate) fn start<const N: usize, const L: usize>(
        &self,
        stepper: &SystemStepper<N, L>,
    ) -> Result<StateOf<N, L>, SetupError> {
        let padded = |bodies: &[Moving]| {
            let resting = ((SO3::identity(), R3::identity()), Vector6::zeros());
            let all: [_; N] = from_fn(|place| bodies.get(place).copied().unwrap_or(resting));
            (all.map(|(body, _)| body), Bodies(all.map(|(_, velocity)| velocity)))
        };
        let given = self.given();
        let (bodies, velocities) = padded(&given);
        let started = stepper.start(bodies, velocities);
        if !self.nearest {
            return started;
        }
        let (bodies, velocities) = if started.is_ok() { (bodies, velocities) } else { padded(&self.shifted(given)) };
        stepper.start_nearest(bodies, velocities)
    }
}
