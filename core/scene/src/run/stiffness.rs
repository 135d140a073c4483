//! The stability limit of springs: kicks at the ends of a step are unstable beyond `hω = 2` of the fastest vibration.

use liestep::SO3;
use liestep::groups::R3;
use liestep::mechanics::Inertia;
use liestep::methods::{Constraint as _, Place};
use nalgebra::{DMatrix, Dyn, Matrix3, Matrix3xX, SymmetricEigen, Vector3};

use crate::file::part::{Between, SystemBody};
use crate::file::quantity::{round, short};
use crate::file::system::{Spring, System};
use crate::run::make::Stop;

/// Least distance of a spring's ends, relative to its length at rest. Below it, rounding errors determine the
/// direction.
const NEAREST_ENDS: f64 = 1e-9;
/// Product `hω` from which a note is due: the vibration is a twentieth too fast.
const COARSE: f64 = 1.0;
/// Product `hω` from which a vibration grows.
pub(crate) const UNSTABLE: f64 = 2.0;

/// The number of a spring in the file, and a message about it.
pub(crate) type OfSpring = (usize, String);

pub(crate) const NO_DIRECTION: &str =
    "the ends of this spring are at one place, where its force has no direction: move one of them";

/// Whether the ends of a spring of this length are too near to each other for its force to have a direction.
pub(crate) fn has_no_direction(apart: f64, length: f64) -> bool {
    apart <= NEAREST_ENDS * length.abs()
}

/// The message about a step that is unstable at this rate, rad/s.
pub(crate) fn unstable(rate: f64, step: f64) -> String {
    let [rate, most, good] = [rate, UNSTABLE / rate, 0.2 / rate].map(round);
    format!(
        "the fastest vibration, in which this spring has the largest part, is at {rate} rad/s, and a step of {} s makes \
         it grow: take a `step` below {most} s, better {good} s, or a smaller `k`",
        short(step)
    )
}

/// A note about a step that is long for a vibration with the rate `now`, or with an upper bound `most`, rad/s.
pub(crate) fn coarse(now: f64, most: f64, step: f64) -> Option<String> {
    let good = round(0.2 / now.max(most));
    if step * now > COARSE {
        let (rate, share) = (round(now), 100.0 * (2.0 * (0.5 * step * now).asin() / (step * now) - 1.0));
        return Some(format!(
            "the fastest vibration, in which this spring has the largest part, is at {rate} rad/s, and a step of {} s \
             makes it {share:.0} % faster: take a `step` of {good} s",
            short(step)
        ));
    }
    (step * most >= UNSTABLE).then(|| {
        format!(
            "where this spring pulls across its arm it vibrates at up to {} rad/s, and a step of {} s would make that \
             grow: take a `step` of {good} s",
            round(most),
            short(step)
        )
    })
}

/// The eigenvalues and eigenvectors of a symmetric matrix; none where it isn't finite.
pub(crate) fn eigen(matrix: DMatrix<f64>) -> Option<SymmetricEigen<f64, Dyn>> {
    /// More sweeps than any finite matrix needs.
    const MOST: usize = 10_000;
    let is_finite = !matrix.is_empty() && matrix.iter().all(|entry| entry.is_finite());
    is_finite.then(|| SymmetricEigen::try_new(matrix, f64::EPSILON, MOST)).flatten()
}

/// `J^{-1/2}`.
pub(crate) fn inverse_root(J: &Inertia) -> Matrix3<f64> {
    let SymmetricEigen { eigenvectors, eigenvalues } = J.as_matrix().symmetric_eigen();
    eigenvectors * Matrix3::from_diagonal(&eigenvalues.map(|moment| moment.sqrt().recip())) * eigenvectors.transpose()
}

/// `J^{-1/2}` of a body; a point mass counts as a ball of a thousandth of the system's size, m, whose turns are fast enough to follow
/// its joints.
fn inverse_root_of(body: &SystemBody, size: f64) -> Matrix3<f64> {
    let of_ball = || Matrix3::identity() / (4e-7 * body.m).sqrt() / size;
    body.J.as_ref().map_or_else(of_ball, inverse_root)
}

/// The index of the largest entry, and the entry.
fn largest(values: impl Iterator<Item = f64>) -> Option<(usize, f64)> {
    values.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b))
}

impl Between<Spring> {
    /// The vector from the first point to the second, in space, for bodies at these places.
    fn along(&self, places: &[(SO3, R3)]) -> Vector3<f64> {
        let [one, other] = [0, 1].map(|side| {
            let point = self.of.at[side];
            self.bodies[side].map_or(point, |body| places[body].0.as_matrix() * point + places[body].1.translation())
        });
        other - one
    }
}

impl System {
    /// A note about a step that is long for the springs at these places, if it is; none about a step that was chosen for an
    /// accuracy.
    ///
    /// # Errors
    ///
    /// The step is unstable, or a spring has no direction.
    pub(crate) fn check_springs(&self, places: &[(SO3, R3)], step: Option<f64>) -> Result<Option<OfSpring>, Stop> {
        if self.springs.is_empty() {
            return Ok(None);
        }
        for (number, spring) in self.springs.iter().enumerate() {
            if spring.of.length != 0.0 && has_no_direction(spring.along(places).norm(), spring.of.length) {
                return Err(Stop::Spring(number, NO_DIRECTION.to_owned()));
            }
        }
        let Some(step) = step else { return Ok(None) };
        let free = self.free_motions(places);
        let Some((number, now)) = self.fastest(places, free.as_ref(), false) else { return Ok(None) };
        if step * now >= UNSTABLE {
            return Err(Stop::Spring(number, unstable(now, step)));
        }
        let (any, most) = self.fastest(places, free.as_ref(), true).unwrap_or((number, now));
        let number = if step * now > COARSE { number } else { any };
        Ok(coarse(now, most, step).map(|why| (number, why)))
    }

    /// The spring with the largest part in the fastest vibration, and its rate, rad/s: in the springs' present
    /// directions, or with `in_any` in any direction.
    fn fastest(&self, places: &[(SO3, R3)], free: Option<&DMatrix<f64>>, in_any: bool) -> Option<(usize, f64)> {
        let mut all = DMatrix::zeros(3 * self.springs.len(), 6 * self.bodies.len());
        for (number, spring) in self.springs.iter().enumerate() {
            let along = spring.along(places);
            let direction = along / along.norm();
            let is_along = !in_any && direction.iter().all(|part| part.is_finite());
            // The stiffness is `k` along the spring, and `k (1 − l/|y|)` across it.
            let stiffness = if is_along {
                let across = (1.0 - spring.of.length / along.norm()).max(0.0).sqrt();
                let projector = direction * direction.transpose();
                projector + (Matrix3::identity() - projector) * across
            } else {
                Matrix3::identity()
            };
            let [one, other] = [0, 1].map(|side| self.moved(places, spring.bodies[side], &spring.of.at[side]));
            all.rows_mut(3 * number, 3).copy_from(&(stiffness * (other - one) * spring.of.k.sqrt()));
        }
        let all = free.map_or_else(|| all.clone(), |free| &all * free);
        let SymmetricEigen { eigenvectors, eigenvalues } = eigen(all.tr_mul(&all))?;
        let (mode, square) = largest(eigenvalues.iter().copied())?;
        let parts = all * eigenvectors.column(mode);
        let (spring, _) = largest((0..self.springs.len()).map(|number| parts.rows(3 * number, 3).norm_squared()))?;
        Some((spring, square.max(0.0).sqrt()))
    }

    /// The derivative of a point of a body, or of space, by the motions of all bodies, in mass-weighted coordinates.
    fn moved(&self, places: &[(SO3, R3)], body: Option<usize>, point: &Vector3<f64>) -> Matrix3xX<f64> {
        let mut moved = Matrix3xX::zeros(6 * self.bodies.len());
        if let Some(body) = body {
            let turned =
                places[body].0.as_matrix() * -point.cross_matrix() * inverse_root_of(&self.bodies[body], self.size());
            moved.fixed_columns_mut::<3>(6 * body).copy_from(&turned);
            let shifted = Matrix3::identity() / self.bodies[body].m.sqrt();
            moved.fixed_columns_mut::<3>(6 * body + 3).copy_from(&shifted);
        }
        moved
    }

    /// The motions that the joints allow, as columns; none without joints.
    fn free_motions(&self, places: &[(SO3, R3)]) -> Option<DMatrix<f64>> {
        let place = |body: Option<usize>| {
            body.map_or(Place::SPACE, |body| {
                let (attitude, position) = &places[body];
                Place { attitude: *attitude.as_matrix(), position: position.translation() }
            })
        };
        let size = self.size();
        let held = self.joints.iter().map(|joint| {
            let mut held = DMatrix::zeros(6, 6 * self.bodies.len());
            let slopes = joint.of.constraint().slope(&place(joint.bodies[0]), &place(joint.bodies[1]));
            for (body, slope) in joint.bodies.into_iter().zip(slopes) {
                let Some(body) = body else { continue };
                let turned = slope.turn * places[body].0.as_matrix() * inverse_root_of(&self.bodies[body], size);
                held.fixed_columns_mut::<3>(6 * body).copy_from(&turned);
                held.fixed_columns_mut::<3>(6 * body + 3).copy_from(&(slope.shift / self.bodies[body].m.sqrt()));
            }
            held
        });
        let squares = held.map(|held: DMatrix<f64>| held.tr_mul(&held)).reduce(|sum, one| sum + one)?;
        let SymmetricEigen { eigenvectors, eigenvalues } = eigen(squares)?;
        let limit = 1e-9 * eigenvalues.max();
        let free = eigenvectors.column_iter().zip(eigenvalues.iter()).filter(|(_, square)| **square <= limit);
        let free: Vec<_> = free.map(|(column, _)| column.into_owned()).collect();
        Some(if free.is_empty() { DMatrix::zeros(6 * self.bodies.len(), 0) } else { DMatrix::from_columns(&free) })
    }
}
