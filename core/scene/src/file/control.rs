//! Laws of torques and wheels in the body: the tables `[[control]]` and `[[wheel]]`.

use std::ops::Range;

use liestep::mechanics;
use liestep_late::Signal;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use serde::{Deserialize, Deserializer};
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use crate::file::law::{Kind, Law, Value, within};
use crate::file::mistake::{SpanMessage, advised};
use crate::file::orbit::{FieldInTime, Nadir, Parameter as _, Time, towards_mass};
use crate::file::parameter::{Parameter, in_value};
use crate::file::quantity::{Direction, Duration, Inertia, PositiveScalar, Rate, Scalar, Torque};
use crate::file::start::Attitude;
use crate::file::tables::Document;
use crate::file::text::{check_name, number_of};

/// A law with what it reads, sampled and held, or at both ends of each step.
#[derive(Clone)]
pub(crate) struct Controller {
    law: Law,
    /// Time between samples, s; a step by default.
    pub(crate) every: Option<f64>,
    /// Whether half of the impulse is that of either end of a step.
    pub(crate) is_at_ends: bool,
    target: UnitQuaternion<f64>,
    /// Whether attitude and rate are relative to the local vertical.
    pub(crate) is_relative: bool,
    /// Whether the law reads the attitude, and the file doesn't say relative to what.
    has_no_frame: bool,
    readings: Vec<Reading>,
    parameters: Vec<Value>,
}

/// A vector in space that is read in the body frame.
#[derive(Clone)]
enum Reading {
    Nadir,
    Field(FieldInTime),
}

/// A torque on the body by a law.
#[derive(Clone)]
pub(crate) struct Control {
    /// The number of the body.
    pub(crate) body: usize,
    pub(crate) controller: Controller,
    /// The largest torque of each axis, N m.
    largest: Vector3<f64>,
    /// The largest norm, N m.
    largest_norm: f64,
    pub(crate) span: Range<usize>,
}

/// A balanced wheel on an axis of the body, with a motor.
#[derive(Clone)]
pub(crate) struct Wheel {
    pub(crate) name: String,
    /// The number of the body.
    pub(crate) body: usize,
    /// Axis, body frame.
    pub(crate) axis: Vector3<f64>,
    /// Moment about the axis, kg m².
    pub(crate) inertia: f64,
    /// Speed relative to the body at the start, rad/s.
    pub(crate) speed: f64,
    pub(crate) motor: Motor,
    /// Largest torque of the motor, N m.
    pub(crate) largest_torque: f64,
    /// Largest speed at which the motor drives on, rad/s.
    pub(crate) largest_speed: f64,
    pub(crate) span: Range<usize>,
}

/// The torque of a wheel's motor, N m.
#[derive(Clone)]
pub(crate) enum Motor {
    Signal(Signal),
    Number(f64),
    Law(Box<Controller>),
}

/// The state that a law reads.
pub(crate) struct Seen<'a> {
    pub(crate) now: Time<'a>,
    /// Attitude, body to space.
    pub(crate) attitude: Matrix3<f64>,
    /// Angular velocity, body frame, rad/s.
    pub(crate) velocity: Vector3<f64>,
}

/// Empty list of the tables that [`take`] removes first.
#[allow(clippy::unnecessary_wraps)] // serde requires a `Result`
pub(crate) fn taken<'de, D: Deserializer<'de>, T>(_: D) -> Result<Vec<T>, D::Error> {
    Ok(Vec::new())
}

impl Controller {
    /// The vectors that are read, in the body frame.
    pub(crate) fn readings(&self, seen: &Seen<'_>) -> Vec<Vector3<f64>> {
        let in_space = |reading: &Reading| match reading {
            Reading::Field(field) => field.at(seen.now),
            Reading::Nadir => {
                let direction = |orbit| towards_mass(orbit, seen.now.time).normalize();
                seen.now.orbit.map_or_else(|| Vector3::repeat(f64::NAN), direction)
            }
        };
        self.readings.iter().map(|reading| seen.attitude.tr_mul(&in_space(reading))).collect()
    }

    pub(crate) fn count_of_readings(&self) -> usize {
        self.readings.len()
    }

    /// Whether the law follows the orbit.
    fn is_on_orbit(&self) -> bool {
        let follows = |reading: &Reading| match reading {
            Reading::Nadir => true,
            Reading::Field(field) => field.is_on_orbit(),
        };
        self.is_relative || self.readings.iter().any(follows)
    }

    /// The value of the law, with the readings of this sample and of the one before.
    pub(crate) fn value(
        &self,
        seen: &Seen<'_>,
        (now, before): (&[Vector3<f64>], &[Vector3<f64>]),
        speed: Option<f64>,
    ) -> Value {
        let (mut attitude, mut velocity) = (seen.attitude, seen.velocity);
        if let Some(orbit) = seen.now.orbit.filter(|_| self.is_relative) {
            velocity -= attitude.tr_mul(&orbit.turning(seen.now.time));
            attitude = orbit.local_vertical(seen.now.time).tr_mul(&attitude);
        }
        let error =
            self.target.inverse() * UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(attitude));
        // The sign of the shorter turn.
        let error = if error.w < 0.0 { -error.into_inner() } else { error.into_inner() };
        let own = [
            Value::Number(seen.now.time),
            Value::Vector(velocity),
            Value::Number(error.w),
            Value::Vector(error.imag()),
        ];
        // The time between samples and the readings before belong to sampled laws.
        let every = self.every.filter(|_| !self.is_at_ends).map(Value::Number);
        let before = if self.is_at_ends { &[] } else { before };
        let readings = now.iter().chain(before).copied().map(Value::Vector);
        let own = own.into_iter().chain(every).chain(speed.map(Value::Number));
        let all: Vec<Value> = own.chain(readings).chain(self.parameters.iter().copied()).collect();
        self.law.value(&all)
    }

    /// The controller of a table with a text `torque`, beside keys that aren't its parameters.
    fn read(table: &DeTable<'_>, text: (&str, Range<usize>), keys: &[&str], kind: Kind) -> Result<Self, SpanMessage> {
        let is_at_ends = at_ends(table)?;
        let mut names: Vec<(String, Kind)> = ["t", "Omega", "q_w", "q"]
            .into_iter()
            .zip([Kind::Number, Kind::Vector, Kind::Number, Kind::Vector])
            .map(|(name, kind)| (name.to_owned(), kind))
            .collect();
        names.extend((!is_at_ends).then(|| ("every".to_owned(), Kind::Number)));
        names.extend((kind == Kind::Number).then(|| ("speed".to_owned(), Kind::Number)));
        let advected = advected(table)?;
        let mut readings = Vec::new();
        for (_, key, span) in &advected {
            let value = table.get(key.as_str());
            let value = value.ok_or_else(|| (span.clone(), format!("the table has no vector `{key}`")))?;
            readings.push(reading(value)?);
        }
        names.extend(advected.iter().map(|(name, ..)| (name.clone(), Kind::Vector)));
        let before = advected.iter().filter(|_| !is_at_ends);
        names.extend(before.map(|(name, ..)| (format!("{name}_before"), Kind::Vector)));
        let mut parameters = Vec::new();
        let is_parameter = |key: &str| !keys.contains(&key) && !COMMON.contains(&key);
        for (key, value) in table {
            let name = key.get_ref().as_ref();
            if !is_parameter(name) || advected.iter().any(|(_, own, _)| own == name) {
                continue;
            }
            if names.iter().any(|(own, _)| own == name) {
                return Err((key.span(), format!("`{name}` has another meaning in a law: take another name")));
            }
            let Parameter { kind, numbers, .. } = Parameter::of(name, value)?;
            let value = match (kind.as_str(), &numbers[..]) {
                ("f64", &[number]) => Value::Number(number),
                (_, &[x, y, z]) => Value::Vector(Vector3::new(x, y, z)),
                _ => return Err((value.span(), "a parameter of a law is a number or a vector of three".to_owned())),
            };
            names.push((name.to_owned(), value.kind()));
            parameters.push(value);
        }
        let law = Law::parse(text.0, &names, kind).map_err(|message| (text.1, message))?;
        let every = optional::<PositiveScalar<Duration>>(table, "every")?.map(|every| every.value);
        let target = optional::<Attitude>(table, "target")?.map_or_else(UnitQuaternion::identity, |at| at.rotation());
        let frame = table.get("relative_to");
        let is_relative = match frame.map(|frame| (frame.get_ref().as_str(), frame.span())) {
            None | Some((Some("space"), _)) => false,
            Some((Some("local vertical"), _)) => true,
            Some((_, span)) => {
                return Err((span, "a law is relative to \"space\", or to the \"local vertical\"".to_owned()));
            }
        };
        let mut words = text.0.split(|letter: char| !letter.is_alphanumeric() && letter != '_');
        let has_no_frame = frame.is_none() && words.any(|word| ["q", "q_w"].contains(&word));
        Ok(Self { law, every, is_at_ends, target, is_relative, has_no_frame, readings, parameters })
    }
}

/// Keys of all laws.
const COMMON: [&str; 6] = ["torque", "every", "at", "target", "relative_to", "advected"];

/// Whether a law is at both ends of each step.
fn at_ends(table: &DeTable<'_>) -> Result<bool, SpanMessage> {
    match (table.get("at"), table.get("every")) {
        (None, _) => Ok(false),
        (Some(at), _) if at.get_ref().as_str() != Some("both ends") => {
            Err((at.span(), "a law is held from sample to sample, or is `at = \"both ends\"` of each step".to_owned()))
        }
        (Some(_), Some(every)) => {
            Err((every.span(), "a law at both ends of each step has no samples: leave `every` out".to_owned()))
        }
        (Some(_), None) => Ok(true),
    }
}

/// Names of the vectors in space that a law reads, and their keys.
fn advected(table: &DeTable<'_>) -> Result<Vec<(String, String, Range<usize>)>, SpanMessage> {
    let Some(value) = table.get("advected") else { return Ok(Vec::new()) };
    let wrong = |span| (span, "what a law reads is named as in `advected = { b = \"B\" }`".to_owned());
    let inner = value.get_ref().as_table().ok_or_else(|| wrong(value.span()))?;
    let pair = |(name, key): (&Spanned<std::borrow::Cow<'_, str>>, &Spanned<DeValue<'_>>)| {
        let own = key.get_ref().as_str().ok_or_else(|| wrong(key.span()))?;
        Ok((name.get_ref().to_string(), own.to_owned(), key.span()))
    };
    inner.iter().map(pair).collect()
}

fn reading(value: &Spanned<DeValue<'_>>) -> Result<Reading, SpanMessage> {
    let source = || ValueDeserializer::from(value.clone());
    if Nadir::deserialize(source()).is_ok() {
        return Ok(Reading::Nadir);
    }
    FieldInTime::deserialize(source()).map(Reading::Field).map_err(|error| in_value(value, &error))
}

fn optional<'de, T: Deserialize<'de>>(table: &DeTable<'de>, key: &str) -> Result<Option<T>, SpanMessage> {
    let Some(value) = table.get(key) else { return Ok(None) };
    T::deserialize(ValueDeserializer::from(value.clone())).map(Some).map_err(|error| in_value(value, &error))
}

fn required<'de, T: Deserialize<'de>>(table: &DeTable<'de>, key: &str, at: &Range<usize>) -> Result<T, SpanMessage> {
    optional(table, key)?.ok_or_else(|| (at.clone(), format!("missing field `{key}`")))
}

/// A number for all axes, or one for each.
#[derive(Deserialize)]
#[serde(untagged, expecting = "a torque above zero for all axes, or three of them")]
enum Limits {
    One(PositiveScalar<Torque>),
    Each([PositiveScalar<Torque>; 3]),
}

impl Control {
    fn read(table: &DeTable<'_>, span: Range<usize>, bodies: &[&str]) -> Result<Self, SpanMessage> {
        let torque = table.get("torque").ok_or_else(|| (span.clone(), "missing field `torque`".to_owned()))?;
        let Some(text) = torque.get_ref().as_str() else {
            return Err((torque.span(), "the torque of a control is a text, as \"-kd * Omega\"".to_owned()));
        };
        let keys = ["body", "largest", "largest_norm"];
        let body = number_of(optional(table, "body")?.as_ref(), bodies, &span)?;
        let controller = Controller::read(table, (text, torque.span()), &keys, Kind::Vector)?;
        let largest = match optional::<Limits>(table, "largest")? {
            None => Vector3::repeat(f64::INFINITY),
            Some(Limits::One(limit)) => Vector3::repeat(limit.value),
            Some(Limits::Each([x, y, z])) => Vector3::new(x.value, y.value, z.value),
        };
        let largest_norm = optional::<PositiveScalar<Torque>>(table, "largest_norm")?;
        let largest_norm = largest_norm.map_or(f64::INFINITY, |norm| norm.value);
        Ok(Self { body, controller, largest, largest_norm, span })
    }

    /// A torque within the limits of the axes, and then of the norm.
    pub(crate) fn limited(&self, torque: Vector3<f64>) -> Vector3<f64> {
        let within = torque.zip_map(&self.largest, |part, most| within(part, [-most, most]));
        let norm = within.norm();
        if norm > self.largest_norm { within * (self.largest_norm / norm) } else { within }
    }
}

const WHEEL: [&str; 8] = ["name", "body", "axis", "inertia", "speed", "torque", "largest_torque", "largest_speed"];

impl Wheel {
    fn read(
        number: usize,
        table: &DeTable<'_>,
        span: Range<usize>,
        (signal, bodies): (Option<Signal>, &[&str]),
    ) -> Result<Self, SpanMessage> {
        let motor = match (signal, table.get("torque")) {
            (Some(signal), _) => Motor::Signal(signal),
            (None, None) => Motor::Number(0.0),
            (None, Some(value)) => match value.get_ref().as_str() {
                Some(text) if Scalar::<Torque>::deserialize(ValueDeserializer::from(value.clone())).is_err() => {
                    if let Some(at) = table.get("at") {
                        return Err((
                            at.span(),
                            "the law of a wheel is held from sample to sample: leave `at` out".to_owned(),
                        ));
                    }
                    Motor::Law(Box::new(Controller::read(table, (text, value.span()), &WHEEL, Kind::Number)?))
                }
                _ => Motor::Number(required::<Scalar<Torque>>(table, "torque", &span)?.value),
            },
        };
        let is_known = |key: &str| WHEEL.contains(&key) || matches!(motor, Motor::Law(_));
        if let Some((key, _)) = table.iter().find(|(key, _)| !is_known(key.get_ref())) {
            let known = WHEEL.map(|key| format!("`{key}`")).join(", ");
            return Err((key.span(), advised(&format!("unknown field `{}`, expected one of {known}", key.get_ref()))));
        }
        let name: Option<String> = optional(table, "name")?;
        if let (Some(value), Some(name)) = (table.get("name"), &name) {
            check_name("a wheel", name).map_err(|message| (value.span(), message))?;
        }
        let most = |limit: Option<f64>| limit.unwrap_or(f64::INFINITY);
        Ok(Self {
            name: name.unwrap_or_else(|| format!("wheel_{}", number + 1)),
            body: number_of(optional(table, "body")?.as_ref(), bodies, &span)?,
            axis: required::<Direction>(table, "axis", &span)?.0,
            inertia: required::<PositiveScalar<Inertia>>(table, "inertia", &span)?.value,
            speed: optional::<Scalar<Rate>>(table, "speed")?.map_or(0.0, |speed| speed.value),
            motor,
            largest_torque: most(optional::<PositiveScalar<Torque>>(table, "largest_torque")?.map(|most| most.value)),
            largest_speed: most(optional::<PositiveScalar<Rate>>(table, "largest_speed")?.map(|most| most.value)),
            span,
        })
    }

    /// The law of the motor.
    pub(crate) fn controller(&self) -> Option<&Controller> {
        if let Motor::Law(controller) = &self.motor { Some(controller) } else { None }
    }
}

/// Reader of the signal in a value; none of another value.
type ReadSignal<'r> = &'r dyn Fn(&Spanned<DeValue<'_>>) -> Result<Option<Signal>, SpanMessage>;

/// The tables `[[control]]` and `[[wheel]]` on bodies of these names, which are removed; `signal` reads a torque over time.
pub(crate) fn take(
    document: &mut Document<'_>,
    signal: ReadSignal<'_>,
    bodies: &[&str],
) -> Result<(Vec<Control>, Vec<Wheel>), SpanMessage> {
    let (mut controls, mut wheels) = (Vec::new(), Vec::new());
    for (_, table, span) in listed(document, "control")? {
        controls.push(Control::read(&table, span, bodies)?);
    }
    for (number, table, span) in listed(document, "wheel")? {
        let over_time = table.get("torque").map(signal).transpose()?.flatten();
        wheels.push(Wheel::read(number, &table, span, (over_time, bodies))?);
    }
    Ok((controls, wheels))
}

/// The tables of a list, which is removed.
fn listed<'a>(document: &mut Document<'a>, name: &str) -> Result<Vec<(usize, DeTable<'a>, Range<usize>)>, SpanMessage> {
    let Some(value) = document.get_mut().remove(name) else { return Ok(Vec::new()) };
    let wrong = |span| (span, format!("`{name}` is a list of tables, `[[{name}]]`"));
    let span = value.span();
    let DeValue::Array(tables) = value.into_inner() else { return Err(wrong(span)) };
    let table = |(number, one): (usize, Spanned<DeValue<'a>>)| {
        let span = one.span();
        match one.into_inner() {
            DeValue::Table(table) => Ok((number, table, span)),
            _ => Err(wrong(span)),
        }
    };
    tables.into_iter().enumerate().map(table).collect()
}

/// The laws of a scene, with the places of their tables.
fn laws<'a>(controls: &'a [Control], wheels: &'a [Wheel]) -> impl Iterator<Item = (&'a Controller, &'a Range<usize>)> {
    let of_controls = controls.iter().map(|control| (&control.controller, &control.span));
    of_controls.chain(wheels.iter().filter_map(|wheel| Some((wheel.controller()?, &wheel.span))))
}

/// The place of the first law that reads the attitude, and doesn't say relative to what.
pub(crate) fn of_no_frame<'a>(controls: &'a [Control], wheels: &'a [Wheel]) -> Option<&'a Range<usize>> {
    laws(controls, wheels).find(|(law, _)| law.has_no_frame).map(|(_, span)| span)
}

/// The readings of all laws of a scene, by what each body sees.
pub(crate) fn readings<'s>(
    controls: &[Control],
    wheels: &[Wheel],
    seen: &dyn Fn(usize) -> Seen<'s>,
) -> Vec<Vector3<f64>> {
    let of_controls = controls.iter().map(|control| (control.body, &control.controller));
    let motors = wheels.iter().filter_map(|wheel| Some((wheel.body, wheel.controller()?)));
    of_controls.chain(motors).flat_map(|(body, law)| law.readings(&seen(body))).collect()
}

/// The number of entries that a state has for laws and wheels: a momentum and a torque of each wheel, the torques on the
/// body, all readings, and a time.
pub(crate) fn entries(controls: &[Control], wheels: &[Wheel]) -> usize {
    let readings: usize = laws(controls, wheels).map(|(law, _)| law.count_of_readings()).sum();
    2 * wheels.len() + 3 * controls.len() + 3 * readings + 1
}

/// Sets the time between samples of laws without one to that of a step, s; refuses times that aren't whole numbers of steps,
/// and laws along an orbit where the scene has none.
pub(crate) fn settle(
    controls: &mut [Control],
    wheels: &mut [Wheel],
    (step, has_orbit): (f64, bool),
) -> Result<(), SpanMessage> {
    let of_controls = controls.iter_mut().map(|control| &mut control.controller);
    let motors = wheels.iter_mut().filter_map(|wheel| match &mut wheel.motor {
        Motor::Law(controller) => Some(&mut **controller),
        _ => None,
    });
    for law in of_controls.chain(motors) {
        law.every.get_or_insert(step);
    }
    for (law, span) in laws(controls, wheels) {
        if stride(law, step).is_none() {
            return Err((span.clone(), "the time `every` is a whole number of steps".to_owned()));
        }
        if law.is_on_orbit() && !has_orbit {
            return Err((span.clone(), "this law follows the orbit, and the file has no table `[orbit]`".to_owned()));
        }
    }
    let is_twice = |at: usize| wheels[..at].iter().any(|other| other.name == wheels[at].name);
    match (0..wheels.len()).find(|at| is_twice(*at)) {
        Some(at) => Err((wheels[at].span.clone(), format!("two wheels have the name `{}`", wheels[at].name))),
        None => Ok(()),
    }
}

/// Whether samples are at the ends of steps of this length, s.
pub(crate) fn fit(controls: &[Control], wheels: &[Wheel], step: f64) -> bool {
    laws(controls, wheels).all(|(law, _)| stride(law, step).is_some())
}

/// The inertia of a body with its wheels locked to it, kg m², at which a gravity gradient pulls.
pub(crate) fn locked(J: &mechanics::Inertia, wheels: &[Wheel], body: usize) -> mechanics::Inertia {
    let mut own = wheels.iter().filter(|wheel| wheel.body == body).peekable();
    if own.peek().is_none() {
        return *J;
    }
    let moments: Matrix3<f64> = own.map(|wheel| wheel.axis * wheel.axis.transpose() * wheel.inertia).sum();
    mechanics::Inertia::new(J.as_matrix() + moments).unwrap_or(*J)
}

/// Steps from one sample to the next.
pub(crate) fn stride(law: &Controller, step: f64) -> Option<f64> {
    let steps = law.every.map_or(1.0, |every| every / step);
    let whole = steps.round();
    (whole >= 1.0 && (steps - whole).abs() < 1e-9 * whole).then_some(whole)
}
