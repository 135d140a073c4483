//! What a table of a system has.

use liestep::with::Column as Named;
use serde::Deserialize;

use super::file::System;
use super::run::SystemSample;
use crate::columns::{Stride, different, drawn};

/// What is known of a system beside its time. Those of bodies have the body's name before theirs: `upper_x`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SystemColumn {
    /// Of each body its centre of mass in space, m.
    Position,
    /// Of each body its attitude, to space, as the unit quaternion `w, x, y, z`: of the two the one nearer to the row before.
    Quaternion,
    /// Of each body its angular velocity, in its own frame, rad/s.
    Velocity,
    /// Of each body the velocity of its centre of mass in space, m/s.
    Moving,
    /// The energy of all, J.
    Energy,
    /// The momentum of all, kg m/s.
    Momentum,
    /// The angular momentum of all about the origin, kg m²/s.
    AngularMomentum,
    /// How far the joint that is open farthest is open, m; of pins with the cosines of their axes.
    Gap,
}

impl SystemColumn {
    /// What its numbers are called, those of a body behind the body's name.
    #[must_use]
    pub const fn names(self) -> &'static [&'static str] {
        match self {
            Self::Position => &["x", "y", "z"],
            Self::Quaternion => &["q_w", "q_x", "q_y", "q_z"],
            Self::Velocity => &["velocity_x", "velocity_y", "velocity_z"],
            Self::Moving => &["moving_x", "moving_y", "moving_z"],
            Self::Energy => &["energy"],
            Self::Momentum => &["momentum_x", "momentum_y", "momentum_z"],
            Self::AngularMomentum => &["angular_momentum_x", "angular_momentum_y", "angular_momentum_z"],
            Self::Gap => &["gap"],
        }
    }

    /// The unit of its numbers.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Position | Self::Gap => "m",
            Self::Quaternion => "1",
            Self::Velocity => "rad/s",
            Self::Moving => "m/s",
            Self::Energy => "J",
            Self::Momentum => "kg m/s",
            Self::AngularMomentum => "kg m²/s",
        }
    }

    /// Whether each body has it.
    const fn is_of_bodies(self) -> bool {
        matches!(self, Self::Position | Self::Quaternion | Self::Velocity | Self::Moving)
    }

    /// Its numbers.
    fn values(self, sample: &SystemSample) -> Vec<f64> {
        let bodies = sample.bodies.iter();
        match self {
            Self::Position => bodies.flat_map(|body| <[f64; 3]>::from(body.position)).collect(),
            Self::Quaternion => bodies.flat_map(|body| body.quaternion).collect(),
            Self::Velocity => bodies.flat_map(|body| <[f64; 3]>::from(body.velocity)).collect(),
            Self::Moving => bodies.flat_map(|body| <[f64; 3]>::from(body.moving)).collect(),
            Self::Energy => vec![sample.energy],
            Self::Momentum => sample.momentum.as_slice().to_vec(),
            Self::AngularMomentum => sample.angular_momentum.as_slice().to_vec(),
            Self::Gap => vec![sample.gap],
        }
    }
}

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Output {
    #[serde(deserialize_with = "different")]
    columns: Vec<SystemColumn>,
    every: Option<Stride>,
}

impl Default for Output {
    fn default() -> Self {
        use SystemColumn::{Energy, Gap, Position, Quaternion};
        Self { columns: vec![Position, Quaternion, Energy, Gap], every: None }
    }
}

impl Output {
    /// Steps from one row to the next, of so many.
    pub(super) fn stride(&self, steps: u64) -> u64 {
        self.every.map_or_else(|| drawn(steps), |every| every.0)
    }

    /// The time, and behind it the numbers of a row.
    pub(super) fn row(&self, sample: &SystemSample) -> Vec<f64> {
        let values = self.columns.iter().flat_map(|column| column.values(sample));
        std::iter::once(sample.time).chain(values).collect()
    }

    /// The columns of bodies of these names, the time first, each with the number of its body.
    fn named(&self, bodies: &[&str], has_pins: bool) -> Vec<(Named, Option<usize>)> {
        let named = |name: String, unit: &str| Named { name, unit: unit.to_owned() };
        let mut all = vec![(named("t".to_owned(), "s"), None)];
        for column in &self.columns {
            // A length and the cosines of axes.
            let unit = if has_pins && *column == SystemColumn::Gap { "m, 1" } else { column.unit() };
            let names = column.names().iter();
            if column.is_of_bodies() {
                for (number, body) in bodies.iter().enumerate() {
                    all.extend(names.clone().map(|name| (named(format!("{body}_{name}"), unit), Some(number))));
                }
            } else {
                all.extend(names.map(|name| (named((*name).to_owned(), unit), None)));
            }
        }
        all
    }

    /// A name that two columns have, and the number of the body that one is of.
    pub(super) fn name_twice(&self, bodies: &[&str]) -> Option<(usize, String)> {
        let all = self.named(bodies, false);
        all.iter().enumerate().find_map(|(number, (column, body))| {
            let (_, other) = all[..number].iter().find(|(other, _)| other.name == column.name)?;
            Some((body.or(*other)?, column.name.clone()))
        })
    }
}

impl System {
    /// The columns of a table, the time first. Where there are pins the unit of the [gap](SystemColumn::Gap) is `m, 1`.
    #[must_use]
    pub fn columns(&self) -> Vec<Named> {
        let named = self.output.named(&self.names().collect::<Vec<_>>(), self.has_pins());
        named.into_iter().map(|(column, _)| column).collect()
    }
}
