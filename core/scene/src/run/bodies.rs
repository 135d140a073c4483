//! The bodies of a file in a system of one of a few sizes: the bodies behind them rest, and joints that aren't there hold
//! nothing.

use std::array::from_fn;

use liestep::groups::{LieGroup as _, R3};
use liestep::mechanics::{Each, Placement, Sum};
use liestep::methods::{Joint, JointedBodies, Joints, PlacedJoint};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, SetupError, Stepper, lagrangian};
use nalgebra::{Vector3, Vector6};

use crate::file::arrangement::Arrangement;
use crate::file::system::{Between, System};
use crate::run::springs::Springs;

/// A body and its weight.
#[lagrangian(
    group(F = SO3, d = R3),
    advected(x = d.seen_from(space)),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
        - 0.5 * h * m * g * (x + x + d).dot(&up),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Heavy {
    /// About the centre of mass, kg m².
    pub(crate) J_d: NonstandardInertia,
    /// kg.
    pub(crate) m: f64,
    /// m/s².
    pub(crate) g: f64,
    pub(crate) up: Vector3<f64>,
}

type Parts<const N: usize> = Sum<Placement<Each<N>, Heavy, N>, Springs<N>>;
pub(crate) type SystemStepper<const N: usize, const L: usize> =
    Stepper<Parts<N>, JointedBodies<Parts<N>, Link, 5, N, N, L>>;

/// A joint, or the place of one.
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
        // What is behind the bodies is like the first without gravity, and rests.
        let heavy = |place: usize| {
            let (body, g) = self.bodies.get(place).map_or((&self.bodies[0], 0.0), |body| (body, g));
            Heavy { J_d: body.J_d, m: body.m, g, up }
        };
        let parts = Each::<N>::of(from_fn::<_, N, _>(heavy)) + Springs::of(&self.springs);
        Stepper::jointed(parts, self.arrangement.joints(&self.joints), self.step)
    }

    pub(crate) fn start<const N: usize>(&self) -> ([(SO3, R3); N], Bodies<Vector6<f64>, N>) {
        let at = |place: usize| {
            let Some(body) = self.bodies.get(place) else {
                return ((SO3::identity(), R3::identity()), Vector6::zeros());
            };
            let (turn, shift) = (body.start.velocity, body.moving);
            let velocity = Vector6::new(turn.x, turn.y, turn.z, shift.x, shift.y, shift.z);
            ((SO3::from(body.start.attitude), R3::from(body.position)), velocity)
        };
        let all: [_; N] = from_fn(at);
        (all.map(|(body, _)| body), Bodies(all.map(|(_, velocity)| velocity)))
    }
}
