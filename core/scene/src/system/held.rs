//! The bodies of a file in a system of one of a few sizes: what is behind them rests, and joints that aren't there hold
//! nothing.

// The letters of the field.
#![allow(non_snake_case)]

use std::array::from_fn;

use liestep::groups::{LieGroup as _, R3};
use liestep::mechanics::{Each, Effect as _, Placed, Sum};
use liestep::methods::{Joined, Joint, Jointed, Joints};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, SetupError, Stepper, lagrangian};
use nalgebra::{Vector3, Vector6};

use super::file::{BODIES, Between, LOOPS, System};
use super::run::{SIZES, Size};
use super::springs::Springs;

/// A body and its weight.
#[lagrangian(
    group(F = SO3, d = R3),
    advected(x = d.seen_from(space)),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
        - 0.5 * h * m * g * (x + x + d).dot(&up),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Heavy {
    /// About the centre of mass, kg m².
    pub(super) J_d: NonstandardInertia,
    /// kg.
    pub(super) m: f64,
    /// m/s².
    pub(super) g: f64,
    pub(super) up: Vector3<f64>,
}

type Parts<const N: usize> = Sum<Placed<Each<N>, Heavy, N>, Springs<N>>;
pub(super) type Held<const N: usize, const L: usize> = Stepper<Parts<N>, Jointed<Parts<N>, Link, 5, N, N, L>>;

/// What joints hold, as in the documentation of `BallJoint` and `PinJoint`.
const BALLS: &str =
    "joints from a body a, or space, to a body b: x_b + R_b ρ_b − x_a − R_a ρ_a = 0 at both ends of a step\n";
const PINS: &str = "pins, with e_1 and e_2 across the axis n_a: R_a e_1 · R_b n_b = R_a e_2 · R_b n_b = 0, too\n";

/// A joint, or the place of one.
type Link = Option<Joint>;

/// Joints as the library takes them, by their numbers in the file.
#[derive(Clone)]
pub(super) struct Arranged {
    tree: Vec<usize>,
    loops: Vec<usize>,
    /// One body of each tree that no joint connects to space. Nothing holds it there.
    free: Vec<usize>,
    /// Of the system that they are stepped in.
    pub(super) size: Size,
}

impl Arranged {
    /// The first joints that lead to a body which none before leads to are those of trees, the others close loops; `Err`
    /// has the number of the first that is too many.
    pub(super) fn of(joints: &[Between<Joint>], bodies: usize) -> Result<Self, usize> {
        // Space is behind the last.
        let mut group: [usize; BODIES + 1] = from_fn(|body| body);
        let (mut tree, mut loops) = (Vec::new(), Vec::new());
        for (number, between) in joints.iter().enumerate() {
            let [one, other] = between.bodies.map(|body| group[body.unwrap_or(BODIES)]);
            if one == other {
                loops.push(number);
            } else {
                group.iter_mut().filter(|of| **of == other).for_each(|of| *of = one);
                tree.push(number);
            }
        }
        if let Some(&number) = loops.get(LOOPS) {
            return Err(number);
        }
        let free =
            (0..BODIES).filter(|&body| group[body] != group[BODIES] && !group[..body].contains(&group[body])).collect();
        let [.., largest] = SIZES;
        let fits = |size: &Size| size.bodies >= bodies && size.loops >= loops.len();
        let size = SIZES.into_iter().find(fits).unwrap_or(largest);
        Ok(Self { tree, loops, free, size })
    }

    fn joints<const N: usize, const L: usize>(&self, joints: &[Between<Joint>]) -> Joints<Link, N, L> {
        let joined = |&number: &usize| {
            let between = &joints[number];
            let [above, below] = between.bodies;
            Joined { joint: Some(between.of), above, below: below.unwrap_or_default() }
        };
        let loose = |below: usize| Joined::to_space(None, below);
        let of_tree =
            |place: usize| self.tree.get(place).map_or_else(|| loose(self.free[place - self.tree.len()]), joined);
        Joints::tree(from_fn(of_tree))
            .closed_by(from_fn(|place| self.loops.get(place).map_or_else(|| loose(0), joined)))
    }

    /// The number in the file of a joint that an error names.
    pub(super) fn number(&self, joint: usize) -> Option<usize> {
        let of_loop = || self.loops.get(joint.checked_sub(self.size.bodies)?);
        self.tree.get(joint).or_else(of_loop).copied()
    }
}

impl System {
    /// What was derived of a body, what springs add, and what joints hold.
    #[must_use]
    pub fn derivation(&self) -> String {
        let gravity = if self.gravity.is_some() { "" } else { "without gravity, g = 0\n" };
        let springs = if self.springs.is_empty() { "" } else { Springs::<BODIES>::DERIVATION };
        let joints = if self.joints.is_empty() { "" } else { BALLS };
        let pins = if self.has_pins() { PINS } else { "" };
        format!("{}{gravity}{springs}{joints}{pins}", Heavy::DERIVATION)
    }

    pub(super) fn stepper<const N: usize, const L: usize>(&self) -> Result<Held<N, L>, SetupError> {
        let (g, up) = self.gravity.unwrap_or((0.0, Vector3::z()));
        // What is behind the bodies is like the first without gravity, and rests.
        let heavy = |place: usize| {
            let (body, g) = self.bodies.get(place).map_or((&self.bodies[0], 0.0), |body| (body, g));
            Heavy { J_d: body.J_d, m: body.m, g, up }
        };
        let parts = Each::<N>::of(from_fn::<_, N, _>(heavy)) + Springs::of(&self.springs);
        Stepper::jointed(parts, self.arranged.joints(&self.joints), self.step)
    }

    pub(super) fn start<const N: usize>(&self) -> ([(SO3, R3); N], Bodies<Vector6<f64>, N>) {
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
