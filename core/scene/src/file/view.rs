//! The numbers of a scene's states, and the columns that they are: those of the motion first, then angles, wheels and laws.

use std::collections::BTreeSet;

use nalgebra::{Rotation3, Vector3};

use crate::file::column::{Column, Names};
use crate::file::control::{Wheel, entries};
use crate::file::euler::roll_pitch_yaw;
use crate::file::sample::{BodySample, Sample};
use crate::file::scene_file::SceneFile;

/// The names of roll, pitch and yaw.
const LOCAL: [&str; 3] = ["roll", "pitch", "yaw"];

impl SceneFile {
    /// The place of the first number of a sample behind those of the motion itself.
    pub(crate) fn behind_motion(&self) -> usize {
        self.system.as_ref().map_or_else(|| self.group.energy() + 2, |system| system.joint_columns())
    }

    /// Whether angles are relative to the local vertical, too.
    fn is_local(&self) -> bool {
        self.orbit.is_some() && self.group.is_rotation()
    }

    /// The bodies with laws.
    fn controlled(&self) -> BTreeSet<usize> {
        self.control.iter().map(|control| control.body).collect()
    }

    /// The numbers of bodies behind those of their motion; `state` is that of the stepper.
    pub(crate) fn numbers(&self, bodies: &[BodySample], (time, state): (f64, &[f64])) -> Vec<f64> {
        let (last, length) = (state.len().saturating_sub(1), entries(&self.control, &self.wheel));
        let memory = state.get(last.saturating_sub(length)..last).unwrap_or_default();
        let speed =
            |(wheel, momentum): (&Wheel, &f64)| momentum / wheel.inertia - bodies[wheel.body].velocity.dot(&wheel.axis);
        let speeds = self.wheel.iter().zip(memory).map(speed);
        let torques = memory.get(2 * self.wheel.len()..).unwrap_or_default().chunks_exact(3).zip(&self.control);
        let torque = |body: usize| {
            let own = torques.clone().filter(|(_, control)| control.body == body);
            own.map(|(torque, _)| Vector3::from_column_slice(torque)).sum::<Vector3<f64>>().data.0[0]
        };
        let angles = self.pointing.iter().map(|one| one.angle(&bodies[one.number].matrix(), self.at(time)));
        let local = self.orbit.into_iter().flat_map(|orbit| {
            let seen = move |body: &BodySample| orbit.local_vertical(time).tr_mul(&body.matrix());
            bodies.iter().flat_map(move |body| roll_pitch_yaw(&Rotation3::from_matrix_unchecked(seen(body))))
        });
        angles.chain(local).chain(speeds).chain(self.controlled().into_iter().flat_map(torque)).collect()
    }

    /// All columns that a table can have.
    pub(crate) fn all_columns(&self) -> Vec<Column> {
        let bodies: Vec<String> = match &self.system {
            Some(system) => system.names().map(|name| format!("{name}_")).collect(),
            None => vec![String::new()],
        };
        let three = |body: &String, names: [&str; 3]| names.map(|name| format!("{body}{name}"));
        let of_all = bodies.iter().filter(|_| self.is_local()).flat_map(|body| three(body, LOCAL));
        let torques = self.controlled().into_iter();
        let torques = torques.flat_map(|body| three(&bodies[body], ["control_x", "control_y", "control_z"]));
        let speeds = self.wheel.iter().map(|wheel| format!("{}_speed", wheel.name));
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

    /// The last state of one body, for the summary of a run; empty on another group.
    pub(crate) fn last_state(&self, sample: &Sample) -> String {
        let Some(BodySample { quaternion, velocity, .. }) = sample.bodies.first() else { return String::new() };
        // A small negative number has no sign once it is rounded to zero.
        let plain = |text: String| match text.strip_prefix('-') {
            Some(zero) if zero.chars().all(|letter| "0.".contains(letter)) => zero.to_owned(),
            _ => text,
        };
        let list = |parts: &[f64]| parts.iter().map(|part| plain(format!("{part:.6}"))).collect::<Vec<_>>().join(", ");
        let local = LOCAL.into_iter().filter(|_| self.is_local());
        let names = self.pointing.iter().map(|pointing| pointing.name.as_str()).chain(local);
        let angle =
            |(name, angle): (&str, &f64)| format!(", {name} {} deg", plain(format!("{:.3}", angle.to_degrees())));
        let angles: String = names.zip(&sample.numbers[self.behind_motion()..]).map(angle).collect();
        let rates = velocity.map(f64::to_degrees);
        format!("\n  at the end quaternion [{}], velocity [{}] deg/s{angles}", list(quaternion), list(rates.as_slice()))
    }
}
