//! Angles of a body's axes: the tables `[[pointing]]`; and roll, pitch and yaw relative to the local vertical.

use std::collections::BTreeSet;
use std::sync::Arc;

use nalgebra::{Matrix3, Rotation3, Vector3};
use serde::Deserialize;
use toml::Spanned;

use crate::file::column::{Column, Names};
use crate::file::control::Wheel;
use crate::file::euler::roll_pitch_yaw;
use crate::file::group::Group;
use crate::file::kepler::Orbit;
use crate::file::orbit::{DirectionInTime, Parameter as _, Time};
use crate::file::quantity::Direction;
use crate::file::sample::BodySample;
use crate::file::system::System;

/// The angle between an axis of the body and a direction in space, or that of the mass.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Pointing {
    pub(crate) name: String,
    pub(crate) body: Option<Spanned<String>>,
    /// The number of the body, which is found when all are known.
    #[serde(skip)]
    pub(crate) number: usize,
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

/// A group or several bodies with all that a sample has numbers of.
#[derive(Clone)]
pub(crate) struct View {
    pub(crate) group: Group,
    pub(crate) system: Option<Arc<System>>,
    pub(crate) orbit: Option<Orbit>,
    pub(crate) pointing: Arc<[Pointing]>,
    pub(crate) wheels: Arc<[Wheel]>,
    /// The body of each law of a torque.
    pub(crate) controls: Arc<[usize]>,
    /// The number of entries that a state has for laws and wheels, before its last.
    pub(crate) memory: usize,
}

impl View {
    /// The names of roll, pitch and yaw.
    const LOCAL: [&'static str; 3] = ["roll", "pitch", "yaw"];

    /// The place of the first number of a sample behind those of the motion itself.
    pub(crate) fn first(&self) -> usize {
        self.system.as_ref().map_or_else(|| self.group.energy() + 2, |system| system.joint_columns())
    }

    /// Whether angles are relative to the local vertical, too.
    fn is_local(&self) -> bool {
        self.orbit.is_some() && self.group.is_rotation()
    }

    /// The numbers of bodies in these columns; `state` is that of the stepper.
    pub(crate) fn numbers(&self, bodies: &[BodySample], (time, state): (f64, &[f64])) -> Vec<f64> {
        let last = state.len().saturating_sub(1);
        let memory = state.get(last.saturating_sub(self.memory)..last).unwrap_or_default();
        let speed =
            |(wheel, momentum): (&Wheel, &f64)| momentum / wheel.inertia - bodies[wheel.body].velocity.dot(&wheel.axis);
        let speeds = self.wheels.iter().zip(memory).map(speed);
        let torques = memory.get(2 * self.wheels.len()..).unwrap_or_default().chunks(3).zip(self.controls.iter());
        let torque = |body: usize| {
            let own = torques.clone().filter(|(torque, of)| torque.len() == 3 && **of == body);
            own.map(|(torque, _)| Vector3::from_column_slice(torque)).sum::<Vector3<f64>>().data.0[0]
        };
        let now = Time { time, orbit: self.orbit.as_ref() };
        let angles = self.pointing.iter().map(|pointing| pointing.angle(&bodies[pointing.number].matrix(), now));
        let local = self.orbit.into_iter().flat_map(|orbit| {
            let seen = move |body: &BodySample| orbit.local_vertical(time).tr_mul(&body.matrix());
            bodies.iter().flat_map(move |body| roll_pitch_yaw(&Rotation3::from_matrix_unchecked(seen(body))))
        });
        angles.chain(local).chain(speeds).chain(self.controlled().into_iter().flat_map(torque)).collect()
    }

    /// The bodies with laws.
    fn controlled(&self) -> BTreeSet<usize> {
        self.controls.iter().copied().collect()
    }

    /// The columns of a scene.
    pub(crate) fn columns(&self) -> Vec<Column> {
        let bodies: Vec<String> = match &self.system {
            Some(system) => system.names().map(|name| format!("{name}_")).collect(),
            None => vec![String::new()],
        };
        let three = |body: &String, names: [&str; 3]| names.map(|name| format!("{body}{name}"));
        let of_all = bodies.iter().filter(|_| self.is_local()).flat_map(|body| three(body, Self::LOCAL));
        let torques = self.controlled().into_iter();
        let torques = torques.flat_map(|body| three(&bodies[body], ["control_x", "control_y", "control_z"]));
        let speeds = self.wheels.iter().map(|wheel| format!("{}_speed", wheel.name));
        let named = |names: Vec<String>, unit| names.into_iter().map(|name| (name, unit)).collect();
        let behind: [(_, Names); 4] = [
            ("pointing", named(self.pointing.iter().map(|pointing| pointing.name.clone()).collect(), "rad")),
            ("roll-pitch-yaw", named(of_all.collect(), "rad")),
            ("wheel-speeds", named(speeds.collect(), "rad/s")),
            ("control", named(torques.collect(), "N m")),
        ];
        match &self.system {
            Some(system) => Column::of_system(&system.names().collect::<Vec<_>>(), &system.kinds(), behind),
            None => Column::of_group(&self.group, behind),
        }
    }

    /// The angles of a sample's numbers, rad, with their names.
    pub(crate) fn named<'a>(&'a self, numbers: &'a [f64]) -> impl Iterator<Item = (&'a str, f64)> {
        let names = self.pointing.iter().map(|pointing| pointing.name.as_str());
        let local = Self::LOCAL.into_iter().filter(|_| self.is_local());
        let values = numbers.get(self.first()..).unwrap_or_default();
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
