//! The table of a joint: its kind, its points and axes, friction, springs and motors in it, and where it starts.

use std::ops::Range;

use liestep::methods;
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use serde::Deserialize;
use toml::Spanned;

use crate::file::joint_kind::Kind;
use crate::file::mistake::SpanMessage;
use crate::file::orbit::put;
use crate::file::quantity::{
    Angle, Damping, Direction, Force, Inertia, Length, LinearDamping, Mass, PositiveScalar, Quantity, Rate, Scalar,
    Speed, Stiffness, Torque, Triple, TurningStiffness, short, si,
};
use crate::file::start::Attitude;

/// A joint of two bodies, that of the body above first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Joint {
    pub(crate) kind: Kind,
    /// A point of each, from the centre of mass in the body's axes, m.
    pub(crate) at: [Vector3<f64>; 2],
    /// A unit vector of each; zero where the kind has no axes.
    pub(crate) axes: [Vector3<f64>; 2],
    /// The attitude of the body below in the axes of the body above, at the angle zero.
    pub(crate) zero: Matrix3<f64>,
    /// The distance between the points of a rod, m.
    pub(crate) length: f64,
    pub(crate) limits: Option<Limits>,
    /// The numbers that the file gives, each at the place of its [`Number`].
    numbers: [Option<f64>; NUMBERS],
    /// 1, or −1 where the file names the bodies in the other order: the sign of angles and shifts there.
    pub(crate) sign: f64,
}

/// The attitude of a body, or of space, and the place of its origin.
pub(crate) type Pose = (Matrix3<f64>, Vector3<f64>);

/// A number of the terms in a joint, or of its start, which places bodies without places of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Number {
    Damping,
    Stiffness,
    /// The angle or the shift at which the spring is at rest.
    Rest,
    /// The torque or the force of a motor.
    Effort,
    /// The torque or the force of dry friction.
    Friction,
    /// The rate or the speed below which dry friction is viscous.
    Below,
    /// The inertia of a motor's rotor, as the joint feels it. It and all that follow don't change with time.
    Armature,
    Angle,
    Rate,
    Shift,
    Speed,
}

const NUMBERS: usize = Number::Speed as usize + 1;

/// The numbers that a key may have.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sign {
    /// All, with the opposite sign where the file names the bodies in the other order.
    Either,
    /// Numbers above zero, and zero over time, where the term is off.
    OrOff,
    /// Numbers above zero.
    Above,
}

/// The reader of a quantity's value, and its SI unit.
type Measure = (fn(&Given) -> Result<f64, SpanMessage>, &'static str);

const fn unit<Q: Quantity>() -> Measure {
    (read::<Q>, si::<Q>())
}

/// A key of a joint for a number.
pub(crate) struct Key {
    name: &'static str,
    number: Number,
    /// The value in a table.
    value: Value,
    /// The kinds that have the number, beside sliders.
    has: fn(Kind) -> bool,
    sign: Sign,
    /// The units in a joint of such a kind, and in a slider.
    units: [Option<Measure>; 2],
}

type Value = fn(&JointTable) -> Option<&Given>;

/// All numbers of joints, as files have them.
const KEYS: [Key; 13] = {
    use Kind as K;
    use Number as N;
    use Sign::{Above, Either, OrOff};
    const fn both<Q: Quantity, P: Quantity>() -> [Option<Measure>; 2] {
        [Some(unit::<Q>()), Some(unit::<P>())]
    }
    const fn turn<Q: Quantity>() -> [Option<Measure>; 2] {
        [Some(unit::<Q>()), None]
    }
    const fn slide<Q: Quantity>() -> [Option<Measure>; 2] {
        [None, Some(unit::<Q>())]
    }
    const fn key(
        name: &'static str,
        number: Number,
        value: Value,
        has: fn(Kind) -> bool,
        sign: Sign,
        units: [Option<Measure>; 2],
    ) -> Key {
        Key { name, number, value, has, sign, units }
    }
    [
        key("damping", N::Damping, |of| of.damping.as_ref(), K::turns, OrOff, both::<Damping, LinearDamping>()),
        key(
            "stiffness",
            N::Stiffness,
            |of| of.stiffness.as_ref(),
            K::springs,
            OrOff,
            both::<TurningStiffness, Stiffness>(),
        ),
        key("rest", N::Rest, |of| of.rest.as_ref(), K::rests, Either, both::<Angle, Length>()),
        key("torque", N::Effort, |of| of.torque.as_ref(), K::turns_about_axis, Either, turn::<Torque>()),
        key("force", N::Effort, |of| of.force.as_ref(), K::turns_about_axis, Either, slide::<Force>()),
        key("friction.torque", N::Friction, |of| of.dry()?.torque.as_ref(), K::turns, OrOff, turn::<Torque>()),
        key("friction.force", N::Friction, |of| of.dry()?.force.as_ref(), K::turns, OrOff, slide::<Force>()),
        key("friction.below", N::Below, |of| of.dry()?.below.as_ref(), K::turns, Above, both::<Rate, Speed>()),
        key("armature", N::Armature, |of| of.armature.as_ref(), K::turns, Above, both::<Inertia, Mass>()),
        key("angle", N::Angle, |of| of.angle.as_ref(), K::turns_about_axis, Either, turn::<Angle>()),
        key("rate", N::Rate, |of| of.rate.as_ref(), K::turns_about_axis, Either, turn::<Rate>()),
        key("shift", N::Shift, |of| of.shift.as_ref(), K::shifts_along_axis, Either, both::<Length, Length>()),
        key("speed", N::Speed, |of| of.speed.as_ref(), K::shifts_along_axis, Either, both::<Speed, Speed>()),
    ]
};

impl Key {
    /// The unit in a joint of a kind; none where that hasn't the number.
    fn unit(&self, kind: Kind) -> Option<Measure> {
        let [turning, sliding] = self.units;
        if kind == Kind::Slider { sliding } else { turning.filter(|_| (self.has)(kind)) }
    }

    const fn may_change(&self) -> bool {
        (self.number as usize) < Number::Armature as usize
    }
}

/// The keys of numbers that may change with time, with their units.
#[must_use]
pub fn changing_numbers() -> String {
    let words = KEYS.iter().filter(|key| key.may_change()).map(|key| {
        let units: Vec<_> = key.units.iter().flatten().map(|(_, unit)| *unit).collect();
        format!("{} in {}", key.name, units.join(" or "))
    });
    words.collect::<Vec<_>>().join(", ")
}

/// The ends of a joint's way, which are watched: angles of a pin, rad, or shifts of a slider, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    pub(crate) ends: [f64; 2],
    /// Whether the run stops there.
    pub(crate) stops: bool,
}

/// The names of two bodies.
pub(crate) type Names = Spanned<[Spanned<String>; 2]>;

/// The keys of a joint.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct JointTable {
    /// The name, by which programs reach it.
    pub(crate) name: Option<Spanned<String>>,
    kind: Spanned<Kind>,
    pub(crate) bodies: Names,
    at: [Triple<Length>; 2],
    axes: Option<Spanned<[Direction; 2]>>,
    zero: Option<Spanned<Attitude>>,
    length: Option<Spanned<PositiveScalar<Length>>>,
    damping: Option<Given>,
    stiffness: Option<Given>,
    rest: Option<Given>,
    torque: Option<Given>,
    force: Option<Given>,
    friction: Option<Spanned<FrictionTable>>,
    armature: Option<Given>,
    limits: Option<Spanned<LimitsTable>>,
    angle: Option<Given>,
    rate: Option<Given>,
    shift: Option<Given>,
    speed: Option<Given>,
}

/// A number whose unit depends on the kind of joint.
type Given = Spanned<toml::Value>;

/// Dry friction, regularised: its torque, or its force in a slider.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct FrictionTable {
    torque: Option<Given>,
    force: Option<Given>,
    /// The rate or the speed below which friction is viscous.
    below: Option<Given>,
}

/// The parts of dry friction in a joint that turns, and in a slider.
const FRICTION: [&str; 2] = [
    "dry friction has a `torque`, N m, and the rate `below` which it is viscous, rad/s",
    "dry friction in a slider has a `force`, N, and the speed `below` which it is viscous, m/s",
];

/// The ends of a joint's way.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct LimitsTable {
    from: Given,
    to: Given,
    #[serde(default)]
    stop: bool,
}

impl LimitsTable {
    fn limits<Q: Quantity>(self, span: Range<usize>, most: f64) -> Result<Limits, SpanMessage> {
        let [from, to] = [read::<Q>(&self.from)?, read::<Q>(&self.to)?];
        if from >= to {
            return Err((span, "a joint moves `from` one place `to` a greater one".to_owned()));
        }
        if to - from >= most {
            return Err((
                span,
                "these limits are a turn apart or more, so that none is reached: leave them out".to_owned(),
            ));
        }
        Ok(Limits { ends: [from, to], stops: self.stop })
    }
}

/// The number of a value with the units of a quantity.
fn read<Q: Quantity>(value: &Given) -> Result<f64, SpanMessage> {
    let read = Scalar::<Q>::deserialize(value.get_ref().clone());
    read.map(|scalar| scalar.value).map_err(|error| (value.span(), error.message().to_owned()))
}

/// The largest cosine between what `zero` makes of the axis below and a direction across the axis above.
const ALONG: f64 = 1e-6;

impl JointTable {
    fn dry(&self) -> Option<&FrictionTable> {
        self.friction.as_ref().map(Spanned::get_ref)
    }

    /// Refuses keys that the kind doesn't have.
    fn check(&self) -> Result<(), SpanMessage> {
        let kind = *self.kind.get_ref();
        let name = kind.name();
        let refuse = |span: Range<usize>, why: String| Err((span, why));
        if let (Kind::Ball, Some(axes)) = (kind, &self.axes) {
            return refuse(
                axes.span(),
                "a ball joint turns about any axis; leave `axes` out, or make it a `pin`".to_owned(),
            );
        }
        if let (false, Some(axes)) = (kind.has_axes(), &self.axes) {
            return refuse(axes.span(), format!("a {name} has no axis: leave `axes` out"));
        }
        if kind.has_axes() && self.axes.is_none() {
            let message = format!("a {name} has `axes`: that of each of its bodies, in that body's frame");
            return refuse(self.kind.span(), message);
        }
        match (&self.length, kind) {
            (None, Kind::Distance) => {
                return refuse(
                    self.kind.span(),
                    "a distance has a `length`, m, that of a rod between both points".to_owned(),
                );
            }
            (Some(length), kind) if kind != Kind::Distance => {
                return refuse(length.span(), format!("a {name} has no `length`; a `distance` has"));
            }
            _ => (),
        }
        let is_slider = kind == Kind::Slider;
        if let Some(friction) = &self.friction {
            if !kind.turns() && !is_slider {
                let message = format!("a {name} has no dry `friction`: it is for joints that turn, and for sliders");
                return refuse(friction.span(), message);
            }
            let FrictionTable { torque, force, below } = friction.get_ref();
            let (own, other) = if is_slider { (force, torque) } else { (torque, force) };
            if other.is_some() || own.is_none() || below.is_none() {
                let place = other.as_ref().map_or_else(|| friction.span(), Spanned::span);
                return refuse(place, FRICTION[usize::from(is_slider)].to_owned());
            }
        }
        for (key, value) in KEYS.iter().filter_map(|key| Some((key, (key.value)(self)?))) {
            if key.unit(kind).is_none() {
                let instead = match key.name {
                    "torque" if is_slider => "; its motor has a `force`",
                    "force" if kind.turns() => "; a motor that turns has a `torque`",
                    "angle" | "rate" if is_slider => "; it starts at a `shift` with a `speed`",
                    "shift" | "speed" if kind.turns_about_axis() => "; it starts at an `angle` with a `rate`",
                    _ => "",
                };
                return refuse(value.span(), format!("a {name} has no `{}`{instead}", key.name));
            }
        }
        if let (Some(limits), false) = (&self.limits, matches!(kind, Kind::Pin | Kind::Slider)) {
            return refuse(limits.span(), format!("a {name} has no `limits`: those of a pin and a slider are watched"));
        }
        if let (Some(rest), None) = (&self.rest, &self.stiffness) {
            return refuse(rest.span(), "a spring that is at `rest` somewhere has a `stiffness`".to_owned());
        }
        Ok(())
    }

    /// The attitude at the angle zero: that which is given, or by the least turn that makes the axes parallel.
    fn attitude(&self, axes: &[Vector3<f64>; 2]) -> Result<Matrix3<f64>, SpanMessage> {
        let kind = *self.kind.get_ref();
        let given = self.zero.as_ref().map(|zero| *zero.get_ref().rotation().to_rotation_matrix().matrix());
        if !kind.has_one_axis() {
            return Ok(given.unwrap_or_else(Matrix3::identity));
        }
        let [above, below] = axes;
        if let (Some(given), Some(zero)) = (given, &self.zero) {
            let off = (given * below).cross(above).norm();
            if off > ALONG {
                let message = format!(
                    "`zero` turns the second of `axes` away from the first, by {} in sine: in both frames they are one line",
                    short(off)
                );
                return Err((zero.span(), message));
            }
            return Ok(given);
        }
        // Opposite axes have no least turn: half a turn about any axis across them.
        let half = || {
            let across = above.cross(&Vector3::ith(above.iamin(), 1.0));
            Rotation3::from_axis_angle(&Unit::new_normalize(across), std::f64::consts::PI)
        };
        Ok(*Rotation3::rotation_between(below, above).unwrap_or_else(half).matrix())
    }

    /// The place of the first of its coordinates at the start, if any is given.
    pub(crate) fn coordinate(&self) -> Option<Range<usize>> {
        let of_start = KEYS.iter().filter(|key| key.number as usize >= Number::Angle as usize);
        of_start.filter_map(|key| (key.value)(self)).map(Spanned::span).next()
    }

    /// The joint; if the second of its bodies is space, with both exchanged.
    pub(crate) fn joint(self, is_swapped: bool) -> Result<Joint, SpanMessage> {
        self.check()?;
        let kind = *self.kind.get_ref();
        let axes = self.axes.as_ref().map_or([Vector3::zeros(); 2], |axes| axes.get_ref().map(|axis| axis.0));
        let zero = self.attitude(&axes)?;
        let mut numbers = [None; NUMBERS];
        for key in &KEYS {
            let (Some(value), Some((read, _))) = ((key.value)(&self), key.unit(kind)) else { continue };
            let number = read(value)?;
            if key.sign != Sign::Either && number <= 0.0 {
                return Err((value.span(), "must be above zero".to_owned()));
            }
            numbers[key.number as usize] = Some(number);
        }
        let limits = self.limits.map(|limits| {
            let (span, limits) = (limits.span(), limits.into_inner());
            if kind == Kind::Slider {
                limits.limits::<Length>(span, f64::INFINITY)
            } else {
                limits.limits::<Angle>(span, std::f64::consts::TAU)
            }
        });
        let limits = limits.transpose()?;
        let length = self.length.map_or(0.0, |length| length.into_inner().value);
        let at = self.at.map(|point| point.value);
        let joint = Joint { kind, at, axes, zero, length, numbers, limits, sign: 1.0 };
        Ok(if is_swapped { joint.swapped() } else { joint })
    }
}

impl Joint {
    /// The joint from the other end: angles, shifts and what acts along them have the opposite sign.
    fn swapped(self) -> Self {
        let Self { mut at, mut axes, zero, limits, .. } = self;
        at.swap(0, 1);
        axes.swap(0, 1);
        let mut numbers = self.numbers;
        for (at, number) in numbers.iter_mut().enumerate() {
            let is_signed = KEYS.iter().any(|key| key.number as usize == at && key.sign == Sign::Either);
            *number = number.map(|number| if is_signed { -number } else { number });
        }
        let limits = limits.map(|limits| Limits { ends: [-limits.ends[1], -limits.ends[0]], ..limits });
        Self { at, axes, zero: zero.transpose(), numbers, limits, sign: -self.sign, ..self }
    }

    /// A number that the file gives.
    pub(crate) const fn number(&self, number: Number) -> Option<f64> {
        self.numbers[number as usize]
    }

    /// Whether the file gives one of these numbers.
    pub(crate) fn has(&self, numbers: &[Number]) -> bool {
        numbers.iter().any(|number| self.number(*number).is_some())
    }

    /// The angle, rad, its rate, the shift, m, and its speed at the start, of bodies without places of their own.
    pub(crate) fn start(&self) -> [f64; 4] {
        [Number::Angle, Number::Rate, Number::Shift, Number::Speed].map(|of| self.number(of).unwrap_or(0.0))
    }

    /// Sets a value over time, with the sign that the file has; returns whether it can have this number.
    pub(crate) fn put(&mut self, name: &str, number: f64) -> bool {
        let of_name = |key: &&Key| key.name == name && key.may_change() && key.unit(self.kind).is_some();
        let Some(Key { number: of, sign, .. }) = KEYS.iter().find(of_name) else { return false };
        let (can_be, number) = match sign {
            Sign::Either => (true, self.sign * number),
            Sign::OrOff => (number >= 0.0, number),
            Sign::Above => (number > 0.0, number),
        };
        put(self.numbers[*of as usize].as_mut(), can_be.then_some(number))
    }

    /// The angle about the axis, rad, from −π to π, and the shift along it, m, between bodies in these poses.
    pub(crate) fn coordinates(&self, [(above, at), (below, to)]: [&Pose; 2]) -> [f64; 2] {
        let Self { at: points, axes: [axis, _], zero, .. } = self;
        let turned = above.tr_mul(below) * zero.transpose();
        let sine = Vector3::new(turned.m32 - turned.m23, turned.m13 - turned.m31, turned.m21 - turned.m12) * 0.5;
        let apart = above.tr_mul(&(to + below * points[1] - at)) - points[0];
        [sine.dot(axis).atan2((turned.trace() - 1.0) * 0.5), axis.dot(&apart)]
    }

    /// The constraint.
    pub(crate) fn constraint(&self) -> methods::Joint {
        let Self { kind, at, axes, zero, length, .. } = *self;
        match kind {
            Kind::Ball => methods::Joint::ball(at),
            Kind::Pin => methods::Joint::pin(at, axes),
            Kind::Universal => methods::Joint::universal(at, axes),
            Kind::Cylinder => methods::Joint::cylinder(at, axes),
            Kind::Slider => methods::Joint::slider(at, axes[0], zero),
            Kind::Weld => methods::Joint::weld(at, zero),
            Kind::Plane => methods::Joint::plane(at, axes),
            Kind::Distance => methods::Joint::distance(at, length),
        }
    }

    /// The attitude of the body below in the axes of the body above, at this angle about the axis.
    pub(crate) fn attitude_at(&self, angle: f64) -> Matrix3<f64> {
        if angle == 0.0 {
            return self.zero;
        }
        Rotation3::from_axis_angle(&Unit::new_normalize(self.axes[0]), angle).matrix() * self.zero
    }
}
