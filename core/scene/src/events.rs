//! Events: the tables `[[event]]`.

use std::cell::RefCell;

use liestep::SO3;
use liestep::groups::Advected;
use liestep::motion::{AnyStepper, Moment};
use liestep::with;
use nalgebra::Vector3;
use serde::Deserialize;

use crate::quantity::{Angle, Energy, Number, Positive, Rate, Scalar};
use crate::run::Sample;

/// What is looked for along a run: that a quantity passes a value.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "EventTable")]
pub(crate) struct Event {
    pub(crate) name: String,
    quantity: Quantity,
    direction: Direction,
    pub(crate) stops: bool,
}

/// A quantity and the value, in SI units.
#[derive(Clone, Copy, Debug)]
enum Quantity {
    Tilt(f64),
    Speed(f64),
    Energy(f64),
    Velocity(usize, f64),
    Axis(usize, f64),
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Direction {
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
    velocity_1: Option<Scalar<Rate>>,
    velocity_2: Option<Scalar<Rate>>,
    velocity_3: Option<Scalar<Rate>>,
    axis_1: Option<Scalar<Number>>,
    axis_2: Option<Scalar<Number>>,
    axis_3: Option<Scalar<Number>>,
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
            table.velocity_1.map(|rate| Quantity::Velocity(0, rate.value)),
            table.velocity_2.map(|rate| Quantity::Velocity(1, rate.value)),
            table.velocity_3.map(|rate| Quantity::Velocity(2, rate.value)),
            table.axis_1.map(|part| Quantity::Axis(0, part.value)),
            table.axis_2.map(|part| Quantity::Axis(1, part.value)),
            table.axis_3.map(|part| Quantity::Axis(2, part.value)),
        ]
        .into_iter()
        .flatten();
        let (Some(quantity), None) = (quantities.next(), quantities.next()) else {
            return Err("an event has one of `tilt`, `speed`, `energy`, `velocity_1`, `velocity_2`, `velocity_3`, \
                        `axis_1`, `axis_2`, `axis_3`");
        };
        // It is the name of a column.
        let is_plain = |letter: char| letter.is_alphanumeric() || "_-".contains(letter);
        if table.name.is_empty() || !table.name.chars().all(is_plain) {
            return Err("the `name` of an event has letters, digits, - and _ only");
        }
        Ok(Self { name: table.name, quantity, direction: table.direction, stops: table.stop })
    }
}

/// An event that has happened.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Happening {
    /// Which of the scene's events, from zero.
    pub event: usize,
    /// Whether the quantity rose.
    pub rising: bool,
    /// The motion then.
    pub sample: Sample,
}

/// More are no events but the course of the motion.
pub(crate) const MOST_HAPPENINGS: usize = 1_000_000;

impl Event {
    /// What counts as it.
    pub(crate) fn kind(&self) -> with::Event {
        let kind = match self.direction {
            Direction::Rising => with::Event::rising(),
            Direction::Falling => with::Event::falling(),
            Direction::Either => with::Event::crossing(),
        };
        if self.stops { kind.terminal() } else { kind }
    }

    /// The function that rises through zero as the quantity rises through its value; a tilt is that of this body axis.
    pub(crate) fn function<A: Advected<SO3>>(
        &self,
        axis: Vector3<f64>,
    ) -> impl Fn(&Moment<'_, AnyStepper<SO3, A>>) -> f64 + use<A> {
        let quantity = self.quantity;
        move |now| match quantity {
            // By the cosine, which is smooth at the vertical.
            Quantity::Tilt(angle) => angle.cos() - (now.attitude().as_matrix() * axis).z,
            Quantity::Speed(speed) => now.velocity().norm_squared() - speed * speed,
            Quantity::Energy(energy) => now.energy() - energy,
            Quantity::Velocity(component, rate) => now.velocity()[component] - rate,
            Quantity::Axis(component, part) => (now.attitude().as_matrix() * axis)[component] - part,
        }
    }
}

/// Where the events of a run are written down; the functions that do it are called one after the other.
pub(crate) struct Log(pub(crate) RefCell<Vec<Happening>>);

impl Log {
    /// Writes it down, if there is room.
    pub(crate) fn write(&self, happening: Happening) -> Result<(), &'static str> {
        let mut list = self.0.borrow_mut();
        if list.len() >= MOST_HAPPENINGS {
            return Err("an event happens more than a million times");
        }
        list.push(happening);
        Ok(())
    }
}
