//! The fastest vibration of springs against the step: half a kick, a drift and half a kick are unstable beyond `hω = 2`.

use liestep::SO3;
use liestep::groups::R3;
use liestep::mechanics::Inertia;
use nalgebra::{DMatrix, Dyn, Matrix3, Matrix3xX, SymmetricEigen, Vector3};

use crate::file::method::Method;
use crate::file::quantity::{round, short};
use crate::file::scene::SceneFile;
use crate::file::schedule::Pace;
use crate::file::system::{System, ends_and_axes};
use crate::run::make::Stop;

/// Least distance of a spring's ends, in its lengths at rest: below it the direction is that of roundings.
const NEAREST_ENDS: f64 = 1e-9;
/// Product `hω` beyond which a note is due: the vibration is a twentieth too fast.
const COARSE: f64 = 1.0;
/// Product `hω` beyond which a vibration grows.
const UNSTABLE: f64 = 2.0;

/// A spring's number in the file, and a message about it.
pub(crate) type OfSpring = (usize, String);

const NO_DIRECTION: &str =
    "the ends of this spring are at one place, where its force has no direction: move one of them";

/// Whether the ends of a spring of this length are too near to each other for its force to have a direction.
fn has_no_direction(apart: f64, length: f64) -> bool {
    apart <= NEAREST_ENDS * length.abs()
}

/// Message about a step that is unstable at this rate, rad/s.
fn unstable(rate: f64, step: f64) -> String {
    let [rate, most, good] = [rate, UNSTABLE / rate, 0.2 / rate].map(round);
    format!(
        "the fastest vibration, in which this spring has the largest part, is at {rate} rad/s, and a step of {} s makes \
         it grow: take a `step` below {most} s, better {good} s, or a smaller `k`",
        short(step)
    )
}

/// Note about a step that is long for a vibration at this rate now, and at that at most, rad/s.
fn coarse(now: f64, most: f64, step: f64) -> Option<String> {
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

/// Eigenvalues of a symmetric matrix, and its eigenvectors; none where it isn't finite.
pub(crate) fn eigen(matrix: DMatrix<f64>) -> Option<SymmetricEigen<f64, Dyn>> {
    /// Sweeps that no finite matrix takes.
    const MOST: usize = 10_000;
    let is_finite = !matrix.is_empty() && matrix.iter().all(|entry| entry.is_finite());
    is_finite.then(|| SymmetricEigen::try_new(matrix, f64::EPSILON, MOST)).flatten()
}

/// `J^{-1/2}`.
fn inverse_root(J: &Inertia) -> Matrix3<f64> {
    let SymmetricEigen { eigenvectors, eigenvalues } = J.as_matrix().symmetric_eigen();
    eigenvectors * Matrix3::from_diagonal(&eigenvalues.map(|moment| moment.sqrt().recip())) * eigenvectors.transpose()
}

/// The largest entry and its place.
fn largest(values: impl Iterator<Item = f64>) -> Option<(usize, f64)> {
    values.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b))
}

impl System {
    /// A note about a step that is long for the springs at these places, if there is one; an error where it is unstable, and
    /// where a spring has no direction.
    pub(crate) fn check_springs(&self, places: &[(SO3, R3)]) -> Result<Option<OfSpring>, Stop> {
        for (number, spring) in self.springs.iter().enumerate() {
            if spring.of.length != 0.0 && has_no_direction(spring.along_of(places).norm(), spring.of.length) {
                return Err(Stop::Spring(number, NO_DIRECTION.to_owned()));
            }
        }
        let free = self.free_motions(places);
        let Some((number, now)) = self.fastest(places, free.as_ref(), false) else { return Ok(None) };
        if self.step * now >= UNSTABLE {
            return Err(Stop::Spring(number, unstable(now, self.step)));
        }
        let (any, most) = self.fastest(places, free.as_ref(), true).unwrap_or((number, now));
        let number = if self.step * now > COARSE { number } else { any };
        Ok(coarse(now, most, self.step).map(|why| (number, why)))
    }

    /// The spring with the largest part in the fastest vibration, and its rate, rad/s: in the directions that springs have
    /// now, or in any.
    fn fastest(&self, places: &[(SO3, R3)], free: Option<&DMatrix<f64>>, in_any: bool) -> Option<(usize, f64)> {
        let mut all = DMatrix::zeros(3 * self.springs.len(), 6 * self.bodies.len());
        for (number, spring) in self.springs.iter().enumerate() {
            let along = spring.along_of(places);
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

    /// Derivative of a point of a body, or of space, by all bodies' motions, in the units in which each has a mass of one.
    fn moved(&self, places: &[(SO3, R3)], body: Option<usize>, point: &Vector3<f64>) -> Matrix3xX<f64> {
        let mut moved = Matrix3xX::zeros(6 * self.bodies.len());
        if let Some(body) = body {
            let turned = places[body].0.as_matrix() * -point.cross_matrix() * inverse_root(&self.bodies[body].J);
            moved.fixed_columns_mut::<3>(6 * body).copy_from(&turned);
            let shifted = Matrix3::identity() / self.bodies[body].m.sqrt();
            moved.fixed_columns_mut::<3>(6 * body + 3).copy_from(&shifted);
        }
        moved
    }

    /// Motions that the joints allow, as columns; none where there are no joints.
    fn free_motions(&self, places: &[(SO3, R3)]) -> Option<DMatrix<f64>> {
        let mut held: Vec<Matrix3xX<f64>> = Vec::new();
        for joint in &self.joints {
            let (ends, axes) = ends_and_axes(&joint.of);
            let apart = |of: &dyn Fn(usize) -> Matrix3xX<f64>| of(1) - of(0);
            held.push(apart(&|side| self.moved(places, joint.bodies[side], &ends[side])));
            // Axes turn with their bodies and aren't shifted.
            held.extend(axes.map(|axes| {
                apart(&|side| {
                    let mut turned = self.moved(places, joint.bodies[side], &axes[side]);
                    (0..self.bodies.len()).for_each(|body| turned.fixed_columns_mut::<3>(6 * body + 3).fill(0.0));
                    turned
                })
            }));
        }
        let squares = held.iter().map(|held| held.tr_mul(held)).reduce(|sum, one| sum + one)?;
        let SymmetricEigen { eigenvectors, eigenvalues } = eigen(squares)?;
        let limit = 1e-9 * eigenvalues.max();
        let free = eigenvectors.column_iter().zip(eigenvalues.iter()).filter(|(_, square)| **square <= limit);
        let free: Vec<_> = free.map(|(column, _)| column.into_owned()).collect();
        Some(if free.is_empty() { DMatrix::zeros(6 * self.bodies.len(), 0) } else { DMatrix::from_columns(&free) })
    }
}

impl SceneFile {
    /// A note about a step that is long for the spring, if there is one; an error where the spring has no direction at the
    /// start, and where the step of a scene that is kicked is unstable.
    pub(crate) fn check_spring(&self) -> Result<Option<String>, Stop> {
        let (Some(spring), Some(body)) = (self.spring, self.body) else { return Ok(None) };
        let (k, length, arm) = (spring.k.value, spring.length.value, spring.at.value);
        let anchor = self.start.attitude.inverse_transform_vector(&spring.anchor.value);
        let along = arm - anchor;
        let apart = along.norm();
        if has_no_direction(apart, length) {
            return Err(Stop::Spring(0, NO_DIRECTION.to_owned()));
        }
        let is_kicked = matches!(self.run.method, Method::Step) && !self.has_steps_of_its_own();
        let Pace::Step { step, .. } = self.run.pace else { return Ok(None) };
        if !is_kicked {
            return Ok(None);
        }
        let (root, turn) = (inverse_root(&body.J), -arm.cross_matrix());
        let direction = along / apart;
        // Second derivatives by a turn of the body: along the spring, across it, and of the arm that shortens.
        let projector = direction * direction.transpose();
        let stiffness = projector + (Matrix3::identity() - projector) * (1.0 - length / apart);
        let tilt = direction * arm.transpose();
        let second = turn.tr_mul(&(stiffness * turn)) * k
            + ((tilt + tilt.transpose()) * 0.5 - Matrix3::identity() * tilt.trace()) * (k * (apart - length));
        let rates = |second: Matrix3<f64>| {
            let matrix = root * second * root;
            let mut squares: [f64; 3] =
                matrix.iter().all(|entry| entry.is_finite()).then(|| matrix.symmetric_eigenvalues().into())?;
            squares.sort_by(f64::total_cmp);
            Some(squares.map(|square| square.max(0.0).sqrt()))
        };
        // Rates of a spring across its arm are about the heavier and the lighter of two axes.
        let (Some([.., now]), Some([_, heavy, light])) = (rates(second), rates(turn.tr_mul(&turn) * k)) else {
            return Ok(None);
        };
        let across = self.farthest_across(&body.J, 0.5 * k * (apart - length).powi(2));
        if step * now.max(heavy * across) >= UNSTABLE {
            return Err(Stop::Spring(0, unstable(now.max(heavy * across), step)));
        }
        Ok(coarse(now, light * across, step))
    }

    /// The largest sine of the angle from the spring to its arm that the energy of the start lets it reach, where the energy
    /// of the spring is this at the start, J.
    fn farthest_across(&self, J: &Inertia, stretched: f64) -> f64 {
        let Some(spring) = self.spring else { return 0.0 };
        let velocity = self.start.velocity;
        let weight = self.gravity.map_or(0.0, |field| field.m.value * field.g.value.abs() * field.rho.value.norm());
        let energy = 0.5 * velocity.dot(&(J.as_matrix() * velocity)) + stretched + 2.0 * weight;
        let (arm, anchor) = (spring.at.value.norm(), spring.anchor.value.norm());
        let across = |part: u32| {
            let angle = f64::from(part) * (std::f64::consts::PI / 64.0);
            let apart = (arm * arm + anchor * anchor - 2.0 * arm * anchor * angle.cos()).max(0.0).sqrt();
            let is_reached = 0.5 * spring.k.value * (apart - spring.length.value).powi(2) <= energy;
            if is_reached && apart > 0.0 { anchor * angle.sin() / apart } else { 0.0 }
        };
        (1..64).map(across).fold(0.0, f64::max)
    }
}
