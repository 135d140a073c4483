//! Events: the tables `[[event]]`.

use serde::Deserialize;

use crate::file::quantity::{Angle, Energy, Number, Positive, Rate, Scalar};

/// An event to be detected along a run: a quantity passes a value.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "EventTable")]
pub(crate) struct Event {
    pub(crate) name: String,
    pub(crate) quantity: Quantity,
    pub(crate) direction: Direction,
    pub(crate) stops: bool,
}

/// A quantity and its value, in SI units.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Quantity {
    Tilt(f64),
    Speed(f64),
    Energy(f64),
    Velocity(usize, f64),
    Axis(usize, f64),
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Direction {
    Rising,
    Falling,
    #[default]
    Either,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EventTable {
    name: String,
    tilt: Option<Scalar<Angle>>,
    speed: Option<Positive<Rate>>,
    energy: Option<Scalar<Energy>>,
    velocity_x: Option<Scalar<Rate>>,
    velocity_y: Option<Scalar<Rate>>,
    velocity_z: Option<Scalar<Rate>>,
    axis_x: Option<Scalar<Number>>,
    axis_y: Option<Scalar<Number>>,
    axis_z: Option<Scalar<Number>>,
    #[serde(default)]
    direction: Direction,
    #[serde(default)]
    stop: bool,
}

impl TryFrom<EventTable> for Event {
    type Error = &'static str;

    fn try_from(table: EventTable) -> Result<Self, &'static str> {
        let mut quantities = [
            table.tilt.map(|angle| Quantity::Tilt(angle.value)),
            table.speed.map(|speed| Quantity::Speed(speed.value)),
            table.energy.map(|energy| Quantity::Energy(energy.value)),
            table.velocity_x.map(|rate| Quantity::Velocity(0, rate.value)),
            table.velocity_y.map(|rate| Quantity::Velocity(1, rate.value)),
            table.velocity_z.map(|rate| Quantity::Velocity(2, rate.value)),
            table.axis_x.map(|part| Quantity::Axis(0, part.value)),
            table.axis_y.map(|part| Quantity::Axis(1, part.value)),
            table.axis_z.map(|part| Quantity::Axis(2, part.value)),
        ]
        .into_iter()
        .flatten();
        let (Some(quantity), None) = (quantities.next(), quantities.next()) else {
            return Err("an event has one of `tilt`, `speed`, `energy`, `velocity_x`, `velocity_y`, `velocity_z`, \
                        `axis_x`, `axis_y`, `axis_z`");
        };
        // An event's name is the name of a column.
        let is_plain = |letter: char| letter.is_alphanumeric() || "_-".contains(letter);
        if table.name.is_empty() || !table.name.chars().all(is_plain) {
            return Err("the `name` of an event has letters, digits, - and _ only");
        }
        Ok(Self { name: table.name, quantity, direction: table.direction, stops: table.stop })
    }
}
