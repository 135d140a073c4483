//! Angles of a body's axes: the tables `[[pointing]]`; and roll, pitch and yaw relative to the local vertical.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::{Matrix3, Rotation3, Vector3};
use serde::Deserialize;

use crate::file::column::Column;
use crate::file::control::Wheel;
use crate::file::euler::roll_pitch_yaw;
use crate::file::group::Group;
use crate::file::kepler::Orbit;
use crate::file::orbit::{DirectionInTime, Parameter as _, Time};
use crate::file::quantity::Direction;

/// The angle between an axis of the body and a direction in space, or that of the mass.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Pointing {
    pub(crate) name: String,
    /// Axis, body frame.
    axis: Direction,
    to: DirectionInTime,
}

impl Pointing {
    /// The angle at an attitude, body to space, at a time; rad.
    fn angle(&self, attitude: &Matrix3<f64>, time: Time<'_>) -> f64 {
        let (axis, to) = (attitude * self.axis.0, self.to.at(time));
        // The cosine alone doesn't know a small angle.
        axis.cross(&to).norm().atan2(axis.dot(&to))
    }

    /// Whether the direction is that of the mass.
    pub(crate) fn is_on_orbit(&self) -> bool {
        self.to.is_on_orbit()
    }
}

/// A group with all that a sample has numbers of.
#[derive(Clone)]
pub(crate) struct View {
    pub(crate) group: Group,
    pub(crate) orbit: Option<Orbit>,
    pub(crate) pointing: Arc<[Pointing]>,
    pub(crate) wheels: Arc<[Wheel]>,
    /// The number of laws of torques on the body.
    pub(crate) controls: usize,
    /// The number of entries that a state has for laws and wheels, before its last.
    pub(crate) memory: usize,
}

impl View {
    /// The names of roll, pitch and yaw.
    const LOCAL: [&'static str; 3] = ["roll", "pitch", "yaw"];

    /// The places of the angles in a sample, behind the defect.
    fn angles(&self) -> Range<usize> {
        let start = self.group.energy() + 2;
        start..start + self.pointing.len()
    }

    /// The places of roll, pitch and yaw; empty without an orbit.
    fn local(&self) -> Range<usize> {
        let start = self.angles().end;
        start..start + if self.orbit.is_some() && self.group.is_rotation() { 3 } else { 0 }
    }

    /// The places of the speeds of wheels.
    fn speeds(&self) -> Range<usize> {
        let start = self.local().end;
        start..start + self.wheels.len()
    }

    /// The places of the torque of laws; empty without any.
    fn control(&self) -> Range<usize> {
        let start = self.speeds().end;
        start..start + if self.controls > 0 { 3 } else { 0 }
    }

    /// The numbers of an attitude, body to space, and a velocity, body frame, in these places; `state` is that of the
    /// stepper.
    pub(crate) fn numbers(
        &self,
        (attitude, velocity): (&Matrix3<f64>, &Vector3<f64>),
        (time, state): (f64, &[f64]),
    ) -> Vec<f64> {
        let last = state.len().saturating_sub(1);
        let memory = state.get(last.saturating_sub(self.memory)..last).unwrap_or_default();
        let speed = |(wheel, momentum): (&Wheel, &f64)| momentum / wheel.inertia - velocity.dot(&wheel.axis);
        let speeds = self.wheels.iter().zip(memory).map(speed);
        let torques = memory.get(2 * self.wheels.len()..).unwrap_or_default().chunks(3).take(self.controls);
        let torque = torques.filter(|torque| torque.len() == 3).map(Vector3::from_column_slice).sum::<Vector3<f64>>();
        let torque = torque.data.0[0].into_iter().take(self.control().len());
        let now = Time { time, orbit: self.orbit.as_ref() };
        let angles = self.pointing.iter().map(|pointing| pointing.angle(attitude, now));
        let seen = self.orbit.map(|orbit| orbit.local_vertical(time).tr_mul(attitude));
        let local = seen.map(|seen| roll_pitch_yaw(&Rotation3::from_matrix_unchecked(seen)));
        angles.chain(local.into_iter().flatten()).chain(speeds).chain(torque).collect()
    }

    /// The columns of a scene.
    pub(crate) fn columns(&self) -> Vec<Column> {
        let names = self.pointing.iter().map(|pointing| pointing.name.as_str());
        let angles = Column::of_places("pointing", names, "rad", self.angles());
        let local = Column::of_places("roll-pitch-yaw", Self::LOCAL.into_iter(), "rad", self.local());
        let wheels: Vec<String> = self.wheels.iter().map(|wheel| format!("{}_speed", wheel.name)).collect();
        let speeds = Column::of_places("wheel-speeds", wheels.iter().map(String::as_str), "rad/s", self.speeds());
        let torques = ["control_x", "control_y", "control_z"].into_iter();
        let control = Column::of_places("control", torques, "N m", self.control());
        Column::of_group(&self.group).into_iter().chain(angles).chain(local).chain(speeds).chain(control).collect()
    }

    /// The angles of a sample's numbers, rad, with their names.
    pub(crate) fn named<'a>(&'a self, numbers: &'a [f64]) -> impl Iterator<Item = (&'a str, f64)> {
        let names = self.pointing.iter().map(|pointing| pointing.name.as_str());
        let local = Self::LOCAL.into_iter().filter(|_| !self.local().is_empty());
        let values = numbers.get(self.angles().start..self.local().end).unwrap_or_default();
        names.chain(local).zip(values.iter().copied())
    }
}

/// The last state of a body, for the summary of a run.
pub(crate) fn at_the_end(view: &View, (attitude, velocity): ([f64; 4], Vector3<f64>), numbers: &[f64]) -> String {
    // A small negative number has no sign once it is rounded to zero.
    let plain = |text: String| match text.strip_prefix('-') {
        Some(zero) if zero.chars().all(|letter| "0.".contains(letter)) => zero.to_owned(),
        _ => text,
    };
    let list = |parts: &[f64]| parts.iter().map(|part| plain(format!("{part:.6}"))).collect::<Vec<_>>().join(", ");
    let angle = |(name, angle): (&str, f64)| format!(", {name} {} deg", plain(format!("{:.3}", angle.to_degrees())));
    let angles = view.named(numbers).map(angle).collect::<Vec<_>>().concat();
    let rates = velocity.map(f64::to_degrees);
    format!("\n  at the end quaternion [{}], velocity [{}] deg/s{angles}", list(&attitude), list(rates.as_slice()))
}
