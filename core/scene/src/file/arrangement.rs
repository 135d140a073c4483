//! Joints in the library's order: joints of trees, and joints that close loops.

use std::array::from_fn;

/// Most bodies of a file. Each number of bodies has compiled types of steppers.
pub(crate) const BODIES: usize = 8;
/// Most joints that close loops.
pub(crate) const LOOPS: usize = 4;

/// Joints in the library's order, each by its number in the file.
#[derive(Clone)]
pub(crate) struct Arrangement {
    pub(crate) tree: Vec<usize>,
    pub(crate) loops: Vec<usize>,
    /// One body of each tree that no joint connects to space; the tree moves freely.
    pub(crate) free: Vec<usize>,
}

impl Arrangement {
    /// Sorts joints, each between two bodies, of which `None` is space. A joint that connects two groups of bodies
    /// belongs to a tree; a joint within a group closes a loop. `Err` has the number of the first loop beyond the most.
    pub(crate) fn of(joints: impl Iterator<Item = [Option<usize>; 2]>) -> Result<Self, usize> {
        // Space has the last entry.
        let mut group: [usize; BODIES + 1] = from_fn(|body| body);
        let (mut tree, mut loops) = (Vec::new(), Vec::new());
        for (number, bodies) in joints.enumerate() {
            let [one, other] = bodies.map(|body| group[body.unwrap_or(BODIES)]);
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
        Ok(Self { tree, loops, free })
    }
}
