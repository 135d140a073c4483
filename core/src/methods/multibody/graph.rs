//! The graph of joints, and the order of elimination of the bodies.

use alloc::sync::Arc;
use alloc::vec;
use alloc::vec::Vec;

use super::functions::Functions;
use crate::error::SetupError;

/// A joint between two bodies, or between space and a body.
#[derive(Clone)]
pub(super) struct Joined {
    pub(super) functions: Arc<dyn Functions>,
    /// The body above; `None` is space.
    pub(super) above: Option<usize>,
    pub(super) below: usize,
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

/// The trees of all bodies, and the joints that close loops.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tree {
    /// The bodies from the roots on: each after its parent.
    pub(super) order: Vec<usize>,
    pub(super) members: Vec<Member>,
    /// The numbers of the joints that close a loop each.
    pub(super) loops: Vec<usize>,
}

impl Tree {
    /// The trees of `bodies` with these joints.
    pub(super) fn of(joints: &[Joined], bodies: usize) -> Result<Self, SetupError> {
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
        Ok(Self::planted(&ends, bodies))
    }

    /// The trees by the ends of the joints. A joint that connects two groups of bodies belongs to a tree; one within a
    /// group closes a loop.
    fn planted(ends: &[[Option<usize>; 2]], bodies: usize) -> Self {
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
        Self { order, members, loops }
    }
}

#[cfg(test)]
mod tests {
    use super::Tree;

    #[test]
    fn trees_are_planted_whatever_the_order_and_the_direction_of_their_joints() {
        // Body 2 hangs on space, 0 and 4 on 2, 1 on 4; 3 floats, with 5 on it.
        let ends = [[Some(1), Some(4)], [Some(0), Some(2)], [Some(2), Some(4)], [None, Some(2)], [Some(3), Some(5)]];
        let tree = Tree::planted(&ends, 6);
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
        let tree = Tree::planted(&ends, 4);
        assert_eq!(tree.loops, [2, 4]);
        assert_eq!(tree.members[1].joint, Some(1));
    }
}
