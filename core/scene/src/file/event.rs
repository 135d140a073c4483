//! Events: the tables `[[event]]`.

use std::f64::consts::PI;
use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;

use crate::file::column::Column;
use crate::file::mistake::{SpanMessage, advised};
use crate::file::quantity::{Angle, Any, Energy, Number, PositiveScalar, Rate, Scalar};
use crate::file::text::{check_name, number_of};

/// An event to be detected along a run: a quantity passes a value.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "EventTable")]
pub(crate) struct Event {
    pub(crate) name: String,
    body: Option<Spanned<String>>,
    /// The number of the body, which is found when all are known.
    pub(crate) number: usize,
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
    /// An angle of a sample that goes around, by its place.
    Angle(usize, f64),
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
    body: Option<Spanned<String>>,
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
    type Error = String;

    fn try_from(table: EventTable) -> Result<Self, String> {
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
                        `axis_x`, `axis_y`, `axis_z`, or a `column` with a `value`"
                .to_owned());
        };
        // Others are reached by no axis, and their cosines are.
        if let Quantity::Tilt(angle) = quantity
            && !(0.0..=PI).contains(&angle)
        {
            return Err("a `tilt` is from 0 to 180 deg".to_owned());
        }
        if table.value.is_some() && table.column.is_none() {
            return Err("a `value` is that of a `column`, as in `column = \"x_2\", value = 0.5`".to_owned());
        }
        check_name("an event", &table.name)?;
        let EventTable { name, body, column, direction, stop: stops, .. } = table;
        Ok(Self { name, body, number: 0, quantity, column, direction, stops })
    }
}

impl Event {
    /// Finds the place of a column among these, which have quaternions in some places, or the body of these names; `of_body` says
    /// why there is none.
    pub(crate) fn placed(
        &mut self,
        (columns, quaternions): (&[Column], &[usize]),
        (bodies, of_body): (&[&str], Result<(), &str>),
        at: &dyn Fn() -> Range<usize>,
    ) -> Result<(), SpanMessage> {
        let is_of_all = self.column.is_some() || matches!(self.quantity, Quantity::Energy(_));
        if let Some(body) = self.body.as_ref().filter(|_| is_of_all) {
            return Err((body.span(), "this quantity is that of all bodies: leave `body` out".to_owned()));
        }
        let Some(name) = &self.column else {
            if !is_of_all {
                of_body.map_err(|message| (at(), message.to_owned()))?;
                self.number = number_of(self.body.as_ref(), bodies, &at())?;
            }
            return Ok(());
        };
        // A quaternion has two signs, and no values that are passed.
        let is_whole = |place: usize| !quaternions.iter().any(|start| (*start..start + 4).contains(&place));
        let found = columns.iter().find_map(|column| Some((column, column.place(name.get_ref())?)));
        let Some((column, place)) = found.filter(|(_, place)| is_whole(*place)) else {
            let names = columns.iter().flat_map(|column| column.names().map(move |name| (name, column.place(name))));
            let names = names.filter(|(_, place)| place.is_some_and(is_whole)).map(|(name, _)| format!("`{name}`"));
            let names = names.collect::<Vec<_>>().join(", ");
            let message = format!("unknown variant `{}`, expected one of {names}", name.get_ref());
            return Err((name.span(), advised(&message)));
        };
        if let Quantity::Column(_, value) = self.quantity {
            self.quantity =
                if column.goes_around(place) { Quantity::Angle(place, value) } else { Quantity::Column(place, value) };
        }
        Ok(())
    }
}
