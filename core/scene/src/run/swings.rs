//! The stability limit of one body's potentials: their kicks are unstable beyond `hω = 2` of its fastest swing.

use liestep::mechanics::Inertia;
use liestep::with::Scheme;
use nalgebra::{Matrix3, Vector3};

use crate::file::orbit::VectorInTime;
use crate::file::quantity::{round, short};
use crate::file::scene_file::SceneFile;
use crate::run::make::{Note, Stop};
use crate::run::stiffness::{NO_DIRECTION, UNSTABLE, coarse, has_no_direction, inverse_root, unstable};

/// Rates of small oscillations about a minimum with these second derivatives by a turn of the body, ascending, rad/s;
/// none where they overflow.
fn rates(J: &Inertia, second: Matrix3<f64>) -> Option<[f64; 3]> {
    let root = inverse_root(J);
    let matrix = root * second * root;
    let mut squares: [f64; 3] =
        matrix.iter().all(|entry| entry.is_finite()).then(|| matrix.symmetric_eigenvalues().into())?;
    squares.sort_by(f64::total_cmp);
    Some(squares.map(|square| square.max(0.0).sqrt()))
}

impl SceneFile {
    /// A note about a step that is long for the spring, if it is, with its place.
    ///
    /// # Errors
    ///
    /// The spring has no direction at the start, or the kicks of a potential are unstable.
    pub(crate) fn check_kicks(&self) -> Result<Option<Note>, Stop> {
        let Some(body) = self.body else { return Ok(None) };
        let of_spring = self.check_spring(&body.J)?;
        let Some(step) = self.kicked_by() else { return Ok(None) };
        let swings = self.swings(&body.J);
        let fastest = swings.into_iter().max_by(|(_, one), (_, other)| one.total_cmp(other));
        if let Some((name, rate)) = fastest.filter(|(_, rate)| step * rate >= UNSTABLE) {
            let [rate, most, good] = [rate, UNSTABLE / rate, 0.2 / rate].map(round);
            let step = short(step);
            return Err(Stop::Other(format!(
                "by {name} the body swings at up to {rate} rad/s, and a step of {step} s makes that grow: take a `step` \
                 below {most} s, better {good} s"
            )));
        }
        Ok(of_spring.map(|why| (self.origin.places.spring, why)))
    }

    /// The step of a scene whose potentials are kicks at its ends, s.
    fn kicked_by(&self) -> Option<f64> {
        let is_own_step = matches!(self.run.method, Scheme::Step) && !self.has_steps_of_its_own();
        self.run.given_step().filter(|_| is_own_step)
    }

    /// The largest rates of the swings by each potential other than the spring's, rad/s.
    fn swings(&self, J: &Inertia) -> Vec<(&'static str, f64)> {
        // A potential `c·w`, `w` fixed in space, has at its minimum the second derivative `|c||w|` about all axes
        // across `c`.
        let pulled = |c: Vector3<f64>, w: Vector3<f64>| {
            let axis = c.normalize();
            let [.., rate] = rates(J, Matrix3::identity() - axis * axis.transpose()).unwrap_or_default();
            rate * (c.norm() * w.norm()).sqrt()
        };
        let gravity = self
            .gravity
            .map(|field| ("gravity", pulled(field.rho.value * (field.m.value * field.g.value), field.up.0)));
        let dipole = self
            .dipole
            .map(|dipole| ("the dipole's field", pulled(dipole.moment.value, dipole.field.at(self.at(0.0)))));
        let gradient = self.gravity_gradient.map(|gradient| {
            let strength = match (gradient.GM, gradient.r, gradient.direction) {
                (Some(GM), Some(r), _) => GM.value / r.value.powi(3),
                (.., VectorInTime::Turns(_)) => self.orbit.map_or(0.0, |orbit| orbit.rate()).powi(2),
                _ => 0.0,
            };
            let mut moments: [f64; 3] = J.principal_moments().into();
            moments.sort_by(f64::total_cmp);
            let [least, middle, largest] = moments;
            (
                "the gravity gradient",
                (3.0 * strength * ((largest - least) / middle).max((middle - least) / largest)).sqrt(),
            )
        });
        [gravity, dipole, gradient].into_iter().flatten().filter(|(_, rate)| rate.is_finite()).collect()
    }

    /// A note about a step that is long for the spring, if it is.
    ///
    /// # Errors
    ///
    /// The spring has no direction at the start, or its kicks are unstable.
    fn check_spring(&self, J: &Inertia) -> Result<Option<String>, Stop> {
        let Some(spring) = self.spring else { return Ok(None) };
        let (k, length, arm) = (spring.k.value, spring.length.value, spring.at.value);
        let anchor = self.start.rotation().as_matrix().tr_mul(&spring.anchor.value);
        let along = arm - anchor;
        let apart = along.norm();
        if has_no_direction(apart, length) {
            return Err(Stop::Spring(0, NO_DIRECTION.to_owned()));
        }
        let Some(step) = self.kicked_by() else { return Ok(None) };
        let turn = -arm.cross_matrix();
        let direction = along / apart;
        // Second derivatives by a turn of the body: along the spring, across it, and by the second-order shift of
        // the arm's end.
        let projector = direction * direction.transpose();
        let stiffness = projector + (Matrix3::identity() - projector) * (1.0 - length / apart);
        let tilt = direction * arm.transpose();
        let second = turn.tr_mul(&(stiffness * turn)) * k
            + ((tilt + tilt.transpose()) * 0.5 - Matrix3::identity() * tilt.trace()) * (k * (apart - length));
        // A spring across its arm vibrates about two axes: a heavier one and a lighter one.
        let (Some([.., now]), Some([_, heavy, light])) = (rates(J, second), rates(J, turn.tr_mul(&turn) * k)) else {
            return Ok(None);
        };
        let across = self.farthest_across(J, 0.5 * k * (apart - length).powi(2));
        if step * now.max(heavy * across) >= UNSTABLE {
            return Err(Stop::Spring(0, unstable(now.max(heavy * across), step)));
        }
        Ok(coarse(now, light * across, step))
    }

    /// The largest sine of the angle between the spring and its arm that the energy of the start permits; `stretched`
    /// is the energy of the spring at the start, J.
    fn farthest_across(&self, J: &Inertia, stretched: f64) -> f64 {
        let Some(spring) = self.spring else { return 0.0 };
        let moving = || Vector3::from_column_slice(&self.start.velocity);
        let of_momentum = || J.as_matrix().try_inverse().map(|inverse| inverse * moving());
        let velocity = self.start.rate().or_else(of_momentum).unwrap_or_default();
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
