//! Joints in the order of the library: those of trees, and those that close loops.

use std::array::from_fn;

/// The most bodies of a file: the types of steppers for each number of bodies are compiled.
pub(crate) const BODIES: usize = 8;
/// The most joints that close loops.
pub(crate) const LOOPS: usize = 4;

/// Joints as the library takes them, by their numbers in the file.
#[derive(Clone)]
pub(crate) struct Arrangement {
    pub(crate) tree: Vec<usize>,
    pub(crate) loops: Vec<usize>,
    /// One body of each tree that no joint connects to space. Nothing holds it there.
    pub(crate) free: Vec<usize>,
}

impl Arrangement {
    /// Of joints between two bodies each, `None` being space. The first joints that lead to a body which none before leads
    /// to are those of trees, the others close loops; `Err` has the number of the first loop beyond the most.
    pub(crate) fn of(joints: impl Iterator<Item = [Option<usize>; 2]>) -> Result<Self, usize> {
        // Space is behind the last.
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
