//! The equations of jointed bodies, at one configuration.

use alloc::vec::Vec;

use nalgebra::{Matrix3, Matrix6, Vector2, Vector3, Vector6};

roots!();

use super::ball::Ball;
use super::balls::{BallMatrices, BallReactions, BallSlopes, BallVelocities, Increments};
use super::constraint::Place;
use super::couplings::Coefficients;
use super::elimination::{factorise, solve};
use super::ends::Ends;
use super::graph::{Joint, Member, Neighbour, Tree};
use super::nodes::{Loop, Node, Unknowns, set_blocks};
use super::point_joint::PointJoint;
use super::{parts, place_of};
use crate::numbers::on_registers;

/// The least pivot of a joint that closes a loop and isn't redundant, relative to that between free bodies. The
/// rounding error of a zero is some `1e-14`. Near a singular configuration a pivot is quadratic in the distance to it,
/// so this limit is some 3 µrad away. It is also proportional to the ratio of the bodies' masses: ratios of 1e11 are
/// refused.
const REDUNDANT: f64 = 1e-11;

/// The least pivot of a joint with independent functions: the rounding error of a zero in a tree, whose pivots are
/// relative to the joint's own matrix. A point mass on an arm of ten million radii is at the limit.
const DEPENDENT: f64 = 1e-14;

/// The joint with the widest gap, or with the fastest opening one.
pub(super) struct Widest {
    pub(super) joint: usize,
    /// The norm of its gap, in the units of its functions.
    pub(super) by: f64,
    /// The largest value of a function, relative to the size of its terms.
    pub(super) relative: f64,
}

/// Matrices, slopes and right-hand sides; after a solution the unknowns.
#[derive(Clone, Default)]
pub(super) struct Equations {
    nodes: Vec<Node>,
    loops: Vec<Loop>,
    pub(super) unknowns: Unknowns,
}

/// The derivative map of an end that a slope is for.
#[derive(Clone, Copy)]
enum Side {
    Before,
    After,
}

impl Side {
    fn of(self, ends: &mut Ends) -> &mut Matrix6<f64> {
        match self {
            Self::Before => &mut ends.before,
            Self::After => &mut ends.after,
        }
    }
}

/// The functions of a joint at these places.
pub(super) fn gap(joined: &Joint, places: &[Place]) -> Vector6<f64> {
    let (above, below) = (place_of(places, joined.above), &places[joined.below]);
    match &joined.of_points {
        Some(joint) => joint.gap(above, below),
        None => joined.functions.gap(above, below),
    }
}

/// The functions of a joint at these places, in which its points are held if it holds points.
pub(super) fn held_gap(joined: &Joint, places: &[Place], is_held: bool) -> Vector6<f64> {
    match &joined.of_points {
        Some(joint) if is_held => joint.cosines(place_of(places, joined.above), &places[joined.below]),
        _ => gap(joined, places),
    }
}

/// The gap of a joint by all its functions, if some of them aren't imposed.
pub(super) fn gap_of_all(joined: &Joint, places: &[Place]) -> Option<Vector6<f64>> {
    joined.functions.gap_of_all(place_of(places, joined.above), &places[joined.below])
}

impl Equations {
    /// Makes room for these bodies and joints, if the last ones were others. Slopes and matrices aren't set.
    pub(super) fn fit(&mut self, joints: &[Joint], tree: &Tree) {
        let rows = |joint: Option<usize>| joint.map_or(0, |joint| joints[joint].rows);
        let all = [tree.members.len(), tree.loops.len()];
        let of_points = |body: usize| tree.of_points(joints, body);
        // The point of the parent's own joint.
        let from = |member: &Member| {
            let joint = member.parent.and_then(of_points);
            let is_below = member.parent.is_some_and(|parent| tree.members[parent].is_below);
            joint.map_or_else(Vector3::zeros, |joint| joint.points[usize::from(is_below)])
        };
        let is_coupled = |neighbours: &[Neighbour]| neighbours.iter().any(|neighbour| neighbour.is_coupled);
        let ball = |body: usize, joint: PointJoint| {
            let member = &tree.members[body];
            Ball::new(joint, member.is_below, is_coupled(&tree.neighbours[body]), &from(member))
        };
        let node = |(body, member): (usize, &Member)| Node {
            ball: of_points(body).map(|joint| ball(body, joint)),
            ..Node::new(rows(member.joint), member.parent.is_some(), &tree.neighbours[body])
        };
        let is_like = |(one, (body, member)): (&Node, (usize, &Member))| {
            let is_ball = match (&one.ball, of_points(body)) {
                (Some(ball), Some(joint)) => ball.is_like(&joint, member.is_below, &from(member)),
                (ball, joint) => ball.is_none() && joint.is_none(),
            };
            is_ball && one.is_like(rows(member.joint), member.parent.is_some(), &tree.neighbours[body])
        };
        let members = || tree.members.iter().enumerate();
        let bodies = |joint: usize| [Some(joints[joint].below), joints[joint].above];
        let fits = self.nodes.len() == all[0]
            && self.loops.len() == all[1]
            && self.nodes.iter().zip(members()).all(is_like)
            && self
                .loops
                .iter()
                .zip(&tree.loops)
                .all(|(one, &joint)| one.is_like(bodies(joint), rows(Some(joint)), all));
        if fits {
            return;
        }
        self.nodes.clear();
        self.nodes.extend(members().map(node));
        self.loops.clear();
        self.loops.extend(tree.loops.iter().map(|&joint| Loop::new(bodies(joint), rows(Some(joint)), all)));
        self.unknowns.bodies.resize(all[0], Vector6::zeros());
        self.unknowns.joints.resize(all[0], Vector6::zeros());
        self.unknowns.loops.resize(all[1], Vector6::zeros());
    }

    /// Sets one of the slopes of all joints at these places, for unknowns that turn the bodies by these maps.
    fn set(
        &mut self,
        joints: &[Joint],
        tree: &Tree,
        places: &[Place],
        side: Side,
        turn: impl Fn(usize) -> Matrix3<f64>,
    ) {
        for (k, (node, member)) in self.nodes.iter_mut().zip(&tree.members).enumerate() {
            let Some(joint) = member.joint else { continue };
            if node.ball.is_some() {
                continue;
            }
            let joined = &joints[joint];
            let (own, other) = (turn(k), member.parent.map(&turn));
            let [of_own, of_other] = &mut *node.ends;
            let (own, other) = ((Some(&own), side.of(of_own)), (other.as_ref(), side.of(of_other)));
            let [above, below] = if member.is_below { [other, own] } else { [own, other] };
            let at = [place_of(places, joined.above), &places[joined.below]];
            joined.functions.slopes(at, [above.0, below.0], [above.1, below.1]);
        }
        for (closing, &joint) in self.loops.iter_mut().zip(&tree.loops) {
            let joined = &joints[joint];
            let [below, above] = &mut closing.ends;
            let (of_above, of_below) = (joined.above.map(&turn), turn(joined.below));
            let at = [place_of(places, joined.above), &places[joined.below]];
            joined.functions.slopes(at, [of_above.as_ref(), Some(&of_below)], [side.of(above), side.of(below)]);
        }
    }

    /// Sets the places after these half increments, and the turns by the unknowns; sets the shifts of bodies on ball joints.
    pub(super) fn set_next(
        &mut self,
        tree: &Tree,
        places: &[Place],
        half: &mut [Vector6<f64>],
        (next, turns): (&mut [Place], &mut [Matrix3<f64>]),
    ) {
        let points = &mut self.unknowns.pairs;
        points.resize(tree.members.len(), [[0.0; 4]; 2]);
        on_registers(Increments { tree, nodes: &self.nodes, places, half, next, turns, points });
    }

    /// Sets `E` at these places.
    pub(super) fn set_before(&mut self, joints: &[Joint], tree: &Tree, places: &[Place]) {
        on_registers(BallSlopes { tree, nodes: &mut self.nodes, places, turns: None });
        self.set(joints, tree, places, Side::Before, |body| places[body].attitude);
    }

    /// Sets `C` at these places, for unknowns that turn the bodies by these maps.
    pub(super) fn set_after(&mut self, joints: &[Joint], tree: &Tree, places: &[Place], turns: &[Matrix3<f64>]) {
        on_registers(BallSlopes { tree, nodes: &mut self.nodes, places, turns: Some(turns) });
        self.set(joints, tree, places, Side::After, |body| turns[body]);
    }

    /// Sets the equations of velocities at these places, with `C = E`, by the inertias of the bodies.
    pub(super) fn set_velocities(&mut self, joints: &[Joint], tree: &Tree, places: &[Place], inertias: &Coefficients) {
        self.set_before(joints, tree, places);
        on_registers(BallVelocities { nodes: &mut self.nodes });
        let others = self.nodes.iter_mut().filter(|node| node.ball.is_none());
        others.flat_map(|node| &mut *node.ends).for_each(|ends| ends.after = ends.before);
        let of_loops = self.loops.iter_mut().flat_map(|closing| &mut closing.ends);
        of_loops.for_each(|ends| ends.after = ends.before);
        self.factorise(tree, inertias);
    }

    /// Factorises these matrices of the bodies and their blocks.
    pub(super) fn factorise(&mut self, tree: &Tree, coefficients: &Coefficients) {
        let has_loops = !self.loops.is_empty();
        on_registers(BallMatrices { nodes: &mut self.nodes, matrices: &coefficients.matrices });
        for (node, matrix) in self.nodes.iter_mut().zip(&coefficients.matrices) {
            // Loops compare their pivots with those between free bodies.
            if node.ball.is_none() || has_loops {
                node.matrix = *matrix;
            }
        }
        set_blocks(tree, &mut self.nodes, &coefficients.blocks);
        factorise(tree, &mut self.nodes, &mut self.loops, &mut self.unknowns.pairs);
    }

    /// Solves for these residuals of the bodies and gaps of the joints, by their numbers and by whether the places of the bodies
    /// hold the joint's points; returns the result of [`solve`].
    pub(super) fn solve(
        &mut self,
        tree: &Tree,
        residuals: &[Vector6<f64>],
        gap: impl Fn(usize, bool) -> Vector6<f64>,
    ) -> Vector2<f64> {
        self.unknowns.bodies.copy_from_slice(residuals);
        for ((unknown, member), node) in self.unknowns.joints.iter_mut().zip(&tree.members).zip(&self.nodes) {
            *unknown = member.joint.map_or_else(Vector6::zeros, |joint| gap(joint, node.ball.is_some()));
        }
        for (unknown, &joint) in self.unknowns.loops.iter_mut().zip(&tree.loops) {
            *unknown = gap(joint, false);
        }
        solve(tree, &self.nodes, &self.loops, &mut self.unknowns)
    }

    /// Writes the reactions `Σ Eᵀ p` of each body: the momentum that the multipliers take.
    pub(super) fn reactions(&self, tree: &Tree, reactions: &mut [Vector6<f64>]) {
        reactions.fill(Vector6::zeros());
        on_registers(BallReactions { tree, nodes: &self.nodes, multipliers: &self.unknowns.joints, reactions });
        for (k, (node, member)) in self.nodes.iter().zip(&tree.members).enumerate() {
            if member.joint.is_none() || node.ball.is_some() {
                continue;
            }
            let multipliers = &self.unknowns.joints[k];
            let [own, of_parent] = node.ends.each_ref().map(|ends| ends.momentum(multipliers));
            reactions[k] += own;
            if let Some(parent) = member.parent {
                reactions[parent] += of_parent;
            }
        }
        for (closing, multiplier) in self.loops.iter().zip(&self.unknowns.loops) {
            closing.ends().for_each(|(body, ends)| reactions[body] += ends.momentum(multiplier));
        }
    }

    /// Adds the multipliers of all joints, each with this factor, by their numbers.
    pub(super) fn add_multipliers(&self, tree: &Tree, factor: f64, forces: &mut [Vector6<f64>]) {
        for (member, multiplier) in tree.members.iter().zip(&self.unknowns.joints) {
            if let Some(joint) = member.joint {
                forces[joint] += multiplier * factor;
            }
        }
        for (&joint, multiplier) in tree.loops.iter().zip(&self.unknowns.loops) {
            forces[joint] += multiplier * factor;
        }
    }

    /// The joint with the widest gap; `lengths` are the bodies' radii of gyration, m.
    pub(super) fn widest_gap(joints: &[Joint], places: &[Place], lengths: &[f64]) -> Widest {
        let shift = |body: usize| lengths[body].max(places[body].position.norm());
        Self::widest((joints, places), 1.0, shift, |joint, _| gap(&joints[joint], places))
    }

    /// The joint that these velocities open fastest, by `E y`; turns slower than `least`, rad/s, count as zero.
    pub(super) fn widest_parting(
        at: (&[Joint], &[Place]),
        velocities: &[Vector6<f64>],
        lengths: &[f64],
        least: f64,
    ) -> Widest {
        let largest = |of: fn(&Vector6<f64>) -> f64| velocities.iter().map(of).fold(0.0, f64::max);
        let turn = largest(|velocity| parts(velocity).0.norm()).max(least);
        let speed = largest(|velocity| parts(velocity).1.norm());
        Self::widest(
            at,
            turn,
            |body| speed.max(lengths[body] * turn),
            |_, ends| {
                ends.iter().fold(Vector6::zeros(), |sum, &(body, ends)| sum + ends.before.tr_mul(&velocities[body]))
            },
        )
    }

    /// The widest gap among these values of the functions, each relative to the size of its own terms.
    fn widest(
        (joints, places): (&[Joint], &[Place]),
        turn: f64,
        shift: impl Fn(usize) -> f64,
        values: impl Fn(usize, &[(usize, &Ends)]) -> Vector6<f64>,
    ) -> Widest {
        let mut widest = Widest { joint: 0, by: 0.0, relative: 0.0 };
        for (joint, joined) in joints.iter().enumerate() {
            let (mut above, mut below) = (Ends::ZERO, Ends::ZERO);
            let at = [place_of(places, joined.above), &places[joined.below]];
            let turns = at.map(|place| Some(&place.attitude));
            joined.functions.slopes(at, turns, [&mut above.before, &mut below.before]);
            let (own, other) = ((joined.below, &below), joined.above.map(|body| (body, &above)));
            let of = |ends: &[(usize, &Ends)]| {
                let sizes =
                    ends.iter().fold(Vector6::<f64>::zeros(), |sum, &(body, ends)| sum + ends.sizes(turn, shift(body)));
                (values(joint, ends), sizes)
            };
            let (values, sizes) = other.map_or_else(|| of(&[own]), |other| of(&[own, other]));
            for (value, size) in values.iter().zip(&sizes) {
                let relative = if *value == 0.0 { 0.0 } else { value.abs() / size };
                // A NaN counts as the widest gap.
                if !(relative <= widest.relative || widest.relative.is_nan()) {
                    widest = Widest { joint, by: values.norm(), relative };
                }
            }
        }
        widest
    }

    /// The largest distance of a body from the origin, or of a joint's points from their body, m. The rounding errors
    /// of positions are relative to this length.
    pub(super) fn extent(&self, places: &[Place]) -> f64 {
        let of_bodies = self.nodes.iter().map(|node| match &node.ball {
            Some(ball) => ball.squared_arm(),
            None => node.ends.iter().map(|ends| ends.squared_arm(node.rows)).fold(0.0, f64::max),
        });
        let of_loops = self.loops.iter().flat_map(|closing| &closing.ends).map(|ends| ends.squared_arm(6));
        let arms = of_bodies.chain(of_loops);
        places.iter().map(|place| place.position.norm_squared()).chain(arms).fold(0.0, f64::max).sqrt()
    }

    /// The first body whose pivot block has a determinant of the wrong sign.
    pub(super) fn wrong_body(&self) -> Option<usize> {
        // A NaN counts as the wrong sign.
        let is_right = |node: &Node| node.determinant > 0.0;
        self.nodes.iter().position(|node| !is_right(node))
    }

    pub(super) fn determinant(&self, body: usize) -> f64 {
        self.nodes[body].determinant
    }

    /// The determinant of the whole system, relative to its diagonal, if its sign is wrong while those of the bodies
    /// are positive. Along the branch that continues rest it never vanishes, so a solution with a changed sign is on
    /// another branch; a strut, for example, has a solution on either side. The signs of single joints may change, and
    /// which ones do depends on the choice of the joints that close loops; the sign of the whole doesn't.
    pub(super) fn reversed(&self) -> Option<f64> {
        let of_trees = self.nodes.iter().map(|node| node.of_joint);
        let of_joints = of_trees.chain(self.loops.iter().map(|closing| closing.of_joint));
        // The product of signs can't underflow as the product of the determinants could.
        let sign = |determinant: f64| if determinant == 0.0 { 0.0 } else { determinant.signum() };
        // A NaN counts as the wrong sign.
        let is_right = of_joints.clone().map(sign).product::<f64>() > 0.0;
        let of_bodies = self.nodes.iter().map(|node| node.determinant);
        if is_right { None } else { Some(of_bodies.chain(of_joints).product()) }
    }

    /// The first joint with dependent functions, or that is redundant beside the others: its number, and its pivot
    /// relative to that between free bodies.
    pub(super) fn redundant(&self, tree: &Tree) -> Option<(usize, f64)> {
        // Far from rest a pivot of the tree may be negative, as the matrix isn't symmetric. A NaN counts as zero.
        let has_rank = |node: &Node| node.pivot.abs() > DEPENDENT;
        for (node, member) in self.nodes.iter().zip(&tree.members) {
            if let (Some(joint), false) = (member.joint, has_rank(node)) {
                return Some((joint, node.pivot));
            }
        }
        let place = self.first_redundant_loop()?;
        Some((tree.loops[place], self.loops[place].pivot))
    }

    fn first_redundant_loop(&self) -> Option<usize> {
        let has_something = |closing: &Loop| closing.pivot > REDUNDANT;
        self.loops.iter().position(|closing| !has_something(closing))
    }

    /// The first joint that closes a loop and has functions which those before it imply, and the numbers of its others, at
    /// rest. The pivots of its Schur complement are taken in the order of their sizes, relative to free bodies.
    pub(super) fn independent(&self, tree: &Tree) -> Option<(usize, Vec<usize>)> {
        let place = self.first_redundant_loop()?;
        let closing = &self.loops[place];
        let (mut block, mut kept) = (closing.block, Vec::new());
        let mut rest: Vec<usize> = (0..closing.rows).collect();
        loop {
            let relative = |&row: &usize| block[(row, row)] / closing.free[row];
            let Some(best) = (0..rest.len()).max_by(|&a, &b| relative(&rest[a]).total_cmp(&relative(&rest[b]))) else {
                break;
            };
            let row = rest.remove(best);
            // A NaN counts as zero.
            let is_independent = relative(&row) > REDUNDANT;
            if !is_independent {
                break;
            }
            kept.push(row);
            let (column, pivot) = (block.column(row).into_owned(), block[(row, row)]);
            for &other in &rest {
                let factor = block[(row, other)] / pivot;
                for &another in &rest {
                    block[(another, other)] -= column[another] * factor;
                }
            }
        }
        kept.sort_unstable();
        Some((tree.loops[place], kept))
    }
}
