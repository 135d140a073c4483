//! Bodies of a file put where their joints are closed: positions and their velocities are mended, not how bodies turn.

use liestep::SO3;
use liestep::groups::R3;
use liestep::methods::Joint;
use nalgebra::{Vector3, Vector6};

use crate::file::system::{System, ends_and_axes};

/// A body's attitude and place, and its velocities, turning in its own axes.
type Moving = ((SO3, R3), Vector6<f64>);

impl System {
    /// Each body where the joints of trees put it, with the velocity that keeps them closed: from space on, and of trees
    /// that aren't tied to space with their centre of mass and its velocity as they were. Of a pin the angular velocity
    /// across its axis is that of the body before. Attitudes stay, and loops may be open.
    pub(crate) fn shifted(&self, mut bodies: Vec<Moving>) -> Vec<Moving> {
        let given = bodies.clone();
        // The body from which a tree goes on; `None` until it is reached.
        let mut root: Vec<Option<Option<usize>>> = vec![None; bodies.len()];
        for &body in &self.arrangement.free {
            if let Some(root) = root.get_mut(body) {
                *root = Some(Some(body));
            }
        }
        while let Some((joint, from, to)) = self.next_joint(&root) {
            root[to] = from.map_or(Some(None), |from| root[from]);
            let before = from.map(|from| bodies[from]);
            bodies[to] = joined(&self.joints[joint].of, before, bodies[to], self.joints[joint].bodies[1] == Some(to));
        }
        for &first in &self.arrangement.free {
            let tree: Vec<_> = (0..bodies.len()).filter(|&body| root[body] == Some(Some(first))).collect();
            let mass: f64 = tree.iter().map(|&body| self.bodies[body].m).sum();
            let mean = |of: &dyn Fn(&Moving) -> Vector3<f64>| -> Vector3<f64> {
                let moved = |&body: &usize| (of(&given[body]) - of(&bodies[body])) * (self.bodies[body].m / mass);
                tree.iter().map(moved).sum()
            };
            let (shift, drift) = (mean(&|body| body.0.1.translation().into_owned()), mean(&|body| linear(body)));
            for &body in &tree {
                let ((attitude, place), velocity) = bodies[body];
                let turning = velocity.fixed_rows::<3>(0).into_owned();
                let place = R3::from(place.translation() + shift);
                bodies[body] = ((attitude, place), both(&turning, &(linear(&bodies[body]) + drift)));
            }
        }
        bodies
    }

    /// A joint of a tree from what is reached, `None` being space, to a body that isn't.
    fn next_joint(&self, root: &[Option<Option<usize>>]) -> Option<(usize, Option<usize>, usize)> {
        let is_reached = |body: Option<usize>| body.is_none_or(|body| root[body].is_some());
        self.arrangement.tree.iter().find_map(|&joint| {
            let [above, below] = self.joints[joint].bodies;
            match (is_reached(above), is_reached(below)) {
                (true, false) => Some((joint, above, below?)),
                (false, true) => Some((joint, below, above?)),
                _ => None,
            }
        })
    }
}

fn linear((_, velocity): &Moving) -> Vector3<f64> {
    velocity.fixed_rows::<3>(3).into_owned()
}

fn both(turning: &Vector3<f64>, moving: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(turning.x, turning.y, turning.z, moving.x, moving.y, moving.z)
}

/// A body that is joined to the one before, or to space; `is_below` is whether it is the second of the joint.
fn joined(joint: &Joint, before: Option<Moving>, body: Moving, is_below: bool) -> Moving {
    let (ends, axes) = ends_and_axes(joint);
    let order = |pair: [Vector3<f64>; 2]| if is_below { pair } else { [pair[1], pair[0]] };
    let [point, own] = order(ends);
    // Where the point of the body before is, how it moves, and how that body turns, in space.
    let (place, moves, turns) = before.map_or((point, Vector3::zeros(), Vector3::zeros()), |before| {
        let ((attitude, place), velocity) = before;
        let R = attitude.as_matrix();
        let turns = R * velocity.fixed_rows::<3>(0);
        (place.translation() + R * point, linear(&before) + turns.cross(&(R * point)), turns)
    });
    let ((attitude, _), velocity) = body;
    let R = attitude.as_matrix();
    let mut turning = velocity.fixed_rows::<3>(0).into_owned();
    if let Some(axis) = axes.map(|axes| order(axes)[1]) {
        let across = R.tr_mul(&turns) - turning;
        turning += across - axis * across.dot(&axis);
    }
    let arm = R * own;
    let moving = moves - (R * turning).cross(&arm);
    ((attitude, R3::from(place - arm)), both(&turning, &moving))
}
