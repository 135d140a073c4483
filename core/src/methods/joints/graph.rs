//! The graph of joints, and the order of elimination of the bodies.

use super::Constraint;
use crate::error::SetupError;

/// A joint between two bodies, or between space and a body. Bodies are counted from zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedJoint<C> {
    /// The joint.
    pub joint: C,
    /// The body above; `None` is space.
    pub above: Option<usize>,
    /// The body below.
    pub below: usize,
}

impl<C> PlacedJoint<C> {
    /// A joint between two bodies.
    #[must_use]
    pub const fn between(joint: C, above: usize, below: usize) -> Self {
        Self { joint, above: Some(above), below }
    }

    /// A joint between space and a body: a pivot.
    #[must_use]
    pub const fn to_space(joint: C, below: usize) -> Self {
        Self { joint, above: None, below }
    }
}

/// The joints of a system: `T` that form trees, and `L` that close one loop each.
///
/// A chain, a tree or several of them have no loop, whether they are joined to space or not. Each loop has one joint in
/// the second list; the choice doesn't change the motion. An error counts the joints of the tree first and then those
/// that close loops, from zero.
///
/// # Examples
///
/// Ten links in a row on a pivot, and the same links with their end on a second pivot.
///
/// ```
/// use core::array::from_fn;
/// use liestep::methods::{BallJoint, PlacedJoint, Joints};
/// use nalgebra::Vector3;
///
/// // From the centre of mass of each link.
/// let (upper, lower) = (Vector3::z() * 0.5, Vector3::z() * -0.5);
/// let pivot = |x: f64, below| BallJoint { above: Vector3::new(x, 0.0, 0.0), below };
/// let link = BallJoint { above: lower, below: upper };
/// let chain = Joints::tree(from_fn::<_, 10, _>(|k| match k {
///     0 => PlacedJoint::to_space(pivot(0.0, upper), 0),
///     _ => PlacedJoint::between(link, k - 1, k),
/// }));
/// let garland = chain.closed_by([PlacedJoint::to_space(pivot(8.0, lower), 9)]);
/// # let _ = garland;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joints<C, const T: usize, const L: usize> {
    pub(super) tree: [PlacedJoint<C>; T],
    pub(super) loops: [PlacedJoint<C>; L],
}

impl<C, const T: usize> Joints<C, T, 0> {
    /// Joints without loops.
    #[must_use]
    pub const fn tree(tree: [PlacedJoint<C>; T]) -> Self {
        Self { tree, loops: [] }
    }

    /// Adds joints that close a loop each.
    #[must_use]
    pub fn closed_by<const L: usize>(self, loops: [PlacedJoint<C>; L]) -> Joints<C, T, L> {
        Joints { tree: self.tree, loops }
    }
}

impl<C, const T: usize, const L: usize> Joints<C, T, L> {
    /// All joints with their numbers, those of the tree first.
    pub(super) fn all(&self) -> impl Iterator<Item = (usize, &PlacedJoint<C>)> {
        self.tree.iter().chain(&self.loops).enumerate()
    }

    /// Checks the bodies and the parameters, and constructs the trees.
    pub(super) fn planted<const K: usize, const N: usize>(&self) -> Result<Tree<N>, SetupError>
    where
        C: Constraint<K>,
    {
        for (joint, joined) in self.all() {
            let refused = |cause| Err(SetupError::Joint { joint, cause });
            if joined.below >= N || joined.above.is_some_and(|above| above >= N) {
                return refused("is at a body that there isn't; they are counted from zero");
            }
            if joined.above == Some(joined.below) {
                return refused("joins a body to itself");
            }
            if let Err(error) = joined.joint.validate() {
                return match error {
                    SetupError::Parameter { field, cause } => Err(SetupError::JointParameter { joint, field, cause }),
                    error => Err(error),
                };
            }
        }
        Tree::planted(&self.tree.each_ref().map(|joined| [joined.above, Some(joined.below)]))
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

/// The trees of all bodies.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tree<const N: usize> {
    /// The bodies from the roots on: each after its parent.
    pub(super) order: [usize; N],
    pub(super) members: [Member; N],
}

impl<const N: usize> Tree<N> {
    /// Constructs the trees from the ends of the joints.
    fn planted(ends: &[[Option<usize>; 2]]) -> Result<Self, SetupError> {
        let root = Member { joint: None, parent: None, is_below: false };
        let (mut order, mut members) = ([0; N], [root; N]);
        let (mut is_known, mut known) = ([false; N], 0);
        let is_there = |is_known: &[bool; N], end: Option<usize>| end.is_none_or(|body| is_known[body]);
        loop {
            // A joint from a body that has been reached either leads to a new body, or closes a loop.
            let mut has_grown = false;
            for (joint, &[above, below]) in ends.iter().enumerate() {
                let (body, parent, is_below) = match (is_there(&is_known, above), is_there(&is_known, below)) {
                    (true, false) => (below, above, true),
                    (false, true) => (above, below, false),
                    _ => continue,
                };
                let Some(body) = body else { continue };
                members[body] = Member { joint: Some(joint), parent, is_below };
                (is_known[body], order[known]) = (true, body);
                (known, has_grown) = (known + 1, true);
            }
            if has_grown {
                continue;
            }
            // A body without a path to space is the root of a tree of its own.
            let Some(body) = is_known.iter().position(|is_known| !is_known) else { break };
            (is_known[body], order[known]) = (true, body);
            known += 1;
        }
        let in_tree = |joint: usize| members.iter().any(|member| member.joint == Some(joint));
        match (0..ends.len()).find(|&joint| !in_tree(joint)) {
            Some(joint) => Err(SetupError::Joint { joint, cause: "closes a loop: it belongs into `closed_by`" }),
            None => Ok(Self { order, members }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Tree;
    use crate::error::SetupError;

    #[test]
    fn trees_are_planted_whatever_the_order_and_the_direction_of_their_joints() {
        // Body 2 hangs on space, 0 and 4 on 2, 1 on 4; 3 floats, with 5 on it.
        let ends = [[Some(1), Some(4)], [Some(0), Some(2)], [Some(2), Some(4)], [None, Some(2)], [Some(3), Some(5)]];
        let tree = Tree::<6>::planted(&ends).unwrap();
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
    fn a_joint_that_closes_a_loop_is_named() {
        let ends = [[None, Some(0)], [Some(0), Some(1)], [None, Some(1)]];
        let error = Tree::<2>::planted(&ends).unwrap_err();
        assert!(matches!(error, SetupError::Joint { joint: 2, .. }), "{error}");
    }
}
