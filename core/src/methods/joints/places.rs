//! Where bodies are, and what joints feel of that.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::graph::{Joined, Joints, Tree};
use super::{Constraint, Place, Slope};
use crate::groups::{R3, SO3};

/// The two maps of one end of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ends<const K: usize> {
    /// `Eᵀ`: from multipliers to the body's momentum, torque in its axes first.
    pub(super) before: SMatrix<f64, 6, K>,
    /// `C`: from the body's unknowns to the functions.
    pub(super) after: SMatrix<f64, K, 6>,
}

impl<const K: usize> Ends<K> {
    /// How much each function changes as the body turns by one, and as it is shifted by one.
    fn rates(&self) -> [SVector<f64, K>; 2] {
        [0, 3].map(|first| SVector::from_fn(|row, _| self.before.fixed_view::<3, 1>(first, row).norm()))
    }

    /// The longest arm at which a turn shifts what the functions compare, m; zero where they compare directions alone.
    pub(super) fn arm(&self) -> f64 {
        let [turns, shifts] = self.rates();
        let of = |row: usize| if shifts[row] > 0.0 { turns[row] / shifts[row] } else { 0.0 };
        (0..K).map(of).fold(0.0, f64::max)
    }

    /// How much each function changes by terms of these sizes: `turn` in rad or rad/s, and `shift` in m or m/s, or what
    /// the turn makes of the arm, where that is more.
    pub(super) fn sizes(&self, turn: f64, shift: f64) -> SVector<f64, K> {
        let [turns, shifts] = self.rates();
        turns * turn + shifts * shift.max(self.arm() * turn)
    }
}

/// Of both ends: of a tree's joint that of the body and that of its parent, of one that closes a loop that of the body
/// below and that of the body above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slopes<const K: usize>(pub(super) [Ends<K>; 2]);

impl<const K: usize> Slopes<K> {
    pub(super) fn new() -> Self {
        Self([Ends { before: SMatrix::zeros(), after: SMatrix::zeros() }; 2])
    }
}

/// All bodies.
pub(super) struct Places<const N: usize>(pub(super) [Place; N]);

impl<const N: usize> Places<N> {
    pub(super) fn of(bodies: &[(SO3, R3); N]) -> Self {
        Self(bodies.map(|(attitude, place)| Place { attitude: *attitude.as_matrix(), position: place.translation() }))
    }

    fn get(&self, body: Option<usize>) -> Place {
        body.map_or(Place::SPACE, |body| self.0[body])
    }

    /// The functions of a joint.
    pub(super) fn gap<C: Constraint<K>, const K: usize>(&self, joined: &Joined<C>) -> SVector<f64, K> {
        joined.joint.gap(&self.get(joined.above), &self.0[joined.below])
    }

    /// Their derivatives, that of the body below first.
    fn slope<C: Constraint<K>, const K: usize>(&self, joined: &Joined<C>) -> [(Option<usize>, Slope<K>); 2] {
        let [above, below] = joined.joint.slope(&self.get(joined.above), &self.0[joined.below]);
        [(Some(joined.below), below), (joined.above, above)]
    }
}

/// The slopes of all joints, those of the trees by the bodies that hang on them: what `of` makes of each.
pub(super) fn each_slope<C: Constraint<K>, const K: usize, const N: usize, const T: usize, const L: usize>(
    places: &Places<N>,
    joints: &Joints<C, T, L>,
    tree: &Tree<N>,
    mut of: impl FnMut(Held, usize, usize, &Slope<K>),
) {
    for (k, member) in tree.members.iter().enumerate() {
        let Some(joined) = member.joint.and_then(|joint| joints.tree.get(joint)) else { continue };
        for (side, (body, slope)) in places.slope(joined).iter().enumerate() {
            let Some(body) = body else { continue };
            // Those of the body itself come first.
            of(Held::Body(k), if member.is_below { side } else { 1 - side }, *body, slope);
        }
    }
    for (k, joined) in joints.loops.iter().enumerate() {
        for (side, (body, slope)) in places.slope(joined).iter().enumerate() {
            let Some(body) = body else { continue };
            of(Held::Loop(k), side, *body, slope);
        }
    }
}

/// What a joint holds: in a tree the body with this number, or the loop with it.
#[derive(Clone, Copy)]
pub(super) enum Held {
    Body(usize),
    Loop(usize),
}

/// `Eᵀ` of a body with this attitude.
pub(super) fn before<const K: usize>(slope: &Slope<K>, attitude: &Matrix3<f64>) -> SMatrix<f64, 6, K> {
    let mut before = SMatrix::<f64, 6, K>::zeros();
    before.fixed_rows_mut::<3>(0).copy_from(&(slope.turn * attitude).transpose());
    before.fixed_rows_mut::<3>(3).copy_from(&slope.shift.transpose());
    before
}

/// `C` of a body whose unknowns turn it by this map, in the axes of space, and shift it by themselves.
pub(super) fn after<const K: usize>(slope: &Slope<K>, turn: &Matrix3<f64>) -> SMatrix<f64, K, 6> {
    let mut after = SMatrix::<f64, K, 6>::zeros();
    after.fixed_columns_mut::<3>(0).copy_from(&(slope.turn * turn));
    after.fixed_columns_mut::<3>(3).copy_from(&slope.shift);
    after
}

/// The turning part of a body's components, and the other.
pub(super) fn parts(components: &nalgebra::Vector6<f64>) -> (Vector3<f64>, Vector3<f64>) {
    (components.fixed_rows::<3>(0).into_owned(), components.fixed_rows::<3>(3).into_owned())
}
