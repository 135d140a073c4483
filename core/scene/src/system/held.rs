//! The bodies of a file in a system of one size: what is behind them rests, and joints that aren't there hold nothing.

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

type Parts = Sum<Placed<Each<BODIES>, Heavy, BODIES>, Springs>;
pub(super) type Held = Stepper<Parts, Jointed<Parts, Link, 5, BODIES, BODIES, LOOPS>>;
pub(super) type HeldBodies = [(SO3, R3); BODIES];

/// What joints hold, as in the documentation of `BallJoint` and `PinJoint`.
const BALLS: &str =
    "joints from a body a, or space, to a body b: x_b + R_b ρ_b − x_a − R_a ρ_a = 0 at both ends of a step\n";
const PINS: &str = "pins, with e_1 and e_2 across the axis n_a: R_a e_1 · R_b n_b = R_a e_2 · R_b n_b = 0, too\n";

/// A joint, or the place of one.
type Link = Option<Joint>;

/// Joints as the library takes them, each with its number in the file.
#[derive(Clone)]
pub(super) struct Arranged {
    joints: Joints<Link, BODIES, LOOPS>,
    /// Those of the tree, then those of loops.
    numbers: Vec<Option<usize>>,
}

impl Arranged {
    /// The first joints that lead to a body which none before leads to are those of trees, the others close loops; `Err`
    /// has the number of the first that is too many.
    pub(super) fn of(joints: &[Between<Joint>]) -> Result<Self, usize> {
        let joined = |number: usize| {
            let between = &joints[number];
            let [above, below] = between.bodies;
            Joined { joint: Some(between.of), above, below: below.unwrap_or_default() }
        };
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
        // What no joint connects to space is held there by nothing, at one body of each such tree.
        let free: Vec<usize> =
            (0..BODIES).filter(|&body| group[body] != group[BODIES] && !group[..body].contains(&group[body])).collect();
        let loose = |below: usize| Joined::to_space(None, below);
        let of_tree =
            |place: usize| tree.get(place).map_or_else(|| loose(free[place - tree.len()]), |&number| joined(number));
        let joints = Joints::tree(from_fn(of_tree));
        let joints =
            joints.closed_by(from_fn(|place| loops.get(place).map_or_else(|| loose(0), |&number| joined(number))));
        let numbers =
            (0..BODIES).map(|place| tree.get(place).copied()).chain(loops.iter().copied().map(Some)).collect();
        Ok(Self { joints, numbers })
    }

    /// The number in the file of a joint that an error names.
    pub(super) fn number(&self, joint: usize) -> Option<usize> {
        self.numbers.get(joint).copied().flatten()
    }
}

impl System {
    /// What was derived of a body, what springs add, and what joints hold.
    #[must_use]
    pub fn derivation(&self) -> String {
        let gravity = if self.gravity.is_some() { "" } else { "without gravity, g = 0\n" };
        let springs = if self.springs.is_empty() { "" } else { Springs::DERIVATION };
        let joints = if self.joints.is_empty() { "" } else { BALLS };
        let pins = if self.has_pins() { PINS } else { "" };
        format!("{}{gravity}{springs}{joints}{pins}", Heavy::DERIVATION)
    }

    pub(super) fn stepper(&self) -> Result<Held, SetupError> {
        let (g, up) = self.gravity.unwrap_or((0.0, Vector3::z()));
        // What is behind the bodies is like the first without gravity, and rests.
        let heavy = |place: usize| {
            let (body, g) = self.bodies.get(place).map_or((&self.bodies[0], 0.0), |body| (body, g));
            Heavy { J_d: body.J_d, m: body.m, g, up }
        };
        let parts = Each::<BODIES>::of(from_fn(heavy)) + Springs::of(&self.springs);
        Stepper::jointed(parts, self.arranged.joints, self.step)
    }

    pub(super) fn start(&self) -> (HeldBodies, Bodies<Vector6<f64>, BODIES>) {
        let at = |place: usize| {
            let Some(body) = self.bodies.get(place) else {
                return ((SO3::identity(), R3::identity()), Vector6::zeros());
            };
            let (turn, shift) = (body.start.velocity, body.moving);
            let velocity = Vector6::new(turn.x, turn.y, turn.z, shift.x, shift.y, shift.z);
            ((SO3::from(body.start.attitude), R3::from(body.position)), velocity)
        };
        let all: [_; BODIES] = from_fn(at);
        (all.map(|(body, _)| body), Bodies(all.map(|(_, velocity)| velocity)))
    }
}
