//! Events: the tables `[[event]]`.

use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;

use crate::file::column::Column;
use crate::file::mistake::{SpanMessage, advised};
use crate::file::quantity::{Angle, Any, Energy, Number, PositiveScalar, Rate, Scalar};

/// An event to be detected along a run: a quantity passes a value.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "EventTable")]
pub(crate) struct Event {
    pub(crate) name: String,
    pub(crate) quantity: Quantity,
    /// The name of a column, whose place is found when the group is known.
    pub(crate) column: Option<Spanned<String>>,
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
    /// A number of a sample by its place.
    Column(usize, f64),
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
    speed: Option<PositiveScalar<Rate>>,
    energy: Option<Scalar<Energy>>,
    velocity_x: Option<Scalar<Rate>>,
    velocity_y: Option<Scalar<Rate>>,
    velocity_z: Option<Scalar<Rate>>,
    axis_x: Option<Scalar<Number>>,
    axis_y: Option<Scalar<Number>>,
    axis_z: Option<Scalar<Number>>,
    column: Option<Spanned<String>>,
    value: Option<Scalar<Any>>,
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
            table.column.as_ref().map(|_| Quantity::Column(0, table.value.map_or(0.0, |value| value.value))),
        ]
        .into_iter()
        .flatten();
        let (Some(quantity), None) = (quantities.next(), quantities.next()) else {
            return Err("an event has one of `tilt`, `speed`, `energy`, `velocity_x`, `velocity_y`, `velocity_z`, \
                        `axis_x`, `axis_y`, `axis_z`, or a `column` with a `value`");
        };
        if table.value.is_some() && table.column.is_none() {
            return Err("a `value` is that of a `column`, as in `column = \"x_2\", value = 0.5`");
        }
        // An event's name is the name of a column.
        let is_plain = |letter: char| letter.is_alphanumeric() || "_-".contains(letter);
        if table.name.is_empty() || !table.name.chars().all(is_plain) {
            return Err("the `name` of an event has letters, digits, - and _ only");
        }
        Ok(Self { name: table.name, quantity, column: table.column, direction: table.direction, stops: table.stop })
    }
}

impl Event {
    /// Finds the place of a column among these, of which the numbers in some places jump, or refuses the quantity of one body
    /// elsewhere: `one_body` says why there is none.
    pub(crate) fn placed(
        &mut self,
        (columns, jumps): (&[Column], &dyn Fn(usize) -> bool),
        one_body: Result<(), &str>,
        at: &dyn Fn() -> Range<usize>,
    ) -> Result<(), SpanMessage> {
        let Some(name) = &self.column else {
            return match one_body {
                Err(message) if !matches!(self.quantity, Quantity::Energy(_)) => Err((at(), message.to_owned())),
                _ => Ok(()),
            };
        };
        let is_whole = |place: usize| !jumps(place);
        let found = columns.iter().find_map(|column| column.place(name.get_ref())).filter(|place| is_whole(*place));
        let Some(place) = found else {
            let names = columns.iter().flat_map(|column| column.names().map(move |name| (name, column.place(name))));
            let names = names.filter(|(_, place)| place.is_some_and(is_whole)).map(|(name, _)| format!("`{name}`"));
            let names = names.collect::<Vec<_>>().join(", ");
            let message = format!("unknown variant `{}`, expected one of {names}", name.get_ref());
            return Err((name.span(), advised(&message)));
        };
        if let Quantity::Column(own, _) = &mut self.quantity {
            *own = place;
        }
        Ok(())
    }
}
