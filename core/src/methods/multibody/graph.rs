//! The graph of joints, and the order of elimination of the bodies.

use alloc::collections::BTreeSet;
use alloc::sync::Arc;
use alloc::vec;
use alloc::vec::Vec;

use super::functions::Functions;
use super::point_joint::PointJoint;
use crate::error::SetupError;

/// A joint between two bodies, or between space and a body.
#[derive(Clone)]
pub(super) struct Joint {
    pub(super) functions: Arc<dyn Functions>,
    /// The body above; `None` is space.
    pub(super) above: Option<usize>,
    pub(super) below: usize,
    /// The joint as one that holds points, if it is one.
    pub(super) of_points: Option<PointJoint>,
    /// The number of functions.
    pub(super) rows: usize,
}

impl Joint {
    pub(super) fn new(functions: Arc<dyn Functions>, above: Option<usize>, below: usize) -> Self {
        Self { of_points: functions.of_points(), rows: functions.rows(), functions, above, below }
    }
}

/// A body's connection to its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Member {
    /// The joint towards space, or towards the root of its tree; `None` for a root.
    pub(super) joint: Option<usize>,
    /// The body at the joint's other end; `None` is space.
    pub(super) parent: Option<usize>,
    /// Whether this body is the joint's body below.
    pub(super) is_below: bool,
}

/// A body that is eliminated after another one, and that has unknowns in its equations or multipliers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Neighbour {
    pub(super) body: usize,
    /// Whether the equations of the two bodies have blocks in each other's unknowns.
    pub(super) is_coupled: bool,
}

/// The trees of all bodies, and the joints that close loops.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tree {
    /// The bodies from the roots on: each after its parent. Elimination has the opposite order.
    pub(super) order: Vec<usize>,
    pub(super) members: Vec<Member>,
    /// The neighbours of each body, its parent first.
    pub(super) neighbours: Vec<Vec<Neighbour>>,
    /// The numbers of the joints that close a loop each.
    pub(super) loops: Vec<usize>,
    /// The pairs of bodies that terms couple, each once.
    pub(super) couplings: Vec<[usize; 2]>,
}

impl Tree {
    /// The trees of `bodies` with these joints, and with terms that couple these pairs of bodies.
    pub(super) fn of(joints: &[Joint], bodies: usize, couplings: Vec<[usize; 2]>) -> Result<Self, SetupError> {
        for (joint, joined) in joints.iter().enumerate() {
            let refused = |cause| Err(SetupError::Joint { joint, cause });
            if joined.below >= bodies || joined.above.is_some_and(|above| above >= bodies) {
                return refused("is at a body that there isn't; they are counted from zero");
            }
            if joined.above == Some(joined.below) {
                return refused("joins a body to itself");
            }
            if let Err(error) = joined.functions.validate() {
                return match error {
                    SetupError::Parameter { field, cause } => Err(SetupError::JointParameter { joint, field, cause }),
                    error => Err(error),
                };
            }
        }
        let ends: Vec<_> = joints.iter().map(|joined| [joined.above, Some(joined.below)]).collect();
        let mut tree = Self::planted(&ends, bodies, couplings);
        // A joint that the others imply altogether imposes nothing.
        tree.loops.retain(|&joint| joints[joint].functions.rows() > 0);
        Ok(tree)
    }

    /// The joint of a body towards the root if it holds points, and if no term couples the body with a later one but the parent.
    pub(super) fn of_points(&self, joints: &[Joint], body: usize) -> Option<PointJoint> {
        let (member, neighbours) = (&self.members[body], &self.neighbours[body]);
        let is_parent = |neighbour: &Neighbour| Some(neighbour.body) == member.parent;
        let is_alone = neighbours.iter().all(|neighbour| is_parent(neighbour) || !neighbour.is_coupled);
        member.joint.and_then(|joint| joints[joint].of_points).filter(|_| is_alone && neighbours.len() < 2)
    }

    /// Whether all joints hold points of bodies in trees, and nothing else, so that their multipliers are always unique.
    pub(super) fn are_balls(&self, joints: &[Joint]) -> bool {
        let is_ball = |body| self.of_points(joints, body).is_some_and(|joint| joint.count == 0);
        self.loops.is_empty() && (0..self.members.len()).all(|body| self.members[body].joint.is_none() || is_ball(body))
    }

    /// The trees of these bodies without joints.
    pub(super) fn without_joints(&self) -> Self {
        Self::planted(&[], self.members.len(), self.couplings.clone())
    }

    /// The trees by the ends of the joints. A joint that connects two groups of bodies belongs to a tree; one within a
    /// group closes a loop.
    fn planted(ends: &[[Option<usize>; 2]], bodies: usize, couplings: Vec<[usize; 2]>) -> Self {
        // Space has the last entry.
        let mut group: Vec<usize> = (0..=bodies).collect();
        let (mut of_trees, mut loops) = (Vec::new(), Vec::new());
        for (joint, bodies_of) in ends.iter().enumerate() {
            let [one, other] = bodies_of.map(|body| group[body.unwrap_or(bodies)]);
            if one == other {
                loops.push(joint);
            } else {
                group.iter_mut().filter(|of| **of == other).for_each(|of| *of = one);
                of_trees.push(joint);
            }
        }
        let root = Member { joint: None, parent: None, is_below: false };
        let (mut order, mut members) = (Vec::with_capacity(bodies), vec![root; bodies]);
        let mut is_known = vec![false; bodies];
        let is_there = |is_known: &[bool], end: Option<usize>| end.is_none_or(|body| is_known[body]);
        loop {
            // A joint from a body that has been reached leads to a new body.
            let before = order.len();
            for &joint in &of_trees {
                let [above, below] = ends[joint];
                let (body, parent, is_below) = match (is_there(&is_known, above), is_there(&is_known, below)) {
                    (true, false) => (below, above, true),
                    (false, true) => (above, below, false),
                    _ => continue,
                };
                let Some(body) = body else { continue };
                members[body] = Member { joint: Some(joint), parent, is_below };
                is_known[body] = true;
                order.push(body);
            }
            if order.len() > before {
                continue;
            }
            // A body without a path to space is the root of a tree of its own.
            let Some(body) = is_known.iter().position(|is_known| !is_known) else { break };
            is_known[body] = true;
            order.push(body);
        }
        let parents = members.iter().map(|member| {
            let parent = member.parent.map(|body| Neighbour { body, is_coupled: false });
            parent.into_iter().collect()
        });
        let mut tree = Self { order, neighbours: parents.collect(), members, loops, couplings };
        if !tree.couplings.is_empty() {
            tree.find_neighbours();
        }
        tree
    }

    /// Sets the order of elimination and the neighbours of bodies that terms couple.
    ///
    /// A body that is eliminated couples all its neighbours with each other. Bodies are eliminated after those that hang
    /// on them; among the others, one with the fewest coupled bodies comes next. So terms between bodies that share a
    /// joint, or along a row, fill nothing; others fill the blocks on the paths between their bodies.
    fn find_neighbours(&mut self) {
        let mut coupled = vec![BTreeSet::new(); self.members.len()];
        for &[one, other] in &self.couplings {
            coupled[one].insert(other);
            coupled[other].insert(one);
        }
        let mut hanging = vec![0_usize; self.members.len()];
        for parent in self.members.iter().filter_map(|member| member.parent) {
            hanging[parent] += 1;
        }
        let (mut left, mut order) = (core::mem::take(&mut self.order), Vec::new());
        let others = |coupled: &[BTreeSet<usize>], body: usize, parent: Option<usize>| {
            coupled[body].len() - usize::from(parent.is_some_and(|parent| coupled[body].contains(&parent)))
        };
        loop {
            let free = (0..left.len()).rev().filter(|&place| hanging[left[place]] == 0);
            let fewest = free.min_by_key(|&place| others(&coupled, left[place], self.members[left[place]].parent));
            let Some(place) = fewest else { break };
            let body = left.remove(place);
            order.push(body);
            let with = core::mem::take(&mut coupled[body]);
            let parent = self.members[body].parent;
            if let Some(parent) = parent {
                hanging[parent] -= 1;
            }
            let all = parent.into_iter().chain(with.iter().copied().filter(|&other| Some(other) != parent));
            let of = |body: usize| Neighbour { body, is_coupled: with.contains(&body) };
            self.neighbours[body] = all.map(of).collect();
            for &other in &with {
                coupled[other].remove(&body);
                let filled = self.neighbours[body].iter().map(|neighbour| neighbour.body).filter(|&b| b != other);
                for filled in filled {
                    coupled[other].insert(filled);
                    coupled[filled].insert(other);
                }
            }
        }
        order.reverse();
        self.order = order;
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::Tree;

    /// The bodies that each body is eliminated before.
    fn neighbours(tree: &Tree) -> Vec<Vec<(usize, bool)>> {
        let of = |all: &Vec<super::Neighbour>| all.iter().map(|next| (next.body, next.is_coupled)).collect();
        tree.neighbours.iter().map(of).collect()
    }

    #[test]
    fn terms_fill_no_blocks_along_joints_and_rows() {
        let chain = [[None, Some(0)], [Some(0), Some(1)], [Some(1), Some(2)]];
        let tree = Tree::planted(&chain, 3, Vec::from([[0, 1], [1, 2]]));
        assert_eq!(tree.order, [0, 1, 2]);
        assert_eq!(neighbours(&tree), [Vec::new(), Vec::from([(0, true)]), Vec::from([(1, true)])]);
        // A row that is numbered in another order has no joints at all.
        let row = Tree::planted(&[], 4, Vec::from([[2, 0], [0, 3], [3, 1]]));
        let of_row = neighbours(&row);
        assert!(of_row.iter().all(|of_body| of_body.len() < 2), "{of_row:?}");
        assert_eq!(of_row.iter().map(Vec::len).sum::<usize>(), 3);
    }

    #[test]
    fn a_term_across_joints_fills_the_path_between_its_bodies() {
        let chain = [[None, Some(0)], [Some(0), Some(1)], [Some(1), Some(2)], [Some(2), Some(3)]];
        let tree = Tree::planted(&chain, 4, Vec::from([[0, 3]]));
        let expected = [
            Vec::new(),
            Vec::from([(0, true)]),
            Vec::from([(1, false), (0, true)]),
            Vec::from([(2, false), (0, true)]),
        ];
        assert_eq!(neighbours(&tree), expected);
        // Two branches from space, coupled at their ends.
        let branches = [[None, Some(0)], [Some(0), Some(1)], [None, Some(2)], [Some(2), Some(3)]];
        let tree = Tree::planted(&branches, 4, Vec::from([[1, 3]]));
        assert_eq!(tree.neighbours.iter().map(Vec::len).sum::<usize>(), 4);
        let place = |body: usize| tree.order.iter().position(|&other| other == body);
        assert!(place(0) < place(1) && place(2) < place(3), "{:?}", tree.order);
    }

    #[test]
    fn trees_are_planted_whatever_the_order_and_the_direction_of_their_joints() {
        // Body 2 hangs on space, 0 and 4 on 2, 1 on 4; 3 floats, with 5 on it.
        let ends = [[Some(1), Some(4)], [Some(0), Some(2)], [Some(2), Some(4)], [None, Some(2)], [Some(3), Some(5)]];
        let tree = Tree::planted(&ends, 6, Vec::new());
        let of = |body: usize| (tree.members[body].joint, tree.members[body].parent, tree.members[body].is_below);
        assert_eq!(of(2), (Some(3), None, true));
        assert_eq!(of(0), (Some(1), Some(2), false));
        assert_eq!(of(4), (Some(2), Some(2), true));
        assert_eq!(of(1), (Some(0), Some(4), false));
        assert_eq!((of(3), of(5)), ((None, None, false), (Some(4), Some(3), true)));
        for (place, &body) in tree.order.iter().enumerate() {
            assert!(tree.members[body].parent.is_none_or(|parent| tree.order[..place].contains(&parent)));
        }
    }

    #[test]
    fn a_joint_within_a_group_closes_a_loop() {
        let ends = [[None, Some(0)], [Some(0), Some(1)], [None, Some(1)], [Some(2), Some(3)], [Some(3), Some(2)]];
        let tree = Tree::planted(&ends, 4, Vec::new());
        assert_eq!(tree.loops, [2, 4]);
        assert_eq!(tree.members[1].joint, Some(1));
    }
}
